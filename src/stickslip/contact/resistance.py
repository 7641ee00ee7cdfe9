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
from stickslip.quantities import quantities_of


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

    @cached_property
    def tree(self) -> Expression:
        """The piece of the law's formula that holds at this slip."""
        return self.law.trees()[int(np.searchsorted(np.asarray(self.law.knots), self.law_slip, side="right"))]

    @cached_property
    def parameters(self) -> dict[str, float]:
        """The law's numbers by name."""
        return {name: getattr(self.law, name) for name in self.law.parameters()}

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
        step, slope = difference(self.tree, self.parameters, self.law_slip, 0.0, rate)
        return self.impedance * rate + self.normal * step + self.start, self.impedance + self.normal * slope

    def excess(self, rate: ArrayLike) -> NDArray[np.float64]:
        """g(s) - S mu_static (Pa); see `excess_and_slope`."""
        return self.excess_and_slope(rate)[0]

    def slope(self, rate: ArrayLike) -> NDArray[np.float64]:
        """g'(s) (Pa s/m)."""
        return self.excess_and_slope(rate)[1]

    @cached_property
    def scales(self) -> tuple[float, ...]:
        """Slip rates (m/s) at which things happen: S (range of mu)/Z, and the law's numbers that are rates or their inverses."""
        low, high = self.law.range()
        found = [self.normal * (high - low) / self.impedance]
        for name, declared in quantities_of(type(self.law)).items():
            size = abs(self.parameters[name])
            if declared.unit == "m/s":
                found.append(size)
            elif declared.unit == "s/m" and size:
                found.append(1.0 / size)
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
