"""Results as the command line shows them, fresh from a run or read from a file: a summary, pictures, and a table."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.cli.output.files import announce, drawing, write_files
from stickslip.cli.output.show import console, say, titled
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import clean
from stickslip.problem import Status

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.cli.output.pictures import Pictures
    from stickslip.problem import Problem
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import Catalogue
    from stickslip.solution import Account, Solution

DONE = Status("finished", "the run is finished", ok=True)
"""The status of a run that has none."""
MANY_EVENTS = 100_000
"""A catalogue with more events than this is not read again for the summary of its run."""


class Results(ABC):
    """Results of one kind."""

    @abstractmethod
    def check(self, pictures: Pictures, where: str) -> None:
        """Refuse pictures that these results do not have. Raises InputError, which begins with `where`."""

    @abstractmethod
    def summarise(self, *, everything: bool = False) -> None:
        """Print the summary; with `everything`, also what is known of the proof of a run, its waves and its predictability."""

    @abstractmethod
    def draw(self, pictures: Pictures) -> list[Path]:
        """Draw the pictures that are wanted, and return their files."""

    @abstractmethod
    def to_csv(self, path: Path) -> Path:
        """Write the numbers as CSV, with a unit in each heading, and return the path."""

    def of_quantity(self, name: str, path: Path) -> Results:
        """Return the results with another quantity to draw. Raises InputError if there is no choice, or no such quantity."""
        raise InputError(f"show: --quantity chooses what is drawn of a sweep, and {path} is not a sweep")


class RunResults(Results):
    """Results of a run, whose status says what ended it."""

    @property
    @abstractmethod
    def status(self) -> Status:
        """What ended the run."""


@dataclass(frozen=True)
class RunToShow(RunResults):
    """A run that has a status and a table of its own."""

    scenario: Scenario
    solution: Any

    @property
    @override
    def status(self) -> Status:
        found: Status = self.solution.status
        return found

    @override
    def to_csv(self, path: Path) -> Path:
        """Write its table, and return the path."""
        return Path(self.solution.to_csv(path))


@dataclass(frozen=True)
class WholeRun(RunToShow):
    """A run with its whole history."""

    solution: Solution

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        pictures.check_problem(self.solution.problem, "show")

    @override
    def summarise(self, *, everything: bool = False) -> None:
        from stickslip.cli.output.summary import show_solution

        show_solution(self.scenario, self.solution, everything=everything)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        return pictures.draw(self.solution)


@dataclass(frozen=True)
class PlainRun(RunResults):
    """A run of the solver of an extension that says no more: its summary is its text; it may have `plot`, `to_csv` and `status`."""

    scenario: Scenario
    run: Any

    @property
    @override
    def status(self) -> Status:
        found = getattr(self.run, "status", DONE)
        return found if isinstance(found, Status) else DONE  # it may be a word of the extension's own

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        pictures.check_only(where, "a run of this kind has --figure", "--figure")

    @override
    def summarise(self, *, everything: bool = False) -> None:
        screen = titled(self.scenario)
        for line in str(self.run).splitlines():
            say(screen, clean(line))

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        if pictures.figure is None:
            return []
        if not hasattr(self.run, "plot"):
            raise InputError(f"run: {self.scenario.name}: a run of this kind has no figure: leave out --figure")
        return write_files((pictures.figure, drawing(self.run.plot, pictures.look)))

    @override
    def to_csv(self, path: Path) -> Path:
        if not hasattr(self.run, "to_csv"):
            raise InputError(f"run: {self.scenario.name}: a run of this kind has no table: leave out --csv")
        return write_atomically(path, self.run.to_csv)


@dataclass(frozen=True)
class EventsOfRun(RunResults):
    """The slip events that a run has just written to a catalogue."""

    scenario: Scenario
    found: Catalogue

    @property
    @override
    def status(self) -> Status:
        return self.found.account.status

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        pictures.check_events(where)

    @override
    def summarise(self, *, everything: bool = False) -> None:
        from stickslip.cli.output.summary import show_run

        count, problem = self.found.events, self.scenario.problem
        many = f"{count} slip events: `stickslip show` on the catalogue shows them"
        events = many if count > MANY_EVENTS else dict(self.found.read().items())
        show_run(titled(self.scenario), self.found.account, events, problem, everything=everything)
        announce(*self.found.files)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        if not pictures.wanted:
            return []
        chosen = self.scenario
        return pictures.draw_events(self.found.read(), chosen.title or chosen.name, chosen.problem.load_unit)

    @override
    def to_csv(self, path: Path) -> Path:
        raise InputError("run: a catalogue keeps slip events only, no history: leave out --csv")


@dataclass(frozen=True)
class StoredEvents(Results):
    """A table of slip events, with the attributes of its file."""

    path: Path
    about: Mapping[str, Any]
    table: pd.DataFrame

    @cached_property
    def scenario(self) -> Scenario | None:
        """The scenario of the run; None if neither the catalogue nor a checkpoint beside it holds it."""
        from stickslip.problem.scenarios import read_scenario

        return read_scenario(str(self.about["scenario"]), self.path.stem) if "scenario" in self.about else None

    @property
    def problem(self) -> Problem | None:
        """The problem of the run, if that is known."""
        return None if self.scenario is None else self.scenario.problem

    @property
    def account(self) -> Account | None:
        """What the attributes say of the run, if they do."""
        from stickslip.solution import Account

        if self.scenario is None or "status" not in self.about:
            return None
        status = Status(str(self.about["status"]), str(self.about["status_message"]), ok=True)
        return Account(self.scenario, status, float(self.about["duration"]), {word: str(note) for word, note in self.about.items()})

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        pictures.check_events(str(self.path))

    @override
    def summarise(self, *, everything: bool = False) -> None:
        from stickslip.cli.output.summary import show_run

        screen = console()
        say(screen, clean(self.path.stem), style="bold")
        show_run(screen, self.account, dict(self.table.items()), self.problem, everything=everything)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        return pictures.draw_events(self.table, self.path.stem, "Pa" if self.problem is None else self.problem.load_unit)

    @override
    def to_csv(self, path: Path) -> Path:
        """Write the slip events with the units of their columns, and return the path. Raises InputError if these are not known."""
        from stickslip.foundation.atomic_write import write_table
        from stickslip.solution.observables import with_units

        if self.problem is None:
            raise InputError(f"{self.path}: does not say of what body it is, so that its units are not known: leave out --csv")
        return write_table(path, with_units(self.table, self.problem.load_unit), [made_by(self.about)])


@dataclass(frozen=True)
class Stored:
    """The results in a file or folder, with its attributes, which say where they come from."""

    path: Path
    about: Mapping[str, Any]
    results: Results
    own_scenario: str | None = None
    """The scenario as TOML text, where that is not simply the attribute."""

    def scenario(self) -> str:
        """Return the scenario as TOML text. Raises InputError if the file does not hold it."""
        if self.own_scenario is not None:
            return self.own_scenario
        if "scenario" not in self.about:
            raise InputError(f"{self.path}: does not hold its scenario: its checkpoint does, if it is beside it")
        return str(self.about["scenario"])

    def print_origin(self) -> None:
        """Print which version made the results."""
        if "source" in self.about:
            made = clean(str(self.about["source"]))
            say(console(), f"made by {made}; `stickslip show {self.path} --scenario` prints its scenario")


def made_by(about: Mapping[str, Any]) -> str:
    """Return the version that made results, as the comment of a file says it."""
    return clean(str(about.get("source", "written by stickslip")))
