"""Commented scenarios to start from: the bundled ones as they are, and starters written from what laws and bodies declare."""

from __future__ import annotations

import json
import tomllib
from dataclasses import MISSING
from typing import Any

from stickslip.errors import InputError, nearest
from stickslip.problem import SELECTION_RULES
from stickslip.scenarios import library
from stickslip.scenarios.schema import KINDS, TABLES, kind_of, quantities_in
from stickslip.scenarios.values import describe

STARTERS = {"slab": "fig6-slab", "block": "fig6-block-reconstructed"}
"""Generic starters, and the bundled scenario whose values they show."""

_HEADER = """\
# A scenario for stickslip: what slides, what resists, how it is loaded, where it starts, how long to run.
# Every quantity is a number in SI or a text with a unit: "10 km", "0.05 m/year" (Julian year), "100 MPa".
# Lines that begin with "#" are comments; a commented key shows its default or waits for a value.
#
#     stickslip check FILE     what it means, and what to know before trusting a run
#     stickslip run FILE       run it
"""
_ABOUT = {
    "body": "What stands behind the contact.",
    "friction": "What the contact resists with.",
    "loading": "How the far side moves.",
    "initial": "Where it starts: give either load or excess (load minus static strength).",
    "run": "How long, how accurately, and which slip rate where the contact equation has several solutions.",
}


def template_names() -> list[str]:
    """Every name that `template` knows."""
    return [*STARTERS, *library.names()]


def template(name: str) -> str:
    """A commented scenario as TOML text. Raises InputError for a name that is not among `template_names()`."""
    if name in STARTERS:
        return _starter(tomllib.loads(library.text(STARTERS[name])))
    if name not in template_names():
        raise InputError(f"no scenario '{name}'; {nearest(name, template_names())}")
    return library.text(name)


def _starter(example: dict[str, Any]) -> str:
    kinds = {table: kind_of(table, example[table], "starter") for table in KINDS}
    parts = [_HEADER, 'title = ""\n']
    for table in TABLES:
        kind = kinds.get(table, kinds["body"])
        lines = [f"# {_ABOUT[table]}", f"[{table}]"]
        if table in KINDS:
            lines.append(f"kind = {json.dumps(kind.kind)}  # {_first_line(kind)}")  # type: ignore[attr-defined] # registered
        lines += _keys(table, kind, example[table])
        if table == "run":
            lines.append(f'# selection = "{SELECTION_RULES[0]}"  # or {", ".join(SELECTION_RULES[1:])}')
        if table == "friction":
            lines += [line for other in KINDS[table].values() if other is not kind for line in ("#", *_other(other))]
        parts.append("\n".join(lines) + "\n")
    return "\n".join(parts)


def _keys(table: str, kind: type, example: dict[str, Any]) -> list[str]:
    lines = []
    for name, (declared, default) in quantities_in(table, kind).items():
        if name in example:
            lines.append(f"{name} = {_toml(example[name])}  # {describe(declared)}")
        else:
            shown = "" if default is None or default is MISSING else _toml(default)
            lines.append(f"# {name} = {shown}  # {describe(declared)}".replace("=   #", "=  #"))
    return lines


def _other(kind: type) -> list[str]:
    """Another law, commented out: what to write instead."""
    lines = [f"# kind = {json.dumps(kind.kind)}  # {_first_line(kind)}"]  # type: ignore[attr-defined] # registered
    return lines + _keys("friction", kind, {})


def _first_line(kind: type) -> str:
    return (kind.__doc__ or "").strip().splitlines()[0]


def _toml(value: Any) -> str:
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    short = f"{value:g}".replace("e+", "e")
    return short if isinstance(value, float) and ("e" in short or "inf" in short) and float(short) == value else repr(value)
