"""The parts of the energy of a run against time."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import EnergyPicture
from stickslip.explorer.model.shown import Shown
from stickslip.foundation.errors import InputError
from stickslip.observables.energy.balance import energies

TIMES = {True: 24, False: 400}
"""Number of times, by whether the body has waves."""


def energy_picture(shown: Shown) -> EnergyPicture:
    """Return the parts of the energy; without any where the waves are not known because the run leaped over creep."""
    readings, body = shown.readings, shown.readings.problem.body
    time = np.linspace(shown.start, shown.end, TIMES[body.has_waves])
    try:
        found = energies(readings.history, readings.history.find(time, "right"))
    except InputError:
        return EnergyPicture(time + shown.begin, {}, body.energy_unit)
    parts = {"elastic": found["elastic"] - found["elastic"].min(), "kinetic": found["kinetic"]}
    parts |= {name: found[name] - found[name][0] for name in ("heat", "radiated", "damped")}
    work = found["work"] - found["work"][0]
    total = parts["elastic"][0] + parts["kinetic"][0] + work + parts["radiated"]
    drawn = {name: values for name, values in parts.items() if values.any()}
    return EnergyPicture(time + shown.begin, drawn | {"total": total}, body.energy_unit)
