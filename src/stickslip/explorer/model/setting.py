"""The setting of the explorer's controls: a scenario document and what has been changed in it."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from contextlib import suppress
from copy import deepcopy
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, Self

from stickslip.foundation.errors import InputError, gathered
from stickslip.scenarios import library
from stickslip.scenarios.entries import Source
from stickslip.scenarios.scenario import Scenario, scenario_of
from stickslip.scenarios.source import all_slips_alike

DEEPEST = 5
"""Largest number of parts in a path."""


def leaves_of(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return all entries that are no tables by their paths; an empty table is one of them."""
    return dict(_leaves(document, ""))


def _leaves(table: Mapping[str, Any], before: str) -> Iterator[tuple[str, Any]]:
    for key, value in table.items():
        if isinstance(value, Mapping) and value:
            yield from _leaves(value, f"{before}{key}.")
        else:
            yield f"{before}{key}", value


def document_of(leaves: Mapping[str, Any]) -> dict[str, Any]:
    """Return the document with these entries. Raises InputError if a path is too deep, or leads through an entry."""
    document: dict[str, Any] = {}
    for path, value in leaves.items():
        *tables, key = path.split(".")
        place = document
        for table in tables:
            place = place.setdefault(table, {})
            if not isinstance(place, dict):
                break
        if len(tables) >= DEEPEST or not isinstance(place, dict) or isinstance(place.get(key), dict):
            raise InputError(f"{ascii(path)[:60]} is not the place of an entry: it is too deep, or leads through another one")
        place[key] = value
    return document


@dataclass(frozen=True)
class Setting:
    """A scenario as the controls hold it: a TOML document, never changed in place, whose entries can be replaced one by one.

    `name` is the bundled scenario it began with, or the name of a file or an upload. `notes` are doubts about the file from which
    the friction law was read, one line each; they go with that law.
    """

    name: str
    document: Mapping[str, Any] = field(repr=False)
    notes: tuple[str, ...] = field(default=(), compare=False, repr=False)

    @classmethod
    def bundled(cls, name: str) -> Self:
        """Return the setting of a bundled scenario. Raises InputError for an unknown name."""
        return cls(name, _bundled(name))

    @classmethod
    def of(cls, scenario: Scenario) -> Self:
        """Return the setting of a scenario: with the entries of its text, or in SI if it has none or names files of data.

        Raises InputError if the scenario cannot be written as text, because its law is a function of Python.
        """
        if scenario.source:
            setting = cls(scenario.name, tomllib.loads(scenario.source))
            with suppress(InputError):
                if setting.scenario() == scenario:
                    return setting
        return cls(scenario.name, tomllib.loads(scenario.to_toml()))

    def value(self, path: str) -> Any:
        """Return the entry at a path such as "friction.alpha" or "loading.pull_rate"; None if the document has none."""
        found: Any = self.document
        for key in path.split("."):
            found = found.get(key) if isinstance(found, Mapping) else None
        return found

    def with_value(self, path: str, value: Any) -> Self:
        """Return a setting in which one entry is replaced, or left away if `value` is None."""
        document = deepcopy(dict(self.document))
        *tables, key = path.split(".")
        place = document
        for table in tables:
            place = place.setdefault(table, {})
        if value is None:
            place.pop(key, None)
        else:
            place[key] = value
        return replace(self, document=document, notes=() if path.partition(".")[0] == "friction" else self.notes)

    @property
    def is_changed(self) -> bool:
        """True if the setting began with a bundled scenario and differs from it."""
        return self.name in library.names() and self.document != _bundled(self.name)

    @property
    def title(self) -> str:
        """The title of the scenario; it says so if the scenario is changed, because it may name numbers that no longer hold."""
        title = str(self.value("title") or "")
        return f"{title}, changed" if title and self.is_changed else title

    def scenario(self) -> Scenario:
        """Return the scenario. Raises InputError, with one line that names the entry that is wrong."""
        return self.read()[0]

    def read(self) -> tuple[Scenario, tuple[str, ...]]:
        """Return the scenario, and doubts about its entries, one line each. Raises InputError as `scenario` does."""
        with gathered() as doubts:
            scenario = replace(scenario_of(self.document, Source(self.name, None)), name=self.name, title=self.title)
        return all_slips_alike("explore", scenario), tuple(dict.fromkeys((*self.notes, *doubts)))


@cache
def _bundled(name: str) -> dict[str, Any]:
    """Return the document of a bundled scenario, which must not be changed."""
    return tomllib.loads(library.text(name))
