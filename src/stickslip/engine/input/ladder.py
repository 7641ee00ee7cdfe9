"""Prepare a body of layers for the engine: its cells, and the waves in them before the start (`engine.waves.ladder`).

At the start the stress is the same along each side and grows at the same rate, and the velocity rises from the contact to the
driver in proportion to the compliance passed. These waves are straight lines in time. Where there is drag, the stress is that at
the contact and what drag takes up to there, so that it would stay so: what a steady driver holds it with is the stress behind it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple, cast

import numpy as np

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import FirstLoad, LadderCell
from stickslip.problem import LoadingHistory, Problem, driver_of, far_excess
from stickslip.problem.bodies import OfLayers
from stickslip.problem.bodies.layered.layers import Layers


class StartingSide(NamedTuple):
    """One side of the contact at the start; velocities (m/s) are towards forward slip, stresses minus the reference (Pa)."""

    layers: Layers
    contact_rate: float
    driver_rate: float
    pulled_at: float
    """Pull rate of the driver: not the rate of the slab there if the driver gives way."""
    stress: float
    far_stress: float | None
    """None for that behind the last layer."""
    far_stress_rate: float
    share: float
    """Share (1) in the load and its growth."""


def layers_of(problem: Problem) -> OfLayers:
    """Return the body of a problem, which is of layers."""
    return cast(OfLayers, problem.body)


def ladder_of(problem: Problem) -> at.Floats:
    """Return the table of `LadderCell` of a problem with a body of layers."""
    body, driver = layers_of(problem), driver_of(problem)
    tables = [_cells_of(side) for side in sides_of(problem, body)]
    for table, pulled in zip(tables, driver.pulled_shares(problem), strict=True):
        cells = LadderCell.of(table)
        cells.pulled[-1] = pulled
        if pulled != 0.0 or driver.moves:  # what is pulled as it varies, or moves by itself, is added
            cells.inflow[-1] = cells.inflow_rate[-1] = 0.0
        if driver.moves:
            cells.reflection[-1] = driver.reflection(problem.body)
    return np.concatenate(tables)


def sides_of(problem: Problem, body: OfLayers) -> Iterator[StartingSide]:
    """Yield the sides of the contact as they are at the start."""
    stress, growth = far_excess(problem), problem.far_stress_rate
    given = problem.far_stress
    far = None if given is None or isinstance(given, LoadingHistory) else given - problem.strength
    rates = body.rates_at_start(problem.rate, problem.initial_shear)
    for layers, (contact, driver), share, moved in zip(body.stacks, rates, body.shares, body.is_pulled, strict=True):
        own, pulled = None if far is None else share * far, problem.first_pull_rate if moved else 0.0
        yield StartingSide(layers, contact, driver, pulled, share * stress, own, share * growth, share)


def _cells_of(side: StartingSide) -> at.Floats:
    """Return the cells of one side, from the contact outwards."""
    layers = side.layers
    zs, time = np.array(layers.cell_impedances), layers.time
    rates, held = (of(side.contact_rate, side.driver_rate) for of in (layers.rates, layers.held))
    drags = layers.drags[:-1]
    growth = layers.stiffness * (side.driver_rate - side.contact_rate)
    table = LadderCell.table(len(zs))
    cells = LadderCell.of(table)
    cells.impedance = zs
    resist = zs[:-1] + zs[1:] + drags
    cells.reflection[:-1], cells.reflection[-1] = (zs[:-1] - zs[1:] - drags) / resist, layers.reflection
    cells.reflection_beyond[:-1] = (zs[1:] - zs[:-1] - drags) / resist
    cells.is_last[-1] = 1.0
    cells.inflow[-1], cells.inflow_rate[-1] = _steady_inflow(side)
    cells.inflow_before[-1] = 2.0 * zs[-1] * side.driver_rate
    place = np.arange(len(zs))
    away = place % 2 == 0  # the even place of the cell is the one nearer to the contact
    sign = np.where(away, -1.0, 1.0)
    cells.ramp_share = side.share * sign
    cells.wave = zs * rates[np.where(away, place, place + 1)] + sign * (side.stress + held[:-1] - growth * 2.0 * time)
    cells.growth = sign * growth
    return table


def _steady_inflow(side: StartingSide) -> tuple[float, float]:
    """Return what the driver of a side sends where waves are followed, at t = 0 (Pa), and how fast it grows (Pa/s)."""
    layers = side.layers
    if np.isinf(layers.driver_impedance):
        return 2.0 * layers.impedances[-1] * side.pulled_at, 0.0
    gain, growth = 1.0 + layers.reflection, side.far_stress_rate
    held = float(layers.held(side.contact_rate, side.driver_rate)[-1])
    far = side.stress + held if side.far_stress is None else side.far_stress
    sent = layers.driver_impedance * side.pulled_at + far - growth * layers.inflow_delay
    return gain * sent, gain * growth


def first_pieces(problem: Problem) -> at.Floats:
    """Return the pieces of the first round trip: the load of the start, or NaN where a driver is heard already.

    A driver behind an odd number of cells joins in after the time of one cell, which is where a single cell hears it.
    """
    body = layers_of(problem)
    delay, end = body.inflow_delay, problem.round_trip_time
    phases = np.array([0.0, delay, end] if 0.0 < delay < end else [0.0, end])
    table = FirstLoad.table(len(phases))
    pieces = FirstLoad.of(table)
    slope = body.stiffness * problem.initial_shear
    heard = (phases >= delay) & (min(sum(one.counts) for one in body.stacks) == 1) & (problem.varies or not body.is_driven_rigidly)
    pieces.phase, pieces.slope, pieces.load = phases, slope, np.where(heard, np.nan, problem.excess + slope * phases)
    return table
