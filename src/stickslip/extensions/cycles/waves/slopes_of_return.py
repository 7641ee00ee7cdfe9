"""What a return to a section makes of small disturbances of its start, from the run itself: see `compiled.echoes`."""

from __future__ import annotations

from typing import Any

import numpy as np

from stickslip.engine import Cause
from stickslip.extensions.cycles.compiled.along_run import FIRST_STATE_ROW, RunNumbers
from stickslip.extensions.cycles.compiled.echo_parts import WAVE_PLACES, WAVE_POINTS, PartsOfRun, WavesOfRun
from stickslip.extensions.cycles.compiled.echoes import NO_ROOM, carry, read_waves
from stickslip.extensions.cycles.tangent import numbers_of_law
from stickslip.extensions.cycles.waves.mesh import NODES, POWERS_OF_TERMS, TERMS_OF_VALUES
from stickslip.extensions.cycles.waves.section import WaveReturn
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import as_waves

TO_POINTS = np.vander(WAVE_PLACES, NODES, increasing=True) @ POWERS_OF_TERMS @ TERMS_OF_VALUES
"""From the values of a mesh on a piece to those at the points of a part."""
FIRST_ROOM, MORE_ROOM, MOST_ROOM = 2, 4, 200
"""Room for so many parts for each piece (1), by what factor it grows, and the most."""
SMALL_JUMP = 1e-2
"""Jumps of the slip rate are small that are below this share (1) of the largest."""

UNHINDERED: Any = (np.zeros(0), 0.0, 0.0, np.inf, -np.inf, 0.0)
"""Numbers of a run without a lag that matters, without play, and without stops."""


def is_known(met: WaveReturn) -> bool:
    """Return True if disturbances of a return are known from its run: else they are by differences of runs."""
    history, law = met.history, met.history.problem.friction
    if not met.source.is_one_wave or len(met.start.kept) or law.depends_on_slip or history.store.bend.any():
        return False
    if law.states and history.rests[met.first : met.piece + 1].any():
        return False
    return not _jumps(met)


def _jumps(met: WaveReturn) -> bool:
    """Return True if the slip rate jumps on the way: a jump that moves leaves more in the wave than a kink.

    Small jumps are echoes of places where the pieces of the wave do not quite meet, which do not move.
    """
    store = met.history.store
    rate, rests = store.rate[met.first : met.piece + 1], met.history.rests[met.first : met.piece]
    ends = rate.sum(axis=1)
    off = np.abs(np.where(rests, 0.0, ends[:-1]) - rate[1:, 0])
    leaps = (store.cause[met.first : met.piece + 1] == Cause.FOLD).any()
    return bool(leaps or off.max(initial=0.0) > SMALL_JUMP * np.abs(ends).max())


def numbers_along(met: WaveReturn) -> WavesOfRun:
    """Return a run for compiled code."""
    history, problem, law = met.history, met.history.problem, numbers_of_law(met.history.problem.friction)
    body, store = as_waves(problem.body), history.store
    forces = 0.0, body.total_damping, body.inertia, problem.normal, problem.first_pull_rate
    run = RunNumbers(*store, *forces, law.calls, law.constants, law.reverses, law.sticks, law.has_knots, *UNHINDERED)
    lasts = np.array(store.speed)
    trip, back = history.round_trip_time, float(body.reflection)
    return WavesOfRun(run, history.start, lasts, trip, back, body.echo_impedance, met.first, int(met.at_onset))


def grown_columns(met: WaveReturn, columns: Floats) -> Floats:
    """Return what disturbances of the start of a return have become where it ends, in columns: states, and wave on the mesh."""
    waves, states = numbers_along(met), len(met.start.states)
    many, room, count = columns.shape[1], FIRST_ROOM * (met.piece + 1), NO_ROOM
    while count == NO_ROOM and room <= MOST_ROOM * (met.piece + 1):
        parts = _begun(met, columns, room)
        count, room = carry(waves, parts, met.piece, met.place), MORE_ROOM * room
    assert count != NO_ROOM, "parts of pieces are bounded"
    mesh = met.start.mesh
    found = np.empty((len(mesh.phases), many))
    times = met.end - waves.trip + mesh.phases
    read_waves(waves, parts, count, np.column_stack([times, met.source.pace_at(mesh.phases)]), found)
    return np.concatenate([parts.now[FIRST_STATE_ROW : FIRST_STATE_ROW + states], found])


def _begun(met: WaveReturn, columns: Floats, room: int) -> PartsOfRun:
    """Return the parts of a run at its start, whose first are those of its wave."""
    states, many = len(met.start.states), columns.shape[1]
    size = FIRST_STATE_ROW + states
    parts = PartsOfRun(np.zeros((room, 2)), np.empty((room * WAVE_POINTS, many)), *_rows(many, size))
    parts.ends[: met.first, 0], parts.ends[: met.first, 1] = met.start.mesh.edges[:-1], met.start.mesh.edges[1:]
    given = TO_POINTS @ columns[states:].reshape(met.first, NODES, many)
    parts.waves[: met.first * WAVE_POINTS] = given.reshape(-1, many)
    parts.now[FIRST_STATE_ROW:size] = columns[:states]
    return parts


def _rows(many: int, size: int) -> tuple[Floats, Floats, Floats, Floats]:
    return np.zeros((WAVE_POINTS, many)), np.zeros((size, many)), np.zeros((size, many)), np.zeros(many)


def slopes_of(met: WaveReturn, scale: Floats) -> Floats:
    """Return the derivative of a return by its start over a scale: states, and wave at the points of the mesh."""
    return grown_columns(met, np.eye(len(scale))) * scale / scale[:, None]
