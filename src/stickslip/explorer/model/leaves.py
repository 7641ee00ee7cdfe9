"""The entries of a scenario document by their full paths, such as "friction.alpha"."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from stickslip.foundation.errors import InputError

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
