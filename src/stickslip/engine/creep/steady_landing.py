"""Landing of a leap over steady sliding: the way and the last round trip as pieces of the history, and the engine at its end."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.steady import Deviation, Leap, integrals
from stickslip.engine.state.layout import Floats, HistoryPiece, Store


@dataclass(frozen=True)
class SteadyLanding:
    """A leap over steady sliding and the deviation from it in the last round trip, ready to be written."""

    leap: Leap
    deviation: Deviation

    @property
    def trips(self) -> int:
        """The number of round trips that are leaped over."""
        return self.leap.trips

    @property
    def errors(self) -> tuple[float, float]:
        """The bound of the error of slip (m), and that as a time (s)."""
        return self.leap.error, self.leap.error / abs(self.deviation.rate_there)

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end."""
        write(run, self.leap, self.deviation)

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact round trips after a landing at `slip`, and how far it may be off."""
        turn = trips * run.problem.round_trip_time
        slip += turn * self.deviation.rate_there
        deviates = turn * abs(self.leap.factor) * self.deviation.largest_rate
        return slip, max(self.leap.error + deviates, tolerance * abs(slip))


def write(run: LeapingRun, leap: Leap, deviation: Deviation) -> None:
    """Write the way as one piece, then the round trip on which the leap lands, and set the engine there."""
    state, count, last = run.state, run.count, deviation.rows.stop - 1
    rows = range(deviation.rows.start if leap.factor else last, last + 1)
    run.reserve(run.length + 1 + len(rows))
    store, way, landed_on = run.store, run.length, int(count.trip) + leap.trips
    sign, turn = math.copysign(1.0, deviation.rate_there), run.problem.round_trip_time
    law_sign = sign if run.problem.friction.counts == "net" else 1.0
    length = leap.trips * turn
    write_piece(run, way, last, (int(count.trip), 0.0, length + np.spacing(landed_on * turn)))  # no gap before the next round trip
    steady = deviation.load_there, sign * leap.slip / length, deviation.states_there
    _write_steady(store, way, *steady)
    state.slip_now += sign * leap.slip
    state.law_slip += law_sign * leap.slip
    for n, row in enumerate(rows, way + 1):
        phases = (float(store.phase_from[row]), float(store.phase_to[row])) if leap.factor else (0.0, turn)
        write_piece(run, n, row, (landed_on, *phases))
        _write_steady(store, n, deviation.load_there, deviation.rate_there, deviation.states_there)
        if leap.factor:
            kept = row - deviation.rows.start
            store.load[n] += leap.factor * deviation.load[kept]
            store.rate[n] += leap.factor * deviation.rate[kept]
            store.speed[n], store.bend[n], store.jump[n] = store.speed[row], store.bend[row], store.jump[row]
        grown = float(integrals(store.rate[n : n + 1], store.speed[n : n + 1], store.bend[n : n + 1])[0])
        state.slip_now += grown
        state.law_slip += law_sign * abs(grown)
    continue_after(run, landed_on, way + 1, way + 1 + len(rows), deviation.states_there)


def continue_after(run: LeapingRun, trip: int, first: int, length: int, states: Floats) -> None:
    """Set the engine to the end of a round trip, whose pieces have been written from `first` up to `length`, in these states."""
    state, count, store = run.state, run.count, run.store
    state.rate_now, state.load_now = store.rate[length - 1].sum(), store.load[length - 1].sum()
    for k, value in enumerate(states):
        state.state_now[k] = value
    count.length = count.previous_to = count.trip_from = length
    count.previous_from, count.trip = first, trip + 1
    count.source = count.moved = count.trips_at_rest = count.leaving_rest = count.jump = count.cause = count.stalled = 0


def write_piece(run: LeapingRun, n: int, row: int, when: tuple[int, float, float]) -> None:
    """Write all of piece n but its motion: like another piece, at a round trip and between two phases (s)."""
    trip, begin, end = when
    kept, like = HistoryPiece(run.store.pieces[n]), HistoryPiece(run.store.pieces[row])
    kept.trip, kept.mode, kept.law_piece = trip, like.mode, like.law_piece
    kept.jump, kept.cause, kept.echo_of = 0, 0, -1
    kept.phase_from, kept.phase_to, kept.speed, kept.bend = begin, end, end - begin, 0.0
    kept.slip, kept.law_slip = run.state.slip_now, run.state.law_slip
    kept.amplified, kept.gain, kept.residual = np.nan, np.nan, 0.0  # a leap has an error bound of its own


def _write_steady(store: Store, n: int, load: float, rate: float, states: Floats) -> None:
    """Write a constant load (Pa or N, minus the reference), a constant rate (m/s) and constant states into piece n."""
    for row, value in ((store.load[n], load), (store.rate[n], rate), *((store.state[n, k], one) for k, one in enumerate(states))):
        row[:] = 0.0
        row[0] = value
