"""What every leap is once it has been found: it writes itself into the history, and says what comes behind it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.state.layout import TERMS, Floats, HistoryPiece

ROUNDING_OF_NUMBER = 4e-16
"""Rounding of a number, as a share of it."""
SHORTEST_LEAP = 16
"""Fewest round trips of a leap that is worth its cost."""


class Landing(Protocol):
    """A leap over creep, sliding or cycles, ready to be written."""

    may_rest: ClassVar[bool]
    """True if the contact may rest where the leap lands, and the engine passes over round trips of rest by itself."""

    @property
    def trips(self) -> int:
        """The number of round trips that are leaped over; a block's are periods."""
        ...

    @property
    def errors(self) -> tuple[float, float]:
        """The bound or the estimate of the error of the slip (m), and that as a time (s)."""
        ...

    def write(self, run: LeapingRun) -> None:
        """Write the leap into the history of a run, and set the engine to its end."""
        ...

    def expected(self, run: LeapingRun, slip: float, trips: int, tolerance: float) -> tuple[float, float]:
        """Return the slip (m) that is expected some exact round trips after the landing at a slip (m), and how far it may be off.

        The run has computed these round trips.
        """
        ...


class LookedFor(NamedTuple):
    """Hold what came of looking for a leap over sliding."""

    landing: Landing | None
    at_end: bool = False
    """True if a longer run might leap, or leap farther."""
    cost: int = 0
    """Of looking, in round trips that could have been computed meanwhile."""


class WrittenMotion(NamedTuple):
    """The motion in a piece, as polynomials of which the last terms may be left out."""

    mode: int
    law_piece: int
    load: Sequence[float] | Floats
    """Pa or N, minus the reference strength."""
    rate: Sequence[float] | Floats
    """m/s."""
    states: Sequence[Sequence[float]] | Floats = ()


def write_piece(run: LeapingRun, n: int, when: tuple[int, float, float], motion: WrittenMotion) -> None:
    """Write piece n: a motion from where the contact is, in a round trip and between two phases (s)."""
    trip, begin, end = when
    store, kept = run.store, HistoryPiece(run.store.pieces[n])
    kept.trip, kept.mode, kept.law_piece = trip, motion.mode, motion.law_piece
    kept.jump, kept.cause, kept.echo_of = 0, 0, -1
    kept.phase_from, kept.phase_to, kept.speed, kept.bend = begin, end, end - begin, 0.0
    kept.slip, kept.law_slip = run.state.slip_now, run.state.law_slip
    kept.amplified, kept.gain, kept.residual = np.nan, np.nan, 0.0  # a leap has an error bound of its own
    of_states = [(store.state[n, k], terms) for k, terms in enumerate(motion.states)]
    for row, terms in ((store.load[n], motion.load), (store.rate[n], motion.rate), *of_states):
        row[: len(terms)], row[len(terms) :] = terms, 0.0


def seen(load: Floats, strength: float, direction: int) -> Floats:
    """Convert loads (terms last) minus the reference strength between signed values and values in the direction of slip.

    The conversion is its own inverse.
    """
    turned = direction * load
    if direction < 0:
        turned[..., 0] -= 2.0 * strength
    return turned


def integrals(p: Floats, speed: Floats, bend: Floats) -> Floats:
    """Return the integrals of polynomials in xi over time: d theta = (speed + 2 bend xi) d xi."""
    powers = np.arange(1, TERMS + 1)
    return np.asarray(speed * (p / powers).sum(axis=1) + 2.0 * bend * (p / (powers + 1)).sum(axis=1))


def move(run: LeapingRun, slip: float) -> None:
    """Move the contact on by a slip (m), with its sign."""
    run.state.slip_now += slip
    run.state.law_slip += slip if run.problem.friction.counts == "net" else abs(slip)


def move_over(run: LeapingRun, n: int) -> None:
    """Move the contact to the end of piece n, whose motion has been written."""
    store, one = run.store, slice(n, n + 1)
    move(run, float(integrals(store.rate[one], store.speed[one], store.bend[one])[0]))


def continue_after(run: LeapingRun, trip: int, first: int, length: int, states: Floats) -> None:
    """Set the engine to the end of a round trip, whose pieces have been written from `first` up to `length`, in these states."""
    state, count, store = run.state, run.count, run.store
    state.rate_now, state.load_now = store.rate[length - 1].sum(), store.load[length - 1].sum()
    for k, value in enumerate(states):
        state.state_now[k] = value
    count.length = count.previous_to = count.trip_from = length
    count.previous_from, count.trip = first, trip + 1
    count.source = count.moved = count.trips_at_rest = count.leaving_rest = count.jump = count.cause = count.stalled = 0
