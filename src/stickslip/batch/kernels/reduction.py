"""Reduce the history of a run to the numbers that a batch keeps, which equal those in the tables of a `Solution`.

The kernels of `trajectory.slip_events` find the slip events. The functions here do in compiled code, for one event or run, what
`trajectory.tables` does for all. Functions on a history take the pieces as pointers (`Pieces`), and the number of pieces as
`length`. A place in it is a pair of a piece and xi from 0 to 1; `row_time` is the length of a round trip (of a block: of a period),
in s.
"""

from __future__ import annotations

import math

from stickslip.batch.kernels.pieces import Pieces, load_of, pieces_of, rate_of, real_of, whole_of
from stickslip.batch.kernels.points import Points
from stickslip.engine.codegen.compiler import floats, kernel
from stickslip.engine.contact_step.contact_equation import friction_of
from stickslip.engine.series.polynomial import evaluate, integral
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Floats, Stop, Store
from stickslip.engine.state.workspace import Run
from stickslip.trajectory.history import ROUNDING
from stickslip.trajectory.slip_events import rises_over

COLUMNS = (
    "events",
    "pulses",
    "shocks",
    "slip",
    "peak_rate",
    "peak_time",
    "first_start",
    "first_end",
    "first_duration",
    "first_slip",
    "first_traction_drop",
    "first_static_drop",
    "recurrence",
    "recurrence_cv",
    "end_time",
    "arrested",
    "irregular",
    "branches",
)
"""Names of the numbers that are kept of each run, in SI units, in the order of their columns."""
(
    EVENTS,
    PULSES,
    SHOCKS,
    SLIP,
    PEAK_RATE,
    PEAK_TIME,
    FIRST_START,
    FIRST_END,
    FIRST_DURATION,
    FIRST_SLIP,
    FIRST_TRACTION_DROP,
    FIRST_STATIC_DROP,
    RECURRENCE,
    RECURRENCE_CV,
    END_TIME,
    ARRESTED,
    IRREGULAR,
    BRANCHES,
) = range(len(COLUMNS))
OF_EVENTS = frozenset(COLUMNS[n] for n in (EVENTS, PULSES, *range(PEAK_RATE, RECURRENCE_CV + 1)))
"""Columns for which slip events must be found."""

# ---- places in a history ----------------------------------------------------------------------------------------------------


@kernel
def offset_at(store: Pieces, piece: int, xi: float) -> float:
    """Return the offset (s) of a place in its round trip, as in `History.placed`."""
    real = real_of(store, piece)
    if xi == 1.0:
        return real[at.S_THETA_TO]
    return real[at.S_THETA_FROM] + xi * (real[at.S_SPEED] + xi * real[at.S_BEND])


@kernel
def time_between(store: Pieces, row_time: float, piece: int, xi: float, later: int, later_xi: float) -> float:
    """Return the time (s) from one place to a later one."""
    rows = whole_of(store, later)[at.S_ROW] - whole_of(store, piece)[at.S_ROW]
    return rows * row_time + (offset_at(store, later, later_xi) - offset_at(store, piece, xi))


@kernel
def time_at(store: Pieces, row_time: float, piece: int, xi: float) -> float:
    """Return the time (s) of a place since the start of the run."""
    return whole_of(store, piece)[at.S_ROW] * row_time + offset_at(store, piece, xi)


@kernel
def place_of(store: Pieces, piece: int, local: float) -> float:
    """Return the place xi in [0, 1] of a time `local` s after the start of a piece, as in `History.xi`."""
    speed, bend = real_of(store, piece)[at.S_SPEED], real_of(store, piece)[at.S_BEND]
    pace = speed + math.sqrt(max(speed * speed + 4.0 * bend * local, 0.0))
    return min(max(2.0 * local / (pace if pace > 0.0 else 1.0), 0.0), 1.0)


@kernel
def grown(store: Pieces, piece: int, xi: float) -> float:
    """Return the slip (m) since the start of the piece, as in `History.grown`."""
    rate, bend = rate_of(store, piece), real_of(store, piece)[at.S_BEND]
    straight = real_of(store, piece)[at.S_SPEED] * integral(rate, xi, 1)
    return straight if bend == 0.0 else straight + 2.0 * bend * integral(rate, xi, 2)


