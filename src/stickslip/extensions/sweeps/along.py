"""Run a scenario for many values of one parameter, for a picture that somebody waits for: what the explorer shows as a strip."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from stickslip.extensions.sweeps.design.quantities import QUANTITIES, quantities_named
from stickslip.extensions.sweeps.execution.chunk import Work, run_chunk
from stickslip.foundation.arrays import Floats
from stickslip.problem.scenarios import ParameterPath, Scenario


class Along(NamedTuple):
    """Results by quantity, in the order of the values and NaN for runs that failed; their units; and why runs failed, by number."""

    results: dict[str, Floats]
    units: dict[str, str]
    refused: dict[int, str]


def run_along(
    scenario: Scenario, parameter: ParameterPath, values: Floats, quantities: Sequence[str], goes_on: Callable[[int], bool]
) -> Along:
    """Return quantities of a sweep for each value (SI) of a parameter: together in the batch, or one after the other.

    Where runs are made one after the other, `goes_on` is called before each with the number of those that are done; False ends it.
    """
    work, count = Work(scenario.to_toml(), (parameter,), quantities_named(quantities)), len(values)
    units = {name: scenario.problem.unit_of(QUANTITIES[name].unit) for name in quantities}
    results, refused = {name: np.full(count, np.nan) for name in quantities}, dict[int, str]()
    portion = 1 if work.why_one_by_one else count
    for start in range(0, count, portion):
        if work.why_one_by_one and not goes_on(start):
            return Along(results, units, refused | dict.fromkeys(range(start, count), "it was stopped"))
        some = slice(start, start + portion)
        done = run_chunk(work, {parameter.name: values[some]}, threads=1)
        for name, column in done.results.items():
            results[name][some] = column
        refused.update({start + i: reason for i, reason in done.reasons.items()})
    return Along(results, units, refused)
