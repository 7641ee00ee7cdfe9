"""The friction of a contact along a given motion: the result of a run of a `MovedContact`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Unpack

import numpy as np
from numpy.typing import ArrayLike

from stickslip.extensions.given_motion.intervals import MotionInIntervals
from stickslip.extensions.given_motion.solve import StepsOfStates, solve_states
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import one_argument
from stickslip.problem import STATUSES, Status, Stop

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from stickslip.extensions.given_motion.moved import MovedContact
    from stickslip.foundation.place import Place
    from stickslip.friction import FrictionLaw

AT_ENDS = 1e-12
"""Times outside the run by this share (1) of its duration are its ends, rounded."""
ROWS = 1_000
"""Number of evenly spaced times in a table and in a figure, beside the kinks of the motion."""
ROUNDING_OF_TRACTION = 4e-15
"""Rounding of the traction as a share (1) of the normal load times the friction coefficient."""
MOST_KINKS = 20_000
"""A table and a figure have at most so many kinks of the motion."""


class At(NamedTuple):
    """What is known at some times: where they lie, the motion, the normal load, and the states as formulas use them."""

    interval: Floats
    time: Floats
    """Time (s) since the start of the interval."""
    slip: Floats
    counted: Floats
    rate: Floats
    load: Floats
    states: list[Floats]
    errors: list[Floats]
    """Bounds of the errors of the states."""


class TractionBounds(NamedTuple):
    """The lowest and the highest traction that can be at each time: the same where friction says what it is."""

    lowest: Floats
    highest: Floats


@dataclass(frozen=True, eq=False, repr=False)
class FrictionAlongMotion:
    """Friction along a given motion, at any time of the run.

    Methods take times (s) of any shape, and return arrays of the same shape. At a jump they give the value after it.
    """

    moved: MovedContact
    duration: float
    """How long the motion was followed (s)."""
    rtol: float
    title: str
    motion: MotionInIntervals
    steps: StepsOfStates | None
    asked_duration: float
    """How long it was to be followed (s)."""
    status: Status = STATUSES[Stop.FINISHED]
    """What ended the run."""
    description: str = ""

    @classmethod
    def along(cls, moved: MovedContact, motion: MotionInIntervals, duration: float, rtol: float) -> FrictionAlongMotion:
        """Return friction along a motion that is divided into intervals already. Raises InputError if it cannot be followed."""
        law = moved.friction
        steps = solve_states(law, motion, law.inner_states(moved.given_states), rtol) if law.states else None
        return cls(moved, duration, rtol, "", motion, steps, duration)

    # ---- values at times ----------------------------------------------------------------------------------------------------

    def _at(self, t: ArrayLike) -> At:
        time, motion = np.asarray(t, float), self.motion
        slack = AT_ENDS * self.duration
        if not ((time >= -slack) & (time <= self.duration + slack)).all():
            raise InputError(f"times must be from 0 to {self.duration:g} s, got {shown(t)}")
        time = np.clip(time, 0.0, self.duration)
        n = np.maximum(np.searchsorted(motion.start, time, side="right") - 1, 0)
        since = time - motion.start[n]
        rests = motion.direction[n] == 0.0
        rate = np.where(rests, 0.0, motion.rate.at(n, since))
        moved = np.where(rests, 0.0, motion.rate.integral(n, since))
        states, errors = self._states_at(n, since)
        counted = motion.counted[n] + motion.counts[n] * moved
        return At(n, since, motion.slip[n] + moved, counted, rate, motion.load.at(n, since), states, errors)

    @cached_property
    def _first_step(self) -> Floats:
        """The number of the first step of each interval."""
        assert self.steps is not None
        return np.asarray(np.searchsorted(self.steps.interval, np.arange(len(self.motion.start))))

    @property
    def begun(self) -> Floats:
        """The starts (s) of the intervals that the run has reached."""
        return self.motion.start[self.motion.start < self.duration]

    @cached_property
    def _step_starts(self) -> Floats:
        """The starts (s) of all steps."""
        assert self.steps is not None
        return np.asarray(self.motion.start[self.steps.interval] + self.steps.since)

    def _states_at(self, n: Floats, since: Floats) -> tuple[list[Floats], list[Floats]]:
        """Return the states, as the formulas use them, and bounds of their errors."""
        steps, first = self.steps, self.motion
        if steps is None:
            return [], []
        last = np.append(self._first_step[1:], len(steps.length))[n] - 1
        k = np.searchsorted(self._step_starts, first.start[n] + since, side="right") - 1
        k = np.clip(k, self._first_step[n], last)
        return steps.within(k, since)

    def slip(self, t: ArrayLike) -> Floats:
        """Return the slip (m or rad) at times (s)."""
        return self._at(t).slip

    def slip_rate(self, t: ArrayLike) -> Floats:
        """Return the slip rate (m/s or rad/s) at times (s)."""
        return self._at(t).rate

    def normal_load(self, t: ArrayLike) -> Floats:
        """Return the normal load (N, Pa or N m) at times (s)."""
        return self._at(t).load

    def state(self, t: ArrayLike) -> Floats:
        """Return the state of the law, or the first one, as users see it, at times (s). Raises InputError if there is none."""
        return self._outer(t, 0)

    def second_state(self, t: ArrayLike) -> Floats:
        """Return the second state of the law, as users see it, at times (s). Raises InputError if there is none."""
        return self._outer(t, 1)

    def _outer(self, t: ArrayLike, which: int) -> Floats:
        law = self.moved.friction
        if which >= len(law.states):
            raise InputError(f"{type(law).__name__} has {len(law.states) or 'no'} state{'s' * (len(law.states) != 1)}")
        found = self._at(t)
        values = np.asarray(law.outer_state(np.asarray(one_argument(found.states))))
        own = values[which] if len(law.states) > 1 else values
        return np.asarray(own * self.motion.facing[found.interval] if law.states[which].reverses else own)

    def _coefficients(self, found: At) -> Floats:
        """Return friction coefficients in the direction of slip, of the last slip at rest."""
        place = (found.counted, abs(found.rate), one_argument(found.states))
        forward, backward = self.moved.friction.ways
        mu = forward.coefficient(*place)
        if backward is not forward:
            mu = np.where(self.motion.facing[found.interval] < 0.0, backward.coefficient(*place), mu)
        return np.asarray(mu)

    def _static(self, law: FrictionLaw, found: At) -> Floats:
        """Return the static friction (N, Pa or N m) of the law of one direction of slip."""
        at_rest = law.coefficient(found.counted, 0.0 * found.rate, one_argument(found.states))
        return np.asarray(found.load * (at_rest + law.static_excess))

    def _is_open(self, found: At) -> Floats:
        """Return where friction does not say what it is: at rest, under a law that sticks."""
        return np.asarray((self.motion.direction[found.interval] == 0.0) & self.moved.friction.sticks)

    def traction(self, t: ArrayLike) -> Floats:
        """Return friction (N, Pa or N m) at times (s), positive where it resists forward slip.

        It is NaN where the contact rests under a law that sticks: any traction up to static friction is possible, and which one it
        is the motion does not say. `bounds` has both ends.
        """
        found = self._at(t)
        traction = self.motion.facing[found.interval] * found.load * self._coefficients(found)
        return np.where(self._is_open(found), np.nan, traction)

    def coefficient(self, t: ArrayLike) -> Floats:
        """Return friction over the normal load (1) at times (s), with the sign of `traction`."""
        found = self._at(t)
        value = self.motion.facing[found.interval] * self._coefficients(found)
        return np.where(self._is_open(found), np.nan, value)

    def bounds(self, t: ArrayLike) -> TractionBounds:
        """Return the lowest and the highest traction (N, Pa or N m) that is possible at times (s).

        They differ at rest under a law that sticks: minus static friction of backward slip, and that of forward slip. Elsewhere
        both are the traction.
        """
        found = self._at(t)
        traction = self.motion.facing[found.interval] * found.load * self._coefficients(found)
        forward, backward = (self._static(one, found) for one in self.moved.friction.ways)
        is_open = self._is_open(found)
        return TractionBounds(np.where(is_open, -backward, traction), np.where(is_open, forward, traction))

    def error(self, t: ArrayLike) -> Floats:
        """Return a bound of the error of the traction (N, Pa or N m) at times (s).

        It follows from the defect of the equation of the states, which is measured at five places between the points of each step,
        and carried on with the law's own derivatives. Between these places nothing is proven. Of a law without a state, traction
        is the law's own value, and the error is rounding. At rest under a law that sticks it is the error of `bounds`.
        """
        found = self._at(t)
        rounding = ROUNDING_OF_TRACTION * found.load * abs(self._coefficients(found))
        if not found.states:
            return np.asarray(rounding)
        slopes = self.moved.friction.slopes(found.counted, abs(found.rate), one_argument(found.states))[2:]
        return np.asarray(rounding + found.load * sum(abs(one) * error for one, error in zip(slopes, found.errors, strict=True)))

    # ---- tables and texts ---------------------------------------------------------------------------------------------------

    @cached_property
    def times(self) -> Floats:
        """Times (s) that show the run: even ones, and those where the motion has a kink, up to 20 000 of these."""
        kinks = self.begun[:: max(1, -(-len(self.begun) // MOST_KINKS))]
        return np.unique(np.concatenate((np.linspace(0.0, self.duration, ROWS + 1), kinks)))

    def at(self, t: ArrayLike) -> pd.DataFrame:
        """Return a table of all that is known at times (s): motion, normal load, traction with its bounds and its error, states."""
        import pandas as pd

        time = np.atleast_1d(np.asarray(t, float)).ravel()
        lowest, highest = self.bounds(time)
        columns = {"time": time, "slip": self.slip(time), "slip_rate": self.slip_rate(time), "normal_load": self.normal_load(time)}
        columns |= {"traction": self.traction(time), "lowest_traction": lowest, "highest_traction": highest}
        columns |= {"coefficient": self.coefficient(time), "error": self.error(time)}
        columns |= {
            name: self._outer(time, i) for i, name in enumerate(("state", "second_state")[: len(self.moved.friction.states)])
        }
        return pd.DataFrame(columns)

    @property
    def units(self) -> dict[str, str]:
        """The unit of each column of `at`."""
        moved, load = self.moved, self.moved.load_unit
        found = {"time": "s", "slip": "rad" if moved.turns else "m", "slip_rate": moved.rate_unit, "normal_load": load}
        found |= dict.fromkeys(("traction", "lowest_traction", "highest_traction", "error"), load) | {"coefficient": "1"}
        return found | {name: one.unit for name, one in zip(("state", "second_state"), moved.friction.states, strict=False)}

    def to_netcdf(self, path: str | Path) -> Path:
        """Write the run to a netCDF file, and return the path: `stickslip.open_solution` gives it back bit for bit.

        Raises InputError if it cannot be written, or for a law or a history that a file cannot name.
        """
        from stickslip.extensions.given_motion.kept import write_motion

        return write_motion(self, Path(path))

    def to_csv(self, path: str | Path) -> Path:
        """Write the table at `times`, with units in its headings, and return the path; as netCDF if its name ends in .nc."""
        from stickslip.foundation.atomic_write import write_atomically

        target = Path(path)
        if target.suffix.lower() == ".nc":
            from stickslip.extensions.given_motion.kept import write_curves

            return write_curves(self, target)
        table = self.at(self.times)
        table.columns = [f"{name} ({self.units[name]})" for name in table.columns]
        return write_atomically(target, lambda draft: table.to_csv(draft, index=False))

    def plot(self, **place: Unpack[Place]) -> Figure:
        """Draw slip rate, states and traction against time; `figure`, `size` and `dpi` as for other figures."""
        from stickslip.extensions.given_motion.figures.along import draw_along

        return draw_along(self, **place)

    def __str__(self) -> str:
        return "\n".join(self.lines())

    __repr__ = __str__

    def lines(self) -> list[str]:
        """Return what is to be said of the run, a sentence each."""
        from stickslip.extensions.given_motion.in_words import lines_of

        return lines_of(self)


def in_intervals(moved: MovedContact, duration: float) -> MotionInIntervals:
    """Return the motion of a contact in intervals. Raises InputError if the normal load falls to 0 within the duration (s)."""
    found = MotionInIntervals.of(moved.slip_rate, moved.normal_load, moved.friction, duration, moved.initial_slip)
    every = np.arange(len(found.start))
    lowest = np.minimum(found.load.at(every, 0.0 * found.lasting), found.load.at(every, found.lasting)).min()
    if not lowest > 0.0:
        raise InputError(f"simulate: normal_load must stay above 0 {moved.load_unit}, but falls to {lowest:g} within the run")
    return found
