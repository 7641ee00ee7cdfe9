"""Truth for the tests of leaps over creep: the printed slab of Fig. 5, pulled `faster` times faster, every round trip run.

    python -m tests.engine.creep_truth engine 10
    python -m tests.engine.creep_truth grid 1 64000

prints the time at which slip has grown by 1 cm, in the middle of the first dynamic pulse. `engine` runs the exact engine and
forgets all but the last two round trips: 134 million pieces and 104 s for 10, a hundred times that for 1. `grid` shares nothing
with the package: the load at so many offsets of the round trip, friction and slip by the implicit midpoint rule.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numba
import numpy as np
from scipy.optimize import brentq

import stickslip as ss
from stickslip.engine.loop import run_until
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Stop
from stickslip.engine.state.workspace import counts_in, lend_history, state_in
from stickslip.engine_input.prepare import prepare
from stickslip.trajectory.history import History

GROWN = 0.01
ROUND, IMPEDANCE = 2 * 1e4 / 3500.0, 2800.0 * 3500.0


def printed(faster: float) -> ss.Problem:
    """The printed slab, pulled so many times faster."""
    problem = ss.load_scenario("fig5-slab-printed").problem
    return replace(problem, pull_rate=faster * problem.pull_rate)


def by_engine(problem: ss.Problem) -> float:
    """Time (s) at which slip has grown by GROWN, by the exact engine, one round trip at a time."""
    _setup, memory = prepare(problem, 1e-10)  # its tables live as long as the memory that holds their addresses
    store, trees = at.new_store(4096), at.EchoNode.table(4096)
    state, count = state_in(memory), counts_in(memory)
    lend_history(memory, store, trees)
    count.pause_at = 1
    while True:
        code = run_until(memory, 10**9, 1.0, 10**9)
        if code == Stop.FULL:
            store = at.resized_store(store, int(count.length), 2 * len(store.pieces))
            trees = at.EchoNode.table(len(store.pieces))
            lend_history(memory, store, trees)
            continue
        assert code == Stop.PAUSED
        row = slice(int(count.previous_from), int(count.previous_to))
        pieces = row.stop - row.start
        if state.slip_now > GROWN:
            return _crossing(at.Store(*(part[row].copy() for part in store)), problem, int(count.trip) - 1)
        for part in store:
            part[:pieces] = part[row]
        count.previous_from, count.previous_to = 0, pieces
        count.trip_from, count.length, count.pause_at = pieces, pieces, count.trip + 1


def _crossing(store: at.Store, problem: ss.Problem, row: int) -> float:
    history = History(store, problem, ROUND, 0.0, (row + 1) * ROUND)

    def beyond(t: float) -> float:
        return float(history.slipped(history.find(np.array([t]), "right"))[0]) - GROWN

    return float(brentq(beyond, row * ROUND, np.nextafter((row + 1) * ROUND, 0.0), xtol=1e-12))


@numba.njit  # type: ignore[untyped-decorator]
def by_grid(points: int, pull_rate: float, first_slip: float, excess: float) -> float:
    """The same, with the load at `points` offsets of the round trip."""
    normal, amplitude, wavenumber = 1e8, 0.5, 5.0
    step, load, slip = ROUND / points, np.empty(points), 0.0
    for i in range(points):
        load[i] = excess + 2.0 * IMPEDANCE * pull_rate / ROUND * (i + 0.5) * step
    sine, cosine = normal * amplitude * np.sin(wavenumber * first_slip), normal * amplitude * np.cos(wavenumber * first_slip)
    row = 0
    while True:
        for i in range(points):
            s, half = np.sin(wavenumber * slip), np.sin(0.5 * wavenumber * slip)
            friction = cosine * s - 2.0 * sine * half * half
            rate = 0.0
            if load[i] > friction:
                falling = wavenumber * (sine * s - cosine * np.cos(wavenumber * slip))
                rate = (load[i] - friction) / (IMPEDANCE - 0.5 * step * falling)
            if slip + rate * step > GROWN:
                return row * ROUND + i * step + (GROWN - slip) / rate
            slip += rate * step
            load[i] += 2.0 * IMPEDANCE * (pull_rate - rate)
        row += 1


if __name__ == "__main__":
    method, problem = sys.argv[1], printed(float(sys.argv[2]))
    if method == "engine":
        sys.stdout.write(f"{by_engine(problem)!r}\n")
    else:
        sys.stdout.write(f"{by_grid(int(sys.argv[3]), problem.pull_rate, problem.initial_slip, problem.excess)!r}\n")
