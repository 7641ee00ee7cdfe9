"""Run a planar slab from t = 0, and keep the motion of its contact at frames in time."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from stickslip.foundation.arguments import shown
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import in_unit, number
from stickslip.foundation.quantities import Quantity
from stickslip.planar.slab import PlanarSlab
from stickslip.run.run_loop import Interrupts
from stickslip.solution.planar import PlanarSolution

FRAMES = 100
"""Frames in a two-way travel time, by default."""
DURATION = Quantity("s", "latest end of the run", above=0)
MOST_MEMORY = 16e9
"""Largest memory of a run, bytes: echoes need most of it, and they are kept for all round trips to come."""


class PlanarReport(NamedTuple):
    """The progress of the run of a planar slab; as a text it is one line for people."""

    time: float
    """Simulated time so far, s."""
    duration: float
    """Simulated time at the end of the run, s."""
    fastest: float
    """Largest slip rate on the contact now, m/s."""

    def __str__(self) -> str:
        length, unit = in_unit(self.duration)
        moving = f"slips at up to {number(self.fastest, 3)} m/s" if self.fastest > 0.0 else "rests"
        return f"{number(self.time / length, 6)} of {number(self.duration / length, 6)} {unit}, {moving}"


PlanarProgress = Callable[[PlanarReport], object]
"""A function that is called with a `PlanarReport` after each frame."""


def memory_of(slab: PlanarSlab, duration: float, frames: int = FRAMES) -> float:
    """Return the memory (bytes) that a run of this duration (s) needs: exponentials, echoes and frames."""
    body = slab.problem.body
    round_trips, steps = max(1.0, np.ceil(duration / body.round_trip_time)), slab.steps_per_round_trip
    modes = float(np.prod(slab.shape[:-1])) * (slab.shape[-1] // 2 + 1)
    exponentials = 5.0 * (2.0 + np.log2(4.0 * round_trips * steps)) * 64.0 * modes
    echoes = (round_trips - 1.0) * (steps + 1) * 96.0 * modes + 3.0 * (steps + 1) * 16.0 * modes
    kept = min(frames, steps) * duration / body.round_trip_time * 32.0 * float(np.prod(slab.shape))
    return float(exponentials + echoes + kept)


def check_memory(slab: PlanarSlab, duration: float, frames: int) -> None:
    """Raise InputError if a run would need more than MOST_MEMORY."""
    if (needed := memory_of(slab, duration, frames)) > MOST_MEMORY:
        raise InputError(
            f"simulate: this PlanarSlab needs {needed / 1e9:.3g} GB for {duration:g} s, allowed are {MOST_MEMORY / 1e9:g} GB:"
            " take fewer nodes, a shorter duration, or fewer frames"
        )


def simulate_planar(
    slab: PlanarSlab, duration: float | str | WithUnit | None, *, frames: int | None = None, progress: PlanarProgress | None = None
) -> PlanarSolution:
    """Run a planar slab from t = 0.

    Parameters
    ----------
    slab
        What is solved.
    duration
        End of the run (s, or a text with a unit). The run ends with the step that reaches it.
    frames
        Number of frames that are kept of each two-way travel time, as far as there are as many steps; 100 by default.
    progress
        A function that is called with a `PlanarReport` after each frame.

    Returns
    -------
    PlanarSolution
        The frames. Ctrl-C ends the run with those that are done.

    Raises
    ------
    InputError
        If an argument is out of range, or the library JAX is missing (`pip install 'stickslip[planar]'`).
    """
    if duration is None:
        raise InputError("simulate: a PlanarSlab needs a duration, in s or with a unit")
    length, wanted = DURATION.check("simulate", "duration", duration), FRAMES if frames is None else frames
    if not isinstance(wanted, int) or isinstance(wanted, bool) or wanted < 1:
        raise InputError(f"simulate: frames must be a whole number above 0, got {shown(frames)}")
    solved, here = slab.alone_for(length)
    check_memory(solved, length, wanted)
    try:
        from stickslip.planar.solver import PlanarSolver
    except ImportError:
        raise InputError("simulate: a PlanarSlab needs the library JAX: pip install 'stickslip[planar]'") from None
    run = PlanarSolver(solved, length)
    every, kept, times = max(1, run.steps // wanted), [run.now().at(here)], [run.time]
    with Interrupts() as interrupts:
        while not interrupts.noted and run.advance(every):
            kept.append(run.now().at(here))
            times.append(run.time)
            if progress is not None:
                progress(PlanarReport(run.time, length, float(np.abs(kept[-1].rate).max())))
    largest_slip = max(float(np.abs(motion.slip - kept[0].slip).max()) for motion in kept)
    if not slab.values.is_unique(slab.body.impedance, largest_slip, max(float(np.abs(motion.rate).max()) for motion in kept)):
        raise InputError(
            f"simulate: within the {largest_slip:.3g} m that this PlanarSlab slips, friction falls with the slip rate by more than"
            " radiation adds: several slip rates solve the contact equation, and no selection rule gives a solution in 2D or 3D"
        )
    return PlanarSolution(
        slab,
        np.array(times),
        slip=np.stack([motion.slip for motion in kept]),
        slip_rate=np.stack([motion.rate for motion in kept]),
        traction=np.stack([motion.traction for motion in kept]),
        heat=np.stack([motion.heat for motion in kept]),
        steps_per_round_trip=run.steps,
        status="interrupted" if interrupts.noted else "finished",
    )
