"""Chunks on a cluster: nothing is lost with a worker or with the whole sweep, and the store is that of a sweep in one process."""

from __future__ import annotations

import asyncio
import gc
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.error import HTTPError
from urllib.request import urlopen

import pytest

import stickslip as ss
from stickslip.extensions.sweeps.execution.cluster import ChunksLostError, cluster, on_cluster, stream
from stickslip.extensions.sweeps.sweep import SweepProgress, carry_out
from tests.extensions.sweeps.cluster_plan import VARY, plan_of
from tests.extensions.sweeps.stores import files

if TYPE_CHECKING:
    from distributed import Client


@pytest.fixture(scope="module")
def local() -> Iterator[Client]:
    with cluster(workers=1) as client:
        yield client


@pytest.fixture(scope="module")
def two_workers() -> Iterator[Client]:
    with cluster(workers=2) as client:
        yield client


@pytest.fixture(scope="module")
def open_scheduler() -> Iterator[str]:
    """The address of a cluster that somebody else started, without keys."""
    from distributed import LocalCluster

    with LocalCluster(n_workers=1, threads_per_worker=2, host="127.0.0.1", dashboard_address="127.0.0.1:0") as found:
        yield found.scheduler_address


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The store of a sweep in one process, a member a chunk."""
    out = tmp_path_factory.mktemp("undisturbed") / "map.zarr"
    found = ss.sweep("fig6-slab", VARY, quantities=["slip", "pulses"], series=["slip"], samples=5, chunk=1, out=out, threads=1)
    assert int((found.status >= 10).sum()) == 12
    assert float(found.slip.max()) > 1.0
    return files(out)


@pytest.mark.slow
def test_a_killed_worker_changes_nothing(two_workers: Client, undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    killed = []

    def kill_one(report: SweepProgress) -> None:
        if report.done >= 3 and not killed:
            killed.append(next(iter(two_workers.run(os.getpid).values())))
            os.kill(killed[0], signal.SIGKILL)

    found = carry_out(plan_of(1), tmp_path / "map.zarr", on_cluster(two_workers), kill_one)
    assert killed
    assert int((found.status < 0).sum()) == 0
    assert files(tmp_path / "map.zarr") == undisturbed


def square(number: int) -> int:
    """Of whole numbers below 100; 7 cannot be squared, and 5 kills."""
    if number == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    if number == 7:
        raise ArithmeticError("no square of 7")
    return number**2


@pytest.mark.slow
def test_chunks_that_kill_their_workers_hold_up_no_others(two_workers: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(two_workers.cluster.scheduler, "allowed_failures", 0)
    found: dict[int, int] = {}

    def collect(numbers: Iterable[int]) -> None:
        for number, result in stream(two_workers, square, ((number, number) for number in numbers)):
            found[number] = result  # noqa: PERF403 - what came before the error is wanted

    with pytest.raises(ChunksLostError, match=r"no worker finished chunk 5: it ended 1 worker.*tries the missing ones again"):
        collect([5])
    with pytest.raises(ChunksLostError, match="chunk 7: ArithmeticError: no square of 7"):
        collect([*range(5), 7, *range(10, 40)])
    assert found == {number: number**2 for number in (*range(5), *range(10, 40))}


@pytest.mark.slow
def test_few_chunks_are_in_flight(local: Client) -> None:
    asked = []

    def chunks() -> Iterator[tuple[int, int]]:
        for number in range(10, 60):
            asked.append(number)
            yield number, number

    for done, _ in enumerate(stream(local, square, chunks())):
        assert len(asked) <= done + 8
    assert len(asked) == 50


@pytest.mark.slow
def test_a_worker_of_another_version_is_refused(local: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.extensions.sweeps.execution.cluster.engine_key", lambda *_: "another")
    with pytest.raises(ss.InputError, match="another version of stickslip"):
        list(stream(local, square, [(1, 1)]))


SUICIDAL = """
import os, signal, sys
from stickslip.extensions.sweeps.sweep import carry_out, runner_of
from tests.extensions.sweeps.cluster_plan import plan_of

