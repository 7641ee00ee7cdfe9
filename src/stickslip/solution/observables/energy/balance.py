"""Energy of a run, as differences from its start.

Energies are per unit area for the slab (J/m^2), and in J for the block. The elastic and kinetic energy of the slab is the energy of
its two travelling waves, [(Z v + sigma)^2 + (Z v - sigma)^2] / (4 G) integrated over the thickness. The heat is computed from the
law at the slip and slip rate of the run, not from the load: so the balance tests the run, and is not an identity.

The kinetic energy of the slab needs both waves at the same place, Z v = (A + B) / 2: A is the beta that is on its way to the
contact, B the w that is on its way to the driver. Between the ends of pieces of either wave, both are smooth functions of the
travel time from the contact, except for a square root at a fold. With s^2 (3 - 2 s) for the place in such an interval they are
smooth functions of s up to its ends.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from stickslip.engine import Epoch, History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import ENERGY_NAMES, in_files
from stickslip.problem.bodies import OfLayers, as_waves
from stickslip.solution.observables.energy.ground import pushing, shaken, shaking, speed, spring_force
from stickslip.solution.observables.quadrature import FULL, NODES, WEIGHTS, Integrand, between, up_to
from stickslip.solution.observables.waves import Radiation, Waves

if TYPE_CHECKING:
    import xarray as xr

MOST_REPLAYED = 300_000
"""Largest number of pieces times cells through which waves are replayed for a note; that takes a tenth of a second."""
CURVED_PLACES = NODES**2 * (3.0 - 2.0 * NODES)
"""Places of the quadrature in an interval of length 1: s^2 (3 - 2 s) at the nodes s of the Gauss-Legendre rule."""
SHARES = 6.0 * NODES * (1.0 - NODES) * WEIGHTS
"""Weights of these places: the derivative of s^2 (3 - 2 s) times the weights of the rule."""


def energy(history: History, t: ArrayLike, origin: float | None = None) -> xr.Dataset:
    """Return the energies of a run at times (s) since the history's epoch, as differences from their values at an origin (s).

    The origin is by default the start of the run. The dataset holds work, stored (elastic + kinetic), elastic, kinetic, heat,
    damped, radiated, balance; and trapped, which is no difference (slab: J/m^2, block: J). For layers it has elastic_in_layer and
    kinetic_in_layer, too, along a dimension `layer`: 1 is that at the contact, and -1 that on its other side. Work is the energy
    input of the driver, net of the energy radiated through a driver of finite impedance. Balance is work - stored - heat - damped,
    zero for an exact solution. Trapped is the part of the stored energy that travels to and fro in waves.

    Raises InputError for times outside the run, and for times in a leap over creep or within a round trip after it: the waves that
    left the contact there are not known.
    """
    import xarray as xr  # here, because it takes a quarter of a second to import

    time = np.atleast_1d(np.asarray(t, float))
    begin = history.span[0] if origin is None else origin
    parts = energies(history, history.find(np.append(begin, time), "right"))
    since = {name: values[1:] - (values[0] if name != "trapped" else 0.0) for name, values in parts.items()}
    since["balance"] = since["work"] - since["stored"] - since["heat"] - since["damped"]
    unit = in_files(history.problem.unit_of("energy"))
    places: dict[str, Any] = {"time": ("time", time, {"units": "s"})}
    if isinstance(body := history.problem.body, OfLayers):
        places["layer"] = (
            "layer",
            _numbers_of(body),
            {"long_name": f"{body.part} from the contact outwards, < 0 on the other side"},
        )
    texts = {name: text for name, text in ENERGY_NAMES.items() if name in since}
    variables = {
        name: (tuple(places)[: since[name].ndim], since[name], {"units": unit, "long_name": texts[name]}) for name in texts
    }
    return xr.Dataset(variables, coords=places)


def _numbers_of(body: OfLayers) -> list[int]:
    """Return the number of each layer: 1 at the contact, or -1 on the other side of it."""
    return [sign * n for sign, one in zip((1, -1), body.stacks, strict=False) for n in range(1, len(one.counts) + 1)]


def event_energies(history: History, first: Positions, last: Positions) -> dict[str, Floats]:
    """Return the energies of slip events from their first to their last positions.

    The keys are the columns of `solution.observables.event_table.ENERGY_COLUMNS`. The energies are integrated over each event
    alone, so their digits do not depend on the run before it.
    """
    body = history.problem.body
    if isinstance(body, OfLayers):
        parts = _events_of_layers(history, body, first, last)
    else:
        parts = (_slab_events if body.has_waves else _block_events)(history, first, last)
    parts["heat"] = between(history, first, last, _heating(history))
    parts["balance"] = parts["released"] + parts["work"] - parts["heat"] - parts["damped"]
    return parts


def _slab_events(history: History, first: Positions, last: Positions) -> dict[str, Floats]:
    body = as_waves(history.problem.body)
    waves = Waves(history, body)
    spans = list(zip(epochs(history, first), epochs(history, last), strict=True))
    moving = 0.5 * body.inertia * (speed(history, first) ** 2 - speed(history, last) ** 2)
    work = np.array([waves.work_between(begin, end) for begin, end in spans])
    if history.problem.ground is not None:
        work += between(history, first, last, shaking(history))
    return {
        "released": np.array([waves.stored(begin) - waves.stored(end) for begin, end in spans]) + moving,
        "work": work,
        "damped": np.zeros(len(spans)),
        "trapped": np.array([waves.trapped(end) for _, end in spans]),
    }


def _events_of_layers(history: History, body: OfLayers, first: Positions, last: Positions) -> dict[str, Floats]:
    if not len(first.piece):
        return {name: np.zeros(0) for name in ("released", "work", "damped", "trapped")}
    before, after = (energies_of_layers(history, body, at) for at in (first, last))
    return {
        "released": before["stored"] - after["stored"],
        "work": after["work"] - before["work"],
        "damped": after["damped"] - before["damped"],
        "trapped": after["trapped"],
    }


def _block_events(history: History, first: Positions, last: Positions) -> dict[str, Floats]:
    problem = history.problem
    body = problem.body
    force, left = spring_force(history, first), spring_force(history, last)
    spring = _stretching(history, left, force)
    pulling = between(history, first, last, _pulling(history))
    return {
        "released": spring + 0.5 * body.inertia * (history.rate(first) ** 2 - history.rate(last) ** 2),
        "work": pulling,
        "damped": between(history, first, last, _damping(history)),
        "trapped": np.zeros(len(force)),
    }


def trapped_note(history: History) -> str:
    """Return one line on the waves that travel in the body at the end of a run.

    It is empty for a block, and for layers whose waves would have to be replayed through more than `MOST_REPLAYED` cells.
    """
    body = history.problem.body
    if not body.has_waves:
        return ""
    end = epochs(history, Positions.inside(len(history) - 1, 1.0))[0]
    if not isinstance(body, OfLayers):
        energy = Waves(history, as_waves(body)).trapped(end)
    elif len(history) * sum(body.cells.counts) > MOST_REPLAYED:
        return ""
    else:
        from stickslip.solution.observables.energy.layers import LayerEnergy  # here and below, because few bodies are of layers

        energy = float(LayerEnergy(history, body).inside([end]).trapped[0])
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
    body = history.problem.body
    if isinstance(body, OfLayers):
        return energies_of_layers(history, body, at) | {"heat": heat(history, at, nodes)}
    return _slab(history, at) if body.has_waves else _block(history, at, nodes)


def energies_of_layers(history: History, body: OfLayers, at: Positions) -> dict[str, Floats]:
    """Return the energies of a body of layers at positions, without heat; see `energies`."""
    from stickslip.solution.observables.energy.layers import LayerEnergy

    energy, now = LayerEnergy(history, body), epochs(history, at)
    contact = 0.5 * body.inertia * speed(history, at) ** 2
    layers = energy.inside(now)
    stored, moving = layers.stored.sum(axis=1), layers.kinetic.sum(axis=1)
    work, radiated, dragged = energy.passed(now)
    if (machine := energy.waves.machine) is not None:  # its gains and the far stress move the layers and itself
        heavy = np.array([machine.kinetic(one) for one in now])
        work, contact = work + heavy, contact + heavy
    return {
        "work": work + shaken(history, at),
        "stored": stored + contact,
        "elastic": stored - moving,
        "kinetic": moving + contact,
        "damped": dragged,
        "radiated": radiated,
        "trapped": layers.trapped,
        "elastic_in_layer": layers.stored - layers.kinetic,
        "kinetic_in_layer": layers.kinetic,
    }


def _slab(history: History, at: Positions) -> dict[str, Floats]:
    body = as_waves(history.problem.body)
    waves, radiation, now = Waves(history, body), Radiation(history, body), epochs(history, at)
    contact = 0.5 * body.inertia * speed(history, at) ** 2
    each = np.array([(waves.stored(epoch), waves.trapped(epoch), kinetic(waves, epoch)) for epoch in now]).reshape(-1, 3)
    if body.has_machine:
        each[:, 2] += [history.machine.kinetic(waves.begun(epoch)) for epoch in now]
    stored, trapped, moving = each[:, 0] + contact, each[:, 1], each[:, 2] + contact
    return {
        "work": np.array([waves.work(epoch) for epoch in now]) + shaken(history, at),
        "stored": stored,
        "elastic": stored - moving,
        "kinetic": moving,
        "heat": heat(history, at),
        "damped": np.zeros(len(now)),
        "radiated": np.array([radiation.work(epoch) for epoch in now]),
        "trapped": trapped,
    }


def _block(history: History, at: Positions, nodes: int) -> dict[str, Floats]:
    problem = history.problem
    body = problem.body
    force, rate = spring_force(history, at), history.rate(at)
    spring = _stretching(history, np.full(len(force), problem.excess), force)
    slipping = np.flatnonzero(history.store.mode)
    return {
        "work": up_to(history, at, _pulling(history), nodes=nodes) + _at_rest(history, at),
        "stored": spring + 0.5 * body.inertia * rate**2,
        "elastic": spring,
        "kinetic": 0.5 * body.inertia * rate**2,
        "heat": heat(history, at, nodes),
        "damped": up_to(history, at, _damping(history), slipping, nodes=nodes) if body.damping else np.zeros(len(force)),
        "radiated": np.zeros(len(force)),
        "trapped": np.zeros(len(force)),
    }


def _pulling(history: History) -> Integrand:
    """Return the power (W) of a block's driver, and of the inertial force where the ground moves, as a function of positions."""
    problem = history.problem

    def power(at: Positions) -> Floats:
        trip, offset = history.placed(at)
        pulling = problem.pull_rate_at(trip * history.round_trip_time + offset) * (problem.strength + spring_force(history, at))
        return np.asarray(pulling if problem.ground is None else pulling - pushing(history, at) * history.rate(at))

    return power


