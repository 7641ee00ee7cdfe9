"""Each cycle of a branch is once round and of the kind of the one before: against cycles that are found alone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from tests.extensions.cycles.by_scipy import Axis

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


def least_force_at_rest(pull: float) -> float:
    """Return the least force (N) of a loop in the rest of its cycle with one slip a period, by matrix exponentials."""
    own = Axis(1.0, 100.0, 50.0, 5.0, 4.0, 3.0, pull=pull)
    turns = -own.kp * pull / own.ki

    def arrest(lag: float) -> tuple[float, float]:
        (behind, _, integral), _, _ = own.slipped(np.array([lag, 0.0, 4.0 - own.kp * lag - own.kd * pull]), 1)
        return behind, own.kp * behind + integral + own.kd * pull

    def missed(lag: float) -> float:
        behind, force = arrest(lag)
        waits = np.roots([0.5 * own.ki * pull, own.kp * pull + own.ki * behind, force - 4.0]).real.max()
        return behind + pull * float(waits) - lag

    behind, force = arrest(brentq(missed, 0.007, 0.008, xtol=1e-16, rtol=1e-15))
    return force + own.kp * (turns - behind) + own.ki * (turns**2 - behind**2) / (2.0 * pull)


def test_a_branch_ends_where_a_slip_the_other_way_begins_in_a_rest() -> None:
    """The force at rest comes to minus the static strength there, to 1e-9, by matrix exponentials; beyond it slips go both ways."""
    branch = ss.studies.follow(ss.studies.cycle(on_ramp(2e-4)), to=1.6e-4, steps=2)
    grazes = brentq(lambda pull: least_force_at_rest(pull) + 4.0, 1.7e-4, 2e-4, xtol=1e-18)
    (edge,) = branch.edges
    assert edge.name == "grazing"
    assert edge.value == pytest.approx(grazes, rel=1e-9)
    assert branch.points[0].measures.least_rate == 0.0
    assert branch.points[-1].measures.least_rate < 0.0


@pytest.mark.parametrize(("begin", "steps"), [(0.1670, 1), (0.1673, 2)])
def test_a_grazed_arrest_is_called_so_and_does_not_depend_on_the_steps(begin: float, steps: int) -> None:
    """One of two arrests has no deceleration there, to 1e-9: behind an impact, where the force comes to dynamic friction."""
    law = ss.friction.Coulomb(static=0.713112, dynamic=0.240396)
    hit: dict[str, float] = {"reference_step": 0.125035, "stop_ahead": begin, "restitution": 1.0}
    body = ss.PositionLoop(1.0, 100.0, 10.0, 226.842, 2.92992, **hit)
    cycle = ss.studies.cycle(ss.Problem(body, law, pull_rate=0.0, initial_load=0.0))
    edge = ss.studies.follow(cycle, "body.stop_ahead", to=0.168, steps=steps).edges[-1]
    assert edge.name == "grazing"
    assert edge.value == pytest.approx(0.16744474910, rel=1e-9)
    history = edge.orbit.closed.history
    arrest = int(np.flatnonzero(history.store.mode == 0)[0])
    assert history.store.load[arrest, 0] + history.problem.strength == pytest.approx(-2.40396, rel=1e-5)
