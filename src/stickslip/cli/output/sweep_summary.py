"""Show the results of a sweep: how its members ended, their quantities, and where the answer changes."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from stickslip.cli.output.files import announce
from stickslip.cli.output.show import console, table, titled
from stickslip.foundation.formatting import about_time, clean, number, with_unit

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.sweeps.estimate import Estimate
    from stickslip.sweeps.execution.plan import Plan
    from stickslip.sweeps.results.changes import Change

_NUMBER = re.compile(r"\d[\d.e+-]*")
FIRST = 5
"""Number of reasons for failures that are shown."""


def show_estimate(plan: Plan, found: Estimate) -> None:
    """Print the estimated time and disk space of a sweep."""
    screen = console()
    _say_what(plan)
    screen.print(f"time: about {about_time(found.seconds)} ({number(found.members / found.seconds, 3)} members a second)")
    screen.print(f"disk: at most {_size(found.bytes)} in {found.chunks} chunk{'' if found.chunks == 1 else 's'}")
    failed = f", {found.failed} failed" if found.failed else ""
    screen.print(f"from a sample of {found.sampled}, which took {about_time(found.took)}{failed}")


def show_sweep(plan: Plan, dataset: xr.Dataset, *written: Path | None) -> int:
    """Print the summary on standard output. Returns the exit code, and raises KeyboardInterrupt if some members were not run."""
    from stickslip.sweeps.execution.outcome import FIRST_FAILURE, NOT_RUN

    dataset = dataset.load()
    status = dataset.status.to_numpy().ravel()
    _say_what(plan)
    _show_ends(status, dataset.reason.to_numpy().ravel())
    _show_quantities(plan, dataset)
    _show_changes(plan, dataset)
    announce(*written)
    if (status == NOT_RUN).any():
        raise KeyboardInterrupt
    return int((status >= FIRST_FAILURE).all())


def _say_what(plan: Plan) -> None:
    screen = titled(plan.scenario)
    screen.print(f"{plan.design} over {', '.join(plan.design.names)}", soft_wrap=True)


def _show_ends(status: np.ndarray[tuple[int], np.dtype[np.int8]], reasons: np.ndarray[tuple[int], np.dtype[np.object_]]) -> None:
    from stickslip.sweeps.execution.outcome import FIRST_FAILURE, MEANINGS

    screen = console()
    for code, count in sorted(Counter(status.tolist()).items()):
        screen.print(f"{count} {MEANINGS[code].replace('_', ' ')}")
        if code >= FIRST_FAILURE:
            _show_reasons(reasons[status == code].tolist())
    screen.print()


def _show_reasons(reasons: list[str]) -> None:
    """Print the most frequent reasons, and group those that differ in their numbers only."""
    alike: dict[str, list[str]] = {}
    for reason in reasons:
        alike.setdefault(_NUMBER.sub("#", reason), []).append(reason)
    told = sorted(alike.values(), key=len, reverse=True)
    screen = console()
    for group in told[:FIRST]:
        screen.print(f"  {len(group)}: {clean(group[0])}" + (" (and the like)" if len(set(group)) > 1 else ""), soft_wrap=True)
    if len(told) > FIRST:
        screen.print(f"  and {len(told) - FIRST} other reasons")


def _show_quantities(plan: Plan, dataset: xr.Dataset) -> None:
    shown = table("quantity", "unit", "members", "smallest", "median", "largest", numbers=True)
    for one in plan.work.quantities:
        values = dataset[one.name].to_numpy()
        values = values[np.isfinite(values)]
        numbers = (values.min(), np.median(values), values.max()) if values.size else (np.nan,) * 3
        unit = str(dataset[one.name].attrs["units"])
        shown.add_row(one.name, "" if unit == "1" else unit, str(values.size), *(number(float(x), 6) for x in numbers))
    console().print(shown)
    console().print()


def _show_changes(plan: Plan, dataset: xr.Dataset) -> None:
    from stickslip.sweeps.results.changes import cases, changes

    screen = console()
    for one in plan.work.quantities:
        found = cases(dataset, one.name)
        if len(found) < 2:
            continue
        names = {0.0: "no", 1.0: "yes"} if one.is_flag else {}
        counts = ", ".join(f"{names.get(value, f'{value:g}')} {times} times" for value, times in found.items())
        along = "; ".join(_told(change, dataset) for change in changes(dataset, one.name)) if plan.design.is_grid else ""
        screen.print(f"{one.name}: {counts}" + (f"; changes {along}" if along else ""), soft_wrap=True)


def _told(change: Change, dataset: xr.Dataset) -> str:
    unit = str(dataset[change.key].attrs.get("units", ""))
    ends = (end if isinstance(end, str) else with_unit(end, unit) for end in (change.low, change.high))
    return f"along {change.key} between {' and '.join(ends)}"


def _size(count: int) -> str:
    factor, unit = next(((f, u) for f, u in ((1e9, "GB"), (1e6, "MB"), (1e3, "kB")) if count >= f), (1.0, "bytes"))
    return f"{number(count / factor, 3)} {unit}"
