"""Bound formulas on cells of slip rates in compiled code, which reads their tapes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.friction.formula.operations import OPERATIONS
from stickslip.friction.formula.operations.enclosures import COUNT
from stickslip.friction.formula.operations.hyperbolic import logistic
from stickslip.friction.formula.tape import CONSTANT, NUMBER, VARIABLE, Integers

_ADD, _SUB, _MUL, _DIV, _POW, _SIN, _COS, _EXP, _LOG, _SQRT, _TANH, _ARCSINH, _EXPM1, _LOG1P = (
    one.taylor for one in OPERATIONS.values()
)


class Formulas(NamedTuple):
    """What compiled code needs to bound the formulas of members."""

    steps: Integers  # tape.Tape
    values: Floats
    spans: Integers  # (members, 2): first row of the formula of each member, and the end
    numbers: Floats  # (2, members, numbers): low and high ends of the law's numbers, of which the slip is the last
    room: Floats  # (nodes + 1, COUNT + 1): rows as in `operations.enclosures`, and one with the member whose rows are there


@exact
def rule(code: int, w: Floats, n: int, i: int, j: int) -> None:
    """Write the Taylor coefficients of a node: the codes are CODES."""
    if code == 3:
        _ADD(w, n, i, j)
    elif code == 4:
        _SUB(w, n, i, j)
    elif code == 5:
        _MUL(w, n, i, j)
    elif code == 6:
        _DIV(w, n, i, j)
    elif code == 7:
        _POW(w, n, i, j)
    elif code == 8:
        _SIN(w, n, i, j)
    elif code == 9:
        _COS(w, n, i, j)
    elif code == 10:
        _EXP(w, n, i, j)
    elif code == 11:
        _LOG(w, n, i, j)
    else:
        _other_rule(code, w, n, i, j)


@exact
def _other_rule(code: int, w: Floats, n: int, i: int, j: int) -> None:
    if code == 12:
        _SQRT(w, n, i, j)
    elif code == 13:
        _TANH(w, n, i, j)
    elif code == 14:
        _ARCSINH(w, n, i, j)
    elif code == 15:
        _EXPM1(w, n, i, j)
    elif code == 16:
        _LOG1P(w, n, i, j)
    else:
        logistic(w, n, i, j)


@exact
def _stand(of: Formulas, member: int) -> None:
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
def enclose(of: Formulas, member: int, low: float, high: float) -> int:
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


@exact
def enclose_cells(  # noqa: PLR0917 # arrays that cross from Python to compiled code
    steps: Integers,
    values: Floats,
    spans: Integers,
    numbers: Floats,
    room: Floats,
    member: Integers,
    low: Floats,
    high: Floats,
    found: Floats,
) -> None:
    """Bound formulas on cells, each of one member; `found` has a row for each cell: low and high ends of three coefficients."""
    of = Formulas(steps, values, spans, numbers, room)
    for k in range(len(low)):
        row = enclose(of, member[k], low[k], high[k])
        for column in range(COUNT):
            found[k, column] = room[row, column]
