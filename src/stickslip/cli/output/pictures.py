"""The figures and the animation that `stickslip run` can draw, with one option for each."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from stickslip.cli.options import FIGURES, option, picture
from stickslip.cli.output.files import PICTURES, FigureLook, Target, drawing, write_files
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    import pandas as pd

    from stickslip.problem import Problem
    from stickslip.solution import Solution

ANIMATION = "Save the slab in motion (.gif; .mp4 and .webm need ffmpeg)."
FILMS = (".gif", ".mp4", ".webm")
"""File suffixes of animations, those of `figures.runs.animation`, which takes long to import."""


@dataclass(frozen=True)
class Pictures:
    """The file of each figure and of the animation, None for those that are not wanted."""

    figure: Annotated[Path | None, picture("slip, slip rate and traction over time", "--figure", "-f")] = None
    path: Annotated[Path | None, picture("the path of the run in the set K", "--path")] = None
    catalogue_figure: Annotated[Path | None, picture("the slip events", "--catalogue-figure")] = None
    energy_figure: Annotated[Path | None, picture("where the energy is", "--energy-figure")] = None
    friction_figure: Annotated[Path | None, picture("the friction coefficient against slip", "--friction-figure")] = None
    space_time: Annotated[Path | None, picture("the inside of the slab over time", "--space-time")] = None
    animation: Annotated[Path | None, option(ANIMATION, panel=FIGURES)] = None
    look: FigureLook = field(default_factory=FigureLook)

    @property
    def wanted(self) -> dict[str, Path]:
        """The files that are wanted, by option."""
        named = {"--" + one.name.replace("_", "-"): getattr(self, one.name) for one in fields(self) if one.name != "look"}
        return {option: target for option, target in named.items() if target is not None}

    def targets(self) -> list[Target]:
        """Return the files that are wanted, with the suffixes that they may have."""
        return [Target(name, path, FILMS if name == "--animation" else PICTURES) for name, path in self.wanted.items()]

    def check(self) -> None:
        """Refuse an animation that could not be written, and a look that figures cannot have. Raises InputError."""
        self.look.check(*(target for option, target in self.wanted.items() if option != "--animation"))
        if self.animation is not None:
            from stickslip.figures.runs.animation import check_animation

            check_animation(self.animation, "--animation")

    def check_problem(self, problem: Problem, command: str = "run") -> None:
        """Refuse, before the run, figures that this problem does not have. Raises InputError."""
        inside = [option for option in self.wanted if option in ("--space-time", "--animation")]
        if inside:
            from stickslip.figures.runs.asked import DRAWN_KINDS

            if not DRAWN_KINDS[problem.body.structure].has_inside:
                raise InputError(f"{command}: {inside[0]} needs a slab or a string: a block is rigid and has no interior field")
        if self.path is not None:
            from stickslip.contact import uniqueness_of

            if uniqueness_of(problem).resistance is None:
                what = "a slab or a string without a mass at its contact: with inertia the slip rate is a state, there is no set K"
                raise InputError(f"{command}: --path needs {what}")

    def check_only(self, where: str, has: str, *options: str) -> None:
        """Refuse all figures but those of some options; `has` says so in words. Raises InputError, which begins with `where`."""
        if others := [option for option in self.wanted if option not in options]:
            raise InputError(f"{where}: {has}: leave out {', '.join(others)}")

    def check_events(self, where: str) -> None:
        """Refuse, before the run, all figures but the one that a catalogue of slip events has. Raises InputError."""
        self.check_only(where, "a catalogue keeps slip events only, no history", "--catalogue-figure")

    def draw_events(self, table: pd.DataFrame, title: str, load_unit: str) -> list[Path]:
        """Draw the figure of a catalogue, of a body whose loads have this unit, if it is wanted and there is an event.

        Return its file.
        """
        from stickslip.figures.runs import catalogue

        shown = partial(catalogue.draw_catalogue, catalogue.ShownCatalogue(table, title, load_unit))
        return write_files((self._file_of_events(table), drawing(shown, self.look)))

    def draw(self, solution: Solution) -> list[Path]:
        """Draw all that are wanted, and return their files."""
        events = None if self.catalogue_figure is None else self._file_of_events(solution.events)  # needs pandas
        return write_files(
            (self.figure, drawing(solution.plot, self.look)),
            (self.path, drawing(solution.plot.path, self.look)),
            (events, drawing(solution.plot.catalogue, self.look)),
            (self.energy_figure, drawing(solution.plot.energy, self.look)),
            (self.friction_figure, drawing(solution.plot.friction, self.look)),
            (self.space_time, drawing(solution.plot.field, self.look)),
            (self.animation, lambda target: animated(solution, target)),
        )

    def _file_of_events(self, table: pd.DataFrame) -> Path | None:
        """Return the file of the figure of slip events, None if it is not wanted; if there is no event, say so and return None."""
        if self.catalogue_figure is not None and table.empty:
            typer.echo(f"not written: {self.catalogue_figure} (there is no slip event)")
            return None
        return self.catalogue_figure


def animated(solution: Any, target: Path) -> Path:
    """Write the animation of a run with its progress on one line, and return the file."""
    from stickslip.run import progress_line

    with progress_line(f"{target}:") as report:
        found: Path = solution.plot.animation(target, progress=lambda done, frames: report(f"frame {done} of {frames}"))
    return found
