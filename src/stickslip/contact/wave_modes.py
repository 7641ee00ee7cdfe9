"""Modes of a slab on a contact: the roots s of A(s) + Z (1 - r E) / (1 + r E) = 0 with E = exp(-s R) and polynomials A and Z in s.

This reads 1 + L(s) = 0 with L = r E (A - Z) / (A + Z). The number of its roots to the right of any vertical line follows from
Nyquist's criterion. The frequencies with abs(L) = 1 are roots of a polynomial; between them the phase of L is known in closed form,
and it says how often L winds around -1. So no root is missed, however high its frequency, and a bisection over the line finds the
growth rate of the fastest growing disturbance.

Source: Nyquist 1932, Bell Syst. Tech. J. 11, 126; Campillo et al. 1996, eqs (7)-(13), for the waves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

Polynomial = NDArray[Any]
"""Coefficients of a polynomial in s, lowest order first."""
_HALVINGS = 200
"""Largest number of halvings of an interval of growth rates: its ends are then neighbouring floats."""
MOST_STEPS = 50
"""Take at most this many of Newton's steps to a root from the place where it was found to lie."""
_DOUBLINGS = 2000
"""Largest number of doublings of a growth rate: from the smallest float to the largest."""


class Growth(NamedTuple):
    """Hold the growth rate of the fastest growing disturbance (1/s; below 0 if all fade), and its angular frequency (rad/s).

    The rate is 0 if disturbances keep their size, or fade ever more slowly at ever higher frequencies; inf if no slip rate near the
    present one solves the contact equation in a stable way.
    """

    rate: float
    frequency: float


def first_of(roots: NDArray[Any]) -> Growth:
    """Return the root that lies farthest to the right; without one, a disturbance is gone at once."""
    root = max(roots.tolist(), key=lambda one: one.real, default=-math.inf)
    return Growth(float(root.real), float(abs(root.imag)))


def roots_of(equation: Polynomial) -> NDArray[Any]:
    """Return the roots of a polynomial without leading zeros, smallest first, each with the digits of its own size.

    A companion matrix gives the largest roots with all their digits, and the one of 1/s the smallest.
    """
    if len(equation) < 2:
        return np.zeros(0, complex)
    large = poly.polyroots(equation).astype(complex)
    with np.errstate(all="ignore"):
        small = 1.0 / poly.polyroots(equation[::-1]).astype(complex)
    large, small = (one[np.argsort(np.abs(one))] for one in (large, small))
    if len(small) < len(large):  # some roots are 0
        small = np.append(np.zeros(len(large) - len(small)), small)
    return np.where(np.abs(large) ** 2 < np.abs(large[-1]) * np.abs(small[0]), small, large)


