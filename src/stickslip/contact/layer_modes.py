"""Modes of a body of layers on a contact: the roots s of a(s) + b(s) W(s) = 0, with W of `bodies.layer_response`.

With the impedance Z at the contact and the share R = (Z - W) / (Z + W) of a wave that comes back from the layers this reads
1 + L(s) = 0, L = R (a - Z b) / (a + Z b). Layers and drivers give no energy: abs(R) <= 1 for Re s >= 0, where R has no poles. So
Nyquist's criterion holds as it does for a uniform slab (`wave_modes`), but the phase of R is followed along the frequency by
sampling, which is refined until it turns slowly from one sample to the next.

At high frequencies a / b tends to a number, or to infinity under a mass. The modes then repeat themselves with the frequency
1 / (2 T): `crowd` is the growth rate that they tend to, and without mass and states that of all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.bodies import OfLayers
from stickslip.bodies.layer_response import Complex, response_of
from stickslip.contact.wave_modes import Growth, Polynomial, WaveModes, parts_on_axis, roots_of
from stickslip.foundation.arrays import Floats

SAMPLES = 16
"""Number of samples of a frequency for each cell and 1 / (2 T)."""
MOST_SAMPLES = 1 << 21
"""Largest number of samples of a line."""
TURN = 0.4
"""Largest turn (rad) from a sample to the next."""
HALVINGS, DOUBLINGS, REFINEMENTS = 18, 60, 12
"""Largest numbers of steps in which a line is enclosed, is sought outwards, and gets more samples."""
GONE = 25.0
"""A disturbance that fades by exp(-GONE) within a two-way travel time through all cells is gone at once."""
SMALLEST = 1e-60
"""Smallest growth rate that is sought, as a share of the first step (1)."""
QUARTERS = np.array([[0.25], [0.5], [0.75]])
"""Where samples are added between two others (1)."""
NEAR = 24
"""Number of places from which a root is sought."""
_Function = Callable[[Complex], Complex]


@dataclass(frozen=True)
class LayerModes:
    """The characteristic equation a + b W = 0 of a body of layers, with polynomials a and b in s (lowest order first)."""

    a: Polynomial
    b: Polynomial
    body: OfLayers

    @property
    def _z(self) -> Polynomial:
        return np.asarray(self.body.impedance * self.b)

    @property
    def is_off_branch(self) -> bool:
        """True if g falls with the slip rate: a contact without mass then leaves the rate at once."""
        return WaveModes(self.a, self._z, -1.0, 1.0).is_off_branch

    @cached_property
    def _keeps_energy(self) -> bool:
        """True if drivers send back all that they meet, and no drag takes any."""
        return not self.body.has_drag and all(abs(one.reflection) == 1.0 for one in self.body.stacks)

    @cached_property
    def is_neutral(self) -> bool:
        """True if neither contact nor drivers give energy or take any, at any frequency."""
        (ar, ai), (br, bi) = parts_on_axis(self.a), parts_on_axis(self.b)
        taken = poly.polyadd(poly.polymul(ar, br), poly.polymulx(poly.polymul(ai, bi)))
        return self._keeps_energy and not taken.any()

    @property
    def _is_algebraic(self) -> bool:
        return len(self.a) == len(self.b) == 1

    def value(self, s: Complex) -> Complex:
        """Return a function of s that is 0 at the modes and has no poles."""
        above, below = response_of(self.body, s)
        return np.asarray(poly.polyval(s, self.a) * below + poly.polyval(s, self.b) * above)

    def _loop(self, s: Complex) -> Complex:
        """Return 1 + L."""
        above, below = response_of(self.body, s)
        whole = poly.polyval(s, poly.polyadd(self.a, self._z)) * (self.body.impedance * below + above)
        return np.asarray(2.0 * self.body.impedance * self.value(s) / whole)

    # ---- how many ---------------------------------------------------------------------------------------------------------------

    def roots_beyond(self, line: float) -> float:
        """Return the number of roots with Re s > `line` (1/s, at least 0); inf if there may be roots of any frequency.

        If it is large it may be the least number that there are.
        """
        if line == 0.0 and self.is_neutral:
            return 0.0
        p = poly.polytrim(poly.polyadd(self.a, self._z))
        count = int(np.sum(roots_of(p).real > line))
        outer = WaveModes(self.a, self._z, self._largest_share(line), 0.0)
        ring = outer.ring(line)
        edges = [0.0, *outer.edges(ring).tolist(), math.inf]
        for low, high in pairwise(edges):
            inside = 0.5 * (low + high) if math.isfinite(high) else 2.0 * low + 1.0
            if poly.polyval(inside * inside, ring) >= 0.0:
                continue
            if not math.isfinite(high):
                if not self._is_algebraic:
                    return math.inf
                return math.inf if self._winds(line) else 0.0
            turns = (high - low) / self._period - len(self.a) - len(self.b)
            if line == 0.0 and self._keeps_energy and turns >= 1.0:
                # R alone turns at least once in each period, and the polynomials by half a turn for each of their roots.
                return math.floor(turns)
            values = self._followed(self._loop, line, low, high)[1]
            angles = np.unwrap(np.angle(values))
            begin = 0.0 if low == 0.0 else float(np.angle(values[0]))
            change = angles[-1] - angles[0] - (float(np.angle(values[-1])) - begin)
            count -= round(change / math.pi)  # the line below the axis turns as much
        return count

    @cached_property
    def _period(self) -> float:
        """The angular frequency (rad/s) with which the response of the layers repeats itself."""
        return math.pi / self.body.cells.time

    @property
    def _per_period(self) -> int:
        return SAMPLES * sum(self.body.cells.counts)

    def _largest_share(self, line: float) -> float:
        """Return the largest abs(R) on a line, at most 1."""
        if line == 0.0 and self._keeps_energy:
            return 1.0
        frequencies = (np.arange(self._per_period) + 0.5) * (0.5 * self._period / self._per_period)
        above, below = response_of(self.body, line + 1j * frequencies)
        z = self.body.impedance
        largest = float(np.max(np.abs((z * below - above) / (z * below + above))))
        return min(max(largest * (1.0 + 1e-9), 1e-300), 1.0)

    def _winds(self, line: float) -> bool:
        """Return True if 1 + L winds around 0 in each period of the frequency, for a contact without mass and states."""
        values = self._followed(self._loop, line, 0.0, 0.5 * self._period)[1]
        angles = np.unwrap(np.angle(values))
        return round(float(angles[-1] - angles[0]) / math.pi) != 0

    def _followed(self, of: _Function, line: float, low: float, high: float) -> tuple[Floats, Complex]:
        """Return frequencies (rad/s) from `low` to `high` on a line, and a function there that turns slowly between them."""
        number = min(max(int(self._per_period * (high - low) / self._period), 100), MOST_SAMPLES)
        slow = np.geomspace(max(low, 1e-9 * high, 1e-300), high, 250)
        at = np.unique(np.concatenate([[low], np.linspace(low, high, number), slow[slow > low]]))
        at[0] = max(low, 1e-12 * high)
        values = of(line + 1j * at)
        for _ in range(REFINEMENTS):
            steep = np.flatnonzero(np.abs(np.angle(values[1:] / values[:-1])) > TURN)
            steep = steep[at[steep + 1] - at[steep] > 1e-13 * at[steep + 1]]
            if not len(steep) or len(at) > 2 * MOST_SAMPLES:
                break
            between = (at[steep] + QUARTERS * (at[steep + 1] - at[steep])).ravel()
            at, values = np.append(at, between), np.append(values, of(line + 1j * between))
            order = np.argsort(at)
            at, values = at[order], values[order]
        return at, values

    # ---- how fast ---------------------------------------------------------------------------------------------------------------

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the mode that grows fastest; of one that fades, the slowest that is found."""
        if self.is_off_branch:
            return Growth(math.inf, 0.0)
        if self.is_neutral:
            return Growth(0.0, 0.0)
        crowd = self._crowd
        if self._is_algebraic:
            return crowd
        grows = self.roots_beyond(0.0) > 0
        roots = self._near(self._rightmost()) if grows else self._fading()
        found = [one for one in roots if grows or one.real < 0.0]
        best = max(found, key=lambda one: one.real, default=complex(crowd.rate, crowd.frequency))
        frequency = 0.0 if abs(best.imag) < 1e-11 * abs(best) else abs(best.imag)
        return Growth(best.real, frequency) if best.real > crowd.rate else crowd

    @cached_property
    def _crowd(self) -> Growth:
        """The growth rate that modes tend to at high frequencies; -inf if there are none."""

        def turns(line: float) -> bool:
            angles = np.unwrap(np.angle(self._followed(self._far, line, 0.0, 0.5 * self._period)[1]))
            return round(float(angles[-1] - angles[0]) / math.pi) != 0

        slowest = GONE / (2.0 * self.body.cells.time * sum(self.body.cells.counts))
        line = _edge_of(turns, 1e-3 / self.body.two_way_time, slowest)
        if not math.isfinite(line):
            return Growth(line, 0.0)
        roots = self._polished(self._far, self._lowest(self._far, line, 0.5 * self._period))
        scale = 1.0 / self.body.two_way_time
        near = [one for one in roots if abs(one.real - line) <= 1e-3 * max(abs(line), scale)]
        best = max(near, key=lambda one: (round(one.real / scale, 9), -abs(one.imag)), default=complex(line, 0.0))
        return Growth(0.0 if abs(best.real) < 1e-14 * scale else best.real, abs(best.imag))

    def _far(self, s: Complex) -> Complex:
        """Return a function of s with the period of the layers that is 0 where modes of high frequency are."""
        above, below = response_of(self.body, s)
        if len(self.a) > len(self.b):
            return below
        last = self.a[-1] if len(self.a) == len(self.b) else 0.0
        return np.asarray(last * below + self.b[-1] * above)

    def _rightmost(self) -> float:
        """Return the largest real part of the roots (1/s), which is above 0."""
        return _edge_of(lambda line: self.roots_beyond(line) > 0, 1e-3 / self.body.two_way_time, 0.0)

    def _near(self, line: float) -> list[complex]:
        """Return roots near a line (1/s) that bounds them all."""
        outer = WaveModes(self.a, self._z, self._largest_share(line), 0.0)
        high = max([2.0 * line, self._period, *outer.edges(outer.ring(line)).tolist()])
        roots = self._polished(self.value, self._lowest(self._loop, line, high))
        return [one for one in roots if abs(one.real - line) <= 1e-3 * abs(line)]

    def _fading(self) -> list[complex]:
        """Return the roots that are found from many places to the left of the axis."""
        scale, poles = 1.0 / self.body.two_way_time, roots_of(poly.polytrim(poly.polyadd(self.a, self._z)))
        slow = [size for pole in poles for size in (abs(pole), self.body.stiffness / (self.body.impedance + abs(pole)))]
        fades = np.concatenate([scale * np.geomspace(1e-4, 3.0, 8), slow])
        swings = np.concatenate([[0.0], np.array(slow), self._period * np.linspace(0.0, 2.0, 4 * sum(self.body.cells.counts[:16]))])
        return self._polished(self.value, (-fades[:, None] + 1j * swings).ravel())

    def _lowest(self, of: _Function, line: float, high: float) -> Complex:
        """Return the places on a line, up to a frequency (rad/s), where the size of a function is a minimum, smallest first."""
        at, values = self._followed(of, line, 0.0, high)
        size = np.abs(np.concatenate([[np.inf], values, [np.inf]]))
        size[0] = size[2]  # it is symmetric about the axis
        least = np.flatnonzero((size[1:-1] <= size[:-2]) & (size[1:-1] <= size[2:]))
        best = least[np.argsort(np.abs(values[least]))[:NEAR]]
        slow = np.append(0.0, abs(line) * np.geomspace(1e-3, 1e3, 13))
        return np.append(line + 1j * slow, line + 1j * at[best])

    def _polished(self, of: _Function, begin: Complex) -> list[complex]:
        """Return the roots of a function that the secant method reaches from places."""
        s = begin + 0j
        with np.errstate(all="ignore"):
            before = s * (1.0 + 1e-6) + 1e-30
            here, there = of(s), of(before)
            for _ in range(60):
                step = here * (s - before) / (here - there)
                moves = np.abs(step) > 4e-16 * np.abs(s)
                if not moves.any():
                    break
                before, there = np.where(moves, s, before), np.where(moves, here, there)
                s = np.where(moves, s - step, s)
                here = of(s)
            settled = np.isfinite(s) & (np.abs(step) <= 1e-11 * np.abs(s))
        return [complex(one) for one in s[settled].tolist()]


def _edge_of(holds: Callable[[float], bool], step: float, slowest: float) -> float:
    """Return the line (1/s) up to which a condition holds, to many digits; -inf if it holds nowhere above -`slowest`."""
    inner, rising = 0.0, holds(0.0)
    outer = step if rising else -step
    for _ in range(DOUBLINGS):
        if not rising and -outer > slowest:
            return -math.inf
        if holds(outer) != rising:
            break
        inner, outer = outer, 2.0 * outer
    while inner == 0.0 and abs(outer) > SMALLEST * step and holds(0.1 * outer) != rising:
        outer *= 0.1
    low, high = sorted((inner, outer))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if holds(middle) else (low, middle)
    return 0.5 * (low + high)
