"""The options of a run, and the one place where they are checked."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.conversion import Number, OptionalNumber, WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.locks import held
from stickslip.foundation.quantities import declare
from stickslip.problem import (
    CHECKPOINT_INTERVAL,
    CREEP_RTOL,
    DURATION,
    ENOUGH_EVENTS,
    SHORTEST_EVENT,
    STATUSES,
    TOO_MANY,
    Problem,
    RunNumbers,
    check_creep_rtol,
    check_problem,
    check_rtol,
    check_shortest_event,
)
from stickslip.problem.scenarios import Scenario, read_source

if TYPE_CHECKING:
    from stickslip.solution import Solution

DEFAULT_RTOL = 1e-10
"""Default relative tolerance."""
CHECKPOINT_EVERY = 30.0
"""Default interval between two checkpoints, s of wall clock: a killed run loses little, and writing costs little."""
MAX_PIECES = 2_000_000
"""Largest number of pieces of a history unless `max_pieces` is given: 0.8 GB."""

LARGEST_HISTORY = 1_000_000_000
"""Largest number of pieces that can be asked for: 0.4 TB, more than the memory of most machines."""

_CHECKS: dict[str, Callable[[str, str, Any], Any]] = {
    "duration": DURATION.check,
    "rtol": lambda who, _, value: check_rtol(value, where=who),
    "creep_rtol": CREEP_RTOL.check,
    "shortest_event": SHORTEST_EVENT.check,
    "checkpoint_every": CHECKPOINT_INTERVAL.check,
    "max_events": lambda who, name, value: check_whole(f"{who}: {name}", value),
    "max_pieces": lambda who, name, value: check_whole(f"{who}: {name}", value, most=LARGEST_HISTORY),
}
"""How the numbers of a run are checked, given who asks and their names."""


@dataclass(frozen=True)
class RunOptions:
    """How long and how accurately to run a problem, and what to report and store on the way.

    The fields are the arguments of `stickslip.simulate`, where they are described. In a catalogue `checkpoint` is not used.
    """

    duration: Number = declare(DURATION)
    rtol: float = DEFAULT_RTOL
    creep_rtol: float | None = None
    shortest_event: OptionalNumber = declare(SHORTEST_EVENT, None)
    max_events: int | None = None
    progress: Callable[[Any], object] | None = None
    checkpoint: Path | None = None
    checkpoint_every: Number = declare(CHECKPOINT_INTERVAL, CHECKPOINT_EVERY)
    max_pieces: int | None = None
    title: str = ""
    description: str = ""
    of_solver: Mapping[str, Any] = field(default_factory=dict)
    """Options of the solver of an extension, by name, which that solver checks."""

    @classmethod
    def of(cls, scenario: Scenario, **given: Any) -> Self:
        """Return the options of a scenario; options in `given` that are not None replace or complete them."""
        names = ("duration", "rtol", "creep_rtol", "shortest_event", "max_events")
        own = {name: getattr(scenario, name) for name in names} | {"title": scenario.heading, "description": scenario.description}
        return cls(**(own | _not_none(given)))

    @classmethod
    def to_continue(cls, stopped: Solution, duration: float | str | WithUnit | None, max_events: int | None, **others: Any) -> Self:
        """Return the options to continue a stopped run: its own where none are given, and `others` beside them.

        A run that has already had its number of events continues without one. Without a limit of its own it may come to half as
        many pieces again as it has, unless it has stopped because it had as many as it was allowed.
        """
        had_them, had = stopped.status == STATUSES[ENOUGH_EVENTS], len(stopped.history)
        if others.get("max_pieces") is None and stopped.status.name != TOO_MANY:
            others["max_pieces"] = max(MAX_PIECES, had + had // 2)
        return cls(
            stopped.asked_duration if duration is None else duration,
            stopped.rtol,
            stopped.creep_rtol,
            stopped.shortest_event,
            max_events if max_events is not None or had_them else stopped.max_events,
            title=stopped.title,
            description=stopped.description,
            **others,
        )

    def check(self, who: str, problem: Problem) -> Self:
        """Return the options if this problem can be run with them. Raises InputError, which begins with `who`, otherwise."""
        check_problem(who, problem)
        if problem.why_not_run:
            raise InputError(f"{who}: {problem.why_not_run}")
        checked = self.checked(who)
        check_creep_rtol(problem, checked.creep_rtol, who)
        check_shortest_event(problem, checked.shortest_event, who)
        return checked

    def checked(self, who: str) -> Self:
        """Return the options with numbers in SI, each in its range whatever is run. Raises InputError, which begins with `who`."""
        if not isinstance(self.title, str):
            raise InputError(f"{who}: title must be text, got {shown(self.title)}")
        converted = {}
        for name, check in _CHECKS.items():
            given = getattr(self, name)
            if given is not None or name == "duration":
                checked = check(who, name, given)
                if checked is not given:
                    converted[name] = checked
        return replace(self, **converted) if converted else self

    @property
    def most_pieces(self) -> int:
        """The largest number of pieces that the history may have."""
        return MAX_PIECES if self.max_pieces is None else self.max_pieces

    @property
    def numbers(self) -> RunNumbers:
        """The numbers that the exact solver takes."""
        return RunNumbers(self.duration, self.rtol, self.creep_rtol, self.shortest_event, self.most_pieces)

    def alone(self) -> AbstractContextManager[None]:
        """Reserve the run's file, if it has one, against other runs until the `with` block ends.

        Raises InputError if another run is writing into it, or if nothing can be written beside it.
        """
        if self.checkpoint is None:
            return nullcontext()
        return held(self.checkpoint, f"{self.checkpoint}: another run is writing into it: choose another name")


def options_of(source: Any, **given: Any) -> RunOptions:
    """Return the options of a run, not yet checked; those in `given` that are None come from the scenario, or are the defaults.

    The source is a scenario, a problem, or what the solver of an extension solves.
    """
    if isinstance(source, Scenario):
        return RunOptions.of(source, **given)
    return RunOptions(**({"duration": None} | _not_none(given)))


def problem_and_options(who: str, source: Problem | Scenario | str | Path, **given: Any) -> tuple[Problem, RunOptions]:
    """Return the problem to run and the checked options of its run, see `options_of`.

    The source is a problem, a scenario, the name of a bundled scenario or a scenario file. Raises InputError, for a wrong option
    with a message that begins with `who`.
    """
    source = read_source(who, source)
    problem = source if isinstance(source, Problem) else source.problem
    return problem, options_of(source, **given).check(who, problem)


def _not_none(given: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in given.items() if value is not None}
