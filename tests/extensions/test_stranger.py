"""Extensions of other packages: those of docs/extensions.md do what the page shows, and bad ones are told in one line."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip import extension
from stickslip.cli import app, mistyped
from stickslip.cli.installation import extensions_there
from stickslip.cli.results import DONE, PlainRun
from stickslip.foundation.errors import InputWarning
from stickslip.foundation.text_columns import read_file, read_text
from stickslip.problem import Status
from tests.docs.pages import ROOT, Block, blocks_of, missing_lines

PAGE = blocks_of(ROOT / "docs" / "extensions.md")
NAME = re.compile(r"# (\S+)\n")
RUNNER = """
import io, json, sys
from contextlib import redirect_stderr, redirect_stdout
from stickslip.cli.main import main
found = []
for arguments in json.load(sys.stdin):
    out, err, code = io.StringIO(), io.StringIO(), 0
    with redirect_stdout(out), redirect_stderr(err):
        try:
            main(arguments)
        except SystemExit as stop:
            code = stop.code or 0
    found.append([code, out.getvalue(), err.getvalue()])
print(json.dumps(found))
"""
"""Runs commands one after the other in one process, and prints the code and the output of each."""


def named(block: Block) -> str:
    """The name of the file that a block shows; "" if it shows none."""
    found = NAME.match(block.text)
    return found[1] if found else ""


def install(site: Path, package: str, code: str, entry: str) -> None:
    """Put a package with an entry point into a folder, as pip would."""
    module = entry.partition("= ")[2].partition(":")[0]
    (site / f"{module}.py").write_text(code, encoding="utf-8")
    about = site / f"{package.replace('-', '_')}-1.0.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n", encoding="utf-8")
    (about / "entry_points.txt").write_text(f"[stickslip.extensions]\n{entry}\n", encoding="utf-8")


def python(site: Path, *arguments: str, given: str = "") -> subprocess.CompletedProcess[str]:
    path = os.pathsep.join([str(site), str(Path(ss.__file__).parents[1])])
    environment = os.environ | {"PYTHONPATH": path, "COLUMNS": "200", "MPLBACKEND": "agg"}
    return subprocess.run([sys.executable, *arguments], cwd=site, env=environment, input=given, capture_output=True, text=True)


def run(site: Path, *commands: list[str]) -> list[tuple[int, str, str]]:
    """Exit code, output and errors of each command, all in one process."""
    done = python(site, "-c", RUNNER, given=json.dumps(commands))
    assert done.returncode == 0, done.stderr
    return [(code, out, err) for code, out, err in json.loads(done.stdout)]


# ---- the two packages of the page ------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the two packages of the page, and with its scenarios."""
    folder = tmp_path_factory.mktemp("site")
    texts = [(named(block), block.text) for block in PAGE]
    about = [text for name, text in texts if name == "pyproject.toml"]
    for name, text in texts:
        if name.endswith(".py"):
            project = about.pop(0)
            entry = re.search(r'stickslip\.extensions"\]\n(\w+) = "(.*)"', project)
            package = re.search(r'name = "(.*)"', project)
            assert entry
            assert package
            install(folder, package[1], text, f"{entry[1]} = {entry[2]}")
        elif name not in ("", "pyproject.toml"):
            (folder / name).write_text(text, encoding="utf-8")
    return folder


def test_a_package_of_the_page_has_at_most_sixty_lines() -> None:
    packages = [block.text for block in PAGE if named(block).endswith(".py")]
    assert len(packages) == 2
    assert all(len(text.splitlines()) <= 60 for text in packages)


TYPED = [part.splitlines() for block in PAGE if block.language == "shell" for part in block.text.split("$ stickslip ")[1:]]
"""The commands of the page, each with the lines that it shows."""
OTHERS = [
    ["--help"],
    ["check", "far.toml", "--parameters"],
    ["check", "row.toml"],
    ["sweep", "far.toml", "--vary", "station.distance=0..1e6:3", "--dry-run"],
    ["run", "row.toml", "--rtol", "1e-5"],
    *(["run", f"{name}.toml"] for name in ("key", "unit", "slab")),
    ["spektrum", "fig6-slab"],
]


