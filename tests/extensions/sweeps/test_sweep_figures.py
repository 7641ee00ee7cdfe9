"""Figures of sweeps show the numbers of the dataset, in units in which they can be read, and what has no number."""

from __future__ import annotations

import json
from itertools import permutations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from matplotlib import pyplot
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PathCollection, QuadMesh
from matplotlib.colors import LogNorm, to_rgba
from matplotlib.figure import Figure
from matplotlib.image import imread
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extensions.sweeps.figures.curves import ALL, BESIDE
from stickslip.extensions.sweeps.figures.varied import is_logarithmic
from stickslip.figures.style import PALE
from stickslip.problem.scenarios.parameter_paths import parameter_paths

Floats = NDArray[np.float64]
pytestmark = pytest.mark.usefixtures("closed_figures")
ALPHA, THICKNESS, STRESS = "friction.alpha", "body.thickness", "body.normal_stress"
RULES = np.array(["perfect-delay", "minimal", "maximal", "maxwell", "middle"], np.dtypes.StringDType())
ABOUT = {one.name: {"long_name": one.declared.meaning, "units": one.unit} for one in parameter_paths(ss.load_scenario("fig6-slab"))}
NAMES = {
    ALPHA: r"weakening parameter $\alpha$ (s/m)",
    THICKNESS: "thickness $h$ (km)",
    STRESS: "normal stress $S$ on the contact (MPa)",
}
AXES = {
    "run.selection": RULES,
    ALPHA: np.linspace(0.1, 2.0, 9),
    THICKNESS: np.geomspace(1e3, 64e3, 13),
    STRESS: np.array([50e6, 100e6]),
}
FAILED, NOT_RUN = 10, -1


def grid(values: Floats, *names: str, status: Any = 0, **about: Any) -> xr.Dataset:
    """What a sweep over these keys returns."""
    coordinates = {name: xr.Variable(name, AXES[name][:size], ABOUT[name]) for name, size in zip(names, values.shape, strict=True)}
    attributes = {"units": "1", "long_name": "pulses of all slip events"} | about
    variables = {"answer": (names, values, attributes), "status": (names, np.broadcast_to(np.int8(status), values.shape).copy())}
    design = {
        "design": json.dumps({"design": "grid", "keys": list(names)}),
        "title": "stickslip sweep: ElasticSlab, Coulomb",
        "scenario": 'title = "Any scenario"',
    }
    return xr.Dataset(variables, coords=coordinates, attrs=design)


def members(answers: Floats, status: Any = 0, **columns: Floats) -> xr.Dataset:
    """What a sweep over samples returns."""
    named = {name.replace("__", "."): values for name, values in columns.items()}
    coordinates = {name: xr.Variable("member", values, ABOUT[name]) for name, values in named.items()}
    status = np.broadcast_to(np.int8(status), answers.shape).copy()
    variables = {"answer": ("member", answers, {"units": "m", "long_name": "slip"}), "status": ("member", status)}
    return xr.Dataset(variables, coords=coordinates, attrs={"design": json.dumps({"design": "lhs", "keys": list(named)})})


def meshes(figure: Figure, which: int) -> QuadMesh:
    """The mesh of areas without a number (0) or of the numbers (1)."""
    found = [one for one in figure.axes[0].collections if isinstance(one, QuadMesh)]
    return found[which]


def legend(figure: Figure) -> list[str]:
    return [text.get_text() for one in figure.legends for text in one.get_texts()]


