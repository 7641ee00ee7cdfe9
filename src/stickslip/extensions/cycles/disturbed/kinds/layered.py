"""Bodies of layers: they carry a wave in each cell."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.extensions.cycles.disturbed.asked import KindWithWaves
from stickslip.foundation.arrays import Floats, Integers1

if TYPE_CHECKING:
    from stickslip.run import ExactRun

FIRST_ROW_OF_WAVES = 2
"""Rows of waves (1) before those of the history: of the piece of load, and of one that is set aside."""


class ComparedLayers(KindWithWaves):
    """Answers of a body of layers."""

    def rows(self, run: ExactRun) -> Integers1:
        """Return the rows of waves of the last round trip."""
        here, kept = self.standing(run), len(run.waves) - FIRST_ROW_OF_WAVES
        return np.asarray(FIRST_ROW_OF_WAVES + (np.arange(here.start, here.stop) + int(run.count.wave_shift)) % kept)

    def series(self, run: ExactRun) -> Floats:
        """Return the waves (Pa), and the rate (m/s) of a driver that is a machine."""
        return np.moveaxis(run.waves[self.rows(run)], 1, 0)

    def add_waves(self, run: ExactRun, series: Floats) -> None:
        """Add to the waves."""
        run.waves[self.rows(run), :, : series.shape[2]] += np.moveaxis(series, 0, 1)


ANSWERS = ComparedLayers()
