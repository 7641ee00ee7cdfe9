"""Follow a given motion from its start, or go on where a file left it, with progress, checkpoints and Ctrl-C as other runs have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.extensions.given_motion.along import FrictionAlongMotion, in_intervals
from stickslip.extensions.given_motion.intervals import MotionInIntervals
from stickslip.extensions.given_motion.moved import MovedContact
from stickslip.extensions.given_motion.solve import StatesUnderWay, StepsOfStates, steps_that_stay
from stickslip.foundation.atomic_write import check_replaceable
from stickslip.foundation.errors import InputError
from stickslip.problem import STATUSES, UNDER_WAY, Stop
from stickslip.run import CallOptions, Pace, WholeHistory, how_far, how_fast, run_to_end

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario


@dataclass(eq=False)
class MotionRun:
    """A given motion that is being followed, an implementation of `run.solver.Solver`."""

    options: CallOptions
    moved: MovedContact
    motion: MotionInIntervals
    states: StatesUnderWay | None
    """None of a law without a state: its friction is known at once."""
    has_enough = False
    """It counts no events."""

    @classmethod
    def begun(cls, moved: MovedContact, options: CallOptions) -> MotionRun:
        """Return a run at its start. Raises InputError if the motion cannot be followed, or the run could not be kept."""
        return cls._along(moved, in_intervals(moved, options.duration), options, None)

    @classmethod
    def behind(cls, stopped: FrictionAlongMotion, options: CallOptions) -> MotionRun:
        """Return a run behind those steps of a stopped one that a run to this duration has, too."""
        motion, steps = stopped.motion, stopped.steps
        if options.duration != stopped.asked_duration:
            motion = in_intervals(stopped.moved, options.duration)
            steps = None if steps is None else steps.first(steps_that_stay(steps, stopped.motion, motion))
        return cls._along(stopped.moved, motion, options, steps)

    @classmethod
    def _along(cls, moved: MovedContact, motion: MotionInIntervals, options: CallOptions, steps: StepsOfStates | None) -> MotionRun:
        law = moved.friction
        start = law.inner_states(moved.given_states) if law.states else ()
        return cls(options, moved, motion, StatesUnderWay(law, motion, start, options.rtol, steps) if law.states else None)

    @property
    def length(self) -> int:
        """The number of steps so far; of a law without a state that of intervals."""
        return len(self.motion.start) if self.states is None else self.states.count

    @property
    def can_be_saved(self) -> bool:
        """True once there is a step."""
        return self.length > 0

    @property
    def time(self) -> float:
        """The time (s) that has been reached."""
        return float(self.options.duration) if self.states is None or self.states.is_over else self.states.time

    def advance(self, budget: int) -> int:
        """Take at most `budget` steps: see `Solver.advance`. Raises InputError where the states cannot be followed."""
        if self.states is not None and not self.states.is_over:
            self.states.advance(budget)
        return Stop.FINISHED if self.states is None or self.states.is_over else Stop.NONE

    def grow(self) -> bool:
        """Return True: there is always room for another step."""
        return True

    def new_events(self) -> None:
        """Return None: where the motion is given there are no slip events."""

    def report(self, pace: Pace) -> str:
        """Return the progress of the run as a line of text."""
        share = self.time / self.options.duration
        return ", ".join([how_far(self.time, self.options.duration), *how_fast(*pace.at(self.time, share))])

    def save(self) -> None:
        """Renew the checkpoint, if a file for it was given."""
        if self.options.checkpoint is not None:
            from stickslip.extensions.given_motion.kept import save_checkpoint

            save_checkpoint(self.so_far(UNDER_WAY), self.options.checkpoint)

    def so_far(self, code: int) -> FrictionAlongMotion:
        """Return what has been found, with the status that belongs to a code."""
        options, steps = self.options, None if self.states is None else self.states.steps()
        return FrictionAlongMotion(
            self.moved,
            self.time,
            options.rtol,
            options.title,
            self.motion,
            steps,
            options.duration,
            STATUSES[code],
            options.description,
        )

    def finish(self, code: int) -> FrictionAlongMotion:
        """Return friction along the motion, which is written if a file for it was given."""
        found = self.so_far(code)
        if self.options.checkpoint is not None:
            found.to_netcdf(self.options.checkpoint)
        return found


def follow_motion(source: MovedContact | Scenario, options: CallOptions) -> FrictionAlongMotion:
    """Find friction along the motion of a `MovedContact`, or of a scenario with a [motion]. Raises InputError."""
    if options.duration is None:
        raise InputError("simulate: a MovedContact needs a duration, in s or with a unit")
    moved = source if isinstance(source, MovedContact) else source.to_solve
    return _run(lambda checked: MotionRun.begun(moved, checked), options.checked("simulate"), "simulate")


def resume_motion(path: Path, duration: Any = None, **given: Any) -> FrictionAlongMotion:
    """Go on along the motion in a file, up to its own duration if none is given: see `stickslip.resume`."""
    from stickslip.extensions.given_motion.kept import check_same_code, read_motion

    stopped = read_motion(path)
    check_same_code(path)
    asked: Any = stopped.asked_duration if duration is None else duration
    checkpoint = given.pop("checkpoint", None)
    own: dict[str, Any] = {"rtol": stopped.rtol, "title": stopped.title, "description": stopped.description}
    options = CallOptions(asked, checkpoint=path if checkpoint is None else checkpoint, **own, **given).checked("resume")
    if options.duration != stopped.asked_duration and options.duration < stopped.duration:
        wanted = f"a duration of {options.duration:.9g} s lies before that"
        raise InputError(f"{path}: the run has already reached {stopped.duration:.9g} s: {wanted}")
    return _run(lambda checked: MotionRun.behind(stopped, checked), options, "resume")


def _run(make: Callable[[CallOptions], MotionRun], options: CallOptions, who: str) -> FrictionAlongMotion:
    """Run to the end, in a file of its own if there is one. Raises InputError."""
    file = options.checkpoint
    if file is not None:
        if file.suffix.lower() != ".nc":
            raise InputError(f"{who}: the run of a MovedContact is kept in a file NAME.nc, got {str(file)!r}")
        check_replaceable(file, f"{who}: {file}")
    with options.alone():
        run = make(options)
        if file is not None:
            from stickslip.extensions.given_motion.kept import text_of

            text_of(run.moved, options)  # refuses now what a file could not say
        return run_to_end(run, WholeHistory(run))
