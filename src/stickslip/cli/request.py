"""What `stickslip run` was asked for: a scenario or a file to go on from, what replaces its numbers, and what is wanted of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.cli.output.files import CATALOGUES, Target, check_targets
from stickslip.cli.overrides import load_with, option_for, typed_option
from stickslip.foundation.errors import InputError
from stickslip.foundation.memory import chosen_memory
from stickslip.problem.scenarios import Scenario
from stickslip.run import FILES_OF_CORE

if TYPE_CHECKING:
    from stickslip.cli.output.pictures import Pictures
    from stickslip.cli.typed_options import TypedOptions


AS_BEGUN = ("rtol", "creep_rtol", "shortest_event", "selection")
"""Options of a run that cannot change while it goes on."""


@dataclass(frozen=True, kw_only=True)
class Request:
    """The options of `stickslip run` as they were typed.

    `changes` are the values of --set.
    """

    scenario: str | None
    resume: Path | None
    changes: Sequence[str] | None
    options: TypedOptions
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
        as_begun = [getattr(self.options, name) for name in AS_BEGUN]
        if self.resume is not None and any(option is not None for option in (self.changes, self.catalogue, *as_begun)):
            options = ", ".join(map(option_for, AS_BEGUN))
            raise InputError(f"run: --resume goes on as the run began: leave out --set, {options} and --catalogue")

    @property
    def typed(self) -> dict[str, Any]:
        """What was typed of the options that concern the accuracy and the kind of results, by option; None is not typed."""
        others = {option_for(name): value for name, value in vars(self.options).items() if name != "duration"}
        return others | {"--catalogue": self.catalogue}

    @property
    def duration(self) -> float | None:
        """The duration that was typed, s, or None."""
        typed: float | None = typed_option("duration", self.options.duration, "run")
        return typed

    @property
    def events(self) -> int | None:
        """The number of slip events that was typed, or None."""
        typed: int | None = typed_option("max_events", self.options.max_events, "run")
        return typed

    @cached_property
    def chosen(self) -> Scenario:
        """The scenario with the changes that the options ask for. Raises InputError."""
        assert self.scenario is not None
        return load_with("run", self.scenario, self.changes, any_kind=True, **self.options.replaced)

    @property
    def most_pieces(self) -> int:
        """The largest number of pieces that the history of a catalogue may have."""
        from stickslip.problem import MAX_PIECES
        from stickslip.run import CAPACITY

        return max(self.options.max_pieces or MAX_PIECES, CAPACITY)
