"""How the command line runs a chain, and shows its runs."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from typing_extensions import override

from stickslip.cli.kinds import KindOfRun
from stickslip.cli.output.files import drawing, write_files
from stickslip.cli.output.pictures import Pictures
from stickslip.cli.output.show import console, say, titled
from stickslip.cli.results import RunResults, RunToShow
from stickslip.extensions.chains.summary import lines_of, proof_of
from stickslip.foundation.errors import InputError
from stickslip.run import progress_line

if TYPE_CHECKING:
    from stickslip.cli.request import Request
    from stickslip.extensions.chains.run import ChainRun

CHAIN_PICTURES: Sequence[str] = ("--figure", "--catalogue-figure", "--energy-figure", "--space-time")
"""The pictures that these runs have: the catalogue (twice), energies, and the rupture of the largest event."""
TYPED = ("--events",)
"""The options that these runs take beside the duration."""


@dataclass(frozen=True)
class ChainResults(RunToShow):
    """A run of a chain."""

    solution: ChainRun
    took: float | None = None
    """Wall-clock time of the run, s; None if it comes from a folder."""
    steps_before: int = 0
    """Steps of blocks that it had when that time began."""

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        check_pictures(pictures, where)

    @override
    def summarise(self, *, everything: bool = False) -> None:
        titled(self.scenario)
        more = [proof_of(self.solution)] if everything else []
        say(console(), str(self.status), *lines_of(self.solution, self.took, self.steps_before), *more)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        if not pictures.wanted:
            return []
        plot = self.solution.plot
        return write_files(
            (pictures.figure, drawing(plot, pictures.look)),
            (pictures.catalogue_figure, drawing(plot.catalogue, pictures.look)),
            (pictures.energy_figure, drawing(plot.energy, pictures.look)),
            (pictures.space_time, drawing(plot.rupture, pictures.look)),
        )


def check_pictures(pictures: Pictures, where: str) -> None:
    """Refuse figures that a chain does not have. Raises InputError."""
    pictures.check_only(where, f"a [chain] has {', '.join(CHAIN_PICTURES)}", *CHAIN_PICTURES)


class KindOfChain(KindOfRun):
    """The run of a chain, in a folder if it is kept."""

    suffix = ".zarr"

    @override
    def check(self, request: Request) -> None:
        check_pictures(request.pictures, "run")
        if request.catalogue is not None:
            raise InputError("run: --catalogue has no effect with a [chain]: --csv writes its events, and --out keeps them")
        if needless := [option for option, value in request.typed.items() if value is not None and option not in TYPED]:
            raise InputError(f"run: {needless[0]} has no effect with a [chain], whose events are located to rounding: leave it out")
        if request.energy:
            raise InputError("run: --energy has no effect with a [chain]: its events have their energies")

    @override
    def run(self, request: Request) -> ChainResults:
        """Run from the start, or from where a folder left the run. Raises InputError."""
        from stickslip.extensions.chains.running import simulate_chain
        from stickslip.run import CallOptions

        if request.resume is not None:
            return _resumed(request, request.resume)
        chosen, began = request.chosen, time.monotonic()
        with progress_line(f"{chosen.name}:") as report:
            run = simulate_chain(chosen, CallOptions.of(chosen, progress=report, checkpoint=request.out))
        return ChainResults(chosen, run, time.monotonic() - began)

    @override
    def how_to_go_on(self, request: Request, results: RunResults) -> str:
        file = self.file(request)
        if results.status.name != "interrupted":
            return ""
        return f"nothing is lost: stickslip run --resume {file} goes on from there" if file is not None else ""


def _resumed(request: Request, folder: Path) -> ChainResults:
    from stickslip.extensions.chains.running import resume_chain
    from stickslip.extensions.chains.store_layout import open_chain, scenario_in
    from stickslip.extensions.chains.table import CHAIN

    if request.out is not None:
        raise InputError(f"run: --resume {folder} continues in its own folder: leave out --out")
    scenario = scenario_in(folder)
    if request.scenario is not None:
        asked = request.chosen
        if (asked.table(CHAIN), asked.problem.friction) != (scenario.table(CHAIN), scenario.problem.friction):
            raise InputError(f"{folder}: is a run of another chain than {request.scenario}")
    began, before = time.monotonic(), open_chain(folder).moving_steps
    with progress_line(f"{folder.stem}:") as report:
        run = resume_chain(folder, request.duration, max_events=request.events, progress=report)
    return ChainResults(replace(scenario, duration=run.duration or scenario.duration), run, time.monotonic() - began, before)
