"""A driver that changes by steps: the share of a wave that it sends back is that of the moment when the wave has met it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from stickslip.engine import Floats, Integers
from stickslip.foundation.constants import RIGID
from stickslip.problem import inflow_of
from stickslip.solution.observables.driver_of_waves import DriverBehind, DriverOfLayers, DriverOfWaves


class ChangingBehindSlab(DriverOfWaves):
    """A driver that changes, behind a uniform body."""

    by_storing = True

    @property
    def steps(self) -> tuple[tuple[float, float], ...]:
        """The times of its changes and the shares from then on."""
        return self.problem.driver_steps

    def share_at(self, time: Floats) -> Floats:
        """Return the share of the moment."""
        return self.inflow.reflection_at(time)

    def impedance_at(self, time: Floats) -> Floats:
        """Return the impedance that has this share."""
        share = np.asarray(self.share_at(time))
        lossy = share != RIGID
        return np.where(lossy, self.body.impedance * (1.0 - share) / np.where(lossy, 1.0 + share, 1.0), 0.0)

    def shears_at(self, time: float) -> float:
        """Return its pull rate while it is rigid."""
        half = 0.5 * self.body.two_way_time
        rigid = self.share_at(np.array(time - half) + self.body.two_way_time) == RIGID
        return float(self.problem.pull_rate_at(time)) if rigid else 0.0


class ChangingBehindLayers(DriverOfLayers):
    """A driver that changes, behind layers."""

    def share_at(self, time: Floats) -> Floats:
        """Return the share of the moment."""
        return inflow_of(self.problem).reflection_at(time)

    @cached_property
    def turned(self) -> tuple[Integers, Floats, Floats]:
        """Its changes, which come with the segments of the inflow."""
        inflow = inflow_of(self.problem)
        trips, phases = np.array(inflow.breaks()).T
        by = -np.diff(inflow.reflection, prepend=inflow.reflection[0])
        changes = by != 0.0
        return trips[changes].astype(np.int64), phases[changes], by[changes]

    def shears_at(self, time: float) -> float:
        """Return its pull rate while it is rigid, if it has been so at first."""
        rigid = self.body.is_driven_rigidly & (self.share_at(np.array(time + self.body.inflow_delay)) == RIGID)
        return float(self.problem.pull_rate_at(time)) if rigid else 0.0


ANSWERS = DriverBehind(ChangingBehindSlab, ChangingBehindLayers)
