"""Run a planar slab from t = 0, and keep the motion of its contact at frames in time."""

from __future__ import annotations

import math
import os
import sys
from contextlib import ExitStack, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.extensions.planar.slab import PlanarSlab
from stickslip.extensions.planar.solution import Frames, PlanarSolution
from stickslip.extensions.planar.table import contact_of, planar_slab_of
from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import number
from stickslip.problem import INTERRUPTED, UNSTABLE, Stop
from stickslip.problem.scenarios import Scenario
from stickslip.run import CallOptions, Pace, WholeHistory, how_far, how_fast, run_to_end

if TYPE_CHECKING:
    from stickslip.extensions.planar.solver import PlanarSolver
    from stickslip.extensions.planar.step import PlanarMotion
    from stickslip.extensions.planar.store import PlanarStore

FRAMES = 100
"""Frames in a two-way travel time, by default."""
RESIDUAL = 1e-6
"""Largest residual of the contact equation, as a share of the load, in a run that counts as a solution; rounding gives 1e-15."""
ROUNDING_OF_FRICTION = 1e-12
"""Rounding may carry friction below zero by this share of the normal stress."""
UNHEARD_OF = 1e3
"""A run is unstable if its slip rate exceeds this multiple of the rate that the largest load could drive against radiation alone;
fronts reach some ten times that rate."""
NODES_OF_BUDGET = 200
"""The step of this many nodes counts as one in the budget of a call: the first call then takes less than a second."""
COMPILER = 6e7
"""Memory that compiling a run takes, bytes."""
UNKNOWN_MEMORY = 16e9
"""Assumed memory of a machine that does not report it, bytes."""
LIMITS_OF_CONTAINER = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
"""Files with the memory limit of a container's processes under Linux."""


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


