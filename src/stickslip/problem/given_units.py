"""Print and draw results in the units of the numbers that a user gave."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from stickslip.foundation.given import PLACE, Given, Units, display_name, shown_in
from stickslip.foundation.names import KINDS_OF_BODY, si_unit
from stickslip.foundation.quantities import LawField, NumberSeries, Quantity, fields_of
from stickslip.foundation.units import si_factor
from stickslip.problem.loading import VARYING, LoadingHistory
from stickslip.problem.problem import Problem

P = ParamSpec("P")
T = TypeVar("T")
RATES = ("pull_rate", "initial_rate", "ground_velocity")
LOADS = ("initial_load", "initial_excess", "far_stress", "force", "normal_load")
"""Fields of a problem that are of the kind of a slip rate, and of a load, the nearest first."""


def units_given(problem: Problem) -> Units:
    """Return the units to show results of a problem in, because something of their kind was given in them.

    What is nearest to the result decides: the pull rate before the slip rates of the law, the load of the start before the normal
    load. If it was given in SI, or numbers equally near have several units, results are in SI.
    """
    body, law = problem.body, problem.friction
    kind = KINDS_OF_BODY[problem.load_unit]
    in_body = [name for name, (entry, _) in fields_of(type(body)).items() if _unit_of(entry) == "m"]
    groups = {
        "slip_rate": [*([getattr(problem, name)] for name in RATES), list(_in_law(law, "m/s"))],
        "slip": [[problem.initial_slip], list(_in_law(law, "m"))],
        "load": [*([getattr(problem, name)] for name in LOADS), [getattr(body, kind.normal, None)]],
        "slip_acceleration": [[problem.ground_acceleration]],
        "stiffness": [[getattr(body, "stiffness", None) if "stiffness" in fields_of(type(body)) else None]],
        PLACE: [[getattr(body, name) for name in in_body]],
    }
    found = {}
    for what, nearest_first in groups.items():
        si = "m" if what == PLACE else si_unit(what, problem.load_unit)
        unit = next((units for values in nearest_first if (units := _units(values))), [""])
        if len(unit) == 1 and unit[0]:
            found[PLACE if what == PLACE else si] = display_name(unit[0], si), float(si_factor(unit[0], si))
    return _with_slip(found)


def units_shared(problems: Sequence[Problem]) -> Units:
    """Return the units in which results of several problems are shown together: those in which all with such results were given.

    A block beside a string keeps its inches, and the string its rpm; a block in inches beside a block in metres is shown in metres.
    """
    own = [(units_given(problem), _si_units(problem)) for problem in problems]
    found = {}
    for si in dict.fromkeys(si for units, _ in own for si in units):
        several = {units.get(si) for units, known in own if si in known}
        if len(several) == 1 and (unit := several.pop()):
            found[si] = unit
    return found


def _si_units(problem: Problem) -> set[str]:
    """Return the SI units of the results of a problem that may be shown in another one."""
    shown = ("slip_rate", "slip", "load", "slip_acceleration", "stiffness")
    return {PLACE, *(si_unit(what, problem.load_unit) for what in shown)}


def _with_slip(found: dict[str, tuple[str, float]]) -> Units:
    """Return units with that of slip if only slip rates were given in a unit of length per time, such as inch/min."""
    length = found["m/s"][0].partition("/")[0].strip() if "m/s" in found and "m" not in found else ""
    if length and length != found["m/s"][0] and length != "m":
        found["m"] = length, float(si_factor(length, "m"))
    return found


def _unit_of(entry: Any) -> str:
    item = entry.item if isinstance(entry, NumberSeries) else entry
    return item.unit if isinstance(item, Quantity) else ""


def _in_law(law: Any, unit: str) -> Iterator[Any]:
    """Yield the numbers of a law that are declared in a unit and are not at their defaults."""
    for name, (entry, default) in fields_of(type(law)).items():
        value = getattr(law, name)
        if isinstance(entry, LawField):
            yield from _in_law(value, unit)
        elif _unit_of(entry) == unit and value != default:
            yield value


def _units(values: list[Any]) -> list[str]:
    """Return the given units of numbers, each once: "" for SI. Zeros say nothing of a unit."""
    found: dict[str, None] = {}
    for value in values:
        own = _numbers(value)
        with_unit = [one.unit for one in own if isinstance(one, Given)]
        found |= dict.fromkeys(with_unit or [""] * any(one != 0.0 for one in own))
    return list(found)


def _numbers(value: Any) -> list[Any]:
    """Return the numbers in a field: one, those of a series, or those of a loading history that are in its unit."""
    if isinstance(value, LoadingHistory):
        varying = [
            name for name, (entry, _) in fields_of(type(value)).items() if _unit_of(entry) in (VARYING, *VARYING.split(" or "))
        ]
        return [one for name in varying for one in _numbers(getattr(value, name))]
    if isinstance(value, list | tuple):
        return list(value)
    return [value] if isinstance(value, float) else []


def in_given_units(method: Callable[P, T]) -> Callable[P, T]:
    """Decorate a method so that it prints or draws in the given units of the problem."""

    @wraps(method)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        problems = _problems_of(args[0])
        if not problems:
            return method(*args, **kwargs)
        with shown_in(units_shared(problems)):
            return method(*args, **kwargs)

    return inside


def _problems_of(owner: Any) -> list[Problem]:
    """Return the problems of a comparison, or the one of another result."""
    found = getattr(owner, "problems", None) or [_problem_of(owner)]
    return [one for one in found if one is not None]


def _problem_of(owner: Any) -> Problem | None:
    """Return the problem of a result, of its run or of its scenario."""
    for name in ("problem", "_run", "slab", "scenario", "solution", "run"):
        found = getattr(owner, name, None)
        if isinstance(found, Problem):
            return found
        if found is not None and not callable(found) and (inner := getattr(found, "problem", None)) is not None:
            return inner if isinstance(inner, Problem) else None
    return None
