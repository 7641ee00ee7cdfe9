"""The execution of a batch: threads take chunks of members, and set up and run each chunk by itself, which bounds the memory."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from queue import Empty, SimpleQueue
from threading import Lock
from time import thread_time
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from stickslip.batch.batch_support import why_not
from stickslip.batch.kernels.engine import engine_address
from stickslip.batch.kernels.reduction import COLUMNS, OF_EVENTS, Reduced
from stickslip.batch.kernels.runs import Group, Stage, run_group
from stickslip.batch.long_member import run_alone
from stickslip.batch.setups import Alike, alike, set_up
from stickslip.batch.vectorised_problem import Values, are_fine, groups, member
from stickslip.batch.workspace import LARGEST_CAPACITY, Workspace, new_workspace, table_of
from stickslip.engine.codegen.simd import WIDTH
from stickslip.engine.on_demand import lend_part
from stickslip.engine.state.layout import Floats, Integers, Stop
from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario
from stickslip.trajectory.status import BAD_PARAMETERS, INTERRUPTED

CHUNK = 8192
"""Largest number of members that are set up together: enough to make numpy efficient, and few enough for the processor's cache."""
SMALLEST_CHUNK = 1024
"""Smallest number of members in a chunk: enough to make the time that a chunk spends in Python negligible."""
NO_BRANCH = "friction falls at least as fast as Z v rises at high slip rates, or has more branches than a batch holds"
NO_START = "the run cannot start"


class BatchResult(NamedTuple):
    """The results of the members of a batch, in the order of the values given.

    Attributes
    ----------
    results : dict of str to array, shape (members,)
        One number for each member, by the name of the quantity; NaN for a member whose parameters are invalid.
    status : array of int, shape (members,)
        What ended each run: codes of `stickslip.trajectory.status.STATUSES`.
    reason : dict of int to str
        Why the parameters of a member are invalid, in one line, by the index of the member.
    seconds : float
        Processor time of all members, s.
    alone : dict of int to float
        Processor time (s) of each member that ran by itself, because its history is long or because it creeps for long.
    later : list of int
        Members that must run by themselves and have been left for later (see `defer`); their status is INTERRUPTED.
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

    Parameters
    ----------
    scenario : Scenario
        The scenario whose parameters vary.
    values : mapping of str to array, shape (members,)
        Values (SI) by key, such as "friction.alpha", "body.thickness", "loading.pull_rate", "initial.excess" or "run.duration".
    quantities : sequence of str
        Names from `stickslip.batch.QUANTITIES`.
    threads : int
        Number of threads.
    defer : bool
        If true, do not run members that must run by themselves, and list them in `later`: each may take as long as thousands of
        others. If false, they run after all others.

    Returns
    -------
    BatchResult
        Quantities and status of each member. A member whose parameters are invalid gets the status BAD_PARAMETERS and a reason;
        it does not affect the others.

    Raises
    ------
    InputError
        If `why_not` gives a reason against running this scenario in a batch, or if the values are not one-dimensional arrays of
        the same length.

    Notes
    -----
    The results depend neither on the number of threads nor on which members run together.
    """
    arrays = checked(scenario, values, quantities)
    count = len(next(iter(arrays.values())))
    batch = _Batch(scenario, arrays, quantities, count)
    for chunk in chunks(count, threads):
        batch.queue.put(chunk)
    batch.run(batch.work, threads)
    waiting = [long.place for long in batch.long]
    if not defer:
        batch.run(batch.work_alone, threads)
    return BatchResult(batch.results, batch.status, batch.reason, batch.seconds, batch.alone, sorted(waiting) if defer else [])


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


def checked(scenario: Scenario, values: Mapping[str, Floats], quantities: Sequence[str]) -> dict[str, Floats]:
    """Return the values as arrays, after checking that the batch can run with them. Raises InputError."""
    reason = why_not(scenario, tuple(values), quantities)
    if reason:
        raise InputError(f"run_members: {reason}")
    arrays = {key: np.ascontiguousarray(value, float) for key, value in values.items()}
    if not arrays or any(array.shape != next(iter(arrays.values())).shape or array.ndim != 1 for array in arrays.values()):
        raise InputError("run_members: values must be one-dimensional arrays of one length, one number a member")
    return arrays


class _Long(NamedTuple):
    """A member that must run by itself: its index in the batch, and what the setup says about its contact equation."""

    place: int
    irregular: float
    branches: float


