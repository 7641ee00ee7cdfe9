"""The execution of a batch: threads take chunks of members, and set up and run each chunk by itself, which bounds the memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from threading import local
from time import thread_time
from typing import NamedTuple, TypeVar

import numpy as np

from stickslip.engine import Floats, Integers, lend_part
from stickslip.engine.lanes import (
    LARGEST_CAPACITY,
    OF_EVENTS,
    REDUCED_COLUMNS,
    Alike,
    Group,
    LaneStage,
    Reduced,
    Values,
    alike,
    are_fine,
    engine_address,
    groups,
    member,
    new_workspace,
    run_group,
    set_up,
    table_of,
    why_not,
)
from stickslip.extensions.sweeps.batch.long_member import run_alone
from stickslip.foundation.errors import InputError
from stickslip.foundation.kernels.memory.simd import SIMD_WIDTH
from stickslip.problem import BAD_PARAMETERS, INTERRUPTED, Stop
from stickslip.problem.scenarios import Scenario

Part = TypeVar("Part")

CHUNK = 16_384
"""Largest number of members that are set up together: enough to make numpy efficient, and few enough for the processor's cache."""
SMALLEST_CHUNK = 1024
"""Smallest number of members in a chunk: enough to make the time that a chunk spends in Python negligible."""
NO_BRANCH = "friction falls at least as fast as Z v rises at high slip rates, or has more branches than a batch holds"
NO_START = "the run cannot start"


class BatchResult(NamedTuple):
    """The results of the members of a batch, in the order of the values given.

    `results` has one number for each member, by the name of the quantity; NaN for a member whose parameters are invalid, and
    `reason` says in one line why, by its index. `status` says what ended each run, in codes of
    `stickslip.problem.run_status.STATUSES`. `seconds` is the processor time of all members, and `alone` that of each member that
    ran by itself, because its history is long or because it creeps for long (s). Members that must run by themselves and have been
    left for `later` (see `defer`) have the status INTERRUPTED.
    """

    results: dict[str, Floats]
    status: Integers
    reason: dict[int, str]
    seconds: float
    alone: dict[int, float]
    later: list[int]


def run_members(
    scenario: Scenario, values: Mapping[str, Floats], quantities: Sequence[str], threads: int = 1, *, defer: bool = False
) -> BatchResult:
    """Run a scenario once for each set of parameters, in compiled code, and reduce each run to the given quantities.

    Values (SI) are arrays of shape (members,) by key, such as "friction.alpha", "body.thickness", "loading.pull_rate",
    "initial.excess" or "run.duration"; quantities are names from `stickslip.extensions.sweeps.batch.QUANTITIES`. The results depend
    neither on the number of threads nor on which members run together. A member whose parameters are invalid gets the status
    BAD_PARAMETERS and a reason; it does not affect the others.

    With `defer`, members that must run by themselves are not run but listed in `later`: each may take as long as thousands of
    others. Without, they run after all others. Raises InputError if `why_not` gives a reason against running this scenario in a
    batch, or if the values are not one-dimensional arrays of the same length.
    """
    reason = why_not(scenario, tuple(values), quantities)
    if reason:
        raise InputError(f"run_members: {reason}")
    arrays = {key: np.ascontiguousarray(value, float) for key, value in values.items()}
    shapes = {array.shape for array in arrays.values()}
    if len(shapes) != 1 or len(next(iter(shapes))) != 1:
        raise InputError("run_members: values must be one-dimensional arrays of one length, one number a member")
    (count,) = shapes.pop()
    batch = _Batch(scenario, arrays, quantities, count)
    batch.run(batch.chunk, chunks(count, threads), threads)
    later = sorted(place for place, _ in batch.long)
    if not defer:
        batch.run(batch.run_long, batch.long, threads)
    return BatchResult(batch.results, batch.status, batch.reason, batch.seconds, batch.alone, later if defer else [])


