"""Prove whether steady sliding of a slab is stable, for all slopes of a law with one state that lie in given discs.

With p = -f_w > 0, n = D - Z + S mu_v, l = S mu_w f_v, b = m p + n and k = n p + l, a disturbance exp(s t) solves

    P + r exp(-s R) Q = 0,   P(s) = m s^2 + (b + Z) s + k + Z p,   Q(s) = m s^2 + (b - Z) s + k - Z p

At a frequency w the echo r exp(-s R) Q is larger than P if and only if y = w^2 gives

    c2 y^2 + c1 y + c0 < 0,   c2 = q m^2,   c1 = n + q (m^2 p^2 + n^2 - 2 m l + Z^2),   c0 = p k + q (k^2 + Z^2 p^2)

with q = Zd/(Z^2 + Zd^2), which is 0 under a rigid driver. So there are three cases with N roots of Re s > 0:

    nowhere         N is the number of such roots of P
    0 < y < y2      (c0 < 0) N = 2 (1 - j2) if r < 0; if r > 0, a real root lies there
    y1 < y < y2     N = 2 (j1 - j2); if k + Z p < 0, a real root lies there

Here j is the whole number next to psi/(2 pi), with the phase psi = arg r - w R + arg Q - arg P of the echo relative to P, taken at
y1 and y2. If several cases occur in a cell of slip rates, the cell is stable if it is stable in each of them: they meet where
psi = 2 pi or j1 = j2. Everything is in closed form, for echoes of any number of round trips.

Source: Nyquist 1932, Bell Syst. Tech. J. 11, 126; Rice & Ruina 1983, J. Appl. Mech. 50, 343, for the response of friction.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import reduce
from typing import Any, NamedTuple

import numpy as np

from stickslip.contact.steady_proof import Discs, slope_symbols
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula import Disc, Expression, Parameter, on_discs
from stickslip.problem import driver_impedance
from stickslip.problem.bodies import BodyOnCharacteristics

OUT = 4e-15
"""Bounds are moved outward by this relative rounding of a few operations and of an arc tangent."""
SHARE, SQUARE = Parameter("q"), Parameter("y")


class CellBounds(NamedTuple):
    """Lower and upper bounds, one of each for each cell."""

    low: Any
    high: Any


def _equation() -> dict[str, Expression]:
    """Return numbers of the equation as formulas of the slopes and of the body's numbers; those with _re are real parts at y."""
    mass, damping, own, normal = (Parameter(name) for name in ("m", "D", "Z", "S"))
    (mu_v, mu_w), (f_v, f_w) = slope_symbols(1)
    p, n, late = -f_w, damping - own + normal * mu_v, normal * mu_w * f_v
    k, b = n * p + late, mass * p + n
    real = k - mass * SQUARE
    return {
        "c0": p * k + SHARE * (k * k + own * own * p * p),
        "c1": n + SHARE * (mass * mass * p * p + n * n - 2.0 * mass * late + own * own),
        "c2": SHARE * mass * mass,
        "P(0)": k + own * p,
        "P": b + own,
        "P_re": real + own * p,
        "Q": b - own,
        "Q_re": real - own * p,
        "Q/P": 2.0 * own * (mass * (p * p + SQUARE) - late),
        "Q/P_re": real * real + SQUARE * b * b - own * own * (p * p + SQUARE),
    }


EQUATION = _equation()


def of_slab(body: BodyOnCharacteristics, normal: float, slopes: Discs) -> tuple[Floats, Floats]:
    """Return for each cell whether sliding is proven to be stable, and whether it is proven to be unstable.

    `slopes` holds the discs of the slopes by their symbols, with f_w < 0, and `normal` is the normal load (Pa).
    """
    slab = _Slab(body, normal, slopes)
    c0, c1, c2, still, damped = (slab.range(name) for name in ("c0", "c1", "c2", "P(0)", "P"))
    stable, unstable = (still.low > 0.0) & (damped.low > 0.0), (still.high < 0.0) | (damped.high < 0.0)
    if body.reflection == 0.0:
        return stable, unstable
    at_once, settles = (False, True) if body.has_inertia else (damped.high < 0.0, damped.low > 0.0)
    if c2.high == 0.0:  # the echo is the larger one at all high frequencies
        at_once = at_once | (c1.high < 0.0) | ((c1.high <= 0.0) & (c0.high < 0.0))
    y1, y2, exist, never = _edges(c0, c1, c2)
    j1, j2 = slab.turns(y1, p_turns=False), slab.turns(y2, p_turns=True)
    below = (j2.low >= 1.0, j2.high < 1.0) if body.reflection < 0.0 else (False, True)
    # true in all cases that occur; the others are left out
    not_nowhere, not_below = (c0.high < 0.0) | ((c1.high < 0.0) & exist), c0.low > 0.0
    not_between = (c0.high < 0.0) | (c1.low >= 0.0) | never
    stable = (not_nowhere | stable) & (not_below | below[0]) & (not_between | ((still.low > 0.0) & (j1.high <= j2.low)))
    unstable = (not_nowhere | unstable) & (not_below | below[1]) & (not_between | (j1.low > j2.high))
    return settles & stable, at_once | unstable


