"""A chunk of a sweep takes the values of some members and returns their results. Everything here can be pickled."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import thread_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.sweeps.batch import run_members, why_not
from stickslip.extensions.sweeps.design.axis import Values
from stickslip.extensions.sweeps.design.quantities import QUANTITIES, Summary
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import BAD_PARAMETERS as REFUSED
from stickslip.problem import ENOUGH_EVENTS, FULL_HISTORY, STATUSES, Status, Stop
from stickslip.problem.scenarios import ParameterPath, Scenario, Source, document_with, read_scenario, scenario_of
from stickslip.run import SolverKind, special_solver_of
from stickslip.run.simulate import simulate
from stickslip.solution import Solution

MEMBER_CODE = ("extensions/sweeps/batch", "extensions/sweeps/execution/chunk.py")
"""The code in these folders and files decides the results of a member, together with the code of its run."""
END = "end_time"
"""The message on a failed member needs this quantity: the time (s) at the end of its run."""
MAX_PIECES = 200_000
"""A member that runs by itself fails if its history needs more polynomial pieces than this (90 MB)."""
NOT_RUN = -1
"""The member has not been run. A new store holds this code for all members."""
BAD_PARAMETERS = 10
"""The scenario of the member is refused, or cannot start."""
ERROR = 14
"""A quantity of the member could not be calculated, or another fault occurred."""
FIRST_FAILURE = 10
"""Codes from this one on are failures. A member that failed has a reason in place of results."""

_OUTCOMES = (
    (NOT_RUN, "not_run", None),
    (0, "finished", Stop.FINISHED),
    (1, "enough_events", ENOUGH_EVENTS),
    (2, "locked_for_ever", Stop.LOCKED),
    (BAD_PARAMETERS, "bad_parameters", REFUSED),
    (11, "event_storm", Stop.STORM),
    (12, "not_finite", Stop.FAILED),
    (13, "too_many_pieces", FULL_HISTORY),
    (15, "negative_friction", Stop.NEGATIVE_FRICTION),
    (16, "off_the_law", Stop.OFF_THE_LAW),
    (ERROR, "error", None),
)
MEANINGS = {code: name for code, name, _ in _OUTCOMES}
"""Names of the codes."""
CODES = {stop: code for code, _, stop in _OUTCOMES if stop is not None}
"""The code of a member, by the code that its run ended with (`problem.run_codes`)."""
CODE_OF = {STATUSES[code].name: ours for code, ours in CODES.items()}
"""The status code of a member by the name of the status of its run."""
PREFIX = "series_"
"""Results name a curve with this prefix: it tells slip over time from the quantity `slip`, the slip of the whole run."""
SAMPLE_TIME = "time"
"""Samples lie along this dimension."""


@dataclass(frozen=True, eq=False)
class KeptCurves:
    """Which curves of a solution to keep, and the sampling times (s). A sample at a shock is the right limit."""

    curves: tuple[str, ...]
    times: Floats

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the curves among the results."""
        return tuple(PREFIX + curve for curve in self.curves)

    def of(self, solution: Solution) -> dict[str, Floats]:
        """Return the samples of a solution by name, with NaN after the end of its run."""
        there = self.times <= solution.history.duration
        found = {}
        for curve, name in zip(self.curves, self.names, strict=True):
            values = np.full(len(self.times), np.nan)
            values[there] = getattr(solution, curve)(self.times[there])
            found[name] = values
        return found


@dataclass(frozen=True)
class Work:
    """What to do for every member.

    `text` is the scenario (TOML, in SI), `parameters` are those that vary, and `quantities` and `series` are the results kept.
    With `defers`, the compiled batch leaves members that it must run by themselves for later: see `ChunkResult.later`.
    """

    text: str
    parameters: tuple[ParameterPath, ...]
    quantities: tuple[Summary, ...]
    series: KeptCurves | None = None
    defers: bool = False

    @cached_property
    def scenario(self) -> Scenario:
        """The scenario that members vary."""
        return read_scenario(self.text, "member")

    @property
    def solver(self) -> SolverKind | None:
        """The solver of an extension that runs members; None for those of the core."""
        return special_solver_of(self.scenario)

    @property
    def code(self) -> tuple[str, ...]:
        """Folders and files whose code decides the results, together with the code of the core."""
        return (*MEMBER_CODE, *self.solver.code) if self.solver else MEMBER_CODE

    @cached_property
    def why_one_by_one(self) -> str:
        """Why the compiled batch cannot do this work, in one line; "" if it can."""
        if self.solver:
            return f"{self.solver.what} has a solver of its own"
        if self.series:
            return "curves over time need whole solutions"
        own = next((one.name for one in self.quantities if QUANTITIES.get(one.name) is not one), None)
        if own is not None:
            return f"{own} is a function of a whole solution"
        return why_not(self.scenario, [parameter.name for parameter in self.parameters], [one.name for one in self.quantities])

    @property
    def names(self) -> tuple[str, ...]:
        """The names of all results."""
        return tuple(one.name for one in self.quantities) + (self.series.names if self.series else ())

    def member(self, values: Mapping[str, float | str]) -> Scenario:
        """Return the scenario of the member with these values (SI).

        Raises InputError with the same one-line message as a scenario file that cannot be used.
        """
        document = document_with(self.scenario, [(parameter, values[parameter.name]) for parameter in self.parameters], "member")
        return scenario_of(document, Source("member"))


