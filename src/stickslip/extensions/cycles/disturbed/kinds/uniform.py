"""Uniform bodies with waves: they carry the wave that left the contact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stickslip.extensions.cycles.disturbed.asked import KindWithWaves
from stickslip.foundation.arrays import Floats

if TYPE_CHECKING:
    from stickslip.run import ExactRun


class ComparedUniform(KindWithWaves):
    """Answers of a slab, string or column."""

    def series(self, run: ExactRun) -> Floats:
        """Return the wave 2 Z v - load (Pa)."""
        here = self.standing(run)
        return np.asarray(2.0 * run.params.impedance * run.store.rate[here] - run.store.load[here])[None]

    def add_waves(self, run: ExactRun, series: Floats) -> None:
        """Add to the wave, by its load."""
        run.store.load[self.standing(run), : series.shape[2]] -= series[0]


ANSWERS = ComparedUniform()
