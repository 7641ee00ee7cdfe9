"""Exact repeats of a logger, which asked faster than the sensor measured: such samples are no measurements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.inference.record.record import LOADING, MEASURED

FEWEST, SHARE = 6, 0.01
"""At least so many runs of equal samples, and this share of all samples, are called repeats of a logger."""
LEVELS = 0.02
"""A quantity with fewer distinct values in turn than this share of its samples has levels, and its samples are no repeats."""
CHANCE = 0.3
"""White noise of standard deviation s repeats itself with the probability q/(2 sqrt(pi) s) in steps q of a digitiser: 0.3 times q
over the usual change from sample to sample."""
COARSE = 0.1
"""Nothing can be said where chance repeats more than this share of the samples."""
SURE = 6.0
"""Repeats are more than chance makes, by this many standard deviations."""
TURNS = 0.35
"""Noise turns from rising to falling, or back, in at least this share of its samples: 2/3 if white, 1/2 as a random walk."""
MOVES = (0.8, 1.25)
"""A steady motion goes on after a repeat as if it had not stopped: by this factor, in the median, on the way missed."""
STEPS = 1.5
"""After a repeat it moves by more than this many steps of its digitiser."""
NORMAL = ("normal_stress", "normal_force", "normal_torque")
MOVING = (*LOADING, "rotation", "rotation_rate")


def repeats_in(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples that repeat the one before them exactly, if noise or a steady motion would not do so."""
    equal = np.append(False, values[1:] == values[:-1])
    count = int(equal.sum())
    begins = np.flatnonzero(equal & ~np.append(False, equal[:-1]))
    fresh = values[~equal & np.isfinite(values)]
    if len(begins) < max(FEWEST, SHARE * len(values)) or len(fresh) < max(4, LEVELS * len(values)):
        return np.zeros(len(values), bool)
    change = np.diff(fresh)
    usual = float(np.median(np.abs(change)))
    bends = np.abs(np.diff(change))
    exact = 16.0 * float(np.max(np.abs(fresh))) * float(np.finfo(float).eps)
    digit = float(np.min(bends[bends > exact], initial=usual)) if (bends > exact).any() else usual
    by_chance = CHANCE * digit / max(usual, 1e-300)
    turns = float(np.mean(change[1:] * change[:-1] < 0.0))
    if turns > TURNS and by_chance < COARSE:
        expected = by_chance * len(values)
        return equal if count > expected + SURE * np.sqrt(expected) + FEWEST else np.zeros(len(values), bool)
    return _missed_way(values, equal, begins, digit)


def _missed_way(values: Floats, equal: NDArray[np.bool_], begins: NDArray[np.intp], digit: float) -> NDArray[np.bool_]:
    """Return True for repeats in a steady motion: it then goes on as far as it would have come."""
    found, shares = np.zeros(len(values), bool), list[float]()
    for first in begins.tolist():
        last = first
        while last + 1 < len(values) and equal[last + 1]:
            last += 1
        if first < 2 or last + 2 >= len(values):
            continue
        before, jump, after = (values[k + 1] - values[k] for k in (first - 2, last, last + 1))
        if not before * after > 0.0 or not abs(jump) > STEPS * digit:
            continue
        share = float(jump / ((last - first + 2) * 0.5 * (before + after)))
        shares.append(share)
        found[first : last + 1] = 2.0 * abs(share - 1.0) < 1.0
    sure = len(shares) >= FEWEST and MOVES[0] < float(np.median(shares)) < MOVES[1]
    return found if sure else np.zeros(len(values), bool)


def without_repeats(found: dict[str, Floats], notes: list[str]) -> dict[str, Floats]:
    """Return columns without samples that repeat the one before, and add a sentence for each of them.

    Rows that are repeats as a whole are left out. In other rows a repeated value has no number; a normal load is interpolated.
    """
    columns = [name for name in found if name in (*MEASURED, *MOVING, *NORMAL)]
    old = {name: repeats_in(found[name]) for name in columns}
    stale = np.any([old[name] for name in columns if name in MEASURED], axis=0) if columns else np.zeros(0, bool)
    for name in (one for one in columns if one in MOVING):  # at rest only the other columns tell
        old[name] |= np.append(False, found[name][1:] == found[name][:-1]) & stale
    told = {name: int(one.sum()) for name, one in old.items() if one.any()}
    if not told:
        return found
    count = len(found["time"])
    for name, often in told.items():
        rest = f"{count - often} samples count" if name in MEASURED else "they are interpolated" if name in NORMAL else "left out"
        notes.append(f"{name} repeats the sample before it exactly in {often} of {count} rows, as a logger does: {rest}")
    changing = [name for name in columns if np.nanmax(found[name]) > np.nanmin(found[name])]
    whole = np.all([old[name] for name in changing], axis=0)
    result = dict(found)
    for name, one in old.items():
        if one.any() and name in NORMAL:
            result[name] = np.interp(found["time"], found["time"][~one], found[name][~one])
        elif one.any():
            result[name] = np.where(one, np.nan, found[name])
    return {name: values[~whole] for name, values in result.items()}
