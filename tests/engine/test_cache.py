"""Compiled code is kept on disk, in a folder of this user alone, and what is damaged there is compiled again."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from numba.core.caching import FunctionCache

from stickslip.engine.codegen import sealed_cache, sealed_file
from stickslip.engine.codegen.private_folder import NotPrivateError, private_folder

SCRIPT = """
import stickslip as ss
slab = ss.ElasticSlab({density}, 3500, {thickness}, 1e8)
law = ss.friction.HyperbolicRate(0.8, {dynamic}, {alpha})
print(len(ss.simulate(ss.Problem(slab, law, pull_rate={pull}, initial_excess=0.0), {duration}).shocks))
"""


def run(**values: float) -> str:
    return subprocess.run([sys.executable, "-c", SCRIPT.format(**values)], capture_output=True, text=True, check=True).stdout


COUNTED = """
from numba import njit
from numba.core.event import RecordingListener, register
passes = RecordingListener()
register("numba:run_pass", passes)
{run}
print(len(passes.buffer))
njit(lambda x: 2 * x)(1)
print(len(passes.buffer) > 0)
"""
"""A run in a process that counts what its compiler does; at the end something is compiled, to see that it is counted."""


def test_second_scenario_compiles_nothing() -> None:
    first = {"density": 2800, "thickness": 1e4, "dynamic": 0.3, "alpha": 1.0, "pull": 1e-9, "duration": 20}
    assert run(**first) == "2\n"
    second = {"density": 2500, "thickness": 3e3, "dynamic": 0.35, "alpha": 2.0, "pull": 1e-3, "duration": 9}
    code = COUNTED.format(run=SCRIPT.format(**second))
    shocks, during, counted = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    assert int(shocks) > 0
    assert (during, counted) == ("0", "True")


AFTER = """
import sys
from numba import njit
import numpy as np
{run}
print("numba.np.linalg" in sys.modules)
print(njit(lambda values: values[np.argmax(np.abs(values))] + np.sum(values))(np.array([1.0, -4.0, 2.0])))
"""


def test_code_from_the_disk_makes_no_compiler_ready_and_code_compiled_after_it_runs() -> None:
    values = {"density": 2800, "thickness": 1e4, "dynamic": 0.3, "alpha": 1.0, "pull": 1e-9, "duration": 20}
    run(**values)
    code = AFTER.format(run=SCRIPT.format(**values))
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert shown == "2\nFalse\n-5.0\n"


TWICE = """
from stickslip.engine.codegen.cache import CACHE
from stickslip.engine.codegen.compiler import kernel
def twice(x):
    return 2.0 * x
