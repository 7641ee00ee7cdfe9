"""Exact repeats of a logger, which asked faster than the sensor measured: such samples are no measurements."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.record.record import LOADING, MEASURED
from stickslip.foundation.arrays import Floats

FEWEST, SHARE_OF_REPEATS = 6, 0.01
"""At least so many runs of equal samples, and this share of all samples, are called repeats of a logger."""
SHARE_OF_VALUES = 0.02
"""A quantity with fewer distinct values in turn than this share of its samples has levels, and its samples are no repeats."""
CHANCE = 0.3
"""White noise of standard deviation s repeats itself with the probability q/(2 sqrt(pi) s) in steps q of a digitiser: 0.3 times q
over the usual change from sample to sample."""
COARSE = 0.1
"""Nothing can be said where chance repeats more than this share of the samples."""
SURE_REPEATS = 6.0
"""Repeats are more than chance makes, by this many standard deviations."""
TURNS = 0.35
"""Noise bends up and down in turn in at least this share of its samples: in about 2/3 of them if it is white or a random walk."""
LONG, EVEN = 2.0, 0.9
"""A logger repeats a sample this often at most, in the median; or new values come at one distance, in this share of them."""
MOVES = (0.8, 1.25)
"""A steady motion goes on after a repeat as if it had not stopped: by this factor, in the median, on the way missed."""
STEPS_OF_DIGITISER = 1.5
"""After a repeat it moves by more than this many steps of its digitiser."""
NORMAL = ("normal_stress", "normal_force", "normal_torque")
MOVING = (*LOADING, "rotation", "rotation_rate")


def repeats_in(values: Floats) -> NDArray[np.bool_]:
    """Return True for samples that repeat the one before them exactly, if noise or a steady motion would not do so."""
    equal = np.append(False, values[1:] == values[:-1])
    begins = np.flatnonzero(equal & ~np.append(False, equal[:-1]))
    fresh = values[~equal & np.isfinite(values)]
    if len(begins) < max(FEWEST, SHARE_OF_REPEATS * len(values)) or len(fresh) < max(4, SHARE_OF_VALUES * len(values)):
        return np.zeros(len(values), bool)
    if not _is_regular(equal, begins):
        return np.zeros(len(values), bool)
    change = np.diff(fresh)
    usual, bends = float(np.median(np.abs(change))), np.diff(change)
    bends = bends[np.abs(bends) > 16.0 * float(np.max(np.abs(fresh))) * float(np.finfo(float).eps)]
    digit = float(np.min(np.abs(bends), initial=usual))
    by_chance = CHANCE * digit / max(usual, 1e-300)
    noisy = len(bends) > 0.5 * len(fresh) and float(np.mean(bends[1:] * bends[:-1] < 0.0)) > TURNS
    if noisy and by_chance < COARSE:
        expected = by_chance * len(values)
        return equal if equal.sum() > expected + SURE_REPEATS * np.sqrt(expected) + FEWEST else np.zeros(len(values), bool)
    return _missed_way(values, equal, begins, digit)


def _is_regular(equal: NDArray[np.bool_], begins: NDArray[np.intp]) -> bool:
    """Return True for few and short repeats, or for new values at even distances; a contact that sticks rests for longer."""
    lengths = _lengths(equal, begins)
    if 2 * int(equal.sum()) < len(equal):
        return float(np.median(lengths)) <= LONG
    apart = np.diff(np.flatnonzero(~equal))
    return float(np.mean(np.abs(apart - np.median(apart)) <= 1.0)) > EVEN


def _lengths(equal: NDArray[np.bool_], begins: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return the numbers of repeats in each run of them."""
    ends = np.flatnonzero(equal & ~np.append(equal[1:], False))
    return np.asarray(ends - begins + 1)


def _missed_way(values: Floats, equal: NDArray[np.bool_], begins: NDArray[np.intp], digit: float) -> NDArray[np.bool_]:
    """Return True for repeats in a steady motion, which then goes on as far as it would have come; rests are longer."""
    lengths = _lengths(equal, begins)
    shares, counted = list[float](), list[int]()
    for first, length in zip(begins.tolist(), lengths.tolist(), strict=True):
        last = first + length - 1
        if first < 2 or last + 2 >= len(values):
            continue
        before, jump, after = (float(values[k + 1] - values[k]) for k in (first - 2, last, last + 1))
        if before * after > 0.0 and abs(jump) > STEPS_OF_DIGITISER * digit:
            shares.append(jump / ((length + 1) * 0.5 * (before + after)))
            counted.append(length)
    if len(shares) < FEWEST or not MOVES[0] < float(np.median(shares)) < MOVES[1]:
        return np.zeros(len(values), bool)
    found, longest = equal.copy(), 1 + 2 * float(np.median(counted))
    for first, length in zip(begins.tolist(), lengths.tolist(), strict=True):
        found[first : first + length] = length <= longest
    return found


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
