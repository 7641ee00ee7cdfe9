"""What is proven of a run: by how much, at most, it misses the contact equation at any moment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.foundation.brief_repr import brief_repr
from stickslip.foundation.formatting import brief
from stickslip.problem.problem import Problem
from stickslip.trajectory.history import History


@dataclass(frozen=True)
class Proof:
    """Bounds of how far a run's polynomials miss the contact equation at any moment.

    Leaps over creep have error bounds of their own (`Solution.creep`). The bound leaves out rounding in the law's formula:
    where that exceeds the tolerance, `Solution.rounding_note` says so. Method and proof: docs/theory/certificate.md.
    """

    residual: float
    """Largest bound (Pa; block: N) of |Z v + S mu(u, v) - load|, with inertia and damping where the contact has them."""
    relative: float
    """The same as a share (1) of the normal stress, or force."""
    unproven: int
    """Number of pieces of the history that are checked at places only: the law is not analytic where the slip rate passes zero."""
    undecided: int
    """Number of steps in which the selection rule is checked at places only: where folds move, it is not decided whether another
    solution that the rule prefers comes and goes between them."""
    unit: str
    """Unit of the residual: Pa or N."""

    units: ClassVar = {"relative": "1"}
    __repr__ = brief_repr

    @property
    def text(self) -> str:
        """One line on the bound."""
        share = f"{self.relative:.1g} of the normal {'stress' if self.unit == 'Pa' else 'force'}"
        found = f"the contact equation holds to {brief(self.residual, self.unit)} at every moment, {share}"
        if self.unproven:
            pieces = "1 piece" if self.unproven == 1 else f"{self.unproven} pieces"
            found += f", except in {pieces} next to a slip rate of zero, checked at places and not proven"
        if self.undecided:
            steps = "1 step" if self.undecided == 1 else f"{self.undecided} steps"
            found += f"; in {steps} the selection rule is checked at places only"
        return found


def proof_of(history: History, undecided: int) -> Proof:
    """Return what is proven of a history, with the number of steps in which the selection rule is not proven to hold."""
    residual = history.store.residual
    return proof_from(history.problem, np.nanmax(residual, initial=0.0), int(np.count_nonzero(np.isnan(residual))), undecided)


def proof_from(problem: Problem, residual: float, unproven: int, undecided: int) -> Proof:
    """Return what is proven of a run, from its largest bound (Pa or N) and the numbers of pieces and steps without a proof."""
    return Proof(float(residual), float(residual / problem.normal), int(unproven), int(undecided), problem.load_unit)
