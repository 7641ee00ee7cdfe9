"""Runs of planar slabs in a folder: streamed, stopped, killed and continued bit for bit; damaged ones are refused in one line."""

from __future__ import annotations

import json
import math
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import google_crc32c
import numcodecs
import numpy as np
import pytest
import xarray
import zarr

import stickslip as ss
from stickslip.extensions.planar import store as planar_store
from stickslip.extensions.planar import store_layout as planar_layout
from stickslip.extensions.planar.run import PlanarReport
from stickslip.foundation import netcdf_file, zarr_folder
from stickslip.foundation.locks import held
from stickslip.foundation.zarr_folder import unpacked_size
from stickslip.run import run_loop
from tests.extensions.planar.patches import patch, state_patch

GRID = {"nodes": 32, "length": 2e4}
DURATION = 12.0  # three round trips, of 5.71 s


def stop_after(count: int) -> Callable[[PlanarReport], None]:
    """A callback that interrupts the run after `count` frames, and the report before the start."""
    left = iter(range(count))

    def report(_: PlanarReport) -> None:
        if next(left, None) is None:
            raise KeyboardInterrupt

    return report


def check_same(one: Any, other: Any) -> None:
    assert one.status.name == other.status.name
    assert len(one.times) == len(other.times)
    check_fields(one, other)


@pytest.fixture(scope="module")
def whole() -> Any:
    return ss.simulate(patch(**GRID), DURATION, frames=10)


