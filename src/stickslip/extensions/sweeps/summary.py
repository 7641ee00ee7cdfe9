"""Show the results of a sweep: how its members ended, their quantities, and where the answer changes."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.cli.output.show import console, print_numbers, say, titled
from stickslip.foundation.names import for_readers, readable_unit
from stickslip.foundation.show import about_time, clean, number, with_unit

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.extensions.sweeps.execution.plan import Plan
    from stickslip.extensions.sweeps.sweep import SweepProgress

_NUMBER = re.compile(r"\d[\d.e+-]*")
REASONS_SHOWN = 5
"""Number of reasons for failures, and of slow members, that are shown."""
LARGEST_COUNT = 12
"""Largest number of distinct values of a quantity that is reported case by case; one with more is a number, not a case."""
SLOW, NOTICED = 20.0, 0.5
"""A member is slow if it takes more than this multiple of the mean processor time of a member, and more than this time (s)."""


def show_plan(plan: Plan) -> None:
    """Print how many members a sweep has, and whether they run in the compiled batch or one by one."""
    why = plan.work.why_one_by_one
    how = f"one by one ({why})" if why else "in the compiled batch"
    say(titled(plan.scenario), f"{plan.design} over {', '.join(plan.design.names)}, {how}")


def show_sweep(title: str, dataset: xr.Dataset) -> int:
    """Print the summary of a sweep on standard output. Returns the exit code of the sweep: 1 if every member failed."""
    from stickslip.extensions.sweeps.design.design import GRID, in_words
    from stickslip.extensions.sweeps.execution.chunk import FIRST_FAILURE
    from stickslip.extensions.sweeps.results.layout import read_design

    dataset, screen = dataset.load(), console()
    kind, keys, _ = read_design(dataset.attrs)
    say(screen, clean(title), style="bold")
    say(screen, f"{in_words(kind, dataset.status.shape)} over {', '.join(keys)}", *_on_starts(dataset, keys))
    status = dataset.status.to_numpy().ravel()
    _show_ends(status, dataset.reason.to_numpy().ravel())
    _show_quantities(dataset)
    _show_changes(dataset, is_grid=kind == GRID)
    return int((status >= FIRST_FAILURE).all())


def _on_starts(dataset: xr.Dataset, keys: Sequence[str]) -> list[str]:
    """Return a line if members without a mass at the contact start in another way than those with one."""
    from stickslip.problem.scenarios import read_scenario
    from stickslip.run.check import other_start

    problem = read_scenario(dataset.attrs["scenario"], "sweep").problem
    mass = f"body.{problem.body.mass_field}"
    if mass not in keys or not 0.0 == float(dataset[mass].min()) < float(dataset[mass].max()):
        return []
    return [f"note: {other}"] if (other := other_start(problem)) else []


def quantities_of(dataset: xr.Dataset) -> list[str]:
    """Return the names of the quantities in the results of a sweep."""
    from stickslip.extensions.sweeps.execution.chunk import PREFIX
    from stickslip.extensions.sweeps.results.layout import REASON, STATUS

    return [str(name) for name in dataset.data_vars if name not in (STATUS, REASON) and not str(name).startswith(PREFIX)]


def _show_ends(status: np.ndarray[tuple[int], np.dtype[np.int8]], reasons: np.ndarray[tuple[int], np.dtype[np.object_]]) -> None:
    from stickslip.extensions.sweeps.execution.chunk import FIRST_FAILURE, MEANINGS

    screen = console()
    for code, count in sorted(Counter(status.tolist()).items()):
        say(screen, f"{count} {MEANINGS.get(code, f'ended with the unknown code {code}').replace('_', ' ')}")
        if code >= FIRST_FAILURE:
            _show_reasons(reasons[status == code].tolist())
    screen.print()


def show_slowest(plan: Plan, spent: SweepProgress) -> None:
    """Print which members took most of the time, if a few did."""
    usual = spent.seconds / max(spent.members, 1)
    slow = {member: took for member, took in spent.alone.items() if took > max(SLOW * usual, NOTICED)}
    if not slow:
        return
    count, share = len(slow), sum(slow.values()) / spent.seconds
    named = []
    for member, took in list(slow.items())[:REASONS_SHOWN]:
        values = plan.design.values(np.array([member]))
        units = {parameter.name: parameter.unit for parameter in plan.design.parameters}
        at = ", ".join(f"{name} = {_valued(column[0], units[name])}" for name, column in values.items())
        named.append(f"{about_time(took)} at {at}")
    more = f"; and {count - REASONS_SHOWN} others" if count > REASONS_SHOWN else ""
    members = "1 member" if count == 1 else f"{count} members"
    total = f"{100.0 * share:.0f} % of the processor time ({about_time(spent.seconds)})"
    say(console(), f"{members} took {total}: {'; '.join(named)}{more}")


def _valued(value: Any, unit: str) -> str:
    return clean(value) if isinstance(value, str) else with_unit(float(value), unit)


def _show_reasons(reasons: list[str]) -> None:
    """Print the most frequent reasons, and group those that differ in their numbers only."""
    alike: dict[str, list[str]] = {}
    for reason in reasons:
        alike.setdefault(_NUMBER.sub("#", reason), []).append(reason)
    told = sorted(alike.values(), key=len, reverse=True)
    screen = console()
    for group in told[:REASONS_SHOWN]:
        say(screen, f"  {len(group)}: {clean(group[0])}" + (" (and the like)" if len(set(group)) > 1 else ""))
    if len(told) > REASONS_SHOWN:
        say(screen, f"  and {len(told) - REASONS_SHOWN} other reasons")


@dataclass(frozen=True)
class ChangeAlongKey:
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


def changes(dataset: xr.Dataset, name: str) -> list[ChangeAlongKey]:
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
            low, high = places[at[0] : at[0] + 1].tolist()[0], places[at[-1] + 1 :].tolist()[0]
            found.append(ChangeAlongKey(str(key), int(differ.sum()), low, high))
    return found


def _show_quantities(dataset: xr.Dataset) -> None:
    rows = []
    for name in quantities_of(dataset):
        values = dataset[name].to_numpy()
        values = values[np.isfinite(values)]
        numbers = (values.min(), np.median(values), values.max()) if values.size else (np.nan,) * 3
        unit, factor = readable_unit(for_readers(str(dataset[name].attrs["units"])), values, plain=True)
        rows.append((name, "" if unit == "1" else unit, str(values.size), *(number(float(x) / factor, 6) for x in numbers)))
    screen = console()
    print_numbers(screen, ("quantity", "unit", "members", "smallest", "median", "largest"), rows, text=2)
    screen.print()


def _show_changes(dataset: xr.Dataset, *, is_grid: bool) -> None:
    screen = console()
    for name in quantities_of(dataset):
        found = cases(dataset, name)
        if len(found) < 2:
            continue
        names = {0.0: "no", 1.0: "yes"} if "flag_values" in dataset[name].attrs else {}
        first, *others = [f"{names.get(value, f'{value:g}')} in {members}" for value, members in found.items()]
        counts = ", ".join([f"{first} member{'' if first.endswith(' in 1') else 's'}", *others])
        along = "; ".join(_told(change, dataset) for change in changes(dataset, name)) if is_grid else ""
        say(screen, f"{name}: {counts}" + (f"; changes {along}" if along else ""))


def _told(change: ChangeAlongKey, dataset: xr.Dataset) -> str:
    unit = str(dataset[change.key].attrs.get("units", ""))
    ends = (end if isinstance(end, str) else with_unit(end, unit) for end in (change.low, change.high))
    return f"along {change.key} between {' and '.join(ends)}"
