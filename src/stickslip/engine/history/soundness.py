"""Check a history and a checkpoint that were read from a file before they reach compiled code, which does not check them.

The checks cover the shape and type of every array, and the range of every number that the engine uses as an index or as a code. A
fault is reported in one line.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.engine.contact_step.certificate import RATIOS
from stickslip.engine.history.history import History
from stickslip.engine.history.status import Checkpoint
from stickslip.engine.input.asked import INPUTS
from stickslip.engine.input.branch_table import table_of_branches
from stickslip.engine.input.prepare import prepare
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import BranchRow, Cause, Counts, HistoryPiece, Incoming, Setup, State
from stickslip.engine.state.workspace import FIRST_ROW, NO_WAVES, WORK_ROWS, counts_in
from stickslip.engine.waves.merged_series import MEAN, MOST_TOGETHER
from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.memory.records import MemoryRecord
from stickslip.problem import Problem, Stop

ROUND_TRIP_ROUNDING = 1e-9
"""Rounding may carry an offset beyond the end of a round trip by this share of it; also the tolerance of xi around 0 and 1."""
LAST_CAUSE = Cause.STOP
"""Largest code for the cause of a shock."""
FINITE = ("phase_from", "phase_to", "speed", "bend", "slip", "law_slip", "load", "rate")
"""Fields of a piece of the history that must be finite."""
FIXED_COUNTS = (
    *("is_block", "has_inertia", "is_algebraic", "states", "given", "reverses", "sticks", "knots_in_rate", "varies"),
    *("driven", "one_way", "cells", "first_side", "joined", "folds_follow_slip"),
)
"""Counts that follow from the problem alone, so that those in a file must be the same."""
FLAGS = ("moved", "jump", "stiff", "folds_move", "branch_ended", "is_locked", "to_the_end", "sparse", "lumped", "lumps", "merging")
"""Counts that are 0 or 1."""
SIGNS = ("mode", "leaving_rest", "side")
"""Counts that are a direction: -1, 0 or 1."""
NOT_NEGATIVE = (
    "trip",
    "source",
    "steps",
    "slip_trip",
    "unresolved_slips",
    "pause_at",
    "pause_for",
    "stalled",
    "lumped_since",
    "rough",
    "merge_above",
    "merge_at",
)
"""Counts of round trips or steps, from 0 to NEVER."""
FREE = ("last_step", "fold_rate", "amplified", "gain", "target", "unbalanced", "rounded", "roughest", "missed", "exit")
"""Numbers of the state that may be infinite or NaN."""
Fault = tuple[str, Any]
"""The name of a check, and whether it fails."""


def check_history(history: History, path: Path) -> None:
    """Refuse a history that no run can leave. Raises InputError."""
    _refuse(_shapes_of_history(history), path)
    _refuse(_faults_of_history(history), path)


def history_table(columns: dict[str, NDArray[Any]], path: Path) -> NDArray[np.int64]:
    """Return the table of a history from the fields of its pieces. Raises InputError if one of them has another shape or type."""
    _refuse(_shapes_of_columns(columns), path)
    table = HistoryPiece.table(len(columns["trip"]))
    for name, place in HistoryPiece.places.items():
        table[:, place.first : place.first + place.size] = columns[name].reshape(len(table), -1).view(np.int64)
    return table


def _shapes_of_columns(columns: dict[str, NDArray[Any]]) -> Iterator[Fault]:
    pieces = columns["trip"].size
    for name, place in HistoryPiece.places.items():
        shape = (pieces, place.size) if place.inside else (pieces,)
        yield f"shape or type of history_{name}", not _is(columns[name], shape, "i" if place.kind is int else "f")


def _shapes_of_history(history: History) -> Iterator[Fault]:
    store, pieces = history.store, len(history)
    states = history.problem.kept_series
    yield "number of pieces of the history", pieces < 1
    yield "shape or type of history_state", not _is(store.state, (pieces if states else 0, states, at.TERMS), "f")
    yield "shape or type of history_creep", not _is(history.creep, (len(history.creep), 4), "f")
    if (given := history.begun_with) is not None:
        first, cells = int(np.searchsorted(store.trip, 1)), INPUTS[history.problem.body.structure].cells(history.problem).cells
        yield "shape or type of history_begun_with", not first or not _is(given, (first, max(cells, 1), at.TERMS), "f")
        yield "number of history_begun_with", not np.isfinite(given).all()


def _is(array: NDArray[Any], shape: tuple[int, ...], kind: str) -> bool:
    return array.shape == shape and array.dtype == {"i": np.dtype(np.int64), "f": np.dtype(np.float64)}[kind]


def _faults_of_history(history: History) -> Iterator[Fault]:
    store, pieces, round_trip = history.store, len(history), history.problem.round_trip_time
    yield "round_trip_time", not math.isclose(history.round_trip_time, round_trip, rel_tol=1e-9)
    yield "ramp or reached", not (math.isfinite(history.ramp) and math.isfinite(history.duration) and history.duration >= 0.0)
    yield "row of a piece", (store.trip < 0).any() or (np.diff(store.trip) < 0).any() or store.trip[-1] >= at.NEVER
    yield "mode of a piece", _outside(store.mode, -1, 1)
    yield "law piece of a piece", _outside(store.law_piece, 0, len(history.problem.friction.pieces) - 1)
    yield "jump of a piece", _outside(store.jump, 0, 1)
    yield "cause of a piece", _outside(store.cause, 0, LAST_CAUSE)
    yield "echo of a piece", (store.echo_of < -1).any() or (store.echo_of >= np.arange(pieces)).any()
    # a leap over creep may span many round trips
    yield "times of a piece", _no_interval(store.phase_from, store.phase_to, math.inf)
    numbers = (*(getattr(store, name) for name in FINITE), store.state, history.creep)
    yield "numbers of a piece, which are not finite,", not all(np.isfinite(table).all() for table in numbers)


def _outside(values: NDArray[Any], low: float, high: float) -> bool:
    return bool(((values < low) | (values > high)).any())


def _no_interval(begin: Any, end: Any, round_trip: float) -> bool:
    """Return True unless each interval of offsets (s) lies in a round trip (s) and does not end before it begins."""
    return not bool(np.all((begin >= 0.0) & (begin <= end) & (end <= round_trip * (1.0 + ROUND_TRIP_ROUNDING))))


def check_checkpoint(checkpoint: Checkpoint, history: History, path: Path, *, rtol: float, shortest_event: float | None) -> None:
    """Refuse a checkpoint that would have the engine read or write outside its tables, or never return. Raises InputError.

    `rtol` and `shortest_event` (s) are those of the run, which its numbers follow from.
    """
    setup, memory = prepare(history.problem, rtol, shortest_event)
    count = counts_in(memory)
    _refuse(_shapes_of_checkpoint(checkpoint), path)
    _refuse(_faults_of_places(Counts(checkpoint.count), setup, len(history), len(history.creep)), path)
    _refuse(_faults_of_codes(Counts(checkpoint.count), count), path)
    _refuse(_faults_of_state(checkpoint, history), path)
    _refuse(_faults_of_branch(checkpoint, setup, history.problem), path)


def _shapes_of_checkpoint(checkpoint: Checkpoint) -> Iterator[Fault]:
    branches = len(checkpoint.branch) if checkpoint.branch.ndim == 2 else 0
    shapes = {
        "state": (State.total,),
        "scratch": (WORK_ROWS, at.TERMS),
        "branch": (max(branches, 1), BranchRow.total),
        "stick_to": (1,),
    }
    for name, shape in shapes.items():
        yield f"shape or type of engine_{name}", not _is(getattr(checkpoint, name), shape, "f")
    count = Counts(checkpoint.count)
    rows = (max(len(checkpoint.waves), FIRST_ROW + 1), int(count.slots), at.TERMS) if count.slots > 0 else NO_WAVES.shape
    yield "shape or type of engine_waves", not _is(checkpoint.waves, rows, "f")
    yield "shape or type of engine_count", not _is(checkpoint.count, (Counts.total,), "i")


def _places(record: MemoryRecord, *names: str) -> Any:
    places = [record.places[name] for name in names]
    return record.numbers[[n for place in places for n in range(place.first, place.first + place.size)]]


def _faults_of_places(count: Counts, setup: Setup, pieces: int, leaps: int) -> Iterator[Fault]:
    """Yield a check of each number that the engine uses as an index."""
    length = int(count.length)
    begins = count.trip == 0 and (count.source == 0 or count.ready != Incoming.NONE)
    yield "number of pieces", not 0 <= length <= pieces or (length == 0 and not begins)
    if count.sparse == 0:  # otherwise they are not used, and a catalogue that discards history makes them negative
        for name in ("trip_from", "previous_from", "previous_to"):
            yield f"engine_count {name}", not 0 <= getattr(count, name) <= length
        yield "engine_count previous_from", count.previous_from > count.previous_to
    else:
        yield "engine_count new_from", not 1 <= count.new_from <= length
        echoes = setup.params.reflection == RIGID and count.is_block == count.states == count.varies == 0
        yield "engine_count sparse", not (echoes and count.sticks == 1)
    yield "engine_count echo_of", not -1 <= count.echo_of < length
    yield "engine_count merged", not 0 <= count.merged <= count.previous_to - count.previous_from
    yield "engine_count smooth_to", not count.smooth_to <= count.previous_to
    yield "engine_count merge_guess", not 0 <= count.merge_guess <= 4 * MOST_TOGETHER
    yield "engine_count merged_as", not 0 <= count.merged_as <= MEAN
    yield "engine_count piece", not 0 <= count.piece < len(setup.law)
    yield "engine_count segment", not 0 <= count.trip_segment <= count.segment < len(setup.loading)
    yield "engine_count wave_shift", not 0 <= count.wave_shift <= at.NEVER
    yield "engine_count creep_leaps", not 0 <= count.creep_leaps <= leaps
    yield "engine_count disc", not at.NO_DISC <= count.disc < len(RATIOS)
    yield "engine_count degree", not 0 <= count.degree < at.TERMS


def _faults_of_codes(count: Counts, fresh: Counts) -> Iterator[Fault]:
    """Yield a check of each number that the engine uses as a code, a flag or a number of round trips."""
    yield "engine_count: what follows from the problem", (_places(count, *FIXED_COUNTS) != _places(fresh, *FIXED_COUNTS)).any()
    yield "engine_count: a flag", _outside(_places(count, *FLAGS), 0, 1)
    yield "engine_count: a direction", _outside(_places(count, *SIGNS), -1, 1)
    yield "engine_count: a number of round trips or steps", _outside(_places(count, *NOT_NEGATIVE), 0, at.NEVER)
    yield "engine_count trips_at_rest", not -1 <= count.trips_at_rest <= at.NEVER
    yield "engine_count creep_in or LUMP_ABOVE", _outside(_places(count, "creep_in", "lump_above"), -at.NEVER, at.NEVER)
    yield "engine_count: a cause", _outside(_places(count, "cause", "arriving"), 0, LAST_CAUSE)
    yield "engine_count ready", not 0 <= count.ready <= Incoming.BROUGHT
    yield "engine_count at_fold", not 0 <= count.at_fold <= 3
    yield "engine_count waits", count.waits != 0
    yield "engine_count breach", count.breach not in (0, Stop.OFF_THE_LAW, Stop.NEGATIVE_FRICTION, Stop.FAILED)


def _faults_of_state(checkpoint: Checkpoint, history: History) -> Iterator[Fault]:
    state, round_trip = State(checkpoint.state), history.round_trip_time
    finite = _places(state, *(name for name in State.places if name not in FREE))
    yield "engine_state: a number that is not finite", not np.isfinite(finite).all()
    yield "engine_waves: a number that is not finite", not np.isfinite(checkpoint.waves).all()
    yield "engine_state xi", not -ROUND_TRIP_ROUNDING <= state.xi <= 1.0 + ROUND_TRIP_ROUNDING
    yield "engine_state: times", _no_interval(state.phase_from, state.phase_to, round_trip)
    yield "engine_state last_step", not state.last_step > 0.0
    trips = history.store.trip[: checkpoint.length]
    yield "engine_count trip, before the end of the history,", bool((trips[-1:] > Counts(checkpoint.count).trip).any())


def _faults_of_branch(checkpoint: Checkpoint, setup: Setup, problem: Problem) -> Iterator[Fault]:
    """Yield checks of the branches, which follow from the problem and, if folds move, from slip and normal load."""
    branch, stick_to = checkpoint.branch, float(checkpoint.stick_to[0])
    yield "engine_count branch", not 0 <= Counts(checkpoint.count).branch < len(branch)
    yield "engine_branch: no number", np.isnan(branch).any() or math.isnan(stick_to)
    if not (problem.folds_move or problem.normal_varies):
        yield "engine_branch or engine_stick_to", not np.array_equal(branch, setup.branches) or stick_to != setup.params.stick_to
        return
    state = State(checkpoint.state)
    known, level = table_of_branches(problem, float(state.table_slip), float(state.table_pressing))
    yield "engine_branch or engine_stick_to", not np.array_equal(branch, known) or stick_to != level


def _refuse(faults: Iterator[Fault], path: Path) -> None:
    for name, is_wrong in faults:
        if is_wrong:
            raise InputError(f"{path}: not a state that a run can have: {name} is out of range; run it again from the start")
