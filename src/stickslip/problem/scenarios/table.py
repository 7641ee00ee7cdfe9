"""A table that an extension adds to scenario files, such as [contact].

A scenario that has one keeps what it says in `Scenario.tables`. A table may say that the scenario is of another kind than those of
the core: what is solved is then what `ScenarioTable.problem` returns, and a solver of the extension solves it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import fields
from importlib import import_module
from typing import TYPE_CHECKING, Any

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Choice, Quantity, quantities_of
from stickslip.problem.scenarios.entries import Source, as_written

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

    from stickslip.problem.problem import Problem
    from stickslip.problem.scenarios.scenario import Scenario
    from stickslip.problem.scenarios.schema import Key


class ScenarioTable:
    """What a table of an extension holds, and what it means; by default, a dataclass whose declared fields are the keys."""

    name: str
    """The name of the table in files: when a file is read, that under which the extension adds it."""
    what = "[{}]"
    """What a scenario that has it, and is of a kind of its own, is said to have; braces stand for its name."""
    instead = "leave out [{}] for the problem of a single contact"
    """What to do where a problem of the core is needed."""
    run_keys: frozenset[str] | None = None
    """The keys that [run] may have beside the table; None for all."""
    why_no_others = "has no effect with this table"
    """Why [run] may have no other key."""
    in_place_of: frozenset[str] = frozenset()
    """The tables of the core that a scenario with this one does not have: `completed` fills them in, and nobody is shown them."""

    def __init__(self, kind: type | None = None) -> None:
        self._kind = kind

    def kind(self) -> type:
        """Return the class whose declared quantities are keys of the table: the one that was given."""
        assert self._kind is not None
        return self._kind

    def other_keys(self) -> Mapping[str, Key]:
        """Return its keys that are no quantities."""
        return {}

    def completed(self, raw: Mapping[str, Any], source: Source) -> Mapping[str, Any]:
        """Return a document that has the table, with what the table makes needless filled in. Raises InputError."""
        return raw

    def read(self, entries: Mapping[str, Any], problem: Problem, source: Source) -> Any:
        """Return what the table says, from its keys, which are read and checked. Raises InputError."""
        from stickslip.problem.scenarios.schema import without_owner

        try:
            return self.kind()(**entries)
        except InputError as error:
            raise InputError(f"{source.file}: [{self.name}] {without_owner(error)}") from None

    def write(self, value: Any) -> dict[str, Any]:
        """Return the table of a value, in SI."""
        given = {one.name: getattr(value, one.name) for one in fields(value)}
        return {name: as_written(one) for name, one in given.items() if one is not None}

    def paths(self, value: Any, problem: Problem) -> Iterator[tuple[str, Quantity | Choice]]:
        """Yield its parameters, which `--set`, sweeps and controls may change: their places in the table, and what they are."""
        yield from quantities_of(self.kind()).items()

    def whole(self) -> frozenset[str]:
        """Return the names of its parameters that count, and are whole numbers."""
        # an annotation is a type or its text, and names in the text may be there for type checkers only: it is not evaluated
        return frozenset(one.name for one in fields(self.kind()) if "int" in re.findall(r"\w+", str(one.type)))

    def pressed(self, value: Any, factor: float) -> Any:
        """Return a value for a problem whose normal load, and all loads, are `factor` times as large."""
        return value

    def problem(self, value: Any, scenario: Scenario) -> Any:
        """Return what is solved in place of the scenario's own problem; None if it is that. Raises InputError."""
        return None

    def check(self, value: Any, scenario: Scenario, source: Source) -> None:
        """Refuse a table that does not suit the rest of the scenario. Raises InputError."""

    def examples(self) -> Traversable | None:
        """Return a folder of scenario files that come with the extension, which then have names as bundled scenarios do."""
        return None


class LateTable(ScenarioTable):
    """A table whose module is imported when a scenario has it, or when somebody asks for more than its examples."""

    def __init__(self, home: str, examples: Traversable | None = None) -> None:
        """Take the home of the table as "module:name", and the folder of its scenario files."""
        object.__setattr__(self, "_late", (home, examples, []))

    def examples(self) -> Traversable | None:
        """Return the folder that was given: see `ScenarioTable.examples`."""
        folder: Traversable | None = object.__getattribute__(self, "_late")[1]
        return folder

    def __getattribute__(self, name: str) -> Any:
        home, _, found = object.__getattribute__(self, "_late")
        if name == "examples":
            return object.__getattribute__(self, name)
        if not found:
            module, _, kind = home.partition(":")
            found.append(getattr(import_module(module), kind)())
        return getattr(found[0], name)
