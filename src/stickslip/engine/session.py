"""A run in progress, called a session: the arrays of the compiled engine, and the work on them between its calls.

A piece of history is an interval with load and slip rate as polynomials. A block's round trip is a period of its oscillation.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass, field
from typing import Generic, Self, TypeVar

import numpy as np

from stickslip.engine.creep.schedule import CreepLeaps
from stickslip.engine.history.history import NO_LEAPS, History
from stickslip.engine.history.phase_index import standing_behind
from stickslip.engine.history.status import Checkpoint, engine_key, merging_note, rounding_note, strips_note
from stickslip.engine.input.branch_table import renewed
from stickslip.engine.input.limits import lumping_note, split_time
from stickslip.engine.input.prepare import prepare
from stickslip.engine.loop import run_until
from stickslip.engine.on_demand import lend_part, lend_parts_at_hand
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import EchoNode, Floats, Integers, LoadingSegment, Setup, Store
from stickslip.engine.state.workspace import (
    FIRST_ROW,
    NO_WAVES,
    are_rows_short,
    count_from,
    counts_in,
    lend,
    lend_history,
    scratch_in,
    state_in,
    with_more_rows,
)
from stickslip.engine.waves.echo_queue import NO_PIECE, rebuild_queue, write_ahead
from stickslip.foundation.kernels.kernels import ready
from stickslip.problem import BoundedOptions, Problem, Stop, creep_tolerance

FIRST_CAPACITY = 256
"""Initial room of a run in pieces of history, 0.1 MB; the room grows fourfold when it is full."""
FIRST_ROWS = 64
"""Initial number of rows of waves of a body of layers; it grows fourfold when they are not enough for two round trips."""
SPARE = 16
"""Room beyond the largest number of pieces allowed: the engine calls a history full when it has room for fewer than 8 more."""
FREE = 1024
"""Number of pieces, 0.5 MB, for which nobody asks whether there is memory: most runs need no more, and take a tenth of a
millisecond."""
WORTH = 1.25
"""A history must grow at least by this factor where memory is short: less is not worth a copy of all."""


Options = TypeVar("Options", bound=BoundedOptions)


@dataclass(eq=False)
class Session(Generic[Options]):
    """The options, the setup, the state and the history of a run between two calls of the engine; `ExactRun` is the run."""

    problem: Problem
    options: Options
    setup: Setup
    memory: Integers
    """State, scratch space and addresses of the tables, in one array: see `workspace.Run`."""
    store: Store
    echoes: Integers
    """Table of `EchoNode`, with a row for each piece of history."""
    leaps: CreepLeaps | None = None
    waves: Floats = field(default_factory=NO_WAVES.copy)
    """Rows of waves of a body of layers: see `engine.waves.ladder`."""
    before_end: Checkpoint | None = None
    """Checkpoint of the moment before the end of the run cut a piece or a leap; None if it has not yet done so."""
    forgotten: int = 0
    """Number of pieces of history that have been discarded."""
    begun_with: Floats | None = None
    """As in `History`."""
    end_is_ahead: bool = False
    """True if the next call must let the end of the run cut pieces and leaps."""
    is_short_of_memory: bool = False
    """True if the history is full because memory is short."""

    def __post_init__(self) -> None:
        self.params, self.state, self.count = self.setup.params, state_in(self.memory), counts_in(self.memory)
        self.scratch = scratch_in(self.memory)
        self._memory = ready(self.memory)
        self.last = split_time(self.options.duration, self.problem.round_trip_time)
        if self.leaps is not None:
            self.leaps.begin(self.count)
        if are_rows_short(self.count, self.waves):
            self.waves = np.zeros((FIRST_ROW + FIRST_ROWS, int(self.count.slots), at.TERMS))
        lend_history(self.memory, self.store, self.echoes, self.waves)
        lend_parts_at_hand(self.memory)

    @classmethod
    def begin(cls, problem: Problem, options: Options) -> Self:
        """Return a run at t = 0."""
        setup, memory = prepare(problem, options.rtol, options.shortest_event)
        capacity = min(FIRST_CAPACITY, options.most_pieces + SPARE)
        store = at.new_store(capacity, problem.kept_series)
        tolerance = creep_tolerance(problem, options.creep_rtol, options.rtol)
        leaps = CreepLeaps(problem, tolerance, patient=options.creep_rtol is None) if tolerance > 0.0 else None
        return cls(problem, options, setup, memory, store, EchoNode.table(capacity), leaps)

    @classmethod
    def at_checkpoint(cls, history: History, checkpoint: Checkpoint, options: Options) -> Self:
        """Return a run that continues from a checkpoint, on a copy of the history."""
        run = cls.begin(history.problem, options)
        if run.leaps is not None:
            run.leaps.take_up(history.creep)
        capacity = max(checkpoint.length, min(max(FIRST_CAPACITY, 3 * checkpoint.length // 2), options.most_pieces + SPARE))
        run.store, run.echoes = at.resized_store(history.store, checkpoint.length, capacity), EchoNode.table(capacity)
        run.begun_with = history.begun_with
        run.restore(checkpoint)
        return run

    def begin_with_rows(self, rows: Floats) -> None:
        """Begin a run of a body of layers with given rows of waves: see `History.begun_with`."""
        self.begun_with, place = rows, rows.shape[1:]
        self.waves = np.concatenate([np.zeros((FIRST_ROW, *place)), rows, np.zeros((FIRST_ROWS, *place))])
        self._lend()

    def _lend(self) -> None:
        lend(self.memory, self.setup, self.store, self.echoes, self.waves)

    @property
    def length(self) -> int:
        """The number of pieces that the history has."""
        return int(self.count.length)

    @property
    def time(self) -> float:
        """The simulated time, s."""
        xi, speed, bend = self.state.xi, self.state.speed, self.state.bend
        return float(self.count.trip * self.problem.round_trip_time + self.state.phase_from + xi * (speed + xi * bend))

    @property
    def lumping_note(self) -> str:
        """One line on automatic lumping, or an empty string if it has not begun."""
        return lumping_note(self.count, self.params, self.options.shortest_event)

    @property
    def rounding_note(self) -> str:
        """One line on steps with a law hidden by rounding, and on merged waves and strips; an empty string if there are none."""
        where = " in the layers" if self.count.slots > 0 else ""
        merged = merging_note(float(self.state.merged_in_all + self.state.merged_now), self.problem.load_unit, where)
        strips = strips_note(float(self.state.shifted), self.problem.unit_of("slip"))
        rounding = rounding_note(int(self.count.rough), float(self.state.roughest))
        return "; ".join(note for note in (rounding, merged, strips) if note)

    @property
    def creep(self) -> Floats:
        """The leaps over creep so far, as in `History.creep`."""
        return NO_LEAPS if self.leaps is None else self.leaps.table(self.count)

    def history(self) -> History:
        """Return the history so far, without the leaps over creep."""
        kept, round_trip = at.trimmed(self.store, self.length), self.problem.round_trip_time
        reached = float(kept.trip[-1] * round_trip + kept.phase_to[-1]) if len(kept.pieces) else 0.0
        ramp, given = float(self.setup.params.ramp), self.begun_with
        return History(kept, self.problem, round_trip, ramp, reached, forgotten=self.forgotten, begun_with=given)

    def advance(self, budget: int) -> int:
        """Call the engine once or, if it has paused for that, leap over creep: see `Solver.advance`."""
        if self.end_is_ahead:
            self.cut_at_end()
        if self.leaps is not None and self.leaps.are_due(self.count, self.last[0]):
            self.leaps.at_row_end(self)
            return Stop.NONE
        code = self.step(budget)
        self.end_is_ahead = code == Stop.END_AHEAD
        return Stop.NONE if code == Stop.PAUSED else code

    def step(self, budget: int) -> int:
        """Call the engine once, and return the code of `loop.run_until`.

        The branches of a law of slip and slip rate are computed again when the engine asks for them.
        """
        code = run_until(self._memory, *self.last, budget)
        if code == Stop.NEED_PART:
            lend_part(self.memory)
            return Stop.NONE
        if code != Stop.NEED_BRANCHES:
            return code
        self.setup = renewed(self.problem, self.setup, self.params, self.state, self.count)
        self._lend()
        return Stop.NONE

    def grow(self) -> bool:
        """Make room for more pieces. Returns False if there are as many as the options allow, or if memory is short."""
        max_pieces = self.options.most_pieces
        if are_rows_short(self.count, self.waves):
            return self._more_rows()
        if self.length >= max_pieces:
            return False
        room = len(self.store.pieces)
        wanted = min(4 * room, max_pieces + SPARE)
        fits = self._fitting(wanted) if wanted > FREE else wanted
        if fits >= min(wanted, WORTH * room):
            with suppress(MemoryError):
                self.reserve(min(wanted, fits))
                return True
        self.is_short_of_memory = True
        return False

    def _fitting(self, pieces: int) -> int:
        """Return how many of so many pieces fit into the memory that the history may take."""
        from stickslip.foundation.memory import granted  # of long histories

        size, waves = self.size_of_piece, self.waves.nbytes
        return min(pieces, math.floor((granted(pieces * size + waves, self.taken) - waves) / size + 0.5))

    @property
    def size_of_piece(self) -> float:
        """What a piece of history takes in memory, bytes."""
        return (self.store.pieces.nbytes + self.store.state.nbytes + self.echoes.nbytes) / len(self.store.pieces)

    @property
    def taken(self) -> float:
        """What history and waves take in memory, bytes; the system gives room for pieces only when they are written."""
        return self.length * self.size_of_piece + self.waves.nbytes

    def _more_rows(self) -> bool:
        """Make room for more rows of waves. Returns False if memory is short."""
        from stickslip.foundation.memory import granted  # of long histories

        wanted = self.taken + 3 * self.waves.nbytes
        if granted(wanted, self.taken) < wanted:
            self.is_short_of_memory = True
            return False
        with suppress(MemoryError):
            self.waves = with_more_rows(self.waves, self.count, 4 * (len(self.waves) - FIRST_ROW))
            self._lend()
            return True
        self.is_short_of_memory = True
        return False

    def reserve(self, pieces: int) -> None:
        """Make sure that there is room for at least the given number of pieces."""
        if pieces > len(self.store.pieces):
            store, echoes = at.resized_store(self.store, self.length, pieces), at.resized(self.echoes, self.length, pieces)
            self.store, self.echoes = store, echoes
            self._lend()

    def forget_before(self, piece: int) -> int:
        """Discard history before a piece, except waves that are still in the body. Returns the number of pieces discarded.

        Pieces from the first one on that the engine itself needs are kept, too.
        """
        piece = min(piece, int(self.count.previous_from), int(self.count.new_from if self.count.sparse else piece))
        if piece == 0:
            return 0
        standing, _, _ = standing_behind(at.trimmed(self.store, piece), self.problem.round_trip_time)
        kept = np.concatenate([np.unique(standing), np.arange(piece, self.length)])
        dropped = self.length - len(kept)
        count_from(self.count, at.keep_only(self.store, self.length, kept), dropped)
        self._rebuild_queue()
        self.forgotten += dropped
        return dropped

    def _rebuild_queue(self) -> None:
        """Build the trees of echoes again from the history."""
        self._lend()
        if self.count.sparse == 0:
            return
        first = int(self.count.new_from)
        pieces, low, _ = standing_behind(at.trimmed(self.store, first), self.problem.round_trip_time)
        past, ahead = low < self.state.new_since, low >= self.state.taken_to
        rebuild_queue(self.memory, pieces[past | ahead].astype(np.int64), int(past.sum()))

    def standing(self) -> Integers:
        """Return the pieces whose echoes make up the coming round trip, in order of phase."""
        if self.count.sparse == 0:
            return np.arange(int(self.count.previous_from), int(self.count.previous_to))
        found = np.empty(self.length, np.int64)
        return found[: write_ahead(self.memory, found)].copy()

    def stand(self, pieces: Integers) -> None:
        """Let these pieces, in order of phase, be those whose echoes make up the coming round trip, and meet only what breaks."""
        count = self.count
        count.sparse, count.behind, count.ahead, count.new_from = 1, NO_PIECE, NO_PIECE, count.length
        self.state.new_since = self.state.taken_to = 0.0
        rebuild_queue(self.memory, pieces, 0)

    def cut_at_end(self) -> None:
        """Store the state where a longer run would continue, and let the end of this run cut pieces and leaps."""
        self.before_end, self.end_is_ahead = self.snapshot(), False
        self.count.to_the_end = 1

    def snapshot(self) -> Checkpoint:
        """Return a checkpoint of the present state."""
        stick_to = np.array([self.params.stick_to])
        state, count, scratch = self.state.numbers.copy(), self.count.numbers.copy(), self.scratch.copy()
        return Checkpoint(state, count, scratch, self.setup.branches.copy(), stick_to, engine_key(), self.waves.copy())

    def checkpoint(self) -> Checkpoint:
        """Return the checkpoint where this run, or a longer one, would continue."""
        return self.before_end or self.snapshot()

    def restore(self, checkpoint: Checkpoint) -> None:
        """Go back to a checkpoint, on the same history or a copy of it."""
        self.state.numbers[:], self.count.numbers[:] = checkpoint.state, checkpoint.count
        self.scratch[:] = checkpoint.scratch
        self.waves = checkpoint.waves.copy()
        self.setup = self.setup._replace(branches=checkpoint.branch.copy())
        self.params.stick_to = checkpoint.stick_to[0]
        if self.count.varies == 1:
            self.params.reflection = LoadingSegment.of(self.setup.loading).reflection[self.count.segment]
        self.end_is_ahead = False
        if self.count.to_the_end == 0:
            self.before_end = None
        self._rebuild_queue()
