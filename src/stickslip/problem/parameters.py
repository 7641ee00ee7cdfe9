"""Find a number of a problem by its name, such as "friction.alpha", "body.normal_stress", "loading.pull_rate.values[1]".

A name is the place of the number in a scenario file, with [i] for the entry i of a series. The end of a name, such as "alpha", is
enough if only one name ends with it. `PRESSING` has no place in a file: it is the normal load with all that follows it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar, cast

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.formatting import brief
from stickslip.foundation.quantities import (
    Choice,
    NamedNumbers,
    Part,
    Quantity,
    Series,
    fields_of,
    in_units,
    quantities_of,
)
from stickslip.friction.contract import STATE_NAMES
from stickslip.loading.contract import VARYING, LoadingHistory

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem

PRESSING = "pressing"
"""Name of the normal load with the initial load and the far stress in proportion: pressed harder, a contact is as near to slip."""
LOADING = ("pull_rate", "far_stress", "far_stress_rate")
"""Fields of a problem that are in the table [loading] of a scenario."""
STRESSES = ("far_stress", "far_stress_rate")
"""Those of them that follow the normal load when a contact is pressed harder."""


class Entry(NamedTuple):
    """An entry of a problem: its name, its declaration, its value (None if it is not given), and what puts another in its place."""

    name: str
    declared: Quantity | Choice
    value: Any
    put: Callable[[Any], Problem]
    written: str = ""
    """Unit that follows the number in a scenario file (only parameters of a formula have one)."""


Owner = TypeVar("Owner")


@dataclass(frozen=True)
class Parameter:
    """A number of a problem: its full name, such as "friction.alpha", its value (SI), and its unit, meaning and allowed range."""

    name: str
    value: float
    declared: Quantity
    _put: Callable[[float], Problem]

    def __repr__(self) -> str:
        return f"Parameter({self.name} = {brief(self.value, self.unit)}, {self.declared.meaning})"

    @property
    def unit(self) -> str:
        """The SI unit of the value, "1" for a pure number."""
        return self.declared.unit

    def put(self, value: float) -> Problem:
        """Return a new problem with another value (SI) of this number. Raises InputError if the problem does not allow it."""
        return self._put(value)


class Parameters(Mapping[str, Parameter]):
    """The numbers of a problem by name, those that are not given left out: of the friction law, of the body, of loading and start.

    `parameters["alpha"]` finds "friction.alpha" if no other name ends with ".alpha". It raises InputError if the name fits no
    number, or several. Three numbers that follow from others are found by their names and are not listed: that of initial load and
    initial excess which is not given, and `PRESSING`, with which the initial load and the far stress change in proportion.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem

    @cached_property
    def _found(self) -> dict[str, Parameter]:
        entries = entries_of(self._problem)
        return {
            one.name: Parameter(one.name, one.value, one.declared, one.put)
            for one in entries
            if isinstance(one.declared, Quantity) and one.value is not None and not isinstance(one.value, str)  # "steady"
        }

    def __getitem__(self, name: str) -> Parameter:
        if not isinstance(name, str):
            raise InputError(f'parameters: a name must be text such as "friction.alpha", got {shown(name)}')
        known = self._found | {one.name: one for one in _derived(self._problem) if one.name not in self._found}
        return known[full_name(name, known, "parameter ", "is unknown")]

    def __contains__(self, name: object) -> bool:
        return name in self._found

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __repr__(self) -> str:
        return "\n".join(f"{one.name} = {brief(one.value, one.unit)}" for one in self._found.values())


def entries_of(problem: Problem) -> Iterator[Entry]:
    """Yield every entry of a problem that can have another value, given or not: numbers, and words such as those of a law."""
    yield from _entries_in(problem.friction, "friction", _field_of(problem, "friction"))
    yield from _entries_in(problem.body, "body", _field_of(problem, "body"))
    for name in LOADING:
        declared, value = quantities_of(type(problem))[name], getattr(problem, name)
        varies = isinstance(value, LoadingHistory)
        yield Entry(f"loading.{name}", declared, None if varies else value, _field_of(problem, name))
        if varies:
            yield from _entries_in(value, f"loading.{name}", _field_of(problem, name), {VARYING: declared.unit})
    yield from _of_start(problem)


def _of_start(problem: Problem) -> Iterator[Entry]:
    """Yield the entries of the start. An initial load replaces an initial excess, and an excess a load."""
    declared = quantities_of(type(problem))
    yield Entry("initial.slip", declared["initial_slip"], problem.initial_slip, _field_of(problem, "initial_slip"))
    for name, other in (("load", "excess"), ("excess", "load")):
        one = replace(declared[f"initial_{name}"], unit=problem.load_unit)
        yield Entry(f"initial.{name}", one, getattr(problem, f"initial_{name}"), _instead(problem, name, other))
    given = dict(zip(STATE_NAMES, problem.given_states, strict=False))
    for name, state in zip(STATE_NAMES, problem.friction.states, strict=False):
        put = _field_of(problem, f"initial_{name}")
        yield Entry(f"initial.{name}", Quantity(state.unit, state.meaning), given.get(name), put)
    yield Entry("initial.rate", declared["initial_rate"], problem.initial_rate, _field_of(problem, "initial_rate"))


