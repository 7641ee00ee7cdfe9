"""Panels of slip rates on which Gauss's rule integrates g = Z v + S mu to rounding, found from bounds of friction's derivatives.

On a panel that is short beside |mu'| / |mu''| friction is as smooth as an exponential over a few of its lengths. A panel on
which mu'' is so small that the area hardly depends on it is short enough, too. Any other panel is cut in two, so that no narrow
feature of the law lies between two nodes unseen.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine.codegen.compiler import kernel
from stickslip.engine.enclosure.formula import bound_at_slips, bound_friction
from stickslip.engine.folds.turns import DEPTH, FASTEST, NARROW, Resistance, cut_between
from stickslip.engine.state.layout import Floats

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
"""Gauss's rule on [-1, 1]."""
SMOOTH = 4.0
"""Length of a panel in units of |mu'| / |mu''|, up to which 16 nodes are enough for rounding."""
NEGLIGIBLE = 1e-16
"""Share of S times the length of the whole integral (1) that a panel may miss."""
MOST_PANELS = 4096
"""Largest number of panels of one integral."""


@kernel
def panels_between(g: Resistance, slip: float, low: float, high: float, edges: Floats) -> int:
    """Write the edges (m/s) of panels from one slip rate to another into `edges`, and return the number of panels.

    There must be room for one panel of each piece of the law, and four more. Panels that remain when only this room is left are as
    long as they are.
    """
    count, begin, missed = 0, 0.0, NEGLIGIBLE * (high - low)
    edges[0] = low
    for k in range(len(g.pieces)):
        piece, end = g.pieces[k], g.knots[k] if k < len(g.knots) else FASTEST
        start, stop = max(begin, low), min(end, high)
        begin = end
        if not start < stop:
            continue
        bound_at_slips(g.formulas, piece, slip, slip)
        g.cells[0, 0], g.cells[0, 1], waiting = start, stop, 1
        for _ in range(2 * len(edges) + DEPTH):
            if waiting == 0:
                break
            waiting -= 1
            first, last = g.cells[waiting, 0], g.cells[waiting, 1]
            friction = bound_friction(g.formulas, piece, first, last)
            slope, bend = max(-friction[2], friction[3]), 2.0 * max(-friction[4], friction[5])
            length = last - first
            fits = length * bend <= SMOOTH * slope or bend * length * length * length <= missed or length <= NARROW * last
            if fits or count + waiting + 3 + len(g.pieces) - k > len(edges) or waiting + 2 > DEPTH:
                count += 1
                edges[count] = last
                continue
            middle = cut_between(first, last)
            g.cells[waiting, 0], g.cells[waiting, 1] = middle, last
            g.cells[waiting + 1, 0], g.cells[waiting + 1, 1] = first, middle
            waiting += 2
    return count
