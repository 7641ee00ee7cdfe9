"""Statistics of a catalogue of slip events."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_type

if TYPE_CHECKING:
    import pandas as pd

QUANTITIES = ("recurrence", "duration", "slip", "peak_rate", "traction_drop", "static_drop", "released", "trapped")
"""Columns of a catalogue whose distribution is described, if the table has them."""

SAME = 1e-9
"""Relative spread below which values count as equal: the correlation of successive values then says nothing."""


def catalogue_statistics(table: pd.DataFrame) -> pd.DataFrame:
    """Return statistics of the events of a catalogue, one row per quantity.

    Parameters
    ----------
    table : pandas.DataFrame
        A catalogue: `Solution.events`, or the result of `Solution.catalogue`.

    Returns
    -------
    pandas.DataFrame
        Each row is in the unit of its quantity. Columns: `count`; `mean`; `deviation`, the sample's standard deviation;
        `variation`, which is deviation / mean (of the recurrence times: 0 periodic, 1 as random as a Poisson process, above 1
        clustered); `smallest`, `median`, `largest`; and `next`, the correlation of a value with the value of the next event. Values
        are NaN if there are too few events.

    Notes
    -----
    An event that is cut off by the end of the run counts in the recurrence only.
    """
    import pandas as pd

    check_type("catalogue_statistics: table", table, pd.DataFrame, "a table of slip events, such as solution.events")
    finished = table[table.end.notna()]
    rows = {name: _describe((table if name == "recurrence" else finished)[name]) for name in QUANTITIES if name in table}
    frame = pd.DataFrame.from_dict(rows, orient="index", columns=list(_describe(table.slip[:0])))
    return frame.astype({"count": int})


def _describe(column: pd.Series[float]) -> dict[str, float]:
    values = column[np.isfinite(column)]
    mean, deviation = values.mean(), values.std()
    return {
        "count": len(values),
        "mean": mean,
        "deviation": deviation,
        "variation": deviation / mean if mean != 0.0 else np.nan,
        "smallest": values.min(),
        "median": values.median(),
        "largest": values.max(),
        "next": _next(np.asarray(values, float)),
    }


def _next(values: NDArray[np.float64]) -> float:
    """Return the correlation of each value with the next one."""
    now, later = values[:-1], values[1:]
    if len(now) < 3 or min(np.ptp(now), np.ptp(later)) <= SAME * np.abs(values).max():
        return np.nan
    return float(np.corrcoef(now, later)[0, 1])
