"""Counts of roots of the characteristic function of layers to the right of a line of growth rates, each with a bound.

A root turns the phase of a function along the line by 2 pi, but a resonance may do so within a frequency interval of any smallness.
So the line is cut into pieces for which discs (`layer_discs`) bound the change of the phase below a half turn. Pieces where they do
not are halved; if that ends nowhere, or takes too many pieces, there is no count.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial as poly
from numpy.typing import NDArray

from stickslip.contact.layer_discs import LinePieces
from stickslip.contact.layer_response import Complex, response_of
from stickslip.contact.wave_modes import Polynomial
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import OfLayers

WIDEST = 1.2
"""Largest angle (rad) to each side of the middle of a piece, less than pi/2."""
MOST_PIECES = 1 << 17
"""Largest number of pieces of a line, unless it is given."""
CUTS_OF_PIECE = 22
"""Largest number of times that pieces are cut."""
SMALL, CUTS = 0.9, 6
"""Pieces are cut so that the angle (rad) becomes this small, but into no more than so many."""
LOWEST_FREQUENCY = 80
"""The lowest frequency of a line is 2^-LOWEST_FREQUENCY of the highest one."""
LARGEST_ANGLE = 0.5
"""Largest angle (rad) at which a piece is seen whose size is bounded."""
WHOLE_TURNS = 0.02
"""A number of turns may differ from a whole one by this much (1)."""
_Bounds = Callable[[LinePieces], Floats]


class NotCountedError(ArithmeticError):
    """Raised if a count needs too many pieces, or if a root lies so close to the line that rounding decides."""


class Followed(NamedTuple):
    """Hold pieces of a line with a function at both ends, whose phase turns by less than a half turn in each."""

    low: Floats
    """Frequencies (rad/s)."""
    high: Floats
    at_low: Complex
    at_high: Complex

    def some(self, chosen: NDArray[np.bool_]) -> Followed:
        """Return the pieces that are chosen."""
        return Followed(self.low[chosen], self.high[chosen], self.at_low[chosen], self.at_high[chosen])

    @property
    def turned(self) -> float:
        """The change of the phase along all pieces (rad)."""
        return float(np.sum(np.angle(self.at_high / self.at_low)))

    def seeds(self, line: float, number: int) -> Complex:
        """Return places near which the function is 0, as straight lines through both ends have it: those nearest to the line."""
        with np.errstate(all="ignore"):
            step = 1j * (self.high - self.low) * self.at_low / (self.at_low - self.at_high)
        known = np.flatnonzero(np.isfinite(step))
        best = known[np.argsort((np.abs(step) / self.high)[known])][:number]
        far = known[np.argsort(np.abs(step)[known])][:number]
        some = np.unique(np.concatenate([best, far]))
        return np.asarray(line + 1j * self.low[some] + step[some])


def joined(pieces: list[Followed]) -> Followed:
    """Return several lists of pieces as one."""
    low, high = (np.concatenate([one[k] for one in pieces]).real for k in (0, 1))
    return Followed(low, high, *(np.concatenate([one[k] for one in pieces]).astype(complex) for k in (2, 3)))


@dataclass(frozen=True)
class Line:
    """A line of growth rates s = line + (lean + i) frequency, for a body of layers."""

    body: OfLayers
    line: float
    """Growth rate (1/s) at the frequency 0."""
    lean: float = 0.0
    """Its change with the frequency (1)."""
    most: int = MOST_PIECES
    """Largest number of pieces."""

    def at(self, frequency: Floats) -> Complex:
        """Return growth rates s (1/s) at frequencies (rad/s)."""
        return np.asarray(self.line + (self.lean + 1j) * frequency)

    def followed(self, of: Callable[[Complex], Complex], angle: _Bounds, frequencies: Floats) -> Followed:
        """Return pieces on which the phase of a function is followed, given bounds of its change for pieces.

        Raises NotCountedError if there are too many.
        """
        values = of(self.at(frequencies))
        rest = Followed(frequencies[:-1], frequencies[1:], values[:-1], values[1:])
        done, number = [], 0
        for _ in range(CUTS_OF_PIECE):
            angles = angle(self.piece(rest.low, rest.high))
            sure = angles < WIDEST
            done.append(rest.some(sure))
            number += int(sure.sum())
            if sure.all():
                return joined(done)
            if number + CUTS * int((~sure).sum()) > self.most:
                break
            rest = self._cut(of, rest.some(~sure), angles[~sure])
        raise NotCountedError

    def _cut(self, of: Callable[[Complex], Complex], rest: Followed, angles: Floats) -> Followed:
        """Return shorter pieces, as many as make the angle small, or CUTS if it is not known."""
        with np.errstate(invalid="ignore"):
            parts = np.where(angles < CUTS * SMALL, np.ceil(angles / SMALL), CUTS).astype(int)
        whole_one = np.repeat(np.arange(len(parts)), parts)
        part = np.arange(len(whole_one)) - np.repeat(np.cumsum(parts) - parts, parts)
        ends = np.append(np.flatnonzero(part == 0)[1:] - 1, len(part) - 1)
        low, high = rest.low[whole_one], rest.high[whole_one]
        step = (high - low) / parts[whole_one]
        begin = low + part * step
        begins = np.flatnonzero(part > 0)
        at_low = rest.at_low[whole_one]
        at_low[begins] = of(self.at(begin[begins]))
        end, at_high = np.append(begin[1:], 0.0), np.append(at_low[1:], 0.0)
        end[ends], at_high[ends] = rest.high, rest.at_high
        return Followed(begin, end, at_low, at_high)

    def piece(self, low: Floats, high: Floats) -> LinePieces:
        """Return pieces between frequencies (rad/s)."""
        return LinePieces(self.body, self.at(0.5 * (low + high)), 0.5 * (high - low) * math.hypot(1.0, self.lean))

    # ---- one period of the layers -----------------------------------------------------------------------------------------------

    @property
    def period(self) -> float:
        """The angular frequency (rad/s) with which the response of the layers repeats itself."""
        return math.pi / self.body.cells.time

    @property
    def cells(self) -> int:
        """Number of cells of all sides, and so of roots in a period, at most."""
        return sum(self.body.cells.counts)

    def _half_period(self) -> Floats:
        return np.linspace(0.0, 0.5 * self.period, 2 * self.cells + 1)

    def roots_in_period(self, a: float, b: float) -> tuple[int, Followed]:
        """Return the number of roots of a below + b above to the right of the line in each period, and what was followed."""
        one, other = np.array([a]), np.array([b])

        def value(s: Complex) -> Complex:
            above, below = response_of(self.body, s)
            return np.asarray(a * below + b * above)

        def angle(piece: LinePieces) -> Floats:
            return np.asarray(piece.bound(one, other).angle + piece.turned)

        found = self.followed(value, angle, self._half_period())
        return whole(-found.turned / math.pi), found

    def largest_share(self, a: float, b: float) -> float:
        """Return a bound of the size of the returning wave on the line, over that of u + k d = 2 Z (a below + b above) / (a + Z b).

        u and d are the waves that leave the contact and come back.
        """
        z = self.body.impedance
        back, whole_wave = (np.array([z]), np.array([-1.0])), (np.array([a]), np.array([b]))
        at, largest = self._half_period(), 0.0
        low, high = at[:-1], at[1:]
        for _ in range(CUTS_OF_PIECE):
            piece = self.piece(low, high)
            over = piece.bound(*whole_wave)
            sure = over.angle < LARGEST_ANGLE
            with np.errstate(all="ignore"):
                share = piece.bound(*back).most[sure] / over.least[sure]
            largest = max(largest, float(np.max(share, initial=0.0)))
            if sure.all():
                return largest * abs(a + z * b) / (2.0 * z)
            if 2 * len(low) > self.most:
                break
            low, high = low[~sure], high[~sure]
            middle = 0.5 * (low + high)
            low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
        raise NotCountedError


@dataclass(frozen=True)
class Share:
    """The characteristic function over that of a contact without mass and states, both over their terms at high frequencies.

    It is H = (a below + b above) (a' + Z b') / ((a' below + b' above) p), p = a + Z b, and tends to 1.
    """

    a: Polynomial
    b: Polynomial
    p: Polynomial
    to: tuple[float, float]
    """The numbers a' and b'."""
    body: OfLayers

    def value(self, s: Complex) -> Complex:
        """Return H at growth rates s (1/s)."""
        above, below = response_of(self.body, s)
        one, other = self.to
        by = (one * below + other * above) * poly.polyval(s, self.p) / (one + self.body.impedance * other)
        return np.asarray((poly.polyval(s, self.a) * below + poly.polyval(s, self.b) * above) / by)

    def angle(self, piece: LinePieces) -> Floats:
        """Return how far the phase of H may differ from that in the middle of pieces (rad)."""
        one, other = self.to
        found = piece.bound(self.a, self.b).angle
        if len(self.p) > 1:
            found = found + piece.polynomial(self.p).angle
        return np.asarray(found + piece.bound(np.array([one]), np.array([other])).angle)

    def windings(self, on: Line, low: float, high: float) -> tuple[int, Followed]:
        """Return how often H winds around 0 between two frequencies (rad/s) and their negatives, and what was followed.

        Outside of them H lies within a distance of 1 from 1. Raises NotCountedError if that cannot be said.
        """
        number = 2.0 * on.cells * (high - low) / on.period
        if number > on.most:
            raise NotCountedError
        lowest = max(low, math.ldexp(high, -LOWEST_FREQUENCY))
        slow = high * 2.0 ** -np.arange(LOWEST_FREQUENCY)
        even = np.linspace(low, high, max(int(number), 2) + 1)
        at = np.unique(np.concatenate([[lowest, high], slow[slow > lowest], even[even > lowest]]))
        found = on.followed(self.value, self.angle, at)
        begin, end = self.value(on.at(np.array([lowest, high])))
        known = float(np.angle(end)) - (0.0 if low == 0.0 else float(np.angle(begin)))
        return whole((found.turned - known) / math.pi), found


def whole(number: float) -> int:
    """Return the whole number that another one is close to. Raises NotCountedError if there is none."""
    found = round(number)
    if abs(number - found) > WHOLE_TURNS:
        raise NotCountedError
    return found
