"""Roots of the characteristic equation of layers that are sought where they cannot be counted, because there are too many."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.polynomial import polynomial as poly

from stickslip.contact.layer_count import Followed, Line, NotCountedError, Share
from stickslip.contact.layer_roots import LEAN, PLACES_SOUGHT_FROM, LayerRoots, Spans
from stickslip.contact.secant import polished
from stickslip.contact.wave_modes import roots_of

STRIDES = 12
"""From a root others are sought that lie up to 2^STRIDES periods of the layers away."""
WINDOWS = 24
"""Number of places, besides those where friction gives most, in which roots are sought."""
SCANNED = 4000
"""Number of frequencies at which friction's response is looked at."""
SAMPLES_OF_CELL = 8
"""Number of samples for each cell in half of a period."""


@dataclass(frozen=True)
class LayerSearch(LayerRoots):
    """A characteristic equation of layers whose roots are sought in some of all periods of the frequency."""

    @cached_property
    def found_growing(self) -> list[complex]:
        """Roots that are certain to grow, fastest first: found, not counted."""
        return self.bettered([one for one in self.sought(0.0) if one.real > LEAN * abs(one)])

    def bettered(self, roots: list[complex]) -> list[complex]:
        """Return roots on the same side of the axis that lie no farther left, that farthest to the right first.

        Roots follow each other in chains, one in each period of the layers, along which the growth rate changes slowly.
        """
        period, best = Line(self.body, 0.0).period, sorted(roots, key=lambda one: -one.real)[: PLACES_SOUGHT_FROM // 8]
        least = -math.ceil(math.log2(sum(self.body.cells.counts)))
        strides = 1j * period * np.outer([1.0, -1.0], 2.0 ** np.arange(least, STRIDES)).ravel()
        for _ in range(STRIDES if best else 0):
            found = polished(self.value, (np.array(best)[:, None] + strides).ravel())
            found = [one for one in found if (one.real < 0.0) is (best[0].real < 0.0) and abs(one.real) > LEAN * abs(one)]
            better = sorted([*best, *found], key=lambda one: -one.real)[: PLACES_SOUGHT_FROM // 8]
            if better[0].real <= best[0].real:
                break
            best = better
        return best

    def sought(self, line: float) -> list[complex]:
        """Return the roots that are found from places along a line (1/s), in some of all periods."""
        try:
            spans = self.spans(line)
        except NotCountedError:
            spans = None
        if spans is None:
            spans = Spans(Share(self.a, self.b, self.p, self.matched, self.body), [(0.0, math.inf)])
        period, seeds = Line(self.body, line).period, []
        number = SAMPLES_OF_CELL * min(sum(self.body.cells.counts), 500)
        for low, high in spans.edges:
            end = high if math.isfinite(high) else 1e3 * max(low, period, *np.abs(roots_of(self.p)))
            width = min(0.5 * period, end - low)
            peaks = [one - 0.5 * width for one in self._peaks() if low < one < end]
            for begin in [low, *peaks, *(low + np.geomspace(1e-12 * end, end, WINDOWS)).tolist()]:
                at = np.linspace(max(begin, low), begin + width, number)
                at[0] = max(at[0], 1e-15 * end)
                values = self.entire(line + 1j * at)
                seeds.append(Followed(at[:-1], at[1:], values[:-1], values[1:]).seeds(line, number // SAMPLES_OF_CELL))
        found = polished(self.entire, np.concatenate(seeds)) if seeds else []
        return polished(self.value, np.array(found))

    def _peaks(self) -> list[float]:
        """Return the frequencies (rad/s) at which friction gives most to a wave that it sends back, or takes least of it."""
        q = poly.polysub(self.a, self.body.impedance * self.b)
        sizes = np.abs(np.concatenate([roots_of(self.p), roots_of(poly.polytrim(q))]))
        sizes = sizes[sizes > 0.0]
        if not len(sizes):
            return []
        at = np.geomspace(1e-3 * sizes.min(), 1e3 * sizes.max(), SCANNED)
        back = np.abs(poly.polyval(1j * at, q) / poly.polyval(1j * at, self.p))
        found: list[float] = at[1:-1][(back[1:-1] > back[:-2]) & (back[1:-1] > back[2:])].tolist()
        return found