def _edges(c0: CellBounds, c1: CellBounds, c2: CellBounds) -> tuple[CellBounds, CellBounds, Any, Any]:
    """Return the roots y1 and y2 of c2 y^2 + c1 y + c0, at least 0, and where c1 < 0 makes both exist, or lets none exist.

    The larger root falls with each coefficient, and the smaller one grows, so that the corners bound them. At a corner without
    roots the vertex takes their place.
    """
    coefficients = c0, c1, c2
    gap_most, gap_least = (_gap(*ends, outward=out) for ends, out in zip(zip(*coefficients, strict=True), (OUT, -OUT), strict=True))
    most, least = (np.sqrt(np.maximum(gap, 0.0)) for gap in (gap_most, gap_least))
    y2_high, y2_low = (
        np.where(one > 0.0, -2.0 * zero / (one + root), (root - one) / (2.0 * two))
        for zero, one, two, root in zip(*coefficients, (most, least), strict=True)
    )
    inner = np.where((c1.high < 0.0) & (gap_least > 0.0), 2.0 * c0.high / (least - c1.high), -c1.low / (2.0 * c2.low))
    found = CellBounds(2.0 * c0.low / (most - c1.low), inner), CellBounds(y2_low, y2_high)
    y1, y2 = (CellBounds(np.maximum(one.low * (1.0 - OUT), 0.0), np.maximum(one.high * (1.0 + OUT), 0.0)) for one in found)
    return y1, y2, gap_least > 0.0, gap_most < 0.0


def _gap(c0: Floats, c1: Floats, c2: Floats, *, outward: float) -> Floats:
    """Return the discriminant, moved by `outward` times the size of its terms."""
    square, product = c1 * c1, 4.0 * c0 * c2
    return np.asarray(square - product + outward * (square + np.abs(product)))


@dataclass(frozen=True)
class _Slab:
    """A slab on a contact, with the discs of the slopes in all cells."""

    body: BodyOnCharacteristics
    normal: float
    slopes: Discs

    def range(self, name: str, y: Disc | None = None) -> CellBounds:
        """Return the range of a number of the equation, where w^2 is in the disc y."""
        body, own = self.body, self.body.impedance
        resists, over = (float(one[0]) for one in driver_impedance(body))
        share = resists * over / (own * own * over + resists * resists)
        numbers = {"m": body.inertia, "D": body.damping, "Z": own, "S": self.normal}
        found = on_discs(EQUATION[name], numbers, {**self.slopes, SHARE: Disc.of(share, OUT * share), SQUARE: y or Disc.of(0.0)})
        radius = found.radius + OUT * found.most
        return CellBounds(found.centre - radius, found.centre + radius)

    def turns(self, y: CellBounds, *, p_turns: bool) -> CellBounds:
        """Return the whole number of turns next to the phase of the echo relative to P, at frequencies whose squares are y.

        arg P grows from 0 if P has its roots to the left; `p_turns` says whether it lies between 0 and 2 pi or between -pi and pi.
        """
        w = CellBounds(np.sqrt(y.low) * (1.0 - OUT), np.sqrt(y.high) * (1.0 + OUT))
        disc = Disc.of(0.5 * (y.low + y.high), 0.5 * (y.high - y.low) + OUT * y.high)
        direct, echo = self._angle("P", disc, w, turns=p_turns), self._angle("Q", disc, w, turns=True)
        low, high = echo.low - direct.high, echo.high - direct.low
        # their difference keeps its digits in the angle of Q/P, which does not count whole turns
        fine = self._angle("Q/P", disc, w, turns=False)
        whole = 2.0 * np.pi * np.round((low + high - fine.low - fine.high) / (4.0 * np.pi))
        is_sure = high - low + fine.high - fine.low < 6.0
        low = np.where(is_sure, np.fmax(low, fine.low + whole - OUT * np.abs(whole)), low)
        high = np.where(is_sure, np.fmin(high, fine.high + whole + OUT * np.abs(whole)), high)
        low = low - w.high * self.body.round_trip_time * (1.0 + OUT)
        high = np.fmin(high, 3.0 * np.pi) - w.low * self.body.round_trip_time * (1.0 - OUT)
        if self.body.reflection < 0.0:  # arg r is pi, half a turn
            return CellBounds(*(np.floor(end / (2.0 * np.pi)) + 1.0 for end in (low, high)))
        return CellBounds(*(np.floor(end / (2.0 * np.pi) + 0.5) for end in (low, high)))

    def _angle(self, name: str, y: Disc, w: CellBounds, *, turns: bool) -> CellBounds:
        """Return the angle (rad) of a number, from 0 to 2 pi if it `turns`, else from -pi to pi; nan if it is not known."""
        real, over_w = self.range(f"{name}_re", y), self.range(name, y)
        odd = np.minimum(w.low * over_w.low, w.high * over_w.low), np.maximum(w.low * over_w.high, w.high * over_w.high)
        sign, base = (-1.0, np.pi) if turns else (1.0, 0.0)
        corners = [base + np.arctan2(sign * v, sign * u) for u in real for v in odd]
        low, high = reduce(np.minimum, corners), reduce(np.maximum, corners)
        is_known = (over_w.low > 0.0) | ((over_w.high < 0.0) & (w.low > 0.0)) | ((real.high < 0.0) if turns else (real.low > 0.0))
        out = OUT * (base + np.abs(low) + np.abs(high))
        return CellBounds(np.where(is_known, low - out, np.nan), np.where(is_known, high + out, np.nan))
