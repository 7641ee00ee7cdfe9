"""The plan of a sweep: its scenario and design, the results to keep, and how it is divided into chunks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.sweeps.design.axis import Values
from stickslip.extensions.sweeps.design.design import GRID, Design, read_design
from stickslip.extensions.sweeps.design.quantities import Wanted, quantities_for, quantities_named
from stickslip.extensions.sweeps.execution.chunk import KeptCurves, Work
from stickslip.foundation.arguments import check_whole
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario, read_scenario, read_source
from stickslip.solution import CURVES

CHUNKS, SMALLEST_CHUNK, LARGEST_CHUNK, LARGEST_BATCH = 64, 16, 4096, 65_536
"""A sweep without a given chunk size is divided into so many chunks; and the limits of their size (members).

A chunk may be a single run of the solver of an extension, which takes far longer.

A chunk has at most LARGEST_CHUNK members if they run one by one, and LARGEST_BATCH in the compiled batch. A sweep that is killed
loses the chunks in progress.
"""
SAMPLES_OF_CURVES = 200
"""Curves have so many samples by default."""
MOST_SAMPLES = 1_000_000
"""A curve has at most so many samples, so that it takes at most 8 MB for each member."""


@dataclass(frozen=True, eq=False)
class Plan:
    """The plan of a sweep. A chunk has `tile` members along each dimension of the design."""

    scenario: Scenario
    design: Design
    work: Work
    tile: tuple[int, ...]

    @property
    def tiles(self) -> tuple[int, ...]:
        """The number of chunks along each dimension."""
        return tuple(-(-whole // part) for whole, part in zip(self.design.shape, self.tile, strict=True))

    @property
    def chunks(self) -> int:
        """The number of chunks."""
        return math.prod(self.tiles)

    def region(self, chunk: int) -> tuple[slice, ...]:
        """Return the slices of the members of a chunk along each dimension."""
        places = np.unravel_index(chunk, self.tiles)
        spans = zip(places, self.tile, self.design.shape, strict=True)
        return tuple(slice(int(at) * part, min((int(at) + 1) * part, whole)) for at, part, whole in spans)

    def members(self, chunk: int) -> NDArray[np.intp]:
        """Return the indices of the members of a chunk, in the order of its results."""
        places = np.meshgrid(*(np.arange(one.start, one.stop) for one in self.region(chunk)), indexing="ij")
        return np.ravel_multi_index(tuple(place.ravel() for place in places), self.design.shape)

    def values(self, chunk: int) -> dict[str, Values]:
        """Return the values of the members of a chunk (SI, one-dimensional arrays) by parameter."""
        return self.design.values(self.members(chunk))


def make_plan(
    scenario: Problem | Scenario | str | Path,
    vary: Any,
    *,
    duration: float | str | WithUnit | None = None,
    design: Any = GRID,
    members: int | None = None,
    seed: int = 0,
    quantities: Iterable[Wanted] | None = None,
    series: Sequence[str] = (),
    samples: int = SAMPLES_OF_CURVES,
    chunk: int | None = None,
    where: str = "sweep: vary",
) -> Plan:
    """Make a plan from the arguments of `stickslip.sweep`, after checking them. Raises InputError."""
    chosen = scenario_to_vary(scenario, duration)
    known = quantities_for(chosen)
    members_of = read_design(chosen, vary, design, members=members, seed=seed, where=where)
    curves = read_series(chosen, members_of, series, samples)
    work = Work(chosen.to_toml(), members_of.parameters, quantities_named(quantities, known), curves)
    largest = LARGEST_CHUNK if work.why_one_by_one else LARGEST_BATCH
    smallest = SMALLEST_CHUNK if chosen.is_of_core else 1
    size = min(max(members_of.size // CHUNKS, smallest), largest) if chunk is None else check_whole("sweep: chunk", chunk)
    return Plan(chosen, members_of, work, tile_of(members_of.shape, size))


def scenario_to_vary(given: Problem | Scenario | str | Path, duration: float | str | WithUnit | None = None) -> Scenario:
    """Return the scenario that a user means: a problem with a duration (s), a scenario, a scenario file, or a bundled name.

    Raises InputError, also for a problem that no scenario file can describe: members are read from such files.
    """
    if not isinstance(given, Problem):
        if duration is not None:
            raise InputError("sweep: duration belongs to a Problem: a scenario has its own, which run.duration varies")
        return read_source("sweep", given, any_kind=True)
    if duration is None:
        raise InputError("sweep: a Problem needs a duration (s)")
    return read_scenario(read_source("sweep", given, duration).to_toml(), "problem")


def read_series(scenario: Scenario, design: Design, curves: Sequence[str], samples: int) -> KeptCurves | None:
    """Return the series of these curves, or None if there are no curves.

    `samples` is the number of times, evenly spaced from 0 s to the longest duration of any member. Raises InputError for an
    unknown or repeated curve, and for a number of samples out of range.
    """
    if not curves:
        return None
    if not scenario.is_of_core:
        raise InputError(f"sweep: series are curves of a single contact, which {scenario.name} is not: leave them out")
    allowed = [*CURVES, *STATE_NAMES[: len(scenario.problem.friction.states)]]
    for curve in curves:
        if curve not in allowed:
            raise InputError(f"sweep: series {ascii(curve)[:60]} is unknown; {nearest(curve, allowed)}")
    if len(set(curves)) < len(curves):
        raise InputError("sweep: a series is given twice")
    check_whole("sweep: samples", samples, 2, MOST_SAMPLES)
    durations = dict(zip(design.names, design.columns, strict=True)).get("run.duration")
    last = scenario.duration if durations is None else float(durations.max())
    return KeptCurves(tuple(curves), np.linspace(0.0, last, samples))


def tile_of(shape: tuple[int, ...], size: int) -> tuple[int, ...]:
    """Return the shape of a chunk of at most `size` members.

    The last dimensions are not divided as long as they fit. The next one is divided into nearly equal parts, and a chunk has the
    length 1 along all dimensions before it.
    """
    tile: list[int] = []
    for length in reversed(shape):
        parts = -(-length // max(size, 1))
        tile.append(-(-length // parts))
        size = size // length
    return tuple(reversed(tile))