def _at_rest(history: History, at: Positions) -> Floats:
    """Return the work of the block's driver up to each position in rests that were not recorded, J: the spring has stored it."""
    trip = history.store.trip
    before = np.flatnonzero(np.diff(trip) > 1)  # the last pieces before leaps
    force, left = (spring_force(history, Positions.inside(*place)) for place in ((before, 1.0), (before + 1, 0.0)))
    whole = np.append(0.0, np.cumsum(_stretching(history, force, left)))
    last = spring_force(history, Positions.inside(at.last, 1.0))
    part = np.where(at.at_rest, _stretching(history, last, spring_force(history, at)), 0.0)
    return np.asarray(whole[np.searchsorted(before, at.last)] + part)


def _stretching(history: History, force: Floats, later: Floats) -> Floats:
    """Return the energy (J) that the block's spring gains from one force to another (both minus the reference)."""
    body = history.problem.body
    return np.asarray((later - force) * (force + later + 2.0 * history.problem.strength) / (2.0 * body.stiffness))


def heat(history: History, at: Positions, nodes: int = FULL) -> Floats:
    """Return the friction heat up to each position, from the law. Slab: J/m^2, block: J."""
    return up_to(history, at, _heating(history), np.flatnonzero(history.store.mode), nodes=nodes)


