"""Energy of a run, as differences from its start.

Energies are per unit area for the slab (J/m^2), and in J for the block. The elastic and kinetic energy of the slab is the energy of
its two travelling waves, [(Z v + sigma)^2 + (Z v - sigma)^2] / (4 G) integrated over the thickness. The heat is computed from the
law at the slip and slip rate of the run, not from the load: so the balance tests the run, and is not an identity.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from stickslip.engine import Epoch, History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import ENERGY_NAMES, in_files
from stickslip.solution.observables.asked import observables_of
from stickslip.solution.observables.quadrature import FULL, Integrand, between, up_to

if TYPE_CHECKING:
    import xarray as xr


def energy(history: History, t: ArrayLike, origin: float | None = None) -> xr.Dataset:
    """Return the energies of a run at times (s) since the history's epoch, as differences from their values at an origin (s).

    The origin is by default the start of the run, or of its motion behind a given wave. The dataset holds work, stored (elastic +
    kinetic), elastic, kinetic, heat, damped, radiated, balance; and trapped, which is no difference (slab: J/m^2, block: J). For
    layers it has elastic_in_layer and kinetic_in_layer, too, along a dimension `layer`: 1 is that at the contact, and -1 that on
    its other side. Work is the energy input of the driver, net of the energy radiated through a driver of finite impedance. Balance
    is work - stored - heat - damped, zero for an exact solution. Trapped is the part of the stored energy that travels to and fro
    in waves.

    Raises InputError for times outside the run, and for times in a leap over creep or within a round trip after it: the waves that
    left the contact there are not known.
    """
    import xarray as xr  # here, because it takes a quarter of a second to import

    time = np.atleast_1d(np.asarray(t, float))
    begin = history.begun if origin is None else origin
    history.check_begun(np.append(begin, time))
    parts = energies(history, history.find(np.append(begin, time), "right"))
    since = {name: values[1:] - (values[0] if name != "trapped" else 0.0) for name, values in parts.items()}
    since["balance"] = since["work"] - since["stored"] - since["heat"] - since["damped"]
    unit = in_files(history.problem.unit_of("energy"))
    places = {"time": ("time", time, {"units": "s"})} | observables_of(history.problem).coordinates(history.problem)
    texts = {name: text for name, text in ENERGY_NAMES.items() if name in since}
    variables = {
        name: (tuple(places)[: since[name].ndim], since[name], {"units": unit, "long_name": texts[name]}) for name in texts
    }
    return xr.Dataset(variables, coords=places)


def event_energies(history: History, first: Positions, last: Positions) -> dict[str, Floats]:
    """Return the energies of slip events from their first to their last positions.

    The keys are the columns of `solution.observables.event_table.ENERGY_COLUMNS`. The energies are integrated over each event
    alone, so their digits do not depend on the run before it.
    """
    parts = observables_of(history.problem).event_energies(history, first, last)
    parts["heat"] = between(history, first, last, _heating(history))
    parts["damped"] = parts["damped"] + taken_between(history, first, last)
    parts["balance"] = parts["released"] + parts["work"] - parts["heat"] - parts["damped"]
    return parts


def trapped_note(history: History) -> str:
    """Return one line on the waves that travel in the body at the end of a run.

    It is empty for a block, and for layers whose waves would have to be replayed through too many cells.
    """
    body, energy = history.problem.body, observables_of(history.problem).trapped(history)
    if energy is None:
        return ""
    holds = history.problem.strength**2 / (2.0 * body.stiffness)
    energy_unit = history.problem.unit_of("energy").replace("^", "")
    share = f", {100.0 * energy / holds:.2g} % of what the {body.noun} holds at its static strength" if holds > 0.0 else ""
    return f"{energy:.6g} {energy_unit} in waves at the end{share}"


def epochs(history: History, at: Positions) -> list[Epoch]:
    """Return positions as epochs, without rounding."""
    return [Epoch(int(trip), float(offset)) for trip, offset in zip(*history.placed(at), strict=True)]


def energies(history: History, at: Positions, nodes: int = FULL) -> dict[str, Floats]:
    """Return the energies at positions in a history.

    Work, heat, damped and radiated count from the start of the run; stored and elastic are up to a constant; kinetic and trapped
    are absolute. All are taken at exactly the same positions, so that their differences balance late in a run too. The work, heat
    and damping of a block are integrated with `nodes` nodes on each piece.
    """
    parts = observables_of(history.problem).energies(history, at, nodes)
    parts["damped"] = parts["damped"] + taken(history, at, nodes)
    return parts


def heat(history: History, at: Positions, nodes: int = FULL) -> Floats:
    """Return the friction heat up to each position, from the law. Slab: J/m^2, block: J."""
    return up_to(history, at, _heating(history), np.flatnonzero(history.store.mode), nodes=nodes)


def taken(history: History, at: Positions, nodes: int = FULL) -> Floats:
    """Return what a dashpot at the contact of a body with waves has taken up to each position (J/m^2): it is no friction heat."""
    if not history.problem.body.dashpot:
        return np.zeros(len(at.piece))
    return up_to(history, at, _resisting(history), np.flatnonzero(history.store.mode), nodes=nodes)


def taken_between(history: History, first: Positions, last: Positions) -> Floats:
    """Return what such a dashpot takes between positions (J/m^2)."""
    if not history.problem.body.dashpot:
        return np.zeros(len(first.piece))
    return between(history, first, last, _resisting(history))


def _resisting(history: History) -> Integrand:
    """Return the power that such a dashpot takes as a function of positions (W/m^2)."""
    dashpot = history.problem.body.dashpot
    return lambda at: dashpot * history.rate(at) ** 2


def _heating(history: History) -> Integrand:
    """Return the power of friction heat as a function of positions (slab: W/m^2, block: W)."""
    return lambda at: history.resistance(at) * np.abs(history.rate(at))
