"""Every option of `simulate` is obeyed, or refused by name, by every solver."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.solution import PlanarSolution
from stickslip.run.simulate import SOLVERS, SolverKind
from tests.problems import SLAB

WEAKENING = ss.friction.LinearSlipWeakening(0.6, 0.3, 2.0)
CREEPS = ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)
SOLVED: tuple[Any, ...] = (
    ss.Problem(SLAB, CREEPS, pull_rate=0.01, initial_excess=1e6),
    ss.PlanarSlab(ss.Problem(SLAB, WEAKENING, initial_excess=1e6), nodes=8, length=1e4),
)
"""One problem for each solver."""
DURATION = 12.0


def end_of(run: Any) -> float:
    """Return the time (s) up to which a run is known."""
    return float(run.times[-1] if isinstance(run, PlanarSolution) else run.duration)


OBEYED: dict[str, tuple[Any, Callable[[Any], bool]]] = {
    "duration": (9.0, lambda run: 9.0 <= end_of(run) < 10.0),
    "rtol": (1e-8, lambda run: run.rtol == 1e-8),
    "frames": (7, lambda run: bool(0.5 < 7 * run.times[1] / SLAB.two_way_time <= 1.0)),
    "creep_rtol": (1e-5, lambda run: run.creep_rtol == 1e-5),
    "shortest_event": (0.01, lambda run: run.shortest_event == 0.01),
    "max_events": (1, lambda run: len(run.events) == 1 and run.duration < DURATION),
    "max_pieces": (20, lambda run: run.status.name == "too many pieces"),
    "selection": ("maxwell", lambda run: run.problem.selection == "maxwell"),
    "title": ("mine", lambda run: run.title == "mine"),
}
"""A value of each option, and what shows that a run obeyed it."""


def solver_of(problem: Any) -> SolverKind:
    return next(one for one in SOLVERS if one.solves(problem))


def test_the_lists_above_are_complete() -> None:
    assert {id(solver_of(one)) for one in SOLVED} == {id(one) for one in SOLVERS}
    others = {"problem", "progress", "checkpoint", "checkpoint_every"}
    assert set(OBEYED) == set(inspect.signature(ss.simulate).parameters) - others


@pytest.mark.parametrize("option", OBEYED)
@pytest.mark.parametrize("problem", SOLVED, ids=lambda one: type(one).__name__)
def test_an_option_is_obeyed_or_refused_by_name(problem: Any, option: str) -> None:
    value, obeyed = OBEYED[option]
    given = {"duration": DURATION} | {option: value}
    if option in solver_of(problem).takes:
        assert obeyed(ss.simulate(problem, **given))
        assert option == "duration" or not obeyed(ss.simulate(problem, DURATION)), "this shows nothing"
        return
    with pytest.raises(ss.InputError, match=rf"simulate: .*\b{option}\b"):
        ss.simulate(problem, **given)


@pytest.mark.parametrize("problem", SOLVED, ids=lambda one: type(one).__name__)
def test_each_solver_reports_its_progress_and_keeps_checkpoints(problem: Any, tmp_path: Path) -> None:
    told: list[str] = []
    place = tmp_path / ("run.zarr" if isinstance(problem, ss.PlanarSlab) else "run.nc")
    run = ss.simulate(problem, DURATION, progress=lambda news: told.append(str(news)), checkpoint=place, checkpoint_every=1e9)
    assert told
    back = ss.open_solution(place)
    slips = (one.slip if isinstance(one, PlanarSolution) else one.slip(DURATION) for one in (back, run))
    assert np.array_equal(*slips)


@pytest.mark.parametrize("source", ["fig4-loop", ss.load_scenario("fig4-loop"), "problem"], ids=["name", "scenario", "problem"])
def test_a_rule_that_is_given_decides_as_that_of_the_problem_would(source: Any) -> None:
    """The loop tells the rules apart: the run under a given rule is, bit for bit, that of a problem with this rule."""
    scenario = ss.load_scenario("fig4-loop")
    source, duration = (scenario.problem, scenario.duration) if source == "problem" else (source, None)
    given = ss.simulate(source, duration, scenario.rtol, selection="maxwell")
    stated = ss.simulate(replace(scenario.problem, selection="maxwell"), scenario.duration, scenario.rtol)
    assert given.shocks.equals(stated.shocks)
    assert not given.shocks.equals(ss.simulate(scenario).shocks)
    with pytest.raises(ss.InputError, match="did you mean 'maxwell'"):
        ss.simulate(source, duration, selection="maxwel")
