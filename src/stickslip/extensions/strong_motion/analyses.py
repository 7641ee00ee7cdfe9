"""Displacements by each kind of analysis: a rigid block, a column that deforms while it slides, and one that deforms before.

Newmark 1965, Geotechnique 15, 139-160 (rigid); Rathje & Bray 1999, J. Geotech. Geoenviron. Eng. 125, 1013-1021 (coupled);
Makdisi & Seed 1978, J. Geotech. Eng. Div. 104, 849-867 (decoupled: the mean acceleration of the column moves a rigid block).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from stickslip.extensions.strong_motion.asked import SlidingAsked
from stickslip.extensions.strong_motion.compiled.rigid_block import (
    ANSWER_COLUMNS,
    DISPLACEMENT,
    FIRST_START,
    LAST_STOP,
    PEAK_DISPLACEMENT,
    PEAK_TIME,
    PEAK_VELOCITY,
    SLIDING_TIME,
    SLIPS,
)
from stickslip.extensions.strong_motion.motion import GroundMotion
from stickslip.extensions.strong_motion.sliding_block import ShakenBlock
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.errors import InputError
from stickslip.friction import Coulomb
from stickslip.problem import Problem
from stickslip.run import uninterrupted
from stickslip.run.simulate import simulate
from stickslip.solution import Solution

FINISHED = "finished"
"""Status of an analysis that reached its end."""
SAMPLES_PER_INTERVAL = 10
"""The mean acceleration of a column, which is smooth between the kinks of a record, is taken at so many times in each interval."""
RINGING = 20.0
"""How long (round trips of a wave in the column) it is followed after the record, beside the time that the block needs to stop."""
NEVER_YIELDS = 1e3
"""Strength of a contact that must not slip, as a multiple of the force on the mass at the peak acceleration of the ground."""


class CaseShaken(NamedTuple):
    """A record times a factor: positive accelerations then slide the block backward."""

    motion: GroundMotion
    factor: float


class SlidingAnswer(NamedTuple):
    """The answers of one case, a row for each yield coefficient, and how its analysis ended."""

    rows: Floats
    status: list[str]


def answer_of(asked: SlidingAsked, case: CaseShaken, tell: Callable[[str], Any]) -> SlidingAnswer:
    """Return the answers of one case for all yield coefficients."""
    if asked.analysis == "coupled":
        return _coupled(asked, case, tell)
    block, status = rigid_block(asked, case)
    rows = block.slide(GRAVITY * asked.forward, GRAVITY * asked.backward)
    return SlidingAnswer(rows if status == FINISHED else np.full_like(rows, math.nan), [status] * len(rows))


def rigid_block(asked: SlidingAsked, case: CaseShaken) -> tuple[ShakenBlock, str]:
    """Return the block that a case shakes, and how the run of a column ended, whose mean acceleration is its load."""
    motion = case.motion
    if asked.analysis == "rigid":
        return ShakenBlock(-case.factor * motion.acceleration, motion.interval), FINISHED
    column, interval = asked.column, motion.interval / SAMPLES_PER_INTERVAL
    mass, lasting = mass_of(column), motion.lasts + RINGING * column.round_trip_time
    enough = NEVER_YIELDS * abs(case.factor) * motion.measures.pga * mass / _normal_of(column)
    run = _run(column, enough, 0.0, case, lasting, one_way=True)
    if not run.status.ok:
        return ShakenBlock(np.zeros(2), interval), run.status.name
    return ShakenBlock(run.load(interval * np.arange(int(lasting / interval))) / mass, interval), FINISHED


def mass_of(column: Any, before: str = "") -> float:
    """Return the mass (kg/m^2) of a column. Raises InputError, which begins with `before`, for a body that is none."""
    try:
        return float(column.density * column.thickness + getattr(column, "contact_mass", 0.0))
    except (AttributeError, TypeError):
        raise InputError(f"{before}a column must be a slab with one density and thickness, got {type(column).__name__}") from None


def _normal_of(column: Any) -> float:
    return float(column.normal_stress)


def coupled_run(asked: SlidingAsked, case: CaseShaken, n: int) -> Solution:
    """Return the run of a column that slides at the yield coefficient n.

    Friction and the initial load are such that it yields at these accelerations: the strength less the load, and more the load.
    """
    forward, backward, column = GRAVITY * asked.forward[n], GRAVITY * asked.backward[n], asked.column
    mass, one_way = mass_of(column), math.isinf(backward)
    friction = (forward if one_way else 0.5 * (forward + backward)) * mass / _normal_of(column)
    load = 0.0 if one_way else 0.5 * (backward - forward) * mass
    stopping = 2.0 * abs(case.factor) * case.motion.measures.pgv / min(forward, backward)
    lasting = case.motion.lasts + stopping + RINGING * column.round_trip_time
    return _run(column, friction, load, case, lasting, one_way=one_way)


def _run(column: Any, friction: float, load: float, case: CaseShaken, lasting: float, *, one_way: bool) -> Solution:
    ground = case.motion.history(case.factor)
    law = Coulomb(friction, friction)
    problem = Problem(column, law, initial_load=load, ground_acceleration=ground, one_way=one_way)
    return uninterrupted(simulate(problem, lasting))


def _coupled(asked: SlidingAsked, case: CaseShaken, tell: Callable[[str], Any]) -> SlidingAnswer:
    rows, status = np.full((len(asked.forward), ANSWER_COLUMNS), math.nan), []
    for n, coefficient in enumerate(asked.forward.tolist()):
        tell(f"{case.motion.name}, yield {coefficient:.4g} g")
        run = coupled_run(asked, case, n)
        status.append(FINISHED if run.status.ok else run.status.name)
        if run.status.ok:
            rows[n] = _row_of(run)
    return SlidingAnswer(rows, status)


def _row_of(run: Solution) -> Floats:
    row, events = np.full(ANSWER_COLUMNS, math.nan), run.catalogue(0.0)
    places = run.slip(np.append(run.breaks, run.history.span[1]))
    row[DISPLACEMENT], row[PEAK_DISPLACEMENT] = places[-1], np.abs(places).max()
    row[PEAK_VELOCITY], row[SLIPS], row[SLIDING_TIME] = 0.0, len(events), 0.0
    if len(events):
        ends = events.end.fillna(run.history.span[1])
        fastest = events.iloc[int(events.peak_rate.abs().argmax())]
        row[PEAK_VELOCITY], row[PEAK_TIME] = abs(fastest.peak_rate), fastest.peak_time
        row[SLIDING_TIME], row[FIRST_START], row[LAST_STOP] = (ends - events.start).sum(), events.start.iloc[0], events.end.iloc[-1]
    return row
