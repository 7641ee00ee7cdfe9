"""Pictures of the inside of a body of layers, and of its energy, from the exact field."""

from __future__ import annotations

import numpy as np

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.sampled_waves import ShownInterval
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables import extent_of

COLUMNS, ROWS = 160, 60
"""Numbers of times and of places of the picture."""
MOST_REPLAYED = 4_000_000
"""Largest number of pieces times cells times columns for which the inside is drawn: that takes some seconds."""


def picture_of_layers(shown: ShownInterval) -> SlabPicture | None:
    """Return the picture of the inside of layers, on both sides of the contact; None if it would take too long.

    Velocities are means over the time of a cell, and stresses those at its middle. Fronts are not drawn: they split where layers
    meet.
    """
    readings = shown.readings
    extent = extent_of(readings.problem)
    if not is_short(shown):
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


def is_short(shown: ShownInterval) -> bool:
    """Return True if the waves of an interval of a run are soon replayed."""
    history = shown.readings.history
    body = history.problem.body
    assert isinstance(body, OfLayers)
    return len(history) * sum(body.cells.counts) * COLUMNS <= MOST_REPLAYED
