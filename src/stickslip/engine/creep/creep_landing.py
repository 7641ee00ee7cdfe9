"""Landing of a leap over the creep of a slab: the way and the last round trip as pieces, and the engine at its end."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import ClassVar

import numpy as np

from stickslip.engine.creep.averaged import AveragedCreep
from stickslip.engine.creep.creep_walk import Piece, last_pieces
from stickslip.engine.creep.landing import WrittenMotion, continue_after, move, seen, write_piece
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.planner import CreepPlan, hermite
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.problem import Problem

NEAR_SLIP = 4.0
"""A part of the round trip may slip where a leap lands if friction could fall to its load within so many round trips."""
EDGE = 16.0
"""Number of roundings of an offset within which it is that of an edge."""


@dataclass(frozen=True)
class CreepLanding:
    """A leap over creep, ready to be written."""

    may_rest: ClassVar[bool] = False
    problem: Problem
    averaged: AveragedCreep
    plan: CreepPlan
    begun: float  # slip where the leap begins, m

    @property
    def trips(self) -> int:
        """The number of round trips that are leaped over."""
        return self.plan.trips

    @property
    def errors(self) -> tuple[float, float]:
        """The bound of the error of slip (m), and that as a time (s) at the slip rate of the landing."""
        return self.plan.error, self.plan.error / self.plan.states[-1].rate * self.problem.round_trip_time

    @property
    def direction(self) -> int:
        """The direction of slip."""
        return 1 if self.problem.first_pull_rate > 0.0 else -1

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end.

        Where the engine meets only echoes that break, only what slips is written: the rest of the pattern goes on as it is.
        """
        count, end, rows, kept = run.count, self.plan.states[-1], run.standing(), np.empty(0, np.int64)
        there, edges = self.averaged, np.union1d(run.store.phase_from[rows], run.store.phase_to[rows])
        if count.sparse == 1:
            reach = there.strength.slope(end.slip) * end.rate
            slips = there.pattern.rows_above(-end.lift - NEAR_SLIP * abs(reach), run.store.phase_to[rows])
            kept = rows[~slips]
            there = replace(there, pattern=there.pattern.of_rows(slips, run.store.phase_to[rows]))
        pieces, begun = last_pieces(there, end), int(count.trip)
        run.reserve(run.length + len(self.plan.states) + len(pieces))
        first = self._write_way(run, run.length, begun, pieces[0].slip)
        length = self.write_landing(run, first, begun + self.trips, pieces, edges)
        move(run, self.direction * (pieces[-1].slip + pieces[-1].grown))
        count.mode = self.direction if pieces[-1].slips else 0
        continue_after(run, begun + self.trips, first, length, np.zeros(0))
        if count.sparse == 1:
            whole = np.concatenate([kept, np.arange(first, length)])
            run.stand(whole[np.argsort(run.store.phase_from[whole], kind="stable")])

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact round trips after the landing, and how far it may be off.

        Known is the mean of the slips at both ends of the last round trip.
        """
        ahead = self.trips + trips
        mean = self.averaged.reaching(ahead, *self.averaged.beyond(self.plan.states[-1], ahead)).slip
        allowed = max(tolerance * (abs(self.begun) + mean), self.plan.error)
        first = float(run.store.slip[run.count.previous_from])
        return 2.0 * (self.begun + self.direction * mean) - first, 2.0 * allowed

    def _write_way(self, run: LeapingRun, n: int, trip: int, last_slip: float) -> int:
        """Write the averaged slip from `trip` on, as cubics from state to state, up to `last_slip` (m).

        Load and traction are means over a round trip, so that their work and heat are those of the round trips that the pieces
        replace. Returns the next free piece.
        """
        averaged, turn = self.averaged, self.problem.round_trip_time
        whole, width = float(averaged.pattern.whole.sum()), float(averaged.pattern.width.sum())
        unload = 2.0 * averaged.impedance / width
        for (t0, x0, v0), (t1, x1, v1) in pairwise(self._nodes(last_slip)):
            grown, rate, load = hermite(t1 - t0, x1 - x0, v0, v1), np.zeros(TERMS), np.zeros(TERMS)
            rate[:3] = grown[1:] * np.arange(1, 4) / (t1 - t0)
            load[:4] = -unload * grown
            load[0] += whole / width + averaged.gain * (t0 / turn - 0.5) - unload * x0
            load[1] += averaged.gain * (t1 - t0) / turn
            self._write(run, n, trip, Piece(True, t0, t1 - t0, 0.0, x0, load + averaged.impedance * rate, rate))
            n += 1
        run.store.phase_to[n - 1] += np.spacing((trip + self.trips) * turn)  # no gap before the next round trip
        return n

    def _nodes(self, last_slip: float) -> list[tuple[float, float, float]]:
        """Return the time since the start of the leap (s), slip (m) and slip rate (m/s) at the ends of the cubics.

        The mean over a round trip is taken as the value in its middle.
        """
        plan, turn = self.plan, self.problem.round_trip_time
        first, second, last = plan.states[0], plan.states[1], plan.states[-1]
        inside = [c for c in plan.states[:-1] if 0.5 < c.trips < plan.trips - 1.0]
        return [
            (0.0, 0.0, (first.rate - 0.5 * second.bend) / turn),
            *(((c.trips + 0.5) * turn, c.slip, c.rate / turn) for c in inside),
            (plan.trips * turn, last_slip, (last.rate - 0.5 * last.bend) / turn),
        ]

    def write_landing(self, run: LeapingRun, n: int, trip: int, pieces: list[Piece], edges: Floats) -> int:
        """Write the round trip on which the leap lands, or what slips of it, from piece n on. Return where the next piece goes.

        `edges` are the offsets (s) at which pieces of the pattern begin or end: where one of them is meant, it is taken to the
        last digit, so that no piece of the pattern is overlapped and no gap is left. A piece of which nothing is left is not kept:
        the queue of echoes could not tell it from the piece that begins there.
        """
        store, close, first = run.store, EDGE * float(np.spacing(self.problem.round_trip_time)), n
        for piece in pieces:
            self._write(run, n, trip, piece)
            for field in (store.phase_from, store.phase_to):
                after = min(int(np.searchsorted(edges, field[n])), len(edges) - 1)
                near = edges[[max(after - 1, 0), after]]
                nearest = near[np.abs(near - field[n]).argmin()]
                field[n] = nearest if abs(nearest - field[n]) <= close else field[n]
            if n > first and abs(store.phase_from[n] - store.phase_to[n - 1]) <= close:
                store.phase_to[n - 1] = store.phase_from[n]
            n += int(store.phase_to[n] > store.phase_from[n])
        return n

    def _write(self, run: LeapingRun, n: int, trip: int, piece: Piece) -> None:
        store, load = run.store, seen(piece.load, self.problem.strength, self.direction)
        motion = WrittenMotion(self.direction * piece.slips, run.count.piece, load, self.direction * piece.rate)
        write_piece(run, n, (trip, piece.phase_from, piece.phase_to), motion)
        store.speed[n], store.bend[n] = piece.speed, piece.bend
        store.slip[n] += self.direction * piece.slip
        store.law_slip[n] += self.averaged.strength.sign * piece.slip
