"""Check what was read from a file before compiled code, which trusts it, works on it.

A file whose checksum fits may still have been made by hand, or by a program with an error. Every array has its shape and type, and
every number that the engine uses as an index or as a code lies in its range; anything else is one line.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.errors import InputError
from stickslip.evolution import layout as at
from stickslip.evolution.checkpoint import Checkpoint
from stickslip.evolution.history import History
from stickslip.evolution.inflow import row_time
from stickslip.evolution.layout import Setup
from stickslip.evolution.moving_branches import STORM_OF, branch_rows, folds_move, has_levels_to_set
from stickslip.evolution.setup import prepare
from stickslip.evolution.solution import Solution
from stickslip.evolution.workspace import COUNTS, DEGREE, EXIT, REAL, STATES, WHOLE, WORK_ROWS

ROUNDING = 1e-9
"""Of the length of a row: offsets lie in it, but for rounding."""
LAST_CAUSE = at.HEALING
SAME = (at.IS_BLOCK, at.HAS_INERTIA, at.IS_ALGEBRAIC, at.HAS_STATE, at.STICKS, at.FOLDS_MOVE, at.KNOTS_IN_RATE, at.VARIES)
"""Counts that follow from the problem alone."""
FLAGS = (at.MOVED, at.JUMP, at.STIFF, at.LEAVING, at.IS_LOCKED, at.TO_THE_END, at.SPARSE, at.LUMPED, at.LUMPS)
SIGNS = (at.MODE, at.EDGE)
NOT_NEGATIVE = (at.ROW, at.SOURCE, at.STEPS, at.SLIP_ROW, at.TINY, at.PAUSE_AT, at.PAUSE_FOR, at.STALLED, at.LUMPED_SINCE, at.ROUGH)
FREE = (at.LAST_STEP, at.FOLD_RATE, at.AMPLIFIED, at.GAIN, at.TARGET, at.UNBALANCED, at.ROUNDED, at.ROUGHEST, EXIT)
"""Numbers of the state that may be infinite or no number."""
Fault = tuple[str, Any]
"""Name of what is wrong, and whether it is."""


def number(attributes: Mapping[str, Any], name: str, path: Path, lowest: float = 0.0) -> float:
    """Return an attribute that is a finite number, at least `lowest`. Raises InputError."""
    value = attributes[name]
    if np.ndim(value) or isinstance(value, str | bytes) or not (math.isfinite(value) and value >= lowest):
        raise InputError(f"{path}: not a file that stickslip has written: {name} is {value!r}")
    return float(value)


def whole_number(attributes: Mapping[str, Any], name: str, path: Path, lowest: float = 0.0, highest: float = 2.0**62) -> int:
    """Return an attribute that is a whole number between two others. Raises InputError."""
    value = number(attributes, name, path, lowest)
    if value != int(value) or value > highest:
        raise InputError(f"{path}: not a file that stickslip has written: {name} is {value!r}")
    return int(attributes[name])


def check_place(about: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Return where a checkpoint says that its catalogue stood. Raises InputError for a number out of range, or a name that leads
    elsewhere."""
    name = about["catalogue"]
    if not isinstance(name, str) or name != Path(name).name or set(name) & set("/\\\0") or name in ("", ".", ".."):
        raise InputError(f"{path}: not a file that stickslip has written: its catalogue is named {name!r}, which is no bare name")
    counts = {key: whole_number(about, key, path) for key in ("bytes", "told", "first", "forgotten")}
    return counts | {
        "catalogue": name,
        "digest": str(about["digest"]),
        "last_piece": whole_number(about, "last_piece", path, -(2.0**62)),
        "last_xi": number(about, "last_xi", path),
        "event_rate": number(about, "event_rate", path),
        "energies": whole_number(about, "energies", path, highest=1),
    }


def check_history(history: History, path: Path) -> None:
    """Refuse a history that no run leaves. Raises InputError."""
    _refuse(_shapes_of_history(history), path)
    _refuse(_faults_of_history(history), path)


def _shapes_of_history(history: History) -> Iterator[Fault]:
    store, pieces = history.store, len(history)
    has_state = history.problem.friction.state is not None
    yield "number of pieces of the history", pieces < 1
    for name, columns, kind in (("whole", WHOLE, "i"), ("real", REAL, "f"), ("load", at.TERMS, "f"), ("rate", at.TERMS, "f")):
        yield f"shape or type of history_{name}", not _is(getattr(store, name), (pieces, columns), kind)
    yield "shape or type of history_state", not _is(store.state, (pieces if has_state else 0, at.TERMS), "f")
    yield "shape or type of history_creep", not _is(history.creep, (len(history.creep), 4), "f")


