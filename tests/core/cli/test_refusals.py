"""Every command that cannot be carried out is refused in one line on standard error with exit code 2, and writes nothing."""

from __future__ import annotations

import pytest

from tests.command_line import Command, check_refusal

CASES = [
    (["rn"], "there is no command 'rn'; did you mean 'run'?"),
    (["frobnicate"], "there is no command 'frobnicate'; allowed: "),
    (["fig6-slab"], "'fig6-slab' is a scenario, not a command: did you mean `stickslip run fig6-slab` or `stickslip check fig6-"),
    (["run"], "run: nothing to run: give a SCENARIO, or --resume FILE"),
    (["run", "fig6-slab", "--figur", "a.png"], "run: there is no option --figur; did you mean '--figure'? `stickslip run --help`"),
    (["run", "fig6-slab", "-q"], "run: there is no option -q; it is an option of show"),
    (["--versio"], "there is no option --versio; did you mean '--version'? `stickslip --help` shows all"),
    (["run", "fig6-slab", "--duration", "480", "years"], "run: 'years' is not expected; put a text with spaces in quotes, as "),
    (["run", "fig6-slab", "alpha=2"], "run: 'alpha=2' is not expected; --set NAME=VALUE replaces a value of the scenario;"),
    (["run", "fig6-slab", "--set", "alpha"], 'run: --set must be NAME=VALUE, as "friction.alpha=2" or "body.thickness=5 km", got'),
    (["run", "fig6-slab", "--set", "alpha=1", "--set", "alpha=2"], "run: --set: 'alpha' is given twice"),
    (["check", "fig6-slab", "--set", "alpa=1"], "check: --set: 'alpa' is not a parameter of this scenario; did you mean 'alpha'?"),
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
    (["export", "fig6-slab", "a.md"], "FILE a.md: the name must end in .csv or .nc or .txt or .dat"),
    (["export", "fig6-slab", "a.txt", "--event", "1"], "window: no event 1: the run has 1, 0 to 0"),
    (["run", "fig6-slab", "--duration", "1e300"], "run: --duration must lie within 1e+50 s, got 1e+300"),
    (["run", "fig6-slab", "--duration", "1e30"], "run: duration must be at most 5.15e+16 s, 2^53 round trips"),
]


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(("arguments", "message"), CASES)
def test_bad_input_gives_one_line_and_writes_nothing(command: Command, arguments: list[str], message: str) -> None:
    check_refusal(command, arguments, message)
