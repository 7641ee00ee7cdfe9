"""Ctrl-C while modules are imported, and readers that stop reading, end a command quietly."""

import os
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

from stickslip.cli.main import main
from stickslip.engine.compile.cache import SLOW

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
        ("typer", ["--help"]),
        ("rich", ["run", "fig6-slab"]),
        ("stickslip.cli.commands.sweep", ["run", "fig6-slab"]),
        ("numpy", ["run", "fig6-slab"]),
        ("stickslip.scenarios.examine", ["check", "fig6-slab"]),
        ("numba", ["run", "fig6-slab"]),
        ("stickslip.run.simulate", ["run", "fig6-slab"]),
        ("h5netcdf", ["run", "fig6-slab", "--out", "a.nc"]),
        ("matplotlib", ["check", "fig6-slab", "--figure", "k.png"]),
    ],
)
def test_ctrl_c_during_imports_is_quiet(tmp_path: Path, module: str, arguments: list[str]):
    code = INTERRUPT_AT.format(module=module, arguments=arguments)
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 130
    assert done.stderr in ("", "stickslip: interrupted\n")
    assert list(tmp_path.iterdir()) == []


UNHEARD = """
import os, sys
from stickslip.cli.main import main
main(sys.argv[1:])
"""


def run_unheard(arguments: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command whose standard output nobody reads: the reading end of its pipe is closed from the start."""
    reading, writing = os.pipe()
    os.close(reading)
    try:
        return subprocess.run(
            [sys.executable, "-c", UNHEARD, *arguments], cwd=folder, stdout=writing, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(writing)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    "arguments", [["--help"], ["run", "--help"], ["--version"], ["new", "--list"], ["new", "slab"], ["check", "fig6-slab"]]
)
def test_output_that_nobody_reads_is_dropped_quietly(tmp_path: Path, arguments: list[str]):
    done = run_unheard(arguments, tmp_path)
    assert (done.returncode, done.stderr) == (0, "")


def test_files_are_written_though_nobody_reads_the_summary(tmp_path: Path):
    done = run_unheard(["run", "fig6-slab", "--out", "a.nc", "--figure", "a.svg"], tmp_path)
    said = [line for line in done.stderr.splitlines() if line.removeprefix("stickslip: ") not in SLOW.values()]
    assert (done.returncode, said) == (0, [])
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.nc", "a.svg"]


def test_a_mistake_has_its_exit_code_though_nobody_reads(tmp_path: Path):
    done = run_unheard(["run", "fig6-slap"], tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith("stickslip: fig6-slap: no such file")


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
