"""Say in one line how far the contacts of several runs have gone: the slips at their ends and their largest displacements."""

from __future__ import annotations

from collections.abc import Mapping

from stickslip.engine import SAME_REACH, largest_of, shown_slip
from stickslip.foundation.names import name_of
from stickslip.solution import Solution


def reach_of_runs(runs: Mapping[str, Solution]) -> str:
    """Return the ranges of slips at the end and of largest displacements, with names of runs, by kind of motion."""
    alike: dict[str, dict[str, Solution]] = {}
    for name, run in runs.items():
        alike.setdefault(run.problem.unit_of("slip"), {})[name] = run
    return "; ".join(_of_one_kind(some, unit) for unit, some in alike.items())


def _of_one_kind(runs: Mapping[str, Solution], unit: str) -> str:
    name = name_of("slip", next(iter(runs.values())).problem.load_unit)
    ends = {run: float(solution.slip()) for run, solution in runs.items()}
    displaced = {run: solution.reach.largest for run, solution in runs.items()}
    return f"{name} at the end {_range(ends, unit)}; {largest_of(unit)} {_range(displaced, unit)}"


def _range(values: Mapping[str, float], unit: str) -> str:
    """Return the smallest and the largest of some slips in words, each with the names that it belongs to."""
    near = SAME_REACH * max(map(abs, values.values()))

    def told(end: float) -> str:
        names = [name for name, value in values.items() if abs(value - end) <= near]
        return f"{shown_slip(end, unit)} ({' and '.join(names)})"

    low, high = min(values.values()), max(values.values())
    if high - low > near:
        return f"from {told(low)} to {told(high)}"
    return f"{shown_slip(high, unit)} in all" if len(values) > 1 else told(high)
