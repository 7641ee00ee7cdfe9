"""The controls of a setting, derived from the declared numbers of bodies, laws, loadings and runs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, dataclass, fields, replace
from functools import cached_property
from typing import Any, Literal

from stickslip.extension import tables
from stickslip.extensions.explorer.model.ranges import SliderRange, range_of
from stickslip.extensions.explorer.model.setting import CONTACT, Setting
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import si_unit
from stickslip.foundation.quantities import Choice, Count, Field, LawField, NamedNumbers, NumberSeries, Quantity, Text, fields_of
from stickslip.foundation.show import brief
from stickslip.foundation.units import split_quantity, to_si
from stickslip.friction import LAWS
from stickslip.friction.contract import STATE_NAMES, StateVariable
from stickslip.problem import ALL_HISTORIES, HISTORIES, HISTORIES_ONLY, SELECTION_RULES, STEADY, driver_of, names
from stickslip.problem.bodies import BODIES
from stickslip.problem.scenarios import (
    ONE_WAY,
    YES_OR_NO,
    ParameterPath,
    describe,
    entries_in,
    kind_of,
    library,
    typed_number,
)
from stickslip.problem.scenarios.parameter_paths import parameter_paths

ControlKind = Literal["number", "whole", "choice", "text", "points"]


def bodies_beside(kind: str) -> tuple[str, ...]:
    """Return the kinds of bodies for which one of a kind can be exchanged: those that slide, or those that turn."""
    slip = si_unit("slip", BODIES[kind].load_unit)
    return tuple(name for name, body in BODIES.items() if si_unit("slip", body.load_unit) == slip)


CONSTANT = "constant"
"""Kind of a pull rate that does not vary."""
STARTS, STARTS_IN_MOTION = ("excess", "load"), ("steady", "load")
"""How the load of the start is given, which takes the place of a kind: minus the static strength, or as it is."""
PARTS_OF_PATCH = {"y[0]": "from y", "y[1]": "to y", "taper": "taper"}
"""Names of the numbers of a patch."""
MUST_BE_0 = ("body.contact_mass", "body.contact_damping")
"""Numbers of a body that are 0 on a fault."""
RARE_IN_CONTACT = ("frames", "courant", "taper")
"""Numbers of a contact and its patches that are seldom changed."""
RARE = ("run.rtol", "run.creep_rtol", "run.shortest_event", "body.p_wave_speed", "run.events", "loading.far_stress_rate")
"""Numbers that are seldom changed: a page may hide them at first."""
TITLES_OF_TABLES: dict[str, str] = {"body": "Body", "friction": "Friction", "loading": "Loading", "initial": "Start", "run": "Run"}
EMPTY = {
    "initial.state": "needed",
    "initial.second_state": "needed",
    "initial.rate": "load and friction balance",
    "loading.far_stress": "the initial load",
    "run.creep_rtol": "automatic",
    "run.shortest_event": "automatic",
}
"""What an empty field of a number stands for that has neither a default nor need be given."""


def empty_of(path: str) -> str:
    """Return what an empty field of an optional number stands for."""
    if path == f"{CONTACT}.frames":
        from stickslip.extensions.planar import usual_frames

        return str(usual_frames())
    return EMPTY.get(path, "none")


PARTLESS = tuple(kind for kind, law in LAWS.items() if not any(isinstance(entry, LawField) for entry, _ in fields_of(law).values()))
"""Kinds of laws that may be a part of another law."""


@dataclass(frozen=True)
class Control:
    """One entry of a setting that can be changed: its path in the document, its name, and what it means with its allowed range.

    The kind "whole" is a number of events or an exponent, "points" a list of numbers. `value` is in SI; None stands for `empty`,
    such as "automatic", which is "" if the entry is needed. A field shows the number in `unit` ("" for a pure number), whose size
    in SI is `size`: shown = value / size. The ends (SI) of the `slider` do not follow it. An entry is `rare` if it is seldom
    changed.
    """

    path: str
    label: str
    meaning: str
    kind: ControlKind
    value: float | str | tuple[float, ...] | None
    unit: str = ""
    size: float = 1.0
    slider: SliderRange | None = None
    choices: tuple[str, ...] = ()
    empty: str = ""
    rare: bool = False
    declared: Field | None = None

    @property
    def shown(self) -> str:
        """The value as its field shows it: a number in `unit`, a word, points with commas, or "" if it is empty."""
        if self.value is None or isinstance(self.value, str):
            return self.value or ""
        if isinstance(self.value, tuple):
            return ", ".join(f"{one / self.size:.12g}" for one in self.value)
        if math.isinf(self.value) and isinstance(self.declared, Quantity):
            return self.declared.word
        return f"{self.value / self.size:.12g}"

    def entry(self, value: float) -> float | str:
        """Return what stands in the document for a number (SI) from the slider: in `unit`, as a person would write it."""
        if self.kind == "whole":
            return 2 * round(value / 2.0) if self.path.endswith("nodes") else round(value)
        return self._with_unit(float(f"{value / self.size:.12g}"))

    def read(self, typed: str) -> Any:
        """Return what stands in the document for a typed text; a number without a unit is one in `unit`.

        None stands for an empty field. Raises InputError, which begins with the label, for what is not allowed.
        """
        text = typed.strip()
        if not text and self.empty:
            return None
        if self.declared is YES_OR_NO:
            return text == "true"
        if self.kind in ("choice", "text"):
            return text
        if self.kind == "points":
            return [self._number(one) for one in text.replace(";", ",").split(",") if one.strip()]
        if isinstance(self.declared, Count):
            number = typed_number(text)
            whole = int(number) if isinstance(number, float) and number.is_integer() else number
            return self.declared.check(self.label, "number", whole)
        number = self._number(text)
        is_whole = self.kind == "whole" and self.path.startswith(CONTACT) and isinstance(number, float) and number.is_integer()
        return int(number) if is_whole else number

    def _number(self, text: str) -> float | str:
        declared = self.declared.item if isinstance(self.declared, NumberSeries) else self.declared
        given = typed_number(text)
        entry = self._with_unit(given) if isinstance(given, float) and math.isfinite(given) else given
        if isinstance(declared, Quantity):
            declared.check(self.label, "it", entry)
        return entry

    def _with_unit(self, number: float) -> float | str:
        return f"{number!r} {self.unit}" if self.unit else number


@dataclass(frozen=True)
class ControlGroup:
    """The controls of one table of the document, such as "friction" or "friction.slip".

    `kind` is the kind of body, law, loading or start, "" for a table without one, and `kinds` those that can be chosen: see
    `exchange.with_kind`.
    """

    table: str
    title: str
    kind: str
    kinds: tuple[str, ...]
    controls: tuple[Control, ...]


def controls_of(setting: Setting) -> tuple[ControlGroup, ...]:
    """Return the controls of a setting, table by table. Raises InputError if its document is not a scenario."""
    return tuple(_Tables(setting).groups())


class _Tables:
    """The tables of a setting, beside those of its scenario at the beginning."""

    def __init__(self, setting: Setting) -> None:
        self.setting, self.problem = setting, setting.scenario().problem
        began = Setting.bundled(setting.name) if setting.name in library.names() else setting
        self.began: Callable[[str], Any] = began.value

    def groups(self) -> Iterator[ControlGroup]:
        if self.setting.is_fault:
            yield from self.of_fault()
            return
        body, law = self.problem.body, self.problem.friction
        yield self.of("body", type(body), bodies_beside(body.kind))
        yield from self.of_law("friction", tuple(LAWS))
        pull = self.setting.value("loading.pull_rate")
        others = self.of("loading", type(body), ())
        if isinstance(pull, Mapping):
            kinds = (CONSTANT, *HISTORIES)
            yield self.of("loading.pull_rate", HISTORIES[pull["kind"]], kinds, "Pull rate that varies")
        else:
            others = ControlGroup("loading", others.title, CONSTANT, (CONSTANT, *HISTORIES), others.controls)
        if law.sticks:  # else the contact slips both ways
            value = str(bool(self.setting.value("loading.one_way"))).lower()
            only = Control(
                "loading.one_way", "one way", ONE_WAY, "choice", value, choices=YES_OR_NO.allowed, rare=True, declared=YES_OR_NO
            )
            others = replace(others, controls=(*others.controls, only))
        if others.controls:
            yield others
        for name in ("far_stress", "force", *HISTORIES_ONLY):
            history = self.setting.value(f"loading.{name}")
            if isinstance(history, Mapping):
                yield self.of(
                    f"loading.{name}", ALL_HISTORIES[history["kind"]], (), f"{name.capitalize().replace('_', ' ')} that varies"
                )
        start = "steady" if self.starts_steadily else "load" if self.setting.value("initial.excess") is None else "excess"
        in_motion = self.problem.has_initial_rate and self.problem.first_pull_rate != 0.0
        kinds = STARTS if law.sticks else STARTS_IN_MOTION if in_motion else ()
        yield replace(self.of("initial", type(body), (), states=law.states), kind=start, kinds=kinds)
        yield self.of_run()

    def of_fault(self) -> Iterator[ControlGroup]:
        """Yield the tables of a fault: its patches first, then those of the problem that each node has; kinds stay as they are."""
        body, law = type(self.problem.body), self.problem.friction
        found: dict[str, list[Control]] = {}
        for one in parameter_paths(self.setting.scenario()):
            if one.name.startswith(CONTACT) and "width" not in one.name:
                found.setdefault(one.name.rpartition("].")[0], []).append(self.of_contact(one))
        grid = ControlGroup(CONTACT, "Contact", "", (), tuple(found.pop("", ())))
        for table, controls in found.items():
            number = int(table.rpartition("[")[2]) + 1
            yield ControlGroup(f"{table}]", f"Patch {number}", "", (), tuple(controls))
        yield grid
        yield from (replace(group, kind="", kinds=()) for group in self.of_law("friction", ()))
        own = self.of("body", body, ())
        own = replace(own, controls=tuple(one for one in own.controls if one.path not in MUST_BE_0))
        others = (own, self.of("loading", body, ()), self.of("initial", body, (), states=law.states))
        yield from (group for group in others if group.controls)
        run = self.of("run", body, ())
        yield replace(run, controls=tuple(one for one in run.controls if one.path == "run.duration"))

    @cached_property
    def usual_contact(self) -> Mapping[str, Any]:
        """The numbers of a contact and its patches that need not be given, as the table declares them."""
        return {one.name: one.default for one in fields(tables()[CONTACT].kind())} | {"taper": 0.0}

    def of_contact(self, one: ParameterPath) -> Control:
        """Return the control of a number of the contact or of one of its patches."""
        inside = one.name.rpartition("].")[2].removeprefix(f"{CONTACT}.")
        label = PARTS_OF_PATCH.get(inside, inside.replace(".", " ").replace("_", " "))
        rare, value = inside in RARE_IN_CONTACT, self.setting.value(one.name)
        if isinstance(one.declared, Choice):
            text = str(self.usual_contact.get(inside) if value is None else value).lower()
            return Control(
                one.name, label, one.declared.meaning, "choice", text, choices=one.declared.allowed, declared=one.declared
            )
        control = self.number(one.name, label, one.declared, self.usual_contact.get(inside), rare)
        return replace(control, kind="whole") if one.counts else control

    def of_law(self, table: str, kinds: tuple[str, ...]) -> Iterator[ControlGroup]:
        content = self.setting.value(table)
        kind = kind_of(table, content, self.setting.name)
        yield self.of(table, kind, kinds, "" if table == "friction" else f"Friction: {table.partition('.')[2]}")
        for name, (entry, _) in entries_in(table, kind, (), self.problem.load_unit).items():
            if isinstance(entry, LawField):
                yield from self.of_law(f"{table}.{name}", PARTLESS)

    def of(
        self, table: str, kind: type, kinds: tuple[str, ...], title: str = "", states: tuple[StateVariable, ...] = ()
    ) -> ControlGroup:
        controls: list[Control] = []
        for name, (entry, default) in entries_in(table, kind, states, self.problem.load_unit).items():
            if not self.applies(f"{table}.{name}"):
                continue
            if isinstance(entry, NamedNumbers):
                given = self.setting.value(f"{table}.{name}") or {}
                controls += [self.named(f"{table}.{name}.{one}", one) for one in given]
            elif not isinstance(entry, LawField) and not self._is_packed(f"{table}.{name}", entry):
                controls.append(self.control(f"{table}.{name}", entry, default))
        own = getattr(kind, "kind", "") if kinds else ""
        return ControlGroup(table, title or TITLES_OF_TABLES[table.partition(".")[0]], own, kinds, tuple(controls))

    def _is_packed(self, path: str, entry: Field) -> bool:
        """Return True for numbers that a scenario holds packed, as those of a record: nobody edits them one by one."""
        return isinstance(entry, NumberSeries) and isinstance(self.setting.value(path), str)

    def of_run(self) -> ControlGroup:
        numbers = self.of("run", type(self.problem.body), ())
        rule = self.setting.value("run.selection") or SELECTION_RULES[0]
        meaning = "which slip rate the contact takes where several solve the contact equation"
        rules = Control("run.selection", "selection rule", meaning, "choice", rule, choices=names())
        return ControlGroup("run", numbers.title, "", (), (*numbers.controls[:1], rules, *numbers.controls[1:]))

    @property
    def starts_steadily(self) -> bool:
        """True if the contact starts in steady sliding, because the scenario gives no load."""
        return all(self.setting.value(f"initial.{name}") is None for name in ("load", "excess"))

    def applies(self, path: str) -> bool:
        """Return False for an entry that this problem cannot have, and for a number that a table replaces."""
        if path.removeprefix("loading.").removeprefix("body.") in driver_of(self.problem).unfelt:
            return False
        if path.removeprefix("loading.") in HISTORIES_ONLY:
            return False
        if path in ("initial.state", "initial.second_state") and (not self.problem.friction.states or self.starts_steadily):
            return False
        if path == "initial.rate" and not (self.problem.body.has_inertia or self.problem.has_initial_rate):
            return False
        if path in ("initial.load", "initial.excess"):
            return self.setting.value(path) is not None
        return not isinstance(self.setting.value(path), Mapping) or "parameters" in path

    def control(self, path: str, entry: Field, default: Any) -> Control:
        label = path.rpartition(".")[2].replace("_", " ")
        value = self.setting.value(path)
        rare = path in RARE
        if isinstance(entry, Choice):
            return Control(path, label, entry.meaning, "choice", value or default, choices=entry.allowed, rare=rare, declared=entry)
        if isinstance(entry, Text):
            return Control(path, label, entry.meaning, "text", value or "", declared=entry)
        if isinstance(entry, Count):
            return Control(path, "slip events", entry.meaning, "whole", value, empty="no limit", rare=rare, declared=entry)
        if isinstance(entry, NumberSeries):
            empty = "" if default is MISSING else "none"
            unit, size = unit_of(next((one for one in value or () if isinstance(one, str)), None), 0.0, entry.item.unit)
            points = None if value is None else tuple(entry.item.check(label, "it", one) for one in value)
            return Control(path, label, describe(entry), "points", points, unit, size, empty=empty, declared=entry)
        assert isinstance(entry, Quantity)
        return self.number(path, label, entry, default, rare)

    def number(self, path: str, label: str, entry: Quantity, default: Any, rare: bool) -> Control:
        given = self.setting.value(path)
        if given == STEADY:
            name = path.partition(".")[2]
            given = self.problem.rate if name == "rate" else self.problem.given_states[STATE_NAMES.index(name)]
        value = default if given is None and default is not MISSING else None if given is None else entry.check(label, "it", given)
        unit, size = unit_of(given, value, entry.unit)
        empty = "" if default is MISSING or path in ("initial.load", "initial.excess") else self._empty(path, default, entry)
        kind: ControlKind = "whole" if entry.whole else "number"
        slider = self._slider(path, entry, value, default)
        return Control(path, label, describe(entry), kind, value, unit, size, slider, empty=empty, rare=rare, declared=entry)

    def _empty(self, path: str, default: Any, entry: Quantity) -> str:
        if path == "initial.rate" and self.starts_steadily:
            return "the pull rate"
        if path == "initial.rate" and self.problem.friction.sticks:
            return "rest"
        if default is None:
            return empty_of(path)
        return entry.word if math.isinf(default) else f"{default:g}"

    def named(self, path: str, name: str) -> Control:
        """Return the control of a number of the user's formula, whose name and unit users choose."""
        given = self.setting.value(path)
        one = self.problem.parameters[path]
        unit, size = unit_of(given, one.value, one.unit)
        slider = self._slider(path, one.declared, one.value, MISSING)
        return Control(path, name, "number of the formula", "number", one.value, unit, size, slider, declared=one.declared)

    def _slider(self, path: str, entry: Quantity, value: float | None, default: Any) -> SliderRange | None:
        """Return the range of a slider. It follows from the first value of the scenario and not from the present one."""
        anchor = self.began(path)
        try:
            began = entry.check("", "", anchor) if anchor is not None else value if default in (MISSING, None) else default
        except InputError:  # the scenario began with another kind of body, law or loading, in which the name means something else
            began = value
        found = range_of(path, entry, began, self.problem)
        return None if found is None else found.holding(value)


def unit_of(given: Any, value: float | None, si: str) -> tuple[str, float]:
    """Return the unit for showing a number, and its size in SI: the unit of the input, or a readable one."""
    if si == "1":
        return "", 1.0
    parts = split_quantity(given) if isinstance(given, str) else None
    if parts is None and value is not None and math.isfinite(value) and value != 0.0:
        parts = split_quantity(brief(value, si))
    if parts is None or " or " in si:
        return si, 1.0
    try:
        return parts[1], to_si(1.0, parts[1], si)
    except InputError:
        return si, 1.0
