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
from stickslip.extensions.schemes.measures import said_of
from stickslip.extensions.schemes.shocks import check_length
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


@dataclass(frozen=True, eq=False, repr=False)
class SeriesWithinBand(Study):
    """Series of another program beside one that has converged, and the largest share that they may leave its error band by."""

    right: xr.Dataset
    series: tuple[Series, ...]
    tolerance: float

    def __post_init__(self) -> None:
        for one in self.series:
            check_length(one, float(self.right.time[-1]), "the converged series")

    @cached_property
    def table(self) -> pd.DataFrame:
        """The table with a row for each series and quantity; the columns are COLUMNS_WITHIN_BAND."""
        rows = [row for one in self.series for row in self._rows(one)]
        return pd.DataFrame(rows, columns=list(COLUMNS_WITHIN_BAND))

    def _rows(self, one: Series) -> Iterator[dict[str, Any]]:
        time = self.right.time.to_numpy()
        slip, rate, traction = (self.right[name].to_numpy() for name in ("slip", "slip_rate", "traction"))
        scales = float(np.abs(slip).max()), _mean(np.abs(rate), time), float(np.ptp(traction))
        pairs = zip(("slip", "slip_rate", "traction"), (one.slip, one.rate, one.traction), scales, strict=True)
        for name, own, scale in pairs:
            gap = np.abs(np.interp(time, one.time, own) - self.right[name].to_numpy())
            beyond = _mean(np.maximum(gap - self.right[f"{name}_band"].to_numpy(), 0.0), time)
            found = {"distance": _mean(gap, time), "beyond": beyond, "share": beyond / scale if scale else np.inf}
            yield {"series": one.name, "quantity": name.replace("_", " "), **found}

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
        for name, rows in self.table.groupby("series", sort=False):
            told = bool((rows.share <= self.tolerance).all())
            yield f"{'passed' if told else 'not passed'}, with a tolerance of {self.tolerance:g} beyond the error band: {name}"
            yield "; ".join(f"{row.quantity} is off by {row.share:.2g}" for row in rows.itertuples())


def _mean(values: Floats, time: Floats) -> float:
    """Return the mean over time."""
    return float(np.trapezoid(values, time) / (time[-1] - time[0]))
