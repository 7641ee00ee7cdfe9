"""A step of the normal stress at the very moment when an echo raises the load: the slip rate goes the way the load wins.

The contact slips just above its fold, at a rate that no branch has any more under the normal stress after the step. Alone the step
brings it to rest. An echo that comes with it, and exceeds what the step adds to friction, brings it to the fast branch instead.
"""

from __future__ import annotations

import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import Steps

STATIC, DROP, ALPHA = 0.6, 0.2, 2.0
BEFORE, AFTER, RATE = 10.0, 20.0, 0.6
"""Normal stresses (Pa), under which slip needs more than 0.5 and more than 0.914 m/s; the slip rate (m/s) at first."""
LOADS = {True: 11.0, False: 10.375}
"""Loads after the step (Pa), above and below Z v + S mu(v) = 10.418 Pa at that rate. Both would hold fast slip, and rest."""
SHARE = 0.5
"""Share of a wave that the driver sends back (1)."""


def resistance(rate: float, normal: float) -> float:
    """Return Z v + S mu(v) (Pa), with Z = 1 Pa s/m."""
    return rate + normal * (STATIC - DROP + DROP / (1.0 + ALPHA * rate))


def fast(load: float, normal: float) -> float:
    """Return the rate (m/s) on the fast branch."""
    return float(brentq(lambda v: resistance(v, normal) - load, ((ALPHA * normal * DROP) ** 0.5 - 1.0) / ALPHA, 99.0, xtol=1e-15))


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize("sent", [0.5, 0.3])
@pytest.mark.parametrize("rises", [True, False])
def test_an_echo_that_comes_with_a_step_decides_which_way_the_slip_rate_goes(rises: bool, sent: float, way: int) -> None:
    load = resistance(RATE, BEFORE)

    def echo(pulse: float) -> float:
        """Return the growth of the load one round trip after a pulse of the load (Pa)."""
        return SHARE * (2.0 * (fast(load + pulse, BEFORE) - RATE) - pulse)

    pulse = float(brentq(lambda one: load + echo(one) - LOADS[rises], 0.1, 50.0, xtol=1e-14))
    slowest = ((ALPHA * AFTER * DROP) ** 0.5 - 1.0) / ALPHA
    assert resistance(slowest, AFTER) < LOADS[rises] < AFTER * STATIC
    assert (LOADS[rises] > resistance(RATE, AFTER)) is rises
    slab = ss.ElasticSlab(1.0, 1.0, 1.0, BEFORE, driver_impedance=(1.0 - SHARE) / (1.0 + SHARE))
    at_rest = way * (load - RATE)  # far stress that keeps the slip rate
    up = way * pulse / (1.0 + SHARE)
    back = sent + 3.0
    problem = ss.Problem(
        slab,
        ss.friction.HyperbolicRate(STATIC, STATIC - DROP, ALPHA),
        pull_rate=way * RATE,
        initial_rate=way * RATE,
        far_stress=Steps([0.0, sent, sent + 0.4], [at_rest, at_rest + up, at_rest]),
        normal_load=Steps([0.0, back], [BEFORE, AFTER]),
    )
    run = ss.simulate(problem, back + 0.3)
    assert float(run.slip_rate(back - 1e-6)) == pytest.approx(way * RATE, abs=1e-9)
    after = way * fast(LOADS[rises], AFTER) if rises else 0.0
    assert float(run.slip_rate(back + 1e-6)) == pytest.approx(after, abs=1e-9)