def _is(array: NDArray[Any], shape: tuple[int, ...], kind: str) -> bool:
    return array.shape == shape and array.dtype == {"i": np.dtype(np.int64), "f": np.dtype(np.float64)}[kind]


def _faults_of_history(history: History) -> Iterator[Fault]:
    store, pieces, row = history.store, len(history), row_time(history.problem)
    yield "row_time", not math.isclose(history.row_time, row, rel_tol=1e-9)
    yield "ramp or reached", not (math.isfinite(history.ramp) and math.isfinite(history.duration) and history.duration >= 0.0)
    yield "row of a piece", (store.row < 0).any() or (np.diff(store.row) < 0).any() or store.row[-1] >= at.NEVER
    yield "mode of a piece", _outside(store.mode, -1, 1)
    yield "law piece of a piece", _outside(store.whole[:, at.S_PIECE], 0, len(history.problem.friction.pieces) - 1)
    yield "jump of a piece", _outside(store.whole[:, at.S_JUMP], 0, 1)
    yield "cause of a piece", _outside(store.cause, 0, LAST_CAUSE)
    yield "echo of a piece", (store.echo_of < -1).any() or (store.echo_of >= np.arange(pieces)).any()
    yield "times of a piece", _no_interval(store.theta_from, store.theta_to, math.inf)  # a leap over creep spans many rows
    numbers = (store.real[:, : at.S_AMPLIFIED], store.load, store.rate, store.state, history.creep)
    yield "numbers of a piece, which are not finite,", not all(np.isfinite(table).all() for table in numbers)


def _outside(values: NDArray[Any], low: float, high: float) -> bool:
    return bool(((values < low) | (values > high)).any())


def _no_interval(begin: Any, end: Any, row: float) -> bool:
    """Return True unless offsets lie in a row, and follow each other."""
    return not bool(np.all((begin >= 0.0) & (begin <= end) & (end <= row * (1.0 + ROUNDING))))


def check_checkpoint(solution: Solution, path: Path) -> None:
    """Refuse a checkpoint with which the engine would read or write beyond its tables, or not return. Raises InputError."""
    checkpoint, history = solution.checkpoint, solution.history
    assert checkpoint is not None
    setup, _, count = prepare(solution.problem, solution.rtol, solution.shortest_event)
    _refuse(_shapes_of_checkpoint(checkpoint), path)
    _refuse(_faults_of_places(checkpoint.count, setup, len(history), len(history.creep)), path)
    _refuse(_faults_of_codes(checkpoint.count, count), path)
    _refuse(_faults_of_state(checkpoint, history), path)
    _refuse(_faults_of_branch(checkpoint, setup, solution), path)


def _shapes_of_checkpoint(checkpoint: Checkpoint) -> Iterator[Fault]:
    branches = checkpoint.branch.shape[1] if checkpoint.branch.ndim == 2 else 0
    shapes = {"state": (STATES,), "scratch": (WORK_ROWS, at.TERMS), "branch": (6, max(branches, 1)), "stick_to": (1,)}
    for name, shape in shapes.items():
        yield f"shape or type of engine_{name}", not _is(getattr(checkpoint, name), shape, "f")
    yield "shape or type of engine_count", not _is(checkpoint.count, (COUNTS,), "i")
    crossings = checkpoint.crossings
    yield "engine_crossings", not _is(crossings, (min(crossings.size, STORM_OF),), "f") or not np.isfinite(crossings).all()


