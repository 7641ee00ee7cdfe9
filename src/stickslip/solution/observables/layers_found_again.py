"""The load of a contact under layers, found again from the replayed waves of its slip."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers
from stickslip.solution.observables.given_load import beside, breaks_at_contact, of_ground
from stickslip.solution.observables.layers import LayerWaves

REPLAYED = 2e7
"""Replay waves through this many cells times round trips times phases; that takes a tenth of a second."""
PHASES = 64
"""Compare loads at no more than this many phases."""
LEAST_PHASES = 4
"""With fewer phases than this, the last round trips of a run are left out instead."""
GOLDEN = 0.5 * (5.0**0.5 - 1.0)
"""Multiples of this share of a round trip fill it evenly."""
EDGE = 1e-11
"""Places nearer to an end of a step than this share (1) of a round trip are not compared: loads may jump there."""
BREAKS = 16
"""Compare loads beside at most this many breaks of the loading."""


def loads_of_layers(history: History, body: OfLayers) -> tuple[float, int]:
    """Return how far (Pa) the loads of a history are from those of the replayed waves, and the number of steps compared."""
    piece, phase = _places(history, body)
    if not len(piece):
        return 0.0, 0
    store = history.store
    xi = history.xi(piece, phase - store.phase_from[piece])
    near = EDGE * history.round_trip_time
    inside = (phase - store.phase_from[piece] > near) & (store.phase_to[piece] - phase > near)
    piece, phase, xi = piece[inside], phase[inside], xi[inside]
    trip = store.trip[piece].astype(np.int64)
    waves = LayerWaves(history, body)
    rows = waves.waves(trip, phase)
    time, at = trip * history.round_trip_time + phase, Positions.inside(piece, xi)
    found = _load(history, body, (waves.starts, rows), at, (time, time))
    differs = np.abs(found - history.excess(at))
    differs = np.maximum(differs, np.abs(waves.driver.missed(rows[:, waves.last[0]], trip, phase)))
    return float(differs.max(initial=0.0)), len(np.unique(piece))


def _places(history: History, body: OfLayers) -> tuple[NDArray[np.intp], Floats]:
    """Return pieces and phases (s) in them where loads are compared: the same phases in every round trip."""
    store, cells = history.store, sum(body.cells.counts)
    last = int(history.creep[:, 0].min(initial=store.trip[-1] + 1))
    many = int(np.clip(REPLAYED / (cells * max(last, 1)), LEAST_PHASES, PHASES))
    last = min(last, int(REPLAYED / (cells * many)) + 1)
    own = history.given + np.flatnonzero(store.trip[history.given :] < last)
    slips = own[store.mode[own] != 0]
    drawn = slips[np.linspace(0, len(slips) - 1, many // 2).astype(int)] if len(slips) else slips
    middles = store.phase_from[drawn] + 0.5 * store.speed[drawn] + 0.25 * store.bend[drawn]
    even = history.round_trip_time * np.modf(GOLDEN * np.arange(1, many - len(drawn) + 1))[0]
    breaks = breaks_at_contact(history.problem)
    cuts = np.mod(beside(history.problem, breaks[breaks < (last + 1) * history.round_trip_time][:BREAKS]), history.round_trip_time)
    found = [
        (own[(store.phase_from[own] < phase) & (phase < store.phase_to[own])], phase)
        for phase in np.concatenate([middles, even, cuts])
    ]
    return np.concatenate([n for n, _ in found]), np.repeat([phase for _, phase in found], [len(n) for n, _ in found])


def _load(
    history: History, body: OfLayers, waves: tuple[NDArray[np.int64], Floats], at: Positions, times: tuple[Floats, Floats]
) -> Floats:
    """Return the load minus the reference (Pa) from the first cell of each side and all waves; `times` as for `of_ground`."""
    problem, rate, (starts, rows) = history.problem, history.rate(at), waves
    velocity, acceleration = of_ground(problem, *times)
    share = body.sides_together.slipping([one.cell_impedances[0] for one in body.stacks])  # of each wave, as of slow slip
    load = 2.0 * body.impedance * (rate + velocity) - rows[:, starts[:-1]] @ np.array(share)
    return np.asarray(load - body.impedance * velocity - body.inertia * acceleration)
