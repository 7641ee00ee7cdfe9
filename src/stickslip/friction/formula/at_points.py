"""Values, changes and derivatives of formulas at points in compiled code, which reads their tapes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats
from stickslip.foundation.compiled import exact
from stickslip.friction.formula.expression import VARIABLES as _VARIABLES
from stickslip.friction.formula.operations import LARGEST_EXPONENT, OPERATIONS
from stickslip.friction.formula.operations.changes import REFERENCE, SLOPE, STEP, VALUE
from stickslip.friction.formula.tape import NUMBER, VARIABLE, Integers

_ADD, _SUB, _MUL, _DIV, _POW, _SIN, _COS, _EXP, _LOG, _SQRT, _TANH, _ARCSINH, _EXPM1, _LOG1P = (
    one.change for one in OPERATIONS.values()
)

MANY = len(_VARIABLES)
"""Number of variables of formulas."""


class Points(NamedTuple):
    """What compiled code needs to follow the formulas of members from point to point."""

    steps: Integers  # tape.Tape
    values: Floats
    spans: Integers  # (members, 2): first row of the formula of each member, and the end
    numbers: Floats  # (members, numbers): the law's numbers, of which the slip (m) at the reference point is the last
    room: Floats  # (MANY + nodes + 1, 4): rows as in `operations.changes` of variables, of nodes, and of an argument that is limited


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
def _limit(w: Floats, i: int, to: int) -> None:
    """Write the row of min(a, LARGEST_EXPONENT)."""
    start, end = min(w[i, REFERENCE], LARGEST_EXPONENT), min(w[i, VALUE], LARGEST_EXPONENT)
    within = w[i, REFERENCE] <= LARGEST_EXPONENT and w[i, VALUE] <= LARGEST_EXPONENT
    w[to, STEP] = w[i, STEP] if within else end - start
    w[to, SLOPE] = w[i, SLOPE] if w[i, VALUE] <= LARGEST_EXPONENT else 0.0
    w[to, REFERENCE], w[to, VALUE] = start, end


@exact
def walk(tape: tuple[Integers, Floats], span: Integers, numbers: Floats, variables: Floats, w: Floats) -> int:
    """Work out all nodes of a formula from the rows of its variables, and return the row of its value.

    The last row of `w` is for an argument that is limited.
    """
    steps, values = tape
    for row in range(span[0], span[1]):
        n, code, i = row - span[0], steps[row, 0], steps[row, 1]
        if code > VARIABLE:
            if steps[row, 3] == 1:
                _limit(w, i, len(w) - 1)
                rule(code, w, n, len(w) - 1, len(w) - 1)
            else:
                rule(code, w, n, i, steps[row, 2])
        elif code == VARIABLE:
            for column in range(4):
                w[n, column] = variables[i, column]
        else:
            number = numbers[i] if code == NUMBER else values[row]
            w[n, REFERENCE], w[n, STEP], w[n, VALUE], w[n, SLOPE] = number, 0.0, number, 0.0
    return int(span[1] - span[0] - 1)


@exact
def change_at(of: Points, member: int, slip_step: float, rate: float) -> int:
    """Work out the change of the formula of a member from rest to a point; return the row of `of.room` with the result."""
    variables, w, start = of.room[: MANY], of.room[MANY :], of.numbers[member, -1]
    variables[0, REFERENCE], variables[0, STEP], variables[0, VALUE], variables[0, SLOPE] = start, slip_step, start + slip_step, 0.0
    variables[1, REFERENCE], variables[1, STEP], variables[1, VALUE], variables[1, SLOPE] = 0.0, rate, rate, 1.0
    variables[2:] = 0.0
    return MANY + walk((of.steps, of.values), of.spans[member], of.numbers[member], variables, w)


@exact
def changes_at(  # noqa: PLR0917 # arrays that cross from Python to compiled code
    steps: Integers,
    values: Floats,
    spans: Integers,
    numbers: Floats,
    room: Floats,
    member: Integers,
    slip_step: Floats,
    rate: Floats,
    found: Floats,
) -> None:
    """Write mu(slip + slip_step, rate) - mu(slip, 0) and dmu/drate at points into the rows of `found`, with all states 0.

    Each point is of a `member`; the step of slip (m) is one number, or one for each point.
    """
    of = Points(steps, values, spans, numbers, room)
    for k in range(len(rate)):
        row = change_at(of, member[k], slip_step[k if len(slip_step) > 1 else 0], rate[k])
        found[0, k], found[1, k] = room[row, STEP], room[row, SLOPE]


@exact
def slopes_at(  # noqa: PLR0917 # arrays that cross from Python to compiled code
    steps: Integers,
    values: Floats,
    spans: Integers,
    numbers: Floats,
    room: Floats,
    points: Floats,
    found: Floats,
) -> None:
    """Write the value of a formula at points, and its derivatives by their coordinates, into the rows of `found`.

    A row of `points` has slip, slip rate and states of one point; `numbers` has one row for all points, or one for each.
    """
    variables, w = room[: MANY], room[MANY :]
    for k in range(len(points)):
        own = numbers[k if len(numbers) > 1 else 0]
        for by in range(points.shape[1]):
            variables[:] = 0.0
            for place in range(points.shape[1]):
                variables[place, REFERENCE], variables[place, VALUE] = points[k, place], points[k, place]
            variables[by, SLOPE] = 1.0
            row = walk((steps, values), spans[0], own, variables, w)
            found[0, k], found[1 + by, k] = w[row, VALUE], w[row, SLOPE]
