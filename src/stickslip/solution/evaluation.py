"""What can be read of a run at any time: values, shocks, curves. A whole run and a window on it are read alike."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import History, Moments, Side
from stickslip.trajectory.tables import shocks_table

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from stickslip.observables.field import Field

Floats = NDArray[np.float64]
Curve = Literal["slip", "slip_rate", "traction", "load", "state", "event_slip"]
MOST_VALUES = 20_000_000
"""Times of the largest dataset, times its places: each takes up to 0.5 kB while it is worked out."""
CURVES: tuple[Curve, ...] = ("slip", "slip_rate", "traction", "load")


def check_size(t: ArrayLike, x: ArrayLike | None) -> None:
    """Refuse a dataset that is larger than the memory of most machines. Raises InputError."""
    wanted = np.size(t) * (1 if x is None else np.size(x))
    if wanted > MOST_VALUES:
        raise InputError(f"dataset: {wanted:.3g} values are too many: take fewer times or places (at most {MOST_VALUES:.0e})")


class Readings:
    """Values of a run at times in s since `history.epoch`; arrays in, arrays of the same shape out.

    `side` ("left" or "right") picks the limit at a shock. Times outside the run raise InputError.
    """

    problem: Problem
    history: History

    @property
    def shown(self) -> tuple[float, float]:
        """Times (s) from which and up to which it is drawn."""
        return self.history.span

    def _at(self, t: ArrayLike, side: Side) -> tuple[Moments, tuple[int, ...]]:
        try:
            time = np.asarray(t, float)
        except OverflowError:  # a whole number beyond all floats
            raise InputError("times must be finite numbers in s") from None
        return self.history.find(np.atleast_1d(time).ravel(), side), time.shape

    def slip(self, t: ArrayLike) -> Floats:
        """Slip u (m) at times t (s). Absolute: it starts at the initial slip."""
        at, shape = self._at(t, "right")
        return (self.problem.initial_slip + self.history.slipped(at)).reshape(shape)

    def slip_rate(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Slip rate v (m/s) at times t (s)."""
        at, shape = self._at(t, side)
        return self.history.rate(at).reshape(shape)

    def traction(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Friction on the contact tau (slab: Pa, block: N) at times t (s), positive where it opposes forward slip."""
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.friction(at)).reshape(shape)

    def load(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Load at times t (s): beta of eqs (12)-(13) for the slab (Pa), the spring's force for the block (N)."""
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.excess(at)).reshape(shape)

    def to_scec(self, path: str | Path, sampling_rate: float, **options: Any) -> Path:
        """Write t, slip, slip rate and shear stress as SCEC's on-fault time series: see `stickslip.io.scec.write_scec`."""
        from stickslip.io.scec import write_scec

        return write_scec(self, path, sampling_rate, **options)

    def to_seismogram(self, path: str | Path, sampling_rate: float, **options: Any) -> list[Path]:
        """Write miniSEED or SAC through ObsPy: see `stickslip.io.seismogram.write_seismogram`."""
        from stickslip.io.seismogram import write_seismogram

        return write_seismogram(self, path, sampling_rate, **options)

    def state(self, t: ArrayLike) -> Floats:
        """State of the friction law at times t (s), in the law's own unit (`FrictionLaw.state`).

        Raises InputError for a law without one.
        """
        if self.problem.friction.state is None:
            raise InputError(f"state: {type(self.problem.friction).__name__} has no state variable")
        at, shape = self._at(t, "right")
        return self.problem.friction.outer_state(self.history.state(at)).reshape(shape)

    def field(self, x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
        """Displacement (m), velocity (m/s) and shear stress (Pa) inside the slab, x (m) away from the contact, at times t (s).

        x and t are broadcast together: `field(x, t[:, None])` has a row a time. Raises InputError for a block and for x outside
        the slab. See `stickslip.observables.field`.
        """
        from stickslip.observables.field import field

        return field(self, x, t, side)

    def plot_field(self, start: float | None = None, end: float | None = None) -> Figure:
        """Velocity and stress in the slab over time (s), with characteristics, and the contact below.

        By default all of it; of a long run the last of the largest slip events. Raises InputError for a block.
        """
        from stickslip.figures.runs import space_time

        return space_time.plot(self, start, end)

    def plot_snapshots(self, t: ArrayLike | None = None) -> Figure:
        """Displacement, velocity and stress across the slab at times t (s; default: six over a round trip of the waves).

        Raises InputError for a block.
        """
        from stickslip.figures.runs import snapshots

        return snapshots.plot(self, t)

    def plot_energy(self, start: float | None = None, end: float | None = None) -> Figure:
        """Elastic and kinetic energy, friction heat, what is radiated and damped, stacked over time (s), and the total.

        By default all of it; of a long run the last of the largest slip events. See `stickslip.figures.runs.energy`.
        """
        from stickslip.figures.runs import energy

        return energy.plot(self, start, end)

    def animate(
        self,
        path: str | Path,
        start: float | None = None,
        end: float | None = None,
        *,
        frames: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Path:
        """Write the slab in motion to a file (.gif; .mp4 and .webm need ffmpeg), beside the contact's curves. Returns the path.

        From `start` to `end` (s) as for `plot_field`, in 150 frames, 20 a second; `progress` is told how many are done.
        Raises InputError for a block, and where what writes such a file is missing.
        """
        from stickslip.figures.runs import animation

        animation.check_animation(Path(path), "animate:")
        return animation.write(animation.data(self, start, end, frames), path, progress=progress)

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """Jumps of the slip rate: time (s), cause (start, fold, echo, loading, healing), rate_before and rate_after (m/s),
        traction_before and traction_after (Pa), rule (the selection rule; empty where the slip rate is unique anyway)."""
        return shocks_table(self.history)

    @cached_property
    def breaks(self) -> Floats:
        """Times (s) at which recorded pieces begin or end, 0 and the end of the run included."""
        history = self.history
        return np.append(np.union1d(history.start, history.end[history.rests]), history.span[1])

    @property
    def curves(self) -> tuple[Curve, ...]:
        """What there is to draw: slip, slip rate, traction, load, and the state of a law that has one."""
        return CURVES if self.problem.friction.state is None else (*CURVES, "state")

    def curve(self, name: Curve, start: float | None = None, end: float | None = None, points: int = 2000) -> tuple[Floats, Floats]:
        """Times (s) and values for drawing, by default all: dense where the solution varies, with both limits at every shock."""
        if name not in self.curves:
            raise InputError(f"curve: unknown quantity '{name}'; {nearest(name, self.curves)}")
        start, end = self.shown[0] if start is None else start, self.shown[1] if end is None else end
        breaks = self.breaks[(self.breaks >= start) & (self.breaks <= end)]
        breaks = np.union1d(breaks, self.history.echo_edges(start, end, points - len(breaks)))
        if len(breaks) > points:  # too many pieces to draw each: keep the shocks, and in every stretch where it is fastest
            shocks = np.asarray(self.shocks.time[self.shocks.time.between(start, end)])
            breaks = np.union1d(shocks, self._fastest(breaks, points)) if len(shocks) <= points else self._fastest(breaks, points)
        inside = [np.linspace(a, b, 8) for a, b in pairwise(breaks)]
        right = np.unique(np.concatenate([np.linspace(start, end, points), breaks, *inside]))
        time = np.concatenate([breaks, right])
        order = np.argsort(time, kind="stable")  # left limits first
        if name in ("slip", "event_slip", "state"):  # continuous
            return time[order], getattr(self, name)(time)[order]
        evaluate = getattr(self, name)
        values = np.concatenate([evaluate(breaks, side="left"), evaluate(right)])
        return time[order], values[order]

    def _fastest(self, times: Floats, groups: int) -> Floats:
        """Of so many groups of times the one of each at which the slip rate is largest."""
        speed = np.abs(self.slip_rate(times))
        starts = np.unique(np.linspace(0, len(times) - 1, groups).astype(int))
        return np.array([times[a + int(np.argmax(speed[a:b]))] for a, b in pairwise([*starts.tolist(), len(times)])])
