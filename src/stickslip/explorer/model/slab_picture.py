"""The inside of the slab in space and time, with the wave fronts that leave its contact."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import SlabPicture
from stickslip.explorer.model.shown import Shown
from stickslip.foundation.errors import InputError
from stickslip.observables.field import slab_of
from stickslip.solution.fronts import fronts_of

TIMES, PLACES = 240, 60
"""Largest numbers of times and of places of the picture."""


def slab_picture(shown: Shown) -> SlabPicture | None:
    """Return the picture of a slab; None for a block, and where its waves are not known because the run leaped over creep."""
    readings = shown.readings
    if not readings.problem.body.has_waves:
        return None
    body = slab_of(readings.problem)
    time, place = np.linspace(shown.start, shown.end, TIMES), np.linspace(0.0, body.thickness, PLACES)
    try:
        found = readings.field(place, time[:, None])
    except InputError:
        return None
    fronts = []
    for times in fronts_of(readings, shown.start, shown.end):
        corners = np.column_stack([times + shown.begin, np.where(np.arange(len(times)) % 2, body.thickness, 0.0)])
        fronts.append(corners)
    displacement = found.displacement - found.displacement[0]
    return SlabPicture(time + shown.begin, place, displacement, found.velocity, found.stress, tuple(fronts))
