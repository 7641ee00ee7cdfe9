"""The command line with a contact of many nodes, in 2D and 3D: what it says, and what it refuses in one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from typer import Context

import stickslip as ss
from stickslip.cli.app import COMMANDS
from stickslip.cli.options import complete_scenario, complete_vary
from stickslip.problem.scenarios import library, read_scenario
from stickslip.run.run_loop import Interrupts
from tests.command_line import Command

SMALL = ("planar-patch", "--set", "contact.nodes=64", "--duration", "1 s")
IN_1D = {
    "analogy": ("--map", "friction.static=0.6..0.8:3", "--map", "friction.dynamic=0.4..0.5:3", "planar-patch"),
    "compare": ("planar-patch", "fig6-slab"),
    "cycle": ("planar-patch",),
    "ensemble": ("planar-patch",),
    "export": ("planar-patch", "out.txt"),
    "find": ("planar-patch", "--along", "friction.static=0.6..0.8"),
    "identify": ("planar-patch", "record.csv", "--free", "friction.static"),
    "infer": ("planar-patch", "record.csv", "--free", "friction.static=0.6..0.8"),
    "lyapunov": ("planar-patch",),
    "schemes": ("planar-patch",),
    "sensitivity": ("planar-patch",),
    "slide": ("record.AT2", "--yield", "0.1", "--analysis", "coupled", "--body", "planar-patch"),
    "sweep": ("planar-patch", "--vary", "friction.static=0.6,0.7"),
}
"""Arguments for each command that is for a contact of one place."""
WITHOUT_SCENARIO = {"benchmark", "doctor", "fit", "magnitudes", "new", "paper"}
WITH_CONTACT = {"run", "check", "show", "explore"}


def test_run_says_how_large_it_is_and_what_happened(command: Command, tmp_path: Path) -> None:
    shown = command("run", *SMALL, "--figure", "a.png", "--animation", "a.gif")
    assert shown.code == 0
    lines = shown.out.splitlines()
    assert lines[0] == "A fault in 2D: a nucleus between barriers: contact.nodes = 64"
    assert lines[1].startswith("64 nodes, 625 m apart; 12 steps up to 1 s; needs ")
    assert lines[2].startswith("finished")
    assert lines[3].startswith("27% of the contact slips")
    assert lines[-2:] == ["written: a.png", "written: a.gif"]
    assert all((tmp_path / name).stat().st_size > 1000 for name in ("a.png", "a.gif"))


def test_check_says_what_it_means_and_what_is_resolved(command: Command) -> None:
    out = command("check", "planar-patch").out
    for text in (
        "[contact]",
        "patches[1]",
        "359 steps, 256 in R",
        "process zone",
        "memory",
        "51 of 256 nodes slip at once, 25 are locked",
    ):
        assert text in out
    assert "rtol" not in out
    assert "warning" not in out


@pytest.mark.parametrize(
    ("change", "warning"),
    [
        ("contact.nodes=128", "the process zone has 3.88 nodes, not resolved: 5 are wanted, as with 166 nodes along y"),
        ("contact.patches[0].initial.load=70 MPa", "no node is loaded to its strength before the run ends: nothing will slip"),
        ("contact.patches[0].initial.load=70 MPa", "0 of 256 nodes slip at once, 25 are locked; the others are 0 Pa or more below"),
        ("contact.replicas=true", "the contact repeats itself every 40 km, and waves of its replicas arrive"),
        ("run.duration=3 s", "the run ends before the first echo returns at R = 5.71429 s"),
        ("body.normal_stress=1 Pa", "the normal stress is 1 Pa"),
    ],
)
def test_check_asks_about_numbers(command: Command, change: str, warning: str) -> None:
    assert warning in " ".join(command("check", "planar-patch", "--set", change).out.split())


def test_nodes_half_a_pascal_above_their_strength_slip(command: Command) -> None:
    out = command("check", "planar-patch", "--set", "contact.patches[0].initial.load=70000000.5 Pa").out
    assert "51 of 256 nodes slip at once" in out
    assert "nothing will slip" not in out


@pytest.mark.parametrize(
    ("outside", "warning"),
    [
        ("friction.static = 30", "the static friction coefficient is 30"),
        ('initial.load = "60 MPa"', "waves of its replicas arrive"),
    ],
    ids=["strongest place", "two loads"],
)
def test_check_looks_at_every_place(command: Command, tmp_path: Path, outside: str, warning: str) -> None:
    text = library.text("planar-patch").replace("locked = true", outside).replace("replicas = false", "replicas = true")
    (tmp_path / "open.toml").write_text(text)
    assert warning in " ".join(command("check", "open.toml").out.split())


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", [name for name in COMMANDS if name not in WITHOUT_SCENARIO | WITH_CONTACT])
def test_what_is_for_one_place_is_refused_in_one_line(command: Command, name: str) -> None:
    said = command(name, *IN_1D[name]).refusal
    assert said.startswith(f"{name}: planar-patch has a [contact] of many nodes, for which there are `stickslip run`")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--path", "a.png"), "run: a [contact] of many nodes has --figure and --animation: leave out --path"),
        (("--space-time", "a.png", "--energy-figure", "b.png"), "leave out --energy-figure, --space-time"),
        (("--rtol", "1e-8"), "run: --rtol has no effect with a [contact], whose nodes and courant set the accuracy: leave it out"),
        (("--events", "3"), "run: --events has no effect"),
        (("--catalogue", "a.csv"), "run: --catalogue has no effect"),
        (("--out", "a.nc"), "--out a.nc: the name must end in .zarr"),
        (("--out", "none/a.zarr"), "there is no folder none"),
        (("--set", "contact.nodes=many"), "contact.nodes must be a number, got 'many'"),
        (("--set", "patches[7].taper=3"), "'patches[7].taper' is not a parameter of this scenario"),
        (("--duration", "10 days"), "864000 s without replicas need 19353856 nodes"),  # 256 and 3.5 km/s x 864000 s / 156.25 m
    ],
)
def test_options_that_it_does_not_have_are_refused_in_one_line(command: Command, options: tuple[str, ...], said: str) -> None:
    assert said in command("run", "planar-patch", *options).refusal


@pytest.mark.parametrize("more", [("planar-plane",), ("planar-patch", "--record", "a.csv")])
def test_the_explorer_is_for_a_line_without_a_record(command: Command, more: tuple[str, ...]) -> None:
    said = command("explore", *more, "--no-browser").refusal
    assert said.startswith("explore: a fault in 3D and a record behind a fault are not shown")


def test_check_refuses_figures_of_a_single_place(command: Command) -> None:
    assert "leave them out with a [contact]" in command("check", "planar-patch", "--figure", "a.png").refusal


@pytest.mark.slow
def test_an_interrupted_run_is_shown_and_resumed(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    class Interrupted(Interrupts):
        def __init__(self) -> None:
            super().__init__()
            self.noted = True  # as by a Ctrl-C during the first steps

    with monkeypatch.context() as patched:
        patched.setattr("stickslip.run.run_loop.Interrupts", Interrupted)
        shown = command("run", *SMALL, "--out", "fault.zarr")
    assert (shown.code, shown.err) == (130, "stickslip: interrupted\n")
    assert "\ninterrupted: " in shown.out
    shown = command("show", "fault.zarr", "--figure", "a.png")
    assert shown.code == 0
    assert shown.out.startswith("A fault in 2D: a nucleus between barriers: contact.nodes = 64\n64 nodes, ")
    for arguments, said in (
        (("run", *SMALL, "--out", "fault.zarr"), "--out fault.zarr: exists: --resume fault.zarr continues"),
        (("run", "--resume", "fault.zarr", "--out", "more.zarr"), "run: --resume fault.zarr continues in its own folder"),
        (("run", "planar-patch", "--resume", "fault.zarr"), "another problem than planar-patch: its [contact] differs"),
        (("run", "planar-plane", "--resume", "fault.zarr"), "another problem than planar-plane: its body is"),
        (("show", "fault.zarr", "--path", "p.png"), "fault.zarr: a [contact] of many nodes has --figure and --animation"),
        (("show", "fault.zarr", "--quantity", "slip"), "show: --quantity chooses what is drawn of a sweep"),
        (("compare", "fault.zarr", "fig6-slab"), "fault.zarr: a folder of results, not a scenario"),
    ):
        assert said in command(*arguments).refusal
    shown = command("run", "--resume", "fault.zarr")
    assert shown.code == 0
    assert "27% of the contact slips" in shown.out
    expected = ss.scenarios["planar-patch"].with_values({"contact.nodes": 64, "run.duration": 1.0})
    again = read_scenario(command("show", "fault.zarr", "--scenario").out, "again")
    assert again.table("contact") == replace(expected.table("contact"), frames=100)
    assert (again.problem, again.duration) == (expected.problem, 1.0)


def test_a_missing_library_is_named(command: Command, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "stickslip.extensions.planar.solver", None)
    shown = command("run", *SMALL)
    assert shown.code == 2
    assert "pip install 'stickslip[planar]'" in shown.err


def test_the_shell_completes_the_numbers_of_a_contact() -> None:
    assert complete_scenario("planar") == ["planar-patch", "planar-plane", "planar-pulse"]
    context = Context.__new__(Context)
    context.params, context.args = {"scenario": "planar-patch"}, []
    assert {"contact.nodes=", "contact.patches[0].initial.load="} <= set(complete_vary(context, "contact."))
