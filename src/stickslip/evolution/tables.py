"""Tables of a run: slip events and shocks."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.bodies import ElasticSlab
from stickslip.contact.uniqueness import uniqueness
from stickslip.evolution.compiled import kernel
from stickslip.evolution.history import Epoch, History, Moments
from stickslip.evolution.layout import S_MODE, TERMS, Floats, Integers, Store
from stickslip.evolution.moving_branches import folds_move, is_algebraic
from stickslip.evolution.polynomial import crossings, evaluate
from stickslip.problem import Problem

if TYPE_CHECKING:
    import pandas as pd

EVENT_COLUMNS = {
    "start": ("s", "when |v| rises above the threshold"),
    "end": ("s", "when it falls to it; NaN if the run ends first"),
    "duration": ("s", "end - start, without the rounding of either"),
    "recurrence": ("s", "start - start of the previous event, without the rounding of either"),
    "slip": ("m", "slip within the event, positive in either direction"),
    "peak_rate": ("m s-1", "largest |v|"),
    "peak_time": ("s", "when"),
    "peak_after": ("s", "peak_time - start, without the rounding of either"),
    "traction_before": ("load", "friction just before"),
    "traction_after": ("load", "friction at rest after"),
    "traction_drop": ("load", "traction_before - traction_after"),
    "static_drop": ("load", "stiffness (G/h, or K) times slip"),
    "pulses": ("1", "maxima of |v| separated by minima below half the lower one"),
    "phase": ("1", "part of the row (round trip of a slab, period of a block) that has passed at the start"),
    "start_row": ("1", "whole rows before the start"),
    "start_offset": ("s", "the rest: start = start_row * length of a row + start_offset, without rounding"),
}
"""Columns of the catalogue: unit ("load" is Pa or N, "energy" J m-2 or J) and meaning."""

ENERGY_COLUMNS = {
    "released": ("energy", "elastic and kinetic energy that the event takes from the body"),
    "work": ("energy", "work of the driver in the meantime, net of what radiates through it"),
    "damped": ("energy", "dissipated by the block's damping"),
    "trapped": ("energy", "of the waves that bounce in the slab at the end, beyond the same mean stress at rest"),
    "heat": ("energy", "friction heat, from the law"),
    "balance": ("energy", "released + work - heat - damped: zero for an exact solution"),
}

Energies = Callable[[History, Moments, Moments], Mapping[str, Floats]]

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


class Points(NamedTuple):
    """Points along a slip event: piece of the history, place xi in it, |slip rate| there, and `kind` of `turning_points`."""

    piece: Any
    xi: Any
    rate: Any
    kind: Any

    @property
    def finished(self) -> bool:
        """Whether the slip rate falls to the threshold within the run."""
        return bool(self.kind[-1] == -1)


def slip_events(history: History, threshold: float) -> list[Points]:
    """Maximal intervals with |slip rate| above the threshold (m/s), in order of time."""
    points = walk(history, threshold)
    bounds = np.append(np.flatnonzero(points[3] == 1), len(points[3]))
    return [Points(*(column[first:last] for column in points)) for first, last in pairwise(bounds)]


def events_table(history: History, threshold: float, energies: Energies | None = None) -> pd.DataFrame:
    """One row a maximal interval with |slip rate| above the threshold (m/s); columns as in EVENT_COLUMNS.

    `energies` gives those of ENERGY_COLUMNS from the first and last moments of all events.
    """
    import pandas as pd

    found = slip_events(history, threshold)
    names = [name for name in EVENT_COLUMNS if name != "recurrence"]
    table = pd.DataFrame([_event(history, points) for points in found], columns=names)
    table = table.astype({"pulses": int, "start_row": int})
    since = (table.start_row.diff() * history.row_time + table.start_offset.diff()).astype(float)
    table.insert(list(EVENT_COLUMNS).index("recurrence"), "recurrence", since)
    if energies is None:
        return table
    ends = [Moments.inside([p.piece[k] for p in found], [p.xi[k] for p in found]) for k in (0, -1)]
    return table.assign(**energies(history, *ends))


def _event(history: History, points: Points) -> tuple[float, ...]:
    piece, xi, rate, _ = points
    top = int(np.argmax(rate))
    at = Moments.inside(piece[[0, -1, top]], xi[[0, -1, top]])
    rows, offsets = history.placed(at)
    own = history.seen_from(Epoch(int(rows[0]), float(offsets[0])))
    start, end, peak = history.seconds(rows, offsets)
    _, lasts, peak_after = own.seconds(rows, offsets)
    first, last = (Moments.inside(piece[k], xi[k]) for k in (0, -1))
    slipped = abs(float(history.slipped_since(first, last)[0]))
    before, after = _friction_before(history, piece[0], xi[0]), _friction_after(history, piece[-1], xi[-1])
    return (
        start,
        end if points.finished else np.nan,
        lasts if points.finished else np.nan,
        slipped,
        float(rate[top]),
        peak,
        peak_after,
        history.problem.strength + before,
        history.problem.strength + after,
        before - after,
        history.problem.body.stiffness * slipped,
        count_pulses(rate[rate > 0.0]) if (rate > 0.0).any() else 0,
        offsets[0] / history.row_time,
        rows[0],
        offsets[0],
    )


def _friction_before(history: History, piece: int, xi: float) -> float:
    """Left limit of the traction (minus the reference)."""
    if xi > 0.0:
        return float(history.friction(Moments.inside(piece, xi))[0])
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
    at = Moments.inside(piece, xi)
    last, rate = piece, abs(float(history.rate(at)[0]))
    mode = history.store.mode
    while last + 1 < len(history) and mode[last] == mode[piece]:
        falls = abs(history.rate(Moments.inside(last, [0.25, 0.5, 0.75, 1.0]))) if last > piece else np.array([0.0])
        if falls.max() > rate:
            break
        last += 1
    if mode[last] != mode[piece]:
        at = Moments.inside(last, 0.0)
    elif xi == 1.0 and piece + 1 < len(history):
        at = Moments.inside(piece + 1, 0.0)
    return float(history.friction(at)[0])


def shocks_table(history: History, first: float = -np.inf, last: float = np.inf) -> pd.DataFrame:
    """One row a jump of the slip rate between two times (s)."""
    import pandas as pd

    at = [int(n) for n in np.flatnonzero((history.store.cause > 0) & (history.start >= first) & (history.start <= last))]
    reference = history.problem.strength
    rows = [
        (
            float(history.start[n]),
            CAUSES[history.store.cause[n]],
            0.0 if n == 0 else float(history.rate(Moments.inside(n - 1, 1.0))[0]),
            float(history.rate(Moments.inside(n, 0.0))[0]),
            reference + _friction_before(history, n, 0.0),
            reference + float(history.friction(Moments.inside(n, 0.0))[0]),
        )
        for n in at
    ]
    columns = ["time", "cause", "rate_before", "rate_after", "traction_before", "traction_after"]
    return pd.DataFrame(rows, columns=columns).assign(rule=rule_in_force(history.problem) if rows else "")


def creep_table(history: History) -> pd.DataFrame:
    """One row a leap over creep."""
    import pandas as pd

    row, trips, error, delay = history.creep.T
    start, end = history.seconds(row, np.zeros(len(row))), history.seconds(row + trips, np.zeros(len(row)))
    columns = {"start": start, "end": end, "start_row": row, "round_trips": trips, "error": error, "time_error": delay}
    return pd.DataFrame(columns).astype({"start_row": int, "round_trips": int})


def creep_note(creep: Floats) -> str:
    """One line on the leaps over creep of `History.creep`; empty where there are none."""
    if not len(creep):
        return ""
    leaps, (_, trips, error, delay) = len(creep), creep.T
    over = f"{leaps} leap{'s' * (leaps > 1)} over {int(trips.sum())} round trips"
    return f"{over}, error at most {error.max():.1e} m of slip, {delay.max():.3g} s of time"


def rule_in_force(problem: Problem) -> str:
    """The selection rule, where the contact equation has several solutions at some load (and slip); else empty."""
    if not is_algebraic(problem):
        return ""
    several = folds_move(problem) or uniqueness(problem).regime != "regular"
    return problem.rule if several else ""
