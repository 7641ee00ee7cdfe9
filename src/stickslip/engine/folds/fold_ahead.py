"""Find a fold that moves with slip, from the series of the slip rate.

Towards a fold the slip rate s goes as the square root of the time left, but time as a function of s is smooth: it turns there.
Therefore the series s(t) is reversed, and the fold is where dt/ds = 0.
"""

from __future__ import annotations

import math

from stickslip.engine.contact.contact_equation import first_piece, last_piece
from stickslip.engine.series.polynomial import NONE
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import Run, borrow
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.addresses import room_for

REVERSED = 14
"""Order of the reversed series (1): rounding grows with it, to 1e-13 here."""
TERMS_OF_FOLD = REVERSED + 1
"""Number of its terms (1)."""
TABLE = TERMS_OF_FOLD * TERMS_OF_FOLD
"""Numbers (1) in a table of such series."""
ENOUGH = 1e-12
"""Largest sum of the last two terms (1), relative to the time to the fold, for the fold to count as found."""
ALIKE_ESTIMATES = 0.03
"""If two estimates of the time to the fold differ by more than this (relative, 1), no fold is sought."""


@kernel
def time_to_root(jet: Floats) -> float:
    """Return the time, in the unit of the series, to the branch point of a square root, judged from the last coefficients.

    Those of (T - t)^(1/2) obey c_(k+1) = c_k (k - 1/2) / (k + 1) / T, and all but c_0 have one sign. The result is NONE if the
    coefficients do not look like that.
    """
    n = TERMS - 1
    if jet[1] * jet[n] <= 0.0 or jet[1] * jet[n - 1] <= 0.0:
        return NONE
    time = (n - 1.5) / n * jet[n - 1] / jet[n]
    before = (n - 2.5) / (n - 1) * jet[n - 2] / jet[n - 1]
    return time if abs(before - time) <= ALIKE_ESTIMATES * time and time < math.inf else NONE


@kernel
def reversed_series(jet: Floats, time: float, out: Floats) -> None:
    """Write t / time as a series in z = (s - s_0) / (2 s_1 time) into out, order by order.

    In these units the series of a square root alone is 2 z - z^2.
    """
    powers = room_for(TABLE)  # z^n in (t / time)^j
    for n in range(TABLE):
        powers[n] = 0.0
    out[0], out[1] = 0.0, 2.0
    powers[TERMS_OF_FOLD + 1] = 2.0
    for n in range(2, TERMS_OF_FOLD):
        out[n] = 0.0
        scale = 1.0
        for j in range(2, n + 1):
            for m in range(1, n - j + 2):
                powers[TERMS_OF_FOLD * j + n] += powers[TERMS_OF_FOLD + m] * powers[TERMS_OF_FOLD * (j - 1) + n - m]
            scale *= time
            out[n] -= jet[j] / jet[1] * scale * powers[TERMS_OF_FOLD * j + n]
        powers[TERMS_OF_FOLD + n] = out[n]


@kernel
def fold_ahead(jet: Floats) -> tuple[float, float]:
    """Return the time to the fold that the series of the slip rate runs into, and the rate (m/s) there.

    The time is in the unit of the series, and NONE if no fold is seen.
    """
    time = time_to_root(jet)
    if time == NONE:
        return NONE, 0.0
    series = room_for(TERMS_OF_FOLD)
    reversed_series(jet, time, series)
    if not abs(series[REVERSED]) + abs(series[REVERSED - 1]) <= ENOUGH:
        return NONE, 0.0
    z, value = 1.0, 0.0
    for _ in range(20):
        value, slope, bend = 0.0, 0.0, 0.0
        for k in range(REVERSED, -1, -1):
            bend = bend * z + 2.0 * slope
            slope = slope * z + value
            value = value * z + series[k]
        step = slope / bend
        z -= step
        if not 0.5 < z < 2.0:
            return NONE, 0.0
        if abs(step) <= 1e-15:
            break
    return value * time, jet[0] + 2.0 * jet[1] * time * z


@kernel
def way_to_fold(run: Run, unit: float) -> float:
    """Return the way (in xi) to the fold that the present series runs into, and note the rate there in state.fold_rate.

    The series is in units of `unit` (in xi). The way is NONE if no fold is seen, or if the law leaves its piece before it.
    """
    eta, rate = fold_ahead(run.jet)
    if eta == NONE or rate <= 0.0:
        return NONE
    piece = run.counts.piece
    if run.counts.knots_in_rate == 1:
        if rate > run.law[piece].knot or (piece > first_piece(run) and rate < run.law[piece - 1].knot):
            return NONE
    elif run.pieces > 1:
        walked = max(rate, run.jet[0]) * (run.k.speed + 0.5 * run.k.bend * eta) * eta
        slip = run.state.law_slip
        knot = piece if run.k.chi > 0.0 else piece - 1
        if first_piece(run) <= knot < last_piece(run) and abs(run.law[knot].knot - slip) <= abs(walked):
            return NONE
    run.state.fold_rate = rate
    return eta * unit


@entry
def moving_folds(memory: int, task: int, unit: float) -> float:
    """Return the way (in xi) to the moving fold that the present series, in units of `unit` (in xi), runs into."""
    return way_to_fold(borrow(memory), unit)
