"""A law that dips below zero ends a run at the dip, however shallow the dip and however long the steps: friction drives no slip.

The laws are m + a sin(u/w), with m a little below a and u the length of the path: friction is zero at the path w (pi + asin(m/a)),
which is beyond the 10 m up to which formulas are checked. A run that gets there must end there, and no other run may.
"""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import stickslip as ss

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
WITH_MASS = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e4)
STIFF = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=1e1)
BLOCK = ss.SpringBlock(1e7, 5e6, 1e8)
NEGLIGIBLE = 1e-9
"""Size of a negative friction coefficient that counts as rounding, as in `contact_step.verify`."""


def dipping(amplitude: float, width: float, depth: float) -> tuple[ss.friction.FrictionLaw, float]:
    """Return a law that falls `depth` of its amplitude below zero, and the path (m) at which it is zero for the first time."""
    mean = amplitude * (1.0 - depth)
    law = ss.friction.FromExpression("m + a*sin(u/w)", {"m": mean, "a": amplitude, "w": width}, counts="path")
    return law, width * (math.pi + math.asin(mean / amplitude))


def path_of(run: ss.Solution) -> float:
    """Return the length of the path (m) of a run: slip is monotone in each piece of the history."""
    return float(np.abs(np.diff(run.slip(np.append(run.history.start, run.history.duration)))).sum())


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("body", [SLAB, WITH_MASS, STIFF, BLOCK], ids=["slab", "mass", "stiff", "block"])
@given(
    depth=st.floats(-5.0, -0.5).map(lambda power: 10.0**power),
    width=st.floats(4.0, 8.0),
    amplitude=st.floats(0.2, 0.4),
    push=st.floats(0.5, 9.0),
    rtol=st.sampled_from([1e-5, 1e-7, 1e-10]),
)
def test_a_run_ends_where_friction_is_zero_and_nowhere_else(
    body: ss.ElasticSlab | ss.SpringBlock, depth: float, width: float, amplitude: float, push: float, rtol: float
) -> None:
    law, zero = dipping(amplitude, width, depth)
    run = ss.simulate(ss.Problem(body, law, initial_excess=1e8 * amplitude * push), 60.0, rtol=rtol, max_pieces=2000)
    path, within = path_of(run), 1e-6 * width + 10.0 * NEGLIGIBLE * width / math.sqrt(2.0 * depth)
    if run.status.name == "negative friction":
        assert path == pytest.approx(zero, abs=within)
    else:
        assert path <= zero + within


def test_a_block_under_a_law_of_slip_rate_ends_at_the_rate_at_which_friction_is_zero() -> None:
    law = ss.friction.FromExpression("m + a*cos(v/w)", {"m": 0.3 * (1.0 - 1e-5), "a": 0.3, "w": "5 m/s"})
    run = ss.simulate(ss.Problem(ss.SpringBlock(1e7, 5e6, 1e8), law, initial_excess=4e8), 60.0, rtol=1e-5)
    assert run.status.name == "negative friction"
    last = abs(float(run.slip_rate(run.history.duration)))
    assert last == pytest.approx(5.0 * math.acos(-(1.0 - 1e-5)), abs=5e-5)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("depth", [0.1, 1e-2, 1e-4])
def test_leaps_over_creep_do_not_pass_over_a_dip(depth: float) -> None:
    """A stiff slab creeps along m + a cos(u/w), whose first zero is at u = w acos(-m/a)."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e3, 1e8)
    law = ss.friction.FromExpression("m + a*cos(u/w)", {"m": 0.2 * (1.0 - depth), "a": 0.2, "w": 20.0}, counts="path")
    problem = ss.Problem(slab, law, pull_rate=1e-2, initial_excess=1e3)
    run = ss.simulate(problem, 1.5e4, rtol=1e-6, creep_rtol=1e-3)
    assert run.creep["round_trips"].sum() > 7000
    assert run.status.name == "negative friction"
    assert path_of(run) == pytest.approx(20.0 * math.acos(-(1.0 - depth)), abs=1e-5)


def test_a_law_that_is_known_to_stay_above_zero_is_not_watched() -> None:
    slip = ss.friction.FromExpression("0.6 - 0.03*u", counts="path")
    assert slip.can_be_negative
    for text in ("0.3 + 0.2*exp(-u*u)", "0.3 + 0.2*sin(u)", "0.3 + 0.2*tanh(u)"):
        assert not ss.friction.FromExpression(text, counts="path").can_be_negative
    assert ss.friction.SlipPlusRate(slip, ss.friction.HyperbolicRate(0.3, 0.2, 1.0)).can_be_negative
    assert not ss.friction.HyperbolicRate(0.8, 0.3, 1.0).can_be_negative
    lag = ss.friction.LaggedFriction(rate=ss.friction.HyperbolicRate(0.8, 0.3, 1.0), time=1.0, direct=0.2, direct_rate=1e-3)
    assert lag.can_be_negative
