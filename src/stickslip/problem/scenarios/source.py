"""Take a problem from what a user gives: a problem, a scenario, the name of a bundled scenario, or a scenario file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.extension import tables
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem, check_problem
from stickslip.problem.run_options import DURATION

if TYPE_CHECKING:
    from stickslip.problem.scenarios.scenario import Scenario


def check_solved_by_core(who: str, scenario: Scenario) -> None:
    """Refuse a scenario whose own problem is not what is solved, as all but runs need it. Raises InputError."""
    if not scenario.is_of_core:
        made = ((name, tables()[name]) for name, value in scenario.tables if tables()[name].problem(value, scenario) is not None)
        name, table = next(made)
        uses = "for which there are `stickslip run`, `check`, `show` and ss.simulate"
        raise InputError(f"{who}: {scenario.name} has a {table.what.format(name)}, {uses}: {table.instead.format(name)}")


def read_source(
    who: str, source: Problem | Scenario | str | Path, duration: float | str | WithUnit | None = None, *, any_kind: bool = False
) -> Scenario:
    """Return the scenario of a problem with a `duration`, a scenario itself, or that of a bundled name or a file.

    A duration (s, or a text with a unit) replaces that of the scenario. Raises InputError, for another type or duration with a
    message that begins with `who`, and unless it may be of `any_kind` for a scenario whose own problem is not what is solved.
    """
    from stickslip.problem.scenarios.scenario import Scenario, load_scenario  # which a problem can do without

    if isinstance(source, Problem):
        return Scenario(source, DURATION.check(who, "duration", duration))
    found = load_scenario(source) if isinstance(source, str | Path) else source
    if not isinstance(found, Scenario):
        check_problem(who, found, "a Problem, a scenario, or the name of one")
    if not any_kind:
        check_solved_by_core(who, found)
    return found if duration is None else replace(found, duration=DURATION.check(who, "duration", duration))


def read_problem(who: str, source: Problem | Scenario | str | Path) -> Problem:
    """Return a problem itself, or that of a scenario, which may be given as to `read_source`. Raises InputError as that does."""
    return source if isinstance(source, Problem) else read_source(who, source).problem
