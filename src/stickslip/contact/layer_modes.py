"""Modes of a body of layers on a contact: whether a disturbance of its steady sliding grows, and how fast.

At high frequencies the modes repeat themselves with the frequency 1 / (2 T) of a cell: `crowd` is the growth rate that they tend
to, and without mass and states that of all of them. Other lines are looked at until one is found with a root next to it and none
beyond it (`rightmost`). A verdict rests on a count of roots, or on a root that is found to grow; without either it is not decided.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from stickslip.contact.layer_count import Line, NotCountedError
from stickslip.contact.layer_roots import LEAN, in_period
from stickslip.contact.layer_search import LayerSearch
from stickslip.contact.rightmost import SeenBeyond, climbed
from stickslip.contact.secant import polished
from stickslip.contact.wave_modes import Growth

GONE = 25.0
"""A disturbance that fades by exp(-GONE) within a two-way travel time through all cells is gone at once."""
NEARER = 20
"""Number of lines that come nearer to the crowd, each half as far from it as the one before."""
SAME_GROWTH = 1e-8
"""A growth rate counts as that of the crowd if it differs by no more than this share (1)."""


@dataclass(frozen=True)
class LayerModes(LayerSearch):
    """The roots of a characteristic equation of layers as modes: the verdict on all of them, and the one that matters most."""

    @cached_property
    def verdict(self) -> bool | None:
        """True if every disturbance fades, False if one grows, None if one keeps its size, or if it is not decided."""
        if self.is_off_branch:
            return False
        if self.is_neutral:
            return None
        try:
            return not self.roots_beyond(0.0)
        except NotCountedError:
            return False if self.found_growing else None

    @property
    def one_that_grows(self) -> complex | None:
        """The fastest root (1/s) that is found next to the axis and grows; None without one."""
        if self.verdict is not False or self.is_off_branch:
            return None
        try:
            near = [one for one in polished(self.value, self.at_axis.seeds) if one.real > LEAN * abs(one)]
        except NotCountedError:
            near = []
        return max(near or self.found_growing[:1], key=lambda one: one.real, default=None)

    def growth(self) -> Growth:
        """Return the growth rate and the frequency of the mode that grows fastest; of one that fades, the slowest that is found.

        The rate is nan if it is not known, and always agrees with the verdict.
        """
        if self.is_off_branch:
            return Growth(math.inf, 0.0)
        if self.is_neutral:
            return Growth(0.0, 0.0)
        if self.verdict is None:
            return Growth(math.nan, 0.0)
        try:
            found = self._fading() if self.verdict else self._growing()
        except NotCountedError:
            best = self.found_growing
            found = _growth_of(best[0]) if best else Growth(math.nan, 0.0)
        agrees = found.rate <= 0.0 if self.verdict else found.rate > 0.0
        return found if agrees else Growth(math.nan, 0.0)

    def _growing(self) -> Growth:
        crowd = self._crowd
        if self.is_algebraic:
            return crowd
        if crowd.rate > 0.0:
            return self._beyond(crowd, [crowd.rate * (1.0 + 0.5**k) for k in range(NEARER)])
        look = self.at_axis
        return self._climbed(0.0, look if len(look.seeds) else SeenBeyond(look.number, np.array(self.found_growing)))

    def _fading(self) -> Growth:
        crowd = self._crowd
        if self.is_algebraic or crowd.rate == 0.0:
            return crowd
        if math.isfinite(crowd.rate):
            return self._beyond(crowd, [crowd.rate * (1.0 - 0.5**k) for k in range(1, NEARER)])
        lines = [-1e-3 * self._scale * 2.0**k for k in range(NEARER)]
        return self._beyond(crowd, [line for line in lines if -line < self._slowest])

    def _beyond(self, crowd: Growth, lines: list[float]) -> Growth:
        """Return the growth of the mode farthest to the right, from lines ever nearer to the crowd; or the crowd's."""
        for line in lines:
            try:
                look = self.look(line)
                if look.number:
                    return self._climbed(line, look)
            except NotCountedError:
                found = self.bettered([one for one in self.sought(line) if (one.real < 0.0) is self.verdict])
                return _growth_of(found[0]) if found and found[0].real - crowd.rate > SAME_GROWTH * abs(crowd.rate) else crowd
        return crowd

    def _climbed(self, low: float, look: SeenBeyond) -> Growth:
        return _growth_of(climbed(self.look, lambda seeds: polished(self.value, seeds), low, look.seeds, self._scale))

    @property
    def _scale(self) -> float:
        """The inverse of the travel time (1/s) through all layers and back."""
        return 1.0 / self.body.two_way_time

    @property
    def _slowest(self) -> float:
        """The rate (1/s) of a disturbance that is gone at once."""
        return GONE / (2.0 * self.body.cells.time * sum(self.body.cells.counts))

    @cached_property
    def _crowd(self) -> Growth:
        """The growth rate that modes tend to at high frequencies; -inf if there are none."""
        if self.keeps_far_modes:
            return Growth(0.0, 0.0)

        def look(line: float) -> SeenBeyond:
            return in_period(self.body, line, *self.far)

        line, first = 0.0, look(0.0)
        for k in range(60):
            if first.number:
                break
            line = -1e-3 * self._scale * 2.0**k
            if -line > self._slowest:
                return Growth(-math.inf, 0.0)
            first = look(line)
        best = climbed(look, lambda seeds: polished(self.value_far, seeds), line, first.seeds, self._scale)
        period = Line(self.body, 0.0).period
        frequency = abs(best.imag - period * round(best.imag / period))
        near_zero = 1e-14 * self._scale
        return Growth(
            0.0 if abs(best.real) < near_zero else best.real, 0.0 if frequency < 1e-11 * max(abs(best), self._scale) else frequency
        )


def _growth_of(root: complex) -> Growth:
    return Growth(root.real, 0.0 if abs(root.imag) < 1e-11 * abs(root) else abs(root.imag))
