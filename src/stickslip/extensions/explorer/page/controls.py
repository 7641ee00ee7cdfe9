"""The controls of the page: what is entered changes the setting, and faults are shown at the field that is wrong."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import cache
from typing import Any, NamedTuple

from stickslip.extensions.explorer.model.controls import Control, ControlGroup, controls_of
from stickslip.extensions.explorer.model.exchange import with_kind
from stickslip.extensions.explorer.model.setting import FIRST_SCENARIO, Setting
from stickslip.extensions.explorer.page.components import ControlRows, finite
from stickslip.extensions.explorer.page.explorer import Explorer
from stickslip.figures.names import symbol
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import GREEK, for_readers
from stickslip.friction import FromExpression
from stickslip.friction.formula import RESERVED
from stickslip.problem.scenarios import library


class Offered(NamedTuple):
    """A scenario to choose: its section, its name, its title, and one sentence on its purpose."""

    section: str
    name: str
    title: str
    description: str


def faults() -> list[str]:
    """Return the names of the bundled scenarios of faults in 2D."""
    others = (name for name in library.names() if name not in library.in_1d())
    return [name for name in others if Setting.bundled(name).value("contact.width") is None]


@cache
def offered() -> tuple[Offered, ...]:
    """Return all bundled scenarios in 1D in the order of the menu: by their trade, first that of the first one."""
    entries, known = library.entries(), library.in_1d()
    trades = sorted(library.by_trade().items(), key=lambda one: FIRST_SCENARIO not in one[1])
    found = ((name, entries[name]) for _, names in trades for name in names if name in known)
    return tuple(Offered(one.trade, name, one.title, one.description) for name, one in found)


FAULT = re.compile(r"\[(?P<table>[\w.]+)\] (?P<key>\w+)")
"""Where a message says which entry is wrong, as in "[friction] alpha must be at least 0"."""
SYMBOL = re.compile(r"\$\\?(?P<letter>\w+?)(_\{(?P<index>\w+)\})?\$")
"""A symbol in mathtext, such as "$\\mu_{S}$"."""
SCENARIO, KIND = "scenario", "kind:"
"""The path of the list of scenarios, and what the paths of lists of kinds begin with, before their table."""
STARTS = {"excess": "excess over the static strength", "load": "load", "steady": "steady sliding"}
"""Names of the ways to give the load of the start."""
HELD = ("text", "value", "range")
"""The parts of a row that change with its value."""
Row = dict[str, Any]


class Controls:
    """All controls of one page. `view` is what is placed on it."""

    def __init__(self, explorer: Explorer) -> None:
        self._explorer, self._entered = explorer, ""
        self.view = ControlRows(self._enter, sizing_mode="stretch_width")
        explorer.listen("setting", self._show)
        explorer.listen("fault", self._blame)
        self._show()

    def _show(self) -> None:
        self._controls = controls_of(self._explorer.setting)
        groups, values = groups_of(self._explorer.setting, self._controls)
        if groups != self.view.groups:  # param compares much more slowly
            self.view.groups = groups
        self.view.values = values

    def _blame(self) -> None:
        """Show the fault at the row that it names, or else at the row of the last entry."""
        fault, found = self._explorer.fault, FAULT.search(self._explorer.fault)
        path = f"{found['table']}.{found['key']}" if found else self._entered
        self.view.faults = {path: fault} if fault else {}

    def _enter(self, entered: dict[str, Any]) -> None:
        self._entered = str(entered.get("path"))
        try:
            setting = changed(self._explorer.setting, self._controls, entered)
        except InputError as error:
            self._explorer.refuse(str(error))
            return
        self._explorer.change(setting)


def changed(setting: Setting, controls: Iterable[ControlGroup], entered: dict[str, Any]) -> Setting:
    """Return a setting with the entry in one row: a number of its slider, the text of its field, or a choice.

    Raises InputError, in one line, for an entry that cannot be read.
    """
    path, value = str(entered.get("path")), entered.get("value", entered.get("text"))
    if path == SCENARIO:
        return Setting.bundled(str(value))
    if path.startswith(KIND):
        return with_kind(setting, path.removeprefix(KIND), str(value))
    control = next((one for group in controls for one in group.controls if one.path == path), None)
    if control is None:
        raise InputError(f"{path} is not an entry of this scenario")
    if (number := finite(value)) is not None:
        return setting.with_value(path, control.entry(number * control.size))
    if path == "friction.expression":
        return with_expression(setting, control.read(str(value)))
    return setting.with_value(path, control.read(str(value)))


def groups_of(setting: Setting, controls: Iterable[ControlGroup]) -> tuple[list[dict[str, Any]], dict[str, Row]]:
    """Return groups of rows for a setting, and what the rows hold, as the script of the controls takes them.

    What a row holds is apart, because a slider that moves changes nothing else. The first row is the choice of the scenario.
    """
    groups = [_scenarios(setting), *({"title": group.title, "rows": rows_of(group)} for group in controls)]
    return groups, {row["path"]: {name: row.pop(name) for name in HELD} for group in groups for row in group["rows"]}


def _scenarios(setting: Setting) -> dict[str, Any]:
    options = [{"value": one.name, "label": one.title, "group": one.section} for one in offered()]
    if setting.is_fault:
        options = [{"value": name, "label": library.entries()[name].title, "group": ""} for name in faults()]
    if setting.name not in {one["value"] for one in options}:
        options.insert(0, {"value": setting.name, "label": setting.name, "group": ""})
    row = {"path": SCENARIO, "label": "scenario", "kind": "choice", "options": options, "text": setting.name}
    return {"title": "Scenario", "rows": [_whole(row)]}


def rows_of(group: ControlGroup) -> list[Row]:
    """Return the rows of one table: its kind, if it can be chosen, and its entries."""
    rows = []
    if group.kinds:
        options = [{"value": kind, "label": STARTS.get(kind, kind.replace("-", " "))} for kind in group.kinds]
        rows.append(_whole({"path": KIND + group.table, "label": "kind", "kind": "choice", "options": options, "text": group.kind}))
    return [*rows, *(_row(control) for control in group.controls)]


def _row(control: Control) -> Row:
    letter, index = symbol_of(control)
    row: Row = {
        "path": control.path, "kind": control.kind, "text": control.shown, "rare": control.rare, "help": control.meaning,
        "label": "" if control.label in (*GREEK, letter) else control.label, "letter": letter, "index": index,
        "empty": control.empty,
        "options": [{"value": choice, "label": choice.replace("-", " ")} for choice in control.choices],
        "unit": spelled(control.unit),
    }  # fmt: skip
    if control.slider is not None and not isinstance(control.value, str | tuple):
        value = control.value if control.value is not None and math.isfinite(control.value) else control.slider.high
        low, high, log = control.slider
        ends = {"low": float(low) / control.size, "high": float(high) / control.size, "log": log, "whole": control.kind == "whole"}
        row |= {"value": float(value) / control.size, "range": ends}
    return _whole(row)


def _whole(row: Row) -> Row:
    """Return a row with every key that the script reads."""
    empty = {
        "unit": "",
        "help": "",
        "letter": "",
        "index": "",
        "empty": "",
        "rare": False,
        "value": 0.0,
        "range": None,
        "options": [],
    }
    return empty | row


def symbol_of(control: Control) -> tuple[str, str]:
    """Return the symbol of an entry and its index, such as "μ" and "S"; both "" if its meaning has none."""
    if control.path.startswith("contact."):
        return "", ""
    found = SYMBOL.fullmatch(symbol(control.path, control.declared.meaning if control.declared else ""))
    return (GREEK.get(found["letter"], found["letter"]), found["index"] or "") if found else ("", "")


def spelled(unit: str) -> str:
    """Return a unit as readers expect to see it."""
    unit = for_readers(unit)
    return re.sub(r"\bu(?=[mNPs])", "µ", unit).replace("/ m", "1/m") if unit.startswith(("u", "/")) else unit


_NAME_IN_FORMULA = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
"""A name in a formula; the e of 1e-3 is none."""


def with_expression(setting: Setting, text: str) -> Setting:
    """Return a setting whose friction law is a formula in u (slip, m), v (slip rate, m/s) and parameters.

    Parameters that the setting already has keep their values, new ones are 1, and those that the formula no longer names go.
    Whether the formula is allowed turns out when the scenario is read.
    """
    if setting.value("friction.kind") != FromExpression.kind:
        setting = with_kind(setting, "friction", FromExpression.kind)
    known = setting.value("friction.parameters") or {}
    names = dict.fromkeys(name for name in _NAME_IN_FORMULA.findall(text) if name not in RESERVED)
    parameters = {name: known.get(name, 1.0) for name in names}
    return setting.with_value("friction.expression", text).with_value("friction.parameters", parameters or None)
