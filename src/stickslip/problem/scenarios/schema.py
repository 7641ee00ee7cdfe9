"""The schema of a scenario file, derived from the declared fields of bodies, laws, loading histories and `Problem`.

A new law or body enters the schema by being registered.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING
from functools import cache, partial
from types import MappingProxyType
from typing import Any, NamedTuple

from stickslip.extension import tables
from stickslip.foundation.arguments import check_type, shown
from stickslip.foundation.conversion import unit_among
from stickslip.foundation.errors import InputError, did_you_mean, meant, nearest, some_of
from stickslip.foundation.names import KINDS_OF_BODY, TURNS, own_units
from stickslip.foundation.quantities import LARGEST_SERIES, LawField, NumberSeries, Quantity, fields_of, in_units
from stickslip.foundation.quantities import Field as Declared
from stickslip.foundation.synonyms import same
from stickslip.friction import LAWS
from stickslip.friction.contract import STATE_NAMES, StateVariable
from stickslip.problem.bodies import BODIES
from stickslip.problem.bodies.on_bit import WEIGHT_ON_BIT
from stickslip.problem.fields import MAY_VARY, STEADY
from stickslip.problem.loading import HISTORIES, VARYING, LoadingHistory
from stickslip.problem.problem import Problem
from stickslip.problem.run_options import RunOptions
from stickslip.problem.scenarios.entries import DocumentPlace, Source, describe, key_of, read_entry
from stickslip.problem.selection_rule import SELECTION_RULES, names, unknown

TABLES_WITH_KIND: dict[str, Mapping[str, type]] = {"body": BODIES, "friction": LAWS}
"""Tables that must have a key `kind`, each with the classes that it may name."""
REGISTERED = TABLES_WITH_KIND | {"loading": HISTORIES}
"""Classes that `kind` may name in a table or in one of its parts, such as [loading.pull_rate]."""
LISTED, EXPLAINED = "`stickslip new --list` lists all", "`stickslip new slab`, or another starter, explains all"
"""Where the kinds of laws and histories are, and the keys."""
TABLES = ("body", "friction", "loading", "initial", "run")
"""The tables of a scenario; extensions add others."""
SOFT_TORQUE, WITH_SOFT_TORQUE = "soft_torque", "with_soft_torque"
"""The key of a string that stands for the three numbers of its drive, and the method of a body that has it."""
DRIVE = ("driver_impedance", "driver_inertia", "driver_integral_gain")
RECORDED = "loading.ground_acceleration"
"""The table that is a record if it names a file and no kind."""
OF_FORCE = {"N": "force", "N m": "torque"}
"""The heading of a force in a data file, which may be "force" alone, by its unit."""
ONE_WAY = "true: the contact never slips backwards"
"""Meaning of the key one_way."""
NO_STATE = {"state": Quantity("1", "state variable of the friction law, if it has one")}
"""Declaration of the initial state for a law without a state: none may be given."""


class Key(NamedTuple):
    """A key of a table: the function that converts and checks its value, its default (MISSING if it must be given), its meaning."""

    read: Callable[[Any, DocumentPlace], Any]
    default: Any = MISSING
    meaning: str = ""


def _read_text(value: Any, place: DocumentPlace) -> str:
    if not isinstance(value, str):
        raise InputError(f"{place.source.file}: {place.key} must be text in quotes, got {shown(value)}")
    return value


def _read_inner(value: Any, place: DocumentPlace) -> dict[str, Any]:
    if not isinstance(value, dict):
        raise InputError(f"{place.source.file}: [{place.key}] must be a table, got {shown(value)}")
    return value


def read_as(kind: type, wanted: str, value: Any, place: DocumentPlace) -> Any:
    """Return a value of a key if it is of a type, `wanted` in words. Raises InputError."""
    check_type(f"{place.source.file}: {place}", value, kind, wanted)
    return value


_DOCUMENT = {name: Key(_read_text, "") for name in ("title", "description", "trade")} | {name: Key(_read_inner) for name in TABLES}
_DOCUMENT |= {name: Key(_read_inner, MappingProxyType({})) for name in ("loading", "initial")}
"""The keys of a scenario outside its tables, and the tables of the core."""


def quantities_in(table: str, kind: type, states: tuple[StateVariable, ...] = ()) -> dict[str, tuple[Quantity, Any]]:
    """Return each quantity of a table with its default (MISSING if there is none).

    `kind` is the class of the law for [friction] and of the body for every other table, because loads are stresses for a slab and
    forces for a block. `states` are the friction law's states, which [initial] needs.
    """
    if table in TABLES_WITH_KIND or table in tables():
        return _declared(tables()[table].kind() if table in tables() else kind)
    if table == "run":
        return _declared(RunOptions)
    ours = {name: entry for name, entry in _declared(Problem).items() if name.startswith("initial_") == (table == "initial")}
    units = own_units(kind.load_unit) if hasattr(kind, "load_unit") else {}
    found = {name.removeprefix("initial_"): (in_units(declared, units), default) for name, (declared, default) in ours.items()}
    remembered = {
        name: Quantity(units.get(state.unit, state.unit), state.meaning) for name, state in zip(STATE_NAMES, states, strict=False)
    }
    return found | {name: (entry, None) for name, entry in (remembered or NO_STATE).items()} if table == "initial" else found


def entries_in(
    table: str, kind: type, states: tuple[StateVariable, ...] = (), load_unit: str = ""
) -> dict[str, tuple[Declared, Any]]:
    """Return every field of a table by its key, with its default: quantities, and other fields of a law or a loading history.

    With the unit of a body's loads, the fields of laws and histories have the units that they take with that body.
    """
    if table in tables():
        return dict(fields_of(tables()[table].kind()))
    if table == "run":
        return {key_of(name, entry): (entry, default) for name, (entry, default) in fields_of(RunOptions).items()}
    if not has_kind(table):
        return dict(quantities_in(table, kind, states))
    of = table.partition(".")[2]
    own = own_units(load_unit) if load_unit and table != "body" else {}
    unit = in_units(_declared(Problem)[of][0], own).unit if of in MAY_VARY else ""
    units = {**own, VARYING: unit}
    return {key_of(name, entry): (in_units(entry, units), default) for name, (entry, default) in fields_of(kind).items()}


def has_kind(table: str) -> bool:
    """Return True if a table has a key `kind`, which names a class."""
    return table in TABLES_WITH_KIND or "." in table


def _declared(kind: type) -> dict[str, tuple[Quantity, Any]]:
    return {name: (entry, default) for name, (entry, default) in fields_of(kind).items() if isinstance(entry, Quantity)}


@cache
def keys_of(table: str, kind: type, states: tuple[StateVariable, ...] = ()) -> Mapping[str, Key]:
    """Return the keys of one table."""
    keys = {"kind": Key(lambda value, _: value)} if has_kind(table) else {}  # `kind_of` has checked it
    for name, (declared, default) in entries_in(table, kind, states).items():
        keys[name] = Key(partial(_read_entry, declared), default, describe(declared))
    if table == "body" and hasattr(kind, WITH_SOFT_TORQUE):
        from stickslip.problem.bodies.soft_torque import MEANING  # here, because few bodies have a drive

        keys[SOFT_TORQUE] = Key(lambda value, _: value, None, MEANING)
    if table == "run":
        keys["selection"] = Key(lambda value, place: check_rule(value, place.source.file, str(place)), SELECTION_RULES[0])
    if table == "loading":
        keys["one_way"] = Key(partial(read_as, bool, "true or false"), False, ONE_WAY)
    return keys | (dict(tables()[table].other_keys()) if table in tables() else {})


def _read_entry(declared: Declared, value: Any, place: DocumentPlace) -> Any:
    """Return a value converted and checked for its field; a table in place of a number that may vary is a loading history."""
    if value == STEADY and place.table == "initial" and place.key in (*STATE_NAMES, "rate"):
        return value
    varies = place.table == "loading" and place.key in MAY_VARY
    if varies and isinstance(value, dict):
        unit = declared.unit if isinstance(declared, Quantity) else ""
        if place.key == "normal_load":
            return _read_normal_load(value, place, unit)
        return read_part(place.inner, value, place.source, OF_FORCE.get(unit, "") if place.key == "force" else "")
    if place.table == "body" and isinstance(value, dict) and any(place.key == kind.normal for kind in KINDS_OF_BODY.values()):
        raise InputError(f"{place.source.file}: {place} is one number, that at the start: a history is [loading.normal_load]")
    if place.source.load_unit:
        declared = in_units(declared, own_units(place.source.load_unit))
    try:
        return read_entry(value, declared, place, _law_in)
    except InputError as error:
        if place.table != "loading" or not (isinstance(value, list | dict) or value in HISTORIES):
            raise
        hint = f"only {' or '.join(MAY_VARY)} may vary in time"
        if varies:
            hint = f"what varies in time is a table [{place.inner}] of a kind: {', '.join(HISTORIES)}"
        raise InputError(f"{error}; {hint}") from None


def _read_normal_load(table: dict[str, Any], place: DocumentPlace, unit: str) -> LoadingHistory:
    """Return a normal load that varies: in the unit of the body's loads, or the weight on the bit of a body that turns."""
    texts = [one for entry in table.values() for one in (entry if isinstance(entry, list) else (entry,))]
    units = {unit_among(one, VARYING) for one in texts} - {""}
    if unit == TURNS and units == {WEIGHT_ON_BIT.unit}:
        return _read_weight(table, place)
    if not units <= {unit}:
        raise InputError(f"{place.source.file}: [{place.inner}] must be in {unit}, as the loads of this body are")
    heading = KINDS_OF_BODY[unit].normal if unit in KINDS_OF_BODY else ""
    try:
        found: LoadingHistory = read_part(place.inner, table, place.source, heading)
    except InputError as error:
        if unit != TURNS or "file" not in table or "no column" not in str(error):
            raise
        try:
            return _read_weight(table, place)
        except InputError as other:
            raise error if "no column" in str(other) else other from None
    return found


