"""Find a number of a problem by its name, such as "friction.alpha", "body.normal_stress", "loading.pull_rate.values[1]".

A name is the place of the number in a scenario file, with [i] for the entry i of a series. The end of a name, such as "alpha", is
enough if only one name ends with it. `PRESSING` has no place in a file: it is the normal load with all that follows it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Generic, NamedTuple, TypeVar

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.names import own_units
from stickslip.foundation.other_values import with_values
from stickslip.foundation.quantities import (
    Choice,
    LawField,
    NamedNumbers,
    NumberSeries,
    Quantity,
    fields_of,
    in_units,
    quantities_of,
)
from stickslip.foundation.show import brief
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.fields import HISTORIES_ONLY, ProblemFields
from stickslip.problem.loading import VARYING, WAY, LoadingHistory

PRESSING = "pressing"
"""Name of the normal load with initial load, far stress and force in proportion: pressed harder, a contact is as near to slip."""
LOADING = ("pull_rate", "far_stress", "far_stress_rate", "force", *HISTORIES_ONLY)
"""Fields of a problem that are in the table [loading] of a scenario."""
STRESSES = ("far_stress", "far_stress_rate", "force")
"""Those of them that follow the normal load when a contact is pressed harder."""

NUMBERS_LISTED = "problem.parameters lists all"
"""Where all numbers are."""

P = TypeVar("P", bound=ProblemFields)


class ProblemEntry(NamedTuple):
    """An entry of a problem: its name, its declaration, and its value (None if it is not given)."""

    name: str
    declared: Quantity | Choice
    value: Any
    written: str = ""
    """Unit that follows the number in a scenario file (only parameters of a formula have one)."""


@dataclass(frozen=True)
class Parameter(Generic[P]):
    """A number of a problem: its full name, such as "friction.alpha", its value (SI), and its unit, meaning and allowed range."""

    name: str
    value: float
    declared: Quantity
    problem: P

    def __repr__(self) -> str:
        return f"Parameter({self.name} = {brief(self.value, self.unit)}, {self.declared.meaning})"

    @property
    def unit(self) -> str:
        """The SI unit of the value, "1" for a pure number."""
        return self.declared.unit

    def put(self, value: float) -> P:
        """Return a new problem with another value (SI) of this number. Raises InputError if the problem does not allow it."""
        return put_many(self.problem, {self.name: value})


class Parameters(Mapping[str, Parameter[P]], Generic[P]):
    """The numbers of a problem by name, those that are not given left out: of the friction law, of the body, of loading and start.

    `parameters["alpha"]` finds "friction.alpha" if no other name ends with ".alpha". It raises InputError if the name fits no
    number, or several. Three numbers that follow from others are found by their names and are not listed: that of initial load and
    initial excess which is not given, and `PRESSING`, with which the initial load and the far stress change in proportion.
    """

    def __init__(self, problem: P, load: float, excess: float) -> None:
        self._problem = problem
        self._loads = {"initial_load": load, "initial_excess": excess}

    @cached_property
    def _found(self) -> dict[str, Parameter[P]]:
        return {
            one.name: Parameter(one.name, one.value, one.declared, self._problem)
            for one in entries_of(self._problem)
            if isinstance(one.declared, Quantity) and one.value is not None and not isinstance(one.value, str)  # "steady"
        }

    def __getitem__(self, name: str) -> Parameter[P]:
        if not isinstance(name, str):
            raise InputError(f'parameters: a name must be text such as "friction.alpha", got {shown(name)}')
        if name in self._found:
            return self._found[name]
        known = self._found | {one.name: one for one in self._derived() if one.name not in self._found}
        return known[full_name(name, known, "parameter ", "is unknown", NUMBERS_LISTED)]

    def _derived(self) -> Iterator[Parameter[P]]:
        """Yield the numbers that follow from others."""
        problem = self._problem
        for name, value in self._loads.items():
            declared = replace(quantities_of(type(problem))[name], unit=problem.load_unit)
            yield Parameter(name.replace("_", "."), value, declared, problem)
        yield Parameter(PRESSING, problem.normal, pressing_of(problem), problem)

    def __contains__(self, name: object) -> bool:
        return name in self._found

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __repr__(self) -> str:
        return "\n".join(f"{one.name} = {brief(one.value, one.unit)}" for one in self._found.values())


def entries_of(problem: ProblemFields) -> Iterator[ProblemEntry]:
    """Yield every entry of a problem that can have another value, given or not: numbers, and words such as those of a law."""
    units = own_units(problem.load_unit)
    yield from _entries_in(problem.friction, "friction", units)
    yield from _entries_in(problem.body, "body")
    for name in LOADING:
        declared, value = in_units(quantities_of(type(problem))[name], units), getattr(problem, name)
        varies = isinstance(value, LoadingHistory)
        if name not in HISTORIES_ONLY:
            yield ProblemEntry(f"loading.{name}", declared, None if varies else value)
        if varies:
            yield from _entries_in(value, f"loading.{name}", {VARYING: declared.unit, WAY: declared.unit.removesuffix("/s")})
    yield from _of_start(problem)


def _of_start(problem: ProblemFields) -> Iterator[ProblemEntry]:
    """Yield the entries of the start. An initial load replaces an initial excess, and an excess a load."""
    units = own_units(problem.load_unit)
    declared = {name: in_units(one, units) for name, one in quantities_of(type(problem)).items()}
    yield ProblemEntry("initial.slip", declared["initial_slip"], problem.initial_slip)
    for name in ("load", "excess"):
        yield ProblemEntry(f"initial.{name}", declared[f"initial_{name}"], getattr(problem, f"initial_{name}"))
    given = dict(zip(STATE_NAMES, problem.given_states, strict=False))
    for name, state in zip(STATE_NAMES, problem.friction.states, strict=False):
        yield ProblemEntry(f"initial.{name}", Quantity(units.get(state.unit, state.unit), state.meaning), given.get(name))
    yield ProblemEntry("initial.rate", declared["initial_rate"], problem.initial_rate)


def put_many(problem: P, values: Mapping[str, Any], make: Callable[..., Any] = replace) -> P:
    """Return a problem with other values (SI) of its numbers, by their full names; an initial load replaces an excess, and back.

    A contact is pressed harder before other numbers are put. `make` is as for `foundation.other_values.with_values`.

    Raises InputError if the problem does not allow the values.
    """
    problem = pressed(problem, values[PRESSING]) if PRESSING in values else problem
    changes: dict[str, Any] = {}
    for name, value in values.items():
        table, _, inner = name.partition(".")
        if table == "initial":
            changes |= dict.fromkeys(("initial_load", "initial_excess")) if inner in ("load", "excess") else {}
            changes[f"initial_{inner}"] = value
        elif name != PRESSING:
            changes[inner if table == "loading" else name] = value
    return with_values(problem, changes, make) if changes else problem


def normal_name(problem: ProblemFields) -> str:
    """Return the name of the parameter that is the normal load: the body's own, or `PRESSING` if that is only in proportion."""
    name = problem.body.normal_field
    return name if getattr(problem.body, name) == problem.normal else PRESSING


