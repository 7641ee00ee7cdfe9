"""What a scenario file may hold, read from what bodies, laws and `Problem` declare about themselves.

A new law or body appears here by being registered. pydantic checks names and types, `Quantity` checks values.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, fields, replace
from functools import cache
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, ValidationInfo, create_model

from stickslip.bodies import BODIES
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Quantity, quantities_of
from stickslip.friction import LAWS
from stickslip.friction.law import StateVariable
from stickslip.friction.parameters import Field as LawField
from stickslip.friction.parameters import Part, Series, fields_of
from stickslip.loading import HISTORIES
from stickslip.loading.contract import VARYING
from stickslip.problem.problem import MAY_VARY, Problem
from stickslip.problem.selection_rule import SELECTION_RULES, names, unknown
from stickslip.scenarios.entries import Source, describe, key_of, read_entry
from stickslip.scenarios.points import read_points
from stickslip.scenarios.values import read_quantity, show

KINDS: dict[str, Mapping[str, type]] = {"body": BODIES, "friction": LAWS}
REGISTERED = KINDS | {"loading": HISTORIES}
"""What a `kind` may name, by the table it stands in, or in a table of which it stands: [loading.pull_rate]."""
TABLES = ("body", "friction", "loading", "initial", "run")
DURATION = Quantity("s", "how long to simulate", above=0)
RTOL = Quantity("1", "relative tolerance of the run", at_least=1e-15)
CREEP_RTOL = Quantity("1", "leap over creep with this error of slip (slab, law of slip); 0: never; else automatic", at_least=0)
SHORTEST_EVENT = Quantity("s", "lump slip events that are shorter (slab, rigid driver); 0: none; else automatic", at_least=0)
LARGEST_RTOL = 1e-2
STATE = Quantity("1", "state variable of the friction law, if it has one")


class _Strict(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=False)


class _Document(_Strict):
    title: str = ""
    description: str = ""
    body: dict[str, Any]
    friction: dict[str, Any]
    loading: dict[str, Any] = Field(default_factory=dict)
    initial: dict[str, Any]
    run: dict[str, Any]


def quantities_in(table: str, kind: type, state: StateVariable | None = None) -> dict[str, tuple[Quantity, Any]]:
    """Each quantity of a table with its default (MISSING where there is none).

    `kind` is the law for [friction] and the body for every other table: loads are stresses for a slab, forces for a block.
    `state` is what the friction law remembers, for [initial].
    """
    if table in KINDS:
        return _declared(kind)
    if table == "run":
        automatic = {"creep_rtol": (CREEP_RTOL, None), "shortest_event": (SHORTEST_EVENT, None)}
        return {"duration": (DURATION, MISSING), "rtol": (RTOL, 1e-10), **automatic}
    ours = {name: entry for name, entry in _declared(Problem).items() if name.startswith("initial_") == (table == "initial")}
    found = {name.removeprefix("initial_"): (_of_body(declared, kind), default) for name, (declared, default) in ours.items()}
    remembered = Quantity(state.unit, state.meaning) if state else STATE
    return found | {"state": (remembered, None)} if table == "initial" else found


def entries_in(table: str, kind: type, state: StateVariable | None = None) -> dict[str, tuple[Quantity | LawField, Any]]:
    """Everything of a table by its key, with its default: the quantities, and what else a law or a loading history is made of."""
    if not has_kind(table):
        return dict(quantities_in(table, kind, state))
    of = table.partition(".")[2]
    unit = _declared(Problem)[of][0].unit if of in MAY_VARY else ""
    return {key_of(name, entry): (in_unit(entry, unit), default) for name, (entry, default) in fields_of(kind).items()}


def has_kind(table: str) -> bool:
    """Whether a table says by its `kind` what it is of."""
    return table in KINDS or "." in table


def in_unit(entry: Quantity | LawField, unit: str) -> Quantity | LawField:
    """A value of a loading history in the unit of what varies."""
    if isinstance(entry, Series) and entry.item.unit == VARYING:
        return replace(entry, item=replace(entry.item, unit=unit))
    return replace(entry, unit=unit) if isinstance(entry, Quantity) and entry.unit == VARYING else entry


def _declared(kind: type) -> dict[str, tuple[Quantity, Any]]:
    return {f.name: (f.metadata["quantity"], f.default) for f in fields(kind) if "quantity" in f.metadata}


def _of_body(declared: Quantity, body: type) -> Quantity:
    """A load in the body's own unit: that of its normal stress (Pa) or normal force (N)."""
    if declared.unit != "Pa or N":
        return declared
    return replace(declared, unit=next(q.unit for name, q in quantities_of(body).items() if name.startswith("normal_")))