def _read_weight(table: dict[str, Any], place: DocumentPlace) -> LoadingHistory:
    """Return a weight on the bit that varies."""
    source = place.source._replace(load_unit=WEIGHT_ON_BIT.unit)
    weight: LoadingHistory = read_part(place.inner, table, source, "weight_on_bit")
    return weight.in_unit(WEIGHT_ON_BIT.unit)


def _law_in(raw: dict[str, Any], source: Source, table: str) -> Any:
    """Return the law in a table such as [friction.slip]. Raises InputError for a law that is made of laws itself."""
    kind = kind_of(table, raw, source.file)
    if any(isinstance(entry, LawField) for entry, _ in fields_of(kind).values()):
        found = f"[{table}] kind {shown(raw['kind'])}"
        raise InputError(f"{source.file}: {found} is itself made of laws and cannot be part of another law")
    return read_part(table, raw, source)


def read_part(table: str, raw: dict[str, Any], source: Source, heading: str = "") -> Any:
    """Return the body, law or loading history that a table describes. Raises InputError.

    `heading` is that of the values in a data file if it is not the name of the table.
    """
    kind = kind_of(table, raw, source.file)
    content = read_table(table, kind, raw, source, heading=heading)
    keys = {name: key_of(name, entry) for name, (entry, _) in fields_of(kind).items()}
    try:
        if content.get(SOFT_TORQUE) is not None:
            return _softened(kind, {name: content[key] for name, key in keys.items() if name not in DRIVE}, raw)
        return kind(**{name: content[key] for name, key in keys.items()})
    except InputError as error:
        raise InputError(f"{source.file}: [{table}] {without_owner(error)}") from None