@pytest.fixture(scope="module")
def stopped(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that was stopped in its second round trip."""
    path = tmp_path_factory.mktemp("stopped") / "run.zarr"
    ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path, progress=stop_after(14))
    return path


@pytest.fixture
def store(stopped: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    return Path(shutil.copytree(stopped, tmp_path / "run.zarr"))


@pytest.mark.slow
@pytest.mark.parametrize("stops", [(3, 7), pytest.param((10, 1), marks=pytest.mark.slow)], ids=str)
def test_a_run_that_was_stopped_twice_is_the_run_that_was_not(tmp_path: Path, whole: Any, stops: tuple[int, int]) -> None:
    """After frame 10 a round trip ends."""
    path = tmp_path / "run.zarr"
    stopped = ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path, progress=stop_after(stops[0]))
    assert stopped.status.name == "interrupted"
    assert len(stopped.times) == stops[0] + 1
    ctrl_c = iter([False] * stops[1] + [True])
    again: Any = ss.resume(
        path, progress=lambda _: next(ctrl_c, False) and signal.raise_signal(signal.SIGINT), checkpoint_every=0.0
    )
    assert len(again.times) == sum(stops) + 1
    check_same(ss.resume(path), whole)
    check_same(ss.open_solution(path), whole)


@pytest.mark.slow
def test_a_run_with_states_continues_bit_for_bit(tmp_path: Path) -> None:
    path = tmp_path / "run.zarr"
    ss.simulate(state_patch(), 3.0, frames=16, checkpoint=path, progress=stop_after(5))
    check_same(ss.resume(path), ss.simulate(state_patch(), 3.0, frames=16))


@pytest.mark.slow
@pytest.mark.parametrize("plane", [False, True], ids=["line", "plane"])
def test_a_run_that_is_alone_continues_bit_for_bit(tmp_path: Path, plane: bool) -> None:
    path = tmp_path / "run.zarr"
    contact = patch(**GRID, **({"width": 1e4, "width_nodes": 16} if plane else {}), replicas=False)
    ss.simulate(contact, 7.0, frames=10, checkpoint=path, progress=stop_after(7))
    check_same(ss.resume(path), ss.simulate(contact, 7.0, frames=10))
    with pytest.raises(ss.InputError, match="without replicas"):
        ss.resume(path, 7.5)


class Killed(BaseException):
    """In place of a signal that no process survives."""


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    "place", ["sync", "write_variables", *(pytest.param(one, marks=pytest.mark.slow) for one in ("consolidate", "in_attributes"))]
)
def test_a_run_that_died_while_it_wrote_continues_bit_for_bit(tmp_path: Path, whole: Any, monkeypatch: Any, place: str) -> None:
    """Half-way through the arrays, before the state, between the state and what readers see, and before the status."""
    path, calls = tmp_path / "run.zarr", iter(range({"sync": 21, "in_attributes": 3}.get(place, 3)))
    module: Any = {"write_variables": netcdf_file, "consolidate": zarr_folder}.get(place, planar_store)
    real = getattr(module, place)

    def dies(*given: Any) -> Any:
        if next(calls, None) is None:
            raise Killed
        return real(*given)

    monkeypatch.setattr(run_loop, "SHARE_OF_TASKS", 1e9)  # a checkpoint at each frame
    monkeypatch.setattr(module, place, dies)
    with pytest.raises(Killed):
        ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path, checkpoint_every=0.0)
    monkeypatch.undo()
    found = ss.open_solution(path)
    assert found.status.name == "under way"
    assert np.array_equal(found.slip, whole.slip[: len(found.times)])
    check_same(ss.resume(path), whole)


@pytest.mark.slow
def test_a_longer_run_is_the_run_that_was_long_from_the_start(tmp_path: Path, whole: Any) -> None:
    """Three round trips are prepared as four; the shorter run ends between two frames."""
    path = tmp_path / "run.zarr"
    ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path)
    longer = ss.resume(path, 20.0)
    check_same(longer, ss.simulate(patch(**GRID), 20.0, frames=10))
    assert np.array_equal(longer.slip[: len(whole.times) - 1], whole.slip[:-1])
    with pytest.raises(ss.InputError, match=r"exponentials are made for 22.857"):
        ss.resume(path, 23.0)
    with pytest.raises(ss.InputError, match=r"has already reached 20"):
        ss.resume(path, 19.0)


ON_TWO = """
import stickslip as ss
print(len(__import__("jax").devices()), ss.resume("run.zarr").status.name)
"""


@pytest.mark.slow
def test_two_devices_continue_what_one_device_began(store: Path, whole: Any) -> None:
    """17 wavenumbers on one device are 18 on two, of which the last is nothing."""
    env = os.environ | {"XLA_FLAGS": "--xla_force_host_platform_device_count=2", "JAX_PLATFORMS": "cpu"}
    done = subprocess.run([sys.executable, "-c", ON_TWO], cwd=store.parent, env=env, capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["2", "finished"]
    found = ss.open_solution(store)
    assert np.abs(found.slip - whole.slip).max() < 1e-12 * whole.slip.max()


@pytest.mark.slow
def test_xarray_reads_a_folder_while_the_run_continues(tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.setattr(run_loop, "SHARE_OF_TASKS", 1e9)  # a checkpoint at each frame
    seen = []

    def look(report: PlanarReport) -> None:
        if report.time == 0.0:
            return
        with xarray.open_zarr(tmp_path / "run.zarr", chunks=None) as found:
            assert np.isfinite(found.slip).all()
            seen.append((found.sizes["time"], found.attrs["status"]))

    run = ss.simulate(patch(**GRID), 3.0, frames=10, checkpoint=tmp_path / "run.zarr", checkpoint_every=0.0, progress=look)
    assert [frames for frames, _ in seen] == list(range(2, len(run.times) + 1))
    assert {status for _, status in seen} == {"under way"}
    with xarray.open_zarr(tmp_path / "run.zarr", chunks=None) as found:
        assert found.slip.dims == ("time", "y")
        assert [found[name].attrs["units"] for name in ("time", "y", "slip_rate", "traction")] == ["s", "m", "m s-1", "Pa"]
        assert found.attrs["status"] == "finished"
        assert np.array_equal(found["along.load"], run.slab.along["load"])


def test_a_folder_opens_with_all_observables(store: Path) -> None:
    found = ss.open_solution(store)
    assert found.pulses.shape == found.rupture_times.shape == (32,)
    assert found.moment_rate.shape == found.times.shape
    assert "interrupted" in repr(found)
    assert str(found)
    assert found.dataset().slip.shape == (15, 32)


# ---- refused in one line ---------------------------------------------------------------------------------------------------------


def refused(act: Callable[[], object], *words: str) -> None:
    with pytest.raises(ss.InputError) as told:
        act()
    assert "\n" not in str(told.value)
    assert all(word in str(told.value) for word in words), str(told.value)


@pytest.mark.parametrize("flips", [1, pytest.param(3, marks=pytest.mark.slow)])
def test_no_damaged_folder_is_read(store: Path, whole: Any, flips: int) -> None:
    """Any bit of any file: what is opened or continued is refused, or is what was written."""
    rng, told, copy = np.random.default_rng(2), [], store.with_name("damaged.zarr")
    for file in sorted(path.relative_to(store) for path in store.rglob("*") if path.is_file()):
        for _ in range(flips):
            shutil.copytree(store, copy)
            damaged = bytearray((copy / file).read_bytes())
            damaged[int(rng.integers(len(damaged)))] ^= 1 << int(rng.integers(8))
            (copy / file).write_bytes(damaged)
            told.append(try_to(lambda: check_fields(ss.open_solution(copy), whole)))
            if flips > 1:
                told.append(try_to(lambda: check_fields(ss.resume(copy), whole)))
            shutil.rmtree(copy)
    lines = [line for line in told if line]
    assert len(lines) > 8 * flips
    assert not any("\n" in line or len(line) > 600 for line in lines)


def try_to(act: Callable[[], object]) -> str:
    """Return the message of the InputError that a call raises, or an empty text."""
    try:
        act()
    except ss.InputError as error:
        return str(error)
    return ""


def check_fields(found: Any, whole: Any) -> None:
    for name in ("times", "slip", "slip_rate", "traction", "heat"):
        assert np.array_equal(getattr(found, name), getattr(whole, name)[: len(found.times)]), name


def edited(path: Path, **changes: Any) -> None:
    """Change attributes of a folder, and give it a checksum that fits: what only somebody who means it does."""
    group = zarr.open_group(path, mode="r+")
    group.attrs.update(changes)
    group.attrs.update({"digest": planar_layout.PLANAR_FORMAT.digest_of(group.attrs)})
    state = netcdf_file.read(path / "state.nc")
    netcdf_file.write(state.assign_attrs(digest=group.attrs["digest"]), path / "state.nc")


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"stickslip_planar": 2}, "format 1 expected, found 2"),
        ({"scenario": "x = 1"}, "run.zarr"),
        ({"scenario": 3}, "cannot be read"),
        ({"grid": {"nodes": 16, "length": 2e4}}, "has another form"),
        ({"grid": [1]}, "run.zarr"),
        ({"along": ["static"]}, "static"),
        ({"modes": [2, 9]}, "waves/sent"),
        ({"steps_per_round_trip": 0.5}, "steps_per_round_trip is 0.5"),
        ({"duration": math.inf}, "duration is inf"),
        ({"frames": "many"}, "frames is 'many'"),
    ],
    ids=str,
)
def test_a_folder_made_by_hand_is_refused(store: Path, changes: dict[str, Any], word: str) -> None:
    edited(store, **changes)
    refused(lambda: ss.resume(store), str(store), word)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("file", ["state.nc", "slip/c.1.0", "barrier/c.0", "waves/sent/c.0.0.0", "waves/zarr.json"])
def test_a_folder_without_one_of_its_files_is_refused(store: Path, file: str) -> None:
    (store / file).unlink()
    refused(lambda: ss.resume(store).slip, str(store))


def test_what_is_no_planar_run_is_refused(store: Path, tmp_path: Path) -> None:
    refused(lambda: ss.open_solution(tmp_path), "is a folder that holds no results of stickslip")
    zarr.create_group(tmp_path / "sweep.zarr", attributes={"stickslip_sweep": 1})
    refused(lambda: ss.open_solution(tmp_path / "sweep.zarr"), "holds a sweep, which is not a run")
    refused(lambda: ss.resume(tmp_path / "missing.zarr"), "missing.zarr")
    (tmp_path / "two.zarr").mkdir()
    refused(lambda: ss.resume(tmp_path / "two.zarr"), "two.zarr")
    refused(lambda: ss.sweep("fig6-slab", {"friction.alpha": [1.0]}, out=store), "not the store of a sweep")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"checkpoint": "run.nc"}, "the checkpoint of a PlanarSlab is a folder NAME.zarr, got 'run.nc'"),
        ({"checkpoint": 3}, "checkpoint"),
        ({"checkpoint": "run.zarr", "checkpoint_every": -1.0}, "checkpoint_every"),
        ({"checkpoint": "missing/run.zarr"}, "missing"),
        ({"max_pieces": 3}, "a PlanarSlab has no max_pieces"),
    ],
    ids=str,
)
def test_a_clumsy_checkpoint_is_refused(monkeypatch: Any, tmp_path: Path, arguments: dict[str, Any], words: str) -> None:
    monkeypatch.chdir(tmp_path)
    refused(lambda: ss.simulate(patch(**GRID), 3.0, **arguments), words)
    assert not list(tmp_path.iterdir())


def test_a_clumsy_resume_is_refused(store: Path) -> None:
    refused(lambda: ss.simulate(patch(**GRID), 3.0, checkpoint=store), "exists: stickslip.resume continues the run in it")
    refused(lambda: ss.resume(store, max_events=3), "without max_events")
    refused(lambda: ss.resume(store, checkpoint="other.zarr"), "without checkpoint")
    with held(store, "held"):
        refused(lambda: ss.resume(store), "another run is writing into it")


# ---- folders that attack ---------------------------------------------------------------------------------------------------------


def grown(path: Path, name: str, rows: int) -> None:
    """Let the metadata of an array say that it has so many rows."""
    for file in (path / "zarr.json", path / name / "zarr.json"):
        about = json.loads(file.read_text())
        one = about if file.parent.name == Path(name).name else about["consolidated_metadata"]["metadata"][name]
        one["shape"][0] = rows
        file.write_text(json.dumps(about))


def bomb(path: Path) -> None:
    """A chunk of 64 kB that unpacks to 2 GB."""
    packed = numcodecs.Zstd().encode(np.zeros(2**21))
    frame = bytearray(packed)
    assert unpacked_size(bytes(frame)) == 2**24
    huge = b"\x28\xb5\x2f\xfd" + b"\xe0" + (2**31).to_bytes(8, "little") + b"\0" * 65_536
    path.write_bytes(huge + google_crc32c.Checksum(huge).digest()[::-1])


@pytest.mark.sampled(every=5)
@pytest.mark.skipif(os.name != "posix", reason="needs pipes and links")
@pytest.mark.parametrize(
    ("attack", "words"),
    [
        (lambda store: os.mkfifo(moved(store / "slip/c.0.0")), "slip/c.0.0: not an ordinary file"),
        (lambda store: moved(store / "slip/c.0.0").symlink_to("/dev/zero"), "slip/c.0.0: not an ordinary file"),
        (lambda store: os.mkfifo(moved(store / "zarr.json")), "not an ordinary file"),
        (lambda store: bomb(store / "slip/c.0.0"), "slip/c.0.0: unpacks to more than 268435456 bytes"),
        (lambda store: (store / "slip/c.0.0").write_bytes(b"x" * 100), "slip/c.0.0: unpacks to more than"),
        (lambda store: grown(store, "slip", 300_000_000), "its array 'slip' has 300000000 rows, and 2 files of them"),
        (lambda store: grown(store, "waves/sent", 300_000_000), "its array 'waves/sent' has 300000000 rows"),
        (lambda store: grown(store, "barrier", 300_000_000), "its array 'barrier' has another form"),
        (lambda store: grown(store, "time", 0), "its times (0,)"),
        (lambda store: edited(store, duration=1e300), "rows"),
    ],
    ids=["pipe", "device", "pipe of metadata", "bomb", "no frame", "rows", "rows of waves", "profile", "no rows", "duration"],
)
def test_a_folder_that_attacks_is_refused_in_one_line(store: Path, attack: Callable[[Path], object], words: str) -> None:
    attack(store)
    if words != "rows":
        refused(lambda: ss.open_solution(store).slip, str(store), words)
    told = try_to(lambda: ss.resume(store))  # which may not need what is wrong
    assert "\n" not in told


def moved(path: Path) -> Path:
    """The name of a file that is no longer there."""
    path.unlink()
    return path


@pytest.mark.skipif(os.name != "posix", reason="needs links")
def test_nothing_is_written_through_a_link(store: Path, tmp_path: Path) -> None:
    link = tmp_path / "link.zarr"
    link.symlink_to(store)
    before = {path: path.stat().st_mtime_ns for path in store.rglob("*")}
    refused(lambda: ss.resume(link), "is a link: name the folder itself")
    refused(lambda: ss.simulate(patch(**GRID), 3.0, checkpoint=link), "is a link: name the folder itself")
    assert before == {path: path.stat().st_mtime_ns for path in store.rglob("*")}


@pytest.mark.skipif(os.name != "posix", reason="needs links")
@pytest.mark.parametrize("name", ["slip", "waves", "waves/sent", "zarr.json", "nothing"])
def test_no_run_is_continued_through_a_link_inside_its_folder(name: str, store: Path, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    if name == "nothing":
        (store / "waves" / name).symlink_to(tmp_path / "not there")
    else:
        (store / name).rename(elsewhere)
        (store / name).symlink_to(elsewhere)
    before = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*") if path.exists()}
    refused(lambda: ss.resume(store, 6.0), f"{name} in it is a link: put the folder or the file itself there")
    assert before == {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*") if path.exists()}


def test_a_folder_that_was_killed_before_its_first_checkpoint_is_used_again(tmp_path: Path, whole: Any, monkeypatch: Any) -> None:
    path = tmp_path / "run.zarr"

    def dies(*_: Any) -> None:
        raise Killed

    monkeypatch.setattr(planar_store.PlanarStore, "save", dies)
    with pytest.raises(Killed):
        ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path)
    monkeypatch.undo()
    assert path.is_dir()
    refused(lambda: ss.resume(path), "has no checkpoint yet: begin the run again with this name")
    check_same(ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path), whole)
    refused(
        lambda: ss.simulate(patch(**GRID), DURATION, frames=10, checkpoint=path), "exists: stickslip.resume continues the run in it"
    )


def test_a_state_that_counts_other_frames_is_refused(store: Path) -> None:
    state = netcdf_file.read(store / "state.nc")
    netcdf_file.write(state.assign_attrs(written=99), store / "state.nc")
    refused(lambda: ss.resume(store), "it has 15 frames, its state.nc says 99")


def test_a_run_stopped_after_its_first_frame_can_continue(store: Path) -> None:
    state = netcdf_file.read(store / "state.nc")
    netcdf_file.write(state.assign_attrs(written=1, sent=1), store / "state.nc")
    with planar_store.PlanarStore.at(store) as found:
        assert (found.written, found.sent) == (1, 1)


@pytest.mark.slow
def test_python_without_assertions_is_refused_in_one_line(store: Path) -> None:
    code = "import stickslip as ss\ntry: ss.open_solution('run.zarr')\nexcept ss.InputError as error: print(error)"
    path = str(Path(ss.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "-O", "-c", code],
        cwd=store.parent,
        env=os.environ | {"PYTHONPATH": path},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == (
        "run.zarr: zarr needs the assertions of Python for the run of a planar slab: unset PYTHONOPTIMIZE, or leave out python -O\n"
    )