def chunks(count: int, threads: int) -> Iterator[slice]:
    """Yield the chunks of a batch as slices of its members.

    Large chunks come first, because each costs some time in Python, and smaller ones later, so that all threads end together.
    """
    start = 0
    while start < count:
        share = -(-(count - start) // (2 * threads)) if threads > 1 else count
        size = min(max(share, SMALLEST_CHUNK), CHUNK)
        yield slice(start, min(start + size, count))
        start += size


class _Batch:
    """A batch in progress, and the results of its members that are done.

    Members that must run by themselves are set aside and run after all others, so that they hold nobody up.
    """

    def __init__(self, scenario: Scenario, values: Values, quantities: Sequence[str], count: int) -> None:
        self.scenario, self.values, self.wants_events = scenario, values, not OF_EVENTS.isdisjoint(quantities)
        self.results = {name: np.full(count, np.nan) for name in quantities}
        self.status = np.full(count, INTERRUPTED)
        self.reason: dict[int, str] = {}
        self.stop = np.zeros(1, np.int64)
        self.engine = engine_address()
        self.alike: dict[int, Alike] = {}
        self.of_thread = local()  # `work`: the workspace of the thread
        self.long: list[tuple[int, Floats]] = []  # members set aside: their index, and room for their numbers
        self.seconds = 0.0
        self.alone: dict[int, float] = {}

    def run(self, work: Callable[[Part], float], parts: Iterable[Part], threads: int) -> None:
        """Do the same work for each part on threads, and count its processor time. An error, or Ctrl-C, ends every thread."""
        if threads == 1:  # a thread of its own would allocate its workspace afresh for each batch
            self.begin()
            self.seconds += sum(map(work, parts))
            return
        with ThreadPoolExecutor(threads, initializer=self.begin) as pool:
            try:
                self.seconds += sum(pool.map(work, parts))
            except BaseException:
                self.stop[0] = 1
                raise

    def begin(self) -> None:
        """Give the present thread a workspace."""
        self.of_thread.work = new_workspace()

    def run_long(self, long: tuple[int, Floats]) -> float:
        """Run a member that was set aside. Returns its processor time (s)."""
        (place, out), start = long, thread_time()
        code = run_alone(self.member(place), LARGEST_CAPACITY, self.stop, out)
        self.keep(np.array([place]), np.array([code]), out[None])
        self.alone[place] = thread_time() - start
        return self.alone[place]

    def chunk(self, chunk: slice) -> float:
        """Run one chunk. Returns its processor time (s)."""
        start, values = thread_time(), {key: value[chunk] for key, value in self.values.items()}
        fine = are_fine(self.scenario, values)
        for n in np.flatnonzero(~fine).tolist():
            self.refuse(chunk.start + n)
        valid = np.flatnonzero(fine)
        if valid.size:
            for kind, places, numbers in groups(self.scenario, {key: value[valid] for key, value in values.items()}):
                self.group(kind, chunk.start + valid[places], numbers)
        return thread_time() - start

    def group(self, kind: int, places: Integers, values: Values) -> None:
        """Run the members of one group, which differ in numbers only. `places` are their indices in the batch."""
        if kind not in self.alike:
            self.alike[kind] = alike(self.scenario, values)
        setups = set_up(self.scenario, values, self.alike[kind])
        codes, out = np.full(len(places), INTERRUPTED), np.full((len(places), len(REDUCED_COLUMNS)), np.nan)
        reduced = Reduced.of(out)
        reduced.irregular, reduced.branches = setups.irregular, setups.branches
        members = Group(self.engine, setups, self.wants_events, self.stop, codes, out)
        work = self.of_thread.work.ready_for(setups.constants.shape[2])
        while True:
            base, stride = table_of(setups, work)
            lane = run_group(members, base, stride, work)
            if lane == SIMD_WIDTH or self.stop[0] != 0:
                break
            if work.stage[lane] == LaneStage.AT_END:
                work = work.with_turns(2 * len(work.turns))
            elif work.code[lane] == Stop.NEED_PART:
                lend_part(work.table[lane])  # and to the other lanes by `table_of`
            elif work.code[lane] != Stop.PAUSED and work.capacity < LARGEST_CAPACITY:
                work = work.larger()
            else:
                n, work.stage[lane] = int(work.member[lane]), LaneStage.FREE
                self.long.append((int(places[n]), out[n].copy()))
        self.of_thread.work = work
        for n in np.flatnonzero(codes == BAD_PARAMETERS).tolist():
            self.reason[int(places[n])] = NO_START if setups.branches[n] > 0 else NO_BRANCH
        self.keep(places, codes, out)

    def keep(self, places: Integers, codes: Integers, out: Floats) -> None:
        """Keep the codes and the numbers `out` of members with these indices."""
        out[codes == BAD_PARAMETERS] = np.nan
        self.status[places] = codes
        for name, column in self.results.items():
            column[places] = out[:, REDUCED_COLUMNS.index(name)]

    def member(self, n: int) -> Scenario:
        """Return the scenario of one member. Raises InputError if its parameters are invalid."""
        return member(self.scenario, {key: float(value[n]) for key, value in self.values.items()})

    def refuse(self, n: int) -> None:
        """Record why the parameters of a member are invalid."""
        self.status[n] = BAD_PARAMETERS
        try:
            self.member(n)
            self.reason[n] = "its parameters are invalid"
        except InputError as error:
            self.reason[n] = str(error)
