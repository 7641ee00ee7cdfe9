"""The waves in a body of layers over a round trip of a cell, from the history of a run: see `engine.waves.ladder`."""

from __future__ import annotations

import math
from functools import cached_property
from typing import ClassVar, cast

import numpy as np

from stickslip.extensions.cycles.waves.fronts import Fronts
from stickslip.extensions.cycles.waves.mesh import FADED, MOST_ECHOES, WaveSource, changes_in
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables import LayerWaves


class LayerSource(WaveSource):
    """The waves that left the even places of all cells, over the round trip of a cell that ends at a time (s)."""

    is_one_wave: ClassVar[bool] = False

    @cached_property
    def body(self) -> OfLayers:
        """The body."""
        return cast(OfLayers, self.history.problem.body)

    def at(self, phases: Floats) -> Floats:
        """Return the waves minus their shares of the reference strength (Pa) at phases (s), one cell after the other."""
        waves = LayerWaves(self.history, self.body)
        begin = self.end - self.history.round_trip_time
        return waves.waves(*waves.placed(begin + phases)).T.ravel()

    def kinks(self, period: float) -> Floats:
        """Return the phases (s) of their kinks, the sharpest first, in a motion that repeats itself after a period (s).

        All that an event has sent keeps its phase in all cells, and there are all events that have not faded.
        """
        changes, trip = changes_in(self.history, self.end, period), self.history.round_trip_time
        share = self.sharp_factor(self.end - period)
        many = min(math.ceil(math.log(FADED) / math.log(share)) if 0.0 < share < 1.0 else 1, MOST_ECHOES)
        ages = np.sort((self.end - changes[None, :] + period * np.arange(many)[:, None]).ravel())[: 2 * MOST_ECHOES]
        found = np.mod(trip - ages, trip)
        return found[(found > 0.0) & (found < trip)]

    def sharp_factor(self, begin: float) -> float:
        """Return what a disturbance that lasts an instant is multiplied by (1) from a time (s) to the end, in the mean."""
        return Fronts(self.history.problem, self.body).left_after(self.history, begin, self.end)