def kill_all(report):
    if report.done >= 3:
        os.kill(os.getpid(), signal.SIGKILL)

if __name__ == "__main__":
    with runner_of(None, 1, None) as run:
        carry_out(plan_of(1), sys.argv[1], run, kill_all)
"""


@pytest.mark.slow
def test_a_killed_sweep_continues(undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    """kill -9 while a local cluster works: its worker goes with it, and the rest is done in one process."""
    out, script = tmp_path / "map.zarr", tmp_path / "suicidal.py"
    script.write_text(SUICIDAL)
    environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[3]), *sys.path])}
    sweep = subprocess.Popen([sys.executable, str(script), str(out)], env=environment, start_new_session=True)
    assert sweep.wait(timeout=120) == -signal.SIGKILL
    assert sum(name.startswith("status/c.") for name in files(out)) == 3
    for _ in range(400):
        if not _alive(sweep.pid):
            break
        time.sleep(0.05)
    assert not _alive(sweep.pid)
    ss.sweep("fig6-slab", VARY, quantities=["slip", "pulses"], series=["slip"], samples=5, chunk=1, out=out)
    assert files(out) == undisturbed


def _alive(session: int) -> bool:
    """Whether a process of that session is left."""
    try:
        os.killpg(session, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nowhere"])
def test_a_scheduler_that_does_not_answer_is_refused(address: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.extensions.sweeps.execution.cluster.TIME_TO_ANSWER", 0.2)
    with pytest.raises(ss.InputError, match=f"no dask scheduler answers at {address}"):
        ss.sweep("fig6-slab", VARY, scheduler=address)


def test_a_sweep_can_start_inside_an_event_loop() -> None:
    """As in a notebook."""

    async def cell() -> None:
        ss.sweep("fig6-slab", VARY, scheduler="nowhere")

    with pytest.raises(ss.InputError, match="no dask scheduler answers at nowhere"):
        asyncio.run(cell())


@pytest.mark.slow
def test_the_scheduler_may_be_named_by_a_file(open_scheduler: str, tmp_path: Path) -> None:
    file = tmp_path / "scheduler.json"
    file.write_text(f'{{"address": "{open_scheduler}"}}')
    found = ss.sweep("fig6-slab", {"friction.alpha": [0.05, 1.0]}, quantities="slip", scheduler=str(file))
    here = ss.sweep("fig6-slab", {"friction.alpha": [0.05, 1.0]}, quantities="slip")
    assert found.slip.values.tobytes() == here.slip.values.tobytes()


def test_without_dask_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(ss.InputError, match=r"needs dask\.distributed and cryptography: pip install 'stickslip\[cluster\]'"):
        ss.sweep("fig6-slab", VARY, workers=2)


@pytest.mark.parametrize("options", [{"workers": 0}, {"workers": 2, "threads": 2}, {"workers": 2, "scheduler": "a:1"}])
def test_bad_numbers_of_workers_are_refused(options: dict[str, int]) -> None:
    with pytest.raises(ss.InputError, match="workers"):
        ss.sweep("fig6-slab", VARY, **options)  # type: ignore[arg-type]


def test_a_local_cluster_refuses_who_has_no_key(local: Client) -> None:
    from distributed import Client, Security

    address = local.scheduler.address
    assert address.startswith("tls://127.0.0.1:")
    with pytest.raises(ss.InputError, match="no dask scheduler answers"):
        ss.sweep("fig6-slab", VARY, scheduler=address)
    with pytest.raises(OSError, match=r"\breset\b|connect"):
        Client(address.replace("tls://", "tcp://"), timeout=2.0)
    gc.collect()  # a client that failed stops its loop when it is thrown away, and must not do so in the thread of the next one
    with pytest.raises(OSError, match=r"certificate|\breset\b|connect"):
        Client(address, security=Security.temporary(), timeout=2.0)


OPEN = """
import json, sys, time
from pathlib import Path
from distributed import LocalCluster