@pytest.fixture(scope="module")
def answers(site: Path) -> list[tuple[int, str, str]]:
    """What is said to the commands of the page, and to the others."""
    far = (site / "far.toml").read_text(encoding="utf-8")
    (site / "key.toml").write_text(far.replace("distance =", "distence ="), encoding="utf-8")
    (site / "unit.toml").write_text(far.replace("2000 km", "2000 s"), encoding="utf-8")
    row = far.replace("[station]\ndistance", "[row]\njoint").replace("2000 km", "1 N/m")
    (site / "slab.toml").write_text(row, encoding="utf-8")
    return run(site, *(line[0].split() for line in TYPED), *OTHERS)


def test_what_the_page_types_does_what_it_shows(answers: list[tuple[int, str, str]]) -> None:
    assert len(TYPED) == 5
    for (command, *shown), (code, out, err) in zip(TYPED, answers, strict=False):
        refused = shown[0].startswith("stickslip: ")
        assert missing_lines(shown, err if refused else out) == [], command  # the other stream may tell that code is compiled
        assert code == (2 if refused else 0), command


def test_commands_and_tables_of_a_stranger_are_like_our_own(answers: list[tuple[int, str, str]]) -> None:
    found = answers[len(TYPED) :]
    (_, shown, _), (_, parameters, _), (_, special, _), swept, *refused = found
    assert re.search(r"Seismology:\n +spectrum  Tell the spectrum of the slip rate at the \[station\] of a scenario", shown)
    assert re.search(r"station\.distance +m +distance of the station", parameters)
    assert re.search(r"row\.joint +N/m +stiffness of the springs between the blocks", special)
    assert swept[0] == 0
    assert "3 members" in swept[1]
    assert [(code, out) for code, out, _ in refused] == [(2, "")] * 5
    lines = [err for _, _, err in refused]
    assert lines[0] == "stickslip: run: row: a run of this kind has no --rtol: leave it out\n"
    assert lines[1] == "stickslip: key.toml: [station] distence is unknown; did you mean 'distance'?\n"
    assert lines[2].startswith("stickslip: unit.toml: [station] distance must be a number in m or a text with a unit")
    assert lines[3] == "stickslip: slab.toml: a [row] needs a spring-block, a law that sticks, and a pull rate above 0\n"
    assert "did you mean 'spectrum'?" in lines[4]


def look_again() -> None:
    """Forget what extensions there are, and what they add."""
    for cached in (extension.found, extension.tables, extension._public):
        cached.cache_clear()


@contextmanager
def installed_in(folder: Path) -> Iterator[None]:
    """Let this process look for extensions again, in a further folder, until the end of the block."""
    sys.path.insert(0, str(folder))
    look_again()
    try:
        yield
    finally:
        sys.path.remove(str(folder))
        look_again()


@pytest.fixture
def strangers(site: Path) -> Iterator[None]:
    """The packages of the page, in this process."""
    with installed_in(site):
        yield


@pytest.mark.usefixtures("strangers")
def test_the_spectrum_is_that_of_a_rate_that_is_constant_while_the_slab_slips() -> None:
    """The slip rate of Fig. 6 is 4.102 m/s for one two-way travel time T: its spectrum is the slip times sin(pi f T) / (pi f T)."""
    slab = ss.simulate("fig6-slab")
    frequencies, size = ss.studies.spectrum(slab)
    slip, lasts = float(slab.slip()), 2.0 * 10e3 / 3500.0
    low = frequencies < 2.0
    np.testing.assert_allclose(size[low], slip * np.abs(np.sinc(frequencies[low] * lasts)), rtol=0.0, atol=2e-3 * slip)
    assert size[0] == pytest.approx(slip, rel=1e-12)
    station = ss.load_scenario("fig6-slab")
    assert station.table("station") is None
    far = extension.tables()["station"].kind()(distance=2e6)
    weaker = ss.studies.spectrum(slab, far)[1]
    np.testing.assert_allclose(weaker, size * np.exp(-np.pi * frequencies * 2e6 / 3500.0 / 200.0), rtol=1e-12)


@pytest.mark.usefixtures("strangers")
def test_a_figure_of_a_stranger_is_drawn_and_listed_beside_our_own() -> None:
    from matplotlib.figure import Figure

    slab = ss.simulate("fig6-slab")
    assert {"spectrum", "energy"} <= set(dir(slab.plot))
    drawn = slab.plot.spectrum()
    (line,) = drawn.axes[0].lines
    np.testing.assert_array_equal(line.get_ydata(), ss.studies.spectrum(slab)[1][1:])
    axes = Figure().subplots()
    assert slab.plot.spectrum(ax=axes) is axes
    with pytest.raises(AttributeError, match="has no attribute 'spektrum'; did you mean 'spectrum'"):
        slab.plot.spektrum  # noqa: B018