twice = kernel(twice)
print(twice(21.0), sum(twice.entry.stats.cache_hits.values()), CACHE)
"""


def twice(root: Path) -> tuple[float, int, Path, str]:
    """Compile or load a small function in another process: its value, its hits of the cache, the folder, what was said."""
    environment = os.environ | {"STICKSLIP_CACHE_DIR": str(root)}
    done = subprocess.run([sys.executable, "-c", TWICE], capture_output=True, text=True, check=True, env=environment)
    value, hits, folder = done.stdout.split()
    return float(value), int(hits), Path(folder), done.stderr


LATER = "later starts compile again; STICKSLIP_CACHE_DIR names another folder"


def files_in(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.suffix in (".nbi", ".nbc")]


def flip(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


DAMAGE: dict[str, Callable[[bytes], bytes]] = {
    "empty": lambda _: b"",
    "truncated": lambda content: content[: len(content) // 2],
    "flipped bit": flip,
    "another program": lambda _: b"raise SystemExit('ran')",
}


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("damage", DAMAGE.values(), ids=DAMAGE)
def test_damaged_files_are_compiled_again(tmp_path: Path, damage: Callable[[bytes], bytes]) -> None:
    value, hits, folder, said = twice(tmp_path)
    assert (value, hits, said) == (42.0, 0, "")
    assert {path.suffix for path in files_in(folder)} == {".nbi", ".nbc"}
    for path in files_in(folder):
        path.write_bytes(damage(path.read_bytes()))
    value, hits, _, said = twice(tmp_path)
    assert (value, hits) == (42.0, 0)
    assert said.count("\n") == 1
    assert "is damaged: what is damaged is compiled again" in said
    assert twice(tmp_path) == (42.0, 1, folder, "")


def test_damaged_machine_code_is_detected_behind_an_intact_index(tmp_path: Path) -> None:
    folder = twice(tmp_path)[2]
    (code,) = folder.rglob("*.nbc")
    code.write_bytes(flip(code.read_bytes()))
    value, hits, _, said = twice(tmp_path)
    assert (value, hits, said.count("\n")) == (42.0, 0, 1)
    assert twice(tmp_path)[1] == 1


def test_without_a_cache_folder_each_process_compiles_for_itself(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    value, hits, folder, said = twice(tmp_path / "file")
    assert (value, hits, folder) == (42.0, 0, Path("None"))
    assert said.startswith("stickslip: no cache for compiled code: ")
    assert said.count("\n") == 1
    assert (tmp_path / "file").read_text() == ""


def test_a_file_in_place_of_a_folder_of_the_cache_is_no_fault_but_one_line(tmp_path: Path) -> None:
    folder = twice(tmp_path)[2]
    (kept,) = folder.iterdir()
    shutil.rmtree(kept)
    kept.touch()
    value, hits, _, said = twice(tmp_path)
    assert (value, hits) == (42.0, 0)
    assert said == f"stickslip: compiled code cannot be kept in {folder}: File exists; {LATER}\n"


def test_a_full_disk_costs_the_cache_and_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from stickslip.engine.codegen import cache
    from stickslip.engine.codegen.compiler import kernel

    def full(path: Path, write: Callable[[Path], object]) -> Path:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    monkeypatch.setattr(FunctionCache, "_load_overload", lambda *_: None)
    monkeypatch.setattr(sealed_file, "write_atomically", full)
    cache.tell.cache_clear()
    assert kernel(lambda x: 2.0 * x)(21.0) == 42.0
    assert f"cannot be kept in {cache.CACHE}: No space left on device; {LATER}\n" in capsys.readouterr().err


def test_the_cache_keeps_the_functions_that_were_used_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from stickslip.engine.codegen import cache

    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    folder = tmp_path / "compiled-0" / "formulas_0"
    folder.mkdir(parents=True)
    for used, name in enumerate(["old", "older", "new"], 1000):
        for file in (f"{name}_0.value-9.py311.nbi", f"{name}_0.value-9.py311.1.nbc"):
            (folder / file).write_bytes(bytes(50))
            os.utime(folder / file, (used, used))
    os.utime(folder / "old_0.value-9.py311.nbi", (2000, 2000))  # read since
    for file in (folder / "own.txt", tmp_path / "own.nbi"):
        file.touch()
    cache.make_room(250)
    assert {path.name.split("_")[0] for path in folder.glob("*.nb[ic]")} == {"old", "new"}
    cache.make_room(100)
    assert [path.name.split("_")[0] for path in folder.glob("*.nb[ic]")] == ["old", "old"]
    assert (folder / "own.txt").exists()
    assert (tmp_path / "own.nbi").exists()


def test_a_function_that_another_process_removed_is_compiled_again(tmp_path: Path) -> None:
    folder = twice(tmp_path)[2]
    (code,) = folder.rglob("*.nbc")
    code.unlink()
    assert twice(tmp_path) == (42.0, 0, folder, "")
    assert twice(tmp_path) == (42.0, 1, folder, "")


def test_a_private_folder_is_closed_to_others(tmp_path: Path) -> None:
    folder = private_folder(tmp_path / "a" / "b")
    assert folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o755)
    (folder / "kept").touch()
    assert private_folder(folder).stat().st_mode & 0o777 == 0o700
    assert (folder / "kept").exists()


def test_a_folder_into_which_others_could_write_is_emptied(tmp_path: Path) -> None:
    folder = private_folder(tmp_path / "a")
    (folder / "planted.py").touch()
    folder.chmod(0o777)
    private_folder(folder)
    assert list(folder.iterdir()) == []
    assert folder.stat().st_mode & 0o777 == 0o700


def test_a_link_is_no_private_folder(tmp_path: Path) -> None:
    private_folder(tmp_path / "there")
    (tmp_path / "here").symlink_to("there")
    with pytest.raises(NotPrivateError, match="here is a link"):
        private_folder(tmp_path / "here")


def test_a_folder_below_one_that_others_can_change_is_not_private(tmp_path: Path) -> None:
    tmp_path.chmod(0o777)
    with pytest.raises(NotPrivateError, match="other users can write into"):
        private_folder(tmp_path / "a")
    tmp_path.chmod(0o1777)
    private_folder(tmp_path / "a")


def test_a_folder_of_another_user_is_not_private(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = private_folder(tmp_path / "a")
    monkeypatch.setattr("os.geteuid", lambda: 12345)
    with pytest.raises(NotPrivateError, match="belongs to another user"):
        private_folder(folder)


@pytest.mark.parametrize(
    ("spent", "name", "has_engine", "message"),
    [
        (0.0, "total", True, ""),
        (0.0, "run_until", False, "run_until"),
        (5.0, "total", True, "others"),
        (5.0, "total", False, "run_until"),
    ],
)
def test_compiling_the_engine_is_announced(
    spent: float, name: str, has_engine: bool, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The engine takes long to compile; of others something is said once they have taken long, and of a small one nothing."""
    from stickslip.engine.codegen import cache
    from stickslip.engine.loop import run_until
    from stickslip.engine.series.polynomial import total

    said: list[str] = []
    (tmp_path / "engine").mkdir()
    if has_engine:
        (tmp_path / "engine" / "loop.run_until-65.py311.nbi").touch()
    monkeypatch.setattr(sealed_cache, "CACHE", tmp_path)
    monkeypatch.setattr(FunctionCache, "_load_overload", lambda *_: None)
    monkeypatch.setattr(FunctionCache, "save_overload", lambda *_: None)
    monkeypatch.setattr(cache, "announce", said.append)
    monkeypatch.setattr(sealed_cache._Wait, "spent", spent)
    monkeypatch.setattr(sealed_cache._Wait, "told", set())
    entry = {"total": total, "run_until": run_until}[name].entry  # type: ignore[attr-defined]
    for _ in range(2):
        assert entry._cache.load_overload(None, entry.targetctx) is None
        entry._cache.save_overload(None, None)
    assert said == ([(cache.SLOW | {"others": cache.OTHERS})[message]] if message else [])


@pytest.mark.parametrize("damage", ["cut", "zeros", "another file", "gone"])
def test_machine_code_of_a_formula_is_kept_and_made_again_where_its_file_is_damaged(
    damage: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sealed_file, "CACHE", tmp_path)
    made: list[bytes] = []

    def make() -> bytes:
        made.append(b"code")
        return b"code"

    assert sealed_file.kept("a text", make) == sealed_file.kept("a text", make) == b"code"
    assert len(made) == 1
    (file,) = (tmp_path / "formulas").iterdir()
    sealed_file.kept("another text", lambda: b"other")
    (other,) = (path for path in (tmp_path / "formulas").iterdir() if path != file)
    content = {"cut": file.read_bytes()[:-1], "zeros": bytes(len(file.read_bytes())), "another file": other.read_bytes()}
    file.unlink()
    if damage in content:
        file.write_bytes(content[damage])
    assert sealed_file.kept("a text", make) == b"code"
    assert len(made) == 2
    assert sealed_file.kept("a text", make) == b"code"
    assert len(made) == 2
