"""Every failure is one line on standard error and an exit code, and nothing is written."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.scenarios.templates import template
from stickslip.trajectory.status import STATUSES
from tests.messages import places_twice

BAD = template("slab").replace("thickness =", "thicknes =")
FOUR_KEYS = [word for name in ("alpha", "static", "dynamic", "thickness") for word in ("-v", f"{name}=0.1,0.2")]
CASES = [
    (["rn"], "there is no command 'rn'; did you mean 'run'?"),
    (["frobnicate"], "there is no command 'frobnicate'; allowed: analogy, benchmark, check, compare, doctor, ensemble, explore,"),
    (["fig6-slab"], "'fig6-slab' is a scenario, not a command: did you mean `stickslip run fig6-slab` or `stickslip check fig6-"),
    (["run"], "run: nothing to run: give a SCENARIO, or --resume FILE"),
    (["run", "fig6-slab", "--figur", "a.png"], "run: there is no option --figur; did you mean '--figure'? `stickslip run --help`"),
    (["run", "fig6-slab", "--catalog", "a.csv"], "run: there is no option --catalog; did you mean '--catalogue'?"),
    (["run", "fig6-slab", "-q"], "run: there is no option -q; `stickslip run --help` explains it, with examples"),
    (["--versio"], "there is no option --versio; did you mean '--version'? `stickslip --help` shows all"),
    (["run", "fig6-slab", "--duration", "480", "years"], "run: 'years' is not expected; put a text with spaces in quotes, as "),
    (["run", "fig6-slab", "alpha=2"], "run: 'alpha=2' is not expected; --set NAME=VALUE replaces a value of the scenario;"),
    (["run", "fig6-slab", "--set", "alpha"], 'run: --set must be NAME=VALUE, as "friction.alpha=2" or "body.thickness=5 km", got'),
    (["run", "fig6-slab", "--set", "alpha=1", "--set", "alpha=2"], "run: --set: 'alpha' is given twice"),
    (["check", "fig6-slab", "--set", "alpa=1"], "check: --set: 'alpa' is not a parameter of this scenario; did you mean 'alpha'?"),
    (["sweep", "fig6-slab", "--set", "alpha=-1", "-v", "static=0.7,0.8"], "sweep: --set: friction.alpha must be at least 0 s/m"),
    (["ensemble", "fig6-slab", "--set", "thickness=5 s"], "ensemble: --set: body.thickness must be a number in m or a text with"),
    (
        ["run", "--resume", "a.nc", "--set", "alpha=1"],
        "run: --resume goes on as the run began: leave out --set, --rtol, --creep-rtol",
    ),
    (["explore", "--static", "tour", "--set", "alpha=1"], "explore: --static writes the guided tour, which has scenarios of its"),
    (["run", "fig6-slab", "--duration"], "Option '--duration' needs a value"),
    (["run", "fig6-slab", "--duration", "12,5"], "run: --duration must be a number in s or a text with a unit such as"),
    (["run", "fig6-slab", "--events", "1.5"], "run: --events must be a whole number, got '1.5'"),
    (["run", "fig6-slab", "--max-pieces", "0"], "run: --max-pieces must be a whole number, at least 1, got '0'"),
    (["run", "fig6-slab", "--rtol", "1,5"], "run: --rtol must be a number, got '1,5': write 1.5"),
    (["run", "fig6-slab", "--figure", "a.png", "--path", "./a.png"], "--path a.png: is already the file of --figure"),
    (["run", "fig6-slab", "--out", f"{'a' * 300}.nc"], f"--out {'a' * 60}: cannot be a file: File name too long"),
    (["run", "fig6-slab", "--figure", "folder.png"], "--figure folder.png: is a folder"),
    (["run", "fig6-slab", "--figure", "pipe.png"], "--figure pipe.png: exists and is not an ordinary file"),
    (["run", "fig6-slab", "--catalogue", "folder.csv"], "--catalogue folder.csv: is a folder"),
    (["compare", "fig6-slab", "fig6-slab", "--figure", "pipe.png"], "--figure pipe.png: exists and is not an ordinary file"),
    (["export", "fig6-slab", "folder.txt"], "FILE folder.txt: is a folder"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "bad.zarr"], "--out bad.zarr: is a file, where a sweep needs a folder"),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1", "--figure", "a.png"],
        "sweep: --figure draws one to three keys, but here no key",
    ),
    (["sweep", "fig6-slab", *FOUR_KEYS, "--figure", "a.png"], "sweep: --figure draws one to three keys, but here 4 keys vary"),
    (["run", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean 'fig6-slab'?"),
    (["check", "fig6-slap"], "fig6-slap: no such file"),
    (["check", "."], ".: is a folder, not a scenario; its scenarios: bad.toml"),
    (["new", "--friction", "coulomb"], "new: which scenario? `stickslip new --list` lists them"),
    (["new", "blok"], "no scenario 'blok'; did you mean 'block'?"),
    (["run", "fig6-slab", "--out", "a.csv"], "--out a.csv: the name must end in .nc"),
    (["run", "fig6-slab", "--out", "no/a.nc"], "--out no/a.nc: there is no folder no"),
    (["run", "fig6-slab", "--figure", "a.xyz"], "--figure a.xyz: the name must end in .png or .pdf or .svg"),
    (["run", "fig6-slab", "--out", "a.nc", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
    (["run", "fig6-slab", "--duration", "10 kg"], "run: --duration must be a number in s or a text with a unit"),
    (["run", "fig6-slab", "--duration", "0"], "run: --duration must be greater than 0 s, got 0"),
    (["run", "fig6-slab", "--duration", "nan"], "run: --duration must be finite, got nan"),
    (["run", "fig6-slab", "--rtol", "1"], "run: --rtol must be at most 0.01, got 1"),
    (
        ["run", "block-or-slab", "--creep-rtol", "1e-6"],
        "run: --creep-rtol must be 0 here: leaps over creep need a friction law of slip alone (FromExpression is not one)",
    ),
    (
        ["run", "fig6-block-printed", "--shortest-event", "1 ms"],
        "run: --shortest-event must be 0 here: only under a slab with a",
    ),
    (["run", "fig6-slab", "--energy"], "run: --energy belongs to --catalogue FILE"),
    (
        ["run", "fig5-slab-printed", "--energy", "--creep-rtol", "1e-6", "--catalogue", "events.csv"],
        "run: --energy and --creep-rtol exclude each other",
    ),
    (["run", "fig6-slab", "--shortest-event", "1 s"], "run: --shortest-event must be 0 or at most 0.0571429 s (1 % of the two-way"),
    (["run", "fig6-slab", "--shortest-event", "1 parsec"], "run: --shortest-event"),
    (
        ["run", "cycles-block", "--creep-rtol", "1e-6"],
        "run: --creep-rtol must be 0 here: leaps over creep need a slab, which creeps",
    ),
    (["run", "fig5-slab-printed", "--creep-rtol=-1"], "run: --creep-rtol must be 0 (no leaps over creep, every round trip is run)"),
    (["run", "fig6-slab", "--rtol", "much"], "run: --rtol must be a number, got 'much'"),
    (["run", "fig6-slab", "--selection", "maxwel"], "run: --selection 'maxwel' is unknown; did you mean 'maxwell'?"),
    (["run", "bad.toml", "--out", "a.nc"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["check", "bad.toml"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["check", "\x1b[31mred.toml"], "'\\x1b[31mred.toml': no such file"),
    (["run", "fig6-slab", "--dpi", "300"], "--dpi needs a figure: name its file, say --figure NAME.png"),
    (["run", "fig6-slab", "--size", "16 x 10 cm", "--animation", "a.gif"], "--size needs a figure"),
    (["run", "fig6-slab", "--figure", "a.png", "--dpi", "3"], "--dpi: must be a number of dots per inch from 10 to 2400, got 3"),
    (["check", "fig6-slab", "--figure", "a.png", "--size", "16 x 10"], "--size: must be two lengths in inches, a text such as"),
    (["compare", "fig6-slab", "fig4-loop", "-f", "a.png", "--size", "1 x 2 mm"], "--size: each side must be from 2 cm to 2 m"),
    (["check", "fig6-slab", "--figure", "a.txt"], "--figure a.txt: the name must end in .png or .pdf or .svg"),
    (
        ["check", "fig6-block-printed", "--figure", "a.png"],
        "figure of the set K: the slip rate does not follow from the load alone",
    ),
    (["run", "fig6-block-printed", "--path", "a.png"], "run: --path needs a slab without contact mass"),
    (["check", "fig6-slab", "--map", "alpha=1..2"], "check: a map needs two --map and a --figure, got 1 and none"),
    (["check", "fig6-slab", *2 * ["--map", "alpha=1..2"]], "check: a map needs two --map and a --figure, got 2 and none"),
    (["check", "fig6-slab", *2 * ["--map", "alpha=1..2"], "--figure", "a.png"], "regime map: needs two different parameters"),
    (
        ["check", "fig6-slab", "--map", "alpa=1..2", "--map", "static=0.1..1", "--figure", "a.png"],
        "check: --map: parameter 'alpa' is unknown; did you mean 'alpha'?",
    ),
    (
        ["check", "fig6-slab", "--map", "alpha:1-2", "--map", "static=0.1..1", "--figure", "a.png"],
        "check: --map must be NAME=LOW..HIGH[:POINTS][:log], as",
    ),
    (
        ["check", "fig6-slab", "--map", "thickness=1 kg..2 km", "--map", "static=0.1..1", "--figure", "a.png"],
        "check: --map: body.thickness must be a number in m or a text with a unit",
    ),
    (["run", "cycles-block", "--space-time", "a.png"], "run: --space-time needs a slab: a block is rigid"),
    (["run", "cycles-block", "--animation", "a.gif"], "run: --animation needs a slab: a block is rigid"),
    (["run", "fig6-slab", "--animation", "a.avi"], "--animation a.avi: the name must end in .gif or .mp4 or .webm"),
    (["run", "fig6-slab", "--animation", "no/a.gif"], "--animation no/a.gif: there is no folder no"),
    (["run", "fig6-slab", "--space-time", "a.gif"], "--space-time a.gif: the name must end in .png or .pdf or .svg"),
    (
        ["run", "fig6-slab", "--catalogue", "a.csv", "--animation", "a.gif", "--figure", "a.png"],
        "run: a catalogue keeps slip events only, no history: leave out --figure, --animation",
    ),
    (["paper", "--out", "bad.toml/paper"], "--out bad.toml/paper:"),
    (["compare"], "compare: RUNS is missing; `stickslip compare --help` explains it, with examples"),
    (["compare", "fig6-slab"], "compare: needs two runs or more, got 1"),
    (["compare", "fig6-slab", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["compare", "fig6-slab", "no.nc"], "no.nc: no such file"),
    (["compare", "fig6-slab", "bad.toml"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["compare", "fig6-slab", "fig6-slab", "--event", "1"], "compare: fig6-slab has no slip event 1: it has 1, counted from 0"),
    (["compare", "fig6-slab", "fig6-slab", "--out", "a.nc"], "--out a.nc: the name must end in .csv"),
    (
        ["compare", "fig6-slab", "fig6-slab", "--duration", "1 kg"],
        "compare: --duration must be a number in s or a text with a unit",
    ),
    (["analogy", "fig6-slab"], 'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got 0'),
    (["analogy", "fig6-slab", "--map", "alpha=1..2", "--map", "alpha=1..2"], "analogy: needs two different parameters"),
    (["analogy", "fig6-block-printed", *2 * ["--map", "mass=1..2"]], "analogy: needs two different parameters"),
    (["analogy", "fig4-loop", "--map", "alpha=1..2", "--map", "static=1..2"], "ElasticSlab: equivalent_block needs a rigid driver"),
    (
        ["analogy", "fig6-slab", "--map", "alpa=1..2", "--map", "static=1..2"],
        "analogy: --map: parameter 'alpa' is unknown; did you mean 'alpha'?",
    ),
    (["export", "fig6-slab", "a.csv"], "FILE a.csv: the name must end in .txt or .dat"),
    (["export", "fig6-slap", "a.txt"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["export", "fig6-slab", "a.txt", "-r", "0"], "sampling rate must be a positive number of samples a second, got 0.0"),
    (["export", "second-event-maxwell", "a.txt"], "1.51e+12 samples are too many: use a lower rate, or a single event"),
    (["export", "fig6-slab", "a.txt", "--event", "1"], "window: no event 1: the run has 1, 0 to 0"),
    (["benchmark", "get", "loop", "--out", "a.csv"], "benchmark: --out does not belong to get: get writes files to --folder"),
    (["benchmark", "list", "--folder", "x"], "benchmark: --folder does not belong to list: leave it out"),
    (["check", "planar-patch", "--set", "duration=1e20 years"], "check: --set: [contact] 3.15576e+27 s are 1.41e+29 time steps"),
    (["check", "planar-patch", "--set", "thickness=1e-40"], "check: --set: [contact] 8 s are 1.4e+44 time steps, allowed are"),
    (["run", "planar-patch", "--set", "wave_speed=1e40"], "run: --set: [contact] "),
    (["benchmark", "get", "lop"], "benchmark: there is no problem 'lop'; did you mean 'loop'?"),
    (["benchmark", "gte"], "benchmark: there is nothing called 'gte'; did you mean 'get'?"),
    (["benchmark", "judge"], "benchmark: judge needs a file"),
    (["schemes", "fig4-loop", "--nx", "20;50"], "schemes: --nx must be whole numbers separated by commas"),
    (["schemes", "fig4-loop", "--scheme", "hth"], "schemes: there is no scheme 'hth'; did you mean 'hht'?"),
    (["schemes", "fig4-loop", "--scheme", "theta,theta"], "schemes: the scheme 'theta' is given twice"),
    (["schemes", "fig4-loop", "--scheme", "all,theta"], "schemes: the scheme 'theta' is given twice"),
    (["schemes", "fig5-slab-printed", "--scheme", "lag"], "schemes: lag does not suit sinusoidal-slip friction"),
    (["schemes", "fig4-lop"], "fig4-lop: no such file, and no bundled scenario of that name; did you mean 'fig4-loop'?"),
    (["schemes", "fig6-block-printed"], "schemes: a block has no grid"),
    (["schemes", "cycles-slab"], "schemes: a contact_mass of"),
    (["schemes", "fig4-loop", "--rtol", "1"], "schemes: --rtol must be at most 0.01, got 1"),
    (["schemes", "fig4-loop", "--out", "a.txt"], "--out a.txt: the name must end in .csv"),
    (["schemes", "fig4-loop", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
    (["schemes", "fig4-loop", "--nx", ""], "schemes: --nx must be whole numbers separated by commas"),
    (["schemes", "fig4-loop", "--series", "a.csv", "--nx", "20"], "schemes: --nx is for schemes of stickslip: leave it out with"),
    (["ensemble", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean 'fig6-slab'?"),
    (["ensemble", "fig6-slab", "--members", "0"], "ensemble: members must be a whole number from 1 to 1000, got 0"),
    (["ensemble", "fig6-slab", "--members", "many"], "ensemble: --members must be a whole number, got 'many'"),
    (["ensemble", "fig6-slab", "--size", "1"], "ensemble: size must lie between 1e-15 and 0.01, got 1.0"),
    (["ensemble", "fig6-slab", "--seed", "-1"], "ensemble: seed must be a whole number, 0 or more, got -1"),
    (["ensemble", "fig6-slab", "--duration", "1 kg"], "ensemble: --duration must be a number in s or a text with a unit"),
    (["ensemble", "fig6-slab", "--events", "0"], "ensemble: --events must be"),
    (["ensemble", "fig6-slab", "--rtol", "1"], "ensemble: --rtol must be at most 0.01, got 1"),
    (["ensemble", "fig6-slab", "--out", "a.txt"], "--out a.txt: the name must end in .csv"),
    (["ensemble", "fig6-slab", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command, tmp_path: Path, arguments: list[str], message: str):
    (tmp_path / "bad.toml").write_text(BAD)
    (tmp_path / "bad.zarr").touch()
    for name in ("folder.png", "folder.csv", "folder.txt"):
        (tmp_path / name).mkdir()
    os.mkfifo(tmp_path / "pipe.png")
    before = sorted(tmp_path.iterdir())
    shown = command(*arguments)
    assert shown.code == 2
    assert shown.out == ""
    assert shown.err.startswith(f"stickslip: {message}")
    assert shown.err.count("\n") == 1
    assert shown.err.strip().isprintable()
    assert not places_twice(shown.err)
    assert sorted(tmp_path.iterdir()) == before


FOREIGN = b"# stick-slip tests, not made by stickslip\ntime,force\n0,1\n"
"""A file of somebody else that a command was told to write by mistake."""


@pytest.mark.parametrize(
    ("arguments", "file"),
    [
        (["run", "fig6-slab", "--catalogue"], "data.csv"),
        (["run", "fig6-slab", "--catalogue"], "data.nc"),
        (["run", "fig6-slab", "--out"], "data.nc"),
        (["compare", "fig6-slab", "fig6-slab", "--out"], "data.csv"),
        (["ensemble", "fig6-slab", "--members", "2", "--out"], "data.csv"),
        (["schemes", "fig4-loop", "--nx", "20", "--out"], "data.csv"),
        (["analogy", "fig6-slab", "--map", "alpha=1..2:2", "--map", "thickness=1..2:2", "--out"], "data.csv"),
        (["export", "fig6-slab"], "data.txt"),
        (["fit", "points.csv", "--out"], "data.toml"),
    ],
    ids=lambda one: one[0] if isinstance(one, list) else one,
)
def test_a_file_of_somebody_else_is_never_replaced(command, tmp_path: Path, arguments: list[str], file: str):
    (tmp_path / file).write_bytes(FOREIGN)
    (tmp_path / "points.csv").write_text("slip,friction\n0,0.6\n1,0.5\n2,0.4\n3,0.4\n")
    shown = command(*arguments, file)
    assert shown.code == 2
    assert f"{file}: exists, and" in shown.err
    assert shown.err.endswith("choose another name, or remove it\n")
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
    for options in (["--out", "a.nc"], ["--catalogue", "a.csv"], ["--catalogue", "b.nc"]):
        assert [command("run", "fig6-slab", *options).code for _ in range(2)] == [0, 0]
    assert [command("compare", "fig6-slab", "fig6-slab", "--out", "c.csv").code for _ in range(2)] == [0, 0]
    assert [command("export", "fig6-slab", "d.txt").code for _ in range(2)] == [0, 0]


def test_a_folder_that_cannot_be_written_is_refused_before_the_run(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("stickslip.cli.output.files.os.access", lambda *_: False)
    monkeypatch.setattr("stickslip.run.simulate.simulate", lambda *_, **__: pytest.fail("ran"))
    shown = command("run", "fig6-slab", "--out", "a.nc")
    assert (shown.code, shown.err) == (2, "stickslip: --out a.nc: the folder . is not writable\n")


def test_a_write_protected_file_is_refused_before_the_run(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "a.nc").touch()
    monkeypatch.setattr("stickslip.cli.output.files.os.access", lambda path, mode: Path(path).is_dir() or mode != os.W_OK)
    monkeypatch.setattr("stickslip.run.simulate.simulate", lambda *_, **__: pytest.fail("ran"))
    shown = command("run", "fig6-slab", "--out", "a.nc")
    assert (shown.code, shown.err) == (2, "stickslip: --out a.nc: exists and is write-protected: choose another name\n")


def test_a_folder_that_refuses_files_is_found_before_the_run(command, monkeypatch: pytest.MonkeyPatch):
    def refuses(**_: object) -> None:
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr("stickslip.cli.output.files.TemporaryFile", refuses)
    monkeypatch.setattr("stickslip.run.simulate.simulate", lambda *_, **__: pytest.fail("ran"))
    shown = command("run", "fig6-slab", "--figure", "a.png")
    assert (shown.code, shown.out) == (2, "")
    assert shown.err == "stickslip: --figure a.png: nothing can be written in the folder .: Read-only file system\n"


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
    assert shown.code == 2
    assert shown.err.count("\n") == 1
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