def _derived(problem: Problem) -> Iterator[Parameter]:
    """Yield the numbers that follow from others."""
    for name, other, value in (("load", "excess", problem.load), ("excess", "load", problem.excess)):
        declared = replace(quantities_of(type(problem))[f"initial_{name}"], unit=problem.load_unit)
        yield Parameter(f"initial.{name}", value, declared, _instead(problem, name, other))
    yield Parameter(PRESSING, problem.normal, pressing_of(problem), lambda value: pressed(problem, value))


def normal_field(problem: Problem) -> str:
    """Return the name of the body's field that holds the normal load."""
    return "normal_stress" if problem.body.has_waves else "normal_force"


def pressing_of(problem: Problem) -> Quantity:
    """Return the declaration of `PRESSING`."""
    name = normal_field(problem)
    meaning = f"{name.replace('_', ' ')}, with the initial load and the far stress in proportion"
    return replace(quantities_of(type(problem.body))[name], meaning=meaning)


def pressed(problem: Problem, value: float) -> Problem:
    """Return a problem with another normal load (Pa or N), at the same ratios of initial load and far stress to it.

    Raises InputError if the problem does not allow the value.
    """
    factor = value / problem.normal
    body = replace(problem.body, **{normal_field(problem): value})
    changes = {name: getattr(problem, name) for name in ("initial_load", "initial_excess", *STRESSES)}
    scaled = {name: _scaled(one, factor) for name, one in changes.items() if one is not None}
    return replace(problem, body=body, **scaled)


def _scaled(value: Any, factor: float) -> Any:
    """Return a number, or a loading history, times a factor."""
    if not isinstance(value, LoadingHistory):
        return factor * value
    fields = {}
    for name, (declared, _) in fields_of(type(value)).items():
        one = getattr(value, name)
        if isinstance(declared, Series) and declared.item.unit == VARYING:
            fields[name] = tuple(factor * x for x in one)
        elif isinstance(declared, Quantity) and declared.unit == VARYING:
            fields[name] = factor * one
    return replace(value, **fields)  # type: ignore[type-var] # every history is a dataclass


def _entries_in(owner: Any, place: str, put: Callable[[Any], Problem], units: Mapping[str, str] | None = None) -> Iterator[Entry]:
    """Yield the entries of a body, a law or a loading history; `units` are as for `in_units`."""
    for name, (given, _) in fields_of(type(owner)).items():
        declared, value = in_units(given, units or {}), getattr(owner, name)
        if isinstance(declared, Quantity | Choice):
            yield Entry(f"{place}.{name}", declared, value, _in_field(owner, name, put))
        elif isinstance(declared, Series) and value:
            for i, one in enumerate(value):
                yield Entry(f"{place}.{name}[{i}]", declared.item, one, _in_series(owner, name, i, put))
        elif isinstance(declared, NamedNumbers):
            for i, one in enumerate(value):
                number = Quantity(one.unit or "1", "parameter of the formula")
                yield Entry(f"{place}.{declared.key}.{one.name}", number, one.value, _in_names(owner, name, i, put), one.unit)
        elif isinstance(declared, Part):
            yield from _entries_in(value, f"{place}.{name}", _in_field(owner, name, put))


def _field_of(problem: Problem, name: str) -> Callable[[Any], Problem]:
    return lambda value: replace(problem, **{name: value})


def _instead(problem: Problem, name: str, other: str) -> Callable[[Any], Problem]:
    return lambda value: replace(problem, **{f"initial_{name}": value, f"initial_{other}": None})


def law_with(law: Any, values: Mapping[str, float]) -> Any:
    """Return a friction law with other values (SI) of its numbers, by names such as "friction.alpha". Raises InputError."""
    for name, value in values.items():
        law = next(one for one in _entries_in(law, "friction", lambda law: law) if one.name == name).put(value)
    return law


def with_numbers(owner: Owner, numbers: Mapping[str, Any]) -> Owner:
    """Return a body, law or problem with other numbers, which may be arrays and are not checked."""
    made = object.__new__(type(owner))  # without what the owner remembers that follows from its numbers
    vars(made).update({one.name: getattr(owner, one.name) for one in fields(cast(Any, owner))} | dict(numbers))
    return made


def _in_field(owner: Any, name: str, put: Callable[[Any], Problem]) -> Callable[[Any], Problem]:
    return lambda value: put(replace(owner, **{name: value}))


def _in_series(law: Any, name: str, i: int, put: Callable[[Any], Problem]) -> Callable[[float], Problem]:
    values = getattr(law, name)
    return lambda value: put(replace(law, **{name: (*values[:i], value, *values[i + 1 :])}))


def _in_names(law: Any, name: str, i: int, put: Callable[[Any], Problem]) -> Callable[[float], Problem]:
    values = getattr(law, name)
    return lambda value: put(replace(law, **{name: (*values[:i], values[i]._replace(value=value), *values[i + 1 :])}))
