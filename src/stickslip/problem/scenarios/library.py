"""The scenarios that come with the package: names, texts, and one line on each; and the starters, which explain every key."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from stickslip.extension import tables
from stickslip.foundation.errors import InputError, nearest

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


class BundledEntry(NamedTuple):
    """The description of a bundled scenario: its title, one sentence on its purpose, and the trade in which it is at home."""

    title: str
    description: str
    trade: str


class Starter(NamedTuple):
    """What a starter shows, and the bundled scenario whose values it has."""

    meaning: str
    example: str


STARTERS = {
    "slab": Starter("an elastic slab", "fig6-slab"),
    "lab-slab": Starter("an elastic slab in the size of a laboratory", "granite-slab"),
    "block": Starter("a block on a spring", "fig6-block-reconstructed"),
    "string": Starter("a drill string", "drill-string"),
    "sectioned-string": Starter("a drill string of pipe and collars", "pipe-and-collar"),
    "layered-slab": Starter("a slab of layers", "low-velocity-zone"),
    "two-slabs": Starter("slabs on both sides of a contact", "steel-on-granite"),
}


NAMES_LISTED = "`stickslip new --list` lists them"
"""Where all names are."""


@cache
def _files() -> dict[str, Traversable]:
    """Return the files of all bundled scenarios by their names, in alphabetical order: our own, and those of extensions."""
    added = [folder for table in tables().values() if (folder := table.examples()) is not None]
    folders = (*added, Path(__file__).with_name("bundled"))  # no extension replaces one of the core
    found = {
        file.name.removesuffix(".toml"): file for folder in folders for file in folder.iterdir() if file.name.endswith(".toml")
    }
    return dict(sorted(found.items()))


def names() -> list[str]:
    """Return the sorted names of the bundled scenarios."""
    return list(_files())


def text(name: str) -> str:
    """Return the TOML text of a bundled scenario. Raises InputError for a name that is not among `names()`."""
    if name not in names():
        raise InputError(f"no bundled scenario {ascii(name)[:60]}; {nearest(name, names(), listed=NAMES_LISTED)}")
    return _files()[name].read_text(encoding="utf-8")


@cache
def _documents() -> dict[str, dict[str, Any]]:
    return {name: tomllib.loads(text(name)) for name in names()}


def entries() -> dict[str, BundledEntry]:
    """Return what each bundled scenario says about itself, by name."""
    return {name: BundledEntry(*(document[key] for key in BundledEntry._fields)) for name, document in _documents().items()}


def by_trade() -> dict[str, list[str]]:
    """Return the names of the bundled scenarios by their trade, both in alphabetical order."""
    found: dict[str, list[str]] = {}
    for name, entry in sorted(entries().items(), key=lambda one: one[1].trade):
        found.setdefault(entry.trade, []).append(name)
    return found


def in_1d() -> list[str]:
    """Return the names of the bundled scenarios without tables of extensions."""
    return [name for name, document in _documents().items() if not set(tables()) & set(document)]