@pytest.mark.usefixtures("strangers")
def test_a_scenario_keeps_the_table_of_a_stranger(site: Path) -> None:
    far = ss.load_scenario(site / "far.toml")
    assert far.table("station").distance == 2e6
    (site / "again.toml").write_text(far.to_toml(), encoding="utf-8")
    assert ss.load_scenario(site / "again.toml") == far
    assert far.with_values({"station.distance": "5 km"}).table("station").distance == 5e3
    with pytest.raises(ss.InputError, match=r"distance must be at least 0 m, got -1"):
        far.with_values({"station.distance": -1.0})
    assert ss.simulate(far).events.slip[0] == ss.simulate("fig6-slab").events.slip[0]


@pytest.mark.slow
@pytest.mark.usefixtures("strangers")
def test_a_sweep_over_the_table_of_a_stranger_has_the_members_that_it_says(site: Path) -> None:
    found = ss.sweep(site / "far.toml", {"station.distance": ["1 km", "5 km"]})
    assert found["station.distance"].values.tolist() == [1e3, 5e3]
    assert found.slip.values.tolist() == [ss.simulate("fig6-slab").events.slip[0]] * 2


@pytest.mark.usefixtures("strangers")
def test_a_row_of_blocks_without_joints_is_a_hundred_blocks_in_closed_form(site: Path) -> None:
    """Each block slips (static - dynamic) S / K = 0.02 m, and then waits for 0.02 m of pull, which takes 20 s."""
    row = ss.load_scenario(site / "row.toml")
    times, blocks, slips = np.array(ss.simulate(row.with_values({"row.joint": 0.0}))).T
    assert set(blocks) == {1.0}
    np.testing.assert_allclose(slips, 0.02, rtol=1e-9)
    np.testing.assert_allclose(times[100:] - times[:-100], 20.0, rtol=1e-9)
    np.testing.assert_allclose(times[:100], np.sort(20.0 * np.random.default_rng(0).random(100)), rtol=1e-9)


@pytest.mark.usefixtures("strangers")
def test_a_row_of_blocks_slips_as_far_as_it_is_pulled(site: Path) -> None:
    """Joints only pass loads on: over 60 s the sum of the slips is that of the pull, but for loads between the two frictions."""
    row = ss.load_scenario(site / "row.toml")
    whole, of_object = ss.simulate(row), ss.simulate(row.to_solve, "60 s")
    assert list(whole) == list(of_object)
    slips = sum(slip for _, _, slip in whole)
    assert abs(slips - 100 * 60.0 * 1e-3) <= 100 * (0.7 - 0.5) * 100.0 / 1e3
    assert 1 < max(blocks for _, blocks, _ in whole) <= 100
    for wrong in ({"rtol": 1e-6}, {"checkpoint": "row.nc"}):
        with pytest.raises(ss.InputError, match=f"simulate: a row of blocks has no {next(iter(wrong))}"):
            ss.simulate(row, **wrong)
    with pytest.raises(ss.InputError, match=r"has a \[row\], for which there are"):
        ss.uniqueness(row)
    with_both = replace(row, tables=(("station", extension.tables()["station"].kind()()), *row.tables))
    with pytest.raises(ss.InputError, match=r"has a \[row\], for which there are .* leave out \[row\]"):
        ss.uniqueness(with_both)


@pytest.mark.usefixtures("strangers")
def test_doctor_names_the_packages_of_extensions() -> None:
    rows = [(one.name, one.value, one.fault) for one in extensions_there()]
    own = ", ".join(sorted(path.parent.name for path in Path(ss.__file__).parent.glob("extensions/*/__init__.py")))
    assert rows[0] == ("extensions", own, "")
    assert rows[1:] == [("extension", "row of stickslip-row 1.0", ""), ("extension", "spectrum of stickslip-spectrum 1.0", "")]


# ---- bad extensions --------------------------------------------------------------------------------------------------------------

