"""Waves in a body of layers, replayed from the slip rate of its contact: what `Waves` is for a uniform slab.

The cells, the times T and 2 T, and the way of the waves are those of `engine.waves.ladder`. E(s) is the wave in each cell that
leaves its even place at time s, O(s) the one that leaves its odd place, which follows from E(s - T). All are loads minus those of
the reference strength; where sides are joined, each bears its share of that (`engine_input.ladder`). A step of 2 T follows from
the slip rate alone, so that the loads of the history are not used: they can be compared.

The integral of E from the start of a round trip obeys the same recursion, and gives displacements without a quadrature. The replay
of one moment takes a time in proportion to the pieces of the history before it, and to the number of cells.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.bodies import OfLayers
from stickslip.engine.compile.kernels import kernel
from stickslip.engine.state.layout import Floats, Integers, LadderCell
from stickslip.engine_input.forcing import inflow_of
from stickslip.engine_input.ladder import ladder_of, sides_of
from stickslip.foundation.constants import RIGID
from stickslip.trajectory.history import History, Positions

VALUE, TOTAL, PULL = 0, 1, 2
"""What drivers send: a load where it joins the waves (Pa), its integral in the round trip (Pa s), and the driver's rate (m/s)."""
MOVED, MOVED_IN_TRIP, WORK, RADIATED = range(4)
"""Sums of a replay: how far the face of the second side has moved (m), since the start and since that of the round trip, and the
work of the drivers and the energy radiated through them (J/m^2), integrated over time at one phase: J/(m^2 s).
"""
MOST = 1 << 19
"""Numbers that are replayed together, of cells or of what drivers send: it keeps the memory bounded."""


class SlipPieces(NamedTuple):
    """The slip of the contact, as arrays over the pieces of the history: see `layout.Store`."""

    trip: Integers
    phase_from: Floats
    phase_to: Floats
    speed: Floats
    bend: Floats
    rate: Floats
    grown: Floats
    """Slip in the whole piece (m)."""


class LadderCells(NamedTuple):
    """The cells, as arrays; see `layout.LadderCell`."""

    impedance: Floats
    reflection: Floats
    ramp: Floats
    """Growth of the wave in a round trip of a settled rest (Pa)."""
    wave: Floats
    growth: Floats
    starts: Integers
    """First cell of each side, and the number of cells."""
    driver: Floats
    """Impedance of the driver of each side (Pa s/m)."""
    strength: Floats
    """Reference strength (Pa) of each side."""
    joined: int
    delay: float
    """Time (s) from the driver to the place where waves are followed."""


class ReplaySteps(NamedTuple):
    """Replays at several phases (s), with the round trips into which single steps lead, and what drivers send in them."""

    phase: Floats
    asked: Integers
    """Round trip (at least -1) of each query, in order at each phase."""
    first: Integers
    """First query of each phase, and the number of queries."""
    trip: Integers
    sent: Floats
    """Array over phases, steps, sides, and VALUE, TOTAL and PULL."""


