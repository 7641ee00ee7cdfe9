"""Disturb the start of a run, and measure how the loads of the disturbed runs part from the undisturbed one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, resistance_slope, written_out
from stickslip.solution import Solution
from stickslip.solution.observables import LOST

LEAST_DISTURBANCE, LARGEST_DISTURBANCE = 1e-15, 1e-2
"""Allowed sizes of a disturbance, as shares of the strength: rounding hides smaller ones, and larger ones make another problem."""
MOST_MEMBERS = 1000
"""Largest number of members of an ensemble; each is a full run."""


def disturbed(problem: Problem, push: float) -> Problem:
    """Return the problem with `push` (Pa; block: N) added to its initial load, and with the same far stress."""
    far = problem.stress if problem.far_stress is None and is_lossy(problem) else problem.far_stress
    if problem.has_initial_rate and not problem.body.has_inertia:  # the load follows from the rate
        return replace(problem, initial_rate=problem.rate + push / resistance_slope(problem), far_stress=far)
    if problem.has_initial_rate or not problem.friction.sticks:
        return replace(written_out(problem), initial_load=problem.load + push, far_stress=far)
    return replace(problem, initial_load=None, initial_excess=problem.excess + push, far_stress=far)


def is_lossy(problem: Problem) -> bool:
    """Return True if the slab has a driver of finite impedance; its far stress follows from the initial load by default."""
    return not problem.body.is_driven_rigidly


def drawn(problem: Problem, members: int, size: float, seed: int) -> Floats:
    """Draw disturbances of the initial load (Pa; block: N), shape (members,). Raises InputError for arguments out of range.

    Their magnitudes lie between size/2 and size times the static strength, or the initial load for a law that never sticks.
    """
    check_whole("ensemble: members", members, 1, MOST_MEMBERS)
    if not LEAST_DISTURBANCE <= size <= LARGEST_DISTURBANCE:
        raise InputError(f"ensemble: size must lie between {LEAST_DISTURBANCE:g} and {LARGEST_DISTURBANCE:g}, got {size!r}")
    check_whole("ensemble: seed", seed, 0)
    scale = abs(problem.strength if problem.friction.sticks else problem.load)
    if scale == 0.0:
        raise InputError("ensemble: there is neither a strength nor an initial load whose share could disturb it")
    shares = 2.0 * np.random.default_rng(seed).random(members) - 1.0
    return _kept_going(problem, 0.5 * size * scale * (shares + np.copysign(1.0, shares)))


def _kept_going(problem: Problem, pushes: Floats) -> Floats:
    """Return the pushes, with their sign changed where they would hold back a contact that starts at its strength or beyond.

    A contact that is held back starts from rest, and its run is the same one a little later.
    """
    # excess of the load over the strength for forward and for backward slip
    ahead, behind = problem.excess, -problem.excess - problem.strength - problem.backward_strength
    held_back = ahead + pushes < 0.0 if ahead >= 0.0 else (behind >= 0.0) & (behind - pushes < 0.0)
    return np.where(held_back, -pushes, pushes)


WINDOWS, SAMPLES = 40, 64
"""Largest number of intervals of time for which separations are given, and number of times sampled in each.

No interval is shorter than the two-way travel time (block: its period).
"""
LATE = 0.1
"""Share of the times of an interval that is discarded, because shocks that come a little earlier or later spoil them."""
NOISE_SHARE = 16.0 * float(np.finfo(float).eps)
"""Share of the largest load (as a difference from the strength) below which separations are rounding noise."""
SAME_SHARE = 0.1
"""Largest difference in start of two equal events, as a share of the time to the nearer of the neighbouring events."""


class Separation(NamedTuple):
    """Separation of the members' loads from the undisturbed load.

    `apart` (Pa or N) has one row for each member and one column for each interval of time. Each value is exceeded at a tenth of the
    times in its interval: it is close to the largest one, but leaves out the times when a shock is late. `time` (s) is the end
    of each interval. A separation of `saturation` (Pa or N), a tenth of the range of the undisturbed load, or more is no longer
    small; one up to `noise` (Pa or N) is rounding.
    """

    time: Floats
    apart: Floats
    saturation: float
    noise: float

    @property
    def small(self) -> NDArray[np.bool_]:
        """True for the intervals before a member's separation is first saturated or only rounding."""
        fine = ((self.apart < self.saturation) & (self.apart > self.noise)).all(axis=0)
        return np.logical_and.accumulate(fine)