def test_a_map_shows_every_member_at_its_place_and_ends_where_its_values_end() -> None:
    values = np.add.outer(np.arange(9.0), np.arange(13.0) // 6)
    figure = ss.figures.plot_sweep(grid(values, ALPHA, THICKNESS), "answer")
    axes, mesh = figure.axes[0], meshes(figure, 1)
    assert (axes.get_xlabel(), axes.get_ylabel()) == (NAMES[ALPHA], NAMES[THICKNESS])
    assert (axes.get_xscale(), axes.get_yscale()) == ("linear", "log")
    assert axes.get_title(loc="left") == "Any scenario"
    assert np.array_equal(mesh.get_array(), values.T)
    edges = np.asarray(mesh.get_coordinates())
    alpha, thickness = edges[0, :, 0], edges[:, 0, 1]
    assert alpha[[0, 1, -1]] == pytest.approx([0.1, 0.1 + 0.11875, 2.0], rel=1e-12)
    assert thickness[[0, 1, -1]] == pytest.approx([1.0, 2.0**0.25, 64.0], rel=1e-12)  # km, halfway in equal ratios
    assert (axes.get_xlim(), axes.get_ylim()) == (tuple(alpha[[0, -1]]), tuple(thickness[[0, -1]]))


def test_few_whole_numbers_have_a_colour_each_and_a_key() -> None:
    values = np.add.outer(np.arange(9) % 2, 2.0 * (np.arange(13) % 2))
    figure = ss.figures.plot_sweep(grid(values, ALPHA, THICKNESS), "answer")
    assert legend(figure) == ["0", "1", "2", "3"]
    assert figure.legends[0].get_title().get_text() == "pulses of all slip events"
    mesh = meshes(figure, 1)
    shades = {tuple(mesh.to_rgba(np.array([value]))[0]) for value in range(4)}
    assert len(shades) == 4
    keys = {tuple(patch.get_facecolor()) for patch in figure.legends[0].get_patches()}
    assert keys == shades


def test_flags_are_named_in_the_legend() -> None:
    figure = ss.figures.plot_sweep(grid(np.ones((9, 13)), ALPHA, THICKNESS, flag_meanings="no yes"), "answer")
    assert legend(figure) == ["no", "yes"]


def test_what_has_no_number_is_told_apart() -> None:
    values = np.ones((9, 13))
    values[:3] = np.nan
    status = np.zeros((9, 13))
    status[1], status[2] = FAILED, NOT_RUN
    figure = ss.figures.plot_sweep(grid(values, ALPHA, THICKNESS, status=status), "answer")
    assert legend(figure) == ["1", "undefined for this run", "not run", "failed"]
    assert figure.axes[0].patch.get_hatch() == "////"
    blank, mesh = meshes(figure, 0), meshes(figure, 1)
    hidden = np.ma.getmaskarray(mesh.get_array())
    assert hidden[:, :3].all()
    assert not hidden[:, 3:].any()
    drawn = np.ma.getmaskarray(blank.get_array())
    assert [bool(drawn[:, k].all()) for k in range(4)] == [False, True, False, True]  # the failed lie open to the background
    assert tuple(blank.to_rgba(np.array([1]))[0]) == to_rgba(PALE)
    assert tuple(blank.to_rgba(np.array([3]))[0]) == to_rgba("white")


def test_without_failures_there_is_no_hatching() -> None:
    figure = ss.figures.plot_sweep(grid(np.ones((9, 13)), ALPHA, THICKNESS), "answer")
    assert figure.axes[0].patch.get_hatch() is None
    assert legend(figure) == ["1"]


def test_numbers_over_decades_have_a_logarithmic_scale_in_a_readable_unit() -> None:
    values = np.outer(np.geomspace(1.0, 1e4, 9), np.linspace(1.0, 2.0, 13)) * ss.YEAR
    figure = ss.figures.plot_sweep(grid(values, ALPHA, THICKNESS, units="s", long_name="recurrence"), "answer")
    bar = figure.axes[1]
    assert bar.get_ylabel() == "recurrence (year)"
    norm = meshes(figure, 1).norm
    assert isinstance(norm, LogNorm)
    assert (norm.vmin, norm.vmax) == pytest.approx((1.0, 2e4), rel=1e-12)


def test_three_keys_are_maps_side_by_side_with_the_same_colours() -> None:
    values = np.add.outer(np.add.outer(np.arange(9) % 2, np.arange(13) % 2), np.array([0.0, 2.0]))
    figure = ss.figures.plot_sweep(grid(values, ALPHA, THICKNESS, STRESS), "answer")
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)  $S$ = 50 MPa", "(b)  $S$ = 100 MPa"]
    assert figure.get_suptitle() == "Any scenario. Panels: normal stress S on the contact"
    for k, axes in enumerate(figure.axes):
        mesh = [one for one in axes.collections if isinstance(one, QuadMesh)][1]
        assert np.array_equal(mesh.get_array(), values[:, :, k].T)
        assert tuple(mesh.to_rgba(np.array([2.0]))[0]) == figure.legends[0].get_patches()[2].get_facecolor()


def test_one_key_is_a_curve_with_gaps() -> None:
    values = np.array([1.0, 2.0, np.nan, 4.0, 5.0])
    figure = ss.figures.plot_sweep(grid(values, ALPHA, status=[0, 0, FAILED, 0, 0]), "answer")
    curve, cross = figure.axes[0].lines
    assert np.array_equal(curve.get_ydata(), values, equal_nan=True)
    assert cross.get_xdata().tolist() == [AXES[ALPHA][2]]
    assert legend(figure) == [ALL, "failed"]
    assert figure.axes[0].get_ylabel() == "pulses of all slip events"


