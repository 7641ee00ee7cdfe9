"""How long and how accurately a problem is run, declared once: for scenarios, runs, their files, Python and the command line."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Self

from stickslip.foundation.arguments import CheckedArguments, shown
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Count, Quantity, declare, fields_of

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem

LARGEST_RTOL = 1e-2
"""Largest relative tolerance of a run."""
MOST_EVENTS = 10**12
"""Number of slip events that no run reaches."""
MAX_PIECES = 2_000_000
"""Largest number of pieces of a history unless `max_pieces` is given: 0.8 GB."""
LARGEST_HISTORY = 1_000_000_000
"""Largest number of pieces that can be asked for: 0.4 TB, more than the memory of most machines."""
DURATION = Quantity("s", "how long to simulate", above=0)
RUN_RTOL = Quantity("1", "relative tolerance of the run", at_least=1e-15, at_most=LARGEST_RTOL)
EVENTS_WANTED = Count("stop after this number of slip events", below=MOST_EVENTS, key="events")
CREEP_RTOL = Quantity("1", "leap over creep with this error of slip (slab, law of slip); 0: never; else automatic", at_least=0)
SHORTEST_EVENT = Quantity(
    "s", "lump slip events that are shorter (slab, rigid driver; layers); 0: none; else automatic", at_least=0
)


@dataclass(frozen=True)
class RunOptions(CheckedArguments):
    """How long and how accurately to run a problem, when to stop, and what to call the run.

    A scenario has them, and a run keeps them. None stands for automatic, of `max_events` for no such end.
    """

    duration: Number = declare(DURATION)
    rtol: float = declare(RUN_RTOL, 1e-10)
    title: str = ""
    description: str = ""
    max_events: int | None = declare(EVENTS_WANTED, None)
    creep_rtol: float | None = declare(CREEP_RTOL, None)
    shortest_event: float | None = declare(SHORTEST_EVENT, None)

    @property
    def options(self) -> RunOptions:
        """The options alone, of a record that has more."""
        return RunOptions(*VALUES_OF_OPTIONS(self))

    def with_given(self, given: Mapping[str, Any]) -> Self:
        """Return a record with other values of some of its fields; those that are None are not given."""
        return replace(self, **{name: value for name, value in given.items() if value is not None})

    def checked(self, who: str) -> Self:
        """Return the options with numbers in SI, each in its range whatever is run. Raises InputError, which begins with `who`."""
        if not isinstance(self.title, str):
            raise InputError(f"{who}: title must be text, got {shown(self.title)}")
        changed: dict[str, Any] = {}
        for name, (declared, default) in fields_of(type(self)).items():
            given = getattr(self, name)
            if (given is not None or default is not None) and (found := declared.check(who, name, given)) is not given:
                changed[name] = found
        return replace(self, **changed) if changed else self

    def check(self, who: str, problem: Problem) -> Self:
        """Return the options if this problem can be run with them. Raises InputError, which begins with `who`, otherwise."""
        from stickslip.problem.problem import check_problem

        check_problem(who, problem)
        if problem.why_not_run:
            raise InputError(f"{who}: {problem.why_not_run}")
        found = self.checked(who)
        found.check_with(problem, who)
        return found

    def check_with(self, problem: Problem, who: str, called: Callable[[str], str] = str) -> None:
        """Refuse what this problem does not allow.

        Raises InputError, which begins with `who` and names options as `called` says.
        """
        if problem.force is not None and problem.body.is_free:
            from stickslip.problem.rare_checks import check_period_of_force

            check_period_of_force(problem, self.duration, who)
        if self.creep_rtol is None and self.shortest_event is None:
            return
        from stickslip.problem.limits import check_creep_rtol, check_shortest_event  # which most scenarios can do without

        check_creep_rtol(problem, self.creep_rtol, who, called("creep_rtol"))
        check_shortest_event(problem, self.shortest_event, who, called("shortest_event"))


VALUES_OF_OPTIONS = attrgetter(*(one.name for one in fields(RunOptions)))
"""Returns the values of the options of a record that has them, in their order."""


@dataclass(frozen=True)
class BoundedOptions(RunOptions):
    """The options that the engine takes: those of a run, and how many pieces its history may have."""

    duration: Number = declare(DURATION)  # again: of a frozen base mypy takes what may be given for what is held
    max_pieces: int | None = declare(Count("largest number of pieces of history", below=LARGEST_HISTORY + 1), None)

    @property
    def most_pieces(self) -> int:
        """The largest number of pieces that the history may have."""
        return MAX_PIECES if self.max_pieces is None else self.max_pieces


def read_option(name: str, value: Any, where: str, called: str = "") -> Any:
    """Return one option in SI and in its range. Raises InputError that begins with `where` and names it `called`, if given."""
    return fields_of(RunOptions)[name][0].check(where, called or name, value)
