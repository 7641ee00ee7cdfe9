"""How the command line follows a given motion, and shows its runs."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from typing_extensions import override

from stickslip.cli.kinds import KindOfRun
from stickslip.cli.results import PlainRun
from stickslip.foundation.errors import InputError
from stickslip.run import progress_line

if TYPE_CHECKING:
    from stickslip.cli.request import Request

TAKEN = "--rtol"
"""The option beside the duration that a given motion has."""


class MotionKindOfRun(KindOfRun):
    """A run along a given motion, in a netCDF file if it is kept."""

    @override
    def check(self, request: Request) -> None:
        others = {name: value for name, value in request.typed.items() if name != TAKEN} | {"--energy": request.energy or None}
        if needless := [name for name, value in others.items() if value is not None]:
            raise InputError(f"run: a run along a given [motion] has no {needless[0]}: leave it out")
        request.pictures.check_only("run", "a run along a given [motion] has --figure", "--figure")

    @override
    def run(self, request: Request) -> PlainRun:
        """Run, or go on from a file. Raises InputError."""
        if request.resume is not None:
            return _resumed(request, request.resume)
        from stickslip.run.simulate import simulate

        chosen = request.chosen
        with progress_line(f"{chosen.name}:") as report:
            return PlainRun(chosen, simulate(chosen, progress=report, checkpoint=request.out))


def _resumed(request: Request, file: Path) -> PlainRun:
    from stickslip.extensions.given_motion.kept import read_motion, text_of
    from stickslip.extensions.given_motion.run import resume_motion
    from stickslip.problem.scenarios import read_scenario

    if request.scenario is not None:
        stopped = read_motion(file)
        began = read_scenario(text_of(stopped.moved, stopped), file.stem)
        asked = request.chosen
        differs = "[friction]" if asked.problem.friction != began.problem.friction else "[motion]"
        if asked.to_solve is asked.problem or text_of(asked.to_solve, began) != text_of(stopped.moved, began):
            raise InputError(f"{file}: is a run of another problem than {request.scenario}: its {differs} differs")
    with progress_line(f"{file.stem}:") as report:
        run = resume_motion(file, request.duration, progress=report, checkpoint=request.out)
    scenario = read_scenario(text_of(run.moved, run), file.stem)
    return PlainRun(replace(scenario, name=file.stem), run)
