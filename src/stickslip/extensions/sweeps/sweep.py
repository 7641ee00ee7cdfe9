"""Sweeps: `stickslip.sweep`, which runs a sweep or continues one, and the progress and interruption of sweeps."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

from stickslip.extensions.sweeps.design.quantities import Wanted
from stickslip.extensions.sweeps.execution.chunk import FIRST_FAILURE, NOT_RUN, ChunkResult, Runner, run_chunk
from stickslip.extensions.sweeps.execution.plan import SAMPLES_OF_CURVES, Plan, make_plan
from stickslip.extensions.sweeps.results.store import ResultStore
from stickslip.foundation.arguments import check_whole, for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import about_time, number
from stickslip.problem import Problem
from stickslip.problem.scenarios import Scenario
from stickslip.run import reporting

if TYPE_CHECKING:
    import xarray as xr


SLOWEST_MEMBERS = 100
"""Number of members whose processor times are kept."""


class SweepProgress(NamedTuple):
    """The progress of a sweep; as a text it is one line for people.

    `done` and `failed` count members, including those of earlier calls that filled the same store; `members` is their total number.
    `rate` is the number of members per second since this call began, and `left` the expected wall-clock time (s) to the end. Both
    are NaN until a chunk is finished. `seconds` is the processor time of this call (s), and `alone` the processor time of the
    SLOWEST_MEMBERS members that ran by themselves, by their number in the design, longest first.
    """

    done: int
    failed: int
    members: int
    rate: float
    left: float
    seconds: float = 0.0
    alone: Mapping[int, float] = MappingProxyType({})

    def __str__(self) -> str:
        parts = [f"{self.done} of {self.members} members"]
        if self.rate > 0.0:
            parts.append(f"{number(self.rate, 3)} a second")
        if self.left >= 1.0:
            parts.append(f"{about_time(self.left)} left")
        return ", ".join([*parts, *([f"{self.failed} failed"] if self.failed else [])])


ProgressCallback = Callable[[SweepProgress], object]


@for_users
def sweep(
    scenario: Problem | Scenario | str | Path,
    vary: Any = None,
    *,
    duration: float | str | WithUnit | None = None,
    design: Any = "grid",
    members: int | None = None,
    seed: int = 0,
    quantities: Iterable[Wanted] | None = None,
    series: Sequence[str] = (),
    samples: int = SAMPLES_OF_CURVES,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    chunk: int | None = None,
    progress: ProgressCallback | bool | None = None,
) -> xr.Dataset:
    """Run a scenario with varied parameters and collect summary quantities of every run in a dataset with units.

    Parameters
    ----------
    scenario : Problem, Scenario, str or pathlib.Path
        A problem, a scenario, the path of a scenario file, or a bundled name.
    vary : mapping, pandas.DataFrame or pathlib.Path
        A mapping from parameters, named by their place in a scenario file ("friction.alpha", or "alpha" where that is clear), to
        an array, a list or a pint quantity array of their values. Numbers are in SI. A list may also hold texts with units
        ("10 km"), or words ("run.selection": ["minimal", "maximal"]). A DataFrame, or the `Path` of a CSV file, has one member in
        each row.
    duration : float or str, optional
        Latest end of the runs (s, or a text with a unit). A problem needs it; a scenario has its own.
    design : {"grid", "random", "lhs"}, array, table or path
        "grid" runs every combination, with one dimension for each parameter. "random" and "lhs" (Latin hypercube) draw members:
        a tuple (LOW, HIGH) in place of values stands for all numbers between the two, (LOW, HIGH, "log") for the same spread
        evenly in the logarithm, and from an array or a list one of the values is drawn. Members that another library has chosen
        take the place of these words: an array with a member in each row, whose columns `vary` names in a list, or, without
        `vary`, a table whose columns have the names of parameters: a DataFrame, a mapping of columns, a list of records, or a
        CSV file. Cells are numbers in SI or texts with units, or words.
    members : int, optional
        Number of members of the designs "random" and "lhs".
    seed : int
        Seed of the random designs.
    quantities : iterable
        Names of built-in quantities (`stickslip.extensions.sweeps.design.quantities.QUANTITIES`, for chains those of
        `stickslip.extensions.chains.swept`), or (name, unit, function of a `Solution` or a run). By default `DEFAULT` of the
        built-in ones, and all those of chains.
    series : sequence of str
        Curves of a solution to keep over time, as variables `series_...`.
    samples : int
        Number of times for samples of curves.
    out : str or pathlib.Path, optional
        Folder (.zarr) for the results, chunk by chunk. A call with the folder of an earlier, stopped call of the same
        sweep runs the members that are missing.
    threads : int, optional
        Number of threads (default: all cores). Results depend neither on it nor on the order of members.
    workers : int, optional
        Run the chunks on a local dask.distributed cluster of this number of processes instead of on threads.
    scheduler : str, optional
        Run the chunks on the dask.distributed cluster whose scheduler has this address (or scheduler file).
    chunk : int, optional
        Number of members in a chunk: at most this many, because a chunk is a block of the design.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a `SweepProgress` after each
        chunk.

    Returns
    -------
    xarray.Dataset
        The quantities and curves of every member. `status` says how each member ended. A member that failed has NaN for results
        and a `reason`. After Ctrl-C, members that have not been run have the status `not_run`.

    Raises
    ------
    InputError
        For anything that cannot be used: a parameter, a value, a quantity, or an `out` that belongs to another sweep.

    See Also
    --------
    stickslip.simulate : one run.
    stickslip.run.find : the value of one parameter where the answer changes.

    Examples
    --------
    >>> import stickslip as ss
    >>> found = ss.sweep("fig6-slab", {"alpha": [0.1, 0.5, 1.0]})
    >>> print(found.slip.round(4).to_series().to_string())
    friction.alpha
    0.1     0.0000
    0.5    17.7259
    1.0    23.4402

    Members chosen elsewhere, one in each row:

    >>> found = ss.sweep("fig6-slab", ["alpha", "thickness"], design=[[0.5, 10e3], [1.0, 20e3]])
    >>> found.slip.values.round(3)
    array([17.726, 46.88 ])
    """
    plan = make_plan(
        scenario,
        vary,
        duration=duration,
        design=design,
        members=members,
        seed=seed,
        quantities=quantities,
        series=series,
        samples=samples,
        chunk=chunk,
    )
    with runner_of(threads, workers, scheduler) as run, reporting(progress, "sweep") as tell:
        return carry_out(plan, out, run, tell)


@contextmanager
def runner_of(threads: int | None, workers: int | None, scheduler: str | None) -> Iterator[Runner]:
    """Provide a function that runs chunks, on threads of this process, or on a cluster if `workers` or a `scheduler` is given.

    Raises InputError.
    """
    if workers is None and scheduler is None:
        yield on_threads(threads)
        return
    from stickslip.extensions.sweeps.execution.cluster import cluster, on_cluster

    if threads is not None or (workers is not None and scheduler is not None):
        raise InputError(
            "sweep: give one of threads, workers (processes of a cluster of its own) and scheduler (of another cluster)"
        )
    with cluster(scheduler, workers) as client:
        yield on_cluster(client)


def carry_out(plan: Plan, out: str | Path | None, run: Runner, progress: ProgressCallback | None = None) -> xr.Dataset:
    """Run the chunks of a plan that are missing in its store, and return the dataset. Raises InputError for an unusable store."""
    store = ResultStore.in_memory(plan) if out is None else ResultStore.at(plan, check_out(Path(out)))
    tally = Tally(store, progress)
    # Ctrl-C leaves a valid store: members that have not been run have the status NOT_RUN.
    with store, ctrl_c_breaks_in(), suppress(KeyboardInterrupt):
        missing = ((chunk, store.plan.values(chunk)) for chunk in store.missing())
        unfinished: dict[int, ChunkResult] = {}
        for chunk, result in run(replace(plan.work, defers=True), missing):
            store.write(chunk, result)
            tally.add(chunk, result)
            if result.later:
                unfinished[chunk] = result
        _finish(store, unfinished, run, tally)
    return store.dataset()


def _finish(store: ResultStore, unfinished: dict[int, ChunkResult], run: Runner, tally: Tally) -> None:
    """Run the members that were left for later: each may take as long as thousands of others, which are all done by now."""
    most = os.cpu_count() or 1
    parts = [(chunk, one.later[i : i + most]) for chunk, one in unfinished.items() for i in range(0, len(one.later), most)]
    values = ({name: column[some] for name, column in store.plan.values(chunk).items()} for chunk, some in parts)
    for part, found in run(store.plan.work, enumerate(values)):
        chunk, some = parts[part]
        unfinished[chunk].fill(some, found)
        store.write(chunk, unfinished[chunk])
        tally.add(chunk, found, some)


@contextmanager
def ctrl_c_breaks_in() -> Iterator[None]:
    """Let Ctrl-C end the whole sweep and not only the run of one member.

    A run (`run.run_loop.Interrupts`) replaces Python's own handler to note Ctrl-C for itself, and might be about to end anyway.
    It leaves the handler that is set here in place. Other handlers than Python's own are not replaced, nor are any outside the
    main thread, where none can be set.
    """
    ours = threading.current_thread() is threading.main_thread() and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if ours:
        signal.signal(signal.SIGINT, lambda number, frame: signal.default_int_handler(number, frame))
    try:
        yield
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def on_threads(threads: int | None) -> Runner:
    """Return a function that runs chunks one after the other in this process, each on the given number of threads.

    Raises InputError.
    """
    if threads is not None:
        check_whole("sweep: threads", threads)
    return lambda work, chunks: ((chunk, run_chunk(work, values, threads)) for chunk, values in chunks)


def check_out(path: Path, what: str = "sweep: out") -> Path:
    """Return the path of a store after checking that it could be created there. Raises InputError."""
    if path.suffix != ".zarr":
        raise InputError(f"{what} {path}: the name must end in .zarr")
    if not path.parent.is_dir():
        raise InputError(f"{what} {path}: there is no folder {path.parent}")
    if os.path.lexists(path) and not path.is_dir():
        raise InputError(f"{what} {path}: is a file, where a sweep needs a folder: choose another name")
    folder = path if path.is_dir() else path.parent
    if not os.access(folder, os.W_OK | os.X_OK):
        raise InputError(f"{what} {path}: the folder {folder} is not writable")
    return path


class Tally:
    """A counter of the members done, which reports progress after each chunk."""

    def __init__(self, store: ResultStore, tell: ProgressCallback | None) -> None:
        before = Counter(store.status.ravel().tolist())
        self.plan, self.members = store.plan, store.plan.design.size
        self.seconds, self.alone = 0.0, dict[int, float]()
        self.done = self.members - before[NOT_RUN]
        self.failed = sum(count for code, count in before.items() if code >= FIRST_FAILURE)
        self.tell, self.started, self.before = tell, time.monotonic(), self.done
        if self.done:
            self.report()

    def add(self, chunk: int, result: ChunkResult, some: list[int] | None = None) -> None:
        """Count the members of a chunk, or some of them, that are done, and report."""
        members = self.plan.members(chunk)[slice(None) if some is None else some]
        self.done += int((result.status != NOT_RUN).sum())
        self.failed += int((result.status >= FIRST_FAILURE).sum())
        self.seconds += result.seconds
        slow = self.alone | {int(members[i]): took for i, took in result.alone.items()}
        self.alone = dict(sorted(slow.items(), key=lambda one: -one[1])[:SLOWEST_MEMBERS])
        self.report()

    def report(self) -> None:
        """Report the progress to the user's callback, if there is one."""
        if self.tell is None:
            return
        took = time.monotonic() - self.started
        new = self.done - self.before
        rate = new / took if new else float("nan")
        left = (self.members - self.done) / rate
        self.tell(SweepProgress(self.done, self.failed, self.members, rate, left, self.seconds, self.alone))
