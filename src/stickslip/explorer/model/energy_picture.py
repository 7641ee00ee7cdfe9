"""The parts of the energy of a run against time."""

from __future__ import annotations

import numpy as np

from stickslip.explorer.model.answer import EnergyPicture, Floats
from stickslip.explorer.model.sampled_waves import SampledWaves, Shown
from stickslip.observables.energy.balance import energies, heat
from stickslip.observables.quadrature import FULL
from stickslip.trajectory.history import History

SLAB_TIMES = 160
"""Number of times for a slab; for a block there are `BLOCK_TIMES`."""
BLOCK_TIMES = 400
LONG_HISTORY, FEW_NODES = 1_000, 4
"""Number of pieces of a history from which on energies are integrated with fewer nodes on each: with all nodes they would take
longer than the run, and a picture shows no difference.
"""
SLAB_PLACES = 240
"""Number of places in the slab at which the product of its two waves is added up."""


def energy_picture(shown: Shown, waves: SampledWaves | None) -> EnergyPicture:
    """Return the parts of the energy; none where the waves in a slab are not known because the run leaped over creep."""
    body = shown.readings.problem.body
    time = np.linspace(shown.start, shown.end, SLAB_TIMES if body.has_waves else BLOCK_TIMES)
    if body.has_waves and waves is None:
        return EnergyPicture(time + shown.begin, {}, body.energy_unit)
    found = _of_block(shown, time) if waves is None else _of_slab(waves, time)
    elastic = found["stored"] - found["kinetic"]
    parts = {"elastic": elastic - elastic.min(), "kinetic": found["kinetic"]}
    parts |= {name: found[name] - found[name][0] for name in ("heat", "radiated", "damped")}
    drawn = {name: values for name, values in parts.items() if values.any()}
    total = parts["elastic"][0] + parts["kinetic"][0] + found["work"] - found["work"][0] + parts["radiated"]
    return EnergyPicture(time + shown.begin, drawn | {"total": total}, body.energy_unit)


def _of_block(shown: Shown, time: Floats) -> dict[str, Floats]:
    history = shown.readings.history
    return energies(history, history.find(time, "right"), _nodes(history))


def _nodes(history: History) -> int:
    """Return the number of nodes on each piece."""
    return FEW_NODES if len(history) > LONG_HISTORY else FULL


def _of_slab(waves: SampledWaves, time: Floats) -> dict[str, Floats]:
    """Return the energies of a slab: what is stored from its waves, the heat from the law, so that they need not balance."""
    at = waves.history.find(time, "right")
    contact = 0.5 * waves.body.contact_mass * waves.history.rate(at) ** 2
    return {
        "work": waves.work(time),
        "heat": heat(waves.history, at, _nodes(waves.history)),
        "stored": waves.stored(time) + contact,
        "kinetic": waves.kinetic(time, SLAB_PLACES) + contact,
        "radiated": waves.radiated(time),
        "damped": np.zeros(len(time)),
    }
