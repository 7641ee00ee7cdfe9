"""What fails while a command works is one line on standard error and an exit code, and nothing is half written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.problem.run_status import STATUSES

FOREIGN = b"# stick-slip tests, not made by stickslip\ntime,force\n0,1\n"
"""A file of somebody else that a command was told to write by mistake."""


@pytest.mark.parametrize(
    ("arguments", "file"),
    [
        (["run", "fig6-slab", "--catalogue"], "data.csv"),
        (["run", "fig6-slab", "--catalogue"], "data.nc"),
        (["run", "fig6-slab", "--out"], "data.nc"),
        (["export", "fig6-slab"], "data.txt"),
    ],
    ids=lambda one: one[0] if isinstance(one, list) else one,
)
def test_a_file_of_somebody_else_is_never_replaced(command, tmp_path: Path, arguments: list[str], file: str):
    (tmp_path / file).write_bytes(FOREIGN)
    (tmp_path / "points.csv").write_text("slip,friction\n0,0.6\n1,0.5\n2,0.4\n3,0.4\n")
    said = command(*arguments, file).refusal
    assert f"{file}: exists, and" in said
    assert said.endswith("choose another name, or remove it\n")
    assert (tmp_path / file).read_bytes() == FOREIGN


def test_python_replaces_no_file_of_somebody_else_either(tmp_path: Path):
    for name in ("data.csv", "data.nc", "a.rows.csv"):
        (tmp_path / name).write_bytes(FOREIGN)
    for call, name in (
        (lambda: ss.catalogue("fig6-slab", path=tmp_path / "data.csv"), "data.csv"),
        (lambda: ss.catalogue("fig6-slab", path=tmp_path / "a.nc"), "a.rows.csv"),
        (lambda: ss.simulate("fig6-slab", checkpoint=tmp_path / "data.nc"), "data.nc"),
    ):
        with pytest.raises(ss.InputError, match=f"{name}: exists, and stickslip did not write it"):
            call()
        assert (tmp_path / name).read_bytes() == FOREIGN


def test_results_of_an_earlier_run_are_replaced(command):
    for options in (["--out", "a.nc"], ["--catalogue", "b.nc"]):
        assert [command("run", "fig6-slab", *options).code for _ in range(2)] == [0, 0]
    assert [command("export", "fig6-slab", "d.txt").code for _ in range(2)] == [0, 0]


def refuses(**_: object) -> None:
    raise OSError(30, "Read-only file system")


@pytest.mark.parametrize(
    ("name", "put", "said"),
    [
        ("stickslip.cli.output.files.os.access", lambda *_: False, "the folder . is not writable"),
        (
            "stickslip.cli.output.files.os.access",
            lambda path, mode: Path(path).is_dir() or mode != os.W_OK,
            "exists and is write-protected: choose another name",
        ),
        ("tempfile.TemporaryFile", refuses, "nothing can be written in the folder .: Read-only file system"),
    ],
)
def test_what_cannot_be_written_is_refused_before_the_run(command, monkeypatch: pytest.MonkeyPatch, name: str, put, said: str):
    if "exists" in said:
        Path("a.nc").touch()
    monkeypatch.setattr(name, put)
    monkeypatch.setattr("stickslip.run.simulate.simulate", lambda *_, **__: pytest.fail("ran"))
    assert command("run", "fig6-slab", "--out", "a.nc").refusal == f"--out a.nc: {said}\n"


def test_ctrl_c_gives_one_line(command, monkeypatch: pytest.MonkeyPatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("stickslip.run.simulate.simulate", interrupted)
    shown = command("run", "fig6-slab")
    assert (shown.code, shown.out, shown.err) == (130, "", "stickslip: interrupted\n")


def test_a_full_disk_gives_one_line_and_leaves_no_half_file(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def fails(self, path, **_):
        Path(path).write_text("half")
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr("matplotlib.figure.Figure.savefig", fails)
    shown = command("run", "fig6-slab", "--figure", "a.png")
    assert (shown.code, shown.err.count("\n")) == (2, 1)
    assert "No space left on device" in shown.err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("status", [status for status in STATUSES.values() if not status.ok], ids=lambda status: status.name)
def test_a_run_that_fails_shows_what_it_has_and_says_so(command, monkeypatch: pytest.MonkeyPatch, status):
    original = ss.simulate

    def failing(scenario, **keep):
        solution = original(scenario, **keep)
        object.__setattr__(solution, "status", status)
        return solution

    monkeypatch.setattr("stickslip.run.simulate.simulate", failing)
    shown = command("run", "fig6-slab")
    assert shown.code == (130 if status.name == "interrupted" else 1)
    assert status.message in shown.out
    assert "1 slip event" in shown.out


def test_a_typer_that_cannot_serve_gets_one_line() -> None:
    spoilt = "import typer.core as m; del m.TyperArgument\nfrom stickslip.cli.main import main\nmain(['--version'])"
    done = subprocess.run([sys.executable, "-c", spoilt], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert done.stderr.startswith("stickslip: typer ")
    assert "cannot import name 'TyperArgument'" in done.stderr
    assert "pip install 'typer>=0.29,<0.30'" in done.stderr
