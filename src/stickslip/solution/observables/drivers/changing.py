"""A driver that changes by steps: the share of a wave that it sends back is that of the moment when the wave has met it."""

from __future__ import annotations

import numpy as np

from stickslip.engine import Floats
from stickslip.foundation.constants import RIGID
from stickslip.solution.observables.driver_of_waves import BehindLayers, BehindSlab, DriverBehind


class ChangingBehindSlab(BehindSlab):
    """A driver that changes, behind a uniform body."""

    by_storing = True

    def impedance_at(self, time: Floats) -> Floats:
        """Return the impedance that has the share of the moment."""
        share = self.share_at(time)
        lossy = share != RIGID
        return np.where(lossy, self.body.impedance * (1.0 - share) / np.where(lossy, 1.0 + share, 1.0), 0.0)


ANSWERS = DriverBehind(ChangingBehindSlab, BehindLayers)
