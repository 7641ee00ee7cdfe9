"""The return of a body with waves as a map of vectors, and its derivative: a matrix, or by differences of runs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.extensions.cycles.waves.krylov import Operator
from stickslip.extensions.cycles.waves.section import WavePlace, WaveReturn, WaveSection
from stickslip.extensions.cycles.waves.slopes_of_return import is_known, slopes_of
from stickslip.foundation.arrays import Floats

SMALL_NUDGE, FINE_NUDGE = 1e-6, 5e-6
"""Sizes of disturbances (1, shares of the extent): to one side for Newton's iteration, to both for multipliers."""
MOST_COLUMNS = 800
"""The derivative of a return is a matrix up to this number of rows (1): a larger one takes longer than differences of runs."""


@dataclass(frozen=True)
class Image:
    """The return as a map of vectors: states and wave at the points of the mesh of a place, over their extents."""

    place: WavePlace
    guess: float

    @cached_property
    def scale(self) -> Floats:
        """The extents of its numbers and of its wave."""
        return self.place.scale

    @cached_property
    def start(self) -> Floats:
        """The place itself."""
        return self.place.vector / self.scale

    def of(self, vector: Floats, section: WaveSection) -> tuple[Floats, WaveReturn]:
        """Return where a start on a section goes, and its run."""
        place = self.place.moved_to(vector * self.scale).over(section.problem.round_trip_time)
        met = section.returned(place, self.guess)
        return met.on(place.mesh).vector / self.scale, met


def slopes_at(met: WaveReturn) -> Floats | None:
    """Return the derivative of a return over the scales of its `Image`; None if its run does not tell it."""
    scale = Image(met.start, met.time).scale
    return slopes_of(met, scale) if len(scale) <= MOST_COLUMNS and is_known(met) else None


def grown(image: Image, section: WaveSection) -> Operator:
    """Return what disturbances of a place become, by differences of two runs."""

    def along(way: Floats) -> Floats:
        step = FINE_NUDGE / np.abs(way).max()
        ends = [image.of(image.start + sign * step * way, section)[0] for sign in (1.0, -1.0)]
        return np.asarray((ends[0] - ends[1]) / (2.0 * step))

    return along


def difference(image: Image, section: WaveSection, missed: Floats) -> Operator:
    """Return the derivative of the miss of a return, by differences from the miss at the place itself."""

    def along(way: Floats) -> Floats:
        step = SMALL_NUDGE / np.abs(way).max()
        at = image.start + step * way
        return np.asarray((image.of(at, section)[0] - at - missed) / step)

    return along


def missed_share(met: WaveReturn) -> float:
    """Return by what share (1) of the extent a return misses its start."""
    start = Image(met.start, met.time)
    return float(np.abs(met.landed.vector / start.scale - start.start).max())
