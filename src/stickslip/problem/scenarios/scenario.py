"""A scenario: a problem with a duration, read from one TOML file and written back in SI."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.extension import tables as tables_of_extensions
from stickslip.foundation.arguments import as_path, for_users, shown
from stickslip.foundation.conversion import Number
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import check_fields, declare, fields_of
from stickslip.foundation.show import ShownAsTable, shown_fields
from stickslip.problem.loading import LoadingHistory
from stickslip.problem.problem import Problem
from stickslip.problem.run_options import DURATION, RunOptions
from stickslip.problem.scenarios import library
from stickslip.problem.scenarios.entries import Source, as_written, key_of, to_table
from stickslip.problem.scenarios.schema import read_document, read_part, read_table, without_owner
from stickslip.problem.scenarios.text_of_files import about_suffix, read_text, why_not_toml

UNNAMED = "scenario"
"""Name of a scenario that has none of its own."""
DEEPEST = 20
"""Largest number of parts in a dotted key: tomllib takes a time that grows with the square of this number."""
LARGEST_TEXT = 4_000_000
"""Largest number of characters of a scenario, as in a file of results, which holds the points of data files, too."""
MOST_TABLES = 100
"""Largest number of tables in a scenario; the laws with most parts have a fifth of it."""
LARGE_COEFFICIENT, SMALL_STRESS, LARGE_SIZE = 3.0, 10.0, 10.0
"""A static coefficient above, a normal stress (Pa) of a slab below, or a string or bit wider (m) than these raises a question."""
KEYS_OF_RUN = {name: key_of(name, entry) for name, (entry, _) in fields_of(RunOptions).items()}
"""The keys of [run], by option."""
_HEADING = re.compile(r"""^[ \t]*\[{1,2}[ \t]*[A-Za-z_"']""", re.MULTILINE)
_LONG_KEY = re.compile(rf"""(?<![\w-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){{{DEEPEST}}}""")


@dataclass(frozen=True)
class OfProblem:
    """What belongs to a problem, which is given first: `Scenario(problem, 10.0)`."""

    problem: Problem


@dataclass(frozen=True)
class Scenario(ShownAsTable, RunOptions, OfProblem):
    """A problem, and how long (s, or a text with a unit) and how accurately to run it.

    Two scenarios are equal if they differ in `name` and `source`, the TOML text from which it was read, only. After `max_events`
    slip events the run stops. `creep_rtol` and `shortest_event` (s) are options of `stickslip.simulate`; None stands for automatic.
    `tables` has what tables of extensions say, such as [contact], each with its name.
    """

    duration: Number = declare(DURATION)  # again, as in `BoundedOptions`
    tables: tuple[tuple[str, Any], ...] = ()
    name: str = field(default=UNNAMED, compare=False)
    source: str = field(default="", compare=False, repr=False)

    def __post_init__(self) -> None:
        check_fields(self)

    def __repr__(self) -> str:
        fields_shown = dict(shown_fields(self))
        problem, head = fields_shown.pop("problem"), [self.name, *([self.title] if self.title else [])]
        problem = repr(self.problem.friction) if self.lacks else problem
        others = ", ".join(f"{name}={text}" for name, text in fields_shown.items() if name not in ("name", "title", "description"))
        return f"stickslip Scenario {': '.join(head)}\n{problem}\n{others}"

    def _lines(self) -> list[tuple[str, str]]:
        law = [("friction", repr(self.problem.friction))] if self.lacks else []
        return law + [(name, text.strip("'")) for name, text in shown_fields(self) if name != "problem"]

    def _repr_html_(self) -> str:
        return super()._repr_html_() + ("" if self.lacks else self.problem._repr_html_())

    @property
    def heading(self) -> str:
        """The title of figures: the scenario's title or name; "" if it has neither."""
        return self.title or (self.name if self.name != UNNAMED else "")

    def table(self, name: str) -> Any:
        """Return what the table of an extension says, such as "contact"; None if the scenario has no such table."""
        return dict(self.tables).get(name)

    def with_table(self, name: str, value: Any) -> Scenario:
        """Return the scenario with a table of an extension, in place of the one that it may have; None for without it."""
        others = tuple(one for one in self.tables if one[0] != name)
        return replace(self, tables=others if value is None else (*others, (name, value)))

    @cached_property
    def to_solve(self) -> Any:
        """What a solver is given: the problem, or what the table of an extension makes of it, such as a `PlanarSlab`.

        Raises InputError if two tables make something of it.
        """
        found = {name: tables_of_extensions()[name].problem(value, self) for name, value in self.tables}
        special = {name: one for name, one in found.items() if one is not None}
        if len(special) > 1:
            raise InputError(f"{self.name}: [{'] and ['.join(special)}] each say what is solved: leave out all but one")
        return next(iter(special.values()), self.problem)

    @property
    def is_of_core(self) -> bool:
        """True if its own problem is solved, and not what the table of an extension makes of it."""
        return self.to_solve is self.problem

    @property
    def run_keys(self) -> frozenset[str] | None:
        """The keys that its [run] may have; None for all."""
        found = [keys for name, _ in self.tables if (keys := tables_of_extensions()[name].run_keys) is not None]
        return frozenset.intersection(*found) if found else None

    @property
    def lacks(self) -> dict[str, str]:
        """The tables of the core that it does not have, each with the name of the table that takes its place."""
        return {one: name for name, _ in self.tables for one in sorted(tables_of_extensions()[name].in_place_of)}

    @cached_property
    def document(self) -> dict[str, Any]:
        """The scenario as a parsed TOML document, which must not be changed. Raises InputError as `to_toml` does."""
        return tomllib.loads(self.to_toml())

    def with_values(self, values: Mapping[str, Any]) -> Scenario:
        """Return a scenario with other values of some parameters, such as {"friction.alpha": 2.0, "body.thickness": "5 km"}.

        Values are numbers in SI, texts with a unit, or words; names are as in `stickslip.sweep`. The title says what was changed;
        the description, which may no longer be true, is left out. An initial load replaces an initial excess, and an excess a load.
        Raises InputError if there is no such parameter, or if it cannot have the value.
        """
        from stickslip.problem.scenarios.parameter_paths import with_values

        return with_values(self, values, self.name)

    def to_toml(self) -> str:
        """Return the scenario as TOML text, to the last digit: with values in SI, but for those in rpm, g, inch and the like."""
        import tomli_w  # here, because few runs write a scenario

        problem = self.problem
        tables: dict[str, Any] = {key: value for key, value in (("title", self.title), ("description", self.description)) if value}
        tables |= {"body": to_table(problem.body), "friction": to_table(problem.friction), "loading": {}, "initial": {}}
        for f in fields(problem):
            value = getattr(problem, f.name)
            if value is not None and value is not False and f.name not in ("body", "friction", "selection"):
                table = "initial" if f.name.startswith("initial_") else "loading"
                tables[table][f.name.removeprefix("initial_")] = (
                    to_table(value) if isinstance(value, LoadingHistory) else as_written(value)
                )
        tables = {name: table for name, table in tables.items() if name not in self.lacks}
        tables |= {name: tables_of_extensions()[name].write(value) for name, value in self.tables}
        run: dict[str, Any] = {key: getattr(self, name) for name, key in KEYS_OF_RUN.items()}
        run["selection"] = problem.rule
        allowed = run if self.run_keys is None else self.run_keys
        tables["run"] = {name: value for name, value in run.items() if value is not None and name in allowed}
        return tomli_w.dumps(tables, multiline_strings=True)


def doubts(problem: Problem) -> list[str]:
    """Return the questions about the numbers of a problem, one line each."""
    found, static = [], problem.strength / problem.normal
    if static > LARGE_COEFFICIENT:
        found.append(f"the static friction coefficient is {static:.4g}; rock has 0.1 to 1: is it a percentage?")
    if problem.load_unit == "Pa" and problem.normal < SMALL_STRESS:
        found.append(f"the normal stress is {problem.normal:.4g} Pa: mPa is a thousandth of a pascal, MPa is a million")
    sizes = {name: np.max(getattr(problem.body, name, None) or 0.0) for name in ("outer_diameter", "bit_radius")}
    return found + [f"{name} is {one:.6g} m: is it in mm? write '{one:.6g} mm'" for name, one in sizes.items() if one > LARGE_SIZE]


@for_users
def load_scenario(path_or_name: str | Path) -> Scenario:
    """Read a scenario file (TOML), or a bundled scenario or a starter by its name; a file of the name of a starter comes first.

    Raises InputError if the scenario cannot be read or is not valid. The message is one line with the file, the place in it, what
    was found and what is allowed.
    """
    if isinstance(path_or_name, str) and path_or_name in library.names():
        return read_scenario(library.text(path_or_name), path_or_name)
    if isinstance(path_or_name, str) and path_or_name in library.STARTERS and not Path(path_or_name).exists():
        from stickslip.problem.scenarios.templates import template

        return read_scenario(template(path_or_name), path_or_name)
    path = as_path("load_scenario: path_or_name", path_or_name, "the name of a file or of a bundled scenario")
    file = str(path) if str(path).isprintable() else shown(str(path))
    return read_scenario(read_text(path, file), file, name=path.stem, folder=path.parent)


def read_scenario(text: str, file: str, name: str | None = None, folder: Path | None = None) -> Scenario:
    """Read a scenario from TOML text; `file` is the name of the text in messages. Raises InputError as `load_scenario`.

    `name` is that of the scenario, `file` by default. Without a `folder` of its data files it cannot name any.
    """
    if len(text) > LARGEST_TEXT:
        raise InputError(f"{file}: longer than {LARGEST_TEXT} characters: not a scenario")
    if len(_HEADING.findall(text)) > MOST_TABLES:
        raise InputError(f"{file}: has more than {MOST_TABLES} tables: not a scenario")
    if _LONG_KEY.search(text):
        raise InputError(f"{file}: a key has more than {DEEPEST} parts: not a scenario")
    try:
        raw = tomllib.loads(text)
    except RecursionError:
        raise InputError(f"{file}: not a scenario: nested too deeply") from None
    except ValueError as error:  # tomllib.TOMLDecodeError, and whole numbers beyond what Python converts
        raise InputError(f"{file}: {about_suffix(file) or why_not_toml(text, str(error))}") from None
    return replace(scenario_of(raw, Source(file, folder)), name=name or file, source=text)


def scenario_of(raw: Mapping[str, Any], source: Source) -> Scenario:
    """Return a scenario from a parsed TOML document. Raises InputError as `load_scenario` does."""
    for name, table in tables_of_extensions().items():
        raw = table.completed(raw, source) if name in raw else raw
    document, file = read_document(raw, source), source.file
    body = read_part("body", document["body"], source)
    source = source._replace(load_unit=body.load_unit)
    law = read_part("friction", document["friction"], source)
    others = ("loading", "initial", "run")
    loading, initial, run = (read_table(table, type(body), document[table], source, law.states) for table in others)
    start = {f"initial_{name}": value for name, value in initial.items()}
    try:
        problem = Problem(body, law, **loading, **start, selection=run.pop("selection"))
    except InputError as error:
        raise InputError(f"{file}: {_in_tables(without_owner(error))}") from None
    options = {name: run[key] for name, key in KEYS_OF_RUN.items()}
    found = Scenario(problem, **options, title=document["title"], description=document["description"], name=file)
    found.check_with(problem, file, lambda option: f"[run] {option}")
    return _with_tables(found, document, source)


def _with_tables(plain: Scenario, document: Mapping[str, Any], source: Source) -> Scenario:
    """Return a scenario with the tables of extensions that a document has. Raises InputError."""
    given = {name: table for name, table in tables_of_extensions().items() if document[name] is not None}
    found = plain
    for name, table in given.items():
        needless = next((key for key in document["run"] if table.run_keys is not None and key not in table.run_keys), None)
        if needless is not None:
            raise InputError(f"{source.file}: [run] {needless} {table.why_no_others}: leave it out")
        table.name = name
        entries = read_table(name, table.kind(), document[name], source)
        found = found.with_table(name, table.read(entries, plain.problem, source))
    for name, table in given.items():
        table.check(found.table(name), found, source)
    _ = found.to_solve if given else None
    return found


def _in_tables(message: str) -> str:
    """Return a message of `Problem` with the names that a scenario file uses."""
    if message.startswith(("far_stress", "only one of pull_rate")):
        return f"[loading] {message}"
    if message.startswith("needs either"):
        return f"[initial] {message.replace('initial_', '')}"
    return message.replace("initial_", "[initial] ")


class BundledScenarios(ShownAsTable, Mapping[str, Scenario]):
    """The bundled scenarios by name: `ss.scenarios["fig6-slab"]` reads one, `print(ss.scenarios)` lists all.

    Iterating gives the names. A name that is not bundled raises InputError, which names the nearest one; a file is read with
    `stickslip.load_scenario`.
    """

    def __getitem__(self, name: str) -> Scenario:
        if not isinstance(name, str):
            raise InputError(f"scenarios: a name must be text, such as 'fig6-slab', got {shown(name)}")
        if name not in self:
            close = nearest(name, library.names(), listed=library.NAMES_LISTED)
            cure = "a file is read with ss.load_scenario" if name.endswith(".toml") else close
            raise InputError(f"no bundled scenario {ascii(name)[:60]}; {cure}")
        return load_scenario(name)

    def __contains__(self, name: object) -> bool:
        return name in library.names()

    def __iter__(self) -> Iterator[str]:
        return iter(library.names())

    def __len__(self) -> int:
        return len(library.names())

    def __repr__(self) -> str:
        width = max(len(name) for name in self)
        return "\n".join(f"{name:<{width}}  {entry.title}" for name, entry in library.entries().items())

    @property
    def _caption(self) -> str:
        return "bundled scenarios: ss.scenarios[name], ss.simulate(name)"

    def _lines(self) -> list[tuple[str, str, str]]:
        return [(name, entry.title, entry.description) for name, entry in library.entries().items()]

    def _ipython_key_completions_(self) -> list[str]:
        return library.names()


scenarios = BundledScenarios()
"""The bundled scenarios, as `stickslip.scenarios`."""