def _softened(kind: type, fields: dict[str, Any], raw: Mapping[str, Any]) -> Any:
    """Return a string whose drive is set by one key of its table, beside an inertia and a gain if given. Raises InputError."""
    impedance, inertia, integral = (raw.get(name) for name in DRIVE)
    if integral is not None:
        raise InputError(f"{kind.__name__}: {SOFT_TORQUE} gives the integral gain of the drive: leave {DRIVE[2]} out")
    return kind(**fields).with_soft_torque(raw[SOFT_TORQUE], impedance, inertia)


def without_owner(error: InputError) -> str:
    """Return a message without its first words, such as "ElasticSlab: ": the author of a file knows tables, not classes."""
    return str(error).partition(": ")[2]


def check_rule(value: Any, where: str, name: str) -> str:
    """Return the name of a selection rule if there is such a rule. Raises InputError otherwise."""
    if value not in names():
        raise InputError(f"{where}: {name} {shown(value)} {unknown(str(value))}")
    return str(value)


def read_document(raw: Mapping[str, Any], source: Source) -> dict[str, Any]:
    """Return a parsed TOML document if it has a scenario's texts and tables, whose content is not checked. Raises InputError."""
    if clash := next((name for name in tables() if name in _DOCUMENT), None):
        raise InputError(f"an extension adds the table '{clash}' to scenario files, which is there already: uninstall it")
    return _read_keys(_DOCUMENT | {name: Key(_read_inner, None) for name in tables()}, raw, source)


def read_table(
    table: str, kind: type, raw: dict[str, Any], source: Source, states: tuple[StateVariable, ...] = (), *, heading: str = ""
) -> dict[str, Any]:
    """Check one table and return it, with the points from a data file if the table names one. Raises InputError."""
    columns = columns_of(table, kind, heading)
    if columns and "file" in raw:
        if getattr(kind, "is_recorded", False):
            return _read_keys(keys_of(table, kind, states), _recorded(table, raw, source), source, table)
        from stickslip.problem.scenarios.points_of_files import read_points  # few scenarios name a file

        name = raw["file"]
        both = next((key for key in columns.values() if key in raw), None)
        if both or not isinstance(name, str):
            got = f"and {both} exclude each other" if both else f"must be text in quotes, got {shown(name)}"
            raise InputError(f"{source.file}: [{table}] file {got}")
        along = raw.get("along") if len(columns) > 2 else None
        named = raw.get("columns")
        turns = source.load_unit == TURNS
        series = next(fields_of(kind)[field][0] for field in columns.values())
        most = series.most if isinstance(series, NumberSeries) else LARGEST_SERIES
        where = f"{source.file}: [{table}] file"
        points = read_points(name, source.folder, columns, where, along, named=named, turns=turns, most=most)
        taken = {"file", "columns"} if along is None else {"file", "columns", "along"}
        raw = {key: value for key, value in raw.items() if key not in taken} | points
    return _read_keys(keys_of(table, kind, states), raw, source, table)


