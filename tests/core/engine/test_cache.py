"""Compiled code is kept on disk, in a folder of this user alone, and what is damaged there is compiled again."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from threading import Thread
from unittest.mock import Mock

import pytest

from stickslip.foundation.kernels import one_module
from stickslip.foundation.kernels.kernels import _checksum_of
from stickslip.foundation import sealed_files
from stickslip.foundation.atomic_write import DRAFT
from stickslip.foundation.private_folder import NotPrivateError, private_folder
from stickslip.foundation.sealed_files import read_sealed, write_sealed

SCRIPT = """
import stickslip as ss
slab = ss.ElasticSlab({density}, 3500, {thickness}, 1e8)
law = ss.friction.HyperbolicRate(0.8, {dynamic}, {alpha})
print(len(ss.simulate(ss.Problem(slab, law, pull_rate={pull}, initial_excess=0.0), {duration}).shocks))
"""


def run(**values: float) -> str:
    return subprocess.run([sys.executable, "-c", SCRIPT.format(**values)], capture_output=True, text=True, check=True).stdout


COUNTED = """
import sys
from numba import njit
from numba.core.event import RecordingListener, register
import numpy as np
passes = RecordingListener()
register("numba:run_pass", passes)
{run}
print(len(passes.buffer), "numba.np.linalg" in sys.modules)
print(njit(lambda values: values[np.argmax(np.abs(values))] + np.sum(values))(np.array([1.0, -4.0, 2.0])), len(passes.buffer) > 0)
"""
"""A run in a process that counts what its compiler does; at the end something is compiled, to see that it is counted."""


def test_a_second_scenario_compiles_nothing_and_makes_no_compiler_ready_and_code_compiled_after_it_runs() -> None:
    first = {"density": 2800, "thickness": 1e4, "dynamic": 0.3, "alpha": 1.0, "pull": 1e-9, "duration": 20}
    assert run(**first) == "2\n"
    second = {"density": 2500, "thickness": 3e3, "dynamic": 0.35, "alpha": 2.0, "pull": 1e-3, "duration": 9}
    code = COUNTED.format(run=SCRIPT.format(**second))
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    shocks, *others = shown.split()
    assert int(shocks) > 0
    assert others == ["0", "False", "-5.0", "True"]


KEPT = """
import ctypes
from stickslip.engine.formula_code import formula_machine
from stickslip.foundation.kernels.cache import CACHE
from stickslip.foundation.kernels.kernels import kernel

@kernel
def twice(x):
    return 2.0 * x

@kernel
def thrice(x):
    return 3.0 * x

made, write = [], formula_machine._object_code
formula_machine._object_code = lambda *rest: made.append(rest) or write(*rest)

def formula(line):
    code, out = formula_machine.MachineCode([line], ["x", "out[]"], False, {}), ctypes.c_double()
    ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p)(code.address)(21.0, ctypes.byref(out))
    return out.value

print(twice(21.0), thrice(21.0), formula("out[0] = 2.0*x"), formula("out[0] = 3.0*x"))
print(sum(sum(one.entry._cache_hits.values()) for one in (twice, thrice)) + 2 - len(made), CACHE)
"""
"""Compiles or loads two kernels and two formulas; prints their values, how many it has loaded, and the folder."""


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of KEPT: numba's own cache looks at its place and date."""
    path = tmp_path_factory.mktemp("script") / "small.py"
    path.write_text(KEPT)
    return path


def kept(script: Path, root: Path, plain: str = "0") -> tuple[int, Path, str]:
    """Run KEPT in another process: how many it has loaded of four, the folder, and what was said."""
    settings = os.environ | {"STICKSLIP_CACHE_DIR": str(root), "STICKSLIP_PLAIN_NUMBA": plain}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True, env=settings)
    values, loaded = done.stdout.splitlines()
    assert values == "42.0 63.0 42.0 63.0"
    count, folder = loaded.split()
    return int(count), Path(folder), done.stderr


LATER = "later starts compile again; STICKSLIP_CACHE_DIR names another folder"


def files_in(root: Path) -> list[Path]:
    return sorted(path for path in root.rglob("*") if path.is_file())


