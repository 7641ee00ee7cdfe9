"""Ctrl-C while modules are imported, and readers that stop reading, end a command quietly."""

import os
import runpy
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from stickslip.cli.main import main

INTERRUPT_AT = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)

class Interrupting:
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            signal.raise_signal(signal.SIGINT)

sys.meta_path.insert(0, Interrupting())
from stickslip.cli.main import main
main({arguments!r})
"""


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(
    ("module", "arguments"),
    [
        ("rich", ["run", "fig6-slab"]),
        ("numpy", ["run", "fig6-slab"]),
        ("stickslip.run.check.examine", ["check", "fig6-slab"]),
        ("numba", ["run", "fig6-slab"]),
        ("h5py", ["run", "fig6-slab", "--out", "a.nc"]),
    ],
)
def test_ctrl_c_during_imports_is_quiet(tmp_path: Path, module: str, arguments: list[str]):
    code = INTERRUPT_AT.format(module=module, arguments=arguments)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 130
    assert done.stderr in ("", "stickslip: interrupted\n")
    assert list(tmp_path.iterdir()) == []


@pytest.fixture
def unheard(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Standard output goes into a pipe whose reading end is closed from the start."""
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w", encoding="utf-8") as stream:
        monkeypatch.setattr(sys, "stdout", stream)
        yield
        monkeypatch.undo()


@pytest.mark.usefixtures("unheard")
@pytest.mark.parametrize(
    ("arguments", "code", "said", "files"),
    [
        (["--help"], 0, "", []),
        (["new", "--list"], 0, "", []),
        (["run", "fig6-slab", "--out", "a.nc", "--figure", "a.svg"], 0, "", ["a.nc", "a.svg"]),
        (["run", "fig6-slap"], 2, "stickslip: fig6-slap: no such file", []),
    ],
)
def test_what_nobody_reads_is_dropped_quietly_and_all_else_is_done(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
    arguments: list[str],
    code: int,
    said: str,
    files: list[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    error = capfd.readouterr().err
    assert ended.value.code == code
    assert error.startswith(said)
    assert bool(error) == bool(said)
    assert sorted(path.name for path in tmp_path.iterdir()) == files


def test_a_process_that_nobody_reads_ends_quietly(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as unread:
        command = [sys.executable, "-m", "stickslip", "new", "slab"]
        done = subprocess.run(command, cwd=tmp_path, stdout=unread, stderr=subprocess.PIPE, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


ENDING = """
import atexit, sys
import stickslip.cli.main as main
def told(): print("tidied up", file=sys.stderr)
def last(): print("taken apart", file=sys.stderr)
atexit.register(last)
main.main = lambda: (atexit.register(told), print("said"), {ending})
main.command_line()
"""


@pytest.mark.parametrize(
    ("ending", "code", "end"),
    [("sys.exit(3)", 3, []), ("sys.exit('a text')", 1, ["taken apart"]), ("1 / 0", 1, ["taken apart"])],
)
def test_a_process_ends_at_once_with_its_code_when_libraries_have_tidied_up(ending: str, code: int, end: list[str]):
    """What was registered before the command line stands for what Python does later. A code that is no number ends as usual."""
    done = subprocess.run([sys.executable, "-c", ENDING.format(ending=ending)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (code, "said\n")
    assert [line for line in done.stderr.splitlines() if line in ("tidied up", "taken apart")] == ["tidied up", *end]


def test_a_fault_of_the_program_is_told_as_one(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def fails(*_: object, **__: object) -> None:
        assert 1 + 1 == 3, "an assertion of the package"

    monkeypatch.setattr("stickslip.cli.app.app", fails)
    with pytest.raises(SystemExit) as caught:
        main(["run", "fig6-slab"])
    assert caught.value.code == 70
    *trace, line = capsys.readouterr().err.splitlines()
    assert line.startswith("stickslip: this is a fault of the program; please report it")
    assert "an assertion of the package" in "\n".join(trace)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="the system has no /dev/full")
def test_a_full_disk_under_the_summary_is_no_success(tmp_path: Path):
    with Path("/dev/full").open("w", encoding="utf-8") as full:
        command = [sys.executable, "-m", "stickslip", "new", "--list"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False, cwd=tmp_path)
    assert done.returncode != 0
    assert "No space left on device" in done.stderr


def test_ctrl_c_during_the_first_import_ends_without_a_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    class Interrupts:
        def find_spec(self, name: str, *_: object) -> None:
            if name == "stickslip.cli.main":
                raise KeyboardInterrupt

    monkeypatch.delitem(sys.modules, "stickslip.cli.main", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Interrupts(), *sys.meta_path])
    with pytest.raises(SystemExit) as caught:
        runpy.run_module("stickslip", run_name="__main__")
    assert caught.value.code == 130
