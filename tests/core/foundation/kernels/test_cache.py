"""Compiled code is kept on disk, in a folder of this user alone, and what is damaged there is compiled again."""

from __future__ import annotations

import errno
import os
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from threading import Thread

import pytest

from stickslip.foundation import sealed_files
from stickslip.foundation.atomic_write import DRAFT
from stickslip.foundation.kernels import code
from stickslip.foundation.private_folder import NotPrivateError, private_folder
from stickslip.foundation.sealed_files import read_sealed, write_sealed

KEPT = """
import ctypes
from pathlib import Path
from stickslip.foundation import code_key
code_key.SHIPPED = Path("nowhere")
from stickslip.engine.formula_code import formula_machine
from stickslip.foundation.kernels import code
from stickslip.foundation.kernels.kernels import entry

@entry
def twice(x: float) -> float:
    return 2.0 * x

@entry
def thrice(x: float) -> float:
    return 3.0 * x

made = []

def counted(make):
    return lambda *given: made.append(given) or make(*given)

formula_machine._object_code, code.made_now = counted(formula_machine._object_code), counted(code.made_now)

def formula(line):
    machine, out = formula_machine.MachineCode([line], ["x", "out[]"], False, {}), ctypes.c_double()
    ctypes.CFUNCTYPE(None, ctypes.c_double, ctypes.c_void_p)(machine.address)(21.0, ctypes.byref(out))
    return out.value

print(twice(21.0), thrice(21.0), formula("out[0] = 2.0*x"), formula("out[0] = 3.0*x"))
print(4 - len(made), code.cache_folder())
"""
"""Makes or loads the machine code of two entries and two formulas; prints their values, how many it has loaded, and the folder."""


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of KEPT: numba reads the source of functions."""
    path = tmp_path_factory.mktemp("script") / "small.py"
    path.write_text(KEPT)
    return path


def kept(script: Path, root: Path) -> tuple[int, Path, list[str]]:
    """Run KEPT in another process: how many it has loaded of four, the folder, and what was said but for why code is made."""
    settings = os.environ | {"STICKSLIP_CACHE_DIR": str(root)}
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True, env=settings)
    values, loaded = done.stdout.splitlines()
    assert values == "42.0 63.0 42.0 63.0"
    count, folder = loaded.split()
    said = done.stderr.splitlines()
    assert sum("compiling the engine" in line for line in said) <= 1
    return int(count), Path(folder), [line for line in said if "compiling the engine" not in line]


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
    "a file larger than any": lambda path, _: os.truncate(path, 2 * sealed_files.LARGEST_FILE),
}
KINDS = {"entries": ("compiled-*/__main__.*", 2), "key": ("keys/*", 4), "formulas": ("compiled-*/formula-*", 2)}
"""Kinds of files: their names, and how many of four are loaded if they are damaged."""


@pytest.fixture(scope="module")
def sound(script: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a sound cache."""
    root = tmp_path_factory.mktemp("sound")
    assert [kept(script, root)[::2] for _ in range(2)] == [(0, []), (4, [])]
    return root


@pytest.mark.sampled(every=len(KINDS) * len(DAMAGE))
@pytest.mark.parametrize("damage", DAMAGE)
@pytest.mark.parametrize("kind", KINDS)
def test_what_is_damaged_is_compiled_again(kind: str, damage: str, tmp_path: Path, script: Path, sound: Path) -> None:
    names, left = KINDS[kind]
    root = tmp_path / "root"
    shutil.copytree(sound, root)
    before = files_in(root)
    damaged = sorted(root.glob(names))
    contents = [path.read_bytes() for path in damaged]
    others = [*contents[1:], contents[0]] if len(contents) > 1 else [before[0].read_bytes()]
    for path, other in zip(damaged, others, strict=True):
        DAMAGE[damage](path, other)
    loaded, _, said = kept(script, root)
    assert loaded == left
    assert [line.partition(" is damaged: ")[2] for line in said] == ["what is damaged is compiled again"]
    assert kept(script, root)[::2] == (4, [])
    assert files_in(root) == before


