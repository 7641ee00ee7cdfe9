"""Integrals in time over the pieces of a history."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, Positions
from stickslip.foundation.arrays import Floats

Integrand = Callable[[Positions], Floats]

FULL = 20
"""Number of nodes of the Gauss-Legendre rule on a piece. It is exact to degree 39, which includes the squares of the history's
polynomials; it integrates the law along a Taylor step to rounding.
"""

PIECES_TOGETHER = 1 << 14
"""Integrate this many pieces together, which keeps the memory bounded."""


@cache
def _gauss(nodes: int) -> tuple[Floats, Floats]:
    """Return places and weights of the Gauss-Legendre rule on [0, 1]."""
    places, weights = np.polynomial.legendre.leggauss(nodes)
    return 0.5 * (1.0 + places), 0.5 * weights


NODES, WEIGHTS = _gauss(FULL)
"""Places and weights of the full rule on [0, 1]."""
CURVED_NODES, CURVED_WEIGHTS = NODES**2 * (3.0 - 2.0 * NODES), 6.0 * NODES * (1.0 - NODES) * WEIGHTS
"""Those for what may be a square root at both ends, as a wave next to folds: the rule for s, where places are s^2 (3 - 2 s)."""


def over(
    history: History,
    piece: NDArray[np.intp],
    low: Floats,
    high: Floats,
    integrand: Integrand,
    *,
    leaped: Floats | None = None,
    nodes: int = FULL,
) -> Floats:
    """Integrate over the part [low, high] (in xi) of each piece, or of its echo `leaped` whole rows later if those are given."""
    leaped = np.zeros(len(piece)) if leaped is None else leaped
    cuts = [slice(n, n + PIECES_TOGETHER) for n in range(0, max(len(piece), 1), PIECES_TOGETHER)]
    parts = (places_in(history, piece[cut], low[cut], high[cut], leaped[cut], nodes=nodes) for cut in cuts)
    return np.concatenate([(integrand(at).reshape(weights.shape) * weights).sum(axis=1) for at, weights in parts])


def places_in(
    history: History, piece: NDArray[np.intp], low: Floats, high: Floats, leaped: Floats, *, nodes: int = FULL
) -> tuple[Positions, Floats]:
    """Return the places of the rule in the part [low, high] (in xi) of each piece, and their weights (s), shape (pieces, nodes)."""
    places, weights = _gauss(nodes)
    xi = low[:, None] + (high - low)[:, None] * places
    pieces = np.repeat(piece, nodes)
    at = Positions(pieces, xi.ravel(), np.repeat(leaped, nodes), np.zeros(xi.size, bool), pieces)
    speed, bend = history.store.speed[piece], history.store.bend[piece]
    return at, (speed[:, None] + 2.0 * bend[:, None] * xi) * weights * (high - low)[:, None]


def up_to(
    history: History, at: Positions, integrand: Integrand, pieces: NDArray[np.intp] | None = None, *, nodes: int = FULL
) -> Floats:
    """Integrate over all pieces, or the given ones, up to each position; rest that was not recorded is left out."""
    at = at.recorded()
    pieces = np.arange(len(history)) if pieces is None else pieces
    count = len(pieces)
    whole = np.concatenate([[0.0], np.cumsum(over(history, pieces, np.zeros(count), np.ones(count), integrand, nodes=nodes))])
    done = np.searchsorted(pieces, at.piece)
    total: Floats = whole[done]
    cut = np.append(pieces, -1)[done] == at.piece
    if cut.any():
        total[cut] += over(history, at.piece[cut], np.zeros(int(cut.sum())), at.xi[cut], integrand, nodes=nodes)
    return total


def between(history: History, first: Positions, last: Positions, integrand: Integrand) -> Floats:
    """Integrate from each first position to the last one of the same slip event; nothing outside the event enters."""

    def one(begin: int, end: int, low: float, high: float) -> float:
        pieces = np.arange(begin, end + 1)
        lows, highs = np.zeros(len(pieces)), np.ones(len(pieces))
        lows[0], highs[-1] = low, high
        return float(over(history, pieces, lows, highs, integrand).sum())

    return np.array([one(*ends) for ends in zip(first.piece, last.piece, first.xi, last.xi, strict=True)])
