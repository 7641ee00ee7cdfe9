"""Solve a chain: compiled steps for a tenth of a second at a time, with what is kept of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.chains.chain import Chain
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.compiled.accounts import energies
from stickslip.extensions.chains.compiled.advance import advance, begin
from stickslip.extensions.chains.compiled.memory import ChainNumbers, KeptRows, Limits
from stickslip.extensions.chains.numbers import numbers_of, room_of
from stickslip.extensions.chains.run import ChainMotion, ChainRun
from stickslip.extensions.chains.state import ChainState
from stickslip.foundation.errors import InputError

Floats = NDArray[np.float64]
BUDGET = 100_000
"""Steps of blocks of one call of compiled code: a tenth of a second."""
ROOM_FOR_EVENTS = 8192
ROOM_FOR_CHANGES = 65_536
MOST_SNAPSHOTS = 256
"""Of states during a run at most so many are kept, so that motion is calculated again from them."""


class RowSink(Protocol):
    """Takes rows of events and of changes as a run goes, so that the run need not keep them."""

    def take(self, events: Floats, changes: Floats, state: ChainState) -> None:
        """Take rows, and the state after them; all are views, to be copied."""


class ChainSolver:
    """A chain that is being solved: `go_on` leads it further, and `rows` of it may be taken after each call."""

    def __init__(self, chain: Chain, start: ChainState | None = None, keeps_changes: bool = False) -> None:
        self.chain, self._owned = chain, numbers_of(chain)
        self.numbers = self._owned.chain
        self.room = room_of(chain.count)
        self._events = np.empty((ROOM_FOR_EVENTS, at.EVENT_COLUMNS))
        rows = ROOM_FOR_CHANGES + 2 * chain.count if keeps_changes else 0
        self._changes = np.empty((rows, at.CHANGE_COLUMNS))
        self._nothing = np.empty(0), np.empty((0, 0)), np.empty((0, 0))
        self._first: tuple[Floats, Floats] | None = None
        if start is None:
            self.state = ChainState.empty(chain.count)
            self.state.blocks[at.SLIP] = chain.values("initial_slip")
            net = np.array([law.counts == "net" for law in chain.laws[0]])[chain.laws[1]]
            slips = self.state.blocks[at.SLIP]
            self.state.blocks[at.COUNTED] = np.where(net, slips, np.abs(slips))
            begin(self.numbers, self.state.memory, self.room, self._kept())
            self._first = self._rows()
        else:
            self.state = start.copy()

    def _kept(self) -> KeptRows:
        return KeptRows(self._changes, self._events, *self._nothing)

    def _rows(self) -> tuple[Floats, Floats]:
        counts = self.room.counts
        return self._events[: counts[at.EVENT_ROWS]].copy(), self._changes[: counts[at.CHANGE_ROWS]].copy()

    def go_on(self, until: float, budget: int = BUDGET) -> tuple[bool, Floats, Floats]:
        """Go on towards a time (s); return whether it is reached, and rows of events and of changes on the way."""
        answer = advance(self.numbers, self.state.memory, self.room, self._kept(), Limits(until, 0, budget))
        check_answer(answer, self.state)
        events, changes = self._rows()
        if self._first is not None:
            events, changes = np.concatenate((self._first[0], events)), np.concatenate((self._first[1], changes))
            self._first = None
        return answer == at.DONE, events, changes

    def at(self, time: float) -> ChainState:
        """Return the state cut at a time (s) not before that of `state`, to look at; a run does not go on from it."""
        cut = self.state.copy()
        answer = at.GOES_ON
        events = np.empty((ROOM_FOR_EVENTS, at.EVENT_COLUMNS))
        while answer == at.GOES_ON:
            kept = KeptRows(np.empty((0, at.CHANGE_COLUMNS)), events, *self._nothing)
            answer = advance(self.numbers, cut.memory, self.room, kept, Limits(time, 1, BUDGET))
            check_answer(answer, cut)
        return cut

    def energy_of_springs(self, state: ChainState) -> float:
        """Return the energy in all springs (J)."""
        return float(energies_of(self.numbers, state))


def energies_of(numbers: ChainNumbers, state: ChainState) -> float:
    """Return the energy in all springs (J)."""
    return float(energies(numbers, state.memory))


def check_answer(answer: int, state: ChainState) -> None:
    """Raise InputError if the solver could not go on."""
    if answer == at.HANGS:
        raise InputError(f"simulate: the chain changes again and again at t = {state.time:.9g} s, without any time between")
    if answer == at.NOT_FINITE:
        raise InputError(f"simulate: the motion of the chain is not finite after t = {state.time:.9g} s")


def solve_chain(
    chain: Chain,
    duration: float,
    start: ChainState | None = None,
    *,
    keep: Literal["catalogue", "changes"] = "catalogue",
    sink: RowSink | None = None,
    report: Callable[[float, ChainState], bool | None] | None = None,
) -> ChainRun:
    """Solve a chain up to a time (s), from t = 0 or from a state, and return the run.

    `keep` says whether changes of blocks are kept, or the catalogue of events alone. A `sink` takes all rows instead of the run.
    `report` is called about every tenth of a second with the time and the state; if it returns True, the run ends there.
    """
    solver = ChainSolver(chain, start, keep == "changes")
    events: list[Floats] = []
    changes: list[Floats] = []
    snapshots, every, calls = [solver.state.copy()], 1, 0
    done, reached = False, duration
    while not done:
        done, new_events, new_changes = solver.go_on(duration)
        if sink is None:
            events.append(new_events)
            changes.append(new_changes)
        else:
            sink.take(new_events, new_changes, solver.state)
        calls += 1
        if calls % every == 0:
            snapshots.append(solver.state.copy())
            if len(snapshots) > MOST_SNAPSHOTS:
                snapshots, every = snapshots[::2], 2 * every
        if report is not None and report(solver.state.time, solver.state) and not done:
            reached, done = solver.state.time, True
    return ChainRun(
        chain,
        reached,
        np.concatenate(events) if events else np.empty((0, at.EVENT_COLUMNS)),
        np.concatenate(changes) if keep == "changes" and changes else None,
        snapshots,
        solver.state,
        solver.at(reached),
    )


def motion_from(chain: Chain, start: ChainState, times: Floats) -> ChainMotion:
    """Return slip and slip rate of all blocks at ascending times (s), by going on from a state before the first of them."""
    solver = ChainSolver(chain, start)
    slips, rates = np.empty((len(times), chain.count)), np.empty((len(times), chain.count))
    kept = KeptRows(np.empty((0, at.CHANGE_COLUMNS)), np.empty((ROOM_FOR_EVENTS, at.EVENT_COLUMNS)), times, slips, rates)
    answer = at.GOES_ON
    while answer == at.GOES_ON:
        answer = advance(solver.numbers, solver.state.memory, solver.room, kept, Limits(float(times[-1]), 0, BUDGET))
        check_answer(answer, solver.state)
    return ChainMotion(times, slips, rates)
