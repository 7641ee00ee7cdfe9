"""Each cycle of a branch is once round and of the kind of the one before: against cycles that are found alone."""

from __future__ import annotations

import pytest

import stickslip as ss

RAMP = ss.PositionLoop(mass=1.0, proportional_gain=100.0, normal_force=10.0, integral_gain=50.0, derivative_gain=5.0)
DROP = ss.friction.Coulomb(static=0.4, dynamic=0.3)
SLOW_RAMP = 1e-3


def on_ramp(pull: float = SLOW_RAMP) -> ss.Problem:
    return ss.Problem(RAMP, DROP, pull_rate=pull, initial_load=0.0)


def states(pull: float = 1e-6) -> ss.Problem:
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=1e-5)
    return ss.Problem(ss.SpringBlock(mass=1.0, stiffness=2.5e3, normal_force=10.0), law, pull_rate=pull)


@pytest.mark.parametrize(("problem", "to"), [(on_ramp(), 20.0 * SLOW_RAMP), (states(), 12e-6)], ids=["loop", "states"])
def test_a_branch_along_which_the_period_changes_much_keeps_to_one_period(problem: ss.Problem, to: float) -> None:
    """Period and largest multiplier at the end are those of the cycle found there alone, to 1e-9 and 1e-6, not a power of it."""
    branch = ss.studies.follow(ss.studies.cycle(problem), to=to, steps=3)
    last = branch.points[-1]
    alone = ss.studies.cycle(problem.parameters["loading.pull_rate"].put(to))
    assert last.value == pytest.approx(to, rel=1e-15)
    assert not branch.edges
    assert last.measures.period == pytest.approx(alone.period, rel=1e-9)
    assert last.multipliers[0].real == pytest.approx(alone.multipliers[0].real, rel=1e-6)
