"""Every command that cannot be carried out is refused in one line on standard error with exit code 2, and writes nothing."""

import os
from pathlib import Path

import pytest

from stickslip.problem.scenarios.templates import template
from tests.messages import places_twice

BAD = template("slab").replace("thickness =", "thicknes =")
FOUR_KEYS = [word for name in ("alpha", "static", "dynamic", "thickness") for word in ("-v", f"{name}=0.1,0.2")]
CASES = [
    (["rn"], "there is no command 'rn'; did you mean 'run'?"),
    (
        ["frobnicate"],
        "there is no command 'frobnicate'; allowed: compare, doctor, find, fit, new, run and 11 more: `stickslip",
    ),
    (["fig6-slab"], "'fig6-slab' is a scenario, not a command: did you mean `stickslip run fig6-slab` or `stickslip check fig6-"),
    (["run"], "run: nothing to run: give a SCENARIO, or --resume FILE"),
    (["run", "fig6-slab", "--figur", "a.png"], "run: there is no option --figur; did you mean '--figure'? `stickslip run --help`"),
    (["run", "fig6-slab", "-q"], "run: there is no option -q; it is an option of show and sweep; `stickslip run --help` explains"),
    (["--versio"], "there is no option --versio; did you mean '--version'? `stickslip --help` shows all"),
    (["run", "fig6-slab", "--duration", "480", "years"], "run: 'years' is not expected; put a text with spaces in quotes, as "),
    (["run", "fig6-slab", "alpha=2"], "run: 'alpha=2' is not expected; --set NAME=VALUE replaces a value of the scenario;"),
    (["run", "fig6-slab", "--set", "alpha"], 'run: --set must be NAME=VALUE, as "friction.alpha=2" or "body.thickness=5 km", got'),
    (["run", "fig6-slab", "--set", "alpha=1", "--set", "alpha=2"], "run: --set: 'alpha' is given twice"),
    (["check", "fig6-slab", "--set", "alpa=1"], "check: --set: 'alpa' is not a parameter of this scenario; did you mean 'alpha'?"),
    (["explore", "--static", "tour", "--set", "alpha=1"], "explore: --static writes the guided tour, which has scenarios of its"),
    (["run", "fig6-slab", "--duration"], "Option '--duration' needs a value"),
    (["run", "fig6-slab", "--events", "1.5"], "run: --events must be a whole number, got '1.5'"),
    (["run", "fig6-slab", "--max-pieces", "0"], "run: --max-pieces must be a whole number, at least 1, got '0'"),
    (["run", "fig6-slab", "--rtol", "1,5"], "run: --rtol must be a number, got '1,5': write 1.5"),
    (["run", "fig6-slab", "--figure", "a.png", "--path", "./a.png"], "--path a.png: is already the file of --figure"),
    (["run", "fig6-slab", "--out", f"{'a' * 300}.nc"], f"--out {'a' * 60}: cannot be a file: File name too long"),
    (["run", "fig6-slab", "--figure", "folder.png"], "--figure folder.png: is a folder"),
    (["run", "fig6-slab", "--figure", "pipe.png"], "--figure pipe.png: exists and is not an ordinary file"),
    (["run", "fig6-slab", "--catalogue", "folder.csv"], "--catalogue folder.csv: is a folder"),
    (["export", "fig6-slab", "folder.txt"], "FILE folder.txt: is a folder"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "bad.zarr"], "--out bad.zarr: is a file, where a sweep needs a folder"),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1", "--figure", "a.png"],
        "sweep: --figure draws one to three keys, but here no key",
    ),
    (["sweep", "fig6-slab", *FOUR_KEYS, "--figure", "a.png"], "sweep: --figure draws one to three keys, but here 4 keys vary"),
    (["run", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean 'fig6-slab'?"),
    (["check", "."], ".: is a folder, not a scenario; its scenarios: bad.toml"),
    (["new", "--friction", "coulomb"], "new: which scenario? `stickslip new --list` lists them"),
    (["new", "blok"], "no scenario 'blok'; did you mean 'block'?"),
    (["run", "fig6-slab", "--out", "a.csv"], "--out a.csv: the name must end in .nc"),
    (["run", "fig6-slab", "--out", "no/a.nc"], "--out no/a.nc: there is no folder no"),
    (["run", "fig6-slab", "--figure", "a.xyz"], "--figure a.xyz: the name must end in .png or .pdf or .svg"),
    (["run", "fig6-slab", "--duration", "10 kg"], "run: --duration must be a number in s or a text with a unit"),
    (["run", "fig6-slab", "--energy"], "run: --energy belongs to --catalogue FILE"),
    (
        ["run", "fig5-slab-printed", "--energy", "--creep-rtol", "1e-6", "--catalogue", "events.csv"],
        "run: --energy and --creep-rtol exclude each other",
    ),
    (["run", "fig6-slab", "--shortest-event", "1 s"], "run: --shortest-event must be 0 or at most 0.0571429 s (1 % of the two-way"),
    (
        ["run", "cycles-block", "--creep-rtol", "1e-6"],
        "run: --creep-rtol must be 0 here: leaps over creep need a friction law that remembers all slip",
    ),
    (["run", "fig6-slab", "--selection", "maxwel"], "run: --selection 'maxwel' is unknown; did you mean 'maxwell'?"),
    (["run", "bad.toml", "--out", "a.nc"], "bad.toml: [body] thicknes is unknown; did you mean 'thickness'?"),
    (["check", "\x1b[31mred.toml"], "'\\x1b[31mred.toml': no such file"),
    (["run", "fig6-slab", "--dpi", "300"], "--dpi needs a figure: name its file, say --figure NAME.png"),
    (["run", "fig6-slab", "--size", "16 x 10 cm", "--animation", "a.gif"], "--size needs a figure"),
    (["run", "fig6-slab", "--figure", "a.png", "--dpi", "3"], "--dpi: must be a number of dots per inch from 10 to 2400, got 3"),
    (
        ["check", "fig6-block-printed", "--figure", "a.png"],
        "figure of the set K: the slip rate does not follow from the load alone",
    ),
    (["check", "fig6-slab", "--map", "alpha=1..2"], "check: a map needs two --map and a --figure, got 1 and none"),
    (["check", "fig6-slab", *2 * ["--map", "alpha=1..2"], "--figure", "a.png"], "regime map: needs two different parameters"),
    (
        ["check", "fig6-slab", "--map", "alpa=1..2", "--map", "static=0.1..1", "--figure", "a.png"],
        "check: --map: parameter 'alpa' is unknown; did you mean 'alpha'?",
    ),
    (
        ["check", "fig6-slab", "--map", "alpha:1-2", "--map", "static=0.1..1", "--figure", "a.png"],
        "check: --map must be NAME=LOW..HIGH[:POINTS][:log], as",
    ),
    (["run", "cycles-block", "--animation", "a.gif"], "run: --animation needs a slab or a string: a block is rigid"),
    (
        ["run", "fig6-slab", "--catalogue", "a.csv", "--animation", "a.gif", "--figure", "a.png"],
        "run: a catalogue keeps slip events only, no history: leave out --figure, --animation",
    ),
    (["run", "fig6-slab", "--animation", "a.avi"], "--animation a.avi: the name must end in .gif or .mp4 or .webm"),
    (["paper", "--out", "bad.toml/paper"], "--out bad.toml/paper:"),
    (["compare"], "compare: RUNS is missing; `stickslip compare --help` explains it, with examples"),
    (["compare", "fig6-slab"], "compare: needs two runs or more, got 1"),
    (["compare", "fig6-slab", "fig6-slap"], "fig6-slap: no such file, and no bundled scenario of that name; did you mean"),
    (["analogy", "fig6-slab"], 'analogy: give two --map, as --map "friction.alpha=0.01..10:20:log", got 0'),
    (["analogy", "fig6-slab", "--map", "alpha=1..2", "--map", "alpha=1..2"], "analogy: needs two different parameters"),
    (["export", "fig6-slab", "a.md"], "FILE a.md: the name must end in .csv or .nc or .txt or .dat"),
    (["export", "fig6-slab", "a.txt", "--event", "1"], "window: no event 1: the run has 1, 0 to 0"),
    (["benchmark", "get", "loop", "--out", "a.csv"], "benchmark: --out does not belong to get: get writes files to --folder"),
    (["benchmark", "list", "--folder", "x"], "benchmark: --folder does not belong to list: leave it out"),
    (["check", "planar-patch", "--set", "duration=1e20 years"], "check: --set: [contact] 3.15576e+27 s are 1.41e+29 time steps"),
    (["run", "planar-patch", "--set", "wave_speed=1e40"], "run: --set: [contact] "),
    (["benchmark", "get", "lop"], "benchmark: there is no problem 'lop'; did you mean 'loop'?"),
    (["benchmark", "gte"], "benchmark: there is nothing called 'gte'; did you mean 'get'?"),
    (["benchmark", "judge"], "benchmark: judge needs a file"),
    (["schemes", "fig4-loop", "--nx", "20;50"], "schemes: --nx must be whole numbers separated by commas"),
    (["schemes", "fig4-loop", "--scheme", "hth"], "schemes: there is no scheme 'hth'; did you mean 'hht'?"),
    (["schemes", "fig4-loop", "--scheme", "theta,theta"], "schemes: the scheme 'theta' is given twice"),
    (["schemes", "fig4-loop", "--out", "a.txt"], "--out a.txt: the name must end in .csv"),
    (["schemes", "fig4-loop", "--series", "a.csv", "--nx", "20"], "schemes: --nx is for schemes of stickslip: leave it out with"),
    (["ensemble", "fig6-slab", "--members", "many"], "ensemble: --members must be a whole number, got 'many'"),
    (["sweep", "fig6-slab"], "sweep: needs either --vary or --list, got neither"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--list", "a.csv"], "sweep: needs either --vary or --list, got both"),
    (["sweep", "fig6-slab", "-v", "alpha"], '--vary must be "KEY=LOW..HIGH:POINTS"'),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1,2", "-q", "xyz"],
        "sweep: quantity 'xyz' is unknown; allowed: arrested, balance, branches, damped, ",
    ),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "map.nc"], "--out map.nc: the name must end in .zarr"),
    (["sweep", "fig6-slab", "-v", "alpha=1,2", "--out", "no/map.zarr"], "--out no/map.zarr: there is no folder no"),
    (["sweep", "fig6-slab", "--list", "no.csv"], "--list no.csv: no such file"),
    (["run", "fig6-slab", "--duration", "1e300"], "run: --duration must lie within 1e+50 s, got 1e+300"),
    (["run", "fig6-slab", "--duration", "1e30"], "run: duration must be at most 5.15e+16 s, 2^53 round trips"),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1..2", "--design", "lhs", "--members", "1e12"],
        "sweep: --members must be a whole number",
    ),
    (
        ["sweep", "fig6-slab", "-v", "alpha=1..2:100000", "-v", "static=0.6..0.8:100000", "--dry-run"],
        "--vary: a grid has at most 1e+09 members, got 1e+10",
    ),
    (["explore", "--port", "70000"], "explore: --port must be a whole number"),
    (["explore", "--sessions", "0"], "explore: --sessions must be a whole number, at least 1, got '0'"),
    (["explore", "--allow-origin", "*"], "explore: --allow-origin must be NAME or NAME:PORT, got '*'"),
    (["explore", "--address", "nowhere.invalid", "--no-browser"], "explore: cannot listen on nowhere.invalid port"),
]


@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command, tmp_path: Path, arguments: list[str], message: str):
    (tmp_path / "bad.toml").write_text(BAD)
    (tmp_path / "bad.zarr").touch()
    for name in ("folder.png", "folder.csv", "folder.txt"):
        (tmp_path / name).mkdir()
    os.mkfifo(tmp_path / "pipe.png")
    before = sorted(tmp_path.iterdir())
    said = command(*arguments).refusal
    assert said.startswith(message)
    assert said.strip().isprintable()
    assert not places_twice(said)
    assert sorted(tmp_path.iterdir()) == before
