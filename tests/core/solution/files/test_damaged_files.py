"""Files that were damaged, cut off, edited, or could not be written: one line, and nothing else is touched."""

from __future__ import annotations

import errno
import hashlib
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

import stickslip as ss
from stickslip.cli.stored import stored
from stickslip.engine.history.status import Checkpoint
from stickslip.engine.state.layout import NEVER, Counts, State
from stickslip.foundation import atomic_write, netcdf_file
from stickslip.foundation.atomic_write import DRAFT, STALE, write_atomically
from stickslip.foundation.locks import held
from stickslip.solution.files.netcdf import save_checkpoint

PROBLEM = ss.load_scenario("cycles-block").problem
POSIX = pytest.mark.skipif(os.name != "posix", reason="needs locks and limits of POSIX")


@pytest.fixture(scope="module")
def run() -> ss.Solution:
    return ss.simulate(PROBLEM, 20 * ss.YEAR)


KEPT: list[bytes] = []
"""The file of that run, once it has been written."""


def saved(run: ss.Solution, folder: Path) -> Path:
    """Put the file of the run into a folder: writing it takes longer than most of what is done with it."""
    path = folder / "run.nc"
    if not KEPT:
        KEPT.append(run.to_netcdf(path).read_bytes())
    path.write_bytes(KEPT[0])
    return path


def refused(act: Callable[[], object], *words: str) -> None:
    with pytest.raises(ss.InputError) as told:
        act()
    assert "\n" not in str(told.value)
    assert all(word in str(told.value) for word in words), str(told.value)


def contents(folder: Path) -> dict[Path, bytes | None]:
    """Return all files in a folder with their bytes, and all folders with None."""
    return {path: None if path.is_dir() else path.read_bytes() for path in folder.rglob("*")}


def resealed(path: Path, edit: Callable[[h5py.File], object]) -> None:
    """Edit a file, and give it a checksum that fits: what only somebody who means it does."""
    path.write_bytes(path.read_bytes()[: -netcdf_file.SEAL])
    with h5py.File(path, "r+") as file:
        edit(file)
    netcdf_file.seal(path)