def separation(reference: Solution, runs: Sequence[Solution], until: float) -> Separation:
    """Return the separation of the runs' loads from the reference's load, from t = 0 to `until` (s)."""
    count = int(np.clip(until / reference.history.round_trip_time, 1, WINDOWS))
    share = (np.arange(SAMPLES) + 0.5) / SAMPLES
    times = (np.arange(count)[:, None] + share) * (until / count)
    undisturbed = _load(reference, times)
    gaps = np.abs([_load(run, times) - undisturbed for run in runs])
    apart = np.asarray(np.quantile(gaps, 1.0 - LATE, axis=2), np.float64)
    ends = np.asarray(until * np.arange(1, count + 1) / count, np.float64)
    return Separation(ends, apart, LOST * float(np.ptp(undisturbed)), NOISE_SHARE * float(np.abs(undisturbed).max()))


def _load(run: Solution, times: Floats) -> Floats:
    """Return the load minus the reference strength (Pa or N), a difference that keeps digits which the load itself would lose."""
    history = run.history
    return history.excess(history.find(times.ravel(), "right")).reshape(times.shape)


def slope(time: Floats, growth: Floats) -> float:
    """Return the slope (1/s) of the straight line fitted to ln(growth); NaN for fewer than three points, or if one is unknown."""
    if time.size < 3:
        return np.nan
    away = time - time.mean()
    return float(away @ np.log(growth / growth[0]) / (away @ away))


def shared_events(
    reference: pd.DataFrame, members: Sequence[pd.DataFrame], round_trip_time: float, until: float
) -> tuple[pd.DataFrame, NDArray[np.bool_]]:
    """Return the table of shared events (see `Ensemble.table`), and whether each member (row) has each event (column).

    A member has an event of the undisturbed catalogue if it has all earlier ones, and its event of the same number starts at the
    same time. Events so close to `until` (s) that a member may start them later are left out, unless all members have them.
    """
    allowed = SAME_SHARE * _nearest(reference, until)
    late = np.array([_later(reference, member, round_trip_time) for member in members])
    has = np.logical_and.accumulate(np.abs(late) <= allowed, axis=1)
    known = (reference.start.to_numpy(float) + allowed <= until) | np.all(has, axis=0)
    table = reference[["start", "recurrence", "slip"]].copy()
    table["members"] = has.sum(axis=0)
    table["amplification"] = reference.amplification
    return table[known], has[:, known]


def _nearest(table: pd.DataFrame, until: float) -> Floats:
    """Return the time (s) from each event to the nearer of its two neighbours; `until` (s) if there is no other event."""
    before = table.recurrence.to_numpy(float)
    after = np.append(before[1:], np.nan)
    nearest: Floats = np.fmin(before, after)
    return np.where(np.isnan(nearest), until, nearest)


def _later(reference: pd.DataFrame, member: pd.DataFrame, round_trip_time: float) -> Floats:
    """Return how much later (s) each event of a member starts, without the rounding of either time; NaN if there is no event."""
    return _gaps(reference.start_row, member.start_row) * round_trip_time + _gaps(reference.start_offset, member.start_offset)


def _gaps(reference: pd.Series, member: pd.Series) -> Floats:
    """Return the values of a member minus those of the undisturbed run, event by event; NaN if the member has no such event."""
    found = np.full(len(reference), np.nan)
    count = min(len(reference), len(member))
    found[:count] = member.to_numpy(float)[:count] - reference.to_numpy(float)[:count]
    return found
