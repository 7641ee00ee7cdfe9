"""Define the exponential cohesive zone, in which friction first rises with slip and then falls."""

from dataclasses import dataclass
from typing import Any, ClassVar

from typing_extensions import override

from stickslip.foundation.conversion import Number
from stickslip.foundation.quantities import quantity
from stickslip.friction.families import SlipWeakening
from stickslip.friction.formula.expression import exp


@dataclass(frozen=True)
class ExponentialCohesiveZone(SlipWeakening):
    """mu(d) = dynamic + (static - dynamic) y exp(1 - y), y = (d + offset) / distance (d2), with d the slip path.

    Friction equals `static` at y = 1: it is largest there if `static` exceeds `dynamic`, and smallest otherwise. If the offset (d1)
    is less than the distance, friction rises while d < distance - offset.
    """

    kind = "exponential-cohesive-zone"
    source = (
        "Bolotskaya 2023, doctoral thesis, Massachusetts Institute of Technology, exponential cohesive zone as in its code "
        "PyLith_custom_friction, doi:10.5281/zenodo.14047393; shape of Xu & Needleman 1994, J. Mech. Phys. Solids 42, 1397"
    )
    many = True
    example: ClassVar = {"static": 0.6, "dynamic": 0.4, "distance": "0.2 m", "offset": "0.1 m"}

    static: float = quantity("1", "largest friction coefficient, at y = 1", at_least=0)
    distance: Number = quantity("m", "slip d2, counted from -offset, at which friction is largest", above=0)
    offset: Number = quantity("m", "slip d1 by which the curve is shifted back", at_least=0, default=0.0)

    @staticmethod
    @override
    def formula(law: Any, u: Any, v: Any) -> Any:
        y = (u + law.offset) / law.distance
        return law.dynamic + (law.static - law.dynamic) * y * exp(1.0 - y)
