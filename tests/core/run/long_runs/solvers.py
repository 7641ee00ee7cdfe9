"""Whether a solver obeys an option of `simulate`, or refuses it by name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.run.kinds import SolverKind, special_solver_of
from stickslip.run.simulate import EXACT

DURATION = 12.0
Obeyed = dict[str, tuple[Any, Callable[[Any], bool]]]
"""A value of each option, and what shows that a run obeyed it."""


def end_of(run: Any) -> float:
    """Return the time (s) up to which a run is known."""
    return float(run.duration if isinstance(run, ss.Solution) else run.times[-1])


OBEYED: Obeyed = {
    "duration": (9.0, lambda run: 9.0 <= end_of(run) < 10.0),
    "rtol": (1e-8, lambda run: run.rtol == 1e-8),
    "creep_rtol": (1e-5, lambda run: run.creep_rtol == 1e-5),
    "shortest_event": (0.01, lambda run: run.shortest_event == 0.01),
    "max_events": (1, lambda run: len(run.events) == 1 and run.duration < DURATION),
    "max_pieces": (20, lambda run: run.status.name == "too many pieces"),
    "selection": ("maxwell", lambda run: run.problem.selection == "maxwell"),
    "title": ("mine", lambda run: run.title == "mine"),
}


def solver_of(problem: Any) -> SolverKind:
    """Return the solver that takes a problem."""
    return special_solver_of(problem) or EXACT


def check_option(problem: Any, option: str, known: Obeyed = OBEYED) -> None:
    """Fail unless the solver of a problem obeys an option that it says it takes, and refuses another by name."""
    value, obeyed = known[option]
    given = {"duration": DURATION} | {option: value}
    if option in solver_of(problem).takes:
        assert obeyed(ss.simulate(problem, **given))
        assert option == "duration" or not obeyed(ss.simulate(problem, DURATION)), "this shows nothing"
        return
    with pytest.raises(ss.InputError, match=rf"simulate: .*\b{option}\b"):
        ss.simulate(problem, **given)


def check_checkpoint(problem: Any, place: Path, slip: Callable[[Any], Any]) -> None:
    """Fail unless the solver of a problem reports its progress and keeps a checkpoint with the same slip."""
    told: list[str] = []
    run = ss.simulate(problem, DURATION, progress=lambda news: told.append(str(news)), checkpoint=place, checkpoint_every=1e9)
    assert told
    assert np.array_equal(slip(ss.open_solution(place)), slip(run))
