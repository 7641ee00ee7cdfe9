"""Compare series of another program with a series that has converged and says itself how far it may be off."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

import stickslip
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.conventions import Written
from stickslip.extensions.schemes.measures import said_of
from stickslip.extensions.schemes.shocks import check_length, check_sizes
from stickslip.foundation.arrays import Floats
from stickslip.run import Study

if TYPE_CHECKING:
    import xarray as xr

COLUMNS_WITHIN_BAND = {
    "series": ("", "name of the program or file"),
    "quantity": ("", "slip, slip rate or traction"),
    "distance": ("", "mean distance from the converged series"),
    "beyond": ("", "mean distance from the error band of the converged series"),
    "share": ("", "the same, as a share of the largest slip, the mean slip rate, or the range of traction"),
}
"""Columns of the table, each with its unit and meaning; distances are in the SI unit of the quantity."""
UNITS_COMPARED = {"slip": "m", "slip rate": "m/s", "traction": "Pa"}
"""What a series has, each with its unit."""


@dataclass(frozen=True, eq=False, repr=False)
class SeriesWithinBand(Study):
    """Series of another program beside one that has converged, and the largest share that they may leave its error band by."""

    right: xr.Dataset
    series: tuple[Series, ...]
    tolerance: float

    def __post_init__(self) -> None:
        largest = {name: float(np.abs(values).max()) for name, values in self._right.items()}
        for one in self.series:
            check_length(one, float(self.right.time[-1]), "the converged series")
            check_sizes(one, largest, UNITS_COMPARED, "converged")

    @cached_property
    def table(self) -> pd.DataFrame:
        """The table with a row for each series and quantity; the columns are COLUMNS_WITHIN_BAND."""
        rows = [row for one in self.series for row in self._rows(one)]
        return pd.DataFrame(rows, columns=list(COLUMNS_WITHIN_BAND))

    def _rows(self, one: Series) -> Iterator[dict[str, Any]]:
        for name, (own, _) in self._pairs(one).items():
            yield {"series": one.name, "quantity": name, **self._off(name, own)}

    @cached_property
    def _right(self) -> dict[str, Floats]:
        return {name: self.right[name.replace(" ", "_")].to_numpy() for name in UNITS_COMPARED}

    def _pairs(self, one: Series) -> dict[str, tuple[Floats, Floats]]:
        """Return each quantity of a series at the times of the converged one, and that itself."""
        own = (np.interp(self.right.time.to_numpy(), one.time, values) for values in (one.slip, one.rate, one.traction))
        return {name: (values, self._right[name]) for name, values in zip(UNITS_COMPARED, own, strict=True)}

    def _off(self, name: str, own: Floats) -> dict[str, float]:
        """Return the numbers of a row for values of a quantity."""
        right, time = self._right[name], self.right.time.to_numpy()
        scales = {"slip": np.abs(right).max(), "slip rate": _mean(np.abs(right), time), "traction": np.ptp(right)}
        gap, scale = np.abs(own - right), float(scales[name])
        beyond = _mean(np.maximum(gap - self.right[f"{name.replace(' ', '_')}_band"].to_numpy(), 0.0), time)
        return {"distance": _mean(gap, time), "beyond": beyond, "share": beyond / scale if scale else np.inf}

    def hints_of(self, one: Series) -> tuple[str, ...]:
        """Return the conventions that explain what is off in a series, one sentence each."""
        written = Written.of(self._pairs(one), lambda name, own: self._off(name, own)["share"], self.tolerance)
        return tuple(written.sentences(one.name, "converged", UNITS_COMPARED.__getitem__))

    @property
    def passed(self) -> bool:
        """True if every series is within the tolerance beyond the error band."""
        return bool((self.table.share <= self.tolerance).all())

    def _about(self) -> Iterator[str]:
        yield f"stickslip {stickslip.__version__}: series beside one that has converged"
        yield from said_of(COLUMNS_WITHIN_BAND)

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.schemes.figure import draw_within_band

        return draw_within_band

    @property
    def sentences(self) -> tuple[str, ...]:
        """Whether each series passes, and how far it is off."""
        return tuple(self._sentences())

    def _sentences(self) -> Iterator[str]:
        of_name = {one.name: one for one in self.series}
        for name, rows in self.table.groupby("series", sort=False):
            told = bool((rows.share <= self.tolerance).all())
            yield f"{'passed' if told else 'not passed'}, with a tolerance of {self.tolerance:g} beyond the error band: {name}"
            yield "; ".join(f"{row.quantity} is off by {row.share:.2g}" for row in rows.itertuples())
            yield from () if told else self.hints_of(of_name[str(name)])


def _mean(values: Floats, time: Floats) -> float:
    """Return the mean over time."""
    return float(np.trapezoid(values, time) / (time[-1] - time[0]))
