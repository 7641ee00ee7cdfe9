"""Run a planar slab from t = 0, and keep the motion of its contact at frames in time."""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from stickslip.engine.state.layout import Stop
from stickslip.foundation.arguments import as_path, shown
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import number
from stickslip.planar.slab import PlanarSlab
from stickslip.problem.run_quantities import CHECKPOINT_INTERVAL, DURATION
from stickslip.run.options import CHECKPOINT_EVERY
from stickslip.run.progress import Pace, how_far, how_fast
from stickslip.run.run_loop import Interrupts, NowAndThen, next_budget
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.planar import Frames, PlanarSolution
from stickslip.trajectory.status import UNSTABLE

if TYPE_CHECKING:
    from stickslip.io.planar_store import PlanarStore
    from stickslip.planar.solver import PlanarSolver
    from stickslip.planar.step import Motion

FRAMES = 100
"""Frames in a two-way travel time, by default."""
RESIDUAL = 1e-6
"""Largest miss of the contact equation, as a share of the load, in a run that counts as a solution; rounding gives 1e-15."""
ROUNDING = 1e-12
"""Share of the normal stress by which rounding may carry friction below zero."""
UNHEARD_OF = 1e3
"""Slip rate of an unstable run over the one that the largest load would drive against radiation alone; fronts come to some ten."""
NODES_AT_ONCE = 1_000_000
"""Nodes times steps in the first call of the solver, which are computed in less than a second."""
COMPILER = 6e7
"""Memory that compiling a run takes, bytes."""
UNKNOWN_MEMORY = 16e9
"""Memory that a machine is taken to have which does not say how much it has, bytes."""
LIMITS_OF_CONTAINER = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Files in which Linux says how much memory the processes of a container may take."""


class PlanarReport(NamedTuple):
    """The progress of the run of a planar slab; as a text it is one line for people."""

    time: float
    """Simulated time so far, s."""
    duration: float
    """Simulated time at the end of the run, s."""
    fastest: float
    """Largest slip rate on the contact now, m/s; NaN before the start."""
    pace: float
    """Simulated time per wall-clock time since the first report; NaN while it is not known."""
    left: float
    """Wall-clock time left at this pace, s; NaN while it is not known."""
    memory: float
    """Memory that the run needs, bytes: see `memory_of`."""

    def __str__(self) -> str:
        moving = f"slips at up to {number(self.fastest, 3)} m/s" if self.fastest > 0.0 else "rests"
        needs = f"needs {number(self.memory / 1e9, 2)} GB"
        doing = [needs] if math.isnan(self.fastest) else [moving, *how_fast(self.pace, self.left)]
        return ", ".join([how_far(self.time, self.duration), *doing])


PlanarProgress = Callable[[PlanarReport], object]
"""A function that is called with a `PlanarReport` before the start, after each frame, and ten times a second between two frames."""


def memory_of(slab: PlanarSlab, duration: float, frames: int = FRAMES) -> float:
    """Return the memory (bytes) that a run of this duration (s) needs beside that of Python and its libraries.

    These are the exponentials, the paths of waves in a round trip, the echoes of the round trips to come with what it takes to set
    them up, and the frames, of which there are two copies at the end, or none (0) if they are streamed.
    """
    round_trips, steps = slab.round_trips(duration), slab.steps_per_round_trip
    modes = float(np.prod(slab.shape[:-1])) * (slab.shape[-1] // 2 + 1)
    exponentials = 5.0 * (2.0 + np.log2(4.0 * round_trips * steps)) * 64.0 * modes
    echoes = 76.0 + 110.0 * (round_trips - 1) if round_trips > 1 else 0.0
    waves = (36.0 + echoes) * (steps + 1) * modes
    kept = min(frames, steps) * duration / slab.body.round_trip_time * 64.0 * float(np.prod(slab.shape))
    return float(COMPILER + exponentials + waves + kept)


def memory_here() -> float:
    """Return the memory (bytes) that a run may take: that of the machine, or of the container or the devices it runs on."""
    found = []
    with suppress(ValueError, OSError, AttributeError):  # where the system does not know these names
        found.append(float(os.sysconf("SC_PAGE_SIZE")) * os.sysconf("SC_PHYS_PAGES"))
    for file in LIMITS_OF_CONTAINER:
        with suppress(ValueError, OSError):  # no such file, or "max"
            found.append(float(Path(file).read_text(encoding="ascii")))
    here, jax = min(found, default=UNKNOWN_MEMORY), sys.modules.get("jax")
    if jax is None:
        return here
    devices = [device.memory_stats() or {} for device in jax.local_devices()]
    return float(jax.process_count() * (sum(one.get("bytes_limit", 0.0) for one in devices) or here))


def check_memory(slab: PlanarSlab, duration: float, frames: int) -> float:
    """Return the memory of a run (see `memory_of`). Raises InputError if it is more than there is: see `memory_here`."""
    if (needed := memory_of(slab, duration, frames)) > (here := memory_here()):
        raise InputError(
            f"simulate: this PlanarSlab needs {needed / 1e9:.3g} GB for {duration:g} s, and there are {here / 1e9:.3g} GB here:"
            " take fewer nodes, a shorter duration, or fewer frames"
        )
    return needed


def simulate_planar(
    slab: PlanarSlab,
    duration: float | str | WithUnit | None,
    *,
    frames: int | None = None,
    progress: PlanarProgress | None = None,
    checkpoint: str | Path | None = None,
    checkpoint_every: float | str | WithUnit = CHECKPOINT_EVERY,
    scenario: Scenario | None = None,
) -> PlanarSolution:
    """Run a planar slab from t = 0: see `stickslip.simulate`. The run ends with the step that reaches the duration.

    It keeps so many `frames` of each two-way travel time, as far as there are as many steps; 100 by default. `progress` is called
    with a `PlanarReport` before the start, after each frame, and ten times a second between two frames. Frames are written to the
    folder `checkpoint` (NAME.zarr) while the run continues, with the scenario of the slab, if it has one, and `resume_planar`
    continues it. Ctrl-C ends the run with the frames that are done, and one for where it ended. Raises InputError if an argument is
    out of range, or the library JAX is missing (`pip install 'stickslip[planar]'`).
    """
    if duration is None:
        raise InputError("simulate: a PlanarSlab needs a duration, in s or with a unit")
    length, wanted = DURATION.check("simulate", "duration", duration), FRAMES if frames is None else frames
    if not isinstance(wanted, int) or isinstance(wanted, bool) or wanted < 1:
        raise InputError(f"simulate: frames must be a whole number above 0, got {shown(frames)}")
    follow = Follow(length, wanted, progress, CHECKPOINT_INTERVAL.check("simulate", "checkpoint_every", checkpoint_every))
    path = None if checkpoint is None else as_path("simulate: checkpoint", checkpoint)
    if path is not None and path.suffix != ".zarr":
        raise InputError(f"simulate: the checkpoint of a PlanarSlab is a folder NAME.zarr, got {shown(str(path))}")
    run, here = follow.solver(slab, streams=path is not None)
    if path is None:
        return follow.to_end(Frames(slab, run.steps), run, here)
    from stickslip.io.planar_store import PlanarStore  # with zarr, which takes half a second to load

    about = replace(scenario or Scenario(slab.problem, length), duration=length)
    with PlanarStore.new(path, slab, about, wanted, run) as store:
        return follow.to_end(store, run, here)


def resume_planar(
    path: Path,
    duration: float | str | WithUnit | None = None,
    *,
    progress: PlanarProgress | None = None,
    checkpoint_every: float | str | WithUnit = CHECKPOINT_EVERY,
) -> PlanarSolution:
    """Continue the run of a planar slab in its folder: see `stickslip.run.resume.resume`."""
    from stickslip.io.planar_store import PlanarStore

    with PlanarStore.at(path) as store:
        before = store.duration
        if duration is not None:
            store.duration = DURATION.check("resume", "duration", duration)
        check_duration(store, before)
        every = CHECKPOINT_INTERVAL.check("resume", "checkpoint_every", checkpoint_every)
        follow = Follow(store.duration, store.frames, progress, every)
        run, here = follow.solver(store.slab, streams=True, time=store.times[-1])
        store.restore(run)
        if run.step % follow.steps_of(run) and run.step < run.steps and run.steps_left:
            store.drop_last()  # it was made because the run ended there
        return follow.to_end(store, run, here)


def check_duration(store: PlanarStore, before: float) -> None:
    """Refuse a new duration that the run has passed, or for which it would have been prepared in another way. Raises InputError."""
    slab, wanted, reached = store.slab, store.duration, store.times[-1]
    if wanted == before:
        return
    from stickslip.planar.memory import horizon  # with scipy

    horizon_trips = horizon(slab.round_trips(before))
    if wanted < reached:
        why = f"the run has already reached {reached:.9g} s"
    elif not slab.replicas:
        why = "without replicas it lies in a locked contact that is as long as waves get in this time; run it again from the start"
    elif slab.round_trips(wanted) > horizon_trips:
        why = f"its exponentials are made for {horizon_trips * slab.body.two_way_time:.9g} s; run it again from the start"
    else:
        return
    raise InputError(f"{store.path}: the duration of {before:.9g} s cannot become {wanted:.9g} s: {why}")


@dataclass
class Follow:
    """How a run is followed to its end.

    `frames` is the number of frames in a two-way travel time, `every` the wall-clock time (s) between two checkpoints, and `memory`
    what the run needs (bytes).
    """

    duration: float
    frames: int
    progress: PlanarProgress | None
    every: float
    memory: float = 0.0

    def solver(self, slab: PlanarSlab, *, streams: bool, time: float = 0.0) -> tuple[PlanarSolver, tuple[slice, ...]]:
        """Return the solver at t = 0, and where the nodes of the contact are in it, after a first report at a time (s).

        Raises InputError if the run needs too much memory, or if JAX is missing.
        """
        solved, here = slab.alone_for(self.duration)
        try:
            from stickslip.planar.solver import PlanarSolver
        except ImportError:
            raise InputError("simulate: a PlanarSlab needs the library JAX: pip install 'stickslip[planar]'") from None
        self.memory = check_memory(solved, self.duration, 0 if streams else self.frames)
        if self.progress is not None:
            self.progress(PlanarReport(time, self.duration, math.nan, math.nan, math.nan, self.memory))
        return PlanarSolver(solved, self.duration), here

    def fault(self, run: PlanarSolver, motion: Motion) -> int | None:
        """Return the code that ends the run at a motion that is no solution, or None."""
        if not all(np.isfinite(one).all() for one in motion):
            return Stop.FAILED
        if motion.residual.max() > RESIDUAL:
            return Stop.OFF_THE_LAW
        largest = np.abs(run.slab.values.load).max() + np.abs(run.loading).max()
        if np.abs(motion.rate).max() > UNHEARD_OF * largest / run.body.impedance:
            return UNSTABLE
        driven = motion.traction * np.sign(motion.rate) < -ROUNDING * run.slab.values.normal
        return Stop.NEGATIVE_FRICTION if driven.any() else None

    def to_end(self, kept: Frames, run: PlanarSolver, here: tuple[slice, ...]) -> PlanarSolution:
        """Run to the end, or to a Ctrl-C, and return the frames."""
        if not kept.times:
            kept.add(run.time, run.now().at(here))
            kept.save(run)
        with Interrupts() as interrupts:
            code = self.follow(kept, run, here, interrupts)
            slab, slip = kept.slab, kept.largest_slip
            if not slab.values.is_unique(slab.body.impedance, slip, kept.fastest):
                raise InputError(
                    f"simulate: within the {slip:.3g} m that this PlanarSlab slips, friction falls with the slip rate by more than"
                    " radiation adds: several slip rates solve the contact equation, and no selection rule is known to help in 2D"
                    " or 3D"
                )
            kept.end(run, code)
            return kept.solution(code)

    def steps_of(self, run: PlanarSolver) -> int:
        """Return the number of steps from frame to frame; the end of a round trip is a frame, too."""
        return max(1, run.steps // self.frames)

    def follow(self, kept: Frames, run: PlanarSolver, here: tuple[slice, ...], interrupts: Interrupts) -> int:
        """Run frame by frame, and return the code of what ended the run.

        The steps from frame to frame are taken in calls of about a tenth of a second, between which Ctrl-C is heard.
        """
        every, saving, pace = self.steps_of(run), NowAndThen.from_now(self.every), None
        budget, fastest = max(1, NODES_AT_ONCE // math.prod(run.slab.shape)), kept.fastest
        while run.steps_left:
            if run.step == run.steps:
                kept.end_round_trip(run)
            missing = every - run.step % every if run.step < run.steps else every
            start = perf_counter()
            taken = run.advance(missing if run.is_shared else min(missing, budget))
            budget, pace = next_budget(budget, perf_counter() - start, 1), pace or Pace()  # from when all has been compiled
            is_frame = taken == missing or run.step == run.steps or not run.steps_left
            if is_frame:
                if (code := self.fault(run, motion := run.now())) is not None:
                    kept.residual = float(motion.residual.max()) if code == Stop.OFF_THE_LAW else kept.residual
                    return code
                fastest = kept.add(run.time, motion.at(here))
                if saving.is_due:
                    with saving.done():
                        kept.save(run)
            goes_on = self.tell(run, fastest, pace)
            if not goes_on or (interrupts.noted and run.steps_left):
                if not is_frame:
                    kept.add(run.time, run.now().at(here))
                return interrupts.answer()
        return Stop.FINISHED

    def tell(self, run: PlanarSolver, fastest: float, pace: Pace) -> bool:
        """Report the progress of a run whose largest slip rate (m/s) is known. Returns False if that raised KeyboardInterrupt."""
        if self.progress is not None:
            done = min(run.time / self.duration, 1.0)
            try:
                self.progress(PlanarReport(run.time, self.duration, fastest, *pace.at(run.time, done), self.memory))
            except KeyboardInterrupt:
                return False
        return True
