"""The figures and the animation that `stickslip run` can draw, with one option for each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.cli.output.files import check_target
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.problem.problem import Problem
    from stickslip.solution.solution import Solution

SUFFIXES = (".png", ".pdf", ".svg")
"""File suffixes of figures; those of animations differ."""


@dataclass(frozen=True)
class Pictures:
    """The file of each figure and of the animation, None for those that are not wanted."""

    figure: Path | None
    path: Path | None
    catalog_figure: Path | None
    energy: Path | None
    space_time: Path | None
    animation: Path | None

    @property
    def _targets(self) -> dict[str, Path]:
        """Return the files that are wanted, by option."""
        named = {"--" + field.name.replace("_", "-"): getattr(self, field.name) for field in fields(self)}
        return {option: target for option, target in named.items() if target is not None}

    @property
    def wanted(self) -> list[str]:
        """Return the options that were given."""
        return list(self._targets)

    def check(self) -> None:
        """Refuse files that could not be written. Raises InputError."""
        for option, target in self._targets.items():
            if option != "--animation":
                check_target(target, option, SUFFIXES)
        if self.animation is not None:
            from stickslip.figures.runs.animation import SUFFIXES as MOVING
            from stickslip.figures.runs.animation import check_animation

            check_target(self.animation, "--animation", MOVING)
            check_animation(self.animation, "--animation")

    def check_problem(self, problem: Problem) -> None:
        """Refuse, before the run, figures that this problem does not have. Raises InputError."""
        inside = [option for option in self.wanted if option in ("--space-time", "--animation")]
        if inside and not problem.body.has_waves:
            raise InputError(f"run: {inside[0]} needs a slab: a block is rigid and has no interior field")
        if self.path is not None:
            from stickslip.contact.uniqueness import uniqueness

            if uniqueness(problem).resistance is None:
                what = "a slab without contact mass: with inertia the slip rate is a state, there is no set K"
                raise InputError(f"run: --path needs {what}")

    def draw(self, solution: Solution) -> Iterator[Path]:
        """Draw all that are wanted, and yield each file when it is complete."""
        still: tuple[tuple[Path | None, Callable[[Solution], Figure]], ...] = (
            (self.figure, lambda run: run.plot()),
            (self.path, _path),
            (self.catalog_figure, _catalogue),
            (self.energy, lambda run: run.plot_energy()),
            (self.space_time, lambda run: run.plot_field()),
        )
        for target, figure in still:
            if target is not None:
                yield write_atomically(target, figure(solution).savefig)
        if self.animation is not None:
            yield _animate(solution, self.animation)


def _path(solution: Solution) -> Figure:
    from stickslip.figures.contact import admissible

    return admissible.draw(admissible.data(solution.problem, solution))


def _catalogue(solution: Solution) -> Figure:
    from stickslip.figures.runs import catalogue

    return catalogue.draw(catalogue.data(solution))


def _animate(solution: Solution, target: Path) -> Path:
    from stickslip.cli.output.show import progress_to

    with progress_to(f"{target}:") as report:
        return solution.animate(target, progress=lambda done, frames: report(f"frame {done} of {frames}"))