def memory_of(slab: PlanarSlab, duration: float, frames: int = FRAMES) -> float:
    """Return the memory (bytes) that a run of this duration (s) needs besides that of Python and its libraries.

    It holds the exponentials, the paths of waves in a round trip, the echoes of the round trips to come and the room to set them
    up, and the frames: two copies of them at the end, or none (0) if they are streamed.
    """
    round_trips, steps = slab.round_trips(duration), slab.steps_per_round_trip
    modes = float(np.prod(slab.shape[:-1])) * (slab.shape[-1] // 2 + 1)
    exponentials = (5.0 * (2.0 + np.log2(4.0 * round_trips * steps)) * 64.0 + 320.0) * modes
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


def with_frames(who: str, options: CallOptions, frames: int | None) -> CallOptions:
    """Return options with the number of frames of each two-way travel time; None for the default. Raises InputError."""
    return replace(options, of_solver={"frames": FRAMES if frames is None else check_whole(f"{who}: frames", frames)})


def frames_of(options: CallOptions) -> int:
    """Return the number of frames that are kept of each two-way travel time."""
    return int(options.of_solver["frames"])


def simulate_planar(source: PlanarSlab | Scenario, options: CallOptions) -> PlanarSolution:
    """Run a planar slab from t = 0, with the step that reaches the duration as the last one: see `stickslip.simulate`.

    Frames are written to the folder `options.checkpoint` (NAME.zarr) while the run continues, and `resume_planar` continues it.
    Raises InputError if an option is out of range, or the library JAX is missing.
    """
    slab = source if isinstance(source, PlanarSlab) else planar_slab_of(source)
    if options.duration is None:
        raise InputError("simulate: a PlanarSlab needs a duration, in s or with a unit")
    frames_kept = options.of_solver.get("frames", None if isinstance(source, PlanarSlab) else contact_of(source).frames)
    options = with_frames("simulate", options.checked("simulate"), frames_kept)
    path, duration = options.checkpoint, options.duration
    if path is not None and path.suffix != ".zarr":
        raise InputError(f"simulate: the checkpoint of a PlanarSlab is a folder NAME.zarr, got {shown(str(path))}")
    solver, here, memory = begun(slab, options, 0.0)
    with ExitStack() as stack:
        frames: Frames = Frames(slab, solver.steps, title=options.title)
        if path is not None:
            from stickslip.extensions.planar.store import PlanarStore  # with zarr, which takes half a second to load

            about = Scenario(slab.problem, duration) if isinstance(source, PlanarSlab) else replace(source, duration=duration)
            frames = stack.enter_context(PlanarStore.new(path, slab, about, frames_of(options), solver))
        run = PlanarRun(options, solver, here, memory, frames)
        run.keep(solver.now())
        frames.save(solver)
        return run_to_end(run, WholeHistory(run))


def resume_planar(path: Path, duration: float | str | WithUnit | None = None, **given: Any) -> PlanarSolution:
    """Continue the run of a planar slab in its folder, up to its own duration if none is given: see `stickslip.resume`."""
    from stickslip.extensions.planar.store import PlanarStore

    with PlanarStore.at(path) as store:
        before = store.duration
        asked: Any = before if duration is None else duration
        options = with_frames("resume", CallOptions(asked, checkpoint=path, **given).checked("resume"), store.frames)
        store.duration = options.duration
        check_duration(store, before)
        solver, here, memory = begun(store.slab, options, store.times[-1])
        store.restore(solver)
        run = PlanarRun(options, solver, here, memory, store)
        if solver.step % run.steps_to_frame and solver.step < solver.steps and solver.steps_left:
            store.drop_last()  # it was made because the run ended there
        return run_to_end(run, WholeHistory(run))


def check_duration(store: PlanarStore, before: float) -> None:
    """Refuse a new duration that the run has passed, or that would have needed other preparations. Raises InputError."""
    slab, wanted, reached = store.slab, store.duration, store.times[-1]
    if wanted == before:
        return
    from stickslip.extensions.planar.memory import horizon  # with scipy

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


def begun(slab: PlanarSlab, options: CallOptions, time: float) -> tuple[PlanarSolver, tuple[slice, ...], float]:
    """Return a solver at t = 0, where the nodes of the contact are in it, and the memory (bytes) that the run needs.

    Before that, the run is reported at a time (s). Raises InputError if it needs too much memory, or if JAX is missing.
    """
    solved, here = slab.alone_for(options.duration)
    try:
        from stickslip.extensions.planar.solver import PlanarSolver
    except ImportError:
        raise InputError("simulate: a PlanarSlab needs the library JAX: pip install 'stickslip[planar]'") from None
    memory = check_memory(solved, options.duration, 0 if options.checkpoint is not None else frames_of(options))
    if options.progress is not None:
        options.progress(PlanarReport(time, options.duration, math.nan, math.nan, math.nan, memory))
    return PlanarSolver(solved, options.duration), here, memory


@dataclass(eq=False)
class PlanarRun:
    """A planar slab in progress and the frames of its motion, an implementation of `run.solver.Solver`."""

    options: CallOptions
    solver: PlanarSolver
    here: tuple[slice, ...]
    """Where the nodes of the contact are among those of the solver."""
    memory: float
    """Memory that the run needs, bytes."""
    frames: Frames
    can_be_saved: bool = False
    """True at a frame: a run continues from one."""
    has_enough = False
    """It counts no events."""

    def __post_init__(self) -> None:
        self.fastest = self.frames.fastest
        self.steps_to_frame = max(1, self.solver.steps // frames_of(self.options))
        self.nodes = math.prod(self.solver.slab.shape)

    @property
    def length(self) -> int:
        """The number of steps since t = 0."""
        return self.solver.trip * self.solver.steps + self.solver.step

    def advance(self, budget: int) -> int:
        """Advance to the next frame, or as far as a budget of steps of NODES_OF_BUDGET nodes each allows: see `Solver.advance`.

        The end of a round trip is a frame, too; there the history is full of the waves that the round trip has sent.
        """
        solver, every = self.solver, self.steps_to_frame
        if not solver.steps_left:
            return Stop.FINISHED
        missing = every - solver.step % every if solver.step < solver.steps else every
        taken = solver.advance(missing if solver.is_shared else min(missing, max(1, budget * NODES_OF_BUDGET // self.nodes)))
        is_over, is_full = not solver.steps_left, solver.step == solver.steps
        self.can_be_saved = taken == missing or is_full or is_over
        if self.can_be_saved:
            motion = solver.now()
            if (code := self._fault(motion)) is not None:
                self.can_be_saved = False
                return code
            self.keep(motion)
        return Stop.FINISHED if is_over else Stop.FULL if is_full else Stop.NONE

    def keep(self, motion: PlanarMotion) -> None:
        """Keep the present motion as a frame."""
        self.fastest = self.frames.add(self.solver.time, motion.at(self.here))

    def _fault(self, motion: PlanarMotion) -> int | None:
        """Return the code that ends the run at a motion that is no solution, or None."""
        if not all(np.isfinite(one).all() for one in motion):
            return Stop.FAILED
        if motion.residual.max() > RESIDUAL:
            self.frames.residual = float(motion.residual.max())
            return Stop.OFF_THE_LAW
        slab = self.solver.slab
        largest = np.abs(slab.values.load).max() + np.abs(self.solver.loading).max()
        if np.abs(motion.rate).max() > UNHEARD_OF * largest / slab.body.impedance:
            return UNSTABLE
        driven = motion.traction * np.sign(motion.rate) < -ROUNDING_OF_FRICTION * slab.values.normal
        return Stop.NEGATIVE_FRICTION if driven.any() else None

    def grow(self) -> bool:
        """Let the frames take what the solver is about to forget."""
        self.frames.end_round_trip(self.solver)
        return True

    def new_events(self) -> None:
        """Return None: a contact of many nodes has pulses at each of them, and no slip events."""

    def report(self, pace: Pace) -> PlanarReport:
        """Return the progress of the run: see `Solver.report`."""
        now, duration = self.solver.time, self.options.duration
        return PlanarReport(now, duration, self.fastest, *pace.at(now, min(now / duration, 1.0)), self.memory)

    def save(self) -> None:
        """Renew the checkpoint, if a folder for it was given."""
        self.frames.save(self.solver)

    def finish(self, code: int) -> PlanarSolution:
        """Return the frames with the status that belongs to a code, and one more if the run was interrupted between two.

        Raises InputError if several slip rates solved the contact equation on the way.
        """
        frames, slab = self.frames, self.frames.slab
        if code == INTERRUPTED and not self.can_be_saved:
            self.keep(self.solver.now())
        if not slab.values.is_unique(slab.body.impedance, frames.largest_slip, frames.fastest):
            raise InputError(
                f"simulate: within the {frames.largest_slip:.3g} m that this PlanarSlab slips, friction falls with the slip rate by"
                " more than radiation adds: several slip rates solve the contact equation, and no selection rule is known to help"
                " in 2D or 3D"
            )
        frames.end(self.solver, code)
        return frames.solution(code)
