"""Reduce the history of a run to the numbers that a batch keeps, which equal those in the tables of a `Solution`.

The kernels of `engine.history.slip_events` find the slip events. The functions here do in compiled code, for one event or run, what
`engine.history.tables` does for all. Functions on a history take its first piece, and the number of pieces as `length`. A place in
it is a pair of a piece and xi from 0 to 1; `round_trip_time` is the length of a round trip (of a block: of a period), in s.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from stickslip.engine.contact.contact_equation import friction_of
from stickslip.engine.history.history import OFFSET_ROUNDING
from stickslip.engine.history.slip_events import LAST_THIRD, EventTurns, rest_of, rises_over, time_slipping
from stickslip.engine.history.turning_points import Known, Turn, starts_from_rest
from stickslip.engine.series.polynomial import evaluate, integral
from stickslip.engine.state.layout import HistoryPiece
from stickslip.engine.state.workspace import Run, pieces_in
from stickslip.foundation.arrays import Floats1, Integers2
from stickslip.foundation.kernels.kernels import entry, kernel
from stickslip.foundation.kernels.memory.pointers import numbers_of, record_at
from stickslip.foundation.kernels.memory.records import MemoryRecord
from stickslip.problem import Stop


class Reduced(MemoryRecord):
    """Hold the numbers that are kept of each run, in SI units; NaN where a run has none."""

    events: float
    pulses: float
    shocks: float
    slip: float
    peak_rate: float
    peak_time: float
    first_start: float
    first_end: float
    first_duration: float
    first_slip: float
    first_traction_drop: float
    first_static_drop: float
    recurrence: float
    recurrence_cv: float
    end_time: float
    arrested: float
    sticking: float
    irregular: float
    branches: float


reduced_at: Any = record_at(Reduced)
"""Function for compiled code that returns the record at a pointer or in an array."""
REDUCED_COLUMNS = tuple(Reduced.places)
"""Names of these numbers, in the order of their columns in a table of results."""
FIRST_OF_EVENTS, LAST_OF_EVENTS = REDUCED_COLUMNS.index("peak_rate"), REDUCED_COLUMNS.index("recurrence_cv")
"""The columns from the first to the second of these describe slip events, and so do the numbers of events and pulses."""
OF_EVENTS = frozenset({"events", "pulses", *REDUCED_COLUMNS[FIRST_OF_EVENTS : LAST_OF_EVENTS + 1]})
"""Columns that need slip events."""


class FoundEventsInMemory(NamedTuple):
    """Hold the slip events of a run, as pointers: the points of its slip rate, which of them each event has, and their number."""

    turns: Turn
    events: EventTurns
    number: int
    known: Known  # what is known of each piece


# ---- places in a history ----------------------------------------------------------------------------------------------------


@kernel
def offset_at(history: HistoryPiece, piece: int, xi: float) -> float:
    """Return the offset (s) of a place in its round trip, as in `History.placed`."""
    kept = history[piece]
    return kept.phase_to if xi == 1.0 else kept.phase_from + xi * (kept.speed + xi * kept.bend)


@kernel
def time_between(history: HistoryPiece, round_trip_time: float, place: tuple[int, float], later: tuple[int, float]) -> float:
    """Return the time (s) from one place (piece, xi) to a later one."""
    trips = history[later[0]].trip - history[place[0]].trip
    return trips * round_trip_time + (offset_at(history, later[0], later[1]) - offset_at(history, place[0], place[1]))


@kernel
def time_at(history: HistoryPiece, round_trip_time: float, piece: int, xi: float) -> float:
    """Return the time (s) of a place since the start of the run."""
    return history[piece].trip * round_trip_time + offset_at(history, piece, xi)


@kernel
def place_of(history: HistoryPiece, piece: int, local: float) -> float:
    """Return the place xi in [0, 1] of a time `local` s after the start of a piece, as in `History.xi`."""
    speed, bend = history[piece].speed, history[piece].bend
    pace = speed + math.sqrt(max(speed * speed + 4.0 * bend * local, 0.0))
    return min(max(2.0 * local / (pace if pace > 0.0 else 1.0), 0.0), 1.0)


@kernel
def grown(history: HistoryPiece, piece: int, xi: float) -> float:
    """Return the slip (m) since the start of the piece, as in `History.grown`."""
    rate, bend = history[piece].rate, history[piece].bend
    straight = history[piece].speed * integral(rate, xi, 1)
    return straight if bend == 0.0 else straight + 2.0 * bend * integral(rate, xi, 2)


@kernel
def reached(run_end: float, code: int, round_trip_time: float, history: HistoryPiece, length: int) -> float:
    """Return the time (s) that a run has reached: `run_end` if it is finished or locked, otherwise the end of its history."""
    return run_end if code in (Stop.FINISHED, Stop.LOCKED) else time_at(history, round_trip_time, length - 1, 1.0)


@kernel
def slipped(history: HistoryPiece, length: int, round_trip_time: float, end: float) -> float:
    """Return the slip (m) from the start of the run to its end (s)."""
    last = length - 1
    while last > 0 and time_at(history, round_trip_time, last, 0.0) > end:
        last -= 1
    return history[last].slip + grown(history, last, place_of(history, last, end - time_at(history, round_trip_time, last, 0.0)))


@kernel
def slipped_between(history: HistoryPiece, known: Known, place: tuple[int, float], later: tuple[int, float]) -> float:
    """Return the slip (m) from one place (piece, xi) to a later one, as in `History.slipped_within`."""
    whole = 0.0
    for n in range(place[0], later[0]):
        whole += grown(history, n, 1.0) if math.isnan(known[n].grown) else known[n].grown
    return whole + (grown(history, later[0], later[1]) - grown(history, place[0], place[1]))


# ---- friction ---------------------------------------------------------------------------------------------------------------


@kernel
def friction_in(run: Run, piece: int, xi: float) -> float:
    """Return friction minus the reference strength (Pa or N) at a place, in slip or at rest, as in `History.friction`."""
    kept = run.history[piece]
    excess, rate, mode = evaluate(kept.load, xi), evaluate(kept.rate, xi), kept.mode
    if run.counts.has_inertia == 0:
        return excess - run.params.damping * rate
    if mode == 0:
        return excess
    walked = grown(run.history, piece, xi) * (1 if run.params.counts_net == 1.0 else mode)
    friction_of(run, kept.law_piece, kept.law_slip + walked, abs(rate))
    return run.friction.stress if mode > 0 else -run.friction.stress - 2.0 * run.params.reference


@kernel
def friction_before(run: Run, piece: int, xi: float, excess: float) -> float:
    """Return friction minus the reference strength (Pa or N) before the first event, as in `tables.friction_before`.

    The event begins at a place; the contact is under the initial `excess` before the run.
    """
    if xi > 0.0:
        return friction_in(run, piece, xi)
    sliding = friction_just_before(run, piece, excess)
    if run.counts.sticks == 0 or not starts_from_rest(run.history, piece):
        return sliding
    at_rest = load_just_before(run, piece, excess)
    return at_rest if run.history[piece].mode * (at_rest - sliding) > 0.0 else sliding


@kernel
def friction_just_before(run: Run, piece: int, excess: float) -> float:
    """Return friction minus the reference strength (Pa or N) just before a piece starts; `excess` before the first one."""
    if piece == 0:
        return excess
    last, xi, trips = place_just_before(run, piece)
    return friction_in(run, last, xi) if trips == 0 else load_just_before(run, piece, excess)


@kernel
def load_just_before(run: Run, piece: int, excess: float) -> float:
    """Return the load minus the reference strength (Pa or N) just before a piece starts; `excess` before the first one.

    After round trips at rest that were not recorded, the load follows from the piece whose echo holds there, and from the ramp.
    """
    if piece == 0:
        return excess
    last, xi, trips = place_just_before(run, piece)
    load = evaluate(run.history[last].load, xi)
    if trips == 0:
        return load
    load += trips * run.params.ramp
    return load if run.counts.is_block == 1 else load - 2.0 * run.params.impedance * evaluate(run.history[last].rate, xi)


@kernel
def place_just_before(run: Run, piece: int) -> tuple[int, float, int]:
    """Return the piece and xi whose load, or its echo, holds just before a piece starts, and the round trips at rest since then."""
    history, last = run.history, piece - 1
    trip_time = run.params.round_trip_time
    if time_between(history, trip_time, (last, 1.0), (piece, 0.0)) <= OFFSET_ROUNDING * trip_time:
        return last, 1.0, 0  # the contact does not rest, unrecorded, before this piece
    trip, phase = history[piece].trip, history[piece].phase_from
    if phase == 0.0:
        trip, phase = trip - 1, trip_time
    while last >= 0 and not (history[last].phase_from < phase <= history[last].phase_to):
        last -= 1
    if last < 0:
        return piece - 1, 1.0, 0
    return last, place_of(history, last, phase - history[last].phase_from), trip - history[last].trip


@kernel
def friction_after(run: Run, piece: int, xi: float) -> float:
    """Return friction minus the reference strength (Pa or N) after an event that ends at a place, as in `tables.friction_after`.

    If the slip rate falls from there to zero, this is the friction at rest.
    """
    history, length = run.history, run.counts.length
    mode, rate = history[piece].mode, abs(evaluate(history[piece].rate, xi))
    for n in range(piece + 1, length):
        if history[n].mode != mode:
            return friction_in(run, n, 0.0)
        if rises_over(history[n].rate, rate):
            break
    if xi == 1.0 and piece + 1 < length:
        return friction_in(run, piece + 1, 0.0)
    return friction_in(run, piece, xi)


# ---- events -----------------------------------------------------------------------------------------------------------------


@kernel
def fold_events(run: Run, found: FoundEventsInMemory, out: Reduced) -> None:
    """Write the numbers that describe all slip events, and their recurrence, into `out`; columns without a value become NaN."""
    (turns, events, count, _), history, round_trip_time = found, run.history, run.params.round_trip_time
    out.events, out.pulses = count, 0.0
    for column in range(FIRST_OF_EVENTS, LAST_OF_EVENTS + 1):
        numbers_of(out)[column] = math.nan
    if count == 0:
        return
    fastest = events[0].top
    for n in range(count):
        out.pulses += events[n].pulses
        if turns[events[n].top].rate > turns[fastest].rate:
            fastest = events[n].top
    out.peak_rate = turns[fastest].rate
    out.peak_time = time_at(history, round_trip_time, turns[fastest].piece, turns[fastest].xi)
    if count > 1:
        fold_recurrence(history, round_trip_time, found, out)


@kernel
def fold_recurrence(history: HistoryPiece, round_trip_time: float, found: FoundEventsInMemory, out: Reduced) -> None:
    """Write the mean (s) and the coefficient of variation of the times between starts of events into `out`.

    The latter is the sample standard deviation over the mean; it stays NaN for two events, which have one recurrence time.
    """
    turns, events, count, _ = found
    mean = spread = 0.0
    for n in range(1, count):
        a, b = turns[events[n - 1].begin], turns[events[n].begin]
        since = time_between(history, round_trip_time, (a.piece, a.xi), (b.piece, b.xi))
        change = since - mean
        mean += change / n
        spread += change * (since - mean)
    out.recurrence = mean
    if count > 2:
        out.recurrence_cv = math.sqrt(spread / (count - 2)) / mean


@kernel
def fold_first(run: Run, found: FoundEventsInMemory, excess: float, out: Reduced) -> None:
    """Write the numbers that describe the first event into `out`, as in `tables.event_columns`, except its static drop.

    excess is the initial load minus the static strength (Pa or N).
    """
    history, begin, end = run.history, found.turns[found.events[0].begin], found.turns[found.events[0].past - 1]
    piece, xi, last, last_xi = begin.piece, begin.xi, end.piece, end.xi
    round_trip_time = run.params.round_trip_time
    out.first_start = time_at(history, round_trip_time, piece, xi)
    if end.kind == -1:
        out.first_end = time_at(history, round_trip_time, last, last_xi)
        out.first_duration = time_between(history, round_trip_time, (piece, xi), (last, last_xi))
    out.first_slip = slipped_between(history, found.known, (piece, xi), (last, last_xi))
    out.first_traction_drop = friction_before(run, piece, xi, excess) - friction_after(run, last, last_xi)


@kernel
def fold_whole(history: HistoryPiece, length: int, round_trip_time: float, end: float, out: Reduced) -> None:
    """Write the numbers that describe the whole run, which has reached the time `end` (s), into `out`."""
    shocks = 0
    for n in range(length):
        shocks += 1 if history[n].cause > 0 else 0
    out.shocks, out.end_time = shocks, end
    recorded = time_at(history, round_trip_time, length - 1, 1.0)
    rests_on = end - recorded > OFFSET_ROUNDING * recorded  # after the last piece, where nothing is recorded
    out.arrested = 1.0 if history[length - 1].mode == 0 or rests_on else 0.0
    out.slip = slipped(history, length, round_trip_time, end)
    begin = LAST_THIRD * end
    out.sticking = rest_of(time_slipping(history, length, round_trip_time, begin, end), end - begin)


@entry
def fold_end(table: Integers2, round_trip_time: float, duration: float, code: int, numbers: Floats1) -> None:
    """Do what `fold_whole` does for a history of which only the last pieces are known, but keep what all pieces determine.

    The run was to last `duration` s and ended with the given code.
    """
    out, history = reduced_at(numbers), pieces_in(table)
    shocks, sticking = out.shocks, out.sticking
    fold_whole(history, len(table), round_trip_time, reached(duration, code, round_trip_time, history, len(table)), out)
    out.shocks, out.sticking = shocks, sticking
