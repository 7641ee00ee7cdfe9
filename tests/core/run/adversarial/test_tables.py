"""Laws that hide a barrier or a needle in a composition: slip ends where friction first equals the load, to 1e-7.

Truth comes from a search of the law itself on a grid that is dense at its features, and brentq. Steps by the last terms of a
series, with guards at single nodes, went through each of these barriers.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.core.run.adversarial.barriers import BARRIERS, CLAIM, DURATION, EXCESS, STEEP, first_balance, problem, value
from tests.core.run.adversarial.walk import Place, walk


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", BARRIERS)
def test_slip_stops_at_a_hidden_barrier(name: str) -> None:
    barrier = BARRIERS[name]
    stops = first_balance(barrier, EXCESS)
    assert stops == pytest.approx(barrier.stops, rel=0.0, abs=6e-5 if name == "power of a power" else 6e-7)
    run = ss.simulate(problem(barrier), DURATION)
    assert run.status.name == "finished"
    assert float(run.slip(DURATION)) == pytest.approx(stops, rel=CLAIM, abs=0.0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", STEEP)
def test_a_contact_settles_against_a_steep_barrier_in_few_steps(name: str) -> None:
    """Slip to 1e-9; explicit steps would be as short as the contact settles: 1e9 pieces for the steepest barrier."""
    barrier = STEEP[name]
    run = ss.simulate(problem(barrier), DURATION)
    assert run.status.name == "finished"
    assert len(run.history) < 300
    assert float(run.slip(DURATION)) == pytest.approx(first_balance(barrier, EXCESS), rel=1e-9, abs=0.0)


NEEDLES = "0.3+0.3*(sin(3*pi*v)**16)**4"


@pytest.mark.slow
def test_a_block_meets_needles_of_the_slip_rate() -> None:
    """m = 1, K = 20, N = 10: peak slip 0.769388 m, where the slip rate first returns to zero. To 1e-7."""
    block = ss.SpringBlock(1.0, 20.0, 10.0)

    def right(t: float, y: Any) -> list[float]:
        return [y[1], 8.0 - 20.0 * y[0] - 10.0 * (float(value(NEEDLES, 0.0, y[1])) - 0.3)]

    places = [Place(lambda t, y: float(y[1]), centre, 0.02) for centre in np.arange(1, 30, 2) / 6.0]
    path = walk(right, 0.0, [0.0, 0.0], 2.0, places, [1.0, 1.0], lambda t, y: float(y[1]))
    peak = float(path(path.end)[0])
    assert path.stopped
    assert peak == pytest.approx(0.769388, rel=0.0, abs=1e-6)
    run = ss.simulate(ss.Problem(block, ss.friction.FromExpression(NEEDLES), initial_excess=8.0), 2.0)
    assert float(run.catalogue(0.0).end[0]) == pytest.approx(path.end, rel=CLAIM, abs=0.0)
    assert float(run.slip(path.end)) == pytest.approx(peak, rel=CLAIM, abs=0.0)
