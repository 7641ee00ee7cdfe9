"""What `stickslip run` was asked for: a scenario or a file to go on from, what replaces its numbers, and what is wanted of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.files import CATALOGUES, Target, check_targets
from stickslip.cli.overrides import load_with, read
from stickslip.foundation.errors import InputError
from stickslip.foundation.memory import chosen_memory
from stickslip.problem.scenarios import Scenario, check_events, read_duration
from stickslip.run import FILES_OF_CORE

if TYPE_CHECKING:
    from stickslip.cli.output.pictures import Pictures


@dataclass(frozen=True, kw_only=True)
class Request:
    """The options of `stickslip run` as they were typed.

    `changes` are the values of --set.
    `overrides` are those that replace numbers of the scenario: duration, events, rtol, creep_rtol, shortest_event and selection.
    """

    scenario: str | None
    resume: Path | None
    changes: Sequence[str] | None
    overrides: Mapping[str, Any]
    max_pieces: int | None
    out: Path | None
    catalogue: Path | None
    csv: Path | None
    energy: bool
    pictures: Pictures

    def check_source(self) -> None:
        """Refuse a size of memory that is none, and nothing to run. Raises InputError."""
        chosen_memory()
        if self.scenario is None and self.resume is None:
            raise InputError("run: nothing to run: give a SCENARIO, or --resume FILE")

    def check(self, suffix: str) -> None:
        """Refuse files that could not be written, that of --out must end in `suffix`, and options that exclude each other.

        Raises InputError.
        """
        is_folder = suffix not in FILES_OF_CORE
        if is_folder and self.out is not None and self.out.exists():
            raise InputError(
                f"--out {self.out}: exists: --resume {self.out} continues the run in it; choose another name, or remove it"
            )
        tables = Target("--catalogue", self.catalogue, CATALOGUES), Target("--csv", self.csv, (".csv",))
        check_targets(Target("--out", self.out, (suffix,)), *tables, *self.pictures.targets())
        self.pictures.check()
        as_begun = [self.overrides[name] for name in ("rtol", "creep_rtol", "shortest_event", "selection")]
        if self.resume is not None and any(option is not None for option in (self.changes, self.catalogue, *as_begun)):
            options = "--set, --rtol, --creep-rtol, --shortest-event, --selection and --catalogue"
            raise InputError(f"run: --resume goes on as the run began: leave out {options}")

    @property
    def typed(self) -> dict[str, Any]:
        """What was typed of the options that concern the accuracy and the kind of results, by option; None is not typed."""
        others = {f"--{name.replace('_', '-')}": value for name, value in self.overrides.items() if name != "duration"}
        return others | {"--max-pieces": self.max_pieces, "--catalogue": self.catalogue}

    @property
    def duration(self) -> float | None:
        """The duration that was typed, s, or None."""
        typed: float | None = read(read_duration, self.overrides["duration"], "run", "duration")
        return typed

    @property
    def events(self) -> int | None:
        """The number of slip events that was typed, or None."""
        typed: int | None = read(check_events, self.overrides["events"], "run", "events")
        return typed

    @cached_property
    def chosen(self) -> Scenario:
        """The scenario with the changes that the options ask for. Raises InputError."""
        assert self.scenario is not None
        return load_with("run", self.scenario, self.changes, any_kind=True, **self.overrides)

    @property
    def most_pieces(self) -> int:
        """The largest number of pieces that the history of a catalogue may have."""
        from stickslip.run import CAPACITY, MAX_PIECES

        return max(self.max_pieces or MAX_PIECES, CAPACITY)
