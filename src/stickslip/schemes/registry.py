"""The schemes by name."""

from __future__ import annotations

from stickslip.foundation.errors import InputError, nearest
from stickslip.schemes.central_differences import CentralDifferences, MassRedistribution
from stickslip.schemes.characteristics import Characteristics
from stickslip.schemes.contract import Scheme
from stickslip.schemes.newmark import Newmark, Theta
from stickslip.schemes.sbp import SummationByParts


class Regularised(CentralDifferences):
    """Friction mu tanh(v/v0) with v0 = `smoothing` S (range of mu)/Z: the contact never sticks, but creeps.

    It tends to friction with stick as v0 tends to 0, not with the grid.
    """

    order = 0.0
    smoothing = 1e-3

    def __init__(self) -> None:
        super().__init__("regularised", "central differences, friction mu tanh(v/v0)", 0.8)


_ALL: tuple[Scheme, ...] = (
    Characteristics(),
    CentralDifferences("central-differences", "central differences, lumped mass", 0.8),
    CentralDifferences("central-differences-cfl1", "central differences, lumped mass, Courant number 1", 1.0),
    MassRedistribution(),
    Newmark("newmark", "finite elements, Newmark, constant mean acceleration", 0.0),
    Newmark("hht", "finite elements, HHT-alpha, alpha = 0.1", 0.1),
    Theta("theta", "finite elements, theta = 0.6", 0.6),
    Theta("backward-euler", "finite elements, backward Euler", 1.0),
    SummationByParts(2),
    SummationByParts(4),
    SummationByParts(6),
    Regularised(),
)
SCHEMES: dict[str, Scheme] = {scheme.name: scheme for scheme in _ALL}
"""The schemes by name."""


def scheme_of(scheme: str | Scheme) -> Scheme:
    """Return the scheme of a name, or a scheme as it is. Raises InputError for an unknown name and for what is no scheme."""
    if isinstance(scheme, str):
        if scheme not in SCHEMES:
            raise InputError(f"schemes: there is no scheme {ascii(scheme)[:60]}; {nearest(scheme, SCHEMES)}")
        return SCHEMES[scheme]
    missing = [name for name in ("name", "title", "order", "courant", "largest_courant", "begin") if not hasattr(scheme, name)]
    if missing:
        raise InputError(f"schemes: a scheme needs {', '.join(missing)}: see stickslip.schemes.contract.Scheme")
    return scheme