where = {"protocol": "tcp", "host": "127.0.0.1", "dashboard_address": None}
with LocalCluster(n_workers=1, threads_per_worker=1, processes=False, **where) as found:
    file = Path(sys.argv[1])
    file.with_suffix(".part").write_text(json.dumps({"address": found.scheduler_address}))
    file.with_suffix(".part").rename(file)
    time.sleep(600)
"""
"""A scheduler without keys, and its worker in the same process, which writes a scheduler file."""


def slowly(number: int) -> int:
    """Take a while, so that not all is done when the scheduler goes."""
    time.sleep(0.3)
    return number


@pytest.mark.slow
def test_a_scheduler_that_is_lost_gives_one_line(tmp_path: Path) -> None:
    file = tmp_path / "scheduler.json"
    scheduler = subprocess.Popen([sys.executable, "-c", OPEN, str(file)])
    try:
        for _ in range(600):
            if file.exists():
                break
            time.sleep(0.1)
        with cluster(str(file)) as client:
            results = stream(client, slowly, ((number, number) for number in range(100)))
            next(results)
            scheduler.kill()
            with pytest.raises(ChunksLostError, match="the dask scheduler is lost"):
                list(results)
    finally:
        scheduler.kill()
        scheduler.wait()


def _listening(process: int) -> set[str]:
    """Addresses (as in /proc/net/tcp) on which a process listens."""
    sockets = {str(link.readlink()) for link in Path(f"/proc/{process}/fd").iterdir() if link.is_symlink()}
    rows = [line.split() for table in ("tcp", "tcp6") for line in Path(f"/proc/net/{table}").read_text().splitlines()[1:]]
    return {row[1].partition(":")[0] for row in rows if row[3] == "0A" and f"socket:[{row[9]}]" in sockets}


@pytest.mark.skipif(not Path("/proc/net/tcp").exists(), reason="needs Linux")
def test_a_local_cluster_listens_on_the_loopback_address_only(local: Client) -> None:
    from distributed import Nanny

    processes = [os.getpid(), *local.run(os.getpid).values()]
    assert all(isinstance(nanny, Nanny) for nanny in local.cluster.workers.values())
    assert set().union(*(_listening(process) for process in processes)) == {"0100007F"}


def test_a_local_cluster_shows_no_pages(local: Client) -> None:
    with pytest.raises(HTTPError, match="404"):
        urlopen(f"http://127.0.0.1:{local.cluster.scheduler.http_server.port}/info/main/workers.html", timeout=10)


@pytest.mark.slow
def test_without_cryptography_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "cryptography", None)
    with pytest.raises(ss.InputError, match=r"and cryptography: pip install 'stickslip\[cluster\]'"):
        ss.sweep("fig6-slab", VARY, workers=2)


STOPPED = """
import os, signal, sys, threading, time
import distributed
from stickslip.cli.main import main

def begin(cluster, *given, begin=distributed.LocalCluster.__init__, **named):
    def stop():
        time.sleep(float(sys.argv[1]))
        os.killpg(0, signal.SIGINT)
    threading.Thread(target=stop, daemon=True).start()
    begin(cluster, *given, **named)

if __name__ == "__main__":  # and not in the workers
    signal.signal(signal.SIGINT, signal.default_int_handler)
    distributed.LocalCluster.__init__ = begin
    main(["sweep", "fig6-slab", "--vary", "alpha=0.1..1:20000", "--workers", "2"])
"""
"""A sweep whose processes, all of them, get Ctrl-C so many seconds after the start of the cluster has begun."""


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="needs groups of processes")
@pytest.mark.parametrize("after", [0.0, 0.5, 1.0, 2.0, 4.0])
def test_ctrl_c_while_the_cluster_starts_is_one_line(after: float, tmp_path: Path) -> None:
    script = tmp_path / "sweep.py"
    script.write_text(STOPPED)
    done = subprocess.run(
        [sys.executable, script, str(after)], capture_output=True, text=True, start_new_session=True, timeout=120, check=False
    )
    assert (done.returncode, done.stderr) == (130, "stickslip: interrupted\n")
