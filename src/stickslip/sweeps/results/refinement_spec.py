"""What determines the members of a refined map, stored with them to reconstruct cells, and where the answer of a sweep changes."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Self

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.sweeps.design.adaptive_grid import Integers, Lattice, Refined, refine_cells
from stickslip.sweeps.design.axis import Axis
from stickslip.sweeps.execution.chunk import NOT_RUN

LARGEST_COUNT = 12
"""Largest number of distinct values of a quantity that is reported case by case; one with more is a number, not a case."""


@dataclass(frozen=True)
class Change:
    """The changes of a quantity along one key: the number of pairs of neighbours that differ, and the values that enclose them.

    All `pairs` pairs lie between the values `low` and `high` of the key (SI, or words).
    """

    key: str
    pairs: int
    low: float | str
    high: float | str


def cases(dataset: xr.Dataset, name: str) -> dict[float, int]:
    """Return the number of members with each value, if the values are a few whole numbers; otherwise an empty dictionary."""
    values = dataset[name].to_numpy()
    found, count = np.unique(values[np.isfinite(values)], return_counts=True)
    if found.size > LARGEST_COUNT or not np.array_equal(found, np.round(found)):
        return {}
    return dict(zip(found.tolist(), count.tolist(), strict=True))


def changes(dataset: xr.Dataset, name: str) -> list[Change]:
    """Return the changes of a quantity along each key of a grid. A missing value (NaN) counts as no change."""
    values, found = dataset[name], []
    for axis, key in enumerate(values.dims):
        if key not in dataset.coords:
            continue
        along = np.moveaxis(values.to_numpy(), axis, 0)
        differ = (along[1:] != along[:-1]) & np.isfinite(along[1:]) & np.isfinite(along[:-1])
        at = np.flatnonzero(differ.any(axis=tuple(range(1, differ.ndim))))
        if at.size:
            places = dataset[key].to_numpy()
            found.append(
                Change(str(key), int(differ.sum()), places[at[0] : at[0] + 1].tolist()[0], places[at[-1] + 1 :].tolist()[0])
            )
    return found


ATTRIBUTE = "refinement"
"""Name of the attribute of the dataset that holds the specification (JSON)."""


@dataclass(frozen=True)
class RefinementSpec:
    """The specification of a search: the quantity whose changes are sought, the coarse grid, and the limits of the refinement.

    `columns` holds the coarse values of each parameter (SI, ascending), and `logarithmic` says which of them are spaced evenly in
    the logarithm. `depth` is the number of halvings, `most` the largest number of members, and `kept` the names of the quantities
    in the dataset. Raises InputError for a factor that is not above 1, for numbers that are not whole, and in the cases of
    `Lattice`.
    """

    quantity: str
    factor: float | None
    depth: int
    most: int
    columns: dict[str, list[float]]
    logarithmic: list[bool]
    kept: list[str]

    def __post_init__(self) -> None:
        if self.factor is not None and not self.factor > 1.0:
            raise InputError(f"refine: factor must be above 1, got {self.factor!r}")
        check_whole("refine: depth", self.depth, 0)
        check_whole("refine: most", self.most)
        _ = self.lattice

    @classmethod
    def of(cls, quantity: str, axes: Sequence[Axis], kept: list[str], *, depth: int, factor: float | None, most: int) -> Self:
        """Make the specification of a search over these axes.

        Raises InputError unless each axis has two or more numbers in ascending order.
        """
        for axis in axes:
            if not axis.parameter.unit or len(axis.values) < 2 or not (axis.values[1:] > axis.values[:-1]).all():
                raise InputError(f"refine: {axis.parameter.name} needs two or more numbers in ascending order")
        columns = {axis.parameter.name: axis.values.tolist() for axis in axes}
        return cls(quantity, factor, depth, most, columns, [axis.log for axis in axes], kept)

    @classmethod
    def read(cls, dataset: xr.Dataset) -> Self:
        """Read the specification of a dataset. Raises InputError if it has none."""
        if ATTRIBUTE not in dataset.attrs:
            raise InputError("this sweep was not made by stickslip.refine")
        try:
            return cls(**json.loads(dataset.attrs[ATTRIBUTE]))
        except (TypeError, ValueError, AttributeError, RecursionError):
            raise InputError(f"the search of this map is {shown(dataset.attrs[ATTRIBUTE])}, which no search is") from None

    def __str__(self) -> str:
        return json.dumps(asdict(self))

    @cached_property
    def lattice(self) -> Lattice:
        """The finest grid, which contains every point of the search."""
        return Lattice(tuple(len(column) for column in self.columns.values()), self.depth)

    def values(self, points: Integers) -> tuple[Floats, ...]:
        """Return the values of each parameter (SI) at points (members, axes) of the finest grid.

        Each coarse step is divided into equal parts, or into equal ratios on a logarithmic axis.
        """
        found = []
        for values, log, place in zip(self.columns.values(), self.logarithmic, points.T / self.lattice.size(0), strict=True):
            column = np.array(values)
            step = np.minimum(place.astype(np.intp), len(column) - 2)
            low, high, part = column[step], column[step + 1], place - step
            between = low * (high / low) ** part if log else low + (high - low) * part
            found.append(np.where(part == 1.0, high, between))
        return tuple(found)


@dataclass(frozen=True, eq=False)
class RefinedMap:
    """The cells of a refined map: their lower and upper ends by parameter (SI), and the answer around each.

    The answer is NaN where it `changes`, and where there is none; with a factor, it is the mean of the smallest and the largest.
    """

    low: dict[str, Floats]
    high: dict[str, Floats]
    answer: Floats
    changes: NDArray[np.bool_]

    def at(self, name: str, value: float) -> RefinedMap:
        """Return the cells that contain a value (SI) of a parameter; where two cells touch at this value, the upper one."""
        low, high = self.low[name], self.high[name]
        rows = (low <= value) & ((value < high) | (high == high.max()) & (value == high))
        lower, upper = ({name: one[rows] for name, one in side.items()} for side in (self.low, self.high))
        return RefinedMap(lower, upper, self.answer[rows], self.changes[rows])


def cells_of(dataset: xr.Dataset) -> RefinedMap:
    """Return the cells of a refined map that were not halved, from the dataset that `stickslip.refine` returned or stored.

    If the search was stopped, only its complete rounds are used. Raises InputError for any other dataset, and for a search that was
    stopped before its coarse grid was complete.
    """
    spec = RefinementSpec.read(dataset)
    missing = np.flatnonzero(dataset["status"].values == NOT_RUN)
    answers = np.asarray(dataset[spec.quantity].values, float)[: missing[0] if missing.size else None]
    found = _repeated(spec, answers)
    cells = found.cells
    size = (2 ** (spec.depth - cells.level))[:, np.newaxis]
    low, high = (dict(zip(spec.columns, spec.values(corner), strict=True)) for corner in (cells.corner, cells.corner + size))
    return RefinedMap(low, high, np.where(found.changes, np.nan, 0.5 * (cells.least + cells.most)), found.changes)


def _repeated(spec: RefinementSpec, answers: Floats) -> Refined:
    """Repeat a search with stored answers, as far as there are any. It asks for the same points in the same order."""
    place = 0

    def evaluate(points: Integers) -> Floats:
        nonlocal place
        place += len(points)
        return answers[place - len(points) : place]

    return refine_cells(spec.lattice, evaluate, spec.factor, len(answers))
