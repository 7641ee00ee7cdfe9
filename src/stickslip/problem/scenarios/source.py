"""Take a problem from what a user gives: a problem, a scenario, the name of a bundled scenario, or a scenario file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.extension import tables
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem, check_problem
from stickslip.problem.run_quantities import DURATION
from stickslip.problem.selection_rule import SelectionRule

if TYPE_CHECKING:
    from stickslip.problem.scenarios.scenario import Scenario


def solved_by_core(who: str, scenario: Scenario) -> Scenario:
    """Return a scenario if its own problem is solved, as all but runs need it. Raises InputError, which begins with `who`."""
    if not scenario.is_of_core:
        made = ((name, tables()[name]) for name, value in scenario.tables if tables()[name].problem(value, scenario) is not None)
        name, table = next(made)
        uses = "for which there are `stickslip run`, `check`, `show` and ss.simulate"
        raise InputError(f"{who}: {scenario.name} has a {table.what.format(name)}, {uses}: {table.instead.format(name)}")
    return scenario


def read_source(who: str, source: Problem | Scenario | str | Path, *, any_kind: bool = False) -> Problem | Scenario:
    """Return a problem or a scenario as it is, or the scenario of a bundled name or a file.

    Raises InputError, for another type with a message that begins with `who`, and unless it may be of `any_kind` for a scenario
    whose own problem is not what is solved.
    """
    if isinstance(source, Problem):
        return source
    from stickslip.problem.scenarios.scenario import Scenario, load_scenario  # which a problem can do without

    found = load_scenario(source) if isinstance(source, str | Path) else source
    if not isinstance(found, Scenario):
        check_problem(who, found, "a Problem, a scenario, or the name of one")
    return found if any_kind else solved_by_core(who, found)


def under_rule(source: Problem | Scenario, rule: str | SelectionRule) -> Problem | Scenario:
    """Return a problem, or a scenario, under another selection rule. Raises InputError for an unknown rule."""
    problem: Problem = source if isinstance(source, Problem) else source.problem
    changed = replace(problem, selection=rule)
    return changed if isinstance(source, Problem) else replace(source, problem=changed)


def read_duration_and_problem(
    who: str, source: Problem | Scenario | str | Path, duration: float | str | WithUnit | None
) -> tuple[float, Problem]:
    """Return a checked duration (s), by default the scenario's, and the problem that `read_source` finds.

    Raises InputError, which begins with `who`, also if a problem comes without a duration.
    """
    found = read_source(who, source)
    if isinstance(found, Problem):
        return DURATION.check(who, "duration", duration), found
    return DURATION.check(who, "duration", found.duration if duration is None else duration), found.problem
