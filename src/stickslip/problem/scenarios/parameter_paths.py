"""The parameters of a scenario, named by their place in the file, and scenarios with other values for some of them.

The names of the problem's numbers are those of `problem.parameters`, "pressing" among them; to them come those of [run] and of
the tables of extensions. The last part of a name ("thickness") is sufficient if it is unambiguous.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from stickslip.extension import tables
from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.names import short_units
from stickslip.foundation.quantities import Choice, Quantity
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem.fields import MAY_VARY, STEADY
from stickslip.problem.parameters import PRESSING, entries_of, pressed, pressing_of
from stickslip.problem.problem import Problem
from stickslip.problem.run_options import EVENTS_WANTED
from stickslip.problem.scenarios.entries import Source
from stickslip.problem.scenarios.scenario import Scenario, scenario_of
from stickslip.problem.scenarios.schema import SOFT_TORQUE, WITH_SOFT_TORQUE, quantities_in, without_owner
from stickslip.problem.selection_rule import names as rules

EVENTS = Quantity("1", EVENTS_WANTED.meaning, at_least=1)
SELECTION = "selection rule"
PARAMETERS_LISTED = "`stickslip check SCENARIO --parameters` lists all"
"""Where all parameters are."""
YES_OR_NO = Choice("true or false", ("true", "false"))
EXCLUDE_EACH_OTHER = {"initial.load": "excess", "initial.excess": "load"}
"""A scenario has either an initial load or an initial excess. The one that is given another value replaces the other."""
MAY_BE_STEADY = ("initial.rate", *(f"initial.{name}" for name in STATE_NAMES))
"""Parameters for which "steady" stands for steady sliding; as initial rate it takes the place of load and states, too."""
TABLES_OF_TEXT = (".csv", ".tsv", ".txt", ".dat")
"""How names of files end that have what varies in time."""
_STEP = re.compile(r"(?P<name>[^\[]+)(?:\[(?P<index>\d+)\])?")


@dataclass(frozen=True)
class ParameterPath:
    """A parameter of a scenario: its place in the file, and its declaration as a quantity or as one of several words."""

    name: str
    declared: Quantity | Choice
    written: str = ""
    """Unit that follows the number in the scenario file (only parameters of an expression have one)."""
    shown_in: str = ""
    """Unit in which its values are shown, because they were given in it; "" for a readable one."""
    counts: bool = False
    """True if its values are whole numbers."""

    @property
    def unit(self) -> str:
        """The SI unit: "1" for a pure number, "" for words."""
        return self.declared.unit if isinstance(self.declared, Quantity) else ""

    def read(self, value: Any, where: str) -> float | str:
        """Return a value in SI, from a number (SI), a text with a unit, or a word.

        Raises InputError, whose message begins with `where`.
        """
        value = value.strip() if isinstance(value, str) else value
        if value == STEADY and self.name in MAY_BE_STEADY:
            return STEADY
        value = str(value).lower() if isinstance(value, bool) and self.declared == YES_OR_NO else value
        try:
            return self.declared.check(where, self.name, value)
        except InputError as error:
            if not (self.name.removeprefix("loading.") in MAY_VARY and isinstance(value, str) and value.endswith(TABLES_OF_TEXT)):
                raise
            given = f'[{self.name}] kind = "piecewise-linear", file = "{value}"'
            raise InputError(f"{error}; a file is named in the scenario: {given}") from None

    def put(self, document: dict[str, Any], value: float | str) -> None:
        """Write a value (SI) into the document of a scenario, in place of the one that is there."""
        owner, key = place_of(self.name, document)
        if self.written:
            owner[key] = f"{value!r} {self.written}"
        elif self.declared == YES_OR_NO:
            owner[key] = value == "true"
        else:
            owner[key] = int(value) if self.counts and isinstance(value, float) and value.is_integer() else value


def place_of(name: str, document: Any) -> tuple[Any, Any]:
    """Return the table or list in a document that has a value with this name, and its key or index there."""
    step, dot, rest = name.partition(".")
    found = _STEP.fullmatch(step)
    if found is None or name in document:
        return document, name
    if not dot:
        return (document[found["name"]], int(found["index"])) if found["index"] else (document, step)
    inner = document[found["name"]]
    return place_of(rest, inner[int(found["index"])] if found["index"] else inner)


def find_parameter(scenario: Scenario, name: str, where: str) -> ParameterPath:
    """Return the parameter with this name, or whose name ends with it. Raises InputError if none fits, or several do."""
    table = name.partition(".")[0]
    if (owner := scenario.lacks.get(table)) is not None:
        raise InputError(f"{where}: {name}: a scenario with a [{owner}] has no [{table}]; {PARAMETERS_LISTED}")
    plain = next((one for one in entries_of(scenario.problem) if one.name == name), None)
    if plain is not None:
        return ParameterPath(plain.name, plain.declared, plain.written)
    found = {parameter.name: parameter for parameter in parameter_paths(scenario)}
    return found[full_name(name, found, f"{where}: ", "is not a parameter of this scenario", PARAMETERS_LISTED)]


Changes = Sequence[tuple[ParameterPath, Any]]
"""Parameters with other values (SI)."""


def document_with(scenario: Scenario, changes: Changes, where: str) -> dict[str, Any]:
    """Return the document of a scenario, in SI, with other values of parameters.

    Raises InputError, which begins with `where`, if two of them exclude each other.
    """
    _check_together(scenario, changes, where)
    pressing = next((value for parameter, value in changes if parameter.name == PRESSING), None)
    document: dict[str, Any] = _copied((scenario if pressing is None else _pressed(scenario, pressing)).document)
    _put(document, [one for one in changes if one[0].name != PRESSING])
    return document


def _copied(document: Any) -> Any:
    """Return a copy of a document, whose tables and lists may be changed."""
    if isinstance(document, dict):
        return {name: _copied(value) for name, value in document.items()}
    return [_copied(value) for value in document] if isinstance(document, list) else document


def put_into(document: Mapping[str, Any], scenario: Scenario, changes: Changes, where: str) -> dict[str, Any]:
    """Return the document of a scenario as somebody wrote it, with other values, and all else as it was written.

    What the document leaves out, keeps in a file of its own, or has in several places needs the scenario's whole text, in SI.
    Raises InputError as `document_with` does.
    """
    _check_together(scenario, changes, where)
    found: dict[str, Any] = _copied(dict(document))
    try:
        _put(found, changes)
    except KeyError:
        return document_with(scenario, changes, where)
    return found


def _check_together(scenario: Scenario, changes: Changes, where: str) -> None:
    names = {parameter.name for parameter, _ in changes}
    for one, other in (("initial.load", "initial.excess"), (PRESSING, f"body.{scenario.problem.body.normal_field}")):
        if {one, other} <= names:
            raise InputError(f"{where}: {one} and {other} exclude each other: give one of them")


def _put(document: dict[str, Any], changes: Changes) -> None:
    """Write values into a document. Raises KeyError if it has no place for one."""
    for parameter, value in changes:
        if parameter.name == PRESSING:
            raise KeyError(PRESSING)
        document.get("initial", {}).pop(EXCLUDE_EACH_OTHER.get(parameter.name), None)
        if parameter.name == "initial.rate" and value == STEADY:
            for excluded in ("load", "excess", *STATE_NAMES):
                document["initial"].pop(excluded, None)
        parameter.put(document, value)


def _pressed(scenario: Scenario, value: float) -> Scenario:
    """Return a scenario with another normal load, and all loads that it gives in proportion."""
    factor = value / scenario.problem.normal
    others = tuple((name, tables()[name].pressed(one, factor)) for name, one in scenario.tables)
    return replace(scenario, problem=pressed(scenario.problem, value), tables=others)


def with_values(scenario: Scenario, values: Mapping[str, Any], where: str) -> Scenario:
    """Return a scenario with other values of some parameters, as `Scenario.with_values` does; `where` begins messages."""
    changes, texts = [], []
    soft = next((name for name in (SOFT_TORQUE, f"body.{SOFT_TORQUE}") if name in values), "")
    if soft and hasattr(scenario.problem.body, WITH_SOFT_TORQUE):
        scenario = _softened(scenario, values[soft], where)
        texts, values = [f"{soft} = {values[soft]}"], {name: value for name, value in values.items() if name != soft}
    for name, value in values.items():
        parameter = find_parameter(scenario, name, where)
        changes.append((parameter, parameter.read(value, where)))
        texts.append(f"{name} = {_said_back(parameter, value)}")
    changed = ", ".join(texts)
    title = f"{scenario.heading}: {changed}" if scenario.heading else changed
    return replace(
        scenario_of(document_with(scenario, changes, where), Source(where)), name=scenario.name, title=title, description=""
    )


def _softened(scenario: Scenario, setting: Any, where: str) -> Scenario:
    """Return a scenario with another setting of its drive, in place of its gains. Raises InputError."""
    problem = scenario.problem
    try:
        body = problem.body.with_soft_torque(setting)  # type: ignore[attr-defined] # as the caller has seen
    except InputError as error:
        raise InputError(f"{where}: {without_owner(error)}") from None
    return replace(scenario, problem=replace(problem, body=body))


def _said_back(parameter: ParameterPath, value: Any) -> Any:
    """Return a value as it was given. A plain number for what turns gets its unit: few would guess that it is read in rad/s."""
    if isinstance(value, float) and parameter.unit in ("rad", "rad/s"):
        ((unit, size),) = short_units(parameter.unit)
        return f"{value:g} {parameter.unit} ({value / size:.5g} {unit})"
    return int(value) if parameter.counts and isinstance(value, float) and value.is_integer() else value


def values_in(scenario: Scenario) -> Iterator[tuple[ParameterPath, Any]]:
    """Yield every parameter that has a value in the file of a scenario, with the value (SI)."""
    for one in parameter_paths(scenario):
        owner, key = place_of(one.name, scenario.document)
        if (isinstance(key, int) or key in owner) and not isinstance(owner[key], Mapping):  # a history in place of a number
            yield one, one.read(owner[key], scenario.name)


def parameter_paths(scenario: Scenario) -> Iterator[ParameterPath]:
    """Yield every parameter, in the order of the scenario file."""
    problem = scenario.problem
    ours = [ParameterPath(one.name, one.declared, one.written) for one in entries_of(problem)]
    for table in ("body", "friction", "loading", "initial"):
        if table in scenario.lacks:
            continue
        yield from (one for one in ours if one.name.startswith(f"{table}."))
        if table == "loading" and scenario.is_of_core:
            yield ParameterPath("loading.one_way", YES_OR_NO)
    if "body" not in scenario.lacks:
        yield ParameterPath(PRESSING, pressing_of(problem))
    allowed = scenario.run_keys
    for name, declared in _in_run().items():
        if allowed is None or name in allowed:
            yield ParameterPath(f"run.{name}", declared, counts=name == "events")
    for table, value in scenario.tables:
        of, whole = tables()[table], tables()[table].whole()
        for place, entry in of.paths(value, problem):
            yield ParameterPath(f"{table}.{place}", entry, counts=place in whole)


def _in_run() -> dict[str, Quantity | Choice]:
    quantities: dict[str, Quantity | Choice] = {name: declared for name, (declared, _) in quantities_in("run", Problem).items()}
    return quantities | {"events": EVENTS, "selection": Choice(SELECTION, tuple(rules()))}