def _recorded(table: str, raw: dict[str, Any], source: Source) -> dict[str, Any]:
    """Return the content of a table that names the file of a record. Raises InputError."""
    from stickslip.problem.scenarios.record_of_file import fields_beside_file  # few scenarios name a file

    where = f"{source.file}: [{table}] file"
    if not isinstance(raw["file"], str):
        raise InputError(f"{where} must be text in quotes, got {shown(raw['file'])}")
    return fields_beside_file(raw, source.folder, where)


def columns_of(table: str, kind: type, heading: str = "") -> dict[str, str]:
    """Return the columns of a data file that may replace lists in a table, each with the key of its list.

    The last one is the dependent variable, whose column has the given heading, or that of the table.
    """
    columns: dict[str, str] = getattr(kind, "columns", {}) if has_kind(table) else {}
    varies = heading or table.partition(".")[2]
    return {varies if column == "value" else column: of for column, of in columns.items()}


def kind_of(table: str, content: Mapping[str, Any], file: str) -> type:
    """Return the class that `kind` names in a table. Raises InputError if it is missing or unknown."""
    kind, registered = content.get("kind"), REGISTERED[table.partition(".")[0]]
    if table == RECORDED and not (isinstance(kind, str) and kind in registered):
        from stickslip.problem.accelerogram import ALL_HISTORIES, Accelerogram  # few scenarios have a record

        registered, kind = ALL_HISTORIES, Accelerogram.kind if kind is None and "file" in content else kind
    if kind is None:
        if table == RECORDED and (wrong := next((key for key in content if meant(key, ["file"])), None)):
            raise InputError(f"{file}: [{table}] {shown(wrong)} is unknown; did you mean 'file'?")
        raise InputError(f"{file}: [{table}] kind is missing; allowed: {some_of(registered, listed=LISTED)}")
    if not isinstance(kind, str) or kind not in registered:
        raise InputError(f"{file}: [{table}] kind {shown(kind)} is unknown; {nearest(str(kind), registered, listed=LISTED)}")
    return registered[kind]


def _read_keys(keys: Mapping[str, Key], raw: Mapping[str, Any], source: Source, table: str = "") -> dict[str, Any]:
    """Return the values of all keys of a table, or of the document (""). Raises InputError.

    A key that is unknown comes first, because a misspelt key makes the right one missing, too, but is the cause.
    """
    for name, value in raw.items():
        if name not in keys:
            place = f"[{table}] {_named(name)}" if table else f"[{_named(name)}]" if isinstance(value, dict) else _named(name)
            hint = _hint(name, table, keys)
            of_whom = " to stickslip and its extensions here" if place == f"[{name}]" and hint.startswith("allowed") else ""
            raise InputError(f"{source.file}: {place} is unknown{of_whom}; {hint}")
    found = {name: key.read(raw[name], DocumentPlace(source, table, name)) for name, key in keys.items() if name in raw}
    for name, key in keys.items():
        if found.setdefault(name, key.default) is MISSING:
            place = f"[{table}] {name}" if table else f"[{name}]"
            raise InputError(f"{source.file}: {place} is missing" + (f": {key.meaning}" if key.meaning else ""))
    return found


def _named(name: str) -> str:
    """Return a key as it is shown: a short word as it is, anything else in quotes."""
    is_word = name.replace("_", "").replace("-", "").isalnum() and name.isascii() and len(name) <= 40
    return name if is_word else shown(name)


def _hint(name: str, table: str, keys: Mapping[str, Key]) -> str:
    """Return where an unknown key belongs, and which key of this table may be meant."""
    belongs = _belongs(name, table)
    if belongs:
        close = same(name, keys)
        return f"{belongs}; {did_you_mean(close)}" if close else belongs
    return nearest(name, keys, listed=EXPLAINED)


def _belongs(name: str, table: str) -> str:
    """Return a hint if a key is known but belongs to another kind of body, or in another table; "" otherwise."""
    having = sorted(kind for kind, body in BODIES.items() if name in keys_of(table, body)) if table == "body" else []
    if having:
        return f"it is a key of {', '.join(having)}, and not of this kind"
    others = () if table.startswith("friction.") else (other for other in (*TABLES, *tables()) if other not in ("friction", table))
    for other in others:
        if any(name in keys_of(other, body) for body in TABLES_WITH_KIND["body"].values()):
            return f"it belongs in [{other}]"
    return ""
