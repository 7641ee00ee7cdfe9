"""Evaluation of a run at any time: values, shocks and curves. A whole run and a window on it share this interface."""

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
from stickslip.trajectory.history import History, Positions, Side
from stickslip.trajectory.tables import shocks_table

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from stickslip.observables.field import Field

Floats = NDArray[np.float64]
Curve = Literal["slip", "slip_rate", "traction", "load", "state", "event_slip"]
MOST_VALUES = 20_000_000
"""Largest number of times multiplied by places in one dataset; each value takes up to 0.5 kB of memory while it is computed."""
CURVES: tuple[Curve, ...] = ("slip", "slip_rate", "traction", "load")
"""Quantities that every run can draw against time."""


def check_size(t: ArrayLike, x: ArrayLike | None) -> None:
    """Raise InputError if a dataset is larger than the memory of most machines."""
    wanted = np.size(t) * (1 if x is None else np.size(x))
    if wanted > MOST_VALUES:
        raise InputError(f"dataset: {wanted:.3g} values are too many: take fewer times or places (at most {MOST_VALUES:.0e})")


class Readings:
    """Values of a run at given times.

    Times are in s since `history.epoch`. Methods take scalars or arrays and return arrays of the same shape. `side` ("left" or
    "right") picks the limit at a shock. Times outside the run raise InputError.
    """

    problem: Problem
    history: History

    @property
    def shown(self) -> tuple[float, float]:
        """Return the first and the last time (s) that figures show by default."""
        return self.history.span

    def _at(self, t: ArrayLike, side: Side) -> tuple[Positions, tuple[int, ...]]:
        try:
            time = np.asarray(t, float)
        except OverflowError:  # a whole number larger than any float
            raise InputError("times must be finite numbers in s") from None
        return self.history.find(np.atleast_1d(time).ravel(), side), time.shape

    def slip(self, t: ArrayLike) -> Floats:
        """Return the slip u.

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        ndarray
            Slip (m), of the shape of `t`. It is absolute: it starts at the initial slip.
        """
        at, shape = self._at(t, "right")
        return (self.problem.initial_slip + self.history.slipped(at)).reshape(shape)

    def slip_rate(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Return the slip rate v.

        Parameters
        ----------
        t : array_like
            Times, s.
        side : {"right", "left"}
            Limit to take at a shock.

        Returns
        -------
        ndarray
            Slip rate (m/s), of the shape of `t`.
        """
        at, shape = self._at(t, side)
        return self.history.rate(at).reshape(shape)

    def traction(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Return the friction traction tau on the contact.

        Parameters
        ----------
        t : array_like
            Times, s.
        side : {"right", "left"}
            Limit to take at a shock.

        Returns
        -------
        ndarray
            Traction (slab: Pa, block: N), of the shape of `t`; positive if it opposes forward slip.
        """
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.friction(at)).reshape(shape)

    def load(self, t: ArrayLike, side: Side = "right") -> Floats:
        """Return the load on the contact.

        Parameters
        ----------
        t : array_like
            Times, s.
        side : {"right", "left"}
            Limit to take at a shock.

        Returns
        -------
        ndarray
            Load, of the shape of `t`: beta of eqs (12)-(13) for the slab (Pa), the spring's force for the block (N).
        """
        at, shape = self._at(t, side)
        return (self.problem.strength + self.history.excess(at)).reshape(shape)

    def to_scec(self, path: str | Path, sampling_rate: float, **options: Any) -> Path:
        """Write time, slip, slip rate and shear stress as SCEC's on-fault time series.

        Parameters
        ----------
        path : str or Path
            File to write.
        sampling_rate : float
            Samples per second, Hz.
        **options
            Options of `stickslip.io.scec.write_scec`.

        Returns
        -------
        Path
            The file that was written.
        """
        from stickslip.io.scec import write_scec

        return write_scec(self, path, sampling_rate, **options)

    def to_seismogram(self, path: str | Path, sampling_rate: float, **options: Any) -> list[Path]:
        """Write miniSEED or SAC files through ObsPy.

        Parameters
        ----------
        path : str or Path
            File to write.
        sampling_rate : float
            Samples per second, Hz.
        **options
            Options of `stickslip.io.seismogram.write_seismogram`.

        Returns
        -------
        list of Path
            The files that were written.
        """
        from stickslip.io.seismogram import write_seismogram

        return write_seismogram(self, path, sampling_rate, **options)

    def state(self, t: ArrayLike) -> Floats:
        """Return the state variable of the friction law.

        Parameters
        ----------
        t : array_like
            Times, s.

        Returns
        -------
        ndarray
            State in the law's own unit (`FrictionLaw.state`), of the shape of `t`.

        Raises
        ------
        InputError
            If the law has no state variable.
        """
        if self.problem.friction.state is None:
            raise InputError(f"state: {type(self.problem.friction).__name__} has no state variable")
        at, shape = self._at(t, "right")
        return self.problem.friction.outer_state(self.history.state(at)).reshape(shape)

    def field(self, x: ArrayLike, t: ArrayLike, side: Side = "right") -> Field:
        """Return displacement, velocity and shear stress inside the slab.

        Parameters
        ----------
        x : array_like
            Distances from the contact, m.
        t : array_like
            Times, s. `x` and `t` are broadcast together: `field(x, t[:, None])` has one row per time.
        side : {"right", "left"}
            Limit in time to take at a wave front.

        Returns
        -------
        Field
            Displacement (m), velocity (m/s) and shear stress (Pa), each of the broadcast shape.

        Raises
        ------
        InputError
            For a block, and for `x` outside the slab.

        See Also
        --------
        stickslip.observables.field
        """
        from stickslip.observables.field import field

        return field(self.history, getattr(self, self.curves[0]), x, t, side)

    def plot_field(self, start: float | None = None, end: float | None = None) -> Figure:
        """Plot velocity and stress in the slab over time, with characteristics, above the curves of the contact.

        Parameters
        ----------
        start, end : float, optional
            First and last time to show, s. The default is the whole run; for a long run, the last of its largest slip events.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        InputError
            For a block.
        """
        from stickslip.figures.runs import space_time

        return space_time.plot(self, start, end)

    def plot_snapshots(self, t: ArrayLike | None = None) -> Figure:
        """Plot displacement, velocity and stress across the slab at several times.

        Parameters
        ----------
        t : array_like, optional
            Times, s. The default is six times over one round trip of the waves.

        Returns
        -------
        matplotlib.figure.Figure

        Raises
        ------
        InputError
            For a block.
        """
        from stickslip.figures.runs import snapshots

        return snapshots.plot(self, t)

    def plot_energy(self, start: float | None = None, end: float | None = None) -> Figure:
        """Plot elastic and kinetic energy, friction heat, radiated and damped energy, stacked over time, and their total.

        Parameters
        ----------
        start, end : float, optional
            First and last time to show, s. The default is the whole run; for a long run, the last of its largest slip events.

        Returns
        -------
        matplotlib.figure.Figure

        See Also
        --------
        stickslip.figures.runs.energy
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
        """Write an animation of the slab, beside the curves of the contact, to a file.

        Parameters
        ----------
        path : str or Path
            File to write: .gif; .mp4 and .webm need ffmpeg.
        start, end : float, optional
            First and last time to show, s; defaults as for `plot_field`.
        frames : int, optional
            Number of frames, shown at 20 per second. The default is 150.
        progress : callable, optional
            Function that is called with the number of finished frames and the number of all frames.

        Returns
        -------
        Path
            The file that was written.

        Raises
        ------
        InputError
            For a block, for fewer than two frames, and if the software that writes such a file is missing.
        """
        from stickslip.figures.runs import animation

        animation.check_animation(Path(path), "animate:")
        return animation.write(animation.data(self, start, end, frames), path, progress=progress)

    @cached_property
    def shocks(self) -> pd.DataFrame:
        """Return the jumps of the slip rate as a table.

        Columns: time (s); cause (start, fold, echo, loading, healing); rate_before and rate_after (m/s); traction_before and
        traction_after (Pa); rule (the selection rule; empty if the slip rate is unique without one).
        """
        return shocks_table(self.history)

    @property
    def breaks(self) -> Floats:
        """Return the times (s) at which recorded pieces begin or end, including 0 and the end of the run."""
        return self.history.breaks

    @property
    def curves(self) -> tuple[Curve, ...]:
        """Return the names of the quantities to draw: slip, slip rate, traction, load, and the state of a law that has one."""
        return CURVES if self.problem.friction.state is None else (*CURVES, "state")

    def curve(self, name: Curve, start: float | None = None, end: float | None = None, points: int = 2000) -> tuple[Floats, Floats]:
        """Return times and values of one quantity for drawing.

        Parameters
        ----------
        name : str
            One of `curves`.
        start, end : float, optional
            First and last time, s. The defaults are those of `shown`.
        points : int
            Number of evenly spaced times. More are added at the breaks and between them, where the solution varies.

        Returns
        -------
        time : ndarray
            Times (s), in ascending order. A shock appears twice, with its left limit first.
        values : ndarray
            Values in the quantity's unit, of the shape of `time`.

        Raises
        ------
        InputError
            If `name` is not one of `curves`.
        """
        if name not in self.curves:
            raise InputError(f"curve: unknown quantity '{name}'; {nearest(name, self.curves)}")
        start, end = self.shown[0] if start is None else start, self.shown[1] if end is None else end
        breaks = self.breaks[(self.breaks >= start) & (self.breaks <= end)]
        breaks = np.union1d(breaks, self.history.echo_edges(start, end, points - len(breaks)))
        if len(breaks) > points:  # too many pieces to draw each: keep the shocks, and the fastest time of every interval
            shocks = np.asarray(self.shocks.time[self.shocks.time.between(start, end)])
            breaks = np.union1d(shocks, self._fastest(breaks, points)) if len(shocks) <= points else self._fastest(breaks, points)
        inside = [np.linspace(a, b, 8) for a, b in pairwise(breaks)]
        right = np.unique(np.concatenate([np.linspace(start, end, points), breaks, *inside]))
        time = np.concatenate([breaks, right])
        order = np.argsort(time, kind="stable")  # stable: puts the left limits first
        if name in ("slip", "event_slip", "state"):  # continuous: both limits are the same
            return time[order], getattr(self, name)(time)[order]
        evaluate = getattr(self, name)
        values = np.concatenate([evaluate(breaks, side="left"), evaluate(right)])
        return time[order], values[order]

    def _fastest(self, times: Floats, groups: int) -> Floats:
        """Return, for each of the given number of groups of consecutive times, the time at which the slip rate is largest."""
        speed = np.abs(self.slip_rate(times))
        starts = np.unique(np.linspace(0, len(times) - 1, groups).astype(int))
        return np.array([times[a + int(np.argmax(speed[a:b]))] for a, b in pairwise([*starts.tolist(), len(times)])])
