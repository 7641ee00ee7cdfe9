"""The linear equation of Newton's iteration along a branch: a return is to meet its start, in a plane across the branch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from stickslip.extensions.cycles.path import NoCycleError
from stickslip.extensions.cycles.waves.image import Image
from stickslip.extensions.cycles.waves.krylov import Operator, solved
from stickslip.extensions.cycles.waves.orbit import MOST_DIRECTIONS
from stickslip.extensions.cycles.waves.section import WavePlace, WaveReturn
from stickslip.foundation.arrays import Floats


@dataclass(frozen=True)
class Bordered:
    """The derivative of the miss of a return by start and parameter, with a plane as its last row."""

    image: Image
    """The place on a section where it is taken."""
    slopes: Floats | None
    """The derivative of the return by its start, if it is known from the run."""
    grown: Operator
    """The derivative of the miss by differences of runs, for where it is not known."""
    by_value: Floats
    """The derivative of the miss by the parameter over its range."""
    plane: Floats
    """The row of the plane, by start and parameter."""

    def step(self, now: WaveReturn, off: float, accuracy: float) -> tuple[WavePlace, float]:
        """Return the start after a step of Newton's from a return that is `off` the plane, and the change of the parameter."""
        scale, mesh = self.image.scale, self.image.place.mesh
        missed = now.start.moved_to(now.landed.vector - now.start.vector).on(mesh).vector / scale
        change = self.solve(np.append(-missed, -off), accuracy)
        moved = self.image.place.moved_to(change[:-1] * scale).on(now.start.mesh)
        return now.start.moved_to(now.start.vector + moved.vector), float(change[-1])

    def ahead(self, accuracy: float) -> tuple[WavePlace, float]:
        """Return the direction of the branch: a change of the start, and one of the parameter."""
        right = np.zeros(len(self.plane))
        right[-1] = 1.0
        change = self.solve(right, accuracy)
        return self.image.place.moved_to(change[:-1] * self.image.scale), float(change[-1])

    def solve(self, right: Floats, accuracy: float) -> Floats:
        """Return x of the linear equation; by differences of runs up to a share (1) of its size. Raises NoCycleError."""
        if self.slopes is None:
            return solved(self._of, right, accuracy, MOST_DIRECTIONS)[0]
        count = len(self.by_value)
        matrix = np.empty((count + 1, count + 1))
        matrix[:count, :count], matrix[:count, count], matrix[count] = self.slopes - np.eye(count), self.by_value, self.plane
        try:
            return np.asarray(np.linalg.solve(matrix, right))
        except np.linalg.LinAlgError:
            raise NoCycleError("follow: the cycles near here cannot be told apart") from None

    def _of(self, change: Floats) -> Floats:
        here = self.grown(change[:-1]) if change[:-1].any() else np.zeros(len(self.by_value))
        return np.append(here + change[-1] * self.by_value, self.plane @ change)
