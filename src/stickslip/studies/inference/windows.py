"""Fit shorter parts of a record: how much the numbers depend on where it is cut."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product

import numpy as np
import pandas as pd

from stickslip.foundation.show import brief
from stickslip.studies.inference.estimate import Estimate
from stickslip.studies.inference.loading import loading_of
from stickslip.studies.inference.part import Part
from stickslip.studies.inference.search import Tell, solved

KEPT_BEFORE, KEPT_AFTER = (1.0, 0.5), (1.0, 0.75, 0.5, 0.35)
"""Shares that are kept of the time before the first change of the pull rate, and after the last one."""
LEAST = 10
"""Smallest number of samples for each free number."""


def windows_of(found: Estimate, tell: Tell) -> pd.DataFrame:
    """Return the numbers that are found from shorter parts of a record, one row each, the whole record first."""
    labels = [one.label for one in found.model.free]
    rows = [(0.0, found.model.parts[0].duration, found.model.samples, *found.model.values(found.searched))]
    for shares in list(product(KEPT_BEFORE, KEPT_AFTER))[1:]:
        parts = [_cut(part, found, *shares) for part in found.model.parts]
        model = found.model.with_(parts=tuple(part for part in parts if part is not None), unsure={})
        if len(model.parts) < len(parts) or model.samples < LEAST * len(labels):
            continue
        begin = float(model.parts[0].record.time[0] - found.model.parts[0].record.time[0])
        tell(f"the record from {begin:.4g} s on, {model.parts[0].duration:.4g} s long")
        searched = solved(model.with_jumps(found.searched).fine(found.searched), found.searched, found.loss, thorough=True)
        rows.append((begin, begin + model.parts[0].duration, model.samples, *model.values(searched)))
    table = pd.DataFrame(rows, columns=["begin", "end", "samples", *labels])
    return table.drop_duplicates(["begin", "end"], ignore_index=True)


def _cut(part: Part, found: Estimate, before: float, after: float) -> Part | None:
    """Return a part without some of its begin and of its end; None if that is not possible.

    A record without a load point keeps its begin, where the loading of the problem begins.
    """
    clock, changes = part.record.clock, part.changes(found.model.problem)
    first, last = (float(changes[0]), float(changes[-1])) if len(changes) else (clock[-1], 0.0)
    begin = 0.0 if part.loading is None else (1.0 - before) * first
    end = last + after * (clock[-1] - last)
    if not 0.0 <= begin < end or (before < 1.0 and begin == 0.0):
        return None
    record = part.record.part(float(part.record.time[0]) + begin, float(part.record.time[0]) + end)
    if begin == 0.0:
        return replace(part, record=record)
    loading = loading_of(record)
    return replace(part, record=record, loading=None if loading is None else loading.rate)


def told(table: pd.DataFrame, units: Mapping[str, str], intervals: pd.DataFrame) -> Iterator[str]:
    """Yield sentences on the spread of numbers over windows, and on those that it makes more unsure than their intervals."""
    spread = [f"{name} {brief(table[name].min(), unit, 4)} to {brief(table[name].max(), unit, 4)}" for name, unit in units.items()]
    lasts = table.end - table.begin
    yield f"over {len(table)} windows of {lasts.min():.3g} to {lasts.max():.3g} s: {', '.join(spread)}"
    wide = [n for n in units if np.ptp(table[n]) > intervals.high[n] - intervals.low[n]]
    if wide:
        yield f"{' and '.join(wide)} depend more on the window than the intervals say: give that spread beside the interval"