def pressing_of(problem: ProblemFields) -> Quantity:
    """Return the declaration of `PRESSING`."""
    name = problem.body.normal_field
    meaning = f"{name.replace('_', ' ')}, with the initial load and the far stress in proportion"
    return replace(quantities_of(type(problem.body))[name], meaning=meaning, unit=problem.load_unit)


def pressed(problem: P, value: float) -> P:
    """Return a problem with another normal load (Pa, N or N m), at the same ratios of initial load and far stress to it.

    Raises InputError if the problem does not allow the value.
    """
    factor, body = value / problem.normal, pressed_body(problem, value)
    changes = {name: getattr(problem, name) for name in ("initial_load", "initial_excess", *STRESSES, "normal_load")}
    scaled = {name: _times(factor, one) for name, one in changes.items() if one is not None}
    return replace(problem, body=body, **scaled)


def pressed_body(problem: ProblemFields, value: float) -> BodyOnCharacteristics:
    """Return the body of a problem with another normal load: the weight on a string's bit is in proportion to it."""
    body, name = problem.body, problem.body.normal_field
    given = getattr(body, name)
    return replace(body, **{name: value if given == problem.normal else value / problem.normal * given})


def _times(factor: float, value: Any) -> Any:
    """Return a number, or a loading history, times a factor."""
    return value.scaled(factor) if isinstance(value, LoadingHistory) else factor * value


def _entries_in(owner: Any, place: str, units: Mapping[str, str] | None = None) -> Iterator[ProblemEntry]:
    """Yield the entries of a body, a law or a loading history; `units` are as for `in_units`."""
    for name, (given, _) in fields_of(type(owner)).items():
        declared, value = in_units(given, units or {}), getattr(owner, name)
        if isinstance(declared, Quantity | Choice):
            yield ProblemEntry(f"{place}.{name}", declared, value)
        elif isinstance(declared, NumberSeries) and value and declared.lists(value):
            for i, one in enumerate(value):
                yield ProblemEntry(f"{place}.{name}[{i}]", declared.item, one)
        elif isinstance(declared, NamedNumbers):
            for one in value:
                number = Quantity(one.unit or "1", "parameter of the formula")
                yield ProblemEntry(f"{place}.{declared.key}.{one.name}", number, one.value, one.unit)
        elif isinstance(declared, LawField):
            yield from _entries_in(value, f"{place}.{name}", units)