HEAD = "from stickslip.extension import Extension\nclass Other(Extension):\n    name = 'other'\n"
END = "EXTENSION = Other()\n"
COMMAND = HEAD + "    def commands(self):\n        def check(): ...\n        return {'Mine': (check,)}\n" + END
BAD = {
    "cannot be imported": (
        "import no_such_library\n",
        r"other:EXTENSION of bad 1\.0 cannot be used \(ModuleNotFoundError: No module",
    ),
    "ends the process": ("raise SystemExit(3)\n", r"cannot be used \(SystemExit: 3\)"),
    "is of another class": ("EXTENSION = 3\n", r"\(TypeError: it is no instance of stickslip\.extension\.Extension, but a int\)"),
    "is a class": (f"{HEAD}EXTENSION = Other\n", r"it is no instance of stickslip\.extension\.Extension, but a type\)"),
    "has another name": (
        HEAD.replace("'other'", "'odder'") + END,
        r"\(TypeError: its name is 'odder', and that of its entry point 'other'",
    ),
    "needs what is not there": (
        f"{HEAD}    needs = ('spectra', 'maps')\n{END}",
        "it needs the extensions 'spectra' and 'maps', which are not",
    ),
    "has no such object": ("", r"cannot be used \(AttributeError: module 'other' has no attribute 'EXTENSION'"),
}


@pytest.fixture
def bad(tmp_path: Path) -> Iterator[Callable[[str], None]]:
    """Return a function that installs an extension "other" with some code, in this process."""

    def installed(code: str) -> None:
        install(tmp_path, "bad", code, "other = other:EXTENSION")
        look_again()

    with installed_in(tmp_path):
        yield installed
    sys.modules.pop("other", None)


@pytest.mark.parametrize("kind", BAD)
def test_a_bad_extension_is_left_out_with_one_line(bad: Callable[[str], None], kind: str) -> None:
    code, why = BAD[kind]
    bad(code)
    with pytest.warns(InputWarning, match=f"^the extension 'other' is left out: .*{why}") as told:
        assert "other" not in [one.name for one in extension.extensions()]
    assert len(told) == 1
    assert "\n" not in str(told[0].message)
    (left_out,) = [one.value for one in extensions_there() if one.name == "left out"]
    assert (
        f"the extension {str(told[0].message).partition('the extension ')[2]}"
        == f"the extension 'other' is left out{left_out.removeprefix('other')}"
    )


def test_an_extension_that_fails_when_it_is_asked_adds_nothing(bad: Callable[[str], None]) -> None:
    bad(f"{HEAD}    def commands(self):\n        return {{'Mine': no_such_name}}\n{END}")
    with pytest.warns(
        InputWarning, match=r"'other' cannot say which commands it adds \(NameError: name 'no_such_name' is not defined"
    ):
        groups = app._all_groups()
    assert "Mine" not in groups


ASKED: dict[str, Callable[[], object]] = {
    "solvers": lambda: ss.simulate("fig6-slab", 1.0, seed=1),
    "tables": lambda: ss.load_scenario("fig6-slab"),
    "readers": lambda: ss.open_solution("nothing.nc4"),
    "forms": lambda: read_text("time (s),slip (m)\n0,0\n1,2\n", ("time", "slip"), "points", 5),
    "commands": app._all_groups,
    "figures": lambda: dir(ss.simulate("fig6-slab", 1.0).plot),
    "public": lambda: dir(ss),
}
"""Something that asks each method of an extension."""