@dataclass(frozen=True)
class WaveModes:
    """The characteristic equation of a slab: a (1 + r E) + z (1 - r E) = 0, with polynomials a and z in s (lowest order first)."""

    a: Polynomial
    z: Polynomial
    reflection: float
    round_trip: float

    @property
    def verdict(self) -> bool | None:
        """True if every disturbance fades, False if one grows, None if one keeps its size."""
        if self.is_off_branch or self.roots_beyond(0.0) > 0:
            return False
        return None if self.is_neutral else True

    @property
    def is_off_branch(self) -> bool:
        """True if g falls with the slip rate: a contact without mass then leaves the rate at once."""
        degree = len(self.z) - 1
        return len(self.a) <= len(self.z) and float(poly.polyadd(self.a, self.z)[degree]) <= 0.0

    @property
    def is_neutral(self) -> bool:
        """True if the contact and a driver that reflects everything give no energy and take none, at any frequency."""
        return not (self.is_matched or self.ring(0.0).any())

    @property
    def is_matched(self) -> bool:
        """True if no echo comes back, or friction and waves cancel in it."""
        return self.reflection == 0.0 or not poly.polysub(self.a, self.z).any()

    def ring(self, line: float) -> Polynomial:
        """Return the polynomial in y = frequency^2 that is negative where abs(L) > 1 on the line Re s = `line` (1/s)."""
        (ar, ai), (zr, zi) = (parts_on_axis(shifted(one, line)) for one in (self.a, self.z))
        # log of the share of a wave that comes back, which may be exactly 1
        share = 2.0 * (math.log(abs(self.reflection)) - line * self.round_trip)
        less, more = -math.expm1(share), 1.0 + math.exp(share)
        squares = [poly.polyadd(poly.polymul(one, one), poly.polymulx(poly.polymul(odd, odd))) for one, odd in ((ar, ai), (zr, zi))]
        cross = poly.polyadd(poly.polymul(ar, zr), poly.polymulx(poly.polymul(ai, zi)))
        return poly.polyadd(less * poly.polyadd(*squares), 2.0 * more * cross)

    def roots_beyond(self, line: float) -> float:
        """Return the number of roots with Re s > `line` (1/s); inf if there are roots of any frequency."""
        p, q = poly.polytrim(poly.polyadd(self.a, self.z)), poly.polytrim(poly.polysub(self.a, self.z))
        count = int(np.sum(roots_of(p).real > line))
        if self.is_matched:
            return count
        ring = self.ring(line)
        edges = self.edges(ring)
        bounds = [-math.inf, *(-edges[::-1]), *edges, math.inf] if len(edges) else [-math.inf, math.inf]
        phase = _Phase(self, p, q, line)
        for low, high in pairwise(bounds):
            inside = _between(low, high)
            if poly.polyval(inside * inside, ring) < 0.0:
                if not (math.isfinite(low) and math.isfinite(high)):
                    return math.inf
                count += phase.turns_at(low) - phase.turns_at(high)
        return count

    @staticmethod
    def edges(ring: Polynomial) -> Polynomial:
        """Return the frequencies (rad/s, > 0) with abs(L) = 1, ascending."""
        trimmed = np.trim_zeros(ring, "b")
        if len(trimmed) < 2:
            return np.zeros(0)
        squares = roots_of(trimmed)
        real = squares[np.abs(squares.imag) <= 1e-9 * np.abs(squares)].real
        return np.asarray(np.sqrt(np.sort(real[real > 0.0])))

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the mode that grows fastest, or fades most slowly."""
        if self.is_off_branch:
            return Growth(math.inf, 0.0)
        if self.is_neutral:
            return Growth(0.0, 0.0)
        if self.is_matched:
            return first_of(roots_of(poly.polytrim(poly.polyadd(self.a, self.z))))
        if len(self.a) == len(self.z) == 1:
            return self._growth_by_gain()
        line = self._rightmost()
        if line == -math.inf or line == 0.0:
            return Growth(line, 0.0)
        tried = [self._polished(complex(line, frequency)) for frequency in self._frequencies(line)]
        near = [one for one in tried if np.isfinite(one) and abs(one.real - line) <= 1e-6 * max(abs(line), abs(one.imag) * 1e-3)]
        best = min(near, key=lambda one: abs(one.imag), default=complex(line, math.inf))
        return Growth(best.real, abs(best.imag))

    def _growth_by_gain(self) -> Growth:
        """Return the growth of a contact without mass and states: each echo multiplies a disturbance by r (2 Z/g' - 1)."""
        share = float(self.a[0] / self.z[0])
        size = math.log(abs(self.reflection)) - math.log1p(share) + (math.log1p(-share) if share < 1.0 else math.log(share - 1.0))
        turns = (1.0 - share) * self.reflection < 0.0
        return Growth(size / self.round_trip, math.pi / self.round_trip if turns else 0.0)

    def _rightmost(self) -> float:
        """Return the largest real part of the roots (1/s), by bisection; -inf if there is no root at all."""
        step = 1e-3 / self.round_trip
        grows = self.roots_beyond(0.0) > 0
        inner, outer = 0.0, step if grows else -step
        for _ in range(_DOUBLINGS):
            if (self.roots_beyond(outer) > 0) != grows:
                break
            inner, outer = outer, 2.0 * outer
            if not grows and -outer * self.round_trip > 300.0:
                return -math.inf
        low, high = sorted((inner, outer))
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            if not low < middle < high or high - low <= 4e-16 * abs(middle):
                break
            low, high = (middle, high) if self.roots_beyond(middle) > 0 else (low, middle)
        return high if high <= 0.0 else low

    def _frequencies(self, line: float) -> list[float]:
        """Return frequencies (rad/s) that may be close to a root, on a line that bounds all roots."""
        p: Polynomial = poly.polyadd(self.a, self.z)
        q: Polynomial = poly.polysub(self.a, self.z)
        found = [0.0, *self.edges(self.ring(line)), *np.abs(roots_of(poly.polytrim(p)).imag)]
        ratio = float(p[-1] * q[-1] * self.reflection)
        first = (0.0 if ratio < 0.0 else math.pi) / self.round_trip
        return [*found, first, first + 2.0 * math.pi / self.round_trip]

    def _polished(self, s: complex) -> complex:
        """Return the root that Newton's method reaches."""
        with np.errstate(all="ignore"):
            for _ in range(MOST_STEPS):
                step = self._step(np.complex128(s))
                s -= step
                if not np.abs(step) > 4e-16 * np.abs(s):
                    break
        return complex(s)

    def _step(self, s: np.complex128) -> np.complex128:
        """Return the function over its derivative, without the loss of digits where slow disturbances meet an echo of -1."""
        r, slopes = self.reflection, (poly.polyder(self.a), poly.polyder(self.z))
        echo = np.exp(-s * self.round_trip)
        more, less = (1.0 + r) + r * np.expm1(-s * self.round_trip), 1.0 - r * echo
        a, z = poly.polyval(s, self.a), poly.polyval(s, self.z)
        slope = poly.polyval(s, slopes[0]) * more + poly.polyval(s, slopes[1]) * less + (z - a) * r * self.round_trip * echo
        return np.complex128((a * more + z * less) / slope)


class _Phase:
    """The phase of L on a vertical line, continuous in the frequency."""

    def __init__(self, waves: WaveModes, p: Polynomial, q: Polynomial, line: float) -> None:
        self.waves, self.line = waves, line
        self.zeros, self.poles = roots_of(q), roots_of(p)
        self.turned = 0.0 if q[-1] * p[-1] > 0.0 else math.pi
        self.level = 0.0 if waves.reflection < 0.0 else math.pi

    def turns_at(self, frequency: float) -> int:
        """Return how many odd multiples of pi lie below the phase of L at a frequency (rad/s), counted from a fixed place."""
        known = self.turned + _winding(self.zeros, self.line, frequency) - _winding(self.poles, self.line, frequency)
        at = complex(self.line, frequency)
        a, z = poly.polyval(at, self.waves.a), poly.polyval(at, self.waves.z)
        exact = math.atan2(2.0 * (a * z.conjugate()).imag, abs(a) ** 2 - abs(z) ** 2)  # keeps the digits of a phase near 0
        whole = round((known - exact) / (2.0 * math.pi))
        return math.floor((exact - frequency * self.waves.round_trip - self.level) / (2.0 * math.pi)) + whole


def _winding(roots: Polynomial, line: float, frequency: float) -> float:
    """Return the phase of the product of (s - root) at s = line + i frequency, continuous in the frequency (rad)."""
    left, up = line - roots.real, frequency - roots.imag
    angle = np.arctan2(up, np.abs(left))
    return float(np.sum(np.where(left >= 0.0, angle, math.pi - angle)))


def _between(low: float, high: float) -> float:
    """Return a place between two others, which may be infinite."""
    if math.isinf(low) and math.isinf(high):
        return 1.0
    if math.isinf(low):
        return 2.0 * high - 1.0
    return 2.0 * low + 1.0 if math.isinf(high) else 0.5 * (low + high)


def shifted(p: Polynomial, by: float) -> Polynomial:
    """Return the polynomial p(by + x) in x."""
    found: Polynomial = np.zeros(len(p))
    for coefficient in p[::-1]:
        found = poly.polymul(found, [by, 1.0])[: len(p)]
        found = poly.polyadd(found, [coefficient])
    return found


def parts_on_axis(p: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Return the polynomials in y with p(i w) = even(w^2) + i w odd(w^2)."""
    signs = (-1.0) ** (np.arange(len(p)) // 2)
    signed = p * signs
    return signed[::2], signed[1::2] if len(p) > 1 else np.zeros(1)