@cache
def table_model(table: str, kind: type, state: StateVariable | None = None) -> type[BaseModel]:
    """The pydantic model of one table."""
    entries: dict[str, Any] = {"kind": (str, ...)} if has_kind(table) else {}
    for name, (declared, default) in entries_in(table, kind, state).items():
        read = Annotated[Any, BeforeValidator(_reader(table, name, declared))]
        entries[name] = (read, Field(... if default is MISSING else default, description=describe(declared)))
    if table == "run":
        entries["events"] = (Annotated[int | None, BeforeValidator(_events)], None)
        entries["selection"] = (Annotated[str, BeforeValidator(_selection)], SELECTION_RULES[0])
    model: type[BaseModel] = create_model(f"{table} of {kind.__name__}", __base__=_Strict, **entries)
    return model


def _reader(table: str, name: str, declared: Quantity | LawField) -> Any:
    def read(value: Any, info: ValidationInfo) -> Any:
        source: Source = info.context["source"]  # type: ignore[index] # always given, in _validate
        if table == "loading" and name in MAY_VARY and isinstance(value, dict):
            return _history(value, source, f"{table}.{name}")
        try:
            return read_entry(value, declared, source, table, name, _nested)
        except InputError as error:
            raise InputError(f"{error}{_as_history(table, name, value)}") from None

    return read


def _as_history(table: str, name: str, value: Any) -> str:
    """A hint where something that varies in time was meant, and not given as a table."""
    if table != "loading" or not (isinstance(value, list | dict) or value in HISTORIES):
        return ""
    if name in MAY_VARY:
        return f"; what varies in time is a table [loading.{name}] of a kind: {', '.join(HISTORIES)}"
    return f"; only {' or '.join(MAY_VARY)} may vary in time"


def _nested(raw: dict[str, Any], source: Source, table: str) -> Any:
    """The law in a table such as [friction.slip]."""
    kind = kind_of(table, raw, source.file)
    if any(isinstance(entry, Part) for entry, _ in fields_of(kind).values()):
        raise InputError(
            f"{source.file}: [{table}] kind {show(raw['kind'])} is made of laws itself: it cannot be a part of another"
        )
    return build(table, read_table(table, kind, raw, source), source.file)


def _history(raw: dict[str, Any], source: Source, table: str) -> Any:
    """The loading history in a table such as [loading.pull_rate]."""
    return build(table, read_table(table, kind_of(table, raw, source.file), raw, source), source.file)


def build(table: str, content: dict[str, Any], file: str) -> Any:
    """The body or law of a table that was read. Raises InputError where its numbers do not go together."""
    kind = kind_of(table, content, file)
    names = {key_of(name, entry): name for name, (entry, _) in fields_of(kind).items()}
    try:
        return kind(**{names[key]: value for key, value in content.items() if key != "kind"})
    except InputError as error:
        raise InputError(f"{file}: [{table}] {without_owner(error)}") from None


def without_owner(error: InputError) -> str:
    """The message behind "ElasticSlab: ": a reader of a file knows tables, not classes."""
    return str(error).partition(": ")[2]


def read_duration(text: str, where: str, name: str = "duration", declared: Quantity = DURATION) -> float:
    """A time (s; if not `declared` otherwise a run's) typed by hand: a number of seconds, or a text with a unit.

    Raises InputError beginning with `where`.
    """
    try:
        value: float | str = float(text)
    except ValueError:
        value = text
    return read_quantity(value, declared, where, name)


def check_rtol(value: float, where: str, name: str = "rtol") -> float:
    """A relative tolerance that `simulate` takes. Raises InputError."""
    if RTOL.check(where, name, value) > LARGEST_RTOL:
        raise InputError(f"{where}: {name} must be at most {LARGEST_RTOL:g}, got {value:g}")
    return value


def check_events(value: Any, where: str, name: str = "events") -> int:
    """A number of slip events after which a run stops. Raises InputError."""
    if isinstance(value, bool) or not isinstance(value, int) or not 0 < value < 10**12:
        raise InputError(f"{where}: {name} must be a whole number above 0, got {show(value)}")
    return value


def _events(value: Any, info: ValidationInfo) -> int:
    return check_events(value, info.context["source"].file, "[run] events")  # type: ignore[index] # always given, in _validate


