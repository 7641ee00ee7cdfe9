"""What each command says when all is well."""

import io
import re
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image
from typer.main import get_command

from stickslip import __version__
from stickslip.cli.app import app
from stickslip.cli.options import (
    CHOICES,
    complete_law,
    complete_pull,
    complete_rule,
    complete_scenario,
)
from stickslip.cli.output.files import CATALOGUES
from stickslip.cli.output.pictures import FILMS
from stickslip.figures.runs import animation
from stickslip.problem.scenarios import library, templates
from stickslip.problem.scenarios.scenario import load_scenario
from stickslip.solution.files import catalogue_rows
from tests.limits import limit_of_process
from tests.problems import of_each_kind

COMMANDS = [*get_command(app).commands]
"""All commands: those of the core, and those of each extension that is there."""


OPTIONS = [("run", "selection"), ("new", "friction"), ("new", "pull")]


@pytest.mark.parametrize(("name", "option"), OPTIONS)
def test_help_names_all_that_an_option_accepts(command, monkeypatch: pytest.MonkeyPatch, name: str, option: str):
    monkeypatch.setenv("COLUMNS", "200")
    shown = " ".join(command(name, "--help").out.split())
    assert f"One of: {', '.join(CHOICES[option]())}." in shown.partition(f"--{option}")[2]


@pytest.mark.parametrize("width", [60, 80])
@pytest.mark.parametrize("name", COMMANDS)
def test_help_has_an_example_fits_the_terminal_and_breaks_no_name(command, monkeypatch: pytest.MonkeyPatch, name: str, width: int):
    monkeypatch.setenv("COLUMNS", str(width))
    found = command(name, "--help")
    shown = found.out
    assert found.code == 0
    assert f"stickslip {name} " in shown.partition("Usage")[2].partition("\n")[2]
    typed = re.compile(r"^ +(stickslip|--)")  # examples are shown as they are typed
    assert all(len(line.rstrip()) <= width for line in shown.splitlines() if width == 80 or not typed.match(line))
    for one in get_command(app).get_command(None, name).params:
        for option in one.opts:
            if option.startswith("--"):
                assert re.search(rf"{option}\b", shown), option


def test_without_arguments_the_help_is_shown(command):
    shown = command()
    assert shown.code == 0
    for name in COMMANDS:
        assert re.search(rf"^  {name} ", shown.out, re.MULTILINE)
    assert shown.out.rstrip() == command("--help").out.rstrip()


def test_version_prints_the_version(command):
    assert command("--version").out == f"stickslip {__version__}\n"


@pytest.mark.slow
def test_figures_have_the_size_and_the_dots_asked_for(command, tmp_path):
    """16 cm x 10 cm at 300 dots per inch, one column of 3.5 inches, 200 dots per inch by default; a PDF in points of 1/72 inch."""
    assert command("check", "fig6-slab", "--figure", "a.png", "--size", "16 x 10 cm", "--dpi", "300").code == 0
    assert command("run", "fig6-slab", "--path", "b.png", "--friction-figure", "c.png", "--size", "single column").code == 0
    assert command("run", "fig6-slab", "--figure", "d.pdf", "--size", "3.5x5in").code == 0
    sizes = []
    for name in ("a.png", "b.png", "c.png"):
        with Image.open(tmp_path / name) as picture:
            sizes.append(picture.size)
    assert sizes[0] == pytest.approx((16 / 2.54 * 300, 10 / 2.54 * 300), abs=1.0)
    assert [width for width, _ in sizes[1:]] == [700, 700]
    assert b"/MediaBox [ 0 0 252 360 ]" in (tmp_path / "d.pdf").read_bytes()


def test_a_scenario_comes_from_standard_input(command, monkeypatch: pytest.MonkeyPatch):
    def piped(text: str) -> None:
        monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))

    text = command("new", "fig6-slab").out
    for name in ("run", "check"):
        piped(text)
        assert command(name, "-").out == command(name, "fig6-slab").out
    for wrong, message in (
        ("", "standard input: is empty; `stickslip new slab > mine.toml` writes"),
        (text.replace("alpha = 1.0", "alpha = 1,0"), "standard input: line 23: 'alpha = 1,0"),
        (text.replace("thickness", "thicknes"), "standard input: [body] thicknes is unknown; did you mean 'thickness'?"),
    ):
        piped(wrong)
        shown = command("run", "-")
        assert (shown.code, shown.out) == (2, "")
        assert shown.err.startswith(f"stickslip: {message}")


def test_help_needs_few_seconds_of_the_processor():
    code = limit_of_process(5) + "from stickslip.cli.main import main\nmain(['--help'])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("name", templates.template_names())
def test_new_prints_the_template(command, name):
    assert command("new", name).out == templates.template(name)


@pytest.mark.parametrize("arguments", [(), ("--list",)])
def test_new_lists_every_name(command, arguments: tuple[str, ...]):
    shown = command("new", *arguments)
    assert shown.code == 0
    for name in templates.template_names():
        assert re.search(rf"^{name} ", shown.out, re.MULTILINE)
    below = re.split(r"^Drilling *\n", shown.out, flags=re.MULTILINE)[1]
    drilling = re.split(r"^ *\n", below, flags=re.MULTILINE)[0]
    assert re.findall(r"^[a-z][a-z-]+", drilling, re.MULTILINE) == ["drill-string", "pipe-and-collar"]


@pytest.mark.sampled(every=13)
@pytest.mark.parametrize("name", of_each_kind(library.in_1d()))
def test_check_prints_its_four_sections(command, name):
    shown = command("check", name)
    assert shown.code == 0
    assert shown.out.startswith(load_scenario(name).title)
    for word in ("what follows", "start", "(stability|steady sliding)", "uniqueness"):
        assert re.search(rf"^{word} ", shown.out, re.MULTILINE)