@kernel
def replay(contact: SlipPieces, ladder: LadderCells, steps: ReplaySteps, rows: Floats, sums: Floats) -> None:
    """Write E, its integral and the sums at each query; no rows if there is no room for them."""
    both, growth, asked = np.empty((2, len(ladder.impedance))), np.zeros(4), steps.asked
    wave, total = both[0], both[1]
    for u in range(len(steps.phase)):
        phase, q, piece, trip = steps.phase[u], steps.first[u], 0, -1
        state = np.zeros(4)
        growth[:] = 0.0
        wave[:] = ladder.wave + ladder.growth * phase
        total[:] = (ladder.wave + 0.5 * ladder.growth * phase) * phase
        slope = 0.0
        for k in range(len(steps.trip) + 1):
            upto = steps.trip[k] if k < len(steps.trip) else asked[steps.first[u + 1] - 1] + 1
            while q < steps.first[u + 1] and asked[q] < upto:
                more = float(asked[q] - trip)
                if len(rows) > 0:
                    rows[q, 0] = wave + more * ladder.ramp
                    rows[q, 1] = total + more * phase * ladder.ramp
                sums[q] = state + more * growth
                sums[q, WORK] += 0.5 * more * (more + 1.0) * slope
                q += 1
            if k == len(steps.trip) or q == steps.first[u + 1]:
                break
            more = float(upto - 1 - trip)
            if more > 0.0:
                wave += more * ladder.ramp
                total += more * phase * ladder.ramp
                state += more * growth
                state[WORK] += 0.5 * more * (more + 1.0) * slope
            trip, rate, slipped = upto, 0.0, 0.0
            while piece < len(contact.trip) and contact.trip[piece] < trip:
                piece += 1
            while piece < len(contact.trip) and contact.trip[piece] == trip and contact.phase_from[piece] <= phase:
                rate, grown = motion(contact, piece, phase)
                slipped += grown
                piece += 1
            growth[:] = 0.0
            slope = step(ladder, both, steps.sent[u, k], (rate, slipped), growth)
            if trip == 0 and phase < ladder.delay:
                growth[WORK] = growth[RADIATED] = slope = 0.0
            state += growth
            state[MOVED_IN_TRIP] = growth[MOVED_IN_TRIP]
            growth[MOVED_IN_TRIP] = 0.0


@kernel
def motion(contact: SlipPieces, piece: int, phase: float) -> tuple[float, float]:
    """Return the slip rate (m/s) at a phase (s), 0 behind the end of the piece, and the slip (m) in the piece until then."""
    if phase >= contact.phase_to[piece]:
        return 0.0, contact.grown[piece]
    speed, bend, local = contact.speed[piece], contact.bend[piece], phase - contact.phase_from[piece]
    pace = speed + np.sqrt(max(speed * speed + 4.0 * bend * local, 0.0))
    xi = min(2.0 * local / pace, 1.0) if pace > 0.0 else 0.0
    rate, grown = 0.0, 0.0
    for k in range(contact.rate.shape[1] - 1, -1, -1):
        one = contact.rate[piece, k]
        rate = rate * xi + one
        grown = grown * xi + one * (speed / (k + 1.0) + 2.0 * bend * xi / (k + 2.0))
    return rate, grown * xi


@kernel
def step(ladder: LadderCells, both: Floats, sent: Floats, slip: tuple[float, float], growth: Floats) -> float:
    """Let waves and integrals of one round trip ago cross two cells, and the contact answer with its slip rate (m/s) and slip (m).

    Write the powers of the drivers (W/m^2) and the way (m) of the second side's face; return by how much the power grows in each
    round trip of a settled rest.
    """
    wave, total, rate, slipped, slope = both[0], both[1], slip[0], slip[1], 0.0
    for side in range(len(ladder.starts) - 1):
        first, past = ladder.starts[side], ladder.starts[side + 1]
        for parity in range(2):
            for cell in range(first + parity, past, 2):
                share = ladder.reflection[cell]
                if cell == past - 1:
                    away, doubled = wave[cell], 2.0 * ladder.impedance[cell]
                    wave[cell] = share * away + sent[side, VALUE]
                    total[cell] = share * total[cell] + sent[side, TOTAL]
                    velocity = (away + wave[cell]) / doubled
                    growth[WORK] += (0.5 * (wave[cell] - away) + ladder.strength[side]) * velocity
                    slope += abs(ladder.ramp[cell]) * np.sign(ladder.ramp[first]) * -velocity
                    if ladder.driver[side] < np.inf:
                        growth[RADIATED] += ladder.driver[side] * (velocity - sent[side, PULL]) ** 2
                else:
                    away, back = wave[cell], wave[cell + 1]
                    wave[cell], wave[cell + 1] = share * away + (1.0 + share) * back, (1.0 - share) * away - share * back
                    away, back = total[cell], total[cell + 1]
                    total[cell], total[cell + 1] = share * away + (1.0 + share) * back, (1.0 - share) * away - share * back
    if len(ladder.starts) == 2:
        wave[0] = 2.0 * ladder.impedance[0] * rate - wave[0]
        total[0] = 2.0 * ladder.impedance[0] * slipped - total[0]
        return slope
    other = ladder.starts[1]
    first, second = ladder.impedance[0], ladder.impedance[other]
    if ladder.joined == 1:
        for cell, own in ((0, 2.0 * first), (other, 2.0 * second)):
            wave[cell] = own * rate - wave[cell]
            total[cell] = own * slipped - total[cell]
        return slope
    # The stress at the contact is (Z2 g1 + Z1 g2 - Z1 Z2 v) / (Z1 + Z2).
    stress = (second * wave[0] + first * wave[other] - first * second * rate) / (first + second)
    of_time = (second * total[0] + first * total[other] - first * second * slipped) / (first + second)
    growth[MOVED_IN_TRIP] = growth[MOVED] = (total[other] - of_time) / second
    for cell in (0, other):
        wave[cell] -= 2.0 * stress
        total[cell] -= 2.0 * of_time
    return slope