def test_members_without_a_number_are_marked_by_why_they_have_none() -> None:
    values = np.array([1.5, np.nan, np.nan, np.nan, 5.0])
    figure = ss.figures.plot_sweep(grid(values, ALPHA, status=[0, 0, FAILED, NOT_RUN, 0]), "answer")
    marks = {line.get_label(): line.get_xdata().tolist() for line in figure.axes[0].lines[1:]}
    places = AXES[ALPHA]
    assert marks == {"undefined for this run": [places[1]], "failed": [places[2]], "not run": [places[3]]}
    assert legend(figure) == list(marks)


def test_few_values_of_a_second_key_are_a_family_of_curves() -> None:
    values = np.add.outer(0.5 * np.arange(9), np.array([0.0, 10.0]))
    figure = ss.figures.plot_sweep(grid(values, ALPHA, STRESS), "answer")
    assert legend(figure) == ["50 MPa", "100 MPa"]
    assert figure.legends[0].get_title().get_text() == "normal stress $S$ on the contact"
    for k, line in enumerate(figure.axes[0].lines):
        assert np.array_equal(line.get_xydata(), np.stack([AXES[ALPHA], values[:, k]], axis=1))


def test_a_curve_is_interrupted_where_it_jumps_and_says_so() -> None:
    alpha = AXES[ALPHA]
    values = np.where(alpha < 1.0, 1e-7, 1.0) * (1.0 + 0.1 * alpha)
    figure = ss.figures.plot_sweep(grid(values, ALPHA, units="m", long_name="slip"), "answer")
    axes = figure.axes[0]
    assert axes.get_yscale() == "log"
    (lines,) = [one for one in axes.collections if isinstance(one, LineCollection)]
    drawn = np.array([segment[:, 0] for segment in lines.get_segments()])
    neighbours = np.stack([alpha[:-1], alpha[1:]], axis=1)
    assert np.array_equal(drawn, neighbours[(neighbours < 1.0).all(axis=1) | (neighbours >= 1.0).all(axis=1)])
    assert legend(figure) == [ALL]


def test_a_smooth_curve_is_one_line_without_a_key() -> None:
    figure = ss.figures.plot_sweep(grid(np.exp(3.0 * AXES[ALPHA]) + 0.5, ALPHA), "answer")
    (lines,) = [one for one in figure.axes[0].collections if isinstance(one, LineCollection)]
    assert len(lines.get_segments()) == len(AXES[ALPHA]) - 1
    assert legend(figure) == []


def test_of_many_members_those_beside_a_jump_are_marked() -> None:
    x = np.linspace(0.0, 1.0, 90)
    coordinate = {ALPHA: xr.Variable(ALPHA, x, ABOUT[ALPHA])}
    values = np.where(x < 0.5, 0.1 * x, 1.0 - 0.1 * x)
    dataset = grid(np.zeros(9), ALPHA).drop_vars(["answer", "status", ALPHA]).assign_coords(coordinate)
    dataset = dataset.assign(answer=(ALPHA, values, {"units": "m", "long_name": "slip"}), status=(ALPHA, np.zeros(90, np.int8)))
    figure = ss.figures.plot_sweep(dataset, "answer")
    (line,) = figure.axes[0].lines
    assert line.get_markevery() == [44, 45]
    assert legend(figure) == [BESIDE]


def test_a_curve_and_a_map_are_drawn_in_axes_of_the_user() -> None:
    for values, names in ((np.arange(9.0), (ALPHA,)), (np.add.outer(np.arange(9.0), np.arange(13.0)), (ALPHA, THICKNESS))):
        _, (left, right) = pyplot.subplots(1, 2)
        assert ss.figures.plot_sweep(grid(values, *names), "answer", ax=right) is right
        assert right.get_xlabel() == NAMES[ALPHA]
        assert right.get_title(loc="left") == ""
        assert not left.has_data()
    with pytest.raises(ss.InputError, match="several panels"):
        ss.figures.plot_sweep(grid(np.ones((9, 13, 2)), ALPHA, THICKNESS, STRESS), "answer", ax=right)


def test_a_figure_has_the_size_and_the_dots_that_are_asked_for(tmp_path: Path) -> None:
    path = tmp_path / "map.png"
    ss.figures.plot_sweep(grid(np.ones((9, 13)), ALPHA, THICKNESS), "answer", path, size=(4.0, 3.0), dpi=100)
    assert imread(path).shape[:2] == (300, 400)