@pytest.mark.parametrize("given", ["None", "3", "{'a': 3}", "[3]", "'abc'", "{3: 'a:b'}", "1 / 0"])
@pytest.mark.parametrize("slot", ASKED)
def test_an_extension_that_answers_with_what_is_no_answer_adds_nothing(
    bad: Callable[[str], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, slot: str, given: str
) -> None:
    """Whatever it is, it is told in one line, and all else goes on as it does without the extension."""
    monkeypatch.chdir(tmp_path)

    def said() -> str:
        try:
            return str(ASKED[slot]())
        except ss.InputError as error:
            return str(error)

    without = said()
    bad(f"{HEAD}    def {slot}(self, *kinds):\n        return {given}\n{END}")
    why = "ZeroDivisionError" if "/" in given else rf"TypeError: {slot}\(\) must return a (list|dict) of .*, not "
    with pytest.warns(InputWarning, match=rf"^the extension 'other' cannot say which .*s.* it adds \({why}"):
        assert said() == without


def test_a_format_of_a_stranger_is_known_by_its_first_lines_and_its_letters_may_be_old(
    tmp_path: Path, bad: Callable[[str], None]
) -> None:
    """A reader of a block of numbers gives them as an array, and the interval that its header states."""
    bad(
        f"""import numpy as np
from stickslip.foundation.record_files import RecordForm, Sheet
def sheet(lines, asked):
    next(lines)
    step = float(next(lines))
    slips = np.array([float(line) for line in lines])
    table = np.column_stack((step * np.arange(len(slips)), slips))
    return Sheet(asked.header(["time (s)", "slip (mm)"], 1), 1, iter(()), ["a block"], counted="sample", table=table, interval=step)
{HEAD}    def forms(self): return [RecordForm(lambda first: first[0].startswith("SLIPS"), sheet)]
{END}"""
    )
    path = tmp_path / "of_any_name"
    path.write_bytes("SLIPS of 5 µm\n0.5\n0\n1\n-4\n".encode("latin-1"))
    table = read_file(path, ("slip", "time"), (1000, 3))
    assert {name: numbers.tolist() for name, numbers in table.columns.items()} == {"slip": [0, 1e-3, -4e-3], "time": [0, 0.5, 1]}
    assert (table.interval, table.notes, table.at(2)) == (0.5, ("a block",), f"{path}, sample 3")
    with pytest.raises(ss.InputError, match=r"of_any_name, sample 3: more than 2 rows$"):
        read_file(path, ("slip", "time"), (1000, 2))


KEPT = """
from pathlib import Path
from stickslip.run.kinds import Reader
class Run:
    def __init__(self, path): self.path = path
class Table(Run):
    def to_csv(self, path): Path(path).write_text("a")
class KeptReader(Reader):
    what = "what is kept"
    def is_in(self, path): return path.suffix in (".run", ".table")
    def open(self, path): return Table(path) if path.suffix == ".table" else Run(path)
"""


def test_results_of_a_stranger_are_exported_if_they_have_a_table(tmp_path: Path) -> None:
    code = f"{KEPT}{HEAD}    def readers(self): return [KeptReader()]\n{END}"
    install(tmp_path, "kept", code, "other = other:EXTENSION")
    given = run(
        tmp_path, ["export", "a.table", "a.csv"], ["export", "a.run", "b.csv"], ["show", "a.run"], ["run", "--resume", "a.run"]
    )
    assert given[0] == (0, "written: a.csv\n", "")
    assert [one[:2] for one in given[1:]] == [(2, "")] * 3
    assert [err for _, _, err in given[1:]] == [
        "stickslip: export: a.run holds what is kept, which has no table\n",
        "stickslip: a.run: holds what is kept, which is not shown\n",
        "stickslip: run: --resume continues a run, not what is kept\n",
    ]


def test_a_run_of_a_stranger_may_have_a_status_of_its_own() -> None:
    stopped = Status("stopped", "it was stopped", ok=False)
    found = [PlainRun(ss.load_scenario("fig6-slab"), SimpleNamespace(status=given)).status for given in (stopped, "fine", None)]
    assert found == [stopped, DONE, DONE]


def test_a_command_without_types_takes_what_its_defaults_are(tmp_path: Path) -> None:
    code = f"def chart(what, count=3, name=None):\n    print(repr(what), repr(count), name)\n{HEAD}"
    install(tmp_path, "plain", f"{code}    def commands(self): return {{'Mine': (chart,)}}\n{END}", "other = other:EXTENSION")
    given = run(tmp_path, ["chart", "4"], ["chart", "4", "--count", "5", "--name", "six"], ["chart", "4", "--count", "x"])
    assert [(code, out) for code, out, _ in given] == [(0, "'4' 3 None\n"), (0, "'4' 5 six\n"), (2, "")]


@pytest.mark.usefixtures("strangers")
@pytest.mark.parametrize("explore", [ss.explore, app.COMMANDS["explore"]], ids=["notebook", "command"])
def test_the_explorer_refuses_problems_of_others_in_one_line(site: Path, explore: Callable[[str], object]) -> None:
    with pytest.raises(ss.InputError, match=r"^explore: row has a \[row\], for which there are `stickslip run`"):
        explore(str(site / "row.toml"))


UNDER_ALL = """    def commands(self):
        def named(name):
            def look(): ...
            look.__name__ = name
            return look
        return {heading: (named(f"look{n}"),) for n, heading in enumerate(HEADINGS)}
"""


def test_a_command_may_stand_under_any_heading_of_the_help(bad: Callable[[str], None]) -> None:
    headings = [*app.OF_CORE, *app.LAST, "My own"]
    bad(HEAD + UNDER_ALL.replace("HEADINGS", repr(headings)) + END)
    groups = app._all_groups()
    assert [groups[heading][-1].__name__ for heading in headings] == [f"look{n}" for n in range(len(headings))]
    assert list(groups)[-1] == list(app.LAST)[-1]


def test_a_command_that_is_there_already_is_refused_in_one_line(bad: Callable[[str], None]) -> None:
    bad(COMMAND)
    with pytest.raises(ss.InputError, match="two extensions, or one and the core, have a command 'check': uninstall one"):
        app._all_groups()


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("contact", "the extensions 'planar' and 'other' both add the table 'contact': uninstall one"),
        ("run", "an extension adds the table 'run' to scenario files, which is there already: uninstall it"),
        ("title", "an extension adds the table 'title' to scenario files, which is there already: uninstall it"),
    ],
)
def test_a_table_that_is_there_already_is_refused_in_one_line(bad: Callable[[str], None], table: str, message: str) -> None:
    made = "from stickslip.problem.scenarios.table import ScenarioTable\n" + HEAD
    bad(f"{made}    def tables(self):\n        return {{'{table}': ScenarioTable()}}\n{END}")
    with pytest.raises(ss.InputError, match=f"^{message}$"):
        ss.load_scenario("fig6-slab")


