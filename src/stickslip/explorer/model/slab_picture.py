"""The inside of the slab in space and time, with the wave fronts that leave its contact."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from stickslip.explorer.model.answer import Floats, SlabPicture
from stickslip.explorer.model.sampled_waves import SampledWaves
from stickslip.solution.fronts import fronts_of
from stickslip.solution.window import Window

COLUMNS, ROWS = 240, 60
"""Largest numbers of times and of places of the picture."""


def slab_picture(waves: SampledWaves) -> SlabPicture:
    """Return the picture of a slab.

    Velocity and stress are means over the time of a cell: a cell that a wave front passes lies between the values before and after,
    so that the edge follows the characteristic, and a pulse that is shorter than a cell is not passed over.
    """
    shown, thickness = waves.shown, waves.body.thickness
    time, place = np.linspace(shown.start, shown.end, COLUMNS), np.linspace(0.0, thickness, ROWS)
    edges = np.concatenate([time[:1], 0.5 * (time[1:] + time[:-1]), time[-1:]])[:, None]
    velocity, stress = waves.velocity_and_stress(edges[:-1], edges[1:], place)
    displacement = waves.displacement(time[:, None], place, _slip(waves, time)[:, None])
    fronts = fronts_of(shown.readings, shown.start, shown.end)
    places = [np.where(np.arange(len(times)) % 2, thickness, 0.0) for times in fronts]
    return SlabPicture(
        time + shown.begin,
        place,
        displacement - displacement[0],
        velocity,
        stress,
        tuple(np.column_stack([times + shown.begin, x]) for times, x in zip(fronts, places, strict=True)),
    )


def _slip(waves: SampledWaves, time: ArrayLike) -> Floats:
    readings = waves.shown.readings
    return readings.event_slip(time) if isinstance(readings, Window) else readings.slip(time)
