"""Exchange the kind of body, law, loading or start of a setting: what still fits stays, the rest is plausible."""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from typing import Any

from stickslip.extensions.explorer.model.asked import SHOWN_KINDS
from stickslip.extensions.explorer.model.controls import CONSTANT, bodies_beside
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity
from stickslip.friction import FrictionLaw
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import HISTORIES, STEADY, written_out
from stickslip.problem.bodies import BODIES
from stickslip.problem.scenarios import TABLES_WITH_KIND, Source, entries_in, example_of, kind_of, library, read_part


def with_kind(setting: Setting, table: str, kind: str) -> Setting:
    """Return a setting with another kind of body, law, loading or start in one of its tables: see `controls.Group`.

    Numbers with the same name, unit and an allowed value stay; others are those of the scenario at its beginning, or plausible
    ones. A contact with a new law or body starts at its static strength, or close to steady sliding. Raises InputError for an
    unknown kind.
    """
    if table == "body":
        return _with_body(setting, kind)
    if table == "initial":
        return _with_start(setting, kind)
    if table in ("loading", "loading.pull_rate"):
        return _with_pull(setting, kind)
    law = _law_table(setting, table, kind)
    changed = setting.with_value(table, law)
    return _started(changed) if table == "friction" else _or_started(changed)


def _law_table(setting: Setting, table: str, kind: str) -> dict[str, Any]:
    """Return the table of a law of another kind, with the numbers of the former one that still fit."""
    load_unit = setting.load_unit
    source = Source(setting.name, load_unit=load_unit)
    law = kind_of("friction", {"kind": kind}, setting.name)
    made = {"kind": kind} | _began(setting, table, kind, example_of(law, load_unit))
    former = setting.value(table)
    had = entries_in("friction", kind_of("friction", former, setting.name))
    for key, (entry, _) in entries_in("friction", law).items():
        old = had.get(key, (None, None))[0]
        fits = isinstance(entry, Quantity) and isinstance(old, Quantity) and old.unit == entry.unit
        if not fits or key not in former or key not in made:  # what is optional in the new law means something else there
            continue
        kept = made | {key: former[key]}
        try:
            read_part("friction", kept, source)
        except InputError:
            continue
        made = kept
    return made


def _began(setting: Setting, table: str, kind: str, otherwise: dict[str, Any]) -> dict[str, Any]:
    """Return the table of the bundled scenario at its beginning if it is of this kind, otherwise `otherwise`."""
    if setting.name in library.names():
        own = Setting.bundled(setting.name).value(table)
        if isinstance(own, Mapping) and own.get("kind") == kind:
            return deepcopy(dict(own))
    return otherwise


def _started(setting: Setting) -> Setting:
    """Return a setting whose start suits its law: at the static strength, or for a law that never sticks as its author says."""
    law = kind_of("friction", setting.value("friction"), setting.name)
    assert issubclass(law, FrictionLaw)
    initial = {key: value for key, value in setting.value("initial").items() if key == "slip"}
    if setting.name in library.names():
        began = Setting.bundled(setting.name)
        same = all(began.value(f"{table}.kind") == setting.value(f"{table}.kind") for table in TABLES_WITH_KIND)
        if same:
            return setting.with_value("initial", dict(began.value("initial")))
    if law.sticks:
        return setting.with_value("initial", initial | {"excess": 0.0})
    setting = setting.with_value("loading.one_way", None)  # which needs rest
    body = read_part("body", dict(setting.value("body")), Source(setting.name))
    load = law.start["coefficient"] * body.normal_load
    states = {name: law.start[name] for name in STATE_NAMES if name in law.start}
    return setting.with_value("initial", initial | {"load": load} | states)


def _or_started(setting: Setting) -> Setting:
    """Return the setting as it is if it makes a scenario, otherwise with a start that suits its law."""
    try:
        setting.scenario()
    except InputError:
        return _started(setting)
    return setting


def _with_body(setting: Setting, kind: str) -> Setting:
    """Return a setting with a body of another kind: a slab's equivalent block, or the slab beside which a block stands."""
    kind_of("body", {"kind": kind}, setting.name)
    problem = setting.scenario().problem
    own = problem.body
    if own.kind == kind:
        return setting
    if kind not in bodies_beside(own.kind):
        raise InputError(f"{setting.name}: {own.kind} cannot be exchanged for {kind}: one slides, the other turns")
    of_kind = SHOWN_KINDS[BODIES[kind].structure]
    body = of_kind.in_place_of(own, kind, setting.name)
    made = {"kind": kind} | _began(setting, "body", kind, body)
    # a far stress acts on a driver that gives way, no ground is under sides that are apart, another driver changes otherwise
    missing = (
        "driver_reflection",
        *("far_stress",) * ("driver_impedance" not in made),
        *("ground_",) * (kind == "two-slabs" and made.get("sides") != "joined"),
    )
    loading = {key: value for key, value in (setting.value("loading") or {}).items() if not key.startswith(missing)}
    setting = setting.with_value("loading", of_kind.loading_of(loading, problem))
    run = {key: value for key, value in setting.value("run").items() if key not in ("creep_rtol", "shortest_event")}
    return _started(setting.with_value("body", made).with_value("run", run))


def _with_start(setting: Setting, kind: str) -> Setting:
    """Return a setting that starts in steady sliding, or from the load, the states and the rate that it has now."""
    problem = setting.scenario().problem
    if kind not in ("load", "excess") and not (kind == STEADY and problem.has_initial_rate):
        raise InputError(f"{setting.name}: [initial] takes load or excess, got {kind!r}")
    initial = {key: value for key, value in setting.value("initial").items() if key not in ("load", "excess")}
    if kind == STEADY:
        return setting.with_value("initial", {key: value for key, value in initial.items() if key not in STATE_NAMES})
    start = written_out(problem)
    states = {name: getattr(start, f"initial_{name}") for name in STATE_NAMES}
    if initial.get("rate") == STEADY:
        initial["rate"] = start.initial_rate
    initial = states | initial | {kind: float(problem.load if kind == "load" else problem.excess)}
    return setting.with_value("initial", {key: value for key, value in initial.items() if value is not None})


def _with_pull(setting: Setting, kind: str) -> Setting:
    pull = setting.scenario().problem.pull_rate
    first = pull if isinstance(pull, float) else pull.first
    if kind == CONSTANT:
        return setting.with_value("loading.pull_rate", first)
    kind_of("loading", {"kind": kind}, setting.name)
    plain = (
        setting if not isinstance(setting.value("loading.far_stress"), Mapping) else setting.with_value("loading.far_stress", None)
    )
    return plain.with_value(
        "loading.pull_rate", {"kind": kind} | _began(setting, "loading.pull_rate", kind, HISTORIES[kind].example)
    )
