"""The Gutenberg-Richter law of a catalogue: how the number of events falls with their magnitude.

N(m or larger) = 10^(a - b m), or exp(-beta m) with beta = b ln 10. The slope is the most likely one
(`statistics_likelihood`), its interval comes of resampling the magnitudes above completeness.

Sources: K. Aki, Bull. Earthquake Res. Inst. 43, 237 (1965), exact magnitudes; S. Tinti, F. Mulargia, Bull. Seismol. Soc. Am. 77,
2125 (1987), in bins; S. Wiemer, M. Wyss, Bull. Seismol. Soc. Am. 90, 859 (2000), completeness by the largest curvature, and
J. Woessner, S. Wiemer, Bull. Seismol. Soc. Am. 95, 684 (2005), what is added to it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd

from stickslip.extensions.chains.magnitudes import RUN_OR_NUMBERS, numbers_of
from stickslip.extensions.chains.magnitudes import magnitudes as magnitudes_of
from stickslip.extensions.chains.statistics_asked import ON_GRID, between, check_enough, checked_bin, checked_number, on_grid
from stickslip.extensions.chains.statistics_likelihood import (
    completeness_of,
    drawn_excess,
    largest_gap,
    resampled_means,
    share_below,
    slope,
)
from stickslip.foundation.arguments import check_whole, for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.run import Study

LN_10 = math.log(10.0)
FEW_EVENTS = 50
"""With fewer events than this the interval is rough: said in words."""
ROUNDED = 0.5
"""Magnitudes that are said to be exact seem rounded if there are fewer different ones than this share of them."""
MOST_RESAMPLES = 100_000
BINS_SHOWN = 25
"""The table of exact magnitudes has about so many bins."""
CATALOGUES_DRAWN = 1_000
"""How well the law fits is judged by so many drawn catalogues of at most as many events each."""
JUDGED = 10
"""How well the law fits fewer events than this is not judged: hardly any of them could be too far from it."""
BARELY = 0.05
"""The law is said not to fit if a drawn catalogue is as far from it with a smaller probability than this."""


@dataclass(frozen=True, eq=False, repr=False)
class GutenbergRichter(Study):
    """The result of `gutenberg_richter`: the slope b of a catalogue with its interval, and how well the law fits.

    `magnitudes` are all that were given, ascending; b was found from those that are `complete`, from `completeness` to
    `largest`.
    `told` is True if completeness was found from the magnitudes. `low` and `high` are the ends of the interval of b that holds the
    share `confidence` of resampled catalogues.
    """

    magnitudes: Floats
    completeness: float
    told: bool
    bin: float
    largest: float
    beta: float
    low: float
    high: float
    confidence: float
    seed: int

    @property
    def b(self) -> float:
        """The slope b: the number of events falls by a factor 10^b for each unit of magnitude."""
        return self.beta / LN_10

    @cached_property
    def complete(self) -> Floats:
        """The magnitudes from completeness to the largest, ascending."""
        return between(self.magnitudes, self.completeness, self.largest, self.bin)

    @property
    def events(self) -> int:
        """The number of events that are complete."""
        return len(self.complete)

    @property
    def a(self) -> float:
        """The number a: 10^(a - b m) events of magnitude m or larger are expected (without a largest magnitude)."""
        return math.log10(self.events) + self.b * self._first_edge

    @property
    def _first_edge(self) -> float:
        return self.completeness - 0.5 * self.bin

    @property
    def _span(self) -> float:
        return self.largest - self.completeness

    @cached_property
    def distance(self) -> float:
        """The largest distance between the share of events and that of the law at or below a magnitude (Kolmogorov-Smirnov)."""
        return largest_gap(self.complete - self.completeness, self.beta, self.bin, self._span)

    @cached_property
    def p_value(self) -> float:
        """The share of catalogues drawn from the law, with slopes of their own, that are as far from it as this one.

        A small one says that magnitudes do not follow the law. 1000 catalogues are drawn, of at most 1000 events each; the distance
        of larger ones is compared by its product with the root of the number of events.
        """
        rng, count = np.random.default_rng(self.seed), min(self.events, CATALOGUES_DRAWN)
        here = self.distance * math.sqrt(self.events)
        drawn = np.sort(drawn_excess(self.beta, self.bin, self._span, (CATALOGUES_DRAWN, count), rng), axis=1)
        gaps = []
        for one in drawn:
            beta = slope(float(one.mean()), self.bin, self._span)
            gaps.append(largest_gap(one, beta, self.bin, self._span) * math.sqrt(count) if math.isfinite(beta) else 0.0)
        return float((1 + sum(gap >= here for gap in gaps)) / (1 + CATALOGUES_DRAWN))

    def expected(self, magnitudes: Any) -> Floats:
        """Return how many events of these magnitudes or larger the law expects, NaN where it says nothing; of bins the middles."""
        return self.at_edges(np.asarray(magnitudes, dtype=float) - 0.5 * self.bin, self.beta)

    def at_edges(self, magnitudes: Floats, beta: float) -> Floats:
        """Return how many events the law with a slope beta expects above magnitudes, those beyond the largest one included."""
        total = self._span + self.bin
        reach = magnitudes - self._first_edge
        slack = ON_GRID * (self.bin or 1.0)
        inside = (reach >= -slack) & (reach <= total + slack)
        law = self.events * (1.0 - share_below(np.clip(reach, 0.0, total), beta, 0.0, total))
        return np.where(inside, law + self._above, np.nan)

    @property
    def _above(self) -> int:
        """The number of events beyond the largest magnitude."""
        return len(self.magnitudes) - int(np.searchsorted(self.magnitudes, self.largest + 0.5 * self.bin, side="right"))

    @cached_property
    def table(self) -> pd.DataFrame:
        """A table with a row for each bin of magnitudes, those below completeness too.

        Columns: magnitude, of bins the middle, of exact magnitudes the lower edge of one of 25 parts of the middle nine tenths;
        events in it; at_least, the number of events from there on; expected, that of the law (NaN where it says nothing).
        """
        step = self.bin or self._shown_step()
        places = np.floor((self.magnitudes - self._first_edge) / step + (ON_GRID if self.bin else 0.0)).astype(np.int64)
        found, counts = np.unique(places, return_counts=True)
        magnitude = self._first_edge + found * step + 0.5 * self.bin
        columns = {
            "magnitude": magnitude,
            "events": counts,
            "at_least": counts[::-1].cumsum()[::-1],
            "expected": self.expected(magnitude),
        }
        return pd.DataFrame(columns)

    def _shown_step(self) -> float:
        low, high = np.quantile(self.magnitudes, [0.05, 0.95])
        return float(high - low) / BINS_SHOWN or 1.0

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.chains.figures.frequency import draw_frequency

        return draw_frequency

    @property
    def text(self) -> str:
        """The slope with its interval, and of how many events."""
        held = f"{self.low:.4g} to {self.high:.4g} in {100.0 * self.confidence:g} % of resampled catalogues"
        return f"b = {self.b:.4g} ({held}), beta = b ln 10 = {self.beta:.4g}, of {self.events} events"

    @property
    def completeness_text(self) -> str:
        """Where the catalogue is complete, and who said so."""
        above = self._above
        below = len(self.magnitudes) - self.events - above
        who = "by the largest curvature" if self.told else "as given"
        cut = f", and {above} above the largest magnitude {self.largest:.4g}" if math.isfinite(self.largest) else ""
        return f"complete from magnitude {self.completeness:.4g} on, {who}: {below} of {len(self.magnitudes)} are below{cut}"

    @property
    def fit_text(self) -> str:
        """How well the law fits."""
        if self.events < JUDGED:
            return f"{self.events} events are too few to judge whether the law fits"
        verdict = "the law does not fit: b says little" if self.p_value < BARELY else "the law fits"
        return f"{verdict} (distance {self.distance:.3g}; {100.0 * self.p_value:.2g} % of catalogues drawn from it are as far)"

    @property
    def notes(self) -> tuple[str, ...]:
        """What has to be said before b is used; empty if there is nothing."""
        error = 100.0 / math.sqrt(self.events)
        few = f"{self.events} events are few: b is known to about {error:.0f} % at best, and its interval is rough"
        different = np.unique(self.complete)
        step = float(np.diff(different).min()) if len(different) > 1 else 0.0
        rounded = f"there are only {len(different)} different magnitudes: if they were rounded, say so by bin={step:.4g}"
        said = ((self.events < FEW_EVENTS, few), (not self.bin and len(different) < ROUNDED * self.events, rounded))
        return tuple(text for true, text in said if true)

    @property
    def sentences(self) -> tuple[str, ...]:
        """All that is said of the result."""
        return self.text, self.completeness_text, self.fit_text, *self.notes

    def _sentences(self) -> tuple[str, ...]:
        return self.sentences


@for_users
def gutenberg_richter(
    magnitudes: Any,
    completeness: float | None = None,
    bin: float = 0.0,
    *,
    largest: float | None = None,
    confidence: float = 0.95,
    resamples: int = 1000,
    seed: int = 0,
) -> GutenbergRichter:
    """Find the Gutenberg-Richter slope b of a catalogue, with its interval.

    Parameters
    ----------
    magnitudes : ChainRun or array_like
        Magnitudes of events, or the run of a chain, whose magnitudes are mu = ln M (see `stickslip.studies.magnitudes`). For mu the
        b of papers on chains is `beta` of the result.
    completeness : float, optional
        Smallest magnitude above which the catalogue lacks no event. By default it is found by the largest curvature: bins of a
        fifth of the distance between the quartiles are counted, and completeness lies two bins above the fullest one's lower end.
    bin : float
        Width of the bins to whose middles magnitudes were rounded, such as 0.1; 0 if they were not.
    largest : float, optional
        Magnitude beyond which events are left out, and the law is cut off: the large events of a chain follow a law of their own.
    confidence : float
        Share of resampled catalogues that the interval holds, between 0 and 1.
    resamples : int
        Number of resampled catalogues.
    seed : int
        Seed of the resampling, and of the drawn catalogues that judge the fit.

    Raises
    ------
    InputError
        If magnitudes are not finite numbers or not on the grid of their bins, if fewer than two events are complete, or if all of
        them have one magnitude.

    Examples
    --------
    >>> import numpy as np, stickslip as ss
    >>> drawn = np.random.default_rng(1).exponential(1 / np.log(10), 10_000)
    >>> found = ss.studies.gutenberg_richter(drawn, completeness=0.0)
    >>> print(f"b = {found.b:.3f}, {found.low:.3f} to {found.high:.3f}")
    b = 1.012, 0.992 to 1.033
    """
    who = "gutenberg_richter"
    listed = magnitudes_of(magnitudes) if hasattr(magnitudes, "events") else magnitudes
    given = numbers_of(who, "magnitudes", listed, RUN_OR_NUMBERS)
    width = checked_bin(bin, given)
    if not 0.0 < checked_number(who, "confidence", confidence) < 1.0:
        raise InputError(f"{who}: confidence must lie between 0 and 1, such as 0.95, got {confidence:g}")
    check_whole(f"{who}: resamples", resamples, 20, MOST_RESAMPLES)
    check_whole(f"{who}: seed", seed, 0)
    ordered = on_grid(np.sort(given), width)
    told = completeness is None
    least = completeness_of(ordered, width) if completeness is None else checked_number(who, "completeness", completeness)
    most = math.inf if largest is None else checked_number(who, "largest", largest)
    if most <= least:
        raise InputError(f"{who}: largest must be above completeness {least:g}, got {most:g}")
    if width:  # the first and the last bin whose middles lie between them
        phase = float(ordered[len(ordered) // 2])
        least = phase + math.ceil((least - phase) / width - ON_GRID) * width
        most = phase + math.floor((most - phase) / width + ON_GRID) * width if math.isfinite(most) else most
    excess = between(ordered, least, most, width) - least
    check_enough(excess, least, most, told=told)
    beta = slope(float(excess.mean()), width, most - least)
    means = resampled_means(excess, resamples, seed)
    slopes = np.array([slope(float(mean), width, most - least) for mean in means]) / LN_10
    low, high = np.quantile(slopes, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence], method="nearest")
    return GutenbergRichter(ordered, least, told, width, most, beta, float(low), float(high), float(confidence), seed)
