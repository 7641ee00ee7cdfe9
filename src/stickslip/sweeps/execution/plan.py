"""The plan of a sweep before it is run: scenario, design, results to keep, and the division into chunks."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario, load_scenario
from stickslip.sweeps.design.axis import Values
from stickslip.sweeps.design.design import Design, read_design
from stickslip.sweeps.design.quantities import DEFAULT, Wanted, quantities_named
from stickslip.sweeps.design.series import read_series
from stickslip.sweeps.execution.chunk import Work

CHUNKS, SMALLEST_CHUNK, LARGEST_CHUNK, LARGEST_BATCH = 64, 16, 4096, 65_536
"""Number of chunks into which a sweep is divided if no chunk size is given, and limits of their size (members).

The upper limit is LARGEST_CHUNK if members run one by one, and LARGEST_BATCH in the compiled batch. The chunks in progress are
lost when a sweep is killed.
"""
SAMPLES = 200
"""Default number of times at which curves are sampled."""


@dataclass(frozen=True, eq=False)
class Plan:
    """The plan of a sweep. `tile` is the shape of a chunk: its number of members along each dimension of the design."""

    scenario: Scenario
    design: Design
    work: Work
    tile: tuple[int, ...]

    def with_tile(self, tile: tuple[int, ...]) -> Plan:
        """Return the same plan with chunks of another shape."""
        return replace(self, tile=tile)

    @property
    def tiles(self) -> tuple[int, ...]:
        """Return the number of chunks along each dimension."""
        return tuple(-(-whole // part) for whole, part in zip(self.design.shape, self.tile, strict=True))

    @property
    def chunks(self) -> int:
        """Return the number of chunks."""
        return math.prod(self.tiles)

    def region(self, chunk: int) -> tuple[slice, ...]:
        """Return the slices of the members of a chunk along each dimension."""
        places = np.unravel_index(chunk, self.tiles)
        spans = zip(places, self.tile, self.design.shape, strict=True)
        return tuple(slice(int(at) * part, min((int(at) + 1) * part, whole)) for at, part, whole in spans)

    def members(self, chunk: int) -> NDArray[np.intp]:
        """Return the indices of the members of a chunk, in the order of its results."""
        region = self.region(chunk)
        places = np.meshgrid(*(np.arange(one.start, one.stop) for one in region), indexing="ij")
        return np.ravel_multi_index(tuple(place.ravel() for place in places), self.design.shape)

    def values(self, chunk: int) -> dict[str, Values]:
        """Return the values of the members of a chunk (SI, one-dimensional arrays) for each key."""
        return self.design.values(self.members(chunk))


def make_plan(
    scenario: Scenario | str,
    vary: Any,
    *,
    design: str = "grid",
    members: int | None = None,
    seed: int = 0,
    quantities: Iterable[Wanted] = DEFAULT,
    series: Sequence[str] = (),
    samples: int = SAMPLES,
    chunk: int | None = None,
    where: str = "sweep: vary",
) -> Plan:
    """Make a plan from the arguments of `stickslip.sweep`, after checking them. Raises InputError."""
    chosen = scenario if isinstance(scenario, Scenario) else load_scenario(scenario)
    members_of = read_design(chosen, vary, design, members, seed, where)
    kept = quantities_named(quantities)
    work = Work(chosen.to_toml(), members_of.keys, kept, read_series(chosen, members_of, series, samples))
    return Plan(chosen, members_of, work, tile_of(members_of.shape, _chunk_size(members_of.size, chunk, work)))


def _chunk_size(members: int, chunk: int | None, work: Work) -> int:
    if chunk is None:
        return min(max(members // CHUNKS, SMALLEST_CHUNK), LARGEST_CHUNK if work.why_one_by_one else LARGEST_BATCH)
    if not (isinstance(chunk, int) and chunk > 0):
        raise InputError(f"sweep: chunk must be a whole number of members above 0, got {chunk!r}")
    return chunk


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
