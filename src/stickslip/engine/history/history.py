"""The history of a run: pieces that hold load and slip rate as polynomials, and their evaluation at any time."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.engine.history.phase_index import Phases
from stickslip.engine.history.series import integrals_at, values_at
from stickslip.engine.state.layout import Integers, Store
from stickslip.foundation.arrays import Floats, Floats1, Integers1
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.kernels import entry
from stickslip.friction.contract import one_argument
from stickslip.problem import Problem, driver_of

if TYPE_CHECKING:
    from stickslip.engine.history.machine_motion import MotionInParts

Side = Literal["left", "right"]


@entry
def add_up(values: Floats1, past: Integers1, sums: Floats1) -> None:
    """Add up consecutive groups of values, term by term: group n ends before index past[n] and begins where group n - 1 ends."""
    begin = 0
    for n in range(len(past)):
        sums[n] = 0.0
        for k in range(begin, past[n]):
            sums[n] += values[k]
        begin = past[n]


class Epoch(NamedTuple):
    """A moment without rounding: whole round trips (a block's are periods) since t = 0, and an offset in s."""

    trip: int
    offset: float


OFFSET_ROUNDING = 1e-13
"""Rounding of the offsets of consecutive pieces, relative to the length of a round trip."""

PIECES_IN_CACHE = 1024
"""Integrate this many pieces together: it keeps the memory bounded, and the data in the cache."""

START = Epoch(0, 0.0)
"""t = 0, the start of the run."""

NO_LEAPS = np.empty((0, 4))
"""Table of leaps over creep (`History.creep`) without rows."""


@dataclass(frozen=True)
class Positions:
    """Times located in the history: each lies at a place xi in a piece, or in a rest that was not recorded.

    At rest the load is an echo of `piece`: `leaped` is the number of whole round trips since then (0 within a recorded piece), and
    `last` is the last piece before the position.
    """

    piece: NDArray[np.intp]
    xi: Floats
    leaped: Floats
    before: NDArray[np.bool_]
    """True for the left limit at t = 0."""
    last: NDArray[np.intp]

    @classmethod
    def inside(cls, piece: ArrayLike, xi: ArrayLike) -> Positions:
        """Return the positions at places xi in recorded pieces."""
        pieces, places = np.broadcast_arrays(np.atleast_1d(np.asarray(piece, np.intp)), np.atleast_1d(np.asarray(xi, float)))
        return cls(pieces, places, np.zeros(len(pieces)), np.zeros(len(pieces), bool), pieces)

    @property
    def at_rest(self) -> NDArray[np.bool_]:
        """True for positions in rests that were not recorded."""
        return self.leaped > 0.0

    def recorded(self) -> Positions:
        """Return the last recorded positions up to these; slip is the same at both, because the contact rests between them."""
        piece, xi = np.where(self.at_rest, self.last, self.piece), np.where(self.at_rest, 1.0, self.xi)
        return Positions(piece, xi, np.zeros(len(xi)), self.before, piece)


@dataclass(frozen=True)
class History:
    """The pieces of a run in order of time.

    Loads are differences from the reference strength, slips from the initial slip (see `layout.Store`). Times are seconds since
    `epoch` and are exact to their own rounding, so an epoch near the times of interest gives the sharpest result.
    """

    store: Store
    problem: Problem
    round_trip_time: float
    ramp: float
    duration: float
    epoch: Epoch = START
    creep: Floats = field(default_factory=NO_LEAPS.copy)
    """Leaps over creep, one per row: round trips before it, round trips in it, and bounds on the errors of slip at its landing (m)
    and of the time when that slip is reached (s).
    """
    max_events: int | None = None
    """Number of slip events after which the run stopped; None if it did not stop because of them. The history goes on beyond the
    last of them until its aftermath is known, and another event may begin there.
    """
    forgotten: int = 0
    """Number of earlier pieces that a catalogue has discarded; pieces that are left need not follow on each other."""
    begun_with: Floats | None = None
    """Waves with which a body began (Pa), if they are given: a series for each of the first pieces, and each cell of layers."""

    @property
    def given(self) -> int:
        """How many of its first pieces hold a given wave, and no motion of the contact (1)."""
        return 0 if self.begun_with is None else len(self.begun_with)

    @property
    def begun(self) -> float:
        """The time (s) when its motion begins: at the start, or behind a given wave."""
        return float(self.start[self.given]) if self.given else self.span[0]

    def check_begun(self, time: ArrayLike) -> None:
        """Raise InputError for times (s) when it holds but a given wave: what else was in the body is not known."""
        if self.given and np.any(np.asarray(time) < self.begun - 1e-12 * self.duration):
            raise InputError(f"the run begins with a given wave: what is in the body is known from {self.begun:g} s on")

    def seen_from(self, epoch: Epoch) -> History:
        """Return the same history with its times counted from another epoch."""
        return replace(self, epoch=epoch)

    def seconds(self, trip: Integers | Floats, offset: Floats) -> Floats:
        """Return the times (s since the epoch) of offsets (s) in whole round trips."""
        return np.asarray((trip - self.epoch.trip) * self.round_trip_time + (offset - self.epoch.offset))

    @cached_property
    def start(self) -> Floats:
        """The start time of each piece, s."""
        return self.seconds(self.store.trip, self.store.phase_from)

    @cached_property
    def end(self) -> Floats:
        """The end time of each piece, s."""
        return self.seconds(self.store.trip, self.store.phase_to)

    @property
    def span(self) -> tuple[float, float]:
        """The times (s) of the start and the end of the run."""
        start = float(self.seconds(np.zeros(1), np.zeros(1))[0])
        return start, start + self.duration

    @cached_property
    def breaks(self) -> Floats:
        """The times (s) of the ends of recorded pieces, including the start and the end of the run."""
        return np.append(np.union1d(self.start, self.end[self.rests]), self.span[1])

    def __len__(self) -> int:
        return len(self.store.pieces)

    def is_averaged(self, trip: int) -> bool:
        """Return True if a stored round trip is a leap over creep, whose pieces are averages over round trips."""
        return bool((self.creep[:, 0] == trip).any())

    def find(self, time: Floats, side: Side) -> Positions:
        """Locate times (s, one-dimensional) in the history; `side` picks the piece at a boundary.

        Raises InputError for times outside the run.
        """
        if side not in ("left", "right"):
            raise InputError(f"side must be 'left' or 'right', got {side!r}")
        begin, end = self.span
        if not np.all((time >= begin) & (time <= end + 1e-12 * self.duration)):
            raise InputError(f"times must lie between {begin:g} and the end of the run, {end:g} s")
        piece = np.searchsorted(self.start, time, side="left" if side == "left" else "right") - 1
        before = (piece < 0) & (self.given == 0)  # no start of the problem precedes a given wave
        last: NDArray[np.intp] = np.maximum(piece, 0)
        found = Positions(last.copy(), self.xi(last, time - self.start[last]), np.zeros(len(time)), before, last)
        late = time >= self.end[last] if side == "right" else time > self.end[last]
        rests = np.flatnonzero(late & self.rests[last])
        if rests.size:
            self._find_echoes(found, rests, time[rests], side)
        return found

    def _find_echoes(self, found: Positions, n: NDArray[np.intp], time: Floats, side: Side) -> None:
        """Set the piece whose echo is the load, for those times (s) that lie in a rest: entries n of `found`.

        At its edges a rest takes the exact phase of the piece beside it. The time in seconds would give it only to rounding, which
        could turn the limit from one side into that from the other.
        """
        last, store = found.last[n], self.store
        trip = (store.trip[last] - self.epoch.trip).astype(float)
        trips = trip + np.floor((time + self.epoch.offset - trip * self.round_trip_time) / self.round_trip_time)
        phase = time + self.epoch.offset - trips * self.round_trip_time
        beside = last if side == "right" else np.minimum(last + 1, len(self) - 1)
        edge, known = (self.end, store.phase_to) if side == "right" else (self.start, store.phase_from)
        here = (time == edge[beside]) & ((beside > last) | (side == "right"))
        trips = np.where(here, store.trip[beside] - self.epoch.trip, trips)
        phase = np.where(here, known[beside], phase)
        if side == "left":
            trips, phase = np.where(phase <= 0.0, trips - 1.0, trips), np.where(phase <= 0.0, self.round_trip_time, phase)
        else:
            past = phase >= self.round_trip_time
            trips, phase = np.where(past, trips + 1.0, trips), np.where(past, 0.0, phase)
        self._set_echoes(found, n, trips + self.epoch.trip, phase, side)

    def _set_echoes(self, found: Positions, n: NDArray[np.intp], trip: Floats, phase: Floats, side: Side) -> None:
        piece = self.phases.latest(phase, found.last[n], side)
        known = piece >= 0
        n, piece, trip, phase = n[known], piece[known], trip[known], phase[known]
        found.piece[n], found.leaped[n] = piece, trip - self.store.trip[piece]
        found.xi[n] = self.xi(piece, phase - self.store.phase_from[piece])

    def just_before(self, piece: Integers) -> Positions:
        """Return the positions of the left limits at the starts of pieces."""
        last = np.maximum(piece - 1, 0)
        found = Positions(last.copy(), np.where(piece > 0, 1.0, 0.0), np.zeros(len(piece)), piece == 0, last)
        n = np.flatnonzero(self.rests[last] & (piece > 0))
        if n.size:
            trip, phase = self.store.trip[piece[n]].astype(float), self.store.phase_from[piece[n]]
            at_edge = phase == 0.0
            self._set_echoes(found, n, trip - at_edge, np.where(at_edge, self.round_trip_time, phase), "left")
        return found

    @cached_property
    def phases(self) -> Phases:
        """The index of the pieces by phase."""
        return Phases.of(self.store, self.round_trip_time)

    def standing(self, trip: int) -> tuple[NDArray[np.intp], Floats, Floats]:
        """Return the pieces whose waves are in the body at the end of a round trip.

        The pieces are in order of phase; the other arrays hold the first and the last offset (s) of each.
        """
        first, past = (int(np.searchsorted(self.store.trip, trip, side=side)) for side in ("left", "right"))
        own = np.arange(first, past)
        low, high = self.store.phase_from[own], self.store.phase_to[own]
        if len(own) and low[0] == 0.0 and high[-1] == self.round_trip_time and not self.rests[own[:-1]].any():
            return own, low, high
        return self.phases.standing(past - 1)

    def echo_edges(self, begin: float, end: float, most: int) -> Floats:
        """Return the times (s) between `begin` and `end` when echoes of recorded pieces begin while the contact rests.

        If there are more than `most` of them, round trips of a rest after the second have only the times of the smallest and the
        largest load, which show how far it swings, and some of these trips are left out evenly. The result is empty if there are
        more than `most` rests.
        """
        behind = np.append(self.start[1:], self.span[1])
        rests = np.flatnonzero(self.rests & (self.end < end) & (behind > begin))
        if not 0 < len(rests) <= most:
            return np.empty(0)
        lows, highs = np.maximum(begin, self.end[rests]), np.minimum(end, behind[rests])
        phases = [self.phases.standing(int(n))[1] for n in rests]
        last = np.floor((highs - lows) / self.round_trip_time) + 1.0
        step = np.ceil(2.0 * last.sum() / most) if last @ [len(one) for one in phases] > most else 0.0
        found: list[Floats] = []
        for low, high, phase, past in zip(lows, highs, phases, last, strict=True):
            first = np.floor((low + self.epoch.offset) / self.round_trip_time) + self.epoch.trip
            whole = np.arange(2.0 if step else past + 1.0)
            edges = self.seconds(first + whole[:, None], phase).ravel()
            if step and past > 2.0:
                trips = np.append(np.arange(2.0, past, step), past)
                edges = np.append(
                    edges, self.seconds(first + trips[:, None], self._extreme_phases(np.asarray(first + 1.0), phase)).ravel()
                )
            found.append(edges[(edges > low) & (edges < high)])
        return np.concatenate(found)

    def _extreme_phases(self, trip: Floats, edges: Floats) -> Floats:
        """Return the offsets (s) of the smallest and largest load in a whole round trip at rest, with echoes at these `edges`."""
        inside = np.linspace(edges, np.append(edges[1:], self.round_trip_time), 8).T.ravel()
        left, right = (self.excess(self.find(self.seconds(trip, inside), side)) for side in ("left", "right"))
        return inside[[int(np.minimum(left, right).argmin()), int(np.maximum(left, right).argmax())]]

    @cached_property
    def rests(self) -> NDArray[np.bool_]:
        """True for each piece after which the contact rests, unrecorded, until the next piece or the end of the run."""
        trip, start, end = self.store.trip, self.store.phase_from, self.store.phase_to
        follows = np.diff(trip) * self.round_trip_time + (start[1:] - end[:-1])
        last = trip[-1:] * self.round_trip_time + end[-1:]
        return np.append(follows, self.duration - last) > OFFSET_ROUNDING * np.append(
            np.full(len(follows), self.round_trip_time), last
        )

    def placed(self, at: Positions) -> tuple[Integers, Floats]:
        """Return the round trips and offsets (s) of positions."""
        store, piece, xi = self.store, at.piece, at.xi
        inside = store.phase_from[piece] + xi * (store.speed[piece] + xi * store.bend[piece])
        return store.trip[piece] + at.leaped.astype(np.int64), np.where(xi == 1.0, store.phase_to[piece], inside)

    def lasting(self, begin: Positions, end: Positions) -> Floats:
        """Return the time between pairs of positions (s), without the rounding of either."""
        (trip, offset), (later_trip, later_offset) = self.placed(begin), self.placed(end)
        return np.asarray((later_trip - trip) * self.round_trip_time + (later_offset - offset))

    def times_inside(self, at: Positions) -> tuple[Floats, Floats]:
        """Return the times of positions (s since the start of the run), and a time inside the piece of each."""
        store = self.store
        middle = store.phase_from[at.piece] + 0.5 * store.speed[at.piece] + 0.25 * store.bend[at.piece]
        trip, offset = self.placed(at)
        inside = np.where(at.before, offset, middle)
        return np.asarray(trip * self.round_trip_time + offset), np.asarray(trip * self.round_trip_time + inside)

    def xi(self, piece: NDArray[np.intp], local: Floats) -> Floats:
        """Return the place xi in [0, 1] of a time `local` s after the start of a piece."""
        speed, bend = self.store.speed[piece], self.store.bend[piece]
        root = np.sqrt(np.maximum(speed * speed + 4.0 * bend * local, 0.0))
        pace = speed + root  # zero only at the very start of a piece that starts at a fold
        return np.clip(2.0 * local / np.where(pace > 0.0, pace, 1.0), 0.0, 1.0)

    @cached_property
    def machine(self) -> MotionInParts:
        """The motion of the driver, if it is a machine or a damper."""
        from stickslip.engine.history.damper_motion import damper_motion  # of few runs
        from stickslip.engine.history.machine_motion import machine_motion

        motion = damper_motion if self.problem.body.is_damped else machine_motion
        return motion(self.problem, self.store, self.duration)

    # ---- values at positions ------------------------------------------------------------------------------------------------

    def excess(self, at: Positions) -> Floats:
        """Return the load minus the reference strength (Pa, N or N m)."""
        value = values_at(self.store.load, at.piece, at.xi)
        if at.at_rest.any():
            left = 2.0 * self.problem.body.echo_impedance * values_at(self.store.rate, at.piece, at.xi)
            value = np.where(at.at_rest, value - left, value)
        return np.where(at.before, self.problem.excess, value + self._gained(at))

    def _gained(self, at: Positions) -> Floats:
        """Return the growth of the load over the round trips at rest since it was recorded."""
        if not self.problem.varies or not at.at_rest.any():
            return at.leaped * self.ramp
        offset = self.store.phase_from[at.piece] + at.xi * (self.store.speed[at.piece] + at.xi * self.store.bend[at.piece])
        return driver_of(self.problem).gathered(self.problem, self.store.trip[at.piece].astype(float), offset, at.leaped)

    def rate(self, at: Positions) -> Floats:
        """Return the slip rate, m/s."""
        sliding = np.where(at.at_rest, 0.0, values_at(self.store.rate, at.piece, at.xi))
        return np.where(at.before, self.problem.rate, sliding)

    def mode(self, at: Positions) -> Integers:
        """Return the mode of the contact: 0 at rest, +1 in forward slip, -1 in backward slip."""
        return np.where(at.at_rest, 0, self.store.mode[at.piece])

    def grown(self, at: Positions) -> Floats:
        """Return the slip since the start of the piece, m."""
        return integrals_at(self.store.rate, self.store.speed, self.store.bend, at.piece, at.xi)

    def slipped(self, at: Positions) -> Floats:
        """Return the slip since the start of the run, m."""
        at = at.recorded()
        return np.where(at.before, 0.0, self.store.slip[at.piece] + self.grown(at))

    def slipped_since(self, origin: Positions, at: Positions) -> Floats:
        """Return the slip since one position, m.

        The sum begins at that position, so that it has full precision however large the slip before it is.
        """
        origin, at = origin.recorded(), at.recorded()
        begin = int(origin.piece[0])
        first, last = min(begin, int(at.piece.min())), max(begin, int(at.piece.max()))
        crossed = np.arange(first, last)
        pieces, places = (np.concatenate(parts) for parts in ((crossed, origin.piece, at.piece), (crossed >= 0, origin.xi, at.xi)))
        grown = self.grown(Positions.inside(pieces, places))
        earlier, later, behind = np.split(grown, [begin - first, last - first])
        sums = np.concatenate([-np.cumsum(earlier[::-1])[::-1], [0.0], np.cumsum(later)])
        return np.where(at.before, -self.slipped(origin), sums[at.piece - first] + (behind[1:] - behind[0]))

    def slipped_within(self, begin: Positions, end: Positions) -> Floats:
        """Return the slip from each of several recorded positions to a later one, m, with the precision of `slipped_since`."""
        past = np.cumsum(end.piece - begin.piece)
        crossed = np.arange(past[-1] if len(past) else 0) + np.repeat(end.piece - past, end.piece - begin.piece)
        blocks = np.array_split(crossed, len(crossed) // PIECES_IN_CACHE + 1)
        whole = np.concatenate([self.grown(Positions.inside(block, 1.0)) for block in blocks])
        sums = np.empty(len(past))
        add_up(whole, past, sums)
        return sums + (self.grown(end) - self.grown(begin))

    def states(self, at: Positions) -> list[Floats]:
        """Return each state of the law that the contact obeys (`Problem.contact_law`) as its formulas see it in forward slip."""
        known = self.store.state
        return [
            np.where(at.before, start, values_at(known[:, n], at.piece, at.xi))
            for n, start in enumerate(self.problem.contact_states)
        ]

    def state(self, at: Positions) -> Any:
        """Return the states as the one argument of `FrictionLaw.coefficient`; 0 for a law without a state."""
        return one_argument(self.states(at))

    def law_slip(self, at: Positions) -> Floats:
        """Return the slip that the friction law sees, m."""
        grown = self.grown(at)
        walked = self.mode(at) * grown if self.problem.friction.counts == "path" else grown
        return np.where(at.before, self.problem.law_slip, self.problem.law_slip + self.store.law_slip[at.piece] + walked)

    def resistance(self, at: Positions) -> Floats:
        """Return the traction of the law against slip, S mu(u, |v|, state) (Pa, N or N m)."""
        law, states = self.problem.contact_law, self.states(at)
        for n in law.reverses:
            states[n] = np.where(self.mode(at) < 0, -states[n], states[n])
        slip = self.law_slip(at) if law.depends_on_slip else 0.0
        place = (slip, np.abs(self.rate(at)), one_argument(states))
        mu = law.coefficient(*place)
        if law.backward_from:
            mu = np.where(self.mode(at) < 0, law.ways[1].coefficient(*place), mu)
        return np.asarray(self.problem.normal * mu)

    def friction(self, at: Positions) -> Floats:
        """Return the friction traction minus the reference strength, with the sign of the load."""
        body = self.problem.body
        if not body.has_inertia:
            return self.excess(at) - body.damping * self.rate(at)
        mode = self.mode(at)
        by_law = np.where(mode < 0, -1.0, 1.0) * self.resistance(at) - self.problem.strength
        held = (mode == 0) | (at.before & (self.problem.rate == 0.0))
        if self.problem.friction.reverses or not held.any():  # a state that reverses holds a traction at rest, too
            return by_law
        return np.where(held, self.excess(at), by_law)