def test_words_label_their_places_on_the_axis() -> None:
    dataset = grid(np.arange(9.0), ALPHA).assign_coords({ALPHA: ("friction.alpha", [f"rule{k}" for k in range(9)])})
    figure = ss.figures.plot_sweep(dataset, "answer")
    assert [text.get_text() for text in figure.axes[0].get_xticklabels()] == [f"rule{k}" for k in range(9)]


def scattered(axes: Axes) -> list[PathCollection]:
    return [one for one in axes.collections if isinstance(one, PathCollection) and len(one.get_offsets())]


def test_samples_over_two_keys_are_points() -> None:
    alpha, thickness = np.array([0.1, 0.5, 2.0, 1.0]), np.array([1e3, 2e3, 50e3, 4e3])
    figure = ss.figures.plot_sweep(
        members(np.array([0.5, 1.5, 3.0, np.nan]), [0, 0, 0, FAILED], friction__alpha=alpha, body__thickness=thickness)
    )
    crosses, points = scattered(figure.axes[0])
    assert np.asarray(points.get_offsets()) == pytest.approx(np.stack([alpha, thickness / 1e3], axis=1)[:3], rel=1e-15)
    assert np.asarray(points.get_array()) == pytest.approx([0.5, 1.5, 3.0], rel=1e-15)
    assert np.asarray(crosses.get_offsets()).tolist() == [[1.0, 4.0]]
    assert legend(figure) == ["failed"]


def test_samples_over_three_keys_are_drawn_over_each() -> None:
    columns = {
        "friction__alpha": AXES[ALPHA],
        "body__thickness": AXES[THICKNESS][:9],
        "body__normal_stress": np.linspace(5e7, 9e7, 9),
    }
    figure = ss.figures.plot_sweep(members(np.arange(9.0) / 2.0, **columns), "answer")
    assert [axes.get_xlabel().replace("\n", " ") for axes in figure.axes] == [NAMES[ALPHA], NAMES[THICKNESS], NAMES[STRESS]]
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)", "(b)", "(c)"]
    for axes, (values, size) in zip(figure.axes, zip(columns.values(), (1.0, 1e3, 1e6), strict=True), strict=True):
        assert axes.lines[0].get_xydata() == pytest.approx(np.stack([values / size, np.arange(9.0) / 2.0], axis=1), rel=1e-15)


@pytest.fixture(scope="module")
def swept() -> xr.Dataset:
    return ss.sweep("fig6-slab", {ALPHA: AXES[ALPHA], STRESS: np.linspace(50e6, 200e6, 5)}, quantities=["irregular"], threads=1)


def test_the_title_is_that_of_the_scenario_without_what_is_varied(swept: xr.Dataset) -> None:
    """The scenario is called "Fig. 6, slab, rate law, alpha = 1", and alpha is on an axis here."""
    assert ss.figures.plot_sweep(swept).axes[0].get_title(loc="left") == "Fig. 6, slab, rate law"
    untitled = swept.assign_attrs(scenario="\n".join(swept.attrs["scenario"].splitlines()[2:]))
    assert not untitled.attrs["scenario"].startswith("title")
    assert ss.figures.plot_sweep(untitled).axes[0].get_title(loc="left") == ""


@pytest.mark.parametrize(("alphas", "thicknesses"), [(5, 1), (2, 5), (3, 4), (5, 2)])
def test_words_are_an_axis_of_curves_and_of_maps(alphas: int, thicknesses: int) -> None:
    """They stay in the order given. `sweep` returns words in numpy's own data type of text."""
    values = np.arange(5.0 * alphas * thicknesses).reshape(5, alphas, thicknesses)
    dataset = grid(values, "run.selection", ALPHA, THICKNESS)
    figure = ss.figures.plot_sweep(dataset, "answer")
    axes = figure.axes[0]
    assert [text.get_text() for text in axes.get_xticklabels()] == RULES.tolist()
    if min(alphas, thicknesses) > 1:
        first = values[:, 0, :] if alphas < thicknesses else values[:, :, 0]
        assert meshes(figure, 1).get_array().tolist() == first.T.tolist()


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("names", [*permutations(("run.selection", ALPHA, STRESS)), *permutations(("run.selection", ALPHA))])
def test_words_may_be_any_of_the_keys(names: tuple[str, ...]) -> None:
    sizes = {"run.selection": 3, ALPHA: 9, STRESS: 2}
    values = np.arange(float(np.prod([sizes[name] for name in names]))).reshape([sizes[name] for name in names])
    figure = ss.figures.plot_sweep(grid(values, *names), "answer")
    figure.canvas.draw()
    words = [text.get_text() for axes in figure.axes for text in (*axes.get_xticklabels(), *axes.get_yticklabels())]
    texts = {*words, *legend(figure), *(axes.get_title(loc="left").partition("  ")[2] for axes in figure.axes)}
    assert set(RULES[:3].tolist()) <= texts