@kernel
def reached(run_end: float, code: int, row_time: float, store: Pieces, length: int) -> float:
    """Return the time (s) that a run has reached: `run_end` if it is finished or locked, otherwise the end of its history."""
    return run_end if code in (Stop.FINISHED, Stop.LOCKED) else time_at(store, row_time, length - 1, 1.0)


@kernel
def rests_at(store: Pieces, length: int, row_time: float, end: float) -> bool:
    """Return True if the contact is at rest at the end of the run (s), in the last piece or after it, where nothing is recorded."""
    recorded = time_at(store, row_time, length - 1, 1.0)
    return whole_of(store, length - 1)[at.S_MODE] == 0 or end - recorded > ROUNDING * recorded


@kernel
def slipped(store: Pieces, length: int, row_time: float, end: float) -> float:
    """Return the slip (m) from the start of the run to its end (s)."""
    last = length - 1
    while last > 0 and time_at(store, row_time, last, 0.0) > end:
        last -= 1
    return real_of(store, last)[at.S_SLIP] + grown(store, last, place_of(store, last, end - time_at(store, row_time, last, 0.0)))


@kernel
def slipped_between(store: Pieces, piece: int, xi: float, later: int, later_xi: float) -> float:
    """Return the slip (m) from one place to a later one, as in `History.slipped_within`."""
    whole = 0.0
    for n in range(piece, later):
        whole += grown(store, n, 1.0)
    return whole + (grown(store, later, later_xi) - grown(store, piece, xi))


# ---- friction ---------------------------------------------------------------------------------------------------------------


@kernel
def friction_in(run: Run, store: Pieces, piece: int, xi: float) -> float:
    """Return friction minus the reference strength (Pa or N) at a place, in slip or at rest, as in `History.friction`."""
    excess, rate, mode = evaluate(load_of(store, piece), xi), evaluate(rate_of(store, piece), xi), whole_of(store, piece)[at.S_MODE]
    if run.counts.has_inertia == 0:
        return excess - run.par.impedance * rate
    if mode == 0:
        return excess
    walked = grown(store, piece, xi) * (1 if run.par.counts_net == 1.0 else mode)
    friction_of(run, whole_of(store, piece)[at.S_PIECE], real_of(store, piece)[at.S_LAW_SLIP] + walked, abs(rate), run.value)
    return run.value[0] if mode > 0 else -run.value[0] - 2.0 * run.par.reference


@kernel
def friction_before(run: Run, store: Pieces, piece: int, excess: float) -> float:
    """Return friction minus the reference strength (Pa or N) just before a piece starts.

    Before the first piece the contact is at rest under the initial `excess`. After round trips at rest that were not recorded, the
    load follows from the piece whose echo holds there, and from the ramp.
    """
    if piece == 0:
        return excess
    row_time, last = run.par.row_time, piece - 1
    if not time_between(store, row_time, last, 1.0, piece, 0.0) > ROUNDING * row_time:
        return friction_in(run, store, last, 1.0)
    row, phase = whole_of(store, piece)[at.S_ROW], real_of(store, piece)[at.S_THETA_FROM]
    if phase == 0.0:
        row, phase = row - 1, row_time
    while last >= 0 and not (real_of(store, last)[at.S_THETA_FROM] < phase <= real_of(store, last)[at.S_THETA_TO]):
        last -= 1
    if last < 0:
        return friction_in(run, store, piece - 1, 1.0)
    xi, trips = place_of(store, last, phase - real_of(store, last)[at.S_THETA_FROM]), row - whole_of(store, last)[at.S_ROW]
    if trips == 0:
        return friction_in(run, store, last, xi)
    load = evaluate(load_of(store, last), xi) + trips * run.par.ramp
    return load if run.counts.is_block == 1 else load - 2.0 * run.par.impedance * evaluate(rate_of(store, last), xi)


@kernel
def friction_after(run: Run, store: Pieces, length: int, piece: int, xi: float) -> float:
    """Return friction minus the reference strength (Pa or N) after an event that ends at a place, as in `tables.friction_after`.

    If the slip rate falls from there to zero, this is the friction at rest.
    """
    mode, rate = whole_of(store, piece)[at.S_MODE], abs(evaluate(rate_of(store, piece), xi))
    for n in range(piece + 1, length):
        if whole_of(store, n)[at.S_MODE] != mode:
            return friction_in(run, store, n, 0.0)
        if rises_over(rate_of(store, n), rate):
            break
    if xi == 1.0 and piece + 1 < length:
        return friction_in(run, store, piece + 1, 0.0)
    return friction_in(run, store, piece, xi)


