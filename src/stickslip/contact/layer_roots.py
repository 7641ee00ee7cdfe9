"""Roots s of a(s) + b(s) W(s) = 0, the characteristic equation of layers, beyond a line of growth rates.

With the waves u and d = R u that leave the contact and come back this reads p u + q d = 0, p = a + Z b, q = a - Z b. Layers and
drivers give no energy: abs(R) <= 1 for Re s >= 0. Nyquist's criterion counts the roots beyond a line where it is followed how often

    H = (p u + q d) / (p (u + k d))

winds around 0; k is 0, or that of a contact without mass and states which responds as this one does at high frequencies. Where
abs(q/p - k) abs(d / (u + k d)) < 1 it does not, so a few intervals of the frequency are left, in which `layer_count` follows H.

Two sides may have modes in which the contact rests. They are no disturbance of its sliding, and are left out.

Source: Nyquist 1932, Bell Syst. Tech. J. 11, 126.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.contact.layer_count import MOST_PIECES, Line, NotCountedError, Share
from stickslip.contact.layer_response import Complex, response_of
from stickslip.contact.rightmost import SeenBeyond
from stickslip.contact.secant import polished
from stickslip.contact.wave_modes import Polynomial, WaveModes, parts_on_axis, roots_of, shifted
from stickslip.problem.bodies import OfLayers

LEAN = 5e-14
"""The axis leans by this much on two sides (1), which may have modes that do not move the contact: these lie on the axis."""
PLACES_SOUGHT_FROM = 128
"""Number of places from which roots are sought."""
SHORT_SPAN = 2000
"""A span of frequencies is short if it has no more than this number of pieces at first."""
FEWER = 4
"""Left of the axis, where no verdict depends on it, a count may take fewer pieces by this factor (1)."""


class Spans(NamedTuple):
    """Hold the frequencies (rad/s) between which H may wind around 0, and the function H."""

    share: Share
    edges: list[tuple[float, float]]

    @property
    def length(self) -> float:
        """The length of all spans together (rad/s)."""
        return sum(high - low for low, high in self.edges)


@dataclass(frozen=True)
class LayerRoots:
    """The characteristic equation a + b W = 0 of a body of layers, with polynomials a and b in s (lowest order first)."""

    a: Polynomial
    b: Polynomial
    body: OfLayers
    pieces: int = MOST_PIECES
    """Largest number of pieces of a line."""

    @property
    def _z(self) -> Polynomial:
        return np.asarray(self.body.impedance * self.b)

    @cached_property
    def p(self) -> Polynomial:
        """The polynomial a + Z b."""
        return np.asarray(poly.polytrim(poly.polyadd(self.a, self._z)))

    @property
    def is_off_branch(self) -> bool:
        """True if g falls with the slip rate: a contact without mass then leaves the rate at once."""
        return WaveModes(self.a, self._z, -1.0, 1.0).is_off_branch

    @cached_property
    def keeps_energy(self) -> bool:
        """True if drivers send back all that they meet, and no drag takes any."""
        return not self.body.has_drag and all(abs(one.reflection) == 1.0 for one in self.body.stacks)

    @cached_property
    def is_neutral(self) -> bool:
        """True if neither contact nor drivers give energy or take any, at any frequency."""
        (ar, ai), (br, bi) = parts_on_axis(self.a), parts_on_axis(self.b)
        taken = poly.polyadd(poly.polymul(ar, br), poly.polymulx(poly.polymul(ai, bi)))
        return self.keeps_energy and not taken.any()

    @property
    def keeps_far_modes(self) -> bool:
        """True if modes of high frequency tend to those that drivers and contact leave alone: of any side, or of all together."""
        of_a, of_b = self.far
        held = math.inf if of_b == 0.0 else 0.0  # with these drivers there are modes that rest wherever drag is lumped
        sides = [
            abs(one.reflection) == 1.0 and (one.drag is None or one.driver_impedance == held) and not self.body.has_machine
            for one in self.body.stacks
        ]
        if of_a and of_b:
            return False
        return any(sides) if (of_a == 0.0) != self.body.has_ground else all(sides)

    @property
    def is_algebraic(self) -> bool:
        """True if the contact has no mass and no states."""
        return len(self.a) == len(self.b) == 1

    @cached_property
    def far(self) -> tuple[float, float]:
        """The numbers a' and b' of a contact without mass and states that responds as this one does at high frequencies."""
        degree = max(len(self.a), len(self.b))
        of_a, of_b = (float(one[-1]) if len(one) == degree else 0.0 for one in (self.a, self.b))
        return of_a, of_b

    def value(self, s: Complex) -> Complex:
        """Return p u + q d over 2 Z u, which is 0 at the modes that move the contact."""
        return self._over_wave(s, poly.polyval(s, self.a), poly.polyval(s, self.b))

    def value_far(self, s: Complex) -> Complex:
        """Return the same for the modes of high frequency."""
        return self._over_wave(s, *self.far)

    def entire(self, s: Complex) -> Complex:
        """Return a below + b above, which has no poles next to its roots, but those of modes that do not move the contact."""
        above, below = response_of(self.body, s)
        return np.asarray(poly.polyval(s, self.a) * below + poly.polyval(s, self.b) * above)

    def _over_wave(self, s: Complex, a: Any, b: Any) -> Complex:
        above, below = response_of(self.body, s)
        return np.asarray((a * below + b * above) / (self.body.impedance * below + above))

    # ---- how many ---------------------------------------------------------------------------------------------------------------

    def roots_beyond(self, line: float) -> float:
        """Return the number of roots with Re s > `line` (1/s), at least 0 or right of the crowd; inf if there are endlessly many.

        If it is large it may be the least number that there are. Raises NotCountedError if the number is not certain.
        """
        if line == 0.0 and self.is_neutral:
            return 0.0
        return (self.look(line) if line else self.at_axis).number

    @cached_property
    def at_axis(self) -> SeenBeyond:
        """What is seen from the axis."""
        return self.look(0.0)

    def near(self, root: complex) -> complex | None:
        """Return the root (1/s) that the secant method reaches from a place, None if it reaches none."""
        found = polished(self.value, np.array([root]))
        return found[0] if found else None

    def look(self, line: float) -> SeenBeyond:
        """Return the number of roots beyond a line (1/s), as `roots_beyond` does, and places near roots."""
        spans = self.spans(line)
        if spans is None:
            return SeenBeyond(math.inf, np.zeros(0, complex))
        count, seeds = int(np.sum(roots_of(self.p).real > line)), [np.zeros(0, complex)]
        lean = LEAN if line == 0.0 and len(self.body.stacks) > 1 else 0.0
        on = Line(self.body, line, lean, self.pieces if line >= 0.0 else MOST_PIECES // FEWER)
        turning = on.cells - (_unmoved(self.body) if line == 0.0 and self.keeps_energy else 0)
        for low, high in spans.edges:
            turns = turning * ((high - low) / on.period - 1.0) - len(self.a) - len(self.b)
            if line == 0.0 and self.keeps_energy and spans.share.to == self.matched and turns >= 1.0:
                # R alone turns as often in each period as there are modes, and polynomials by half a turn for each of their roots
                return SeenBeyond(math.floor(turns), np.zeros(0, complex))
            winds, found = spans.share.windings(on, low, high)
            count -= winds
            seeds.append(found.seeds(line, PLACES_SOUGHT_FROM))
        if count < 0:
            raise NotCountedError
        return SeenBeyond(count, np.concatenate(seeds))

    @property
    def matched(self) -> tuple[float, float]:
        """The numbers a' and b' of a contact from which no wave comes back: k = 0."""
        return self.body.impedance, 1.0

    def spans(self, line: float) -> Spans | None:
        """Return where H may wind around 0 on a line, with the k that leaves less of it; None if there are endlessly many roots."""
        short, per_piece = math.inf, Line(self.body, line).period / (2 * sum(self.body.cells.counts))
        matched = None
        if line >= 0.0:
            largest = 1.0 if line == 0.0 and self.keeps_energy else _largest_share(self.body, line)
            ring = WaveModes(self.a, self._z, max(largest, 1e-300), 0.0).ring(line)
            matched = Spans(Share(self.a, self.b, self.p, self.matched, self.body), _open(ring))
            short = matched.length / per_piece
            if short <= SHORT_SPAN:
                return matched
            if line == 0.0 and self.keeps_energy:
                return matched if math.isfinite(short) else None
        if line == 0.0 and in_period(self.body, 0.0, *self.far).number:
            return None
        of_far = Line(self.body, _off_axis(self.body, line)).largest_share(*self.far)
        rest = poly.polysub(self.far[1] * self.a, self.far[0] * self.b)[: len(self.p) - 1]
        known = 2.0 * self.body.impedance * of_far / abs(self.far[0] + self.body.impedance * self.far[1])
        ring = poly.polysub(_square(self.p, line), known * known * _square(rest, line) if len(rest) else [0.0])
        spans = Spans(Share(self.a, self.b, self.p, self.far, self.body), _open(ring))
        return matched if matched is not None and matched.length < spans.length else spans


def _square(p: Polynomial, line: float) -> Polynomial:
    """Return abs(p)^2 at line + i w as a polynomial in w^2."""
    even, odd = parts_on_axis(shifted(p, line))
    return np.asarray(poly.polyadd(poly.polymul(even, even), poly.polymulx(poly.polymul(odd, odd))))


def _open(ring: Polynomial) -> list[tuple[float, float]]:
    """Return the intervals of frequencies (rad/s) in which a polynomial in their squares is below 0; the last may be endless."""
    edges, found = [0.0, *WaveModes.edges(ring).tolist(), math.inf], []
    for low, high in pairwise(edges):
        inside = 0.5 * (low + high) if math.isfinite(high) else 2.0 * low + 1.0
        if poly.polyval(inside * inside, ring) < 0.0:
            found.append((low, high))
    return found


def _off_axis(body: OfLayers, line: float) -> float:
    """Return a line (1/s), the axis a little to the right if there are two sides."""
    return line or (LEAN * math.pi / body.cells.time if len(body.stacks) > 1 else 0.0)


@lru_cache(maxsize=256)
def _largest_share(body: OfLayers, line: float) -> float:
    """Return a bound of abs(R) on a line (1/s, at least 0)."""
    try:
        return min(Line(body, _off_axis(body, line)).largest_share(body.impedance, 1.0), 1.0)
    except NotCountedError:
        return 1.0


def in_period(body: OfLayers, line: float, a: float, b: float) -> SeenBeyond:
    """Return the number of roots of a below + b above beyond a line in a period, without those that do not move the contact."""
    at = _off_axis(body, line)
    number, found = Line(body, at).roots_in_period(a, b)
    return SeenBeyond(number - (_unmoved(body) if at < 0.0 else 0), found.seeds(at, PLACES_SOUGHT_FROM))


@lru_cache(maxsize=64)
def _unmoved(body: OfLayers) -> int:
    """Return the number of modes in a period that do not move the contact: they are on the axis, if both sides keep energy."""
    if len(body.stacks) < 2:
        return 0
    return Line(body, -1e-9 / body.two_way_time).roots_in_period(body.impedance, 1.0)[0]
