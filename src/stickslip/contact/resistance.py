"""The resistance g(s) = Z s + S mu(u, s) of a contact that slips at rate s, kept as an excess over its static strength."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.bodies import ElasticSlab
from stickslip.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.friction.difference import difference
from stickslip.friction.expression import Expression
from stickslip.problem import Problem


@dataclass(frozen=True)
class Resistance:
    """g of one contact at one law slip: impedance Z (Pa s/m), normal stress S (Pa), law_slip (m).

    The contact equation, paper eqs (12)-(13), reads excess(s) = load - S mu_static. s >= 0 is the magnitude of the slip rate
    (m/s); for slip backwards the load changes sign.
    """

    law: FrictionLaw
    impedance: float
    normal: float
    law_slip: float

    @property
    def strength(self) -> float:
        """Static strength S mu_static (Pa)."""
        return self.normal * float(self.law.static_coefficient(self.law_slip))

    @property
    def start(self) -> float:
        """Excess at s = 0+ (Pa): minus the step from static to sliding friction."""
        return -self.normal * self.law.static_excess if self.law.static_excess else 0.0

    def excess_and_slope(self, rate: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """g(s) - S mu_static (Pa) and g'(s) (Pa s/m) at slip rates s >= 0 (m/s; 0 means 0+).

        Near-equal frictions are not subtracted: the excess keeps its digits down to s = 0.
        """
        rate = np.asarray(rate, float)
        step, slope = np.empty(rate.shape), np.empty(rate.shape)
        piece = self.law.piece_at(self.law_slip, rate)
        first = int(self.law.piece_at(self.law_slip))
        for i in np.unique(piece).tolist():
            chosen = piece == i
            own_step, slope[chosen] = difference(self.trees[i], self.law.numbers(i), self.law_slip, 0.0, rate[chosen])
            step[chosen] = own_step + (self._at_rest(i) - self._at_rest(first) if i != first else 0.0)
        return self.impedance * rate + self.normal * step + self.start, self.impedance + self.normal * slope

    @cached_property
    def trees(self) -> tuple[Expression, ...]:
        """The law's formulas."""
        return self.law.trees()

    @property
    def rate_knots(self) -> tuple[float, ...]:
        """Slip rates (m/s) at which g has a kink, ascending."""
        return self.law.knots if self.law.knot_variable == "rate" else ()

    def _at_rest(self, piece: int) -> float:
        """What the formula of a piece gives at s = 0, even where the piece holds only at higher rates."""
        return float(self.law.piece_coefficient(piece, self.law_slip, 0.0))

    def excess(self, rate: ArrayLike) -> NDArray[np.float64]:
        """g(s) - S mu_static (Pa); see `excess_and_slope`."""
        return self.excess_and_slope(rate)[0]

    def slope(self, rate: ArrayLike) -> NDArray[np.float64]:
        """g'(s) (Pa s/m)."""
        return self.excess_and_slope(rate)[1]

    @cached_property
    def scales(self) -> tuple[float, ...]:
        """Slip rates (m/s) at which things happen: S (variation of mu)/Z, and the law's own."""
        found = (self.normal * self.law.variation / self.impedance, *self.law.rate_scales)
        return tuple(scale for scale in found if scale > 0.0 and np.isfinite(scale)) or (1.0,)

    def fastest(self, excess: float) -> float:
        """A slip rate (m/s) at which g has surely passed the given excess (Pa), because friction is bounded below."""
        fall = self.strength - self.normal * self.law.range()[0]
        bound = max(excess + fall, 0.0) / self.impedance
        return 2.0 * bound + float(np.finfo(float).tiny)


def resistance(problem: Problem, law_slip: float | None = None) -> Resistance:
    """The resistance of a slab's contact at a law slip (m; default: where the problem starts).

    A contact mass plays no part in it: g is then what the contact settles to. Raises InputError for a block, whose slip rate
    is a state and solves no contact equation.
    """
    if not isinstance(problem.body, ElasticSlab):
        raise InputError("contact equation: a block has none, its slip rate follows from its inertia")
    slip = problem.law_slip if law_slip is None else float(law_slip)
    return Resistance(problem.friction, problem.body.impedance, problem.normal, slip)
