"""Prepare a body of layers for the engine: its cells, and the waves in them before the start (`engine.waves.ladder`).

At the start the stress is the same everywhere and grows everywhere at the same rate, and the velocity rises from the contact to the
driver in proportion to the compliance passed. These waves are straight lines in time.
"""

from __future__ import annotations

from itertools import accumulate
from typing import NamedTuple

import numpy as np

from stickslip.bodies import LayeredSlab
from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import Counts, FirstLoad, LadderCell
from stickslip.engine_input.forcing import far_excess, steady_inflow
from stickslip.problem.problem import Problem

NO_LADDER = LadderCell.table(0)
"""Table `Setup.ladder` of a body without layers."""


class Side(NamedTuple):
    """One side of the contact: a body of layers whose driver moves at a rate V (m/s) at first, and the contact at another (m/s)."""

    body: LayeredSlab
    driver_rate: float
    contact_rate: float
    stress: float
    """Shear stress at the start, minus that of the reference strength (Pa)."""
    inflow: tuple[float, float]
    """What the driver sends at t = 0 (Pa), and how fast it grows (Pa/s); 0 if it varies."""
    pulled: float
    """Share of a varying inflow that this side's driver sends."""


def ladder_of(problem: Problem) -> at.Floats:
    """Return the table of `LadderCell` of a problem; an empty one for a body of one layer, which is a plain slab."""
    body = problem.body
    if body.is_uniform:
        return NO_LADDER
    assert isinstance(body, LayeredSlab)
    inflow = (0.0, 0.0) if problem.varies else steady_inflow(problem)
    driver = problem.rate + problem.initial_shear
    return cells_of(Side(body, driver, problem.rate, far_excess(problem), inflow, 1.0))


def cells_of(side: Side) -> at.Floats:
    """Return the cells of one side, from the contact outwards."""
    body = side.body
    zs, time = body.cell_impedances, body.cells.time
    passed = np.array([0.0, *accumulate(body.compliances)]) * body.stiffness
    rates = side.contact_rate + (side.driver_rate - side.contact_rate) * passed
    growth = body.stiffness * (side.driver_rate - side.contact_rate)
    table = LadderCell.table(len(zs))
    cells = LadderCell.of(table)
    cells.impedance = zs
    beyond = np.array([*zs[1:], np.nan])
    cells.reflection = np.append(((np.array(zs) - beyond) / (np.array(zs) + beyond))[:-1], body.reflection)
    cells.is_last[-1], cells.pulled[-1] = 1.0, side.pulled
    cells.inflow[-1], cells.inflow_rate[-1] = side.inflow
    cells.inflow_before[-1] = 2.0 * zs[-1] * side.driver_rate
    for n, z in enumerate(zs):
        away = n % 2 == 0  # the even place of the cell is the one nearer to the contact
        sign = -1.0 if away else 1.0
        place = n if away else n + 1
        cells.wave[n] = z * rates[place] + sign * (side.stress - growth * 2.0 * time)
        cells.growth[n] = sign * growth
    return table


def set_counts(counts: Counts, problem: Problem) -> None:
    """Set the counts of a body of layers at t = 0."""
    if problem.body.is_uniform:
        return
    assert isinstance(problem.body, LayeredSlab)
    counts.cells = counts.first_side = len(problem.body.cell_impedances)


def first_pieces(problem: Problem) -> at.Floats:
    """Return the pieces of the first round trip, whose load follows from the waves in the layers.

    A driver behind an odd number of cells joins in after the time of one cell.
    """
    delay, end = problem.body.inflow_delay, problem.round_trip_time
    phases = [0.0, delay, end] if 0.0 < delay < end else [0.0, end]
    table = FirstLoad.table(len(phases))
    FirstLoad.of(table).phase = phases
    return table
