"""Write a leap over the creep of a slab into the history: pieces seen in the direction of slip."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from stickslip.engine.creep.averaged import AveragedCreep
from stickslip.engine.creep.landing import Piece
from stickslip.engine.creep.planner import CreepPlan, hermite
from stickslip.engine.state.layout import TERMS, Counts, Floats, HistoryPiece, State, Store
from stickslip.problem import Problem


def seen(load: Floats, strength: float, direction: int) -> Floats:
    """Convert loads (n, TERMS) minus the reference strength between signed values and values in the direction of slip.

    The conversion is its own inverse.
    """
    turned = direction * load
    if direction < 0:
        turned[:, 0] -= 2.0 * strength
    return turned


EDGE = 16.0
"""Number of roundings of an offset within which it is that of an edge."""


@dataclass(frozen=True)
class HistoryWriter:
    """Write pieces, seen in the direction of slip, into the rows of the history."""

    store: Store
    problem: Problem
    round_trip_time: float
    direction: int
    sign: float  # change of the law's slip with slip in that direction
    state: State  # where the leap begins
    count: Counts

    def write_way(self, n: int, trip: int, averaged: AveragedCreep, plan: CreepPlan, last_slip: float) -> int:
        """Write the averaged slip from `trip` on, as cubics from state to state, up to `last_slip` (m).

        Load and traction are means over a round trip, so that their work and heat are those of the round trips that the pieces
        replace. Returns the next free piece.
        """
        whole, width = float(averaged.pattern.whole.sum()), float(averaged.pattern.width.sum())
        unload = 2.0 * averaged.impedance / width
        for (t0, x0, v0), (t1, x1, v1) in pairwise(self._nodes(plan, last_slip)):
            grown, rate, load = hermite(t1 - t0, x1 - x0, v0, v1), np.zeros(TERMS), np.zeros(TERMS)
            rate[:3] = grown[1:] * np.arange(1, 4) / (t1 - t0)
            load[:4] = -unload * grown
            load[0] += whole / width + averaged.gain * (t0 / self.round_trip_time - 0.5) - unload * x0
            load[1] += averaged.gain * (t1 - t0) / self.round_trip_time
            self._write(n, trip, Piece(True, t0, t1 - t0, 0.0, x0, load + averaged.impedance * rate, rate))
            n += 1
        self.store.phase_to[n - 1] += np.spacing((trip + plan.trips) * self.round_trip_time)  # no gap before the next round trip
        return n

    def _nodes(self, plan: CreepPlan, last_slip: float) -> list[tuple[float, float, float]]:
        """Return the time since the start of the leap (s), slip (m) and slip rate (m/s) at the ends of the cubics.

        The mean over a round trip is taken as the value in its middle.
        """
        first, second, last = plan.states[0], plan.states[1], plan.states[-1]
        inside = [c for c in plan.states[:-1] if 0.5 < c.trips < plan.trips - 1.0]
        return [
            (0.0, 0.0, (first.rate - 0.5 * second.bend) / self.round_trip_time),
            *(((c.trips + 0.5) * self.round_trip_time, c.slip, c.rate / self.round_trip_time) for c in inside),
            (plan.trips * self.round_trip_time, last_slip, (last.rate - 0.5 * last.bend) / self.round_trip_time),
        ]

    def write_landing(self, n: int, trip: int, pieces: list[Piece], edges: Floats) -> int:
        """Write the round trip on which the leap lands, or what slips of it, from piece n on. Return where the next piece goes.

        `edges` are the offsets (s) at which pieces of the pattern begin or end: where one of them is meant, it is taken to the
        last digit, so that no piece of the pattern is overlapped and no gap is left. A piece of which nothing is left is not kept:
        the queue of echoes could not tell it from the piece that begins there.
        """
        store, close, first = self.store, EDGE * float(np.spacing(self.round_trip_time)), n
        for piece in pieces:
            self._write(n, trip, piece)
            for field in (store.phase_from, store.phase_to):
                after = min(int(np.searchsorted(edges, field[n])), len(edges) - 1)
                near = edges[[max(after - 1, 0), after]]
                nearest = near[np.abs(near - field[n]).argmin()]
                field[n] = nearest if abs(nearest - field[n]) <= close else field[n]
            if n > first and abs(store.phase_from[n] - store.phase_to[n - 1]) <= close:
                store.phase_to[n - 1] = store.phase_from[n]
            n += int(store.phase_to[n] > store.phase_from[n])
        return n

    def _write(self, n: int, trip: int, piece: Piece) -> None:
        store, state = self.store, self.state
        slip, law_slip = state.slip_now + self.direction * piece.slip, state.law_slip + self.sign * piece.slip
        kept = HistoryPiece(store.pieces[n])
        kept.trip, kept.mode, kept.law_piece = trip, self.direction * piece.slips, self.count.piece
        kept.jump, kept.cause, kept.echo_of = 0, 0, -1
        kept.phase_from, kept.phase_to, kept.speed, kept.bend = piece.phase_from, piece.phase_to, piece.speed, piece.bend
        kept.slip, kept.law_slip, kept.amplified, kept.gain = slip, law_slip, np.nan, np.nan
        kept.residual = 0.0  # a leap has an error bound of its own
        store.load[n] = seen(piece.load[None, :], self.problem.strength, self.direction)[0]
        store.rate[n] = self.direction * piece.rate
