"""A run that is made, or read from a file, when it is asked for: what `compare` and `export` take."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import Scenario, read_source
from stickslip.run.kinds import reader_of
from stickslip.run.progress import Progress
from stickslip.run.simulate import simulate
from stickslip.run.study import uninterrupted
from stickslip.solution import Solution
from stickslip.solution.files import read_solution


class RunSource(NamedTuple):
    """A run to compare or to export: its name, and a function that runs or reads it, with a callback for its progress.

    The function raises KeyboardInterrupt if Ctrl-C ends the run.
    """

    name: str
    solution: Callable[[Progress | None], Solution]


def run_source(
    source: str | Path | Scenario | Solution, duration: float | None = None, rtol: float | None = None, who: str = "compare"
) -> RunSource:
    """Return the run described by a bundled scenario's name, a scenario file, a solution file (.nc), a scenario or a solution.

    `duration` (s) and `rtol` replace those of a scenario; `who` begins messages. Raises InputError if `source` is none of these,
    and if `duration` or `rtol` is given with a solution, which has been run already.
    """
    computed = isinstance(source, Solution)
    if (computed or Path(str(source)).suffix == ".nc") and not (duration is None and rtol is None):
        raise InputError(f"{'a solution' if computed else source}: has been run: leave out duration and rtol")
    if isinstance(source, Solution):
        return RunSource("run", lambda _: source)
    if Path(str(source)).suffix == ".nc":
        if (reader := reader_of(Path(str(source)))) is not None:
            raise InputError(f"{who}: {source} holds {reader.what}, and a run of the exact solver is needed")
        solution = read_solution(Path(str(source)))
        return RunSource(Path(str(source)).stem, lambda _: solution)
    scenario = read_source(who, source, duration)
    changed = scenario.with_given({"rtol": rtol})
    return RunSource(scenario.name, lambda progress: uninterrupted(simulate(changed, progress=progress)))
