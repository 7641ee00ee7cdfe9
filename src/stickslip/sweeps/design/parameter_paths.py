"""The parameters of a scenario that a sweep can vary, named by their place in the file.

Every quantity can be varied: "body.thickness", "friction.slip.mean", "run.rtol". The last part of a name ("thickness") is
sufficient if it is unambiguous. One element of a series is written "friction.values[2]".
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Choice, NamedNumbers, Part, Quantity, Series, fields_of
from stickslip.problem.selection_rule import names as rules
from stickslip.scenarios.entries import key_of
from stickslip.scenarios.scenario import Scenario
from stickslip.scenarios.schema import entries_in
from stickslip.scenarios.values import read_quantity, show

EVENTS = Quantity("1", "stop after this number of slip events", at_least=1)
SELECTION = "selection rule"


@dataclass(frozen=True)
class Key:
    """A parameter of a scenario: its place in the file, and its declaration as a quantity or as one of several words."""

    name: str
    declared: Quantity | Choice
    written: str = ""
    """Unit that follows the number in the scenario file (only parameters of an expression have one)."""

    @property
    def unit(self) -> str:
        """Return the SI unit: "1" for a pure number, "" for words."""
        return self.declared.unit if isinstance(self.declared, Quantity) else ""

    @property
    def meaning(self) -> str:
        """Return the meaning of the parameter in words."""
        return self.declared.meaning

    def read(self, value: Any, where: str) -> float | str:
        """Read a value: a number (SI), a text with or without a unit, or a word. Returns it in SI.

        Raises InputError, whose message begins with `where`.
        """
        if isinstance(self.declared, Choice):
            return self.declared.check(where, self.name, value.strip() if isinstance(value, str) else value)
        return read_quantity(_number(value), self.declared, where, self.name)


def _number(value: Any) -> Any:
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            return value.strip()
    return value.item() if hasattr(value, "item") else value


def key_named(scenario: Scenario, name: str, where: str) -> Key:
    """Return the key with this name, or whose name ends with it. Raises InputError if no key fits, or several do."""
    found = {key.name: key for key in keys_of(scenario)}
    if name in found:
        return found[name]
    fitting = [full for full in found if full.endswith(f".{name}")]
    if len(fitting) > 1:
        raise InputError(f"{where}: '{name}' is ambiguous: give one of {', '.join(fitting)}")
    if not fitting:
        short = nearest(name, [full.rpartition(".")[2] for full in found if "[" not in full])
        hint = short if short.startswith("did") and "." not in name else nearest(name, [full for full in found if "[" not in full])
        raise InputError(f"{where}: {show(name)} is not a parameter of this scenario; {hint}")
    return found[fitting[0]]


def keys_of(scenario: Scenario) -> Iterator[Key]:
    """Yield every key that can be varied, in the order of the scenario file."""
    problem = scenario.problem
    yield from _of(problem.body, "body")
    yield from _of(problem.friction, "friction")
    for table in ("loading", "initial", "run"):
        for name, (declared, _) in entries_in(table, type(problem.body), problem.friction.state).items():
            if isinstance(declared, Quantity):
                yield Key(f"{table}.{name}", declared)
    yield Key("run.events", EVENTS)
    yield Key("run.selection", Choice(SELECTION, tuple(rules())))


def _of(owner: Any, place: str) -> Iterator[Key]:
    for name, (declared, _) in fields_of(type(owner)).items():
        key, value = f"{place}.{key_of(name, declared)}", getattr(owner, name)
        if isinstance(declared, Quantity | Choice):
            yield Key(key, declared)
        elif isinstance(declared, Part):
            yield from _of(value, key)
        elif isinstance(declared, Series):
            yield from (Key(f"{key}[{i}]", declared.item) for i in range(len(value)))
        elif isinstance(declared, NamedNumbers):
            yield from (Key(f"{key}.{one.name}", Quantity(one.unit or "1", declared.meaning), one.unit) for one in value)
