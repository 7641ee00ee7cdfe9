"""Bound formulas on boxes of slip, slip rate and the law's numbers in compiled code, which reads their tapes."""

from __future__ import annotations

from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.friction.formula.operations import OPERATIONS
from stickslip.friction.formula.operations.sets import HIGH, LOW
from stickslip.friction.formula.tape import CONSTANT, NUMBER, VARIABLE, Integers

_ADD, _SUB, _MUL, _DIV, _POW, _SIN, _COS, _EXP, _LOG, _SQRT, _TANH, _ARCSINH, _EXPM1, _LOG1P = (
    one.bounds for one in OPERATIONS.values()
)


@exact
def rule(code: int, w: Floats, n: int, i: int, j: int) -> None:
    """Write the row of a node: the codes are CODES."""
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
    else:
        _LOG1P(w, n, i, j)


@exact
def bound_boxes(  # noqa: PLR0917 # arrays that cross from Python to compiled code
    steps: Integers, values: Floats, numbers: Floats, variables: Floats, room: Floats, found: Floats
) -> None:
    """Write the bounds of a formula on boxes into the rows of `found`.

    `numbers` and `variables` have low and high ends along the first axis, and along the second one an entry for each box.
    """
    for box in range(found.shape[1]):
        for row in range(len(steps)):
            code, place = steps[row, 0], steps[row, 1]
            if code > VARIABLE:
                rule(code, room, row, place, steps[row, 2])
            elif code == CONSTANT:
                room[row, LOW], room[row, HIGH] = values[row], values[row]
            elif code == NUMBER:
                room[row, LOW], room[row, HIGH] = numbers[0, box, place], numbers[1, box, place]
            else:
                room[row, LOW], room[row, HIGH] = variables[0, box, place], variables[1, box, place]
        found[0, box], found[1, box] = room[len(steps) - 1, LOW], room[len(steps) - 1, HIGH]
