"""The table [contact]: what varies along a contact in 2D and 3D, from a file, against closed forms; mistakes in one line."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.contact import Contact
from stickslip.extensions.planar.kind import PLANAR
from stickslip.extensions.planar.table import planar_slab_of
from stickslip.extensions.studies.compare import compare
from stickslip.problem.scenarios import Scenario, library, load_scenario, read_scenario
from stickslip.problem.scenarios.parameter_paths import parameter_paths
from tests.messages import refused

NODE = """\
[body]
kind = "elastic-slab"
density = 2800
wave_speed = 3500
thickness = "10 km"
normal_stress = "100 MPa"
[friction]
kind = "linear-slip-weakening"
static = 0.7
dynamic = 0.5
distance = 0.4
[initial]
load = "60 MPa"
[run]
duration = "2 s"
"""
LINE = NODE + '[contact]\nnodes = 32\nlength = "32 km"\n'
PLANE = LINE + 'width_nodes = 16\nwidth = "16 km"\n'
Y, Z = 1e3 * (np.arange(32) - 16.0), 1e3 * (np.arange(16) - 8.0)
LIST = ", ".join(["60e6"] * 32)
PATCH = '[[contact.patches]]\ny = ["-4 km", "4 km"]\ninitial.load = "71 MPa"\n'


def load_along(text: str) -> np.ndarray:
    """Return the initial load (MPa) at the nodes, or the friction that varies in its place."""
    return read_scenario(text, "my.toml").to_solve.values.load / 1e6


def test_a_patch_has_its_values_at_its_nodes_and_lies_on_those_before() -> None:
    second = PATCH.replace("-4 km", "2 km").replace("71 MPa", "73 MPa")
    expected = np.where((Y >= 2e3) & (Y <= 4e3), 73.0, np.where(np.abs(Y) <= 4e3, 71.0, 60.0))
    assert np.array_equal(load_along(LINE + PATCH + second), expected)


def test_a_taper_is_linear() -> None:
    beyond = np.maximum(np.abs(Y) - 4e3, 0.0)
    expected = 60.0 + 11.0 * np.clip(1.0 - beyond / 5e3, 0.0, 1.0)
    assert load_along(LINE + PATCH + "taper = 5000\n") == pytest.approx(expected, rel=1e-14)


def test_outside_is_all_the_rest() -> None:
    locked = read_scenario(
        LINE + '[[contact.patches]]\ny = ["-10 km", "5 km"]\noutside = true\nlocked = true\n', "x"
    ).to_solve.locked
    assert np.array_equal(locked, (Y < -10e3) | (Y > 5e3))


def test_a_later_patch_may_unlock() -> None:
    text = (
        LINE
        + "[contact.along]\nlocked = ["
        + ", ".join(["true"] * 32)
        + ']\n[[contact.patches]]\ny = [0, "3 km"]\nlocked = false\n'
    )
    assert np.array_equal(~read_scenario(text, "x").to_solve.locked, (Y >= 0) & (Y <= 3e3))


def test_points_are_joined_by_straight_lines_with_steps_where_a_place_stands_twice() -> None:
    text = LINE + '[contact.along]\ninitial.load = {y = [-8000, "0 km", "0 km", 4000], values = [60e6, "64 MPa", 68e6, 60e6]}\n'
    expected = np.where(Y < 0, 64.0 + 4.0 * np.maximum(Y, -8e3) / 8e3, 68.0 - 8.0 * np.minimum(Y, 4e3) / 4e3)
    assert load_along(text) == pytest.approx(expected, rel=1e-14)


def test_values_at_the_nodes_are_taken_as_they_are() -> None:
    values = np.round(np.random.default_rng(1).uniform(50, 65, (32, 16)), 3)
    rows = ", ".join(str([f"{one} MPa" for one in row]) for row in values.tolist())
    assert load_along(PLANE + f"[contact.along]\ninitial.load = [{rows}]\n") == pytest.approx(values, rel=1e-15)
    assert load_along(LINE + f"[contact.along]\ninitial.load = {[1e6 * one for one in values[:, 0].tolist()]}\n") == pytest.approx(
        values[:, 0], rel=1e-15
    )


def test_an_ellipse_grows_by_its_taper() -> None:
    """Inside 71 MPa, beyond both half axes and the taper 60, and half way between on the axes."""
    patch = PATCH + 'shape = "ellipse"\nz = ["-2 km", "2 km"]\ntaper = "2 km"\n'
    load, y, z = load_along(PLANE + patch), Y[:, None], Z[None, :]
    assert np.all(load[(y / 4e3) ** 2 + (z / 2e3) ** 2 <= 1.0] == 71.0)
    assert np.all(load[(y / 6e3) ** 2 + (z / 4e3) ** 2 >= 1.0] == 60.0)
    assert [load[16 + 5, 8], load[16, 8 - 3]] == pytest.approx([65.5, 65.5], rel=1e-14)


def test_a_box_has_round_corners_of_the_taper() -> None:
    load = load_along(PLANE + PATCH + 'z = [0, "2 km"]\ntaper = "5 km"\n')
    assert load[16 + 4 + 3, 8 + 2 + 2] == pytest.approx(60.0 + 11.0 * (1.0 - np.hypot(3.0, 2.0) / 5.0), rel=1e-14)


def test_friction_and_normal_stress_vary_and_short_names_do() -> None:
    patch = '[[contact.patches]]\ny = [-1e3, 1e3]\nstatic = 0.8\nbody = {normal_stress = "90 MPa"}\n"initial.slip" = "1 cm"\n'
    values = read_scenario(LINE + patch, "x").to_solve.values
    middle = np.abs(Y) <= 1e3
    assert np.array_equal(values.normal, np.where(middle, 90e6, 100e6))
    assert np.array_equal(values.slip, np.where(middle, 0.01, 0.0))
    assert {one.friction.static for one in values.problems} == {0.7, 0.8}


@pytest.mark.parametrize("text", [LINE, LINE + PATCH, PLANE + PATCH + 'shape = "ellipse"\nz = [-2e3, 2e3]\ntaper = 7.1\n'])
@pytest.mark.parametrize(
    "more",
    ["", "[contact.along]\ndynamic = {y = [0, 1, 1], values = [0.1, 0.2, 0.3]}\n", "frames = 7\nreplicas = false\ncourant = 0.3\n"],
)
def test_a_scenario_is_written_and_read_back_exactly(text: str, more: str) -> None:
    at = text.index("[contact]\n") + len("[contact]\n") if more.startswith("frames") else len(text)
    scenario = read_scenario(text[:at] + more + text[at:], "my.toml")
    again = read_scenario(scenario.to_toml(), "again")
    assert again == scenario
    assert again.to_toml() == scenario.to_toml()
    for name in ("load", "normal", "slip"):
        assert np.array_equal(getattr(again.to_solve.values, name), getattr(scenario.to_solve.values, name))


def test_profiles_of_a_planar_slab_become_lists() -> None:
    problem = load_scenario("planar-patch").problem
    slab = ss.PlanarSlab(
        problem,
        nodes=32,
        length=32e3,
        along={"load": lambda y: 60e6 + 10e6 * np.exp(-((y / 3e3) ** 2)), "friction.static": np.linspace(0.7, 0.8, 32)},
        barrier=lambda y: np.abs(y) > 9e3,
    )
    scenario = Scenario(problem, 2.0, tables=(("contact", Contact.of(slab)),))
    again = read_scenario(scenario.to_toml(), "again")
    assert again == scenario
    assert np.array_equal(again.to_solve.values.load, slab.values.load)
    assert np.array_equal(again.to_solve.locked, slab.locked)


def test_other_values_are_put_into_patches_and_sizes() -> None:
    scenario = load_scenario("planar-patch")
    changed = scenario.with_values(
        {
            "contact.nodes": 64,
            "patches[0].initial.load": "72 MPa",
            "contact.patches[1].y[0]": "-17 km",
            "patches[0].taper": 500,
            "static": 0.71,
        }
    )
    slab = changed.to_solve
    assert slab.shape == (64,)
    assert slab.values.load.max() == 72e6
    assert slab.y[~slab.locked].min() >= -17e3 > slab.y[~slab.locked].min() - slab.spacing[0]
    assert changed.table("contact").patches[0].taper == 500.0
    for one in parameter_paths(scenario):
        assert one.name in {other.name for other in parameter_paths(changed)}


def test_a_name_or_a_file_is_run_with_its_duration_and_frames(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "mine.toml"
    file.write_text((LINE + PATCH).replace("nodes = 32", "nodes = 32\nframes = 20"))
    shown = replace(PLANAR, run=lambda found, options: (found.to_solve.shape, options.duration, dict(options.of_solver)))
    monkeypatch.setattr("stickslip.extensions.planar.kind.PLANAR", shown)
    assert ss.simulate(file) == ((32,), 2.0, {})
    assert ss.simulate(str(file), "1 s", frames=5) == ((32,), "1 s", {"frames": 5})
    assert ss.simulate("planar-plane") == ((48, 40), 4.5, {})
    with pytest.raises(ss.InputError, match="a PlanarSlab has no rtol"):
        ss.simulate("planar-patch", rtol=1e-8)


CLUMSY = [
    ("nodes = 32", "nodes = 33", "[contact] nodes must be an even whole number, at least 8, got 33"),
    ("nodes = 32", "nodes = 32.5", "[contact] nodes must be a whole number, got 32.5"),
    ("nodes = 32", "nodes = 1_000_000_000", "[contact] a contact may have 4194304 nodes, got 1000000000"),
    ("nodes = 32", 'nodes = "many"', "[contact] nodes must be a number, got 'many'"),
    ("nodes = 32\n", "", "[contact] nodes is missing: number of nodes along y, even, no unit, at least 8"),
    ("nodes = 32", "node = 32", "[contact] node is unknown; did you mean 'nodes'?"),
    ('length = "32 km"\n', "", "[contact] length is missing: length of the contact along y, in m, above 0"),
    ('length = "32 km"', "length = nan", "[contact] length must be finite, got nan"),
    ('length = "32 km"', 'length = "32 s"', "got '32 s': 's' does not convert to m"),
    ("nodes = 32", "nodes = 32\nwidth = 3e3", "[contact] width and width_nodes belong together"),
    ("nodes = 32", "nodes = 32\nreplicas = 1", "[contact] replicas must be true or false, got 1"),
    ("nodes = 32", "nodes = 32\ncourant = 0.9", "[contact] courant must be at most 0.796 here, got 0.9"),
    ("nodes = 32", "nodes = 32\nload = 3", "[contact] load is unknown; it belongs in [initial]"),
    (PATCH, "patches = 3", "[contact] patches must be tables, each after a line [[contact.patches]], got 3"),
    ("nodes = 32", "nodes = 32\nalong = 3", "[contact] along must be a table of what varies along the contact, got 3"),
    ("[contact]", "[contcat]", "[contcat] is unknown; did you mean 'contact'?"),
    ('duration = "2 s"', 'duration = "2 s"\nnodes = 32', "[run] nodes is unknown; it belongs in [contact]"),
    ('duration = "2 s"', 'duration = "2 s"\nrtol = 1e-9', "[run] rtol has no effect with a [contact], whose nodes and"),
    ('duration = "2 s"', 'duration = "2 s"\nevents = 3', "[run] events has no effect with a [contact]"),
    ('"linear-slip-weakening"\nstatic = 0.7\ndynamic = 0.5\ndistance = 0.4', '"coulomb"\nstatic = 1\ndynamic = 0', "no selection"),
    ('thickness = "10 km"', 'thickness = "10 km"\ncontact_mass = 3', "[contact] contact_mass must be 0"),
    ('load = "60 MPa"', "excess = 0", "[contact] initial.load varies, but [initial] gives excess: give the same of them in both"),
    ('y = ["-4 km", "4 km"]', 'y = ["4 km", "-4 km"]', "[contact.patches[0]] y must go from the smaller to the larger end"),
    ('y = ["-4 km", "4 km"]', "y = [1, 2, 3]", "[contact.patches[0]] y must be an interval such as"),
    ('y = ["-4 km", "4 km"]', 'y = ["-4 MPa", "4"]', "'MPa' does not convert to m"),
    ('y = ["-4 km", "4 km"]', 'y = ["20 km", "30 km"]', "[contact] patches[0] has no node: nodes lie at y = -16000 to 15000 m"),
    ('y = ["-4 km", "4 km"]\n', "", "[contact.patches[0]] needs y, an interval such as"),
    ('y = ["-4 km", "4 km"]', 'y = [-4e3, 4e3]\nz = [-4e3, 4e3]', "[contact.patches[0]] z is for a plane"),
    ('y = ["-4 km", "4 km"]', 'y = [-4e3, 4e3]\nshape = "ellipse"', "[contact.patches[0]] an ellipse needs y and z, on a plane"),
    ('y = ["-4 km", "4 km"]', 'y = [-4e3, 4e3]\nshape = "elipse"', "shape 'elipse' is unknown; did you mean 'ellipse'?"),
    ('y = ["-4 km", "4 km"]', 'y = [-4e3, 4e3]\nlocked = "yes"', "[contact.patches[0]] locked must be true or false, got 'yes'"),
    ('y = ["-4 km", "4 km"]', "y = [-4e3, 4e3]\nlocked = true\ntaper = 3", "[contact.patches[0]] a locked patch has no taper"),
    ('y = ["-4 km", "4 km"]', "y = [-4e3, 4e3]\ntaper = -3", "[contact.patches[0]] taper must be at least 0 m, got -3"),
    ('y = ["-4 km", "4 km"]', "y = [-4e3, 4e3]\ntapper = 3", "[contact.patches[0]] 'tapper' is not a number that can vary"),
    ("initial.load =", "initial.laod =", "did you mean 'initial.load'?"),
    ("initial.load =", "initial.excess =", "[contact] initial.excess varies, but [initial] gives load"),
    ("initial.load =", "body.thickness =", "'body.thickness' is not a number that can vary along the contact"),
    ('initial.load = "71 MPa"', "static = -0.1", "[contact.patches[0]] static must be at least 0 (a pure number), got -0.1"),
    ('initial.load = "71 MPa"', "static = 0.8\nfriction.static = 0.8", "[contact.patches[0]] friction.static is given twice"),
    ('initial.load = "71 MPa"', "", "[contact.patches[0]] says nothing: give locked = true, or a number such as"),
    ("PATCH", "initial.load = 61e6", "[contact.along] initial.load must be a list with a value for each node, or a table of"),
    ("PATCH", "initial.load = [61e6, 62e6]", "[contact] along.initial.load must have 32 values, one for each node, got 2"),
    ("PATCH", f"initial.load = [{LIST.replace('60e6', '[60e6, 61e6]')}]", "must have 32 values, one for each node, got 32 lists"),
    ("PATCH", f"initial.load = [{LIST[:-4]}nan]", "[contact.along] initial.load[31] must be finite, got nan"),
    ("PATCH", "locked = {y = [1, 2], values = [true, false]}", "[contact.along] locked must be a list with a value for each node"),
    ("PATCH", f"locked = [{LIST}]", "[contact.along] locked[0] must be true or false, got 60000000.0"),
    ("PATCH", "initial.load = {y = [1, 2], values = [1]}", "must have a list y and a list of as many values"),
    ("PATCH", "initial.load = {y = [2, 1], values = [1, 2]}", "initial.load.y must ascend, where a step is the same place twice"),
    ("PATCH", "initial.load = {values = [1, 2]}", "must be a list with a value for each node, or a table of y and values"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "message"), CLUMSY)
def test_a_mistake_is_one_line_that_says_where_and_what_is_allowed(old: str, new: str, message: str) -> None:
    text = LINE + "[contact.along]\n" + new if old == "PATCH" else (LINE + PATCH).replace(old, new, 1)
    assert old == "PATCH" or old in LINE + PATCH
    with refused(message, begins="my.toml: "):
        read_scenario(text, "my.toml")


def test_rows_of_a_plane_must_have_one_value_for_each_node() -> None:
    rows = ", ".join(["[" + ", ".join(["60e6"] * 16) + "]"] * 31 + ["[60e6]"])
    with pytest.raises(ss.InputError, match=r"must have 32 lists of 16 values, one for each node, got 32 lists of 1 or 16$"):
        read_scenario(PLANE + f"[contact.along]\ninitial.load = [{rows}]\n", "my.toml")


REFUSING = {
    "uniqueness": lambda name: ss.uniqueness(name),
    "catalogue": lambda name: ss.catalogue(name, "events.csv"),
    "sweep": lambda name: ss.sweep(name, {"friction.static": [0.7]}),
    "compare": lambda name: compare(name, "fig6-slab"),
}


@pytest.mark.parametrize("what", REFUSING)
def test_what_is_for_problems_in_1d_says_so_in_one_line(what: str) -> None:
    with pytest.raises(ss.InputError, match=rf"^{what}: planar-patch has a \[contact\] of many nodes, .* leave out \[contact\]"):
        REFUSING[what]("planar-patch")


def test_the_scenarios_in_1d_are_those_without_a_contact() -> None:
    assert library.in_1d() == [name for name in library.names() if load_scenario(name).is_of_core]
    with pytest.raises(ss.InputError, match=r"^fig6-slab: has no \[contact\] of many nodes"):
        planar_slab_of(load_scenario("fig6-slab"))
