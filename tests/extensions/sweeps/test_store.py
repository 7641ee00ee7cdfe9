"""A sweep that was stopped, killed or ran out of disk goes on, and leaves the store of one that was not, file by file."""

from __future__ import annotations

import errno
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
import zarr

import stickslip as ss
from stickslip.engine.session import Session
from stickslip.extensions.sweeps.execution.chunk import BAD_PARAMETERS, NOT_RUN
from stickslip.extensions.sweeps.execution.plan import make_plan
from stickslip.extensions.sweeps.results.store import ResultStore, open_store
from stickslip.extensions.sweeps.sweep import SweepProgress, carry_out, on_threads
from tests.extensions.sweeps.stores import FINE, MEMBERS, SAVED, VARY, files, sweep
from tests.messages import refused


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of a sweep that nothing disturbed."""
    path = tmp_path_factory.mktemp("whole") / "map.zarr"
    sweep(path)
    return path


@pytest.fixture(scope="module")
def whole(kept: Path) -> dict[str, bytes]:
    """Files of that store."""
    return files(kept)


@pytest.fixture
def store(kept: Path, tmp_path: Path) -> Path:
    """A copy of that store."""
    return Path(shutil.copytree(kept, tmp_path / "map.zarr"))


def test_a_store_holds_what_a_sweep_gives(tmp_path: Path, whole: dict[str, bytes]) -> None:
    path = tmp_path / "map.zarr"
    given = sweep(path).load()
    assert given.identical(sweep(None))
    assert files(path) == whole
    with xr.open_zarr(path) as opened:
        assert opened.load().equals(given)
    assert given.slip.dims == ("loading.far_stress_rate", "body.thickness")
    assert given.slip.sel({"loading.far_stress_rate": 0.0, "body.thickness": 11e3}).item() > 1.0
    assert given.status.values.tolist() == [[0] * 6, [BAD_PARAMETERS] * 6]
    assert [reason != "" for reason in given.reason.values.ravel()] == [False] * 6 + [True] * 6
    assert given["body.thickness"].attrs["units"] == "m"
    assert given["body.thickness"].attrs["long_name"]
    assert given.slip.attrs == {"long_name": "slip of the whole run", "units": "m"}
    assert given.attrs["source"] == f"stickslip {ss.__version__}"
    assert "thickness = 10000.0" in given.attrs["scenario"]
    assert (given.attrs["rtol"], given.attrs["selection_rule"]) == (1e-10, "perfect-delay")


def test_samples_and_lists_have_a_member_dimension(tmp_path: Path) -> None:
    asked = {"vary": {"alpha": (0.1, 2.0), "run.selection": ["maxwell", "minimal"]}, "design": "lhs", "members": 7, "seed": 5}
    sweep(tmp_path / "sample.zarr", **asked)
    with xr.open_zarr(tmp_path / "sample.zarr") as found:
        assert found.slip.dims == ("member",)
        assert set(found.coords) == {"friction.alpha", "run.selection", "time"}
        assert set(found["run.selection"].values.tolist()) == {"maxwell", "minimal"}
        assert found.load().identical(sweep(None, **asked))


class Stop:
    """Presses Ctrl-C when so many members are done."""

    def __init__(self, after: int) -> None:
        self.after = after
        self.reports: list[SweepProgress] = []

    def __call__(self, report: SweepProgress) -> None:
        self.reports.append(report)
        if report.done >= self.after:
            raise KeyboardInterrupt


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("after", [2, 6, 10])
def test_a_stopped_sweep_continues_to_the_same_files(tmp_path: Path, whole: dict[str, bytes], after: int) -> None:
    path = tmp_path / "map.zarr"
    stopped = sweep(path, progress=Stop(after))
    assert int((stopped.status != NOT_RUN).sum()) == after
    assert np.isfinite(stopped.slip.values).sum() == min(after, FINE)
    again = Stop(MEMBERS + 1)
    sweep(path, progress=again)
    assert [report.done for report in again.reports] == list(range(after, MEMBERS + 1, 2))
    assert files(path) == whole


def test_ctrl_c_without_a_store_returns_the_finished_members() -> None:
    stopped = sweep(None, progress=Stop(4))
    assert int((stopped.status != NOT_RUN).sum()) == 4


@pytest.mark.skipif(os.name != "posix", reason="needs SIGINT")
def test_ctrl_c_in_the_last_moment_of_a_run_ends_the_sweep(monkeypatch: pytest.MonkeyPatch) -> None:
    """The run, which ends just then by itself, must not take it for its own."""
    advance = Session.advance

    def interrupted(run: Session, budget: int) -> int:
        code = advance(run, budget)
        os.kill(os.getpid(), signal.SIGINT)
        return code

    monkeypatch.setattr(Session, "advance", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    stopped = ss.sweep("fig6-slab", {"friction.alpha": [1.0, 2.0]}, quantities=["end_time", "heat"], chunk=1)
    assert signal.signal(signal.SIGINT, before) is signal.default_int_handler
    assert stopped.status.values.tolist() == [NOT_RUN, NOT_RUN]


def test_the_order_of_chunks_does_not_matter(tmp_path: Path, whole: dict[str, bytes]) -> None:
    plan, path = make_plan("fig6-slab", VARY, **SAVED), tmp_path / "map.zarr"
    forwards = on_threads(1)
    carry_out(plan, path, lambda work, chunks: forwards(work, reversed(list(chunks))))
    assert files(path) == whole


def test_a_chunk_of_another_size_gives_the_same_numbers(tmp_path: Path) -> None:
    one, other = sweep(None).drop_attrs(), sweep(None, chunk=5).drop_attrs()
    assert one.identical(other)
    path = tmp_path / "map.zarr"
    sweep(path, progress=Stop(2))
    assert (sweep(path, chunk=5).status.values != NOT_RUN).all()  # goes on with the chunks with which it was begun


KILLED = """
import os, signal, sys
from pathlib import Path
from tests.extensions.sweeps.stores import sweep

