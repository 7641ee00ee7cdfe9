"""The generator of the tables against itself with other digits, a balance of impulse, and a march that knows nothing of pieces."""

from __future__ import annotations

import math
from bisect import bisect_right
from itertools import islice

import pytest
from mpmath import mp, mpf, quad

from tests.core.engine.truth.slab_events import ALPHA_ONE, JUST_ABOVE_CRITICAL, Contact, Event, Piece, Ring, Slab, Slips, Table

FAST = Slab(alpha=1.0, pull_rate=0.1234)
"""Pulled so fast that hundreds of events of all kinds (ended by the echo, by folds, fragments) come within 400 round trips."""


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("table", [ALPHA_ONE, JUST_ABOVE_CRITICAL], ids=lambda table: table.name)
@pytest.mark.parametrize("digits", [50, 60])
def test_the_files_hold_what_the_generator_makes(table: Table, digits: int) -> None:
    stored = table.read()
    assert len(stored) == table.count
    made = table.rows(15, digits)
    assert [tuple(row.values()) for row in stored[:15]] == made


@pytest.mark.slow
def test_slip_sheds_load_as_impulse_says() -> None:
    """The load of a whole round trip, by the forward maps at each phase, falls by 2 Z slip; to 1e-18 of what has been shed."""
    with mp.workdps(30):
        contact = FAST.contact()
        ring = Ring(contact)
        shed = 2 * contact.impedance * sum(event.slip for event in islice(ring.events(), 60))
        row = max(piece.row for piece in pieces(ring))
        left = sum(quad(lambda theta, p=piece: load(contact, p, row, theta), [piece.start, piece.end]) for piece in pieces(ring))
        brought = (row + mpf(1) / 2) * contact.ramp * contact.round_trip
        assert abs(left - (brought - shed)) < mpf("1e-18") * shed


def pieces(ring: Ring) -> list[Piece]:
    """All pieces, from phase 0 on."""
    any_piece = ring.waiting[0][3]
    found = [any_piece]
    while found[-1].next is not any_piece:
        found.append(found[-1].next)
    return sorted(found, key=lambda piece: piece.start)


def load(contact: Contact, piece: Piece, row: int, theta: mpf) -> mpf:
    """The load at a phase of a piece at rest, forwards through the slips of its history."""
    rows: list[int] = []
    slips: Slips | None = piece.slips
    while slips is not None:
        rows.append(slips.row)
        slips = slips.before
    e, now = contact.ramp * theta / contact.round_trip, 0
    for slipped in reversed(rows):
        e, now = contact.echo(e + (slipped - now) * contact.ramp), slipped + 1
    return e + (row - now) * contact.ramp


@pytest.mark.slow
def test_independent_phases_slip_in_the_same_round_trips() -> None:
    """2 000 phases one after the other, in double precision: at each the contact slips iff an event says so.

    Until an event is so short that it falls between two of these phases: the first one in row 279.
    """
    rows, count = 270, 2_000
    with mp.workdps(30):
        events = []
        for event in Ring(FAST.contact()).events():
            if event.start_row >= rows:
                break
            events.append(event)
        phases = [float((i + mpf(1) / math.pi) * FAST.contact().round_trip / count) for i in range(count)]
        expected = slipping(events, phases, rows)
    assert len(events) > 60
    assert march(phases, rows) == expected


def slipping(events: list[Event], phases: list[float], rows: int) -> list[list[bool]]:
    """Whether each phase slips in each round trip, by the events."""
    starts = [(event.start_row, event.start_offset) for event in events]
    ends = [(event.end_row, event.end_offset) for event in events]
    found = []
    for row in range(rows):
        last = [bisect_right(starts, (row, phase)) - 1 for phase in phases]
        found.append([k >= 0 and (row, phase) < ends[k] for k, phase in zip(last, phases, strict=True)])
    return found


def march(phases: list[float], rows: int) -> list[list[bool]]:
    """The same by perfect delay from phase to phase: slip goes on while the load is not below the fold, rest while not above 0."""
    z, fall, alpha = 9.8e6, 5e7, FAST.alpha
    ramp, round_trip = 2 * z * FAST.pull_rate, 2e4 / 3500
    fold = -z / alpha * (math.sqrt(alpha * fall / z) - 1) ** 2
    loads = [ramp * phase / round_trip for phase in phases]
    slips, found = False, []
    for _ in range(rows):
        found.append([False] * len(phases))
        for i, e in enumerate(loads):
            slips = e >= fold if slips else e > 0.0
            found[-1][i] = slips
            half = ((fall + e) * alpha - z) / 2
            rate = (half + math.sqrt(half**2 + z * alpha * e)) / (z * alpha) if slips else 0.0
            loads[i] = e - 2 * z * rate + ramp
    return found