# ---- events -----------------------------------------------------------------------------------------------------------------


@kernel
def fold_events(run: Run, store: Pieces, points: Points, events: int, out: Floats) -> None:
    """Write the numbers that describe all slip events, and their recurrence, into `out`; columns without a value become NaN."""
    out[EVENTS], out[PULSES] = events, 0.0
    for column in range(PEAK_RATE, RECURRENCE_CV + 1):
        out[column] = math.nan
    if events == 0:
        return
    row_time, fastest = run.par.row_time, points.top[0]
    for n in range(events):
        out[PULSES] += points.pulses[n]
        if points.rate[points.top[n]] > points.rate[fastest]:
            fastest = points.top[n]
    out[PEAK_RATE] = points.rate[fastest]
    out[PEAK_TIME] = time_at(store, row_time, points.piece[fastest], points.xi[fastest])
    if events > 1:
        fold_recurrence(store, row_time, points, events, out)


@kernel
def fold_recurrence(store: Pieces, row_time: float, points: Points, events: int, out: Floats) -> None:
    """Write the mean (s) and the coefficient of variation of the times between starts of events into `out`.

    The latter is the sample standard deviation over the mean; it stays NaN for two events, which have one recurrence time.
    """
    mean = spread = 0.0
    for n in range(1, events):
        a, b = points.begin[n - 1], points.begin[n]
        since = time_between(store, row_time, points.piece[a], points.xi[a], points.piece[b], points.xi[b])
        change = since - mean
        mean += change / n
        spread += change * (since - mean)
    out[RECURRENCE] = mean
    if events > 2:
        out[RECURRENCE_CV] = math.sqrt(spread / (events - 2)) / mean


@kernel
def fold_first(run: Run, store: Pieces, length: int, points: Points, excess: float, stiffness: float, out: Floats) -> None:
    """Write the numbers that describe the first event into `out`, as in `tables.event_rows`.

    excess is the initial load minus the static strength (Pa or N), stiffness that of the body (Pa/m or N/m).
    """
    a, b = points.begin[0], points.past[0] - 1
    piece, xi, last, last_xi = points.piece[a], points.xi[a], points.piece[b], points.xi[b]
    row_time = run.par.row_time
    out[FIRST_START] = time_at(store, row_time, piece, xi)
    if points.kind[b] == -1:
        out[FIRST_END] = time_at(store, row_time, last, last_xi)
        out[FIRST_DURATION] = time_between(store, row_time, piece, xi, last, last_xi)
    out[FIRST_SLIP] = abs(slipped_between(store, piece, xi, last, last_xi))
    out[FIRST_STATIC_DROP] = stiffness * out[FIRST_SLIP]
    before = friction_before(run, store, piece, excess) if xi == 0.0 else friction_in(run, store, piece, xi)
    out[FIRST_TRACTION_DROP] = before - friction_after(run, store, length, last, last_xi)


@kernel
def fold_whole(store: Pieces, length: int, row_time: float, duration: float, code: int, out: Floats) -> None:
    """Write the numbers that describe the whole run into `out`; the run was to last `duration` s and ended with a `Stop` code."""
    end = reached(duration, code, row_time, store, length)
    shocks = 0
    for n in range(length):
        shocks += 1 if whole_of(store, n)[at.S_CAUSE] > 0 else 0
    out[SHOCKS], out[END_TIME] = shocks, end
    out[ARRESTED] = 1.0 if rests_at(store, length, row_time, end) else 0.0
    out[SLIP] = slipped(store, length, row_time, end)


@kernel
def fold_end(store: Store, length: int, row_time: float, duration: float, code: int, out: Floats) -> None:
    """Do the same as `fold_whole` for the last pieces of a history, but keep the number of shocks, which are not all among them."""
    shocks = out[SHOCKS]
    fold_whole(pieces_of(store), length, row_time, duration, code, floats(out.ctypes.data))
    out[SHOCKS] = shocks
