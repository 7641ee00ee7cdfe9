"""A rigid body on a spring: a disturbance of its sliding has as many modes as its equation has roots.

Under a law with one or two states a disturbance exp(s t) solves, with n = D + S mu_v,

    (m s^2 + K) B(s) + s N(s) = 0,   one state: B = s + p, N = n s + k;   two: B = s^2 + t s + d, N = n s^2 + j s + k

so sliding is stable if and only if all of these are positive (Routh & Hurwitz), without differences of large terms:

    one state       K p,   m p + n,   n (K + k) + m p k
    two states      K d,   a1 = K t + k,   a3 = m t + n,   j a1 a3 + (n K - m k) (a1 - d a3)

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache, partial, reduce
from typing import Any

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from stickslip.contact.asked import ContactOfKind, SteadyDrive, Withstood
from stickslip.contact.disturbance import Response
from stickslip.contact.steady_proof import Discs, Judge, slope_symbols
from stickslip.contact.wave_modes import MOST_STEPS, Growth, Polynomial, first_of
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula import Expression, Parameter, on_discs
from stickslip.problem.bodies import BodyOnCharacteristics

CANCELLED = 2e-15
"""A difference that is smaller than this share of its terms is their rounding, and counts as 0."""


@dataclass(frozen=True)
class ModesOfBlock:
    """The roots of a polynomial in s, lowest order first."""

    equation: Polynomial

    @property
    def verdict(self) -> bool | None:
        """True if all roots have Re s < 0, False if one has Re s > 0, None if the farthest are on Re s = 0.

        This is Routh's array. It needs no roots, so that roots of very different sizes do not spoil each other.
        """
        rows = self.equation[::-1][::2], self.equation[::-1][1::2]
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

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the disturbance that grows fastest, or fades most slowly."""
        equation = self.equation
        if len(equation) == 3:  # where the terms with s cancel, the growth rate is exactly 0
            half = -0.5 * equation[1] / equation[2]
            swing = np.emath.sqrt(half * half - equation[0] / equation[2])
            return Growth(float(half + swing.real), float(abs(swing.imag)))
        return first_of(_roots(equation))


def _roots(equation: Polynomial) -> NDArray[Any]:
    """Return the roots of a polynomial, the small ones and the large ones with all their digits."""
    slope = poly.polyder(equation)
    with np.errstate(all="ignore"):
        found = np.concatenate((poly.polyroots(equation), 1.0 / poly.polyroots(equation[::-1])))
        for _ in range(MOST_STEPS):
            found = found - poly.polyval(found, equation) / poly.polyval(found, slope)
    return found[np.isfinite(found)]


class ContactOfRigid(ContactOfKind[BodyOnCharacteristics, ModesOfBlock]):
    """What a rigid body on a spring answers."""

    def modes(self, body: BodyOnCharacteristics, normal: float, response: Response, *, patient: bool = False) -> ModesOfBlock:
        """Return the roots of m s + D + K/s + S Phi(s)."""
        above, below = response
        spring = np.array([body.stiffness, body.total_damping, body.inertia])
        return ModesOfBlock(poly.polyadd(poly.polymul(spring, below), poly.polymulx(normal * above)))

    def steady_drive(self, body: BodyOnCharacteristics) -> SteadyDrive:
        """Return a drive that holds its rate: the end of the spring moves as prescribed."""
        return SteadyDrive(math.inf, math.inf)

    def withstood(self, body: BodyOnCharacteristics, normal: float) -> Withstood:
        """Return the damping."""
        return Withstood(body.total_damping, is_known=True)

    def judge(self, body: BodyOnCharacteristics, normal: float, many: int) -> Judge | None:
        """Return the proof for a block on a spring under a law with one or two states."""
        return partial(_proven, body, normal, many) if body.stiffness > 0.0 and many <= 2 else None


@lru_cache
def _conditions(many: int) -> tuple[Expression, ...]:
    """Return formulas of the slopes and of the body's numbers that are all positive if and only if a block is stable."""
    stiffness, damping, mass, normal = (Parameter(name) for name in ("K", "D", "m", "S"))
    (mu_v, *mu_w), *change = slope_symbols(many)
    f_v, f_w = [row[0] for row in change], [row[1:] for row in change]
    n = damping + normal * mu_v
    if many == 1:
        p = -f_w[0][0]
        k = n * p + normal * mu_w[0] * f_v[0]
        return stiffness * p, mass * p + n, n * (stiffness + k) + mass * p * k
    (one, two), (three, four) = f_w
    t, d = -(one + four), one * four - two * three
    late = mu_w[0] * (two * f_v[1] - four * f_v[0]) + mu_w[1] * (three * f_v[0] - one * f_v[1])
    k, j = n * d + normal * late, n * t + normal * (mu_w[0] * f_v[0] + mu_w[1] * f_v[1])
    a1, a3 = stiffness * t + k, mass * t + n
    return stiffness * d, a1, a3, j * a1 * a3 + (n * stiffness - mass * k) * (a1 - d * a3)


def _proven(body: BodyOnCharacteristics, normal: float, many: int, slopes: Discs) -> tuple[Floats, Floats]:
    """Return for each cell whether sliding is proven to be stable, and whether it is proven to be unstable."""
    numbers = {"m": body.inertia, "D": body.total_damping, "K": body.stiffness, "S": normal}
    found = [on_discs(one, numbers, slopes) for one in _conditions(many)]
    stable = reduce(np.logical_and, (one.centre > one.radius for one in found))
    return stable, reduce(np.logical_or, (one.centre < -one.radius for one in found))


ANSWERS = ContactOfRigid()