def _selection(value: Any, info: ValidationInfo) -> str:
    if value not in names():
        raise InputError(f"{info.context['source'].file}: [run] selection {show(value)} {unknown(str(value))}")  # type: ignore[index] # as above
    return str(value)


def read_document(raw: Mapping[str, Any], source: Source) -> dict[str, Any]:
    """Check a parsed TOML document; return title, description and the five tables, every quantity a float in SI.

    Raises InputError: one line that begins with the file and says the place, what was found and what is allowed.
    """
    document = _validate(_Document, dict(raw), source)
    kinds = {table: kind_of(table, document[table], source.file) for table in KINDS}
    for table in TABLES:
        document[table] = read_table(table, kinds.get(table, kinds["body"]), document[table], source, kinds["friction"].state)  # type: ignore[attr-defined] # registered
    return document


def read_table(table: str, kind: type, raw: dict[str, Any], source: Source, state: StateVariable | None = None) -> dict[str, Any]:
    """One table, checked; the points of a law come from the file that it names, if it does. Raises InputError."""
    columns = columns_of(table, kind)
    if columns and "file" in raw:
        name = raw["file"]
        both = next((key for key in columns.values() if key in raw), None)
        if both or not isinstance(name, str):
            got = f"and {both} exclude each other" if both else f"must be text in quotes, got {show(name)}"
            raise InputError(f"{source.file}: [{table}] file {got}")
        points = read_points(name, source.folder, columns, value_column(columns), f"{source.file}: [{table}] file")
        raw = {key: value for key, value in raw.items() if key != "file"} | points
    return _validate(table_model(table, kind, state), raw, source, table)


def columns_of(table: str, kind: type) -> dict[str, str]:
    """Columns of a data file that may stand instead of lists, each with the list it is for."""
    columns: dict[str, str] = getattr(kind, "columns", {}) if has_kind(table) else {}
    varies = table.partition(".")[2]
    return {varies if column == "value" else column: of for column, of in columns.items()}


def value_column(columns: Mapping[str, str]) -> str:
    """The column that the others say where to find: the last one."""
    return list(columns)[-1]


def kind_of(table: str, content: Mapping[str, Any], file: str) -> type:
    """The class that `kind` names in a table."""
    kind, registered = content.get("kind"), REGISTERED[table.partition(".")[0]]
    if "kind" not in content:
        raise InputError(f"{file}: [{table}] kind is missing; allowed: {', '.join(sorted(registered))}")
    if not isinstance(kind, str) or kind not in registered:
        raise InputError(f"{file}: [{table}] kind {show(kind)} is unknown; {nearest(str(kind), registered)}")
    return registered[kind]


def _validate(model: type[BaseModel], raw: dict[str, Any], source: Source, table: str = "") -> dict[str, Any]:
    try:
        return dict(model.model_validate(raw, context={"source": source}))
    except ValidationError as error:
        raise InputError(_one_line(error, model, source.file, table)) from None


_RANK = {"extra_forbidden": 0, "missing": 2}
"""Which of several errors is told: a misspelt key makes the right one missing too, and the misspelling is the news."""


def _one_line(error: ValidationError, model: type[BaseModel], file: str, table: str) -> str:
    first = min(error.errors(), key=lambda one: _RANK.get(one["type"], 1))
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, InputError):
        return str(cause)
    name = str(first["loc"][0])
    shown = name if name.replace("_", "").replace("-", "").isalnum() and name.isascii() and len(name) <= 40 else show(name)
    place = f"[{table}] {shown}" if table else f"[{shown}]" if name in TABLES or isinstance(first["input"], dict) else shown
    if first["type"] == "extra_forbidden":
        return f"{file}: {place} is unknown; {_belongs(name, table) or nearest(name, model.model_fields)}"
    if first["type"] == "missing":
        meaning = model.model_fields[name].description if table else None
        return f"{file}: {place} is missing" + (f": {meaning}" if meaning else "")
    return f"{file}: {place} must be {'a table' if name in TABLES else 'text in quotes'}, got {show(first['input'])}"


def _belongs(name: str, table: str) -> str:
    """A hint where the key is right but stands in another table."""
    for body in KINDS["body"].values():
        for other in TABLES:
            if (
                other not in ("friction", table)
                and not table.startswith("friction.")
                and name in table_model(other, body).model_fields
            ):
                return f"it belongs into [{other}]"
    return ""