rename, left = Path.replace, [int(sys.argv[2])]
def replace(self, target):
    left[0] -= self.suffix == ".partial" and "map.zarr" in self.parts
    if left[0] < 0:
        os.kill(os.getpid(), signal.SIGKILL)
    return rename(self, target)
Path.replace = replace
sweep(Path(sys.argv[1]))
"""


@pytest.mark.slow
@pytest.mark.sampled(every=3)
@pytest.mark.skipif(os.name != "posix", reason="needs SIGKILL")
@pytest.mark.parametrize("writes", [7, 14, 17])
def test_a_sweep_killed_while_it_writes_continues_to_the_same_files(tmp_path: Path, whole: dict[str, bytes], writes: int) -> None:
    """With a file half written: in the middle of a chunk of six files, and before its status (17)."""
    path = tmp_path / "map.zarr"
    done = subprocess.run([sys.executable, "-c", KILLED, str(path), str(writes)], capture_output=True, text=True, check=False)
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert list(path.rglob("*.partial"))
    with xr.open_zarr(path) as found:
        there = found.status.values != NOT_RUN
        assert 0 < there.sum() < MEMBERS
        assert np.isfinite(found.slip.values)[there].sum() == min(there.sum(), FINE)
    again = Stop(MEMBERS + 1)
    sweep(path, progress=again)
    assert again.reports[0].done == there.sum()
    assert files(path) == whole


COMMAND = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # which background jobs of a shell ignore
from stickslip.cli.main import main
main(sys.argv[1:])
"""


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.skipif(os.name != "posix", reason="needs signals")
@pytest.mark.parametrize("sent", [signal.SIGINT, signal.SIGKILL])
def test_a_command_stopped_at_any_moment_continues(tmp_path: Path, sent: signal.Signals) -> None:
    arguments = ["sweep", "fig6-slab", "--vary", "friction.alpha=0.2..2:60", "-q", "heat", "--chunk", "2", "--out", "map.zarr"]
    command, path = [sys.executable, "-c", COMMAND, *arguments], tmp_path / "map.zarr"
    running = subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while len(list(path.glob("status/c*"))) < 3 and running.poll() is None:
        time.sleep(0.01)
    running.send_signal(sent)
    out, err = running.communicate(timeout=60)
    assert running.returncode == (130 if sent == signal.SIGINT else -signal.SIGKILL), err
    if sent == signal.SIGINT:
        assert err == "stickslip: interrupted\n"
        assert "not run" in out
    with xr.open_zarr(path) as found:
        there = int((found.status != NOT_RUN).sum())
    assert 6 <= there < 60
    again = Stop(61)
    asked = {"vary": {"friction.alpha": np.linspace(0.2, 2.0, 60)}, "quantities": ["heat"], "series": []}
    assert (sweep(path, progress=again, **asked).status.values == 0).all()
    assert again.reports[0].done == there


