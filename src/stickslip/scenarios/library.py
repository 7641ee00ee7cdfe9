"""The scenarios that come with the package: names, texts, one line on each, and `ss.scenarios`."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from functools import cache
from html import escape
from importlib import resources
from importlib.resources.abc import Traversable
from typing import TYPE_CHECKING, Any, NamedTuple

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError, nearest

if TYPE_CHECKING:
    from stickslip.scenarios.scenario import Scenario


class Entry(NamedTuple):
    """What a bundled scenario says about itself: its title, and one sentence on what it shows."""

    title: str
    description: str


def _folder() -> Traversable:
    return resources.files("stickslip.scenarios") / "bundled"


def names() -> list[str]:
    """Return the sorted names of the bundled scenarios."""
    return sorted(file.name.removesuffix(".toml") for file in _folder().iterdir() if file.name.endswith(".toml"))


def text(name: str) -> str:
    """Return the TOML text of a bundled scenario. Raises InputError for a name that is not among `names()`."""
    if name not in names():
        raise InputError(f"no bundled scenario {ascii(name)[:60]}; {nearest(name, names())}")
    return (_folder() / f"{name}.toml").read_text(encoding="utf-8")


@cache
def _documents() -> dict[str, dict[str, Any]]:
    return {name: tomllib.loads(text(name)) for name in names()}


def entries() -> dict[str, Entry]:
    """Return what each bundled scenario says about itself, by name."""
    return {name: Entry(document["title"], document["description"]) for name, document in _documents().items()}


def in_1d() -> list[str]:
    """Return the names of the bundled scenarios without a contact of many nodes."""
    return [name for name, document in _documents().items() if "contact" not in document]


class BundledScenarios(Mapping[str, "Scenario"]):
    """The bundled scenarios by name: `ss.scenarios["fig6-slab"]` reads one, `print(ss.scenarios)` lists all.

    Iterating gives the names. A name that is not bundled raises InputError, which names the nearest one; a file is read with
    `stickslip.load_scenario`.
    """

    def __getitem__(self, name: str) -> Scenario:
        from stickslip.scenarios.scenario import load_scenario  # which a list of names can do without

        if not isinstance(name, str):
            raise InputError(f"scenarios: a name must be text, such as 'fig6-slab', got {shown(name)}")
        if name not in self:
            cure = "a file is read with ss.load_scenario" if name.endswith(".toml") else nearest(name, names())
            raise InputError(f"no bundled scenario {ascii(name)[:60]}; {cure}")
        return load_scenario(name)

    def __contains__(self, name: object) -> bool:
        return name in names()

    def __iter__(self) -> Iterator[str]:
        return iter(names())

    def __len__(self) -> int:
        return len(names())

    def __repr__(self) -> str:
        width = max(len(name) for name in self)
        return "\n".join(f"{name:<{width}}  {entry.title}" for name, entry in entries().items())

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><th style='text-align:left'>{name}</th><td style='text-align:left'>{escape(entry.title)}</td>"
            f"<td style='text-align:left'>{escape(entry.description)}</td></tr>"
            for name, entry in entries().items()
        )
        return f"<table><caption>bundled scenarios: ss.scenarios[name], ss.simulate(name)</caption>{rows}</table>"

    def _ipython_key_completions_(self) -> list[str]:
        return names()


scenarios = BundledScenarios()
"""The bundled scenarios, as `stickslip.scenarios`."""