def flip(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


DAMAGE: dict[str, Callable[[Path, bytes], object]] = {
    "empty": lambda path, _: path.write_bytes(b""),
    "truncated": lambda path, _: path.write_bytes(path.read_bytes()[:-1]),
    "zeros": lambda path, _: path.write_bytes(bytes(path.stat().st_size)),
    "a flipped bit": lambda path, _: path.write_bytes(flip(path.read_bytes())),
    "another file's bytes": lambda path, other: path.write_bytes(other),
    "a folder": lambda path, _: (path.unlink(), path.mkdir(), (path / "inside").touch()),
    "unreadable": lambda path, _: (path.unlink(), path.symlink_to(path)),
    "a pipe": lambda path, _: (path.unlink(), os.mkfifo(path)),
    "a link to an endless device": lambda path, _: (path.unlink(), path.symlink_to("/dev/zero")),
    "a file without end": lambda path, _: os.truncate(path, 2**40),
}
KINDS = {
    "kernels": ("0", "compiled-*/__main__.*", 2, 1),
    "key": ("0", "keys/*", 4, 1),
    "formulas": ("0", "compiled-*/formula-*", 2, 1),
    "numba's own": ("1", "compiled-*/plain/*/*", 2, 0),
    "numba's own checksums": ("1", "compiled-*/plain.*", 2, 1),
}
"""Kinds of files: whether numba is used plainly, names, how many of four are loaded if they are damaged, and lines that say so."""


@pytest.fixture(scope="module")
def sound(script: Path, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """A function that returns the folder of a sound cache, by whether numba is used plainly."""

    @cache
    def root_of(plain: str) -> Path:
        root = tmp_path_factory.mktemp("sound")
        assert [kept(script, root, plain)[0] for _ in range(2)] == [0, 4]
        return root

    return root_of


@pytest.mark.sampled(every=len(DAMAGE) * len(KINDS))
@pytest.mark.parametrize("damage", DAMAGE)
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_damaged_is_compiled_again(
    kind: str, damage: str, tmp_path: Path, script: Path, sound: Callable[[str], Path]
) -> None:
    plain, names, left, said_of = KINDS[kind]
    root = tmp_path / "root"
    shutil.copytree(sound(plain), root)
    before = files_in(root)
    damaged = sorted(root.glob(names))
    contents = [path.read_bytes() for path in damaged]
    others = [*contents[1:], contents[0]] if len(contents) > 1 else [before[0].read_bytes()]
    for path, other in zip(damaged, others, strict=True):
        DAMAGE[damage](path, other)
    loaded, _, said = kept(script, root, plain)
    assert loaded == left
    assert said.count("\n") == said_of + (plain == "1")
    assert said.count("is damaged: what is damaged is compiled again") == said_of
    assert kept(script, root, plain)[0] == 4
    assert files_in(root) == before


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("plain", ["0", "1"])
def test_without_a_cache_folder_each_process_compiles_for_itself(plain: str, script: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    loaded, folder, said = kept(script, tmp_path / "file", plain)
    assert (loaded, folder) == (0, Path("None"))
    assert said.startswith("stickslip: no cache for compiled code: ")
    assert said.count("\n") == 1 + (plain == "1")
    assert (tmp_path / "file").read_text() == ""


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    ("names", "plain", "loaded"), [("keys", "0", 4), ("compiled-*", "0", 0), ("*/plain", "1", 2), ("*/plain/*", "1", 2)]
)
def test_a_file_in_place_of_a_folder_of_the_cache_is_no_fault(
    names: str, plain: str, loaded: int, script: Path, tmp_path: Path, sound: Callable[[str], Path]
) -> None:
    shutil.copytree(sound(plain), tmp_path / "root")
    for path in (tmp_path / "root").glob(names):
        shutil.rmtree(path)
        path.touch()
    found, _, said = kept(script, tmp_path / "root", plain)
    assert found == loaded
    assert said.count("\n") <= 1 + (plain == "1")


def test_a_full_disk_costs_the_cache_and_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from stickslip.foundation.kernels import cache
    from stickslip.foundation.kernels.kernels import kernel

    def full(path: Path, write: Callable[[Path], object]) -> Path:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    monkeypatch.setattr(sealed_files, "write_atomically", full)
    sealed_files.tell.cache_clear()
    assert kernel(lambda x: 2.0 * x)(21.0) == 42.0
    assert f"cannot be kept in {cache.CACHE}: No space left on device; {LATER}\n" in capsys.readouterr().err


NOT_READ: dict[str, Callable[[Path], object]] = {
    "a pipe": os.mkfifo,
    "a link to an endless device": lambda path: path.symlink_to("/dev/zero"),
    "a link to a sound file": lambda path: path.symlink_to(path.rename(path.with_name("other"))),
    "a file larger than any": lambda path: os.truncate(path, 2**40),
    "a folder": lambda path: (path.mkdir(), (path / "inside").touch()),
}


@pytest.mark.parametrize("stands", NOT_READ)
def test_what_is_no_file_of_the_cache_is_not_read(stands: str, tmp_path: Path) -> None:
    """It is read in a thread, because a read that never ends would hold up the tests."""
    path = tmp_path / "kept.nbc"
    write_sealed(path, b"code")
    assert read_sealed(path) == b"code"
    if stands not in ("a link to a sound file", "a file larger than any"):
        path.unlink()
    NOT_READ[stands](path)
    found: list[object] = []
    reader = Thread(target=lambda: found.extend([_checksum_of(path), read_sealed(path), os.path.lexists(path)]), daemon=True)
    reader.start()
    reader.join(20.0)
    assert found == [b"", None, False]


def test_what_is_larger_than_any_file_of_the_cache_is_not_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sealed_files, "LARGEST_FILE", 100)
    for size, there in ((10, True), (100, False)):  # the seal is part of the file
        write_sealed(tmp_path / str(size), bytes(size))
        assert (tmp_path / str(size)).exists() == there


def test_a_file_of_another_user_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "kept.nbc"
    write_sealed(path, b"code")
    monkeypatch.setattr("os.geteuid", lambda: 12345)
    assert read_sealed(path) is None
    assert not path.exists()


def test_a_draft_that_is_a_pipe_holds_up_nobody(tmp_path: Path) -> None:
    pipe = tmp_path / f"{DRAFT}0"
    os.mkfifo(pipe)
    os.utime(pipe, (0.0, 0.0))
    writer = Thread(target=write_sealed, args=(tmp_path / "kept.nbc", b"code"), daemon=True)
    writer.start()
    writer.join(20.0)
    assert read_sealed(tmp_path / "kept.nbc") == b"code"
    assert not pipe.exists()


def test_a_long_process_looks_again_at_the_size_of_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that has written 10 MB since it last looked removes what has not been used for longest."""
    from stickslip.foundation.kernels import cache

    folder = tmp_path / "compiled-0"
    folder.mkdir()
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(cache, "CACHE", folder)
    monkeypatch.setattr(cache, "TIDY", cache.Tidy())
    monkeypatch.setattr(cache.make_room, "__defaults__", (12_000_000,))
    sizes = []
    for n in range(30):
        cache.Kept(f"formula{n}", "text").write(bytes(1_000_000))
        sizes.append(sum(path.stat().st_size for path in folder.iterdir()))
    assert max(sizes) <= 12_000_000 + cache.LOOK_AFTER
    assert sizes[-1] < 30_000_000  # all that was written


def test_the_cache_keeps_the_files_that_were_used_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from stickslip.foundation.kernels import cache

    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    folder = tmp_path / "compiled-0" / "plain" / "formulas_0"
    folder.mkdir(parents=True)
    for used, file in enumerate([folder / "old.nbi", folder / "older.1.nbc", tmp_path / "compiled-0" / "new.nbc"], 1000):
        file.write_bytes(bytes(100))
        os.utime(file, (used, used))
    os.utime(folder / "old.nbi", (2000, 2000))  # read since
    for file in (folder / "own.txt", tmp_path / "own.nbi"):
        file.touch()
    cache.make_room(250)
    assert {path.stem for path in tmp_path.rglob("*.nb[ic]")} == {"old", "new", "own"}
    cache.make_room(100)
    assert {path.stem for path in tmp_path.rglob("*.nb[ic]")} == {"old", "own"}
    assert (folder / "own.txt").exists()


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
    from stickslip.foundation.kernels import cache
    from stickslip.engine.loop import run_until
    from stickslip.engine.series.polynomial import total

    said: list[str] = []
    if has_engine:
        (tmp_path / "loop.run_until-0.nbc").touch()
    monkeypatch.setattr(one_module, "CACHE", tmp_path)
    monkeypatch.setattr(one_module.Kept, "read", lambda _: None)
    monkeypatch.setattr(cache, "announce", said.append)
    monkeypatch.setattr(one_module._Wait, "spent", spent)
    monkeypatch.setattr(one_module._Wait, "announced", set())
    entry = {"total": total, "run_until": run_until}[name].entry  # type: ignore[attr-defined]
    for _ in range(2):
        assert entry._cache.load_overload(None, entry.targetctx) is None
        monkeypatch.setattr(one_module.Kept, "write", lambda *_: None)
        entry._cache.save_overload(None, Mock())
    assert said == ([(cache.SLOW | {"others": cache.OTHERS})[message]] if message else [])
