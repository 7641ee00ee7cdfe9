"""The contact equation g(v) = Z v + S mu(v) as a curve with its folds and jumps, and the path of a run on it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.uniqueness import Uniqueness
from stickslip.explorer.model.answer import ContactPicture, Floats, Motion

CURVE_POINTS = 500
"""Number of evenly spaced slip rates of the curve; as many in even ratios, folds and knots are added."""
BEYOND = 1.15
"""The curve reaches this far beyond the fastest slip rate of the run, and of the jumps of the rule."""


def contact_picture(contact: Uniqueness, motion: Motion) -> ContactPicture | None:
    """Return the contact equation and the run's path on it; None if the slip rate is a state and follows from no such equation."""
    g = contact.resistance
    if g is None:
        return None
    fastest = [float(np.abs(motion.slip_rate).max()), *(max(jump.rate_before, jump.rate_after) for jump in contact.jumps)]
    fastest += [2.0 * fold.rate for fold in contact.folds]
    top = BEYOND * max(fastest) or 2.0 * min(g.scales)
    own = [*(fold.rate for fold in contact.folds), *g.rate_knots]
    grid = np.concatenate([np.linspace(0.0, top, CURVE_POINTS), np.geomspace(1e-5 * top, top, CURVE_POINTS), own])
    rate = np.unique(grid[grid <= top])
    excess, slope = g.excess_and_slope(rate)
    load, kind = g.strength + excess, np.sign(slope).astype(np.int64)
    if motion.slip_rate.min() < 0.0:  # the mirror image, after a gap
        rate, load = (np.concatenate([-values[::-1], [np.nan], values]) for values in (rate, load))
        kind = np.concatenate([kind[::-1], [0], kind])
    time, path_rate, path_load = _path(motion)
    return ContactPicture(
        rate=rate,
        load=load,
        stability=kind,
        strength=g.strength,
        folds=np.array([(fold.rate, fold.load) for fold in contact.folds]).reshape(-1, 2),
        jumps=np.array([(jump.rate_before, jump.load, jump.rate_after, jump.load) for jump in contact.jumps]).reshape(-1, 4),
        path_time=time,
        path_rate=path_rate,
        path_load=path_load,
    )


def _path(motion: Motion) -> tuple[Floats, Floats, Floats]:
    """Return time, slip rate and load of a run, with NaN for rate and load where the slip rate jumps."""
    jumps: NDArray[np.intp] = np.flatnonzero((np.diff(motion.time) == 0.0) & (np.diff(motion.slip_rate) != 0.0)) + 1
    return (
        np.insert(motion.time, jumps, motion.time[jumps]),
        np.insert(motion.slip_rate, jumps, np.nan),
        np.insert(motion.load, jumps, np.nan),
    )
