"""Values, changes and derivatives of formulas at points in compiled code, which reads their tapes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats, Floats1, Floats2, Integers1, Integers2
from stickslip.foundation.kernels.kernels import exact, exact_entry
from stickslip.friction.formula.expression import VARIABLES as _VARIABLES
from stickslip.friction.formula.operations import LARGEST_EXPONENT, OPERATIONS
from stickslip.friction.formula.operations.sets import REFERENCE, SLOPE, STEP, VALUE
from stickslip.friction.formula.tape import NUMBER, VARIABLE, rule_by_code

rule = rule_by_code([one.change for one in OPERATIONS.values()])
"""Compiled code that writes the row of a node."""

NUMBER_OF_VARIABLES = len(_VARIABLES)
"""Number of variables of formulas."""


class AtPoints(NamedTuple):
    """What compiled code needs to follow the formulas of members from point to point."""

    steps: Integers2  # tape.Tape
    values: Floats1
    spans: Integers2  # (members, 2): first row of the formula of each member, and the end
    numbers: Floats2  # (members, numbers): the law's numbers, the slip (m) at the reference point last
    room: Floats2  # (NUMBER_OF_VARIABLES + nodes + 1, 4): rows as in `operations.changes`: variables, nodes, a limited argument


@exact
def _limit(w: Floats, i: int, to: int) -> None:
    """Write the row of min(a, LARGEST_EXPONENT)."""
    start, end = min(w[i, REFERENCE], LARGEST_EXPONENT), min(w[i, VALUE], LARGEST_EXPONENT)
    within = w[i, REFERENCE] <= LARGEST_EXPONENT and w[i, VALUE] <= LARGEST_EXPONENT
    w[to, STEP] = w[i, STEP] if within else end - start
    w[to, SLOPE] = w[i, SLOPE] if w[i, VALUE] <= LARGEST_EXPONENT else 0.0
    w[to, REFERENCE], w[to, VALUE] = start, end


@exact
def walk(of: AtPoints, member: int) -> int:
    """Work out all nodes of the formula of a member from the rows of its variables; return the row of `of.room` with its value.

    The last row is for an argument that is limited.
    """
    w, first, last = of.room, of.spans[member, 0], of.spans[member, 1]
    spare = len(w) - 1
    for row in range(first, last):
        n, code, i = NUMBER_OF_VARIABLES + row - first, of.steps[row, 0], of.steps[row, 1]
        if code > VARIABLE:
            if of.steps[row, 3] == 1:
                _limit(w, NUMBER_OF_VARIABLES + i, spare)
                rule(code, w, n, spare, spare)
            else:
                rule(code, w, n, NUMBER_OF_VARIABLES + i, NUMBER_OF_VARIABLES + of.steps[row, 2])
        elif code == VARIABLE:
            for column in range(4):
                w[n, column] = w[i, column]
        else:
            number = of.numbers[member, i] if code == NUMBER else of.values[row]
            w[n, REFERENCE], w[n, STEP], w[n, VALUE], w[n, SLOPE] = number, 0.0, number, 0.0
    return int(NUMBER_OF_VARIABLES + last - first - 1)


@exact
def put_variable(of: AtPoints, place: int, reference: float, step: float, slope: float) -> None:
    """Write the row of a variable."""
    w = of.room
    w[place, REFERENCE], w[place, STEP], w[place, VALUE], w[place, SLOPE] = reference, step, reference + step, slope


@exact
def change_at(of: AtPoints, member: int, slip_step: float, rate: float) -> int:
    """Work out the change of the formula of a member from rest to a point; return the row of `of.room` with the result."""
    put_variable(of, 0, of.numbers[member, -1], slip_step, 0.0)
    put_variable(of, 1, 0.0, rate, 1.0)
    for place in range(2, NUMBER_OF_VARIABLES):
        put_variable(of, place, 0.0, 0.0, 0.0)
    return walk(of, member)


@exact_entry
def changes_at(of: AtPoints, member: Integers1, slip_step: Floats1, rate: Floats1, found: Floats2) -> None:
    """Write mu(slip + slip_step, rate) - mu(slip, 0) and dmu/drate at points into the rows of `found`, with all states 0.

    Each point is of a `member`; the step of slip (m) is one number, or one for each point.
    """
    for k in range(len(rate)):
        row = change_at(of, member[k], slip_step[k if len(slip_step) > 1 else 0], rate[k])
        found[0, k], found[1, k] = of.room[row, STEP], of.room[row, SLOPE]


@exact_entry
def slopes_at(of: AtPoints, points: Floats2, found: Floats2) -> None:
    """Write the value of a formula at points, and its derivatives by their coordinates, into the rows of `found`.

    A row of `points` has slip, slip rate and states of one point; it is that of a member, if there is more than one.
    """
    for k in range(len(points)):
        for by in range(points.shape[1]):
            for place in range(NUMBER_OF_VARIABLES):
                number = points[k, place] if place < points.shape[1] else 0.0
                put_variable(of, place, number, 0.0, 1.0 if place == by else 0.0)
            row = walk(of, k if len(of.numbers) > 1 else 0)
            found[0, k], found[1 + by, k] = of.room[row, VALUE], of.room[row, SLOPE]
