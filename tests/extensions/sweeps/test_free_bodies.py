"""Sweeps over the stiffness of a spring that may be none, and over a force."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.lanes.vectorised_problem import why_not
from stickslip.foundation.quantities import quantities_of
from stickslip.problem.scenarios import Scenario

DRY = ss.friction.Coulomb(0.6, 0.4)
FREE = ss.SpringBlock(2.0, 0.0, 20.0)
SPRUNG = ss.SpringBlock(2.0, 30.0, 20.0)


def test_a_sweep_over_a_stiffness_begins_with_none() -> None:
    start = ss.Problem(SPRUNG, DRY, initial_load=13.0)
    found = ss.sweep(start, {"body.stiffness": [0.0, 1e-12, 30.0]}, quantities=["slip"], duration=2.0).slip.to_numpy()
    assert found[0] == pytest.approx(0.5 * 2.5 * 4.0, rel=1e-13)
    assert found[1] == pytest.approx(found[0], rel=1e-9)
    assert np.isfinite(found).all()
    forces = ss.sweep(ss.Problem(FREE, DRY, force=13.0), {"loading.force": [11.0, 13.0, 15.0]}, quantities=["slip"], duration=2.0)
    assert forces.slip.to_numpy() == pytest.approx([0.0, 5.0, 7.0], rel=1e-13)


MOVED = {
    "at rest": {},
    "pushed": {"force": 13.0},
    "thrown": {"initial_rate": 1.0},
    "sprung": {"initial_load": 13.0},
    "pulled": {"pull_rate": 0.5, "initial_load": 0.0},
}
"""What moves a body, or nothing: without a spring a pull is that of a dashpot."""


@pytest.mark.sampled(every=20)
@pytest.mark.parametrize("stiffness", [0.0, 30.0])
@pytest.mark.parametrize("how", MOVED)
@pytest.mark.parametrize("kind", [ss.SpringBlock, ss.RotatingBlock])
def test_a_sweep_over_each_number_of_a_body_gives_what_single_runs_give(kind: type, how: str, stiffness: float) -> None:
    """One parameter after the other, and the force, in a batch where there is one; runs of each value are the other way."""
    start: dict[str, Any] = MOVED[how] | ({"initial_load": 0.0} if stiffness and how in ("at rest", "thrown", "pushed") else {})
    dashpot = {"driver_damping": 30.0} if how == "pulled" else {}
    problem = ss.Problem(kind(2.0, stiffness, 20.0, **dashpot), DRY, **start)
    for name in quantities_of(kind):
        if name != "restitution" and not (name == "backlash" and stiffness == 0.0):  # which need a stop, and a spring
            own = getattr(problem.body, name)
            compare_with_runs(problem, f"body.{name}", [0.5 * own, own] if 0.0 < own < np.inf else [0.03, 0.4])
    if not dashpot:
        compare_with_runs(problem, "loading.force", [0.0, 13.0])


def compare_with_runs(problem: ss.Problem, name: str, values: list[float]) -> None:
    """Compare the slip at the end of the members of a sweep with that of single runs."""
    found = ss.sweep(problem, {name: values}, quantities=["slip"], duration=2.0).slip.to_numpy()
    single = [float(ss.simulate(with_value(problem, name, value), 2.0).slip(2.0)) for value in values]
    np.testing.assert_allclose(found, single, rtol=1e-9, atol=1e-12, err_msg=name)


def with_value(problem: ss.Problem, name: str, value: float) -> ss.Problem:
    """Return the problem with another number; a force need not be there yet."""
    return replace(problem, force=value) if name == "loading.force" else problem.parameters[name].put(value)


def test_a_sweep_over_a_play_is_followed_one_run_at_a_time() -> None:
    start = ss.Problem(ss.SpringBlock(1.0, 100.0, 10.0, backlash=0.02), DRY, 0.05, initial_load=0.0)
    sizes = [0.0, 0.01, 0.02]
    found = ss.sweep(start, {"body.backlash": sizes}, quantities=["slip"], duration=4.0).slip.to_numpy()
    alone = [ss.simulate(replace(start, body=replace(start.body, backlash=size)), 4.0) for size in sizes]
    assert found.tolist() == [float(run.slip(4.0)) for run in alone]
    assert len(set(found.tolist())) == len(sizes)
    why = why_not(Scenario(start, 4.0), ["friction.static"], ["slip"])
    assert why == "[body] backlash is followed one run at a time"
