"""Growth of a small disturbance of steady sliding: the roots s of the linearised equations of a body on a contact.

A disturbance exp(s t) of the slip rate meets the contact mass, the body, and the response of friction, Phi(s):

    block   m s + D + K/s + S Phi(s) = 0
    slab    A(s) + Z (1 - r E) / (1 + r E) = 0,   E = exp(-s R),   A(s) = m_c s + D - Z + S Phi(s)
    layers  A(s) + W(s) = 0,                      W in `bodies.layer_response`

D is the damping of the body, which is Z for a slab. Phi is the slope of friction by the slip rate and, under a law with states, a
quotient of polynomials. With a rigid driver (r = -1) the slab's term is Z coth(s h/c).

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343, for the block; Campillo et al. 1996, eqs (7)-(13), for the waves of the slab.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from stickslip.contact.layer_count import MOST_PIECES
from stickslip.contact.layer_modes import LayerModes
from stickslip.contact.wave_modes import MOST_STEPS, Growth, Polynomial, WaveModes, first_of
from stickslip.foundation.constants import RIGID
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers

CANCELLED = 2e-15
"""A difference that is smaller than this share of its terms is their rounding, and counts as 0."""


class Response(NamedTuple):
    """Hold friction's response Phi(s) to a disturbance of the slip rate (s/m) as two polynomials in s, lowest order first."""

    numerator: Polynomial
    denominator: Polynomial


@dataclass(frozen=True)
class Disturbed:
    """A body that slides on a contact under a normal load (Pa or N) with a given response of friction."""

    body: BodyOnCharacteristics
    normal: float
    response: Response
    pieces: int = MOST_PIECES
    """Largest number of pieces in which roots on layers are counted."""

    def is_stable(self) -> bool | None:
        """Return True if every disturbance fades, False if one grows, None if one keeps its size, or if it is not decided."""
        if not self.body.has_waves:
            return _all_left(self._of_block())
        waves = self._waves
        if isinstance(waves, LayerModes):
            return waves.verdict
        if waves.is_off_branch or waves.roots_beyond(0.0) > 0:
            return False
        return None if waves.is_neutral else True

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the disturbance that grows fastest, or fades most slowly; nan: not known."""
        return self._waves.growth() if self.body.has_waves else self._growth_of_block()

    def one_that_grows(self) -> complex | None:
        """Return the fastest root that is found to grow on layers (1/s), without proof that none grows faster; None without one."""
        return self._waves.one_that_grows if isinstance(self._waves, LayerModes) else None

    def near(self, root: complex) -> complex | None:
        """Return the root on layers that the secant method reaches from a place (1/s), None if it reaches none."""
        return self._waves.near(root) if isinstance(self._waves, LayerModes) else None

    @cached_property
    def _waves(self) -> WaveModes | LayerModes:
        body, (above, below) = self.body, self.response
        own = poly.polymul([body.damping - body.impedance, body.inertia], below)
        a, z = poly.polytrim(poly.polyadd(own, self.normal * above)), body.impedance * below
        if isinstance(body, OfLayers):
            return LayerModes(a, np.asarray(below, float), body, self.pieces)
        if not body.has_machine:
            return WaveModes(a, z, float(body.reflection), body.round_trip_time)
        # The machine resists with x = M s + kp + ki/s, so that r = -(x - Z) / (x + Z): both sides times x + Z.
        resists, one = np.array([body.driver_impedance, body.driver_inertia]), np.ones(1)
        if body.driver_integral_gain > 0.0:
            resists, one = np.append(body.driver_integral_gain, resists), np.array([0.0, 1.0])

        def mixed(f: Polynomial, g: Polynomial) -> Polynomial:
            found: Polynomial = poly.polyadd(poly.polymul(f, resists), poly.polymul(body.impedance * g, one))
            return poly.polytrim(found)

        return WaveModes(mixed(a, z), mixed(z, a), RIGID, body.round_trip_time)

    def _of_block(self) -> Polynomial:
        """Return the polynomial in s (lowest order first) whose roots are those of a block."""
        body, (above, below) = self.body, self.response
        spring = np.array([body.stiffness, body.damping, body.inertia])
        return poly.polyadd(poly.polymul(spring, below), poly.polymulx(self.normal * above))

    def _growth_of_block(self) -> Growth:
        equation = self._of_block()
        if len(equation) == 3:  # where the terms with s cancel, the growth rate is exactly 0
            half = -0.5 * equation[1] / equation[2]
            swing = np.emath.sqrt(half * half - equation[0] / equation[2])
            return Growth(float(half + swing.real), float(abs(swing.imag)))
        return first_of(_roots(equation))


def _all_left(equation: Polynomial) -> bool | None:
    """Return True if all roots of a polynomial have Re s < 0, False if one has Re s > 0, None if the farthest are on Re s = 0.

    This is Routh's array. It needs no roots, so that roots of very different sizes do not spoil each other.
    """
    rows = equation[::-1][::2], equation[::-1][1::2]
    first = [float(rows[0][0])]
    while len(rows[1]):
        lead = float(rows[1][0])
        first.append(lead)
        if lead == 0.0:
            break
        rest = rows[0][0] / lead * np.append(rows[1], 0.0)[1 : len(rows[0])]
        left = rows[0][1:] - rest
        rows = rows[1], np.where(np.abs(left) > CANCELLED * np.abs(rest), left, 0.0)
    if min(first) < 0.0:
        return False
    return None if 0.0 in first else True


def _roots(equation: Polynomial) -> NDArray[Any]:
    """Return the roots of a polynomial, the small ones and the large ones with all their digits."""
    slope = poly.polyder(equation)
    with np.errstate(all="ignore"):
        found = np.concatenate((poly.polyroots(equation), 1.0 / poly.polyroots(equation[::-1])))
        for _ in range(MOST_STEPS):
            found = found - poly.polyval(found, equation) / poly.polyval(found, slope)
    return found[np.isfinite(found)]
