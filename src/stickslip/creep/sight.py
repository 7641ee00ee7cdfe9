"""Guards of a law of slip for leaps over creep: they tell which parts of the law leave no trace at a given slip (see `guards`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from stickslip.engine.codegen.compiler import CompiledFormula, compile_formula
from stickslip.engine.state.layout import Floats
from stickslip.friction.formula.expression import Expression


@dataclass(frozen=True)
class Sight:
    """The guards of a compiled formula, with its constants at a reference slip."""

    formula: CompiledFormula
    constants: Floats

    @classmethod
    def of(cls, tree: Expression, parameters: tuple[str, ...], values: tuple[float, ...], reference: float) -> Self:
        """Return the guards of a formula with these values of its parameters; slips count from the reference (m)."""
        formula = compile_formula(tree, parameters)
        numbers, constants = np.array(values), np.zeros(formula.size)
        formula.fill(numbers, reference, constants)
        return cls(formula, constants)

    def used_up(self, start: float, end: float) -> float:
        """Return the share of its room that the most critical guard uses up from one slip to another (m, minus the reference).

        Beyond 1 a part of the formula that leaves no trace at the start may have come into view.
        """
        if self.formula.guard_count == 0:
            return 0.0
        before, after = self._at(start), self._at(end)
        return float(np.max(before[:, 1] * (after[:, 0] - before[:, 0])))

    def _at(self, slip: float) -> Floats:
        """Return the arguments and pulls of the guards at a slip (m, minus the reference)."""
        out = np.zeros(2 * self.formula.guard_count)
        self.formula.fill_guards(self.constants, slip, out)
        return out.reshape(-1, 2)
