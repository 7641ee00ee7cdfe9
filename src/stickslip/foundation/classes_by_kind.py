"""Classes by their names in scenario files, each imported when it is first asked for: a run uses one law of many."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, MutableMapping
from importlib import import_module
from typing import TypeVar

Base = TypeVar("Base")


class ClassesByKind(MutableMapping[str, type[Base]]):
    """A mapping from kinds to classes; a user may add a class, under a kind of its own or in place of another."""

    def __init__(self, home: str, places: Mapping[str, str]) -> None:
        """Take the place of each class below the package `home`, as in "laws.of_rate.Coulomb"."""
        self._home = home
        self._known: dict[str, str | type[Base]] = dict(places)

    def __getitem__(self, kind: str) -> type[Base]:
        found = self._known[kind]
        if not isinstance(found, str):
            return found
        module, name = f"{self._home}.{found}".rsplit(".", 1)
        known: type[Base] = getattr(import_module(module), name)
        self._known[kind] = known
        return known

    def __setitem__(self, kind: str, known: type[Base]) -> None:
        self._known[kind] = known

    def __delitem__(self, kind: str) -> None:
        del self._known[kind]

    def __contains__(self, kind: object) -> bool:
        return kind in self._known

    def __iter__(self) -> Iterator[str]:
        return iter(self._known)

    def __len__(self) -> int:
        return len(self._known)

    def __repr__(self) -> str:
        return repr(dict(self))
