"""The start of a run of a uniform body from a given wave, and not as its problem says: what searches for periodic motion need."""

from __future__ import annotations

import numpy as np

from stickslip.engine.state.layout import Counts, Floats, HistoryPiece, State, Store


def put_wave(store: Store, count: Counts, state: State, edges: Floats, series: Floats) -> None:
    """Put a wave into a history without pieces, as the load of a contact at rest, which sends back what it meets.

    The first round trip is over then, and the second begins, whose first load may jump. Numbers are those of `Session.begin_with`.
    """
    pieces = len(series)
    store.pieces[:pieces] = 0
    past = HistoryPiece.of(store.pieces[:pieces])
    past.phase_from, past.phase_to, past.speed = edges[:-1], edges[1:], np.diff(edges)
    past.echo_of, past.amplified, past.gain = -1, np.nan, np.nan
    past.load[:] = -series
    past.jump[0] = 1
    count.trip, count.length, count.trip_from, count.previous_to = 1, pieces, pieces, pieces
    count.mode = 0 if state.rate_now == 0.0 and count.sticks == 1 else 1