def _heating(history: History) -> Integrand:
    """Return the power of friction heat as a function of positions (slab: W/m^2, block: W)."""
    return lambda at: history.resistance(at) * np.abs(history.rate(at))


def _damping(history: History) -> Integrand:
    """Return the power that the block's damping dissipates as a function of positions, W."""
    body = history.problem.body
    damping = body.damping
    return lambda at: damping * history.rate(at) ** 2


# ---- kinetic energy of the slab -------------------------------------------------------------------------------------------------


def kinetic(waves: Waves, now: Epoch) -> float:
    """Return the kinetic energy of the slab at a moment, J/m^2, without a contact mass.

    Raises InputError if the waves inside are not known: in a leap over creep, and within a round trip after it.
    """
    return _BothWaves(waves, now).kinetic()


class _BothWaves:
    """The two waves in the slab at a moment. Times are in s since then, places are travel times (s) from the contact."""

    def __init__(self, waves: Waves, now: Epoch) -> None:
        self.waves, self.begun = waves, waves.begun(now)
        low = max(-waves.round, -self.begun)
        trips = range(max(now.trip + int((now.offset + low) // waves.round), 0), now.trip + 1)
        standing = [waves.standing(trip) for trip in trips]
        piece, begin, end = (np.concatenate(parts) for parts in zip(*standing, strict=True))
        trip = np.repeat(trips, [len(pieces) for pieces, _, _ in standing])
        start, store = (trip - now.trip) * waves.round - now.offset, waves.history.store
        inside = (start + end > low) & (start + begin < 0.0)
        self.piece, self.start = piece[inside], (start + begin)[inside]
        self.origin, self.leaped = (start + store.phase_from[piece])[inside], (trip - store.trip[piece]).astype(float)[inside]

    def kinetic(self) -> float:
        """Return the kinetic energy, J/m^2."""
        half = self.waves.half
        comes = self.waves.inflow.edges(self.begun, self.begun + half) - self.begun
        fronts = np.concatenate([-self.start, self.start + self.waves.round, [self.begun, half - self.begun], comes])
        edges = np.unique(np.concatenate([[0.0, half], fronts[(fronts > 0.0) & (fronts < half)]]))
        lengths = np.diff(edges)[:, None]
        away = edges[:-1, None] + lengths * CURVED_PLACES
        both = self._coming(away.ravel()) + self._left(-away.ravel())
        return float((both.reshape(away.shape) ** 2 * SHARES * lengths).sum()) / (8.0 * self.waves.body.impedance)

    def _left(self, time: Floats) -> Floats:
        """Return w plus the reference (Pa) that left the contact at these times."""
        found = self.waves.left_before(self.begun + time)
        known = np.flatnonzero(time > -self.begun) if len(self.start) else np.empty(0, np.intp)
        which = np.maximum(np.searchsorted(self.start, time[known], side="right") - 1, 0)
        piece = self.piece[which]
        xi = self.waves.history.xi(piece, np.maximum(time[known] - self.origin[which], 0.0))
        at = Positions(piece, xi, self.leaped[which], np.zeros(len(piece), bool), piece)
        found[known] = self.waves.leaving(at)
        return found

    def _coming(self, away: Floats) -> Floats:
        """Return the load minus the reference (Pa) that reaches the contact after the time `away` (s)."""
        since, left = self.begun + away, away - self.waves.round
        return np.where(
            since < self.waves.half, self.waves.first_load(since), self.waves.arriving(self._left(left), self.begun + left)
        )
