"""Areas between g = Z v + S mu and a load, to rounding: by Gauss's rule on panels that bounds of friction's derivatives ensure.

On a panel that is short in comparison with |mu'| / |mu''|, friction is as smooth as an exponential over a few of its lengths. A
panel is also short enough if mu'' is so small that the area hardly depends on it. Any other panel is cut in two, so that no narrow
feature of the law is missed between two nodes.
"""

from __future__ import annotations

import numpy as np

from stickslip.contact.slopes import NARROW_SLOPE_CELL, Pieces, cut_between, pieces_of
from stickslip.foundation.arrays import Floats
from stickslip.problem import Resistance

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Gauss's rule on [-1, 1]."""
SMOOTH = 4.0
"""16 nodes reach rounding on panels up to this length, in units of |mu'| / |mu''|."""
NEGLIGIBLE_AREA = 1e-16
"""Error allowed on a panel, as a share (1) of S times the length of the whole integral."""
MOST_PANELS = 4096
"""Largest number of panels of one integral, besides one for each piece of the law. When it is reached, no more panels are cut."""


def area(g: Resistance, start: float, end: float, excess: float) -> float:
    """Return the integral of g - load from start to end (m/s), in Pa m/s; the load exceeds the static strength by `excess` (Pa).

    For one contact the same slip rates always give the same panels, so that areas which should cancel do.
    """
    if end <= start:
        return 0.0
    edges = panels_between(pieces_of([g]), start, end)
    half = 0.5 * np.diff(edges)
    rates = edges[:-1, None] + half[:, None] * (1.0 + NODES)
    return float(np.sum(half * ((g.excess(rates) - excess) @ WEIGHTS)))


def panels_between(of: Pieces, low: float, high: float) -> Floats:
    """Return the edges (m/s) of panels from one slip rate to another of a single contact."""
    first, last, piece = np.maximum(of.begin, low), np.minimum(of.end, high), np.arange(len(of.begin))
    some, missed = first < last, NEGLIGIBLE_AREA * (high - low)
    first, last, piece, most = first[some], last[some], piece[some], MOST_PANELS + len(piece)
    edges = [np.array([high])]
    while len(first):
        friction = np.abs(of.friction(piece, first, last)[:, 1:]).max(axis=0)
        slope, bend, length = friction[0], 2.0 * friction[1], last - first
        with np.errstate(invalid="ignore"):
            fits = (length * bend <= SMOOTH * slope) | (bend * length**3 <= missed) | (length <= NARROW_SLOPE_CELL * last)
        if sum(map(len, edges)) + 2 * len(first) > most:
            fits[:] = True
        edges.append(first[fits])
        first, last, piece = first[~fits], last[~fits], piece[~fits]
        middle = cut_between(first, last)
        first, last, piece = np.concatenate((first, middle)), np.concatenate((middle, last)), np.tile(piece, 2)
    return np.sort(np.concatenate(edges))