class _Batch:
    """A batch in progress: a queue of chunks that are still to be done, and the results of those that are.

    Members that must run by themselves are set aside and run after all others, so that they hold nobody up.
    """

    def __init__(self, scenario: Scenario, values: Values, quantities: Sequence[str], count: int) -> None:
        self.scenario, self.values, self.wants_events = scenario, values, not OF_EVENTS.isdisjoint(quantities)
        self.results = {name: np.full(count, np.nan) for name in quantities}
        self.status = np.full(count, INTERRUPTED)
        self.reason: dict[int, str] = {}
        self.queue: SimpleQueue[slice] = SimpleQueue()
        self.stop = np.zeros(1, np.int64)
        self.engine = engine_address()
        self.alike: dict[int, Alike] = {}
        self.long: deque[_Long] = deque()
        self.seconds = 0.0
        self.alone: dict[int, float] = {}
        self.counting = Lock()

    def run(self, work: Callable[[], object], threads: int) -> None:
        """Do the same work on the given number of threads. An error, or Ctrl-C, ends every thread."""
        if threads == 1:
            work()
            return
        with ThreadPoolExecutor(threads) as pool:
            done = [pool.submit(work) for _ in range(threads)]
            try:
                for one in done:
                    one.result()
            except BaseException:
                self.stop[0] = 1
                raise

    def work(self) -> None:
        """Run chunks on one thread until the queue is empty or the batch is to stop."""
        start, work = thread_time(), new_workspace()
        while self.stop[0] == 0:
            try:
                chunk = self.queue.get_nowait()
            except Empty:
                break
            work = self.chunk(chunk, work)
        with self.counting:
            self.seconds += thread_time() - start

    def work_alone(self) -> None:
        """Run members that were set aside, one after the other, until none is left or the batch is to stop."""
        while self.stop[0] == 0:
            try:
                long = self.long.popleft()
            except IndexError:
                return
            start, out = thread_time(), np.full((1, len(COLUMNS)), np.nan)
            code = run_alone(self.member(long.place), LARGEST_CAPACITY, self.stop, out[0])
            self.keep(np.array([long.place]), np.array([code]), out, (long.irregular, long.branches))
            took = thread_time() - start
            with self.counting:
                self.seconds += took
                self.alone[long.place] = took

    def chunk(self, chunk: slice, work: Workspace) -> Workspace:
        """Run one chunk. Returns the workspace, which may have been replaced by a larger one."""
        values = {key: value[chunk] for key, value in self.values.items()}
        fine = are_fine(self.scenario, values)
        for n in np.flatnonzero(~fine).tolist():
            self.refuse(chunk.start + n)
        valid = np.flatnonzero(fine)
        if not valid.size:
            return work
        for kind, places, numbers in groups(self.scenario, {key: value[valid] for key, value in values.items()}):
            work = self.group(kind, chunk.start + valid[places], numbers, work)
        return work

    def group(self, kind: int, places: Integers, values: Values, work: Workspace) -> Workspace:
        """Run the members of one group, which differ in numbers only. `places` are their indices in the batch.

        Returns the workspace, which may have been replaced by a larger one.
        """
        if kind not in self.alike:
            self.alike[kind] = alike(self.scenario, values)
        setups = set_up(self.scenario, values, self.alike[kind])
        codes, out = np.full(len(places), INTERRUPTED), np.full((len(places), len(COLUMNS)), np.nan)
        members = Group(self.engine, setups, self.wants_events, self.stop, codes, out)
        work = work.ready_for(setups.constants.shape[2])
        while True:
            base, stride = table_of(setups, work)
            lane = run_group(members, base, stride, work)
            if lane == WIDTH or self.stop[0] != 0:
                break
            if work.stage[lane] == Stage.AT_END:
                work = work.with_more_points()
            elif work.code[lane] == Stop.NEED_PART:
                lend_part(work.table[lane])  # and to the other lanes by `table_of`
            elif work.code[lane] != Stop.PAUSED and work.capacity < LARGEST_CAPACITY:
                work = work.larger()
            else:
                n, work.stage[lane] = int(work.member[lane]), Stage.FREE
                self.long.append(_Long(int(places[n]), float(setups.irregular[n]), float(setups.branches[n])))
        self.keep(places, codes, out, (setups.irregular, setups.branches))
        return work

    def keep(self, places: Integers, codes: Integers, out: Floats, contact: tuple[ArrayLike, ArrayLike]) -> None:
        """Keep the codes and the numbers `out` of members with these indices; `contact` holds their `irregular` and `branches`."""
        reduced = Reduced.of(out)
        reduced.irregular, reduced.branches = contact
        out[codes == BAD_PARAMETERS] = np.nan
        self.status[places] = codes
        for name, column in self.results.items():
            column[places] = out[:, COLUMNS.index(name)]
        branches = np.broadcast_to(contact[1], len(places))
        for n in np.flatnonzero(codes == BAD_PARAMETERS).tolist():
            self.reason[int(places[n])] = NO_START if branches[n] > 0 else NO_BRANCH

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