def test_a_command_of_an_extension_that_is_left_out_says_what_it_needs(bad: Callable[[str], None]) -> None:
    bad(COMMAND.replace("name = 'other'", "name = 'other'\n    needs = ('maps',)").replace("check", "chart"))
    with pytest.warns(InputWarning):
        extension.extensions()
    said = "'chart' is a command of the extension 'other', which is left out: it needs the extension 'maps', which is not installed"
    assert mistyped.unknown_command("chart", ["run"]) == said


def test_beside_bad_extensions_everything_else_works(tmp_path: Path) -> None:
    install(tmp_path, "first-bad", "import no_such_library\n", "first = first:EXTENSION")
    install(tmp_path, "second-bad", "EXTENSION = 3\n", "second = second:EXTENSION")
    done = python(tmp_path, "-m", "stickslip", "new", "--list")
    assert done.returncode == 0
    assert "fig6-slab" in done.stdout
    notes = done.stderr.splitlines()
    assert [line.partition(" is left out: ")[0] for line in notes] == [
        f"stickslip: note: the extension '{name}'" for name in ("first", "second")
    ]


def test_without_an_extension_its_names_and_what_uses_it_say_so(monkeypatch: pytest.MonkeyPatch) -> None:
    there = {name: one for name, one in extension.found().there.items() if name not in ("inference", "sweeps")}
    monkeypatch.setattr(extension, "found", lambda: extension.Found(there, dict.fromkeys(there, ""), ()))
    extension._public.cache_clear()
    try:
        for name, owner in (("sweep", "sweeps"), ("studies", "inference")):
            holder: Any = ss if name == "sweep" else ss.studies
            wanted = "sweep" if name == "sweep" else "infer"
            vars(holder).pop(wanted, None)
            with pytest.raises(
                AttributeError, match=f"has no {wanted} here: it belongs to the extension '{owner}', which is not installed"
            ):
                getattr(holder, wanted)
        with pytest.raises(ss.InputError, match="explore: record= needs the extension 'inference', which is not installed"):
            ss.explore("fig6-slab", record={"time (s)": [0.0, 1.0], "mu": [0.5, 0.5]})
    finally:
        extension._public.cache_clear()


REFUSES = """
from dataclasses import dataclass
from stickslip.extension import Extension
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import quantity
from stickslip.problem.scenarios import ScenarioTable

@dataclass(frozen=True)
class Gate:
    low: float = quantity("m", "lower end", default=0.0)
    high: float = quantity("m", "upper end", default=1.0)

    def __post_init__(self):
        if self.low >= self.high:
            raise InputError("Gate: high must be above low")

class Other(Extension):
    name = 'other'
    def tables(self):
        return {'gate': ScenarioTable(Gate)}

EXTENSION = Other()
"""


def test_a_table_whose_class_refuses_its_numbers_is_named_in_the_message(bad: Callable[[str], None], tmp_path: Path) -> None:
    bad(REFUSES)
    bundled = ss.load_scenario("fig6-slab").to_toml()
    (tmp_path / "gate.toml").write_text(f"{bundled}\n[gate]\nlow = 1.0\nhigh = 1.0\n", encoding="utf-8")
    with pytest.raises(ss.InputError, match=r"gate\.toml: \[gate\] high must be above low$"):
        ss.load_scenario(tmp_path / "gate.toml")
    (tmp_path / "gate.toml").write_text(f"{bundled}\n[gate]\nhigh = 2.0\n", encoding="utf-8")
    assert ss.load_scenario(tmp_path / "gate.toml").table("gate").high == 2.0
