"""The door of searches for periodic motion: a run of a uniform body that begins with a given wave, and not as its problem says."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from stickslip.engine.history.history import Floats
from stickslip.engine.session import Session
from stickslip.engine.state.layout import HistoryPiece


class WaveBefore(NamedTuple):
    """What a uniform body with waves remembers: the wave of the last round trip, and the contact at its end."""

    edges: Floats
    """Phases (s) between pieces of the wave, from 0 to the length of a round trip."""
    series: Floats
    """The wave 2 Z v - load that left the contact, plus the reference strength (Pa), a polynomial in xi on a piece: (n, TERMS)."""
    rate: float
    """Slip rate (m/s) at its end; at 0 the contact rests, if its law knows rest."""
    states: Floats
    """States of the law there, as its formulas see them in forward slip."""


def begin_with(session: Session[Any], wave: WaveBefore) -> None:
    """Put a wave in the place of the start of a run that has not begun: its first round trip is over, and held this wave.

    The history has the wave as the load of a contact at rest, which sends back what it meets. The first piece of load may jump.
    """
    count, state, pieces = session.count, session.state, len(wave.series)
    session.reserve(pieces)
    session.store.pieces[:pieces] = 0
    past = HistoryPiece.of(session.store.pieces[:pieces])
    past.phase_from, past.phase_to, past.speed = wave.edges[:-1], wave.edges[1:], np.diff(wave.edges)
    past.echo_of, past.amplified, past.gain = -1, np.nan, np.nan
    past.load[:] = -wave.series
    past.jump[0] = 1
    count.trip, count.length, count.trip_from, count.previous_to = 1, pieces, pieces, pieces
    count.mode = 0 if wave.rate == 0.0 and count.sticks == 1 else 1
    count.piece = int(session.problem.friction.piece_at(session.problem.law_slip, wave.rate))
    state.rate_now = wave.rate
    for n, value in enumerate(wave.states.tolist()):
        state.state_now[n] = value
