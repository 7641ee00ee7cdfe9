"""Small disturbances of steady sliding: the roots s of the linearised equations of a body on a contact.

A disturbance exp(s t) of the slip rate meets the contact mass, the body, and the response of friction, Phi(s):

    block   m s + D + K/s + S Phi(s) = 0
    slab    A(s) + Z (1 - r E) / (1 + r E) = 0,   E = exp(-s R),   A(s) = m_c s + D - Z + S Phi(s)
    layers  A(s) + W(s) = 0,                      W in `layer_response`

D is the damping of the body, which is Z for a slab. Phi is the slope of friction by the slip rate and, under a law with states, a
quotient of polynomials. With a rigid driver (r = -1) the slab's term is Z coth(s h/c).

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343, for the block; Campillo et al. 1996, eqs (7)-(13), for the waves of the slab.
"""

from __future__ import annotations

from typing import NamedTuple, Protocol

from numpy.polynomial import polynomial as poly

from stickslip.contact.wave_modes import Growth, Polynomial
from stickslip.problem.bodies import BodyOnCharacteristics


class Response(NamedTuple):
    """Hold friction's response Phi(s) to a disturbance of the slip rate (s/m) as two polynomials in s, lowest order first."""

    numerator: Polynomial
    denominator: Polynomial


class Modes(Protocol):
    """All disturbances of one steady sliding."""

    @property
    def verdict(self) -> bool | None:
        """True if every disturbance fades, False if one grows, None if one keeps its size, or if it is not decided."""
        ...

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the disturbance that grows fastest, or fades most slowly; nan: not known."""
        ...


def of_contact(body: BodyOnCharacteristics, normal: float, response: Response) -> Polynomial:
    """Return A(s), what the contact of a body with waves adds to them, times the denominator of friction's response."""
    above, below = response
    own = poly.polymul([body.damping - body.impedance, body.inertia], below)
    found: Polynomial = poly.polytrim(poly.polyadd(own, normal * above))
    return found
