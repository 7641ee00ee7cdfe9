"""The work of a sweep, in chunks: from the values of some members to their results. Everything here can be pickled."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.batch import run_members, why_not
from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario, read_scenario
from stickslip.solution.solution import Solution
from stickslip.sweeps.design.axis import Values
from stickslip.sweeps.design.members import Members
from stickslip.sweeps.design.parameter_paths import Key
from stickslip.sweeps.design.quantities import QUANTITIES, Summary
from stickslip.sweeps.design.series import Series
from stickslip.sweeps.execution.outcome import BAD_PARAMETERS, CODES, ERROR, FIRST_FAILURE
from stickslip.trajectory.status import STATUSES, Status

Floats = NDArray[np.float64]
END = "end_time"
"""The quantity that the message on a failed member needs: the time (s) at which its run ended."""
MAX_PIECES = 200_000
"""Largest number of polynomial pieces in the history of a member that runs by itself (90 MB); a member that needs more fails."""
CODE_OF = {STATUSES[code].name: ours for code, ours in CODES.items()}
"""The status code of a member by the name of the status of its run."""


@dataclass(frozen=True)
class Work:
    """The work that is done for every member.

    `text` is the scenario (TOML, in SI), `keys` are the parameters that vary, and `quantities` and `series` are the results kept.
    """

    text: str
    keys: tuple[Key, ...]
    quantities: tuple[Summary, ...]
    series: Series | None = None

    @cached_property
    def members(self) -> Members:
        """Return the factory of the members' scenarios."""
        return Members(self.text, self.keys)

    @cached_property
    def scenario(self) -> Scenario:
        """Return the scenario whose parameters are varied."""
        return read_scenario(self.text, "member")

    @cached_property
    def why_one_by_one(self) -> str:
        """Return in one line why the compiled batch cannot do this work; "" if it can."""
        if self.series:
            return "curves over time need whole solutions"
        own = next((one.name for one in self.quantities if QUANTITIES.get(one.name) is not one), None)
        if own is not None:
            return f"{own} is a function of a whole solution"
        return why_not(self.scenario, [key.name for key in self.keys], [one.name for one in self.quantities])

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of all results."""
        return tuple(one.name for one in self.quantities) + (self.series.names if self.series else ())


@dataclass(frozen=True)
class ChunkResult:
    """The results of some members, in their order.

    `results` holds a float64 array for each name, of shape (members,), or (members, samples) for a series. `status` holds codes
    (`outcome.MEANINGS`). `reasons` says why members failed, by their index; such members have NaN for results.
    """

    results: dict[str, Floats]
    status: NDArray[np.int8]
    reasons: dict[int, str] = field(default_factory=dict)


def run_chunk(work: Work, values: Mapping[str, Values], threads: int | None = None) -> ChunkResult:
    """Run the members with these values (SI, one-dimensional arrays by key) on a number of threads (default: all cores).

    The results of a member depend on nothing but its own values.
    """
    return compiled_batch(work, values, threads) or one_by_one(work, values)


def compiled_batch(work: Work, values: Mapping[str, Values], threads: int | None) -> ChunkResult | None:
    """Run all members in the compiled batch (`stickslip.batch`); return None if it cannot do this work."""
    if work.why_one_by_one:
        return None
    names = [one.name for one in work.quantities]
    found = run_members(work.scenario, values, list(dict.fromkeys([*names, END])), threads or os.cpu_count() or 1)
    status = np.array([CODES[code] for code in found.status.tolist()], np.int8)
    failed = status >= FIRST_FAILURE
    result = ChunkResult({name: np.where(failed, np.nan, found.results[name]) for name in names}, status)
    for i in np.flatnonzero(failed).tolist():
        result.reasons[i] = (
            _refused(work, values, i, found.reason[i])
            if i in found.reason
            else _stopped(STATUSES[int(found.status[i])], float(found.results[END][i]))
        )
    return result


def _refused(work: Work, values: Mapping[str, Values], i: int, otherwise: str) -> str:
    """Return why the values of a member make no valid scenario, in the same words as when it is read by itself."""
    try:
        work.members.scenario(_of_member(values, i))
    except InputError as error:
        return str(error)
    return otherwise


def _of_member(values: Mapping[str, Values], i: int) -> dict[str, float | str]:
    return {name: column[i : i + 1].tolist()[0] for name, column in values.items()}


def one_by_one(work: Work, values: Mapping[str, Values]) -> ChunkResult:
    """Run each member by itself, one after the other. Raises KeyboardInterrupt on Ctrl-C."""
    count = len(next(iter(values.values())))
    result = nothing(work, count)
    for i in range(count):
        try:
            _run_one(work, _of_member(values, i), result, i)
        except Exception as error:  # no error, not even one in a user's function, may stop the other members
            _fail(result, i, ERROR, f"{type(error).__name__}: {error}")
    return result


def nothing(work: Work, count: int) -> ChunkResult:
    """Return empty results of `count` members: NaN, with the status "finished"."""
    results = {one.name: np.full(count, np.nan) for one in work.quantities}
    if work.series:
        results |= {name: np.full((count, len(work.series.times)), np.nan) for name in work.series.names}
    return ChunkResult(results, np.zeros(count, np.int8))


def _run_one(work: Work, values: dict[str, float | str], result: ChunkResult, i: int) -> None:
    try:
        solution = _solved(work.members.scenario(values))
    except InputError as error:
        _fail(result, i, BAD_PARAMETERS, str(error))
        return
    code = CODE_OF[solution.status.name]
    if code >= FIRST_FAILURE:
        _fail(result, i, code, _stopped(solution.status, solution.history.duration))
        return
    found: dict[str, Any] = {one.name: one.value(solution) for one in work.quantities}
    for name, value in (found | work.series.of(solution) if work.series else found).items():
        result.results[name][i] = value
    result.status[i] = code


def _stopped(status: Status, end: float) -> str:
    return f"{status.name} at {end:.9g} s: {status.message}"


def _solved(scenario: Scenario) -> Solution:
    solution = scenario.run(max_pieces=MAX_PIECES)
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    return solution


def _fail(result: ChunkResult, i: int, code: int, reason: str) -> None:
    result.status[i] = code
    result.reasons[i] = " ".join(reason.split())
