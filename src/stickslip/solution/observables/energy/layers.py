"""Energy of a body of layers, from its replayed waves (`solution.observables.layers`).

In a cell of impedance Z the waves f and g store (f^2 + g^2) / (4 Z) for each second of travel time. Those that are in the cells at
a moment left the two ends within the time T of a cell before it, so that all cells have their fronts at the same places. The power
of the drivers is summed over round trips at each phase, and then integrated over phases.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from stickslip.engine import Epoch, Floats, History
from stickslip.problem import inflow_of
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables.layer_records import DRAGGED, RADIATED, SUMS, VALUE, WORK
from stickslip.solution.observables.layers import NUMBERS_TOGETHER, LayerWaves
from stickslip.solution.observables.quadrature import CURVED_NODES, CURVED_WEIGHTS, NODES, WEIGHTS


class InsideLayers(NamedTuple):
    """Energies of the waves in each layer at some moments, shape (moments, layers), and trapped in all of them (J/m^2)."""

    stored: Floats
    """Elastic and kinetic energy, up to a constant."""
    kinetic: Floats
    trapped: Floats


class LayerEnergy:
    """Energies of a body of layers."""

    def __init__(self, history: History, body: OfLayers) -> None:
        self.history, self.body, self.waves = history, body, LayerWaves(history, body)
        self.rule = (CURVED_NODES, CURVED_WEIGHTS) if history.store.bend.any() else (NODES, WEIGHTS)

    # ---- what the waves store -----------------------------------------------------------------------------------------------

    def inside(self, moments: list[Epoch]) -> InsideLayers:
        """Return the energies of the waves at each moment, from one replay of them all."""
        places = [self._cells_at(now) for now in moments]
        left = self._left(moments, [ago for ago, _ in places])
        counts = [count for one in self.body.stacks for count in one.counts]
        cells = np.array([self._at(*one) for one in zip(moments, places, left, strict=True)]).reshape(len(moments), 3, sum(counts))
        stored, kinetic, trapped = np.add.reduceat(cells, np.cumsum([0, *counts[:-1]]), axis=2).transpose(1, 0, 2)
        return InsideLayers(stored, kinetic, trapped.sum(axis=1))

    def _at(self, now: Epoch, places: tuple[Floats, Floats], left: tuple[Floats, Floats]) -> tuple[Floats, Floats, Floats]:
        """Return the energies of the waves in each cell at a moment: stored, kinetic, trapped.

        The trapped energy is that beyond a state of even stress: on each side, if the sides are joined. Under rigid drivers it is
        sheared at their rates, and the velocity changes with the compliance passed, and the stress by what drag takes; else it is
        at rest.
        """
        waves = self.waves
        (ago, weight), (even, odd) = places, left
        f, g = np.where(waves.is_away, even, odd), np.where(waves.is_away, odd, even)[::-1]  # the places are symmetric
        impedance, doubled = waves.ladder.impedance, 2.0 * waves.reference
        stored = weight @ ((f * (f - doubled) + g * (g + doubled)) / (4.0 * impedance))
        moving = weight @ ((f + g) ** 2 / (8.0 * impedance))
        rates, held = self._sheared(now, ago)
        even_rates, mean = impedance * rates, self._mean(weight @ (0.5 * (g - f) / impedance))
        mean += held - self._mean(held * waves.time / impedance)
        trapped = weight @ (((f - even_rates + mean) ** 2 + (g - even_rates - mean) ** 2) / (4.0 * impedance))
        return stored, moving, trapped

    def _cells_at(self, now: Epoch) -> tuple[Floats, Floats]:
        """Return travel times (s) from the near side of a cell, symmetric about its middle, and the weights of an integral (s)."""
        time = self.waves.time
        standing = [self.history.standing(trip)[1:] for trip in range(max(now.trip - 1, 0), now.trip + 1)]
        fronts = np.mod(now.offset - np.concatenate([self._breaks(), *(phase for pair in standing for phase in pair)]), time)
        near = np.unique(np.concatenate([[0.0, 0.5 * time], np.minimum(fronts, time - fronts)]))
        return self._places(np.concatenate([near, time - near[-2::-1]]))

    def _breaks(self) -> Floats:
        """Return when (s) a loading that varies breaks; it has not come to the contact at once."""
        return inflow_of(self.history.problem).start if self.history.problem.varies else np.zeros(1)

    def _places(self, edges: Floats) -> tuple[Floats, Floats]:
        places, weights = self.rule
        widths = np.diff(edges)[:, None]
        return (edges[:-1, None] + widths * places).ravel(), (widths * weights).ravel()

    def _left(self, moments: list[Epoch], ago: list[Floats]) -> list[tuple[Floats, Floats]]:
        """Return the waves E and O (Pa) that left their places some times (s) before each moment, shape (times, cells)."""
        waves, many = self.waves, [len(times) for times in ago]
        phase = np.concatenate([now.offset - times for now, times in zip(moments, ago, strict=True)])
        trip, early = np.repeat([now.trip for now in moments], many), phase < 0.0
        at = waves.clipped(np.where(early, trip - 1, trip), np.where(early, phase + waves.round, phase))
        before = waves.earlier(*at)
        found = waves.waves(*(np.concatenate(both) for both in zip(at, before, strict=True)))
        odd, ends = waves.odd(found[len(phase) :, None], *before)[:, VALUE], np.cumsum(many)[:-1]
        return list(zip(np.split(found[: len(phase)], ends), np.split(odd, ends), strict=True))

    def _sheared(self, now: Epoch, ago: Floats) -> tuple[Floats, Floats]:
        """Return the velocities (m/s) at travel times (s) in the cells when the contact rests and the layers follow the drivers.

        The second result is the stress (Pa) that drag then takes between the contact and each cell.
        """
        waves, found, held = self.waves, [], []
        rate = waves.driver.shears_at(now.trip * waves.round + now.offset)
        for layers, (contact, driver) in zip(self.body.stacks, self.body.rates_at_start(0.0, rate), strict=True):
            passed = layers.passed[:-1] + np.diff(layers.passed) * (ago / waves.time)[:, None]
            found.append(contact + (driver - contact) * passed)
            held.append(layers.held(contact, driver)[:-1])
        return np.concatenate(found, axis=1), np.concatenate(held)

    def _mean(self, strain: Floats) -> Floats:
        """Return the mean stress minus the reference (Pa) in each cell, from integrals of that stress over Z (m)."""
        starts = self.body.sides_together.alike(self.waves.starts)
        compliance = np.add.reduceat(self.waves.time / self.waves.ladder.impedance, starts[:-1])
        return np.repeat(np.add.reduceat(strain, starts[:-1]) / compliance, np.diff(starts))

    # ---- what drivers and drag do -------------------------------------------------------------------------------------------

    def passed(self, moments: list[Epoch]) -> tuple[Floats, Floats, Floats]:
        """Return energies since the start until each moment (J/m^2): work of the drivers, radiated through them, taken by drag."""
        many, delays = len(moments), [self.waves.ladder.delay] + [self.waves.time] * self.body.has_drag
        sums = self._summed([self._later(now, delay) for delay in delays for now in moments])
        return sums[:many, WORK], sums[:many, RADIATED], sums[-many:, DRAGGED]

    def _summed(self, ends: list[Epoch]) -> Floats:
        """Return the sums of a replay, integrated over all phases until each moment."""
        waves, store, moments = self.waves, self.history.store, len(ends)
        trip, phase = np.array([end.trip for end in ends]), np.array([end.offset for end in ends])
        known = int(np.searchsorted(store.trip, trip.max(), side="right"))
        fronts = np.mod(np.concatenate([self._breaks(), store.phase_from[:known], store.phase_to[:known]]), waves.time)
        edges = np.unique(np.concatenate([[0.0, waves.time, waves.round], fronts, fronts + waves.time, phase]))
        places, weights = self._places(edges)
        sums = np.zeros((moments, SUMS))
        together = max(NUMBERS_TOGETHER // (SUMS * moments), 1)
        for low in range(0, len(places), together):
            here = places[low : low + together]
            trips = trip[:, None] - (here > phase[:, None])
            found = waves.powers(np.maximum(trips, waves.first).ravel(), np.tile(here, moments)).reshape(*trips.shape, SUMS)
            sums += np.einsum("mpk,p->mk", found, weights[low : low + together])
        return sums

    def _later(self, now: Epoch, delay: float) -> Epoch:
        """Return when a wave that is at a driver, or at an odd place, at a moment is where waves are followed: `delay` s later."""
        offset = now.offset + delay
        return Epoch(now.trip, offset) if offset < self.waves.round else Epoch(now.trip + 1, offset - self.waves.round)