@dataclass(frozen=True)
class ChunkResult:
    """The results of some members, in their order.

    `results` holds a float64 array for each name, of shape (members,), or (members, samples) for a series. `status` holds codes
    (`MEANINGS`). `reasons` says why members failed, by their index; such members have NaN for results.
    """

    results: dict[str, Floats]
    status: NDArray[np.int8]
    reasons: dict[int, str] = field(default_factory=dict)
    seconds: float = 0.0
    """Processor time of all members, s."""
    alone: dict[int, float] = field(default_factory=dict)
    """Processor time (s) of each member that ran by itself."""
    later: list[int] = field(default_factory=list)
    """Members left for later; their status is NOT_RUN."""

    @classmethod
    def empty(cls, work: Work, count: int) -> ChunkResult:
        """Return results for `count` members that have not run yet: NaN, with the status "finished"."""
        results = {one.name: np.full(count, np.nan) for one in work.quantities}
        if work.series:
            results |= {name: np.full((count, len(work.series.times)), np.nan) for name in work.series.names}
        return cls(results, np.zeros(count, np.int8))

    def fill(self, places: list[int], found: ChunkResult) -> None:
        """Enter the results of members left for later at their places in this chunk."""
        for name, values in found.results.items():
            self.results[name][places] = values
        self.status[places] = found.status
        self.reasons.update({places[i]: reason for i, reason in found.reasons.items()})

    def fail(self, i: int, code: int, reason: str) -> None:
        """Record that a member failed."""
        self.status[i] = code
        self.reasons[i] = " ".join(reason.split())


Runner = Callable[[Work, Iterable[tuple[int, dict[str, Values]]]], Iterator[tuple[int, ChunkResult]]]
"""A function that takes chunks as (number, values), runs them, and yields (number, results) in any order."""


def run_chunk(work: Work, values: Mapping[str, Values], threads: int | None = None) -> ChunkResult:
    """Run the members with these values (SI, one-dimensional arrays by parameter) on a number of threads (default: all cores).

    The results of a member depend on nothing but its own values.
    """
    return one_by_one(work, values) if work.why_one_by_one else compiled_batch(work, values, threads or os.cpu_count() or 1)


def compiled_batch(work: Work, values: Mapping[str, Values], threads: int) -> ChunkResult:
    """Run all members in the compiled batch (`stickslip.extensions.sweeps.batch`)."""
    names = [one.name for one in work.quantities]
    found = run_members(work.scenario, values, list(dict.fromkeys([*names, END])), threads, defer=work.defers)
    status = np.array([CODES.get(code, NOT_RUN) for code in found.status.tolist()], np.int8)
    failed = status >= FIRST_FAILURE
    kept = {name: np.where(failed, np.nan, found.results[name]) for name in names}
    result = ChunkResult(kept, status, seconds=found.seconds, alone=found.alone, later=found.later)
    for i in np.flatnonzero(failed).tolist():
        if i in found.reason:
            result.reasons[i] = _refusal(work, _of_member(values, i)) or found.reason[i]
        else:
            result.reasons[i] = _stopped(STATUSES[int(found.status[i])], float(found.results[END][i]))
    return result


def _refusal(work: Work, values: Mapping[str, float | str]) -> str:
    """Return why a member's values make no valid scenario, in the words of a scenario read by itself; "" if they make one."""
    try:
        work.member(values)
    except InputError as error:
        return str(error)
    return ""


def _of_member(values: Mapping[str, Values], i: int) -> dict[str, float | str]:
    return {name: column[i : i + 1].tolist()[0] for name, column in values.items()}


def one_by_one(work: Work, values: Mapping[str, Values]) -> ChunkResult:
    """Run each member by itself, one after the other. Raises KeyboardInterrupt on Ctrl-C."""
    count = len(next(iter(values.values())))
    result = ChunkResult.empty(work, count)
    for i in range(count):
        start = thread_time()
        try:
            _run_one(work, _of_member(values, i), result, i)
        except Exception as error:  # no error, not even one in a user's function, may stop the other members
            result.fail(i, ERROR, f"{type(error).__name__}: {error}")
        result.alone[i] = thread_time() - start
    return replace(result, seconds=sum(result.alone.values()))


def _run_one(work: Work, values: dict[str, float | str], result: ChunkResult, i: int) -> None:
    """Run one member and enter its results. Raises KeyboardInterrupt on Ctrl-C, and whatever a quantity raises."""
    try:
        solution: Any = simulate(work.member(values), max_pieces=None if work.solver else MAX_PIECES)
    except InputError as error:
        result.fail(i, BAD_PARAMETERS, str(error))
        return
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    code = CODE_OF[solution.status.name]
    if code >= FIRST_FAILURE:
        result.fail(i, code, _stopped(solution.status, solution.duration))
        return
    found: dict[str, Any] = {one.name: one.value(solution) for one in work.quantities}
    for name, value in (found | work.series.of(solution) if work.series else found).items():
        result.results[name][i] = value
    result.status[i] = code


def _stopped(status: Status, end: float) -> str:
    return f"{status.name} at {end:.9g} s: {status.message}"
