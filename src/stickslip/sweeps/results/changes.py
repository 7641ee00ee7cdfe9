"""Where the answer of a sweep changes: between which members a count or a yes and no differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

LARGEST_COUNT = 12
"""Of different values: a quantity with more of them is no answer with a few cases."""


@dataclass(frozen=True)
class Change:
    """Along a key a quantity differs between so many `pairs` of neighbours, all of them between `low` and `high` (SI, or words)."""

    key: str
    pairs: int
    low: float | str
    high: float | str


def cases(dataset: xr.Dataset, name: str) -> dict[float, int]:
    """How many members have each value, where these are a few whole numbers; else nothing."""
    values = dataset[name].to_numpy()
    found, count = np.unique(values[np.isfinite(values)], return_counts=True)
    if found.size > LARGEST_COUNT or not np.array_equal(found, np.round(found)):
        return {}
    return dict(zip(found.tolist(), count.tolist(), strict=True))


def changes(dataset: xr.Dataset, name: str) -> list[Change]:
    """Along each key of a grid, where neighbours differ; a missing value differs from none."""
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