def test_a_full_disk_gives_one_line_and_leaves_a_store_that_continues(
    tmp_path: Path, whole: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    path, rename, left = tmp_path / "map.zarr", Path.replace, [13]

    def replace(self: Path, target: Path) -> Path:
        left[0] -= self.suffix == ".partial" and path in self.parents
        if left[0] < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        return rename(self, target)

    monkeypatch.setattr(Path, "replace", replace)
    with refused(begins=f"{path}: cannot be written: No space left on device; the members so far are kept, and"):
        sweep(path)
    with xr.open_zarr(path) as found:
        assert 0 < int((found.status != NOT_RUN).sum()) < MEMBERS
    monkeypatch.undo()
    sweep(path)
    assert files(path) == whole


def test_a_disk_that_is_full_from_the_start_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def replace(self: Path, target: Path) -> Path:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "replace", replace)
    with pytest.raises(ss.InputError, match="No space left on device; nothing was kept"):
        sweep(tmp_path / "map.zarr")
    assert list(tmp_path.iterdir()) == []


OTHERS: list[tuple[dict[str, Any], str]] = [
    ({"vary": VARY | {"body.thickness": np.linspace(5e3, 20e3, 5)}}, "was made with other values of body.thickness"),
    ({"vary": {"friction.dynamic": [0.3]}}, "was made over loading.far_stress_rate, body.thickness (design grid)"),
    ({"quantities": ["slip"]}, "was made for other quantities (arrested, pulses, series_slip, slip)"),
    ({"samples": 6}, "was made with other samples of time"),
    ({"series": []}, "was made for other quantities"),
]


@pytest.mark.parametrize(("asked", "said"), OTHERS)
def test_another_sweep_is_refused(store: Path, whole: dict[str, bytes], asked: dict[str, Any], said: str) -> None:
    with refused(begins=f"{store}: {said}"):
        sweep(store, **asked)
    assert files(store) == whole


def test_another_scenario_and_another_version_are_refused(store: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ss.InputError, match="was made from another scenario"):
        ss.sweep("second-event-maxwell", VARY, out=store, **SAVED)
    monkeypatch.setattr("stickslip.extensions.sweeps.results.layout.engine_key", lambda *_: "another")
    with pytest.raises(ss.InputError, match=r"was made by another version of stickslip \('\w+', this is 'another'\)"):
        sweep(store)


@pytest.mark.parametrize("kind", ["file", "folder", "zarr"])
def test_what_is_no_sweep_is_left_alone(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "map.zarr"
    if kind == "file":
        path.write_text("mine")
    elif kind == "folder":
        path.mkdir()
        (path / "mine").write_text("mine")
    else:
        xr.Dataset({"mine": 1}).to_zarr(path, consolidated=False)
    before = files(tmp_path)
    said = "is a file, where a sweep needs a folder" if kind == "file" else "exists and is not the store of a sweep"
    with pytest.raises(ss.InputError, match=f"{said}: choose another name"):
        sweep(path)
    assert files(tmp_path) == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.skipif(os.name != "posix", reason="needs locks")
def test_two_sweeps_do_not_write_into_one_store(tmp_path: Path) -> None:
    plan, path = make_plan("fig6-slab", VARY, **SAVED), tmp_path / "map.zarr"
    with ResultStore.at(plan, path), pytest.raises(ss.InputError, match="another sweep is writing into it"):
        sweep(path)
    assert (sweep(path).status.values != NOT_RUN).all()


@pytest.mark.slow
def test_a_changed_file_is_refused_in_one_line(store: Path, whole: dict[str, bytes]) -> None:
    """Each file of a store: with a bit flipped, cut off, or gone; members whose status is gone are those that have not been run."""
    path = store
    for name, content in whole.items():
        flipped = bytes([content[0] ^ 1]) + content[1:]
        for damaged in (flipped, content[: len(content) // 2], None):
            file = path / name
            file.unlink() if damaged is None else file.write_bytes(damaged)
            if damaged is None and name.startswith("status/c"):
                assert int((open_store(path).status == NOT_RUN).sum()) == SAVED["chunk"]
                file.write_bytes(content)
                continue
            with refused(begins=str(path)):
                open_store(path)
            file.write_bytes(content)
    for name in ("slip/c.0.0", "status/c.0.0"):
        (path / name).write_bytes(whole[name][:-1])
        with pytest.raises(ss.InputError, match=f"damaged: {name} is not as it was written: remove .*status/c.0.0, and the same"):
            sweep(path)
        (path / "status" / "c.0.0").unlink()
        sweep(path)
        assert files(path) == whole


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("version", [1, 3])
def test_a_store_of_another_format_is_refused_in_one_line(store: Path, version: int) -> None:
    zarr.open_group(store, mode="r+").attrs["stickslip_sweep"] = version
    reads = ", which the version that made it reads" if version == 1 else ""
    for act in (sweep, open_store):
        with pytest.raises(ss.InputError) as told:
            act(store)
        said = f"not the store of a sweep of this version of stickslip (format 2 expected, found {version}{reads})"
        assert str(told.value) == f"{store}: {said}"
