"""A slab whose slip varies along the contact: a line of contact (2D) or a plane of it (3D), in JAX.

`slab.py` says what is solved, `nodes.py` what each node is, `memory.py` and `echo.py` how waves come back along the half-space and
from the driver, `friction.py` what the contact answers, `layout.py` how fields and modes are spread over devices. `step.py` takes a
step of time with these, and `solver.py` a run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.extension import Extension

if TYPE_CHECKING:
    from stickslip.extensions.planar.solution import PlanarSolution as PlanarSolution
    from stickslip.problem.scenarios import Scenario, ScenarioTable
    from stickslip.run import Reader, SolverKind


class PlanarExtension(Extension):
    """`ss.PlanarSlab`, the table [contact] of scenario files, and the solver of both."""

    name = "planar"

    def solvers(self) -> Sequence[SolverKind]:
        """Return the solver of planar slabs."""
        from stickslip.extensions.planar.kind import PLANAR

        return (PLANAR,)

    def tables(self) -> Mapping[str, ScenarioTable]:
        """Return the table [contact]."""
        from stickslip.problem.scenarios import LateTable

        return {"contact": LateTable("stickslip.extensions.planar.table:ContactTable", Path(__file__).with_name("bundled"))}

    def readers(self) -> Sequence[Reader]:
        """Return the reader of their folders."""
        from stickslip.extensions.planar.kind import PlanarReader

        return (PlanarReader(),)

    def public(self) -> Mapping[str, str]:
        """Return `ss.PlanarSlab`."""
        return {"PlanarSlab": "stickslip.extensions.planar.slab:PlanarSlab"}


EXTENSION = PlanarExtension()


# ---- what other extensions may use -----------------------------------------------------------------------------------------------


def usual_frames() -> int:
    """Return the number of frames in each two-way travel time that a run keeps if nobody says otherwise."""
    from stickslip.extensions.planar.run import FRAMES

    return FRAMES


def memory_of_run(scenario: Scenario) -> float:
    """Return the memory (bytes) that the run of a scenario with a [contact] needs, besides that of Python and its libraries."""
    from stickslip.extensions.planar.run import memory_of
    from stickslip.extensions.planar.table import contact_of, planar_slab_of

    slab, frames = planar_slab_of(scenario), contact_of(scenario).frames
    return memory_of(slab.alone_for(scenario.duration)[0], scenario.duration, frames or usual_frames())


def count_pulses(rate: Any, threshold: float) -> Any:
    """Return the number of slip pulses at each node, as `pulses.pulses` says."""
    from stickslip.extensions.planar.pulses import pulses

    return pulses(rate, threshold)


def length_of_process_zone(modulus: float, fall: float) -> float:
    """Return the length (m) over which friction falls behind a slow front.

    `modulus` is the shear modulus (Pa), and `fall` the steepest fall of friction with slip (Pa/m).
    """
    from stickslip.extensions.planar.slab import PROCESS_ZONE

    return PROCESS_ZONE * modulus / fall
