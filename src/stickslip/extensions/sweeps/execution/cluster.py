"""Run the chunks of a sweep on the workers of a dask.distributed cluster, on this machine or elsewhere.

Results come back as they are ready. Dask repeats chunks, replaces lost workers and balances the load. The task of a chunk carries
all that it needs, a few kilobytes: nothing is placed on the workers beforehand, so nothing is lost with a worker.

The processes of dask run any code that is sent to them, and all users of a machine can reach its loopback address. The processes of
a local cluster therefore share a key that is made for it and kept in memory; a connection without the key is refused.
"""

from __future__ import annotations

import gc
import json
import logging
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError
from contextlib import ExitStack, contextmanager
from functools import partial
from itertools import islice
from multiprocessing import resource_tracker
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from stickslip.engine import engine_key
from stickslip.extensions.sweeps.execution.chunk import MEMBER_CODE, Runner, run_chunk
from stickslip.foundation.atomic_write import read_bounded
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    from distributed import Client, Future

Chunk = TypeVar("Chunk")
Result = TypeVar("Result")

LOOPBACK = "127.0.0.1"
"""A local cluster has this address; no other machine can reach it."""
TIME_TO_ANSWER = 10.0
"""A scheduler must answer within this time (s)."""
LARGEST_FILE = 1_000_000
"""Refuse a scheduler file that is larger than this (bytes), before it fills the memory."""
AHEAD = 2
"""Each thread of the cluster has so many chunks in flight: the one that it works on, and the next."""
CHUNKS_IN_FLIGHT = 8
"""Keep at least this many chunks in flight: a cluster that starts workers on demand does so only when chunks wait."""
RETRIES = 2
"""Dask repeats a failed chunk this many times."""
GONE = "sweep: the dask scheduler is lost; finished chunks are kept: the same command continues"
GONE_AGAIN = ("lost", "pending")
"""A chunk has one of these statuses if its worker died with the finished result. Dask computes it again."""
ENVIRON = "distributed.nanny.pre-spawn-environ"
"""Dask's settings for environment variables of worker processes begin with this."""
SETTINGS = {
    "distributed.worker.profile.enabled": False,  # profiling costs a few per cent of all time, and is not used here
    # With dask's own settings, workers return every freed array to the operating system and fetch it again,
    # which costs 15 per cent of the time of a chunk of the compiled batch.
    f"{ENVIRON}.MALLOC_TRIM_THRESHOLD_": 2**28,
    f"{ENVIRON}.MALLOC_MMAP_THRESHOLD_": 2**25,
    # No status pages, which would show what runs to anyone who asks.
    "distributed.scheduler.http.routes": [],
    "distributed.worker.http.routes": [],
}
"""A local cluster runs dask with these settings; thresholds are in bytes."""
LEAVE_CTRL_C = "import signal; signal.signal(signal.SIGINT, signal.SIG_IGN)"
"""Local workers run this code first. Ctrl-C reaches them too, but only the sweep may end them."""


class ChunksLostError(RuntimeError):
    """No worker could finish some chunks. The message says in one line why, and what to do."""


@contextmanager
def cluster(scheduler: str | None = None, workers: int | None = None) -> Iterator[Client]:
    """Provide a client of the cluster at an address (or of a scheduler file), or of a local one with `workers` processes.

    Raises InputError if dask.distributed is not installed, if the number of workers is missing or below 1, or if the scheduler
    does not answer within 10 s.
    """
    try:
        from dask import config
        from distributed import Client, LocalCluster, Security

        security = None if workers is None else Security.temporary()  # by the package cryptography
    except ImportError:
        raise InputError("sweep: a cluster needs dask.distributed and cryptography: pip install 'stickslip[cluster]'") from None
    if scheduler is not None:
        with _quietly(), _connected(scheduler) as client:
            yield client
        return
    if workers is None or workers < 1:
        raise InputError(f"sweep: workers must be 1 or more, got {workers}")
    many = {"n_workers": workers, "threads_per_worker": 1, "preload": [LEAVE_CTRL_C]}
    private = {"host": LOOPBACK, "dashboard_address": f"{LOOPBACK}:0", "worker_dashboard_address": f"{LOOPBACK}:0"}
    with ExitStack() as running:
        running.enter_context(_quietly())
        with config.set(SETTINGS), _ctrl_c_waits():
            local = running.enter_context(LocalCluster(**many, **private, security=security, silence_logs=logging.ERROR))
            client = running.enter_context(Client(local, set_as_default=False))
        yield client


