"""Waves in a body of layers, replayed from the slip rate of its contact: what `Waves` is for a uniform slab.

The cells, the times T and 2 T, and the way of the waves are those of `engine.waves.ladder`. E(s) is the wave in each cell that
leaves its even place at time s, O(s) the one that leaves its odd place, which follows from E(s - T). All are loads minus those of
the reference strength; where sides are joined, each bears its share of that (`engine.input.ladder`). A step of 2 T follows from
the slip rate alone, so that the loads of the history are not used: they can be compared.

The kernels are in `layer_replay`. A replay takes a time in proportion to the pieces of the history, to the cells, and to the phases
that are asked for; one that answers many moments costs hardly more than one for the last of them.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from stickslip.engine import Floats, History, Integers, LadderCell, Positions, crossed
from stickslip.engine.input import ladder_of, sides_of
from stickslip.foundation.constants import RIGID
from stickslip.problem import inflow_of
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables.driver_of_waves import driver_behind
from stickslip.solution.observables.layer_records import (
    PULL,
    SHARE,
    SUMS,
    TOTAL,
    VALUE,
    FollowedTrips,
    FollowedWaves,
    LadderCells,
    SlipPieces,
    WaveQueries,
)
from stickslip.solution.observables.layer_replay import answer, replay

NUMBERS_TOGETHER = 1 << 19
"""Keep so many numbers together, of cells or of drivers, so that memory is bounded."""
PHASES_TOGETHER = 64
"""Phases that are replayed together (1): what they need fits into the fast memory of a processor."""


class LayerWaves:
    """The waves in a body of layers at any time of a history."""

    def __init__(self, history: History, body: OfLayers) -> None:
        self.history, self.body, self.problem = history, body, history.problem
        self.time, self.round = body.cells.time, body.round_trip_time
        self.driver = driver_behind(self.problem).layers(history, body)
        """The first driver; one on the other side is passive, and does not change."""
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
            moves=np.array(np.any(store.rate, axis=1), bool),
        )
        strength = np.array([side.share * self.problem.strength for side in sides])
        self.ladder = LadderCells(
            impedance=np.array(cells.impedance, float),
            reflection=np.array(cells.reflection, float),
            beyond=np.array(cells.reflection_beyond, float),
            drag=np.concatenate([side.layers.drags for side in sides]),
            ramp_share=np.array(cells.ramp_share, float),
            wave=np.array(cells.wave, float),
            growth=np.array(cells.growth, float),
            starts=self.starts.astype(np.int64),
            strength=strength,
            gain=self.driver.gain,
            joined=int(body.is_joined),
            delay=float(body.inflow_delay),
            time=self.time,
        )
        self.is_away = np.concatenate([np.arange(count) % 2 == 0 for count in counts])
        """True for cells where E travels away from the contact."""
        self.reference = np.repeat(strength, counts)
        self._inflow = np.array([cells.inflow[self.last], cells.inflow_rate[self.last]], float)
        self._before = np.array(cells.inflow_before[self.last], float)
        self._pulled = np.array(cells.pulled[self.last], float)
        self._is_pulled = np.array(body.is_pulled, float)
        self.first = -1 if history.begun_with is None else 0
        """The first round trip whose waves are known."""
        trips = np.unique(self.contact.trip)
        self._steps = np.union1d(trips, trips + 1)[self.first + 1 :]

    def placed(self, time: Floats) -> tuple[Integers, Floats]:
        """Return round trips and phases (s) of times (s since the history's epoch), none before the first that is known."""
        epoch = self.history.epoch
        since = time + epoch.offset
        trips = np.floor(since / self.round)
        phase = np.clip(since - trips * self.round, 0.0, self.round)
        return self.clipped(epoch.trip + trips.astype(np.int64), phase)

    def clipped(self, trip: Integers, phase: Floats) -> tuple[Integers, Floats]:
        """Return the same places, or the first that is known, one round trip before the start unless the run began with waves."""
        return np.maximum(trip, self.first), np.where(trip < self.first, 0.0, phase)

    def earlier(self, trip: Integers, phase: Floats) -> tuple[Integers, Floats]:
        """Return the places in time one cell earlier."""
        late = phase >= self.time
        return self.clipped(np.where(late, trip, trip - 1), np.where(late, phase - self.time, phase + self.time))

    @cached_property
    def _met_at_changes(self) -> Floats:
        """The integral of the wave that the first driver met, from the start of the round trip to each change (Pa s)."""
        trip, phase, _ = self.driver.turned
        return self.rows(trip - 1, phase)[:, TOTAL, self.last[0]]

    def sent(self, trip: Integers, phase: Floats) -> Floats:
        """Return what each driver does at these places in time: axes sides, and VALUE, TOTAL, PULL and SHARE.

        Until the first wave of the run has come from a driver that is behind an odd number of cells, it keeps the initial state.
        """
        begin, before, early = trip * self.round, self.ladder.delay, trip == 0
        time, known = begin + phase, np.asarray(np.where(early, np.minimum(before, phase), 0.0), float)
        low, lasting = (
            np.asarray(begin + known, float),
            phase - known,
        )  # and not time - low, which is rounded to the digits of the time
        found = np.empty((len(self._before), 4, *time.shape))
        shares = [self.driver.share_at(time), *self.ladder.reflection[self.last[1:]]]
        for side, last in enumerate(self.last):
            if (weight := self._pulled[side]) != 0.0:
                inflow = inflow_of(self.problem)
                value = weight * inflow.at(time)
                whole = weight * inflow.total(low, time) + value * (lasting - (time - low))
            else:
                first, slope = self._inflow[:, side]
                value, whole = first + slope * time, (first + 0.5 * slope * (low + time)) * lasting
            if side == 0:
                value, whole = self.driver.sent(trip, phase, (value, whole))
            wave, growth = self.ladder.wave[last], self.ladder.growth[last]
            kept = RIGID - self.ladder.reflection[last]  # it reflects all, and the recursion lets it reflect its share
            found[side, SHARE] = shares[side]
            of_start = kept * (wave + growth * phase) + self._before[side]
            found[side, VALUE] = np.where(early & (phase < before), of_start, value)
            found[side, TOTAL] = whole + known * (kept * (wave + 0.5 * growth * known) + self._before[side])
            found[side, PULL] = self._is_pulled[side] * self.problem.pull_rate_at(np.maximum(time - before, 0.0))
        return found

    def rows(self, trip: Integers, phase: Floats) -> Floats:
        """Return E and its integral since the start of the round trip (axis 1), in each cell (axis 2), at places in time."""
        return self._replayed(trip, phase, 2, len(self.is_away))[0]

    def waves(self, trip: Integers, phase: Floats) -> Floats:
        """Return E in each cell (axis 1) at places in time."""
        return self._replayed(trip, phase, 1, len(self.is_away))[0][:, VALUE]

    def sums(self, trip: Integers, phase: Floats) -> Floats:
        """Return the sums of a replay, `MOVED` and so on (axis 1), at places in time."""
        return self._replayed(trip, phase, 2, 0)[1]

    def powers(self, trip: Integers, phase: Floats) -> Floats:
        """Return the same sums, but for those of motion."""
        return self._replayed(trip, phase, 1, 0)[1]

    def _replayed(self, trip: Integers, phase: Floats, levels: int, cells: int) -> tuple[Floats, Floats]:
        rows, sums = np.empty((len(trip) if cells else 0, levels, cells)), np.empty((len(trip), SUMS))
        phases, which = np.unique(phase, return_inverse=True)
        last = np.full(len(phases), -1)
        np.maximum.at(last, which, trip)
        late_first = np.argsort(-last, kind="stable")  # phases that need but a part of the history stand together
        rank = np.empty_like(late_first)
        rank[late_first] = np.arange(len(phases))
        order = np.lexsort((trip, rank[which] // PHASES_TOGETHER))
        first = np.searchsorted(rank[which[order]] // PHASES_TOGETHER, np.arange(len(phases) // PHASES_TOGETHER + 2))
        for n in range(len(first) - 1):
            part, here = order[first[n] : first[n + 1]], phases[late_first[n * PHASES_TOGETHER : (n + 1) * PHASES_TOGETHER]]
            if len(part):
                asked, place = trip[part].astype(np.int64), self._at_first(here, levels)
                found = np.empty((len(part) if cells else 0, levels, cells)), np.empty((len(part), SUMS))
                self._replay_together(here, place, WaveQueries(asked, rank[which[part]] % PHASES_TOGETHER, *found))
                sums[part] = found[1]
                if cells:
                    rows[part] = found[0]
        return rows, sums

    def _at_first(self, phase: Floats, levels: int) -> FollowedWaves:
        """Return the first place that is known."""
        phase = self._with_changes(phase, levels)
        wave, growth, many = self.ladder.wave[:, None], self.ladder.growth[:, None] * phase, len(phase)
        both = [wave + growth, (wave + 0.5 * growth) * phase] if self.first < 0 else self._begun_with(phase)
        sums, slip = (np.zeros((number, many)) for number in (SUMS, 2))
        return FollowedWaves(
            *(np.array(both[:levels]), sums, np.zeros_like(sums), np.zeros(many), slip, np.array([self.first, 0, 0]), phase),
            *(np.zeros(1), np.zeros(many)),
        )

    def _begun_with(self, phase: Floats) -> list[Floats]:
        """Return given waves in each cell (axis 0), and their integrals since the start of the first round trip."""
        store, given = self.history.store, self.history.begun_with
        assert given is not None
        piece = np.searchsorted(store.phase_from[1 : len(given)], phase, side="right")
        powers, width = np.arange(given.shape[-1]), store.speed[: len(given)]
        xi = ((phase - store.phase_from[piece]) / width[piece])[:, None]
        total = given / (powers + 1.0) * width[:, None, None]
        before = np.cumsum(total.sum(axis=2), axis=0) - total.sum(axis=2)
        value, since = np.einsum("pck,pk->cp", given[piece], xi**powers), np.einsum("pck,pk->cp", total[piece], xi ** (powers + 1))
        return [value, before[piece].T + since]

    def _with_changes(self, phase: Floats, levels: int) -> Floats:
        """Return phases (s) with those of changes of the driver behind them, if integrals are followed."""
        return np.append(phase, self.driver.turned[1]) if levels > TOTAL else phase

    def _ground(self, trip: Integers, phase: Floats) -> Floats:
        """Return the velocity of moving ground (m/s) at these places in time, and its way in the round trip (m); else nothing."""
        if (ground := self.problem.ground) is None:
            return np.empty((2, 0, 0))
        begin = trip * self.round
        time = begin + phase
        return np.array([ground.velocity_at(time), ground.displacement_at(time) - ground.displacement_at(begin)])

    def _replay_together(self, asked: Floats, place: FollowedWaves, queries: WaveQueries) -> None:
        """Answer queries at the phases asked for, in the order of their round trips."""
        phase = place.phase
        turned = np.zeros((0, 3))
        if len(phase) > len(asked):
            changes, _, by = self.driver.turned
            turned = np.column_stack([changes, np.arange(len(asked), len(phase)), by])
        last = int(queries.asked[-1])
        trips, block = self._steps[self._steps <= max(last, 0)], max(NUMBERS_TOGETHER // (6 * len(phase)), 1)
        for low in range(0, len(trips), block):
            part = trips[low : low + block]
            when = np.broadcast_arrays(part[:, None], phase)
            steps = FollowedTrips(phase, part, self.sent(*when), self._ground(*when), self.driver.ramp(part - 1), turned)
            replay(self.contact, self.ladder, steps, place, queries)
        after = self.driver.ramp(trips[-1:] if len(trips) else np.array([-1]))
        place.ramp[0] = after[0]
        nothing = FollowedTrips(phase, trips[:0], np.empty((0, 0, 0, 0)), np.empty((2, 0, 0)), after, turned)
        answer(self.ladder, nothing, place, queries, last + 1)

    def odd(self, rows: Floats, trip: Integers, phase: Floats) -> Floats:
        """Return O and its integral at times T after those of rows of E, whose places in time are given."""
        found, sent = np.empty_like(rows), self.sent(trip + 1, phase)
        for side, last in enumerate(self.last):
            near = np.arange(self.starts[side], last, 2)
            share, beyond = self.ladder.reflection[near], self.ladder.beyond[near]
            found[..., near], found[..., near + 1] = crossed(share, beyond, rows[..., near], rows[..., near + 1])
            if (last - self.starts[side]) % 2 == 0:
                found[..., last] = sent[side, SHARE][:, None] * rows[..., last] + sent[side, : rows.shape[1]].T
                if side == 0 and rows.shape[1] > TOTAL and len(self.driver.turned[0]):
                    found[:, TOTAL, last] += self._met_before_changes(trip + 1, phase)
        return found

    def _met_before_changes(self, trip: Integers, phase: Floats) -> Floats:
        """Return what changes of the driver in these round trips, up to these phases (s), take off what it sends back (Pa s)."""
        changes, at, by = self.driver.turned
        passed = (changes == trip[:, None]) & (at <= phase[:, None])
        return np.asarray(passed @ (by * self._met_at_changes))
