"""The parameters of a scenario, named by their place in the file, and scenarios in which some of them have other values.

Every quantity is one: "body.thickness", "friction.slip.mean", "run.rtol". The last part of a name ("thickness") is
sufficient if it is unambiguous. One element of a series is written "friction.values[2]".
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from stickslip.foundation.errors import full_name
from stickslip.foundation.quantities import Choice, NamedNumbers, Part, Quantity, Series, fields_of, quantities_of
from stickslip.planar.nodes import varying
from stickslip.problem.problem import Problem
from stickslip.problem.run_quantities import DURATION
from stickslip.problem.selection_rule import names as rules
from stickslip.scenarios.contact import LOCKED, Contact
from stickslip.scenarios.contact_table import PLACES, TAPER
from stickslip.scenarios.entries import Source, key_of
from stickslip.scenarios.scenario import Scenario, scenario_of
from stickslip.scenarios.schema import entries_in

EVENTS = Quantity("1", "stop after this number of slip events", at_least=1)
SELECTION = "selection rule"
YES_OR_NO = Choice("true or false", ("true", "false"))
WHOLE = ("run.events", "contact.nodes", "contact.width_nodes", "contact.frames")
"""Parameters that count."""
EXCLUDE_EACH_OTHER = {"initial.load": "excess", "initial.excess": "load"}
"""A scenario has either an initial load or an initial excess. The one that is given another value replaces the other."""
_STEP = re.compile(r"(?P<name>[^\[]+)(?:\[(?P<index>\d+)\])?")


@dataclass(frozen=True)
class ParameterPath:
    """A parameter of a scenario: its place in the file, and its declaration as a quantity or as one of several words."""

    name: str
    declared: Quantity | Choice
    written: str = ""
    """Unit that follows the number in the scenario file (only parameters of an expression have one)."""

    @property
    def unit(self) -> str:
        """The SI unit: "1" for a pure number, "" for words."""
        return self.declared.unit if isinstance(self.declared, Quantity) else ""

    def read(self, value: Any, where: str) -> float | str:
        """Return a value in SI, from a number (SI), a text with a unit, or a word.

        Raises InputError, whose message begins with `where`.
        """
        value = value.strip() if isinstance(value, str) else value
        value = str(value).lower() if isinstance(value, bool) and self.declared is YES_OR_NO else value
        return self.declared.check(where, self.name, value)

    def put(self, document: dict[str, Any], value: float | str) -> None:
        """Write a value (SI) into the document of a scenario, in place of the one that is there."""
        owner, key = _place_of(self.name, document)
        if self.written:
            owner[key] = f"{value!r} {self.written}"
        elif self.declared is YES_OR_NO:
            owner[key] = value == "true"
        else:
            whole = self.name in WHOLE and isinstance(value, float) and value.is_integer()
            owner[key] = int(value) if whole else value


def _place_of(name: str, document: Any) -> tuple[Any, Any]:
    """Return the table or list in a document that has a value with this name, and its key or index there."""
    step, dot, rest = name.partition(".")
    found = _STEP.fullmatch(step)
    if found is None or name in document:
        return document, name
    if not dot:
        return (document[found["name"]], int(found["index"])) if found["index"] else (document, step)
    inner = document[found["name"]]
    return _place_of(rest, inner[int(found["index"])] if found["index"] else inner)


def find_parameter(scenario: Scenario, name: str, where: str) -> ParameterPath:
    """Return the parameter with this name, or whose name ends with it. Raises InputError if none fits, or several do."""
    found = {parameter.name: parameter for parameter in parameter_paths(scenario)}
    return found[full_name(name, found, f"{where}: ", "is not a parameter of this scenario")]


def with_values(scenario: Scenario, values: Mapping[str, Any], where: str) -> Scenario:
    """Return a scenario in which some parameters have other values, as `Scenario.with_values` does; `where` begins messages."""
    document, texts = tomllib.loads(scenario.to_toml()), []
    for name, value in values.items():
        parameter = find_parameter(scenario, name, where)
        document["initial"].pop(EXCLUDE_EACH_OTHER.get(parameter.name), None)
        parameter.put(document, parameter.read(value, where))
        counts = parameter.name in WHOLE and isinstance(value, float) and value.is_integer()
        texts.append(f"{name} = {int(value) if counts else value}")
    changed = ", ".join(texts)
    title = f"{scenario.heading}: {changed}" if scenario.heading else changed
    return replace(scenario_of(document, Source(where)), name=scenario.name, title=title, description="")


def values_in(scenario: Scenario) -> Iterator[tuple[ParameterPath, Any]]:
    """Yield every parameter that has a value in the file of a scenario, with the value (SI)."""
    document = tomllib.loads(scenario.to_toml())
    for one in parameter_paths(scenario):
        owner, key = _place_of(one.name, document)
        if isinstance(key, int) or key in owner:
            yield one, owner[key]


def parameter_paths(scenario: Scenario) -> Iterator[ParameterPath]:
    """Yield every parameter, in the order of the scenario file."""
    problem = scenario.problem
    yield from _paths_in(problem.body, "body")
    yield from _paths_in(problem.friction, "friction")
    tables = ("loading", "initial") if scenario.contact is not None else ("loading", "initial", "run")
    for table in tables:
        for name, (declared, _) in entries_in(table, type(problem.body), problem.friction.states).items():
            if isinstance(declared, Quantity) and (f"{table}.{name}" != "initial.rate" or problem.has_initial_rate):
                yield ParameterPath(f"{table}.{name}", declared)
    if scenario.contact is not None:
        yield ParameterPath("run.duration", DURATION)
        yield from _paths_in_contact(scenario.contact, problem)
        return
    yield ParameterPath("run.events", EVENTS)
    yield ParameterPath("run.selection", Choice(SELECTION, tuple(rules())))


def _paths_in_contact(contact: Contact, problem: Problem) -> Iterator[ParameterPath]:
    """Yield the sizes of a contact, and the numbers of its patches."""
    for name, declared in quantities_of(Contact).items():
        yield ParameterPath(f"contact.{name}", declared)
    yield ParameterPath("contact.replicas", YES_OR_NO)
    units = {name: declared for name, (declared, _) in varying(problem).items()}
    for i, patch in enumerate(contact.patches):
        place, values = f"contact.patches[{i}]", [name for name, _ in patch.values if name != LOCKED]
        for axis, declared in PLACES.items():
            yield from (ParameterPath(f"{place}.{axis}[{j}]", declared) for j in range(len(getattr(patch, axis) or ())))
        yield from (ParameterPath(f"{place}.{name}", units[name]) for name in values)
        if values:
            yield ParameterPath(f"{place}.taper", TAPER)


def _paths_in(owner: Any, place: str) -> Iterator[ParameterPath]:
    """Yield the parameters of a body or a law, and of the laws inside it."""
    for name, (declared, _) in fields_of(type(owner)).items():
        path, value = f"{place}.{key_of(name, declared)}", getattr(owner, name)
        if isinstance(declared, Quantity | Choice):
            yield ParameterPath(path, declared)
        elif isinstance(declared, Part):
            yield from _paths_in(value, path)
        elif isinstance(declared, Series):
            yield from (ParameterPath(f"{path}[{i}]", declared.item) for i in range(len(value)))
        elif isinstance(declared, NamedNumbers):
            yield from (ParameterPath(f"{path}.{one.name}", Quantity(one.unit or "1", declared.meaning), one.unit) for one in value)
