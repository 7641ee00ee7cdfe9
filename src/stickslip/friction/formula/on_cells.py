"""Bound formulas on cells of slip rates in compiled code, which reads their tapes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats1, Floats2, Floats3, Integers1, Integers2
from stickslip.foundation.kernels.kernels import exact, exact_entry
from stickslip.friction.formula.operations import OPERATIONS
from stickslip.friction.formula.operations.enclosures import COUNT
from stickslip.friction.formula.operations.hyperbolic import logistic
from stickslip.friction.formula.tape import CONSTANT, NUMBER, VARIABLE, rule_by_code

rule = rule_by_code([*(one.taylor for one in OPERATIONS.values()), logistic])
"""Compiled code that writes the row of a node."""


class OnCells(NamedTuple):
    """What compiled code needs to bound the formulas of members."""

    steps: Integers2  # tape.Tape
    values: Floats1
    spans: Integers2  # (members, 2): first row of the formula of each member, and the end
    numbers: Floats3  # (2, members, numbers): low and high ends of the law's numbers, the slip last
    room: Floats2  # (nodes + 1, COUNT + 1): rows as in `operations.enclosures`, and one with the member whose rows are there


@exact
def _stand(of: OnCells, member: int) -> None:
    """Work out the nodes of a member that do not depend on the slip rate."""
    w, first, last = of.room, of.spans[member, 0], of.spans[member, 1]
    for row in range(first, last):
        code, n, place = of.steps[row, 0], row - first, of.steps[row, 1]
        w[n, 1], w[n, 2], w[n, 4], w[n, 5], w[n, COUNT] = 0.0, 0.0, 0.0, 0.0, of.steps[row, 3]
        if code == CONSTANT:
            w[n, 0], w[n, 3] = of.values[row], of.values[row]
        elif code == NUMBER:
            w[n, 0], w[n, 3] = of.numbers[0, member, place], of.numbers[1, member, place]
        elif of.steps[row, 3] > 1:
            w[n, 1], w[n, 4] = 1.0, 1.0  # where it is the slip rate; otherwise it is overwritten
        elif code > VARIABLE:
            rule(code, w, n, place, of.steps[row, 2])
        else:
            w[n, 0], w[n, 3] = of.numbers[0, member, -1], of.numbers[1, member, -1]  # the slip
    w[len(w) - 1, 0] = member


@exact
def enclose(of: OnCells, member: int, low: float, high: float) -> int:
    """Bound the formula of a member on a cell of slip rates (m/s); return the row of `of.room` with its coefficients."""
    w, first, last = of.room, of.spans[member, 0], of.spans[member, 1]
    if w[len(w) - 1, 0] != member:
        _stand(of, member)
    for row in range(first, last):
        if of.steps[row, 3] > 1:
            n, code = row - first, of.steps[row, 0]
            if code > VARIABLE:
                rule(code, w, n, of.steps[row, 1], of.steps[row, 2])
            else:
                w[n, 0], w[n, 3] = low, high
    return int(last - first - 1)


@exact_entry
def enclose_cells(of: OnCells, member: Integers1, low: Floats1, high: Floats1, found: Floats2) -> None:
    """Bound formulas on cells, each of one member; `found` has a row for each cell: low and high ends of three coefficients."""
    for k in range(len(low)):
        row = enclose(of, member[k], low[k], high[k])
        for column in range(COUNT):
            found[k, column] = of.room[row, column]