@pytest.mark.slow
def test_without_a_cache_folder_each_process_compiles_for_itself(script: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    loaded, folder, said = kept(script, tmp_path / "file")
    assert (loaded, folder) == (0, Path("None"))
    assert [line.partition(": ")[2].partition(": ")[0] for line in said] == ["no cache for machine code"]
    assert (tmp_path / "file").read_text() == ""


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("names", "loaded"), [("keys", 4), ("compiled-*", 0)])
def test_a_file_in_place_of_a_folder_of_the_cache_is_no_fault(
    names: str, loaded: int, script: Path, tmp_path: Path, sound: Path
) -> None:
    shutil.copytree(sound, tmp_path / "root")
    for path in (tmp_path / "root").glob(names):
        shutil.rmtree(path)
        path.touch()
    found, _, said = kept(script, tmp_path / "root")
    assert found == loaded
    assert len(said) <= 1


def test_a_full_disk_costs_the_cache_and_one_line(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def full(path: Path, write: Callable[[Path], object]) -> Path:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    monkeypatch.setattr(sealed_files, "write_atomically", full)
    sealed_files.tell.cache_clear()
    kept_code = code.Kept("never-kept")
    kept_code.write(b"code")
    assert kept_code.read() is None
    assert capsys.readouterr().err.endswith(f"cannot be kept in {code.cache_folder()}: No space left on device; {LATER}\n")


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
    path = tmp_path / "kept.o"
    write_sealed(path, b"code")
    assert read_sealed(path) == b"code"
    if stands not in ("a link to a sound file", "a file larger than any"):
        path.unlink()
    NOT_READ[stands](path)
    found: list[object] = []
    reader = Thread(target=lambda: found.extend([read_sealed(path), os.path.lexists(path)]), daemon=True)
    reader.start()
    reader.join(20.0)
    assert found == [None, False]


def test_what_is_larger_than_any_file_of_the_cache_is_not_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sealed_files, "LARGEST_FILE", 100)
    for size, there in ((10, True), (100, False)):  # the seal is part of the file
        write_sealed(tmp_path / str(size), bytes(size))
        assert (tmp_path / str(size)).exists() == there


def test_a_file_of_another_user_is_not_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "kept.o"
    write_sealed(path, b"code")
    monkeypatch.setattr("os.geteuid", lambda: 12345)
    assert read_sealed(path) is None
    assert not path.exists()


def test_a_draft_that_is_a_pipe_holds_up_nobody(tmp_path: Path) -> None:
    pipe = tmp_path / f"{DRAFT}0"
    os.mkfifo(pipe)
    os.utime(pipe, (0.0, 0.0))
    writer = Thread(target=write_sealed, args=(tmp_path / "kept.o", b"code"), daemon=True)
    writer.start()
    writer.join(20.0)
    assert read_sealed(tmp_path / "kept.o") == b"code"
    assert not pipe.exists()


def test_a_long_process_looks_again_at_the_size_of_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A process that has written 10 MB since it last looked removes what has not been used for longest."""
    folder = tmp_path / "compiled-0"
    folder.mkdir()
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(code, "cache_folder", lambda: folder)
    monkeypatch.setattr(code, "TIDY", code.Tidy())
    monkeypatch.setattr(code.make_room, "__defaults__", (12_000_000,))
    sizes = []
    for n in range(30):
        code.Kept(f"formula{n}", "text").write(bytes(1_000_000))
        sizes.append(sum(path.stat().st_size for path in folder.iterdir()))
    assert max(sizes) <= 12_000_000 + code.LOOK_AFTER
    assert sizes[-1] < 30_000_000  # all that was written


def test_the_cache_keeps_the_files_that_were_used_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STICKSLIP_CACHE_DIR", str(tmp_path))
    folder = tmp_path / "compiled-0" / "plain" / "formulas_0"  # as other versions had them
    folder.mkdir(parents=True)
    for used, file in enumerate([folder / "old.o", folder / "older.o", tmp_path / "compiled-0" / "new.o"], 1000):
        file.write_bytes(bytes(100))
        os.utime(file, (used, used))
    os.utime(folder / "old.o", (2000, 2000))  # read since
    for file in (folder / "own.txt", tmp_path / "own.o"):
        file.touch()
    code.make_room(250)
    assert {path.stem for path in tmp_path.rglob("*.o")} == {"old", "new", "own"}
    code.make_room(100)
    assert {path.stem for path in tmp_path.rglob("*.o")} == {"old", "own"}
    assert (folder / "own.txt").exists()


def test_a_file_that_is_read_counts_as_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code, "cache_folder", lambda: tmp_path)
    one = code.Kept("one")
    one.write(b"code")
    os.utime(tmp_path / one.file, (1000, 1000))
    assert one.read() == b"code"
    assert (tmp_path / one.file).stat().st_mtime > 2000


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