@pytest.mark.parametrize("status", [FAILED, NOT_RUN, 0])
def test_a_sweep_without_numbers_can_be_drawn(status: int) -> None:
    nothing = np.full((9, 13), np.nan)
    assert len(ss.figures.plot_sweep(grid(nothing, ALPHA, THICKNESS, status=status)).axes) == 1  # no scale of nothing
    assert (
        not meshes(ss.figures.plot_sweep(grid(nothing, ALPHA, THICKNESS, status=status, units="s"), "answer"), 1)
        .get_array()
        .count()
    )
    ss.figures.plot_sweep(grid(nothing[:, 0], ALPHA, status=status), "answer")
    assert not scattered(
        ss.figures.plot_sweep(members(nothing[0], status, friction__alpha=AXES[THICKNESS], body__thickness=AXES[THICKNESS])).axes[0]
    )[1:]


def test_sweeps_that_cannot_be_drawn_are_refused() -> None:
    dataset = grid(np.ones((9, 13)), ALPHA, THICKNESS)
    with pytest.raises(ss.InputError, match="this sweep has no quantity 'anser'; did you mean 'answer'"):
        ss.figures.plot_sweep(dataset, "anser")
    with pytest.raises(ss.InputError, match="one member"):
        ss.figures.plot_sweep(grid(np.ones(1), ALPHA))
    with pytest.raises(ss.InputError, match="a grid of 4 keys: select some values first"):
        ss.figures.plot_sweep(dataset.expand_dims({"a": 2, "b": 2}), "answer")


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        (np.geomspace(1.0, 50.0, 7), True),
        (np.linspace(1.0, 50.0, 7), False),
        (np.geomspace(1.0, 2.0, 7), False),
        (np.linspace(-1.0, 5.0, 7), False),
        (np.array([1.0, 100.0]), False),
        (np.array([0.01, 0.1, 0.5, 2.0]), True),
    ],
)
def test_axes_are_logarithmic_where_values_are_spread_so(values: Floats, expected: bool) -> None:
    assert is_logarithmic(values) is expected


def test_a_map_and_curves_have_a_line_where_a_quantity_says_so() -> None:
    about = {"long_name": "severity", "line": 1.0, "line_name": "severity 1: full stick-slip"}
    rising = np.broadcast_to(np.linspace(0.2, 1.8, 9)[:, None], (9, 13)).copy()
    figure = ss.figures.plot_sweep(grid(rising, ALPHA, THICKNESS, **about), "answer")
    (line,) = [one for one in figure.axes[0].collections if type(one).__name__ == "QuadContourSet"]
    (path,) = line.get_paths()
    assert path.vertices[:, 0] == pytest.approx(np.full(len(path.vertices), AXES[ALPHA][4]), rel=1e-9)
    assert legend(figure) == ["severity 1: full stick-slip"]
    curve = ss.figures.plot_sweep(grid(rising[:, 0], ALPHA, **about), "answer")
    assert any(np.all(np.asarray(one.get_ydata()) == 1.0) for one in curve.axes[0].get_lines())
    assert "severity 1: full stick-slip" in legend(curve)


def test_a_map_on_one_side_of_the_line_has_none() -> None:
    about = {"line": 1.0, "line_name": "severity 1: full stick-slip"}
    figure = ss.figures.plot_sweep(grid(np.linspace(1.2, 1.8, 117).reshape(9, 13), ALPHA, THICKNESS, **about), "answer")
    assert legend(figure) == []


@pytest.mark.slow
def test_a_sweep_of_severity_says_where_its_line_is() -> None:
    rates = {"pull_rate": np.array([10.0, 14.0])}
    found = ss.sweep(ss.load_scenario("drill-string").problem, rates, duration="5 s", quantities=["severity"], workers=1)
    assert (found.severity.attrs["line"], found.severity.attrs["line_name"]) == (1.0, "severity 1: full stick-slip")