def _faults_of_places(count: at.Integers, setup: Setup, pieces: int, leaps: int) -> Iterator[Fault]:
    """What the engine uses as an index."""
    length = int(count[at.LENGTH])
    begins = count[at.ROW] == 0 and (count[at.SOURCE] == 0 or count[at.READY] != 0)
    yield "number of pieces", not 0 <= length <= pieces or (length == 0 and not begins)
    if count[at.SPARSE] == 0:  # else these are not used, and a catalogue counts them down below zero
        for name in ("ROW_FROM", "PREVIOUS_FROM", "PREVIOUS_TO"):
            yield f"engine_count {name}", not 0 <= count[getattr(at, name)] <= length
        yield "engine_count PREVIOUS_FROM", count[at.PREVIOUS_FROM] > count[at.PREVIOUS_TO]
    else:
        yield "engine_count NEW_FROM", not 1 <= count[at.NEW_FROM] <= length
        echoes = setup.par[at.REFLECTION] == -1.0 and count[at.IS_BLOCK] == count[at.HAS_STATE] == count[at.VARIES] == 0
        yield "engine_count SPARSE", not (echoes and count[at.STICKS] == 1)
    yield "engine_count ECHO_OF", not -1 <= count[at.ECHO_OF] < length
    yield "engine_count PIECE", not 0 <= count[at.PIECE] < setup.address.shape[1]
    yield "engine_count SEGMENT", not 0 <= count[at.ROW_SEGMENT] <= count[at.SEGMENT] < setup.loading.shape[1]
    yield "engine_count CREEP_LEAPS", not 0 <= count[at.CREEP_LEAPS] <= leaps
    yield "engine_count DEGREE", not 0 <= count[DEGREE] < at.TERMS


def _faults_of_codes(count: at.Integers, fresh: at.Integers) -> Iterator[Fault]:
    """What the engine takes as a code, a flag or a number of rows."""
    yield "engine_count: what follows from the problem", (count[[*SAME]] != fresh[[*SAME]]).any()
    yield "engine_count: a flag", _outside(count[[*FLAGS]], 0, 1)
    yield "engine_count: a direction", _outside(count[[*SIGNS]], -1, 1)
    yield "engine_count: a number of rows or steps", _outside(count[[*NOT_NEGATIVE]], 0, at.NEVER)
    yield "engine_count STUCK_ROWS", not -1 <= count[at.STUCK_ROWS] <= at.NEVER
    yield "engine_count CREEP_IN or LUMP_ABOVE", _outside(count[[at.CREEP_IN, at.LUMP_ABOVE]], -at.NEVER, at.NEVER)
    yield "engine_count: a cause", _outside(count[[at.CAUSE, at.ARRIVING]], 0, LAST_CAUSE)
    yield "engine_count READY", not 0 <= count[at.READY] <= at.BROUGHT
    yield "engine_count AT_FOLD", not 0 <= count[at.AT_FOLD] <= 3
    yield "engine_count WAITS", count[at.WAITS] != 0
    yield "engine_count BREACH", count[at.BREACH] not in (0, at.OFF_THE_LAW, at.NEGATIVE_FRICTION)


def _faults_of_state(checkpoint: Checkpoint, history: History) -> Iterator[Fault]:
    state, row = checkpoint.state, history.row_time
    finite = np.delete(state, [*FREE])
    yield "engine_state: a number that is not finite", not np.isfinite(finite).all()
    yield "engine_state XI", not -ROUNDING <= state[at.XI] <= 1.0 + ROUNDING
    yield "engine_state: times", _no_interval(state[at.THETA_FROM], state[at.THETA_TO], row)
    yield "engine_state LAST_STEP", not state[at.LAST_STEP] > 0.0
    rows = history.store.row[: checkpoint.length]
    yield "engine_count ROW, before the end of the history,", bool((rows[-1:] > checkpoint.count[at.ROW]).any())


def _faults_of_branch(checkpoint: Checkpoint, setup: Setup, solution: Solution) -> Iterator[Fault]:
    """Branches follow from the problem, and where folds move, from the slip at which they were worked out."""
    problem, branch, stick_to = solution.problem, checkpoint.branch, float(checkpoint.stick_to[0])
    yield "engine_count BRANCH", not 0 <= checkpoint.count[at.BRANCH] < branch.shape[1]
    yield "engine_branch: no number", np.isnan(branch).any() or math.isnan(stick_to)
    if not folds_move(problem):
        yield "engine_branch or engine_stick_to", not np.array_equal(branch, setup.branch) or stick_to != setup.par[at.STICK_TO]
        return
    rows, level = branch_rows(problem, float(checkpoint.state[at.TABLE_SLIP]))
    compared = [*range(6)]
    if has_levels_to_set(problem):  # by compiled code, to rounding
        compared = [at.RATE_FROM, at.RATE_TO, at.EXCESS_FROM, at.EXCESS_TO]
    same = branch.shape == rows.shape and np.array_equal(branch[compared], rows[compared])
    yield "engine_branch", not same
    yield "engine_stick_to", not has_levels_to_set(problem) and stick_to != level


def _refuse(faults: Iterator[Fault], path: Path) -> None:
    for name, is_wrong in faults:
        if is_wrong:
            raise InputError(f"{path}: not a state that a run can have: {name} is out of range; run it again from the start")
