"""What becomes of a small disturbance: how far the loads of runs move apart, which events they share, and what statistics keep."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.observables.predictability import LOST
from stickslip.observables.statistics import catalogue_statistics
from stickslip.solution.solution import Solution
from stickslip.trajectory.history import Floats

WINDOWS, SAMPLES = 40, 64
"""Stretches of time in which separations are looked at, no shorter than a round trip (period), and times in each."""
LATE = 0.1
"""Share of the times of a stretch that may be spoilt by shocks that come a little earlier or later."""
ROUNDING = 16.0 * float(np.finfo(float).eps)
"""Separations below this share of the largest load (as a difference from the strength) are noise."""
SAME_SHARE = 0.1
"""Events are the same if they start no further apart than this share of the time to the nearer of the events beside."""
SPREADS = ("start", "slip", "recurrence")
DESCRIBED = ("recurrence", "slip", "peak_rate")


class Separation(NamedTuple):
    """Of the loads of members from the undisturbed run: `apart` (Pa or N), one row a member, one column a stretch of time.

    Each value is what a tenth of the times of its stretch exceed: almost the largest, but not that while a shock is late.
    `time` (s) is where a stretch ends. From `saturation`, a tenth of the range of the undisturbed load, on a separation is not
    small any more; up to `noise` it is rounding.
    """

    time: Floats
    apart: Floats
    saturation: float
    noise: float

    @property
    def small(self) -> NDArray[np.bool_]:
        """Stretches before the first in which a member is too far away, or not more than rounding."""
        fine = ((self.apart < self.saturation) & (self.apart > self.noise)).all(axis=0)
        return np.logical_and.accumulate(fine)


def separation(reference: Solution, runs: Sequence[Solution], until: float) -> Separation:
    """Of loads, from t = 0 to `until` (s)."""
    count = int(np.clip(until / reference.history.row_time, 1, WINDOWS))
    share = (np.arange(SAMPLES) + 0.5) / SAMPLES
    times = (np.arange(count)[:, None] + share) * (until / count)
    undisturbed = _load(reference, times)
    gaps = np.abs([_load(run, times) - undisturbed for run in runs])
    apart = np.asarray(np.quantile(gaps, 1.0 - LATE, axis=2), np.float64)
    ends = np.asarray(until * np.arange(1, count + 1) / count, np.float64)
    return Separation(ends, apart, LOST * float(np.ptp(undisturbed)), ROUNDING * float(np.abs(undisturbed).max()))


def _load(run: Solution, times: Floats) -> Floats:
    """Load minus the reference strength, which keeps the digits that the load itself has no room for."""
    history = run.history
    return history.excess(history.find(times.ravel(), "right")).reshape(times.shape)


def slope(time: Floats, growth: Floats) -> float:
    """Slope (1/s) of the straight line that fits ln(growth) best; NaN for fewer than three points, or where one is unknown."""
    if time.size < 3:
        return np.nan
    away = time - time.mean()
    return float(away @ np.log(growth / growth[0]) / (away @ away))


def shared_events(
    reference: pd.DataFrame, members: Sequence[pd.DataFrame], row_time: float, until: float
) -> tuple[pd.DataFrame, NDArray[np.bool_]]:
    """For each event of the undisturbed catalogue how many members still have it, and how far apart (see `Ensemble.table`).

    Also whether each member (row) has each event (column): as many events before it, all of which it has, and the same start.
    Events so near `until` (s) that nobody knows are left out.
    """
    allowed = SAME_SHARE * _nearest(reference, until)
    late = np.array([_later(reference, member, row_time) for member in members])
    has = np.logical_and.accumulate(np.abs(late) <= allowed, axis=1)
    known = (reference.start.to_numpy(float) + allowed <= until) | np.all(has, axis=0)
    table = reference[["start", "recurrence", "slip"]].copy()
    table["members"] = has.sum(axis=0)
    for name in SPREADS:
        gaps = late if name == "start" else np.array([_gaps(reference[name], member[name]) for member in members])
        table[f"{name}_spread"] = _root_mean_square(np.where(has, gaps, np.nan))
    table["amplification"] = reference.amplification
    return table[known], has[:, known]


def _nearest(table: pd.DataFrame, until: float) -> Floats:
    """Time (s) from each event to the nearer of those beside it; all the time there is where there is no other."""
    before = table.recurrence.to_numpy(float)
    after = np.append(before[1:], np.nan)
    nearest: Floats = np.fmin(before, after)
    return np.where(np.isnan(nearest), until, nearest)


def _later(reference: pd.DataFrame, member: pd.DataFrame, row_time: float) -> Floats:
    """How much later (s) each event starts, without the rounding of either time; NaN where there is none."""
    return _gaps(reference.start_row, member.start_row) * row_time + _gaps(reference.start_offset, member.start_offset)


def _gaps(reference: pd.Series, member: pd.Series) -> Floats:
    """Values of a member minus those of the undisturbed run, event by event; NaN where the member has too few."""
    found = np.full(len(reference), np.nan)
    count = min(len(reference), len(member))
    found[:count] = member.to_numpy(float)[:count] - reference.to_numpy(float)[:count]
    return found


def _root_mean_square(values: Floats) -> Floats:
    """Over the first axis, of what is there; NaN where nothing is."""
    count = np.isfinite(values).sum(axis=0)
    with np.errstate(invalid="ignore"):
        return np.asarray(np.sqrt(np.nansum(values**2, axis=0) / count))


def statistics_spread(reference: pd.DataFrame, members: Sequence[pd.DataFrame]) -> pd.DataFrame:
    """How far statistics of the members are apart (see `Ensemble.statistics`)."""
    own = catalogue_statistics(reference)
    others = [catalogue_statistics(member) for member in members]
    rows = {}
    for name in DESCRIBED:
        row = {"count": float(own["count"][name])}
        for what in ("mean", "variation"):
            values = np.array([one[what][name] for one in others])
            there = values[np.isfinite(values)]
            row |= {
                what: own[what][name],
                f"{what}_members": there.mean() if there.size else np.nan,
                f"{what}_deviation": there.std(ddof=1) if there.size > 1 else np.nan,
            }
        row["chance"] = own.deviation[name] / np.sqrt(own["count"][name]) if own["count"][name] else np.nan
        rows[name] = row
    return pd.DataFrame.from_dict(rows, orient="index").astype({"count": int})
