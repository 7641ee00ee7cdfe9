"""A rigid block that slides on shaken ground, for as many yield accelerations as are asked for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from stickslip.extensions.strong_motion.compiled.rigid_block import (
    ACCELERATION,
    ANSWER_COLUMNS,
    BLOCK_PLACE,
    CHANGE,
    PIECES,
    SAMPLES_OF_A_BLOCK,
    SLIPS,
    START,
    VELOCITY,
    LoadOnBlock,
    slide_blocks,
)
from stickslip.foundation.arrays import Floats

MOST_IN_A_SLIP = 4
"""Largest number of pieces that a slip adds to those of its segments: its start, and its stop."""
NOTHING = np.empty((0, CHANGE + 1))
"""No room for pieces of a motion."""


@dataclass(frozen=True, eq=False)
class BlockMotion:
    """The motion of a rigid block as pieces, each a cubic from its START on."""

    pieces: Floats

    def _since(self, t: ArrayLike) -> tuple[Floats, Floats]:
        time = np.asarray(t, float)
        found = self.pieces[np.searchsorted(self.pieces[:, START], time, side="right") - 1]
        return found, time - found[..., START]

    def displacement(self, t: ArrayLike) -> Floats:
        """Return the displacement (m) relative to the ground at times (s) of any shape, 0 or later."""
        piece, s = self._since(t)
        slope = 0.5 * piece[..., ACCELERATION] + s * piece[..., CHANGE] / 6.0
        return np.asarray(piece[..., BLOCK_PLACE] + s * (piece[..., VELOCITY] + s * slope))

    def velocity(self, t: ArrayLike) -> Floats:
        """Return the velocity (m/s) relative to the ground at times (s) of any shape, 0 or later."""
        piece, s = self._since(t)
        return np.asarray(piece[..., VELOCITY] + s * (piece[..., ACCELERATION] + 0.5 * s * piece[..., CHANGE]))


@dataclass(frozen=True, eq=False)
class ShakenBlock:
    """A rigid block under a load per mass (m/s^2) at even intervals (s): positive loads push it forward."""

    load: Floats
    interval: float

    @cached_property
    def _prepared(self) -> LoadOnBlock:
        load = np.ascontiguousarray(self.load, float)
        starts = np.arange(0, len(load), SAMPLES_OF_A_BLOCK)
        extremes = np.column_stack([np.maximum.reduceat(load, starts), np.minimum.reduceat(load, starts)])
        return LoadOnBlock(load, np.ascontiguousarray(extremes), float(self.interval))

    def slide(self, forward: Floats, backward: Floats | float = math.inf) -> Floats:
        """Return the answers for yield accelerations (m/s^2), a row each; by default the block never slides backward."""
        yields = np.ascontiguousarray(np.column_stack(np.broadcast_arrays(np.asarray(forward, float), backward)), float)
        answers = np.zeros((len(yields), ANSWER_COLUMNS))
        slide_blocks(self._prepared, yields, answers, NOTHING)
        return answers

    def motion(self, forward: float, backward: float = math.inf) -> BlockMotion:
        """Return the motion under one pair of yield accelerations (m/s^2)."""
        slips = int(self.slide(np.array([forward]), backward)[0, SLIPS])
        pieces, answers = np.zeros((len(self.load) + MOST_IN_A_SLIP * (slips + 1), CHANGE + 1)), np.zeros((1, ANSWER_COLUMNS))
        slide_blocks(self._prepared, np.array([[forward, backward]]), answers, pieces)
        return BlockMotion(pieces[: int(answers[0, PIECES])])
