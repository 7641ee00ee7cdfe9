"""Discs that hold the characteristic function a(s) below(s) + b(s) above(s) of layers on a piece of a line of growth rates.

Each side of a contact has an outgoing and a returning wave, u and d, and a disc holds the smaller one over the larger one. Layers
turn it and map it to another disc, so that a bound for all of the piece follows from its middle: the function, over the larger
waves of both sides, lies in a disc around its value there. Where this does not contain 0 the phase turns by no more than the angle
at which it is seen from 0, however narrow a resonance is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.contact.layer_response import Complex, Quotient, at_driver, crossings_of, met_by, sides_of
from stickslip.contact.wave_modes import Polynomial
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers
from stickslip.problem.bodies.layered.layers import Layers

ROUNDING_OF_PHASE = 3e-15
"""Rounding (1) of the function, relative to its terms: where it is smaller its phase is not known."""
TURNED = 4e-16
"""Rounding (1) of the phase of a wave in a layer, relative to this phase."""

LARGER = 1.0 + 1e-9
"""The returning wave counts as the larger one if it is larger by this factor (1): where no energy is lost they are as large."""


class Bound(NamedTuple):
    """Hold how far a function may lie from its value in the middle of a piece, and that value, with a common factor."""

    middle: Complex
    radius: Floats

    @property
    def angle(self) -> Floats:
        """The angle (rad) by which the phase may differ from that in the middle; inf if the function may be 0."""
        return _seen(self.radius, np.abs(self.middle))

    @property
    def least(self) -> Floats:
        """The least size of the function."""
        return np.asarray(np.abs(self.middle) - self.radius)

    @property
    def most(self) -> Floats:
        """The largest size of the function."""
        return np.asarray(np.abs(self.middle) + self.radius)


class _Side(NamedTuple):
    """Hold velocity and stress of one side at the contact over its larger wave, in the middle of pieces."""

    below: Complex
    above: Complex
    """Over the impedance at the contact."""
    sign: Floats
    """1 where the larger wave comes back, -1 where it goes out: the slope of `above` by the smaller wave, in halves."""
    radius: Floats
    """Half the radius of the disc that holds the smaller wave over the larger one."""
    turned: Floats
    """Angle (rad) by which the phase of the larger wave may differ from that in the middle."""
    impedance: float
    """Impedance at the contact (Pa s/m)."""


class _Waves(NamedTuple):
    """Hold a disc on its way: the quotient of stress and velocity in the middle, and a radius around it."""

    found: Quotient
    returns: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]
    """True where the returning wave is the larger one."""
    radius: Floats
    turned: Floats

    @property
    def sizes(self) -> tuple[Floats, Floats]:
        """The sizes of the larger wave and of the smaller one."""
        out, back = np.abs(self.found.above + self.found.below), np.abs(self.found.below - self.found.above)
        return np.where(self.returns, back, out), np.where(self.returns, out, back)

    def mapped(self, to: Quotient, ratio: float, drag: float) -> _Waves:
        """Return the disc behind a place with other impedance or drag, where stress and velocity are `to`."""
        one, other = 0.5 * (1.0 + ratio + drag), 0.5 * (1.0 - ratio + drag)
        back = 0.5 * (1.0 + ratio - drag), 0.5 * (1.0 - ratio - drag)
        outer, inner = np.abs(to.above + to.below), np.abs(to.below - to.above)
        returns, before = inner > LARGER * outer, self.sizes[0]
        # the new larger wave is c (larger) + k (smaller) of the old ones
        k = np.where(returns, np.where(self.returns, back[1], back[0]), np.where(self.returns, one, other))
        share, moves = np.where(returns, inner, outer) / before, np.abs(k) * self.radius
        left = np.where(share > moves, share - moves, 0.0)
        radius = np.where(left > 0.0, ratio * self.radius / (share * left), np.inf)
        return _Waves(to, returns, radius, self.turned + _seen(moves, share))

    def crossed(self, to: Quotient, s: Complex, time: float, half: Floats) -> _Waves:
        """Return the disc across cells, for pieces of the half length `half` (1/s)."""
        larger, smaller = self.sizes
        turn = np.minimum(2.0 * time * half, 2.0) + TURNED * 2.0 * time * np.abs(s)
        fades = np.exp(-2.0 * time * s.real)
        grown = self.radius + (smaller / larger + self.radius) * turn
        radius = np.where(self.returns, grown / fades, grown * fades)
        return _Waves(to, self.returns, radius, self.turned + np.where(self.returns, turn, 0.0))


def _seen(radius: Floats, size: Floats) -> Floats:
    """Return the half of the angle (rad) at which a disc is seen from 0, inf if 0 may be in it."""
    with np.errstate(all="ignore"):
        share = radius / size
        return np.where(share < 1.0, np.arcsin(np.minimum(share, 1.0)), np.inf)


def _of_side(layers: Layers, s: Complex, half: Floats) -> _Side:
    found, zeros = at_driver(layers, s), np.zeros(s.shape)
    waves = _Waves(found, np.zeros(s.shape, bool), zeros, zeros)
    for meets in crossings_of(layers):
        if meets.ratio != 1.0 or meets.drag:
            changed = Quotient(found.above * meets.ratio + meets.drag * found.below, found.below)
            waves = waves.mapped(changed, meets.ratio, meets.drag)
        found = met_by(meets, s, found)
        waves = waves.crossed(found, s, meets.time, half)
    waves = waves.mapped(found, 1.0, 0.0)
    larger = np.where(waves.returns, found.below - found.above, found.above + found.below)
    sign = np.where(waves.returns, 1.0, -1.0)
    return _Side(found.below / larger, found.above / larger, sign, 0.5 * waves.radius, waves.turned, layers.impedances[0])


@dataclass(frozen=True)
class LinePieces:
    """Pieces of a line: s in the middle of each (1/s), and half of its length (1/s)."""

    body: OfLayers
    s: Complex
    half: Floats

    @cached_property
    def _sides(self) -> tuple[_Side, ...]:
        with np.errstate(all="ignore"):  # a radius may be inf
            return tuple(_of_side(one, self.s, self.half) for one in self.body.stacks)

    @property
    def turned(self) -> Floats:
        """The angle (rad) by which the phase of the factor that both sides have may differ from that in the middle."""
        return np.asarray(sum((one.turned for one in self._sides), np.zeros(self.half.shape)))

    def polynomial(self, p: Polynomial) -> Bound:
        """Return a bound of a polynomial in s, by its Taylor series."""
        if len(p) == 1:
            return Bound(np.full(self.s.shape, complex(p[0])), np.zeros(self.s.shape))
        radius: Floats = ROUNDING_OF_PHASE * np.asarray(poly.polyval(np.abs(self.s), np.abs(p)), float)
        slope, step = p, np.ones(self.half.shape)
        for k in range(1, len(p)):
            slope, step = poly.polyder(slope), step * self.half / k
            radius = radius + np.abs(poly.polyval(self.s, slope)) * step
        return Bound(np.asarray(poly.polyval(self.s, p)), radius)

    def bound(self, a: Polynomial, b: Polynomial) -> Bound:
        """Return a bound of a below + b above, over the larger waves of both sides."""
        one, other = (*self._sides, _NOTHING)[:2]
        parts = [self.polynomial(np.asarray(part, float)) for part in (a, b)]
        factors = partial(sides_of(self.body).factors, z=one.impedance, other=other.impedance)
        terms = [factors(*both) for both in zip(*parts, strict=True)]  # of the middles, and of their radii
        values = [np.abs(one.below), np.abs(one.above)], [np.abs(other.below), np.abs(other.above)]
        wide = [[part + side.radius for part in sizes] for side, sizes in zip((one, other), values, strict=True)]
        first: Complex = _summed(terms[0], (0.5 + 0j, 0.5 * one.sign), (other.below, other.above))
        second = _summed(terms[0], (one.below, one.above), (0.5 + 0j, 0.5 * other.sign))
        both = _summed(terms[0], (0.5 + 0j, 0.5 * one.sign), (0.5 + 0j, 0.5 * other.sign))
        with np.errstate(invalid="ignore"):  # a radius may be inf
            radius: Floats = 2.0 * (np.abs(first) * one.radius + np.abs(second) * other.radius)
            radius = radius + 4.0 * np.abs(both) * one.radius * other.radius
            radius = radius + np.real(_summed(np.abs(terms[1]), *wide) + ROUNDING_OF_PHASE * _summed(np.abs(terms[0]), *values))
        return Bound(_summed(terms[0], (one.below, one.above), (other.below, other.above)), np.asarray(radius))


_NOTHING = _Side(np.ones(1, complex), np.zeros(1, complex), np.zeros(1), np.zeros(1), np.zeros(1), 0.0)
"""The other side of a contact with layers on one side only."""


def _summed(terms: Complex | Floats, one: Sequence[Any], other: Sequence[Any]) -> Complex:
    """Return the sum of products of both sides' velocities and stresses."""
    below, above = one
    return np.asarray(
        terms[0] * below * other[0] + terms[1] * below * other[1] + terms[2] * above * other[0] + terms[3] * above * other[1]
    )
