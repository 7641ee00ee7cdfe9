"""Bound formulas on boxes of slip, slip rate and the law's numbers in compiled code, which reads their tapes."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.foundation.arrays import Floats1, Floats2, Floats3, Integers2
from stickslip.foundation.kernels.kernels import exact_entry
from stickslip.friction.formula.operations import OPERATIONS
from stickslip.friction.formula.operations.sets import HIGH, LOW
from stickslip.friction.formula.tape import CONSTANT, NUMBER, VARIABLE, rule_by_code

rule = rule_by_code([one.bounds for one in OPERATIONS.values()])
"""Compiled code that writes the row of a node."""


class OnBoxes(NamedTuple):
    """What compiled code needs to bound a formula on boxes."""

    steps: Integers2  # tape.Tape
    values: Floats1
    numbers: Floats3  # (2, boxes, numbers): low and high ends of the law's numbers
    variables: Floats3  # (2, boxes, variables): and of slip, slip rate and states
    room: Floats2  # (nodes, 2): rows as in `operations.sets`


@exact_entry
def bound_boxes(of: OnBoxes, found: Floats2) -> None:
    """Write the bounds of a formula on boxes into the rows of `found`."""
    w = of.room
    for box in range(found.shape[1]):
        for row in range(len(of.steps)):
            code, place = of.steps[row, 0], of.steps[row, 1]
            if code > VARIABLE:
                rule(code, w, row, place, of.steps[row, 2])
            elif code == CONSTANT:
                w[row, LOW], w[row, HIGH] = of.values[row], of.values[row]
            elif code == NUMBER:
                w[row, LOW], w[row, HIGH] = of.numbers[0, box, place], of.numbers[1, box, place]
            else:
                w[row, LOW], w[row, HIGH] = of.variables[0, box, place], of.variables[1, box, place]
        found[0, box], found[1, box] = w[len(of.steps) - 1, LOW], w[len(of.steps) - 1, HIGH]
