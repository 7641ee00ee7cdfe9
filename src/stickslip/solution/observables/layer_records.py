"""What a replay of waves in layers works on: the slip of the contact, the cells, what drivers do, what is asked."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Flags1, Floats1, Floats2, Floats3, Floats4, Integers1

VALUE, TOTAL, PULL, SHARE = 0, 1, 2, 3
"""What drivers do: the load that they send, where it joins the waves (Pa), its integral in the round trip (Pa s), the driver's rate
(m/s), and the share (1) of the wave that is sent back.
"""
MOVED, MOVED_IN_TRIP, WORK, RADIATED, DRAGGED = range(5)
"""Sums of a replay: how far the face of the second side has moved (m), since the start and since that of the round trip, and the
work of the drivers, the energy radiated through them, and what drag has taken (J/m^2), integrated over time at one phase:
J/(m^2 s). Drag acts at odd places, T before the phase.
"""
SUMS = 5
"""Number of these sums (1)."""


class SlipPieces(NamedTuple):
    """The slip of the contact, as arrays over the pieces of the history: see `layout.Store`."""

    trip: Integers1
    phase_from: Floats1
    phase_to: Floats1
    speed: Floats1
    bend: Floats1
    rate: Floats2
    grown: Floats1
    """Slip in the whole piece (m)."""
    moves: Flags1
    """False for rest."""


class LadderCells(NamedTuple):
    """The cells, as arrays; see `layout.LadderCell`."""

    impedance: Floats1
    reflection: Floats1
    beyond: Floats1
    """That for waves from the other side."""
    drag: Floats1
    """Stress over velocity (Pa s/m) that drag takes at the far end of each cell."""
    ramp_share: Floats1
    """Growth of the wave in a round trip of a settled rest, over that of the load."""
    wave: Floats1
    growth: Floats1
    starts: Integers1
    """First cell of each side, and the number of cells."""
    strength: Floats1
    """Reference strength (Pa) of each side."""
    gain: float
    """Proportional gain of a driver that is a machine (Pa s/m); 0 if it is none."""
    joined: int
    delay: float
    """Time (s) from the driver to the place where waves are followed."""
    time: float
    """Time (s) of a cell."""


class FollowedTrips(NamedTuple):
    """Round trips that are replayed one by one, at several phases (s) together."""

    phase: Floats1
    trip: Integers1
    sent: Floats4
    """What drivers do: array over sides, VALUE, TOTAL, PULL and SHARE, round trips and phases."""
    ground: Floats3
    """Velocity (m/s) of moving ground, and its way in the round trip (m): array over both, round trips and phases, or empty."""
    ramp: Floats1
    """Growth of the load (Pa) in each round trip of the settled rest before each of these, and behind the last one."""
    turned: Floats2
    """Changes of the first driver in order, one per row: round trip, which phase it is, and the share before less the one after."""


class WaveQueries(NamedTuple):
    """What is asked of a replay, and where the answers go."""

    asked: Integers1
    """Round trip (at least -1) of each query, in order."""
    which: Integers1
    """Phase of each query."""
    rows: Floats3
    """E in each cell, and its integral, for each query; none if they are not asked for."""
    sums: Floats2


class FollowedWaves(NamedTuple):
    """How far a replay has come: arrays whose last axis is that of the phases."""

    wave: Floats3
    """E in each cell, and its integral behind it if that is followed, too."""
    sums: Floats2
    growth: Floats2
    """What each round trip of a settled rest adds to the sums."""
    slope: Floats1
    """By how much the power of the drivers grows in each of these round trips, over the growth of the load."""
    slip: Floats2
    """Slip rate of the contact (m/s), and its slip since the start of the round trip (m)."""
    counts: Integers1
    """Round trip, next piece of the history, next query."""
    phase: Floats1
    """Phases (s)."""
    ramp: Floats1
    """Growth of the load (Pa) in each round trip of the present settled rest: one number."""
    more: Floats1
    """Room for a number of each phase."""
