"""Take a problem from what a user gives: a problem, a scenario, the name of a bundled scenario, or a scenario file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.contact.uniqueness import Uniqueness, uniqueness_of
from stickslip.extension import tables
from stickslip.foundation.arguments import for_users
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
        name, table = next((name, tables()[name]) for name, _ in scenario.tables)
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


@for_users
def uniqueness(problem: Problem | Scenario | str | Path, law_slip: float | str | WithUnit | None = None) -> Uniqueness:
    """Determine whether the load fixes the slip rate of a contact, and otherwise what the selection rule does.

    The problem may also be given by its scenario, the name of a bundled scenario, or a scenario file. For a block, a contact with
    mass and a law with a state, the answer is "regular". `law_slip` (m, or a text with a unit) is the slip as the law counts it;
    the initial slip by default. The contact is regular if g(v) = Z v + S mu(v) increases, otherwise irregular (Campillo et al.
    1996, section 3).

    Raises InputError if friction falls at least as fast as Z v rises even at the fastest rate of the search, or if the table of the
    selection rule cannot be followed; for a scenario also as `stickslip.load_scenario` does.

    See Also
    --------
    stickslip.studies.critical_value : the value of a parameter where the answer ceases to be unique.
    stickslip.selection : the rules that select one of several answers.

    Examples
    --------
    >>> import stickslip as ss
    >>> body = ss.ElasticSlab(thickness="10 km", density=2700, wave_speed="3 km/s", normal_stress="100 MPa")
    >>> law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha="1 s/m")
    >>> answer = ss.uniqueness(ss.Problem(body, law, pull_rate="3 cm/year", initial_excess=0.0))
    >>> print(answer.regime, f"above {answer.critical_parameter} = {answer.critical_value:.4f} {answer.critical_unit}")
    irregular above alpha = 0.1620 s/m
    """
    found = read_source("uniqueness", problem)
    return uniqueness_of(found if isinstance(found, Problem) else found.problem, law_slip)
