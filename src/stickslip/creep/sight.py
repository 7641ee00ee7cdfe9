"""Ball arithmetic of a law of slip for leaps over creep: it tells how far friction can be from its value at a given slip."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from stickslip.engine.codegen.compiler import CompiledFormula, compile_formula
from stickslip.engine.state.layout import Ball, Floats
from stickslip.friction.formula.expression import Expression


@dataclass(frozen=True)
class Sight:
    """A compiled formula, with its constants at a reference slip."""

    formula: CompiledFormula
    constants: Floats

    @classmethod
    def of(cls, tree: Expression, parameters: tuple[str, ...], values: tuple[float, ...], reference: float) -> Self:
        """Return a formula with these values of its parameters; slips count from the reference (m)."""
        formula = compile_formula(tree, parameters, ())
        numbers, constants = np.array(values), np.zeros(formula.size)
        formula.fill(numbers, reference, constants)
        return cls(formula, constants)

    def change(self, slip: float, radius: float) -> float:
        """Return a bound (1) of the change of friction at rest from a slip to slips up to `radius` away (both m).

        The bound is infinite or NaN where nothing is known. Slips count from the reference.
        """
        ball = Ball(np.zeros(Ball.total))
        ball.slip, ball.at_slip = radius, slip
        self.formula.fill_radii(self.constants, ball.numbers)
        return float(ball.friction)
