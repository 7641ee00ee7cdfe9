"""What a finished run of a body of layers says, from its replayed waves."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from stickslip.engine import History, Positions, Side
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables.asked import AtContact, AtDriver, Extent, Field, FollowedFronts, LoadCompared, ObservablesOfKind
from stickslip.solution.observables.energy.balance import epochs, heat
from stickslip.solution.observables.energy.ground import shaken, speed
from stickslip.solution.observables.energy.layers import LayerEnergy
from stickslip.solution.observables.field import check_side, velocity_and_stress
from stickslip.solution.observables.inside_layers import beside, field_of_layers
from stickslip.solution.observables.layer_records import VALUE
from stickslip.solution.observables.layers import NUMBERS_TOGETHER, LayerWaves
from stickslip.solution.observables.layers_found_again import loads_of_layers

MOST_REPLAYED = 300_000
"""Replay waves for a note through at most this many pieces times cells; that takes a tenth of a second."""


def of_layers(problem: Problem) -> OfLayers:
    """Return the body of a problem, which is one of layers."""
    return cast(OfLayers, problem.body)


class ObservablesOfLayered(ObservablesOfKind):
    """The answers of bodies of layers; energies are in J/m^2."""

    def energies(self, history: History, at: Positions, nodes: int) -> dict[str, Floats]:
        """Return them, and those of each layer."""
        return _of_waves(history, at) | {"heat": heat(history, at, nodes)}

    def event_energies(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return how much the energies change from the start to the end of each event."""
        if not len(first.piece):
            return {name: np.zeros(0) for name in ("released", "work", "damped", "trapped")}
        before, after = (_of_waves(history, at) for at in (first, last))
        return {
            "released": before["stored"] - after["stored"],
            "work": after["work"] - before["work"],
            "damped": after["damped"] - before["damped"],
            "trapped": after["trapped"],
        }

    def energetics(self, history: History, first: Positions, last: Positions) -> dict[str, Floats]:
        """Return such differences, too."""
        if not len(first.piece):
            return {name: np.zeros(0) for name in ("kinetic", "radiated", "trapped_before")}
        before, after = (_of_waves(history, at) for at in (first, last))
        grown = {name: after[name] - before[name] for name in ("kinetic", "radiated")}
        return grown | {"trapped_before": before["trapped"]}

    def trapped(self, history: History) -> float | None:
        """Return the energy of the waves at the end; None if they would be replayed through more than `MOST_REPLAYED` cells."""
        body = of_layers(history.problem)
        cells = sum(body.cells.counts)
        if len(history) * cells > MOST_REPLAYED:
            return None
        end = epochs(history, Positions.inside(len(history) - 1, 1.0))
        return float(LayerEnergy(history, body).inside(end).trapped[0])

    def coordinates(self, problem: Problem) -> dict[str, Any]:
        """Return the number of each layer: 1 at the contact, or -1 on the other side of it."""
        body = of_layers(problem)
        numbers = [sign * n for sign, one in zip((1, -1), body.stacks, strict=False) for n in range(1, len(one.counts) + 1)]
        return {"layer": ("layer", numbers, {"long_name": f"{body.part} from the contact outwards, < 0 on the other side"})}

    def at_driver(self, history: History, time: Floats, side: Side) -> AtDriver:
        """Return them from the waves that are replayed up to the last cell of the first side."""
        history.find(time, side)  # raises InputError
        waves = LayerWaves(history, of_layers(history.problem))
        last = int(waves.last[0])
        found = np.empty((2, len(time)))
        together = max(NUMBERS_TOGETHER // (2 * len(waves.is_away)), 1)
        for low in range(0, len(time), together):
            part = time[low : low + together]
            away, back = (waves.placed(beside(waves, part - ago, part, side)) for ago in (waves.time, 0.0))
            of_even, of_odd = (away, back) if waves.is_away[last] else (back, away)
            before = waves.earlier(*of_odd)
            both = waves.waves(*(np.concatenate(pair) for pair in zip(of_even, before, strict=True)))
            even, odd = both[: len(part), last], waves.odd(both[len(part) :, None], *before)[:, VALUE, last]
            found[:, low : low + together] = (even, odd) if waves.is_away[last] else (odd, even)
        met, sent = found
        return AtDriver(*velocity_and_stress(met, sent, float(waves.ladder.impedance[last]), float(waves.reference[last])))

    def ways(self, problem: Problem) -> list[float]:
        """Return the time through all cells of each side."""
        return [sum(one.counts) * one.time for one in of_layers(problem).stacks]

    def fronts_drawn(self, fronts: Floats) -> Floats:
        """Return none: each time takes a replay of all waves."""
        return fronts[:0]

    def field(self, history: History, at_contact: AtContact, place: Floats, time: Floats, side: Side) -> Field:
        """Return it from the replayed waves in each cell."""
        contact, body = at_contact(), of_layers(history.problem)
        if (ground := history.problem.ground) is not None:
            begun = history.epoch.trip * body.round_trip_time + history.epoch.offset
            contact = contact + ground.displacement_at(begun + time) - ground.displacement_at(begun)
        check_side(side)
        inside = field_of_layers(history, body, contact.ravel(), x=place.ravel(), t=time.ravel(), side=side)
        return Field(*(np.reshape(values, place.shape) for values in inside))

    def extent(self, problem: Problem) -> Extent:
        """Return the places from the driver of one side to that of the other, or from the contact on."""
        body = of_layers(problem)
        depths = [np.cumsum(one.thickness).tolist() for one in body.stacks]
        lowest = -depths[1][-1] if len(depths) > 1 else 0.0
        below = tuple(-one for one in depths[1][:-1]) if len(depths) > 1 else ()
        return Extent(lowest, depths[0][-1], (*below, *depths[0][:-1]), body.two_way_time)

    def fronts(self, problem: Problem) -> FollowedFronts:
        """Return that no front can be followed: they split where layers meet."""
        return FollowedFronts(problem.body.longest_way, 1.0, 0.0)

    def load_compared(self, history: History) -> LoadCompared:
        """Compare the loads with what the replayed waves bring, at the same phases in every round trip."""
        return LoadCompared(*loads_of_layers(history, of_layers(history.problem)))


def _of_waves(history: History, at: Positions) -> dict[str, Floats]:
    """Return the energies at positions, without heat."""
    body = of_layers(history.problem)
    energy, now = LayerEnergy(history, body), epochs(history, at)
    contact = 0.5 * body.inertia * speed(history, at) ** 2
    layers = energy.inside(now)
    stored, moving = layers.stored.sum(axis=1), layers.kinetic.sum(axis=1)
    work, radiated, dragged = energy.passed(now)
    heavy = np.array([energy.waves.driver.kinetic(one) for one in now])  # what drives a machine moves the layers and itself
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


ANSWERS = ObservablesOfLayered()