class LayerWaves:
    """The waves in a body of layers at any time of a history."""

    def __init__(self, history: History, body: OfLayers) -> None:
        self.history, self.body, self.problem = history, body, history.problem
        self.time, self.round = body.cells.time, body.round_trip_time
        sides, cells, store = list(sides_of(self.problem, body)), LadderCell.of(ladder_of(self.problem)), history.store
        counts = [sum(side.layers.counts) for side in sides]
        self.starts = np.cumsum([0, *counts])
        self.last = self.starts[1:] - 1
        self.contact = SlipPieces(
            trip=store.trip.astype(np.int64),
            phase_from=np.array(store.phase_from, float),
            phase_to=np.array(store.phase_to, float),
            speed=np.array(store.speed, float),
            bend=np.array(store.bend, float),
            rate=np.array(store.rate, float),
            grown=history.grown(Positions.inside(np.arange(len(history)), 1.0)),
        )
        strength = np.array([side.share * self.problem.strength for side in sides])
        self.ladder = LadderCells(
            impedance=np.array(cells.impedance, float),
            reflection=np.array(cells.reflection, float),
            ramp=np.array(cells.ramp_share * history.ramp, float),
            wave=np.array(cells.wave, float),
            growth=np.array(cells.growth, float),
            starts=self.starts.astype(np.int64),
            driver=np.array([side.layers.driver_impedance for side in sides], float),
            strength=strength,
            joined=int(body.is_joined),
            delay=float(body.inflow_delay),
        )
        self.is_away = np.concatenate([np.arange(count) % 2 == 0 for count in counts])
        """True for cells in which E travels away from the contact."""
        self.reference = np.repeat(strength, counts)
        self._inflow = np.array([cells.inflow[self.last], cells.inflow_rate[self.last]], float)
        self._before = np.array(cells.inflow_before[self.last], float)
        self._pulled = np.array(cells.pulled[self.last], float)
        self._is_pulled = np.array([1.0] + [float(body.is_joined)] * (len(sides) - 1))
        trips = np.unique(self.contact.trip)
        self._steps = np.union1d(trips, trips + 1)

    def placed(self, time: Floats) -> tuple[Integers, Floats]:
        """Return round trips and phases (s) of times (s since the history's epoch), at least one round trip before the start."""
        epoch = self.history.epoch
        since = time + epoch.offset
        trips = np.floor(since / self.round)
        phase = np.clip(since - trips * self.round, 0.0, self.round)
        return self.clipped(epoch.trip + trips.astype(np.int64), phase)

    def clipped(self, trip: Integers, phase: Floats) -> tuple[Integers, Floats]:
        """Return the same places, or the first that is known, one round trip before the start."""
        return np.maximum(trip, -1), np.where(trip < -1, 0.0, phase)

    def earlier(self, trip: Integers, phase: Floats) -> tuple[Integers, Floats]:
        """Return the places in time one cell earlier."""
        late = phase >= self.time
        return self.clipped(np.where(late, trip, trip - 1), np.where(late, phase - self.time, phase + self.time))

    def sent(self, trip: Integers, phase: Floats) -> Floats:
        """Return what each driver sends that joins the waves at these places in time: VALUE, TOTAL and PULL on the last axis.

        Until the first wave of the run has come from a driver that is behind an odd number of cells, it keeps the initial state.
        """
        begin, before, early = trip * self.round, self.ladder.delay, trip == 0
        time, known = begin + phase, np.asarray(np.where(early, np.minimum(before, phase), 0.0), float)
        low, lasting = (
            np.asarray(begin + known, float),
            phase - known,
        )  # and not time - low, which is rounded to the digits of the time
        found = np.empty((*time.shape, len(self._before), 3))
        for side, last in enumerate(self.last):
            if self.problem.loading_varies:
                inflow, weight = inflow_of(self.problem), self._pulled[side]
                value = weight * inflow.at(time)
                whole = weight * inflow.total(low, time) + value * (lasting - (time - low))
            else:
                first, slope = self._inflow[:, side]
                value, whole = first + slope * time, (first + 0.5 * slope * (low + time)) * lasting
            wave, growth = self.ladder.wave[last], self.ladder.growth[last]
            kept = RIGID - self.ladder.reflection[last]  # it reflects all, and the recursion lets it reflect its share
            of_start = kept * (wave + growth * phase) + self._before[side]
            found[..., side, VALUE] = np.where(early & (phase < before), of_start, value)
            found[..., side, TOTAL] = whole + known * (kept * (wave + 0.5 * growth * known) + self._before[side])
            found[..., side, PULL] = self._is_pulled[side] * self.problem.pull_rate_at(np.maximum(time - before, 0.0))
        return found

    def rows(self, trip: Integers, phase: Floats) -> Floats:
        """Return E and its integral since the start of the round trip (axis 1), in each cell (axis 2), at places in time."""
        return self._replayed(trip, phase, len(self.is_away))[0]

    def sums(self, trip: Integers, phase: Floats) -> Floats:
        """Return the sums of a replay, `MOVED` and so on (axis 1), at places in time."""
        return self._replayed(trip, phase, 0)[1]

    def _replayed(self, trip: Integers, phase: Floats, cells: int) -> tuple[Floats, Floats]:
        rows, sums = np.empty((len(trip) if cells else 0, 2, cells)), np.empty((len(trip), 4))
        order = np.lexsort((trip, phase))
        phases, first = np.unique(phase[order], return_index=True)
        first = np.append(first, len(trip))
        together = max(MOST // (6 * len(self._steps)), 1)
        for low in range(0, len(phases), together):
            high = min(low + together, len(phases))
            part = order[first[low] : first[high]]
            steps = self._steps[self._steps <= max(int(trip[part].max()), 0)]
            times = np.meshgrid(phases[low:high], steps, indexing="ij")
            given = ReplaySteps(
                phase=phases[low:high],
                asked=trip[part].astype(np.int64),
                first=(first[low : high + 1] - first[low]).astype(np.int64),
                trip=steps,
                sent=self.sent(times[1], times[0]),
            )
            found = np.empty((len(part) if cells else 0, 2, cells)), np.empty((len(part), 4))
            replay(self.contact, self.ladder, given, *found)
            sums[part] = found[1]
            if cells:
                rows[part] = found[0]
        return rows, sums

    def odd(self, rows: Floats, trip: Integers, phase: Floats) -> Floats:
        """Return O and its integral at times T after those of rows of E, whose places in time are given."""
        found, sent = np.empty_like(rows), self.sent(trip + 1, phase)
        for side, last in enumerate(self.last):
            near = np.arange(self.starts[side], last, 2)
            away, back, share = rows[..., near], rows[..., near + 1], self.ladder.reflection[near]
            found[..., near] = share * away + (1.0 + share) * back
            found[..., near + 1] = (1.0 - share) * away - share * back
            if (last - self.starts[side]) % 2 == 0:
                found[..., last] = self.ladder.reflection[last] * rows[..., last] + sent[:, side, :PULL]
        return found
