"""The start of a run from a given wave, and not as its problem says."""

from __future__ import annotations

from typing import cast

import numpy as np

from stickslip.engine import TERMS, HistoryPiece
from stickslip.extensions.cycles.waves.fronts import FirstCells
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers
from stickslip.run import ExactRun


def begin_with(run: ExactRun, edges: Floats, series: Floats, rate: float, beside: Floats) -> None:
    """Let a run begin with a wave that left the contact of a body with waves, over a round trip before its start.

    It is 2 Z v - load, plus the reference strength (Pa), a polynomial in xi between each two phases (s) of `edges`. A body of
    layers has one in each cell, of each piece: those that left their even places (`engine.waves.ladder`). The contact has the slip
    rate (m/s) and rests at 0 if its law knows rest. `beside` are its states as formulas see them in forward slip, and rate (m/s)
    and push (Pa) of a driver that moves by itself, where it meets the beginning of the wave.
    """
    run.reserve(len(series))
    run.state.rate_now, run.count.piece = rate, int(run.problem.friction.piece_at(run.problem.law_slip, rate))
    *states, run.state.driver_rate, run.state.driver_push = beside.tolist()
    for n, value in enumerate(states):
        run.state.state_now[n] = value
    if len(run.setup.ladder):
        rows = series.reshape(len(series), -1, TERMS)
        run.begin_with_rows(rows)
        series = FirstCells.of(cast(OfLayers, run.problem.body)).as_one(rows)
    else:
        run.begun_with = series[:, None]
    _put_wave(run, edges, series)


def _put_wave(run: ExactRun, edges: Floats, series: Floats) -> None:
    """Put a wave into a history without pieces, as the load of a contact at rest, which sends back what it meets.

    The first round trip is over then, and the second begins, whose first piece of load may jump.
    """
    count, pieces = run.count, len(series)
    run.store.pieces[:pieces] = 0
    past = HistoryPiece.of(run.store.pieces[:pieces])
    past.phase_from, past.phase_to, past.speed = edges[:-1], edges[1:], np.diff(edges)
    past.echo_of, past.amplified, past.gain = -1, np.nan, np.nan
    past.load[:] = -series
    past.jump[0] = 1
    count.trip, count.length, count.trip_from, count.previous_to = 1, pieces, pieces, pieces
    count.mode = 0 if run.state.rate_now == 0.0 and count.sticks == 1 else 1
