"""What a replay of waves in layers works on: the slip of the contact, the cells, what drivers do, what is asked."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import Floats, Integers

Flags = NDArray[np.bool_]

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

    trip: Integers
    phase_from: Floats
    phase_to: Floats
    speed: Floats
    bend: Floats
    rate: Floats
    grown: Floats
    """Slip in the whole piece (m)."""
    moves: Flags
    """False for rest."""


class LadderCells(NamedTuple):
    """The cells, as arrays; see `layout.LadderCell`."""

    impedance: Floats
    reflection: Floats
    beyond: Floats
    """That for waves from the other side."""
    drag: Floats
    """Stress over velocity (Pa s/m) that drag takes at the far end of each cell."""
    ramp_share: Floats
    """Growth of the wave in a round trip of a settled rest, over that of the load."""
    wave: Floats
    growth: Floats
    starts: Integers
    """First cell of each side, and the number of cells."""
    strength: Floats
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

    phase: Floats
    trip: Integers
    sent: Floats
    """What drivers do: array over sides, VALUE, TOTAL, PULL and SHARE, round trips and phases."""
    ground: Floats
    """Velocity (m/s) of moving ground, and its way in the round trip (m): array over both, round trips and phases, or empty."""
    ramp: Floats
    """Growth of the load (Pa) in each round trip of the settled rest before each of these, and behind the last one."""
    turned: Floats
    """Changes of the first driver in order, one per row: round trip, which phase it is, and the share before less the one after."""


class WaveQueries(NamedTuple):
    """What is asked of a replay, and where the answers go."""

    asked: Integers
    """Round trip (at least -1) of each query, in order."""
    which: Integers
    """Phase of each query."""
    rows: Floats
    """E in each cell, and its integral, for each query; none if they are not asked for."""
    sums: Floats


class FollowedWaves(NamedTuple):
    """How far a replay has come: arrays whose last axis is that of the phases."""

    wave: Floats
    """E in each cell, and its integral behind it if that is followed, too."""
    sums: Floats
    growth: Floats
    """What each round trip of a settled rest adds to the sums."""
    slope: Floats
    """By how much the power of the drivers grows in each of these round trips, over the growth of the load."""
    slip: Floats
    """Slip rate of the contact (m/s), and its slip since the start of the round trip (m)."""
    counts: Integers
    """Round trip, next piece of the history, next query."""
    phase: Floats
    """Phases (s)."""
    ramp: Floats
    """Growth of the load (Pa) in each round trip of the present settled rest: one number."""