def test_check_says_what_jumps_and_what_depends_on_the_rule(command):
    out = command("check", "fig6-slab").out
    for text in ("9.8 MPa s/m", "34.3 GPa", "5.7142857 s", "(0.05 m/year)", "80 MPa", "warning"):
        assert text in out
    for pattern in (
        r"^critical value +friction\.alpha = 0\.196 s/m; here above it, at 1",
        r"^critical value +body\.normal_stress = 19\.6 MPa; here above it, at 100 MPa",
        r"^jump up \* +slip rate 0 to 4\.10204082 m/s at a load of 80 MPa; traction changes by -40\.2 MPa",
        r"^jump down \* +slip rate 1\.25876976 to 0 m/s at a load of 64\.4718872424 MPa; traction changes by 12\.3359 MPa",
        r"^loop \* +the load going up and down encloses 46\.2819 MPa m/s",
        r"^\* +depends on the rule 'perfect-delay'",
        r"the slip rate jumps to 4\.10204082 m/s",
    ):
        assert re.search(pattern, out, re.MULTILINE), pattern
    block = command("check", "fig6-block-reconstructed").out
    assert not re.search(r"^(critical value|fold|jump|loop)", block, re.MULTILINE)


def test_check_says_where_a_mixed_law_is_irregular(command, tmp_path: Path):
    (tmp_path / "mine.toml").write_text(command("new", "slab", "--friction", "product").out)
    assert re.search(r"^along slip +irregular from 0 to 0\.8 m of slip", command("check", "mine.toml").out, re.MULTILINE)


def test_check_draws_the_set_and_the_map(command, tmp_path: Path):
    assert "written: k.svg" in command("check", "fig6-slab", "--figure", "k.svg").out
    axes = ("--map", "alpha=0.01..10:4:log", "--map", "normal_stress=10 MPa..500 MPa:3")
    assert "written: map.png" in command("check", "fig6-slab", *axes, "--figure", "map.png").out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["k.svg", "map.png"]
    assert "written: path.png" in command("run", "fig4-loop", "--path", "path.png").out


def test_run_says_what_happened(command):
    shown = command("run", "fig6-slab")
    assert shown.code == 0
    assert shown.err == ""
    for text in ("finished", "1 slip event", "23.440233", "2 shocks", "4.1020408", "this run depends on the rule"):
        assert text in shown.out


def test_run_takes_other_durations_rules_and_tolerances(command):
    shown = command("run", "fig6-slab", "--duration", "3 s", "--rtol", "1e-6", "--selection", "maxwell")
    assert shown.code == 0
    assert "duration 3 s, rtol 1e-06" in shown.out
    assert "maxwell" in shown.out
    assert "1 shock\n" in shown.out
    assert "duration 3 s" in command("run", "fig6-slab", "--duration", "3").out


def test_the_shell_completes_laws_pulls_and_rules():
    assert complete_law("hyp") == ["hyperbolic-rate"]
    assert complete_pull("hold") == ["hold-and-slide"]
    assert complete_rule("max") == ["maxwell", "maximal"]


def test_run_draws_space_time_and_animation(command, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("stickslip.figures.runs.animation.FRAMES", 2)
    for name, value in (("TIMES", 100), ("CELLS", 30)):
        monkeypatch.setattr(f"stickslip.figures.runs.inside.{name}", value)
    out = command("run", "fig6-slab", "--space-time", "waves.svg", "--animation", "slab.gif").out
    assert out.endswith("written: waves.svg\nwritten: slab.gif\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["slab.gif", "waves.svg"]
    assert (tmp_path / "slab.gif").read_bytes().startswith(b"GIF89a")


def test_run_says_what_is_trapped(command):
    short = command("run", "fig5-slab-reconstructed").out
    assert re.search(r"\nproven: to \S+ of the normal stress at every moment; trapped energy: 1\.86\d+e\+07 J/m2 \(--all", short)
    shown = command("run", "fig5-slab-reconstructed", "--all").out
    assert re.search(r"trapped energy: 1\.86\d+e\+07 J/m2 in waves at the end, 0\.57 % of what", shown)
    assert "--all" not in shown
    assert short.partition("proven")[0] == shown.partition("trapped")[0]
    assert "trapped" not in command("run", "cycles-block").out


def test_the_shell_completes_scenarios(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "fig6-mine.toml").touch()
    (tmp_path / "notes.txt").touch()
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "deep.toml").touch()
    monkeypatch.chdir(tmp_path)
    assert complete_scenario("fig6-") == [name for name in library.names() if name.startswith("fig6-")] + ["fig6-mine.toml"]
    named = [name for name in (*library.STARTERS, *library.names()) if name.startswith("s")]
    assert complete_scenario("s") == [*named, "sub/"]
    assert complete_scenario("sub/") == ["sub/deep.toml"]
    assert complete_scenario("nowhere/") == []


def test_the_suffixes_of_files_are_those_that_can_be_written():
    assert FILMS == animation.SUFFIXES
    assert CATALOGUES == catalogue_rows.SUFFIXES


def test_export_writes_time_series(command, tmp_path: Path):
    assert "written: late.txt" in command("export", "second-event-maxwell", "late.txt", "--event", "1", "-r", "50").out
    text = (tmp_path / "late.txt").read_text()
    assert "# problem=second-event-maxwell\n" in text
    assert "\nt slip slip-rate shear-stress\n" in text
