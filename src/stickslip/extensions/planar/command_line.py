"""How the command line runs a contact of many nodes, and shows its runs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from typing_extensions import override

from stickslip.cli.kinds import KindOfRun, check_same
from stickslip.cli.output.files import drawing, write_files
from stickslip.cli.output.pictures import Pictures, animated
from stickslip.cli.results import RunToShow
from stickslip.extensions.planar.summary import announce_run, show_run
from stickslip.extensions.planar.table import planar_slab_of
from stickslip.foundation.errors import InputError
from stickslip.run import progress_line

if TYPE_CHECKING:
    from stickslip.cli.request import Request
    from stickslip.extensions.planar.solution import PlanarSolution

DRAWN: Sequence[str] = ("--figure", "--animation")
"""The pictures that these runs have."""


@dataclass(frozen=True)
class PlanarResults(RunToShow):
    """A run of a contact of many nodes."""

    solution: PlanarSolution
    is_fresh: bool = False
    """True if its size has been said before the run."""

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        check_pictures(pictures, where)

    @override
    def summarise(self, *, everything: bool = False) -> None:
        if not self.is_fresh:
            announce_run(self.scenario, streamed=True)
        show_run(self.solution)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        figure = drawing(self.solution.plot, pictures.look)
        return write_files((pictures.figure, figure), (pictures.animation, lambda target: animated(self.solution, target)))


def check_pictures(pictures: Pictures, where: str) -> None:
    """Refuse figures that a contact of many nodes does not have. Raises InputError."""
    pictures.check_only(where, f"a [contact] of many nodes has {' and '.join(DRAWN)}", *DRAWN)


class PlanarKindOfRun(KindOfRun):
    """The run of a contact of many nodes, in a folder if it is kept."""

    suffix = ".zarr"

    @override
    def check(self, request: Request) -> None:
        check_pictures(request.pictures, "run")
        if needless := [option for option, value in request.typed.items() if value is not None]:
            raise InputError(
                f"run: {needless[0]} has no effect with a [contact], whose nodes and courant set the accuracy: leave it out"
            )
        if request.energy:
            raise InputError("run: --energy belongs to --catalogue FILE")

    @override
    def run(self, request: Request) -> PlanarResults:
        """Run, and say before the start how large the run is. Raises InputError."""
        from stickslip.extensions.planar.run import simulate_planar
        from stickslip.run import CallOptions

        if request.resume is not None:
            return _resumed(request, request.resume)
        chosen = request.chosen
        announce_run(chosen, streamed=request.out is not None)
        with progress_line(f"{chosen.name}:") as report:
            run = simulate_planar(chosen, CallOptions.of(chosen, progress=report, checkpoint=request.out))
        return PlanarResults(chosen, run, is_fresh=True)


def _resumed(request: Request, folder: Path) -> PlanarResults:
    from stickslip.extensions.planar.contact import Contact
    from stickslip.extensions.planar.run import resume_planar
    from stickslip.extensions.planar.store_layout import open_planar, scenario_in

    if request.out is not None:
        raise InputError(f"run: --resume {folder} continues in its own folder: leave out --out")
    stopped, began = open_planar(folder), scenario_in(folder)
    check_same(request, stopped.slab.problem)
    if request.scenario is not None and Contact.of(planar_slab_of(request.chosen)) != Contact.of(stopped.slab):
        raise InputError(f"{folder}: is a run of another problem than {request.scenario}: its [contact] differs")
    announce_run(began if request.duration is None else replace(began, duration=request.duration), streamed=True)
    with progress_line(f"{folder.stem}:") as report:
        return PlanarResults(began, resume_planar(folder, request.duration, progress=report), is_fresh=True)
