"""The places at which the answer of a sweep changes: neighbouring members between which a count or a flag differs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

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
