"""Every failure is one line on standard error and an exit code, and nothing is written."""

from pathlib import Path

import pytest

from stickslip.scenarios.scenario import Scenario
from stickslip.trajectory.status import STATUSES

CASES = [
    (["rn"], "No such command 'rn'. Did you mean 'run'?"),
    (["run"], "run: what is to be run is missing: a SCENARIO, or --resume FILE"),
    (["run", "fig6-slab", "--figur", "a.png"], "No such option: --figur"),
    (["run", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean 'fig6-slab'?"),
    (["check", "fig6-slap"], "fig6-slap: no such file"),
    (["check", "."], ".: cannot be read: Is a directory"),
    (["new", "--friction", "coulomb"], "new: which scenario? `stickslip new --list` lists them"),
    (["new", "blok"], "no scenario 'blok'; did you mean 'block'?"),
    (["run", "fig6-slab", "--out", "a.csv"], "--out a.csv: the name must end in .nc"),
    (["run", "fig6-slab", "--out", "no/a.nc"], "--out no/a.nc: there is no folder no"),
    (["run", "fig6-slab", "--figure", "a.xyz"], "--figure a.xyz: the name must end in .png or .pdf or .svg"),
    (["run", "fig6-slab", "--out", "a.nc", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
    (["run", "fig6-slab", "--duration", "10 kg"], "run: --until must be a number in s or a text with a unit"),
    (["run", "fig6-slab", "--duration", "0"], "run: --until must be greater than 0 s, got 0"),
    (["run", "fig6-slab", "--duration", "nan"], "run: --until must be finite, got nan"),
    (["run", "fig6-slab", "--rtol", "1"], "run: --rtol must be at most 0.01, got 1"),
    (
        ["run", "fig6-slab", "--creep-rtol", "1e-6"],
        "run: --creep-rtol must be 0 here: leaps over creep need a friction law of slip",
    ),
    (
        ["run", "fig6-block-printed", "--shortest-event", "1 ms"],
        "run: --shortest-event must be 0 here: only under a slab with a",
    ),
    (["run", "fig6-slab", "--energies"], "run: --energies belongs to --catalog FILE"),
    (
        ["run", "fig5-slab-printed", "--energies", "--creep-rtol", "1e-6", "--catalog", "events.csv"],
        "run: --energies and --creep-rtol exclude each other",
    ),
    (["run", "fig6-slab", "--shortest-event", "1 s"], "run: --shortest-event must be 0 or at most 0.0571429 s (1 % of the two-way"),
    (["run", "fig6-slab", "--shortest-event", "1 parsec"], "run: --shortest-event"),
    (["run", "fig6-block-printed", "--creep-rtol", "1e-6"], "run: --creep-rtol must be 0 here: leaps over creep need a slab"),
    (["run", "fig5-slab-printed", "--creep-rtol=-1"], "run: --creep-rtol must be 0 (no leaps over creep, every round trip is run)"),
    (["run", "fig6-slab", "--rtol", "much"], "Invalid value for '--rtol'"),
    (["run", "fig6-slab", "--selection", "maxwel"], "run: --selection 'maxwel' is unknown; did you mean 'maxwell'?"),
    (["run", "bad.toml", "--out", "a.nc"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["check", "bad.toml"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["check", "\x1b[31mred.toml"], "'\\x1b[31mred.toml': no such file"),
    (["run", "fig6-slab", "--dpi", "300"], "--dpi is the look of a figure: name the file of one, say --figure NAME.png"),
    (["run", "fig6-slab", "--size", "16 x 10 cm", "--animation", "a.gif"], "--size is the look of a figure"),
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
        ["run", "fig6-slab", "--catalog", "a.csv", "--animation", "a.gif", "--figure", "a.png"],
        "run: a catalogue keeps slip events only, no history: leave --figure, --animation away",
    ),
    (["paper", "--out", "bad.toml/paper"], "--out bad.toml/paper:"),
    (["compare"], "Missing argument"),
    (["compare", "fig6-slab"], "compare: needs two runs or more, got 1"),
    (["compare", "fig6-slab", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["compare", "fig6-slab", "no.nc"], "no.nc: no such file"),
    (["compare", "fig6-slab", "bad.toml"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["compare", "fig6-slab", "fig6-slab", "--event", "1"], "compare: fig6-slab has no slip event 1: it has 1, counted from 0"),
    (["compare", "fig6-slab", "fig6-slab", "--out", "a.nc"], "--out a.nc: the name must end in .csv"),
    (["compare", "fig6-slab", "fig6-slab", "--until", "1 kg"], "compare: --until must be a number in s or a text with a unit"),
    (["analogy", "fig6-slab"], 'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got 0'),
    (["analogy", "fig6-slab", "--map", "alpha=1..2", "--map", "alpha=1..2"], "analogy: needs two different parameters"),
    (["analogy", "fig6-block-printed", *2 * ["--map", "mass=1..2"]], "analogy: needs two different parameters"),
    (["analogy", "fig4-loop", "--map", "alpha=1..2", "--map", "static=1..2"], "ElasticSlab: equivalent_block needs a rigid driver"),
    (
        ["analogy", "fig6-slab", "--map", "alpa=1..2", "--map", "static=1..2"],
        "analogy: --map: parameter 'alpa' is unknown; did you mean 'alpha'?",
    ),
    (["export", "fig6-slab", "a.csv"], "FILE a.csv: the name must end in .txt or .dat or .mseed or .sac"),
    (["export", "fig6-slap", "a.txt"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["export", "fig6-slab", "a.txt", "-r", "0"], "sampling rate must be a positive number of samples a second, got 0.0"),
    (["export", "second-event-maxwell", "a.txt"], "1.51e+12 samples are too many: use a lower rate, or a single event"),
    (["export", "fig6-slab", "a.txt", "--event", "1"], "window: no event 1: the run has 1, 0 to 0"),
    (["regularise", "fig4-lop"], "fig4-lop: no such file, and no bundled scenario of that name; did you mean 'fig4-loop'?"),
    (["regularise", "fig6-block-printed"], "regularise: a block has inertia, which makes its slip rate unique"),
    (["regularise", "cycles-slab"], "regularise: a contact_mass of"),
    (["regularise", "fig5-slab-printed", "--by", "lag"], "regularise: 'lag' needs a smooth law of slip rate only"),
    (["regularise", "fig4-loop", "--by", "lagg"], "regularise: there is no regularisation 'lagg'; did you mean 'lag'?"),
    (["regularise", "fig4-loop", "--count", "2"], "regularise: --count must lie between 3 and 100, got 2"),
    (["regularise", "fig4-loop", "--largest", "1 us"], "regularise: --smallest must be less than --largest"),
    (["regularise", "fig4-loop", "--smallest", "1 kg"], "regularise: --smallest must be a number in s or a text with a unit"),
    (["regularise", "fig4-loop", "--rtol", "1"], "regularise: --rtol must be at most 0.01, got 1"),
    (["regularise", "fig4-loop", "--out", "a.txt"], "--out a.txt: the name must end in .csv"),
    (["regularise", "fig4-loop", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
    (["ensemble", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean 'fig6-slab'?"),
    (["ensemble", "fig6-slab", "--members", "0"], "ensemble: members must be a whole number from 1 to 1000, got 0"),
    (["ensemble", "fig6-slab", "--members", "many"], "Invalid value for '--members'"),
    (["ensemble", "fig6-slab", "--size", "1"], "ensemble: size must lie between 1e-15 and 0.01, got 1.0"),
    (["ensemble", "fig6-slab", "--seed", "-1"], "ensemble: seed must be a whole number, 0 or more, got -1"),
    (["ensemble", "fig6-slab", "--until", "1 kg"], "ensemble: --until must be a number in s or a text with a unit"),
    (["ensemble", "fig6-slab", "--events", "0"], "ensemble: --events must be"),
    (["ensemble", "fig6-slab", "--rtol", "1"], "ensemble: --rtol must be at most 0.01, got 1"),
    (["ensemble", "fig6-slab", "--out", "a.txt"], "--out a.txt: the name must end in .csv or .nc"),
    (["ensemble", "fig6-slab", "--figure", "no/a.png"], "--figure no/a.png: there is no folder no"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command, tmp_path: Path, arguments: list[str], message: str):
    (tmp_path / "bad.toml").write_text(command("new", "slab").out.replace("thickness =", "thicknes ="))
    shown = command(*arguments)
    assert shown.code == 2
    assert shown.out == ""
    assert shown.err.startswith(f"stickslip: {message}")
    assert shown.err.count("\n") == 1
    assert shown.err.strip().isprintable()
    assert [path.name for path in tmp_path.iterdir()] == ["bad.toml"]


def test_a_folder_that_cannot_be_written_is_refused_before_the_run(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("stickslip.cli.output.files.os.access", lambda *_: False)
    monkeypatch.setattr(Scenario, "run", lambda *_: pytest.fail("ran"))
    shown = command("run", "fig6-slab", "--out", "a.nc")
    assert (shown.code, shown.err) == (2, "stickslip: --out a.nc: the folder . is not writable\n")


def test_ctrl_c_gives_one_line(command, monkeypatch: pytest.MonkeyPatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr(Scenario, "run", interrupted)
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
    original = Scenario.run

    def failing(self, progress=None, **keep):
        solution = original(self, progress, **keep)
        object.__setattr__(solution, "status", status)
        return solution

    monkeypatch.setattr(Scenario, "run", failing)
    shown = command("run", "fig6-slab")
    assert shown.code == (130 if status.name == "interrupted" else 1)
    assert status.message in shown.out
    assert "1 slip event" in shown.out
