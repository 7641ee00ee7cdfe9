"""Tables of a run: slip events and shocks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.evolution.compiled import kernel
from stickslip.evolution.history import History, Moments
from stickslip.evolution.layout import S_MODE, TERMS, Floats, Integers, Store
from stickslip.evolution.polynomial import crossings, evaluate
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

CAUSES = ("", "start", "fold", "echo", "loading", "healing")

MAXIMA_PER_PIECE = 32


def default_event_rate(problem: Problem) -> float:
    """1e-6 S (range of mu) / Z, m/s; for the block sqrt(K m) stands for Z."""
    body = problem.body
    resistance = body.impedance if isinstance(body, ElasticSlab) else float(np.sqrt(body.stiffness * body.mass))
    return 1e-6 * problem.normal * problem.friction.variation / resistance


@kernel
def turning_points(store: Store, length: int, threshold: float, piece: Integers, xi: Floats, rate: Floats, kind: Integers) -> int:
    """Walk along |slip rate|: note where and how much it is at starts, ends, extrema and crossings of the threshold.

    kind: 0 a point above the threshold, +1 the rate rises above it here, -1 it falls to it here. Returns the number of points,
    or -1 if the arrays are too short.
    """
    found = 0
    p, slope, places = np.empty(TERMS), np.zeros(TERMS), np.empty(MAXIMA_PER_PIECE)
    above = False
    for n in range(length):
        if found + 3 * MAXIMA_PER_PIECE > len(piece):
            return -1
        sign = 1.0 if store.whole[n, S_MODE] >= 0 else -1.0
        for k in range(TERMS):
            p[k] = sign * store.rate[n, k]
        contiguous = n > 0 and store.whole[n, S_MODE] == store.whole[n - 1, S_MODE]
        begins = store.whole[n, S_MODE] != 0 and (p[0] > threshold or (p[0] == threshold and p[1:].any() and _rises(p)))
        if above and not (begins and contiguous):
            found = _note(piece, xi, rate, kind, found, n - 1, 1.0, 0.0, -1)
            above = False
        if store.whole[n, S_MODE] == 0:
            continue
        if begins:
            found = _note(piece, xi, rate, kind, found, n, 0.0, p[0], 0 if above else 1)
            above = True
        for k in range(TERMS - 1):
            slope[k] = (k + 1) * p[k + 1]
        p[0] -= threshold
        crossed = crossings(p, places)
        for i in range(crossed):
            above = not above
            found = _note(piece, xi, rate, kind, found, n, places[i], threshold, 1 if above else -1)
        p[0] += threshold
        for i in range(crossings(slope, places)):
            height = evaluate(p, places[i])
            if height > threshold:
                found = _note(piece, xi, rate, kind, found, n, places[i], height, 0)
        if above:
            found = _note(piece, xi, rate, kind, found, n, 1.0, p.sum(), 0)
    return found


@kernel
def _rises(p: Floats) -> bool:
    for k in range(1, len(p)):
        if p[k] != 0.0:
            return p[k] > 0.0
    return False


@kernel
def _note(
    piece: Integers, xi: Floats, rate: Floats, kind: Integers, n: int, where: int, place: float, height: float, what: int
) -> int:
    piece[n], xi[n], rate[n], kind[n] = where, place, height, what
    return n + 1


def count_pulses(rates: Floats) -> int:
    """Maxima of |v| separated by minima below half the lower of their neighbours."""
    pulses, peak, low = 1, rates[0], rates[0]
    for rate in rates[1:]:
        if low < 0.5 * min(peak, rate):
            pulses, peak, low = pulses + 1, rate, rate
        elif rate > peak:
            peak = low = rate
        low = min(low, rate)
    return pulses


def walk(history: History, threshold: float) -> tuple[Any, Any, Any, Any]:
    """`turning_points` with enough room, in order of time."""
    room = 8 * len(history) + 4 * MAXIMA_PER_PIECE
    while True:
        piece, kind = np.empty(room, np.int64), np.empty(room, np.int64)
        xi, rate = np.empty(room), np.empty(room)
        found = turning_points(history.store, len(history), threshold, piece, xi, rate, kind)
        if found >= 0:
            order = np.lexsort((-kind[:found] * (xi[:found] < 1.0), xi[:found], piece[:found]))
            return piece[:found][order], xi[:found][order], rate[:found][order], kind[:found][order]
        room *= 2


def events_table(history: History, threshold: float) -> pd.DataFrame:
    """One row a maximal interval with |slip rate| above the threshold (m/s); see the contract of `Solution.events`."""
    import pandas as pd

    piece, xi, rate, kind = walk(history, threshold)
    rows = []
    starts = np.flatnonzero(kind == 1)
    for n, first in enumerate(starts):
        last = starts[n + 1] if n + 1 < len(starts) else len(kind)
        rows.append(_event(history, piece[first:last], xi[first:last], rate[first:last], kind[first:last]))
    columns = ["start", "end", "slip", "peak_rate", "peak_time", "traction_drop", "static_drop", "pulses"]
    table = pd.DataFrame(rows, columns=columns)
    return table.astype({"pulses": int})


def _event(history: History, piece: Any, xi: Any, rate: Any, kind: Any) -> tuple[float, ...]:
    body = history.problem.body
    finished = kind[-1] == -1
    top = int(np.argmax(rate))
    slips = history.slipped(_moments(piece, xi))
    slipped = abs(slips[-1] - slips[0])
    stiffness = body.stiffness
    return (
        _time(history, piece[0], xi[0]),
        _time(history, piece[-1], xi[-1]) if finished else np.nan,
        slipped,
        float(rate[top]),
        _time(history, piece[top], xi[top]),
        _friction_before(history, piece[0], xi[0]) - _friction_after(history, piece[-1], xi[-1]),
        stiffness * slipped,
        count_pulses(rate[rate > 0.0]) if (rate > 0.0).any() else 0,
    )


def _moments(piece: Any, xi: Any) -> Moments:
    """Places in the history by piece and xi."""
    piece, xi = np.broadcast_arrays(np.atleast_1d(piece), np.atleast_1d(xi))
    return Moments(piece, xi, np.zeros(len(piece)), np.zeros(len(piece), bool))


def _time(history: History, piece: int, xi: float) -> float:
    if xi == 1.0:
        return float(history.end[piece])
    return float(history.start[piece] + xi * (history.store.speed[piece] + xi * history.store.bend[piece]))


def _friction_before(history: History, piece: int, xi: float) -> float:
    """Left limit of the traction (minus the reference)."""
    if xi > 0.0:
        return float(history.friction(_moments(piece, xi))[0])
    if piece == 0:
        return history.problem.excess
    leaped = np.array([float(history.rested(piece))])
    at = Moments(np.array([piece - 1]), np.array([1.0]), leaped, np.array([False]))
    return float(history.friction(at)[0])


def _friction_after(history: History, piece: int, xi: float) -> float:
    """Traction (minus the reference) after an event that ends here: at rest, where the slip rate falls on to zero from here.

    The traction of a law that strengthens as the rate vanishes is another one an instant before rest: it says nothing of what
    the event left behind.
    """
    at = _moments(piece, xi)
    last, rate = piece, abs(float(history.rate(at)[0]))
    mode = history.store.mode
    while last + 1 < len(history) and mode[last] == mode[piece]:
        falls = abs(history.rate(_moments(last, [0.25, 0.5, 0.75, 1.0]))) if last > piece else np.array([0.0])
        if falls.max() > rate:
            break
        last += 1
    if mode[last] != mode[piece]:
        at = _moments(last, 0.0)
    elif xi == 1.0 and piece + 1 < len(history):
        at = _moments(piece + 1, 0.0)
    return float(history.friction(at)[0])


def shocks_table(history: History) -> pd.DataFrame:
    """One row a jump of the slip rate."""
    import pandas as pd

    at = [int(n) for n in np.flatnonzero(history.store.cause)]
    reference = history.problem.strength
    rows = [
        (
            float(history.start[n]),
            CAUSES[history.store.cause[n]],
            0.0 if n == 0 else float(history.rate(_moments(n - 1, 1.0))[0]),
            float(history.rate(_moments(n, 0.0))[0]),
            reference + _friction_before(history, n, 0.0),
            reference + float(history.friction(_moments(n, 0.0))[0]),
        )
        for n in at
    ]
    return pd.DataFrame(rows, columns=["time", "cause", "rate_before", "rate_after", "traction_before", "traction_after"])


def creep_table(history: History) -> pd.DataFrame:
    """One row a leap over creep."""
    import pandas as pd

    return pd.DataFrame(history.creep, columns=["start", "end", "round_trips", "error"]).astype({"round_trips": int})
