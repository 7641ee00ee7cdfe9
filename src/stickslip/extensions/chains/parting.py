"""How far the events of a chain can be foretold: when runs part whose initial slips differ by little.

A disturbance of the slip grows from event to event by factors that friction, springs and the state of the chain decide; no formula
is known for them. So they are measured: the chain is run again with slips that are disturbed, by sizes ten times apart, and each
time it is asked which events remain.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.chains.drawn import LARGEST_SEED
from stickslip.extensions.chains.solver import solve_chain
from stickslip.foundation.arguments import NamesAttributes, check_whole, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import ShownAsTable, brief, number

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainRun

LEAST_SIZE, MOST_SIZE, LARGEST_SIZE = 1e-14, 1e-6, 1e-4
"""Bounds of the least disturbance, as a share of the slip, and the size up to which it is made ten times as large again and again.

Below the first one it would be lost in rounding; from the second one on there would be fewer than three sizes.
"""
SAME_SHARE = 0.1
"""An event is the same if it begins at the same time, to within this share of the time to the nearer of its two neighbours."""
FEWEST_SIZES = 3
"""A straight line is fitted to the horizons of at least so many sizes."""
MOST_RUNS = 1000


class HorizonSlope(NamedTuple):
    """How a horizon falls with ln(size): by so many s and events per e-fold, and the standard error of the first."""

    time: float
    events: float
    error: float


@dataclass(frozen=True, eq=False, repr=False)
class ChainPredictability(ShownAsTable, NamesAttributes):
    """The result of `ChainRun.predictability`: how many events remain if the initial slips are disturbed.

    `sizes` of the disturbance are shares of `slip` (m), the largest mean slip of the blocks of an event. For each disturbance (row)
    and size (column), `horizons` holds the time (s) of the first event that the disturbed run lacks, inf if it has all of them, and
    `shared` the number of events before that one. `events` is the number of those that were compared.
    """

    sizes: Floats
    slip: float
    horizons: Floats
    shared: NDArray[np.int64]
    events: int
    seed: int

    @property
    def horizon(self) -> float:
        """The time (s) of the first event that some run with the least disturbance lacks; inf if each run has all events."""
        return float(self.horizons[:, 0].min())

    @cached_property
    def _growth(self) -> HorizonSlope | None:
        """The straight line through the mean horizons of sizes that make all runs part; None if these are too few."""
        part = np.isfinite(self.horizons).all(axis=0)
        if part.sum() < FEWEST_SIZES:
            return None
        # the runs of one size lack the same events of one run, so that their mean counts as one point
        away = np.log(self.sizes[part])
        away -= away.mean()
        time, events = (np.mean(one[:, part], axis=0) for one in (self.horizons, self.shared))
        scale = float(away @ away)
        slope = float(away @ time) / scale
        left = time - time.mean() - slope * away
        error = math.sqrt(float(left @ left) / (len(away) - 2) / scale)
        return HorizonSlope(-slope, -float(away @ events) / scale, error) if slope < 0.0 else None

    @property
    def per_decade(self) -> float:
        """How much earlier (s) the horizon is if the disturbance is ten times as large; NaN if it cannot be told."""
        return self._growth.time * math.log(10.0) if self._growth else math.nan

    @property
    def exponent(self) -> float:
        """The growth rate (1/s) of a disturbance, an estimate of the largest Lyapunov exponent; NaN if it cannot be told.

        It is how fast ln(size) falls with the horizon. At least three sizes must make all runs part.
        """
        return 1.0 / self._growth.time if self._growth else math.nan

    @property
    def exponent_error(self) -> float:
        """The standard error of the exponent (1/s), from how far horizons lie off the straight line."""
        return self._growth.error / self._growth.time**2 if self._growth else math.nan

    @property
    def growth_per_event(self) -> float:
        """How many times larger a disturbance is from one event to the next, on average; NaN if it cannot be told."""
        return math.exp(1.0 / self._growth.events) if self._growth and self._growth.events > 0.0 else math.nan

    @property
    def text(self) -> str:
        """How long single events are predictable, in a sentence."""
        known = f"with initial slips known to {number(float(self.sizes[0]), 3)} of {brief(self.slip, 'm', 3)}"
        runs = f"{len(self.horizons)} disturbed run{'s' if len(self.horizons) > 1 else ''}, seed {self.seed}"
        if math.isinf(self.horizon):
            return f"all {self.events} events are predictable {known} ({runs})"
        least = int(self.shared[:, 0].min())
        return f"the first {least} of {self.events} events, up to {number(self.horizon, 6)} s, are predictable {known} ({runs})"

    @property
    def growth_text(self) -> str:
        """How fast a disturbance grows, in a sentence."""
        if not np.isfinite(self.horizons).any():
            return f"no run parts up to a disturbance of {number(float(self.sizes[-1]), 3)}"
        if self._growth is None:
            return f"how fast a disturbance grows cannot be told: runs of fewer than {FEWEST_SIZES} sizes part"
        digits = f"{number(self.exponent, 3)} per s (standard error {number(self.exponent_error, 2)})"
        each = f", {number(self.growth_per_event, 3)} times per event" if math.isfinite(self.growth_per_event) else ""
        return f"a disturbance ten times as large costs {number(self.per_decade, 3)} s: it grows by {digits}{each}"

    def _lines(self) -> list[tuple[str]]:
        beyond = [] if math.isinf(self.horizon) else ["beyond that only statistics of events mean anything"]
        return [(line,) for line in (self.text, self.growth_text, *beyond)]


def chain_predictability(run: ChainRun, size: float, runs: int, seed: int) -> ChainPredictability:
    """Run a chain again with disturbed initial slips: see `ChainRun.predictability`. Raises InputError."""
    where = "ChainRun.predictability"
    if isinstance(size, bool) or not isinstance(size, int | float | np.floating) or not LEAST_SIZE <= size <= MOST_SIZE:
        raise InputError(f"{where}: size must be a share of the slip from {LEAST_SIZE:g} to {MOST_SIZE:g}, got {shown(size)}")
    many, first_seed = check_whole(f"{where}: runs", runs, 1, MOST_RUNS), check_whole(f"{where}: seed", seed, 0, LARGEST_SEED)
    allowed = _allowed(run)
    events = run.events[: len(allowed)]
    if not len(events):
        raise InputError(f"{where}: no event is over early enough before the end of the run at {run.duration:g} s: run it longer")
    slip, start = float(np.abs(events["moment"] / events["size"]).max()), run.chain.values("initial_slip")
    sizes: Floats = float(size) * np.power(10.0, np.arange(1 + math.floor(math.log10(LARGEST_SIZE / size) + 1e-9)))
    shared = np.empty((many, len(sizes)), np.int64)
    for row in range(many):
        # the same direction for each size, so that only the size differs
        way = slip * np.random.default_rng((first_seed, row)).uniform(-1.0, 1.0, run.chain.count)
        for column, share in enumerate(sizes):
            again = solve_chain(replace(run.chain, initial_slip=start + share * way), run.duration)
            shared[row, column] = shared_events_of(events, again.events, allowed)
    horizons = np.append(events["time"], np.inf)[shared]
    return ChainPredictability(sizes, slip, horizons, shared, len(events), first_seed)


def _allowed(run: ChainRun) -> Floats:
    """Return by how much (s) each event of a run may begin earlier or later, without those a disturbed run may end too late."""
    time = run.events["time"]
    gaps = np.diff(time)
    nearest = np.minimum(np.append(np.inf, gaps), np.append(gaps, np.inf))
    allowed = SAME_SHARE * np.where(np.isfinite(nearest), nearest, run.duration)
    late = np.flatnonzero(time + run.events["duration"] + allowed > run.duration)
    return np.asarray(allowed[: late[0]] if late.size else allowed)


def shared_events_of(events: Any, others: Any, allowed: Floats) -> int:
    """Return how many of these events, from the first one on, are also those of another run.

    The same event has the same first block and number of blocks, and begins at the same time to within so much (s).
    """
    count = min(len(events), len(others))
    one, other = events[:count], others[:count]
    same = (one["first_block"] == other["first_block"]) & (one["size"] == other["size"])
    same &= np.abs(one["time"] - other["time"]) <= allowed[:count]
    return count if same.all() else int(same.argmin())
