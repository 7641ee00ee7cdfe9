"""What the explorer shows of bodies of layers: their inside and their energy, from the exact field."""

from __future__ import annotations

from typing import cast

import numpy as np

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.pictures import exact_energies
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.extensions.explorer.model.with_waves import ShownWaves
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables import extent_of

COLUMNS, ROWS = 160, 60
"""Numbers of times and of places of the picture."""
MOST_REPLAYED = 4_000_000
"""Largest number of pieces times cells times columns for which the inside is drawn: that takes some seconds."""


class _ShownLayered(ShownWaves):
    def waves(self, shown: ShownInterval) -> SampledWaves | None:
        """Return nothing: they are replayed in cells."""
        return None

    def inside(self, shown: ShownInterval, waves: SampledWaves | None) -> SlabPicture | None:
        """Return the picture of the inside of layers, on both sides of the contact; None if it would take too long.

        Velocities are means over the time of a cell, and stresses those at its middle. Fronts are not drawn: they split where
        layers meet.
        """
        readings = shown.readings
        extent = extent_of(readings.problem)
        if not _is_short(shown):
            return None
        time, place = np.linspace(shown.start, shown.end, COLUMNS), np.linspace(extent.lowest, extent.highest, ROWS)
        edges = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])
        field = readings.field(place, time[:, None])
        moved = readings.field(place, edges[:, None]).displacement
        return SlabPicture(
            time + shown.begin,
            place,
            field.displacement - field.displacement[0],
            np.diff(moved, axis=0) / np.diff(edges)[:, None],
            field.stress,
            (),
            (*extent.boundaries, *((0.0,) if extent.lowest < 0.0 else ())),
        )

    def energies(self, shown: ShownInterval, waves: SampledWaves | None, time: Floats) -> dict[str, Floats] | None:
        return exact_energies(shown, time) if _is_short(shown) else None


def _is_short(shown: ShownInterval) -> bool:
    """Return True if the waves of an interval of a run are soon replayed."""
    history = shown.readings.history
    body = cast(OfLayers, history.problem.body)
    return len(history) * sum(body.cells.counts) * COLUMNS <= MOST_REPLAYED


ANSWERS = _ShownLayered()
