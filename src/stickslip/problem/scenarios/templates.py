"""Commented scenarios to start from: the bundled ones, and starters that are written from the declarations of laws and bodies."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping, Sequence
from copy import deepcopy
from dataclasses import MISSING
from types import MappingProxyType
from typing import Any

from stickslip.extension import tables
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.names import KINDS_OF_BODY, TURNS
from stickslip.foundation.quantities import LawField, NamedNumbers, fields_of
from stickslip.foundation.show import brief, clean
from stickslip.friction import LAWS, FrictionLaw
from stickslip.friction.contract import STATE_NAMES, StateVariable, states_in
from stickslip.problem.accelerogram import ALL_HISTORIES
from stickslip.problem.bodies.soft_torque import MEANING as SOFT_TORQUE_MEANS
from stickslip.problem.drivers.driver import loading_rate
from stickslip.problem.fields import HISTORIES_ONLY
from stickslip.problem.loading import HISTORIES
from stickslip.problem.problem import Problem
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.entries import Source, describe, key_of, to_table
from stickslip.problem.scenarios.parameter_paths import find_parameter, put_into
from stickslip.problem.scenarios.scenario import scenario_of
from stickslip.problem.scenarios.schema import (
    SOFT_TORQUE,
    TABLES,
    TABLES_WITH_KIND,
    WITH_SOFT_TORQUE,
    columns_of,
    entries_in,
    has_kind,
    kind_of,
    read_part,
)
from stickslip.problem.selection_rule import SELECTION_RULES

LOADINGS = 3
"""Number of loads from nothing to the strength in which a contact slips several times, as few events take all of the load."""
LEAST_TRIPS, MOST_TRIPS = 20, 100
"""Such a run has so many periods of a block, or round trips of waves, at least; and so many round trips at most, each of which may
have many pieces.
"""
_HEADER = """\
# A scenario for stickslip: what slides, what resists, how it is loaded, where it starts, how long to run.
# Every quantity is a number in SI or a text with a unit: "10 km", "0.05 m/year" (Julian year), "100 MPa".
# Lines that begin with "#" are comments; a commented key shows its default or waits for a value.
#
#     stickslip check FILE     show what it means, and what to know before trusting a run
#     stickslip run FILE       run it
#
# Many nodes along the contact, a fault in 2D or 3D, have a table [contact]: `stickslip new planar-patch` explains it.
"""
_ABOUT = {
    "body": "The body that slides.",
    "friction": "The friction law of the contact.",
    "loading": "The motion of the driver.",
    "initial": "The initial state: give either load or excess (load minus static strength).",
    "run": "How long, how accurately, and which slip rate where the contact equation has several solutions.",
}


def template_names() -> list[str]:
    """Return every name that `template` accepts."""
    return [*library.STARTERS, *library.names()]


def template(name: str, friction: str | None = None, pull: str | None = None) -> str:
    """Return a commented scenario as TOML text: a starter, one of `library.STARTERS`, or a bundled scenario.

    `friction` and `pull` are kinds of another law, which then has plausible values, and of a loading history for the pull rate of a
    starter. Raises InputError for unknown names, and if a bundled scenario is to have another law or pull rate.
    """
    if name in library.STARTERS:
        return _starter(tomllib.loads(library.text(library.STARTERS[name].example)), friction, pull)
    if name not in template_names():
        raise InputError(f"no scenario '{name}'; {nearest(name, template_names(), listed=library.NAMES_LISTED)}")
    if friction is not None or pull is not None:
        chosen = "pull rate" if friction is None else "friction law"
        raise InputError(f"new: only {', '.join(library.STARTERS)} take a {chosen}; {name} has its own")
    return library.text(name)


def check_takes_law(name: str) -> None:
    """Raise InputError unless `with_law` knows the name."""
    if name not in template_names():
        raise InputError(f"no scenario '{name}'; {nearest(name, template_names(), listed=library.NAMES_LISTED)}")
    if name not in (*library.STARTERS, *library.in_1d()):
        document = tomllib.loads(library.text(name))
        what = next(table.what.format(one) for one, table in tables().items() if one in document)
        raise InputError(f"{name} has a {what}, which takes no other law: name another scenario")


def with_law(name: str, law: FrictionLaw, about: Sequence[str], values: Mapping[str, Any] = MappingProxyType({})) -> str:
    """Return a starter or a bundled scenario with another friction law without a state, as commented TOML text to the last digit.

    `about` are lines of comments for the head of the text. The title is that of the scenario, with the kind of the law; a starter
    says what slides, and runs for some loads of its contact. `values` are other values of its
    parameters, as for `Scenario.with_values`, but for those of friction. Raises InputError for an unknown name, and for values that
    the scenario cannot have.
    """
    check_takes_law(name)
    example = tomllib.loads(library.text(library.STARTERS[name].example if name in library.STARTERS else name))
    of_body = KINDS_OF_BODY[kind_of("body", example["body"], name).load_unit]  # type: ignore[attr-defined] # registered
    if law.slips_in not in ("", of_body.slip):
        raise InputError(f"{name}: the points are in {law.slips_in}, but its contact {of_body.moves}: name another scenario")
    former = kind_of("friction", example["friction"], name)
    if former.state is not None:  # type: ignore[attr-defined] # registered
        example["initial"] = {"excess": 0.0}
    starter, changes = library.STARTERS.get(name), []
    title = f"{starter.meaning.capitalize() if starter else example['title'] or name}, under a law of the kind {law.kind}"
    example |= {"title": title, "description": f"Body, loading and start of {name}.", "friction": _listed(to_table(law))}
    if values:
        scenario = scenario_of(example, Source(name))
        changes = [(one, one.read(value, name)) for key, value in values.items() for one in (find_parameter(scenario, key, name),)]
        taken = next((one.name for one, _ in changes if one.name.startswith("friction.")), None)
        if taken is not None:
            raise InputError(f"{name}: {taken} belongs to the law, which comes from the points")
        example = put_into(example, scenario, changes, name)
        _ = scenario_of(example, Source(name))
    if starter and all(one.name != "run.duration" for one, _ in changes):
        example["run"] = example["run"] | _lasting(scenario_of(example, Source(name)).problem)
    return _written(example, "".join(f"# {clean(line)}".rstrip() + "\n" for line in about))


def _lasting(problem: Problem) -> dict[str, str]:
    """Return the duration of a run in which the contact is loaded some times, as its key and value; none if nothing loads it."""
    rate, trip = loading_rate(problem), problem.body.round_trip_time
    if not rate > 0.0:
        return {}
    lasts = max(LOADINGS * problem.strength / rate, LEAST_TRIPS * trip)
    lasts = min(lasts, MOST_TRIPS * trip) if problem.body.has_waves else lasts
    return {"duration": brief(float(f"{lasts:.1g}"), "s")}


def _listed(table: dict[str, Any]) -> dict[str, Any]:
    """Return a table with lists in place of tuples."""
    made = {}
    for key, value in table.items():
        made[key] = _listed(value) if isinstance(value, dict) else list(value) if isinstance(value, tuple) else value
    return made


def _starter(example: dict[str, Any], friction: str | None, pull: str | None) -> str:
    load_unit = kind_of("body", example["body"], "new").load_unit  # type: ignore[attr-defined] # registered
    if friction is not None:
        law: type[FrictionLaw] = kind_of("friction", {"kind": friction}, "new")
        example["friction"] = {"kind": friction} | example_of(law, load_unit)
        if not law.sticks:
            example["initial"] = _start_of(law, example["body"])
    if pull is not None:
        kind_of("loading", {"kind": pull}, "new")
        history = dict(HISTORIES[pull].example)
        history = _by_angle("loading.pull_rate", {"kind": pull, **history}) if load_unit == TURNS else history
        example["loading"] = {"pull_rate": {"kind": pull, **history}}
    return _written(example | {"title": "", "description": ""})


def _written(example: dict[str, Any], about: str = "") -> str:
    """Return a scenario as text that explains every key, after `about`, some lines of comments."""
    kinds = {table: kind_of(table, example[table], "starter") for table in TABLES_WITH_KIND}
    texts = [f"{key} = {_toml(example[key])}\n" for key in ("title", "description") if key == "title" or example[key]]
    parts = [about + "#\n" * bool(about) + _HEADER, "".join(texts)]
    for table in TABLES:
        kind = kinds.get(table, kinds["body"])
        lines = [f"# {_ABOUT[table]}"]
        if table == "friction" and not about:
            lines += ["# Other laws, shown in full by `stickslip new slab --friction KIND`:", "#"]
            lines += [f"# kind = {json.dumps(other.kind)}  # {_first_line(other)}" for other in LAWS.values() if other is not kind]
        if table == "loading":
            lines.append(f"# A pull rate that varies: `stickslip new slab --pull KIND`, KIND one of {', '.join(HISTORIES)}.")
        states = states_in(getattr(kinds["friction"], "state", None))  # a typed state is not that of the class
        lines += _table(table, kind, example[table], kinds["body"].load_unit, states)  # type: ignore[attr-defined] # registered
        if table == "run":
            given = [f"{key} = {_toml(example[table][key])}" for key in ("selection",) if key in example[table]]
            lines += given or [f'# selection = "{SELECTION_RULES[0]}"  # or {", ".join(SELECTION_RULES[1:])}']
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def _start_of(law: type[FrictionLaw], body: dict[str, Any]) -> dict[str, Any]:
    """Return [initial] for a law that never sticks: its example's states, and a load of the example's share of the normal load."""
    read = read_part("body", body, Source("starter"))
    states = {name: law.start[name] for name in STATE_NAMES if name in law.start}
    return {"load": law.start["coefficient"] * read.normal_load} | states


def example_of(law: type[FrictionLaw], load_unit: str) -> dict[str, Any]:
    """Return the example values of a law by their keys in a scenario, for a body whose loads have this unit.

    Where the contact turns they are the same numbers, in rad in place of m.
    """
    made = {key_of(name, entry): deepcopy(law.example[name]) for name, (entry, _) in fields_of(law).items() if name in law.example}
    return _by_angle("friction", {"kind": law.kind, **made}) if made and load_unit == TURNS else made


def _by_angle(table: str, content: dict[str, Any]) -> dict[str, Any]:
    """Return a law or a history with plain numbers in place of texts with units of length."""
    made = _listed(to_table(read_part(table, content, Source("example"))))
    return {key: value for key, value in made.items() if key != "kind"}


def _table(table: str, kind: type, example: dict[str, Any], load_unit: str, states: tuple[StateVariable, ...] = ()) -> list[str]:
    """Return the lines of a table with its keys, and of the tables inside it."""
    lines, inner = [f"[{table}]"], []
    if has_kind(table):
        lines.append(f"kind = {json.dumps(kind.kind)}  # {_first_line(kind)}")  # type: ignore[attr-defined] # registered
    for name, (entry, default) in entries_in(table, kind, states, load_unit).items():
        value = example.get(name)
        if value is None and table == "loading" and name in HISTORIES_ONLY:
            lines.append(f"# {name} = {{...}}  # {describe(entry)}: a table [{table}.{name}], of the kinds named above")
            continue
        if table == "loading" and isinstance(value, dict):
            inner += [
                "",
                f"# {describe(entry)}, as it varies in time",
                *_table(f"{table}.{name}", ALL_HISTORIES[value["kind"]], value, load_unit),
            ]
        elif isinstance(entry, LawField) and value:
            inner += ["", *_table(f"{table}.{name}", LAWS[value["kind"]], value, load_unit)]
        elif isinstance(entry, NamedNumbers):
            inner += ["", f"# {describe(entry)}", f"[{table}.{name}]"]
            inner += [f"{parameter} = {_toml(number)}" for parameter, number in (value or {}).items()]
        elif value is not None:
            lines.append(f"{name} = {_toml(value)}  # {describe(entry)}")
        else:
            shown = "" if default is None or default is MISSING else _toml(default)
            lines.append(f"# {name} = {shown}  # {describe(entry)}".replace("=   #", "=  #"))
    if table == "body" and hasattr(kind, WITH_SOFT_TORQUE):
        lines.append(f"# {SOFT_TORQUE} =  # {SOFT_TORQUE_MEANS}")
    columns = columns_of(table, kind)
    if columns:
        lines.append(f'# file = "points.csv"  # instead of lists: columns {", ".join(columns)}, in SI or with units as in (mm/s)')
    if len(columns) > 2:
        *others, _ = columns
        lines.append(f'# along = "{others[-1]}"  # the column that counts, if the file has {" and ".join(others)}')
    return lines + inner


def _first_line(kind: type) -> str:
    return (kind.__doc__ or "").strip().splitlines()[0]


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(_toml(one) for one in value)}]"
    short = f"{value:g}".replace("e+", "e")
    return short if isinstance(value, float) and ("e" in short or "inf" in short) and float(short) == value else repr(value)
