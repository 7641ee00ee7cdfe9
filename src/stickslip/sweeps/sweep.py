"""Run a sweep, or go on with one."""

from __future__ import annotations

import signal
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from stickslip.foundation.errors import InputError
from stickslip.scenarios.scenario import Scenario
from stickslip.sweeps.design.axis import Values
from stickslip.sweeps.design.quantities import DEFAULT, Wanted
from stickslip.sweeps.execution.chunk import ChunkResult, Work, run_chunk
from stickslip.sweeps.execution.outcome import FIRST_FAILURE, NOT_RUN
from stickslip.sweeps.execution.plan import SAMPLES, Plan, make_plan
from stickslip.sweeps.results.store import ResultStore

if TYPE_CHECKING:
    import xarray as xr


class Report(NamedTuple):
    """How far a sweep is: members done and failed (those of earlier runs of it counted), all of them, members a second since it
    was taken up, and the wall clock (s) that is left; NaN where that is not known yet."""

    done: int
    failed: int
    members: int
    rate: float
    left: float


Progress = Callable[[Report], object]
Runner = Callable[[Work, Iterable[tuple[int, dict[str, Values]]]], Iterator[tuple[int, ChunkResult]]]
"""Runs chunks, each given by its number and its values, and yields their results in any order."""


def sweep(
    scenario: Scenario | str,
    vary: Any,
    *,
    design: str = "grid",
    members: int | None = None,
    seed: int = 0,
    quantities: Iterable[Wanted] = DEFAULT,
    series: Sequence[str] = (),
    samples: int = SAMPLES,
    out: str | Path | None = None,
    threads: int | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    chunk: int | None = None,
    progress: Progress | None = None,
) -> xr.Dataset:
    """Run a scenario over what varies, and collect summary quantities of every run in a Dataset with units.

    scenario: a `Scenario`, the path of a file, or a bundled name. vary: a mapping from keys of the scenario to
    "LOW..HIGH:POINTS" (":log" behind it for equal ratios), to "VALUE,VALUE,..." or to a list of values, numbers in SI or texts
    with units; or a DataFrame, or the `Path` of a CSV file, with a member a row. design "grid" runs every combination, with a
    dimension a key; "random" and "lhs" (Latin hypercube) draw so many `members` between LOW and HIGH from a seed.

    quantities: names (`stickslip.sweeps.design.quantities.QUANTITIES`), or (name, unit, function of a `Solution`). series: curves
    of a solution at so many `samples` of time, kept as `series_...`. `status` says how each member ended; a member that failed has
    NaN for results and a `reason`.

    With out (a folder, .zarr) results are written there in chunks (of `chunk` members) as they come; called again it runs what is
    missing. Ctrl-C ends the sweep with what is there. Results depend neither on `threads` (default: all cores) nor on the order.
    Instead of threads, a dask.distributed cluster may run the chunks: one of so many local `workers` (processes), or the one whose
    `scheduler` answers at an address.

    Raises InputError for anything that cannot be used: a key, a value, a quantity, or an `out` of another sweep.
    """
    plan = make_plan(
        scenario,
        vary,
        design=design,
        members=members,
        seed=seed,
        quantities=quantities,
        series=series,
        samples=samples,
        chunk=chunk,
    )
    with runner_of(threads, workers, scheduler) as (run, _):
        return carry_out(plan, out, run, progress)


@contextmanager
def runner_of(threads: int | None, workers: int | None, scheduler: str | None) -> Iterator[tuple[Runner, int]]:
    """What runs the chunks, and how many at a time: threads of this process, or a cluster where `workers` or a `scheduler` are
    given. Raises InputError."""
    if workers is None and scheduler is None:
        yield on_threads(threads), 1
        return
    from stickslip.sweeps.execution.cluster import cluster, on_cluster

    if threads is not None or (workers is not None and scheduler is not None):
        raise InputError(
            "sweep: give one of threads, workers (processes of a cluster of its own) and scheduler (of another cluster)"
        )
    with cluster(scheduler, workers) as client:
        yield on_cluster(client), max(sum(client.nthreads().values()), 1)


def carry_out(plan: Plan, out: str | Path | None, run: Runner, progress: Progress | None = None) -> xr.Dataset:
    """Run what is missing of a plan. Raises InputError where the store cannot be used."""
    store = ResultStore.in_memory(plan) if out is None else ResultStore.at(plan, check_out(Path(out)))
    tally = Tally(store, progress)
    with store, ctrl_c_breaks_in(), suppress(KeyboardInterrupt):  # what is there by then is valid, and says itself what is not
        for chunk, result in run(plan.work, ((chunk, store.plan.values(chunk)) for chunk in store.missing())):
            store.write(chunk, result)
            tally.add(result)
    return store.dataset()


@contextmanager
def ctrl_c_breaks_in() -> Iterator[None]:
    """Ctrl-C ends the sweep, not just the run of one member, which would take it for its own and might end just then anyway.

    Handlers that are not Python's own stay as they are; so they do outside the main thread, where none can be set.
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
    """Runs chunks one after the other in this process, each on so many threads. Raises InputError."""
    if threads is not None and not (isinstance(threads, int) and threads > 0):
        raise InputError(f"sweep: threads must be a whole number above 0, got {threads!r}")
    return lambda work, chunks: ((chunk, run_chunk(work, values, threads)) for chunk, values in chunks)


def check_out(path: Path, what: str = "sweep: out") -> Path:
    """Refuse a store that could not be written. Raises InputError."""
    if path.suffix != ".zarr":
        raise InputError(f"{what} {path}: the name must end in .zarr")
    if not path.parent.is_dir():
        raise InputError(f"{what} {path}: there is no folder {path.parent}")
    return path


class Tally:
    """Counts what comes in, and tells."""

    def __init__(self, store: ResultStore, tell: Progress | None) -> None:
        before = Counter(store.status.ravel().tolist())
        self.members = store.plan.design.size
        self.done = self.members - before[NOT_RUN]
        self.failed = sum(count for code, count in before.items() if code >= FIRST_FAILURE)
        self.tell, self.started, self.before = tell, time.monotonic(), self.done
        if self.done:
            self.report()

    def add(self, result: ChunkResult) -> None:
        """Another chunk is done."""
        self.done += len(result.status)
        self.failed += int((result.status >= FIRST_FAILURE).sum())
        self.report()

    def report(self) -> None:
        """Say how far it is."""
        if self.tell is None:
            return
        took = time.monotonic() - self.started
        new = self.done - self.before
        rate = new / took if new else float("nan")
        self.tell(Report(self.done, self.failed, self.members, rate, (self.members - self.done) / rate))