@contextmanager
def _ctrl_c_waits() -> Iterator[None]:
    """Hold back Ctrl-C until the end of the `with` block, in this thread, in those that it starts, and in all their processes.

    Dask ends a cluster in good order once it has started, but not while it starts: each of its processes would then say at length
    where it was interrupted.
    """
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # its start would let the signal through again
    noted: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, _: noted.append(number))  # another thread of ours may be given it
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)  # one that has waited is noted now
        signal.signal(signal.SIGINT, before)
    if noted:
        signal.raise_signal(signal.SIGINT)


@contextmanager
def _quietly() -> Iterator[None]:
    """Silence the log of dask's client, which reports a lost connection at length; the sweep reports it in one line."""
    log = logging.getLogger("distributed.client")
    before = log.level
    log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        log.setLevel(before)


def _connected(scheduler: str) -> Client:
    """Return a client of the scheduler at an address, or of the one that a scheduler file names. Raises InputError."""
    from distributed import Client

    try:
        path = Path(scheduler)
        address = str(json.loads(read_bounded(path, LARGEST_FILE))["address"]) if path.is_file() else scheduler
        return Client(address, timeout=TIME_TO_ANSWER, set_as_default=False)
    except (OSError, ValueError, KeyError, TypeError) as error:  # TypeError means tls:// without a key in dask's configuration
        missed = str(error)
    # A client that failed stops its loop when it is thrown away. In the thread of the next client it would wait for itself.
    gc.collect()
    raise InputError(
        f"sweep: no dask scheduler answers at {scheduler} ({missed}); it needs HOST:PORT as `dask scheduler` prints it"
    )


def on_cluster(client: Client) -> Runner:
    """Return a function that runs chunks on a cluster, each on one thread. A worker with n threads runs n chunks at a time."""
    return lambda work, chunks: stream(client, partial(run_chunk, work, threads=1), chunks, work.code)


def stream(
    client: Client, run: Callable[[Chunk], Result], chunks: Iterable[tuple[int, Chunk]], code: tuple[str, ...] = MEMBER_CODE
) -> Iterator[tuple[int, Result]]:
    """Yield the number and the result of each chunk as soon as it is ready, with few in flight at a time.

    `run` and the chunks must be picklable, and `code` is what decides the results, beside the engine. A chunk that fails does not
    hold up the others: ChunksLostError comes when they are done. Raises InputError at once if a worker has another version of the
    code, and ChunksLostError if the scheduler is lost.
    """
    from distributed import as_completed

    waiting, version = iter(chunks), (code, engine_key(*code))
    numbers: dict[Future, int] = {}
    lost: list[str] = []

    def send() -> list[Future]:
        room = max(CHUNKS_IN_FLIGHT, AHEAD * sum(client.nthreads().values())) - len(numbers)
        more = list(islice(waiting, max(room, 0)))
        sent = [client.submit(_run_checked, run, chunk, version, pure=False, retries=RETRIES) for _, chunk in more]
        numbers.update(zip(sent, (number for number, _ in more), strict=True))
        return sent

    try:
        ready = as_completed(send(), loop=client.loop)
        for future in ready:
            if future.status in GONE_AGAIN:
                ready.add(future)
                continue
            number = numbers.pop(future)
            if future.status == "finished":
                yield number, future.result()
            else:
                lost.append(f"chunk {number}: {_why(future)}")
            future.release()
            ready.update(send())
    except (OSError, CancelledError):
        # Only the connection can raise these: an error in a chunk is part of its result, and the store is not written here.
        raise ChunksLostError(GONE) from None
    if lost:
        more = f", and {len(lost) - 1} more" if len(lost) > 1 else ""
        raise ChunksLostError(
            f"sweep: no worker finished {lost[0]}{more}; all other chunks are stored: the same command tries the missing ones again"
        )


def _run_checked(run: Callable[[Chunk], Result], chunk: Chunk, version: tuple[tuple[str, ...], str]) -> Result:
    """Run a chunk on the worker, after checking that it has the expected version of the engine. Raises InputError."""
    code, expected = version
    if engine_key(*code) != expected:
        raise InputError("sweep: a worker of the cluster has another version of stickslip: install the same everywhere")
    return run(chunk)


def _why(future: Future) -> str:
    """Return why a chunk was not finished. Raises what stops the whole sweep: InputError, or ChunksLostError without scheduler."""
    from distributed import KilledWorker

    if future.status != "error":
        raise ChunksLostError(GONE)
    error = future.exception()
    if isinstance(error, InputError):
        raise error
    if isinstance(error, KilledWorker):
        return f"it ended {error.allowed_failures + 1} worker(s), one after the other (out of memory?)"
    return f"{type(error).__name__}: {error}"
