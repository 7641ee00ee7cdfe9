"""Define what kernels are given of the members of a batch, and what a lane is doing."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

from stickslip.engine.state.layout import Floats, Integers


class Setups(NamedTuple):
    """The input of the engine for members that differ in numbers only.

    The engine's tables (see `engine.state.layout.Setup`) have one row for each member, or a single row if all members share it.
    """

    params: Floats  # (members, numbers of Params)
    jets: Integers  # (3 pieces,): addresses of the formulas' series, radii and values in lanes; (0,) if members step alone
    constants: Floats  # (members, pieces, size)
    law: Integers  # (members, pieces of the law, LawPiece.total)
    branch_table: Floats  # (members, largest number of branches, Branch.total); for member n the first branches[n] are filled
    first_load: Floats  # (members, pieces of the first load + 1, FirstLoad.total)
    branches: Integers  # (members,): number of branches; 0 if Z v + S mu does not rise at high rates, -1 if more than MOST_BRANCHES
    irregular: Floats  # (members,): 1 if several slip rates solve the contact equation at some load, otherwise 0
    state: Floats  # at t = 0, the same for all members
    counts: Integers  # at t = 0, the same for all members
    last_trip: Integers  # (members,): the last round trip of each run
    last_phase: Floats  # (members,): the offset (s) of its end in this round trip
    duration: Floats  # (members,), s
    threshold: Floats  # (members,): slip above this rate (m/s) is an event
    stiffness: Floats  # (members,): Pa/m for a slab, N/m for a block
    excess: Floats  # (members,): initial load minus static strength, Pa or N


class LaneStage(IntEnum):
    """Say what a lane is doing."""

    FREE = 0
    """It has no member."""
    UNDER_WAY = 1
    """Its member is running."""
    AT_END = 2
    """The run of its member has ended and is not reduced yet."""
