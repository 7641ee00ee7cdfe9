"""Find a number of a problem by its name, such as "friction.alpha", "friction.rate.alpha", "body.normal_stress", "initial.slip".

A name is the place of the number in a scenario file, with [i] for the entry i of a series. The end of a name, such as "alpha", is
enough if only one name ends with it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.formatting import brief
from stickslip.foundation.quantities import NamedNumbers, Part, Quantity, Series, fields_of, quantities_of

if TYPE_CHECKING:
    from stickslip.problem.problem import Problem


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
    """The numbers of a problem by name, those that are None left out: of the friction law and its parts, of the body, of the start.

    `parameters["alpha"]` finds "friction.alpha" if no other name ends with ".alpha". It raises InputError if the name fits no
    number, or several.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem

    @cached_property
    def _found(self) -> dict[str, Parameter]:
        return {one.name: one for one in _of_problem(self._problem)}

    def __getitem__(self, name: str) -> Parameter:
        if not isinstance(name, str):
            raise InputError(f'parameters: a name must be text such as "friction.alpha", got {shown(name)}')
        return self._found[full_name(name, self._found, "parameter ", "is unknown")]

    def __contains__(self, name: object) -> bool:
        return name in self._found

    def __iter__(self) -> Iterator[str]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def __repr__(self) -> str:
        return "\n".join(f"{one.name} = {brief(one.value, one.unit)}" for one in self._found.values())


def _of_problem(problem: Problem) -> Iterator[Parameter]:
    yield from _of_law(problem.friction, "friction", lambda law: replace(problem, friction=law))
    for name, declared in quantities_of(type(problem.body)).items():
        value = getattr(problem.body, name)
        if value is not None:
            put = _in_field(problem.body, name, lambda body: replace(problem, body=body))
            yield Parameter(f"body.{name}", value, declared, put)
    for name in ("initial_slip", "initial_rate"):
        if (value := getattr(problem, name)) is not None:
            yield Parameter(
                name.replace("_", "."), value, quantities_of(type(problem))[name], _in_field(problem, name, lambda p: p)
            )


def _of_law(law: Any, place: str, put: Callable[[Any], Problem]) -> Iterator[Parameter]:
    for name, (declared, _) in fields_of(type(law)).items():
        value = getattr(law, name)
        if isinstance(declared, Quantity) and value is not None:
            yield Parameter(f"{place}.{name}", value, declared, _in_field(law, name, put))
        elif isinstance(declared, Series) and value:
            for i, one in enumerate(value):
                yield Parameter(f"{place}.{name}[{i}]", one, declared.item, _in_series(law, name, i, put))
        elif isinstance(declared, NamedNumbers):
            for i, one in enumerate(value):
                number = Quantity(one.unit or "1", "parameter of the formula")
                yield Parameter(f"{place}.{declared.key}.{one.name}", one.value, number, _in_names(law, name, i, put))
        elif isinstance(declared, Part):
            yield from _of_law(value, f"{place}.{name}", _in_field(law, name, put))


def _in_field(owner: Any, name: str, put: Callable[[Any], Problem]) -> Callable[[Any], Problem]:
    return lambda value: put(replace(owner, **{name: value}))


def _in_series(law: Any, name: str, i: int, put: Callable[[Any], Problem]) -> Callable[[float], Problem]:
    values = getattr(law, name)
    return lambda value: put(replace(law, **{name: (*values[:i], value, *values[i + 1 :])}))


def _in_names(law: Any, name: str, i: int, put: Callable[[Any], Problem]) -> Callable[[float], Problem]:
    values = getattr(law, name)
    return lambda value: put(replace(law, **{name: (*values[:i], values[i]._replace(value=value), *values[i + 1 :])}))
