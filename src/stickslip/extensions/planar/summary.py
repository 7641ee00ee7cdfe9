"""Show a run whose contact has many nodes: its size before the start, and what happened at its end."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stickslip.cli.output.files import file_size
from stickslip.cli.output.show import console, say, titled
from stickslip.extensions.planar.table import contact_of, planar_slab_of
from stickslip.foundation.show import brief
from stickslip.problem.scenarios import doubts

if TYPE_CHECKING:
    from stickslip.extensions.planar.solution import PlanarSolution
    from stickslip.problem.scenarios import Scenario


def size_of(scenario: Scenario, *, streamed: bool = False) -> str:
    """Return the memory that a run of a scenario needs, in words; less of it if its frames are `streamed` to a folder."""
    from stickslip.extensions.planar.run import FRAMES, memory_of

    slab = planar_slab_of(scenario)
    solved, _ = slab.alone_for(scenario.duration)
    beyond = "" if solved.shape == slab.shape else f", with {_shape(solved.shape)} nodes against replicas"
    frames = 0 if streamed else contact_of(scenario).frames or FRAMES
    return f"{file_size(memory_of(solved, scenario.duration, frames))}{beyond}"


def announce_run(scenario: Scenario, *, streamed: bool) -> None:
    """Print on standard output what is about to be run, with its frames `streamed` to a folder or kept in memory."""
    slab, size = planar_slab_of(scenario), size_of(scenario, streamed=streamed)
    apart = " and ".join(brief(one, "m") for one in slab.spacing)
    steps = f"{slab.steps(scenario.duration)} steps up to {brief(scenario.duration, 's')}"
    screen = titled(scenario)
    say(screen, f"{_shape(slab.shape)} nodes, {apart} apart; {steps}; needs {size}")
    say(screen, *(f"warning: {one}" for one in doubts(scenario.problem)))


def show_run(solution: PlanarSolution) -> None:
    """Print the summary of a run on standard output."""
    say(console(), str(solution.status), *solution.sentences)


def _shape(shape: tuple[int, ...]) -> str:
    return " x ".join(map(str, shape))