def test_no_damaged_file_is_read(run: ss.Solution, tmp_path: Path) -> None:
    path = saved(run, tmp_path)
    whole, rng = path.read_bytes(), np.random.default_rng(1)
    for place in [0, len(whole) - 1, len(whole) - 70, *rng.integers(0, len(whole), 60).tolist()]:
        damaged = bytearray(whole)
        damaged[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(damaged)
        refused(lambda: ss.open_solution(path), "run.nc: ")
    for length in (0, 7, 8, 500, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        refused(lambda: ss.open_solution(path), "run.nc: ")


def test_other_readers_of_netcdf_do_not_mind_the_checksum(run: ss.Solution, tmp_path: Path) -> None:
    with h5py.File(saved(run, tmp_path), "r") as file:
        assert file["history_load"].shape == (len(run.history), 19)


COUNTS = {
    "length": 10**6,
    "piece": 7,
    "mode": 2,
    "echo_of": 10**9,
    "trip_from": -1,
    "sparse": 1,
}


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize(("name", "value"), COUNTS.items())
def test_a_count_out_of_range_is_refused(run: ss.Solution, tmp_path: Path, name: str, value: int) -> None:
    def edit(checkpoint: Checkpoint) -> None:
        setattr(Counts(checkpoint.count), name, value)

    check_edit(run, tmp_path, edit)


EDITS: dict[str, Callable[[Checkpoint], object]] = {
    "branch that is infinite": lambda checkpoint: checkpoint.branch.fill(np.inf),
    "branch that is no number": lambda checkpoint: checkpoint.branch.fill(np.nan),
    "place beyond the piece": lambda checkpoint: checkpoint.state.__setitem__(State.places["xi"].first, 1e300),
    "slip that is no number": lambda checkpoint: checkpoint.state.__setitem__(State.places["slip_now"].first, np.nan),
}


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", EDITS)
def test_a_state_out_of_range_is_refused(run: ss.Solution, tmp_path: Path, name: str) -> None:
    check_edit(run, tmp_path, EDITS[name])


def check_edit(run: ss.Solution, tmp_path: Path, edit: Callable[[Checkpoint], object]) -> None:
    assert run.checkpoint is not None
    arrays = {name: np.copy(value) for name, value in vars(run.checkpoint).items() if name != "engine"}
    checkpoint = Checkpoint(**arrays, engine=run.checkpoint.engine)
    edit(checkpoint)
    path = tmp_path / "run.nc"
    save_checkpoint(replace(run, checkpoint=checkpoint), path)
    refused(lambda: ss.resume(path, 30 * ss.YEAR), "run.nc: not a state that a run can have: ", "out of range")


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("trips", [{0: -1}, {1: 5, 2: 3}, {-1: NEVER}], ids=["negative", "descend", "beyond all"])
def test_a_row_of_a_piece_out_of_range_is_refused(run: ss.Solution, tmp_path: Path, trips: dict[int, int]) -> None:
    path = saved(run, tmp_path)

    def edit(file: h5py.File) -> None:
        table = file["history_trip"][...]
        for place, trip in trips.items():
            table[place] = trip
        file["history_trip"][...] = table

    resealed(path, edit)
    refused(lambda: ss.open_solution(path), "run.nc: not a state that a run can have: row of a piece is out of range")


def test_tables_that_claim_more_than_the_file_holds_are_not_read(run: ss.Solution, tmp_path: Path) -> None:
    path = saved(run, tmp_path)

    def claim(file: h5py.File) -> None:
        del file["history_load"]
        file.create_dataset("history_load", shape=(10**12, 19), dtype="f8", chunks=(1024, 19))

    resealed(path, claim)
    refused(lambda: ss.open_solution(path), "run.nc: not a file of stickslip: its tables claim")


NUMEROUS: dict[str, Callable[[h5py.File], object]] = {
    "tables": lambda file: [file.create_dataset(f"t{k}", data=0.0) for k in range(300)],
    "attributes": lambda file: [file.attrs.__setitem__(f"a{k}", k) for k in range(300)],
    "attributes of '/history_load'": lambda file: [file["history_load"].attrs.__setitem__(f"a{k}", k) for k in range(300)],
}


@pytest.mark.parametrize("what", NUMEROUS)
def test_more_tables_or_attributes_than_any_run_has_are_counted_and_not_read(
    run: ss.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, what: str
) -> None:
    """The libraries take 5 ms for each: 8 000 small tables in 2.8 MB took 39 s."""
    path = saved(run, tmp_path)
    resealed(path, NUMEROUS[what])
    monkeypatch.setattr("h5netcdf.File", None)
    monkeypatch.setattr("xarray.open_dataset", None)
    refused(lambda: ss.open_solution(path), "run.nc: not a file of stickslip: it has 3", f" {what}, at most 256 are allowed")


def test_links_out_of_the_file_are_not_followed(run: ss.Solution, tmp_path: Path) -> None:
    path = saved(run, tmp_path)
    resealed(path, lambda file: file.__setitem__("elsewhere", h5py.ExternalLink("other.nc", "/x")))
    refused(lambda: ss.open_solution(path), "run.nc: not a file of stickslip: 'elsewhere' in it is a link")


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", ["history_rate", "engine_count", "round_trip_time"])
def test_a_missing_table_is_refused_in_one_line(run: ss.Solution, tmp_path: Path, name: str) -> None:
    path = saved(run, tmp_path)
    resealed(path, lambda file: file.__delitem__(name))
    refused(lambda: ss.open_solution(path), "run.nc: ")


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("value", ["", "x", np.inf, np.nan, [1, 2]])
def test_an_attribute_that_is_no_number_is_refused_in_one_line(run: ss.Solution, tmp_path: Path, value: Any) -> None:
    path = saved(run, tmp_path)
    resealed(path, lambda file: file.attrs.__setitem__("rtol", value))
    refused(lambda: ss.open_solution(path), "run.nc: not a file that stickslip has written: ")


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", ["status", "status_message", "lumping", "rounding"])
def test_texts_of_a_result_cannot_change_the_terminal(
    run: ss.Solution, tmp_path: Path, name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = saved(run, tmp_path)
    resealed(path, lambda file: file.attrs.__setitem__(name, "a\n\x1b[31mred\x07"))
    stored(path).results.summarise()
    shown = capsys.readouterr().out
    assert r"a\n\x1b[31mred\x07" in "".join(shown.split())
    assert "\x1b" not in shown


FULL = """
import resource, sys
import stickslip as ss
problem = ss.load_scenario("cycles-block").problem
ss.simulate(problem, 20 * ss.YEAR).to_netcdf("run.nc")
solution = ss.simulate(problem, 100 * ss.YEAR)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), int(sys.argv[1])))
try:
    solution.to_netcdf("run.nc")
except ss.InputError as error:
    assert error.solution is solution
    print(error)
"""


@pytest.mark.sampled(every=3)
@POSIX
@pytest.mark.parametrize("room", [0, 3000, 30_000])
def test_a_full_disk_gives_one_line_and_keeps_the_file_before(tmp_path: Path, room: int) -> None:
    """HDF5 crashes where a write fails, so it must not see that."""
    done = subprocess.run([sys.executable, "-c", FULL, str(room)], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("run.nc: cannot be written: File too large")
    assert ss.open_solution(tmp_path / "run.nc").duration == 20 * ss.YEAR
    assert [path.name for path in tmp_path.iterdir()] == ["run.nc"]


def test_a_checkpoint_on_a_full_disk_does_not_end_the_run(
    run: ss.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    save_checkpoint(run, tmp_path / "run.nc")
    before = (tmp_path / "run.nc").read_bytes()
    monkeypatch.setattr(atomic_write, "sync", full)
    with pytest.warns(RuntimeWarning, match=r"run\.nc: cannot be written: No space left on device; the run continues"):
        save_checkpoint(run, tmp_path / "run.nc")
    assert (tmp_path / "run.nc").read_bytes() == before


@POSIX
def test_drafts_of_killed_writers_are_removed_and_no_others(tmp_path: Path) -> None:
    import fcntl

    old, young, locked, other = (tmp_path / name for name in (f"{DRAFT}1.nc", f"{DRAFT}2.nc", f"{DRAFT}3.nc", ".other.nc"))
    for path in (old, young, locked, other):
        path.write_text("x")
    for path in (old, locked, other):
        os.utime(path, (1.0, 1.0) if path is other else (young.stat().st_mtime - 2 * STALE,) * 2)
    with locked.open("r+") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        write_atomically(tmp_path / "new.txt", lambda draft: draft.write_text("y"))
    assert {path.name for path in tmp_path.iterdir()} == {"new.txt", young.name, locked.name, other.name}


@POSIX
@pytest.mark.parametrize("folder", [False, True])
def test_the_draft_of_a_slow_writer_is_left_alone(tmp_path: Path, folder: bool) -> None:
    def slow(draft: Path) -> None:
        (draft / "a" if folder else draft).write_text("whole")
        os.utime(draft, (draft.stat().st_mtime - 2 * STALE,) * 2)
        write_atomically(tmp_path / "other.txt", lambda other: other.write_text("y"))

    path = write_atomically(tmp_path / "slow", slow, folder=folder)
    assert (path / "a" if folder else path).read_text() == "whole"
    assert {one.name for one in tmp_path.iterdir()} == {"slow", "other.txt"}


def test_a_file_that_fails_in_a_draft_has_its_final_name_in_the_message(tmp_path: Path) -> None:
    def full(draft: Path) -> None:
        (draft / "data").mkdir()
        raise OSError(errno.ENOSPC, "No space left on device", str(draft / "data" / "step-1.js"))

    with pytest.raises(OSError, match="No space left") as told:
        write_atomically(tmp_path / "tour", full, folder=True)
    assert told.value.filename == str(tmp_path / "tour" / "data" / "step-1.js")
    assert list(tmp_path.iterdir()) == []


@POSIX
def test_a_lock_on_a_name_is_exclusive_and_released(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    with held(path, "taken"):
        refused(lambda: held(path, "taken").__enter__(), "taken")
    assert list(tmp_path.iterdir()) == []
    with held(path, "taken"):
        pass


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", ["k.nc", "k.rows.csv", "k.checkpoint.nc", ".k.checkpoint.nc.lock"])
def test_a_folder_in_place_of_a_file_of_a_catalogue_is_named_before_anything_is_removed(tmp_path: Path, name: str) -> None:
    ss.catalogue(PROBLEM, 20 * ss.YEAR, tmp_path / "k.nc")
    (tmp_path / "k.rows.csv").write_text("start,end,duration,recurrence,")  # of a run that was killed
    (tmp_path / name).unlink(missing_ok=True)
    (tmp_path / name / "inside").mkdir(parents=True)
    before = contents(tmp_path)
    refused(lambda: ss.catalogue(PROBLEM, 20 * ss.YEAR, tmp_path / "k.nc"), f"{tmp_path / name}: ")
    assert contents(tmp_path) == before


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", ["k.nc", "k.rows.csv", "k.checkpoint.nc"])
def test_a_file_of_others_in_place_of_one_of_a_catalogue_is_never_replaced(tmp_path: Path, name: str) -> None:
    ss.catalogue(PROBLEM, 20 * ss.YEAR, tmp_path / "k.nc")
    (tmp_path / name).write_text("mine")
    before = contents(tmp_path)
    refused(lambda: ss.catalogue(PROBLEM, 20 * ss.YEAR, tmp_path / "k.nc"), f"{tmp_path / name}: exists, and stickslip did not")
    assert contents(tmp_path) == before


def test_a_checkpoint_never_cuts_a_file_that_is_no_catalogue(tmp_path: Path) -> None:
    """A checkpoint that counts no rows, made by hand, beside somebody's own table."""
    ss.catalogue(PROBLEM, 20 * ss.YEAR, tmp_path / "events.csv")
    crafted = tmp_path / "mine.checkpoint.nc"
    crafted.write_bytes((tmp_path / "events.checkpoint.nc").read_bytes())
    mine = tmp_path / "mine.csv"
    mine.write_text("a,b\n1,2\n")
    refused(lambda: ss.resume(crafted, 40 * ss.YEAR), "not the checkpoint of events.csv")

    def name_it(file: h5py.File) -> None:
        file.attrs.update({"catalogue": "mine.csv", "bytes": 0, "told": 0, "digest": hashlib.sha256().hexdigest()})

    resealed(crafted, name_it)
    refused(lambda: ss.resume(crafted, 40 * ss.YEAR), "mine.csv")
    assert mine.read_text() == "a,b\n1,2\n"


@POSIX
@pytest.mark.parametrize("name", ["run.nc", "events.csv"])
def test_a_pipe_in_place_of_a_result_is_refused_at_once(name: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / name)
    refused(lambda: stored(tmp_path / name), name, "not an ordinary file")
