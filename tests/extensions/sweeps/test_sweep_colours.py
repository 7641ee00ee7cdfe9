"""Colours of whole numbers, which readers with any colour vision can tell apart, and jumps of curves."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extensions.sweeps.figures.colours import COLOURS_IN_KEY, colours_of, shades
from stickslip.extensions.sweeps.figures.curves import jumps
from stickslip.extensions.sweeps.figures.varied import ShownQuantity
from stickslip.figures.names import parameter_name, plain_name, symbol
from stickslip.figures.panels import letter_panels, set_title
from stickslip.figures.style import image
from stickslip.foundation.names import readable_unit, sizes_of
from stickslip.problem.scenarios.library import names
from stickslip.problem.scenarios.parameter_paths import ParameterPath, parameter_paths
from tests.core.figures.legible import SIZES, SLAB_PROBLEM

pytestmark = pytest.mark.usefixtures("closed_figures")


def declared() -> list[ParameterPath]:
    """Every parameter that can be varied in some bundled scenario."""
    return [one for name in names() for one in parameter_paths(ss.load_scenario(name))]


@pytest.mark.parametrize(
    ("name", "meaning", "shown", "short"),
    [
        ("body.normal_stress", "normal stress S on the contact, compression positive", "normal stress $S$ on the contact", "$S$"),
        ("body.density", "density rho", r"density $\rho$", r"$\rho$"),
        ("body.driver_impedance", "impedance Zd of the driver: inf for a rigid one", "impedance $Z_{d}$ of the driver", "$Z_{d}$"),
        ("friction.static", "friction coefficient muS at rest", r"friction coefficient $\mu_{S}$ at rest", r"$\mu_{S}$"),
        ("friction.rate", "slip rate v_s at which it is half", "slip rate $v_{s}$ at which it is half", "$v_{s}$"),
        ("friction.exponent", "exponent of v / rate: 1 or 2", "exponent of $v$ / rate", ""),
        ("friction.distance", "slip over which friction falls (often Dc)", "slip over which friction falls", ""),
        ("friction.dynamic", "friction after `distance` of slip", "friction after distance of slip", ""),
        ("friction.values[2]", "the values", "the values [2]", ""),
        ("friction.parameters.alpha", "values of the parameters", r"$\alpha$", r"$\alpha$"),
        ("run.duration", "how long to simulate", "duration", ""),
        ("run.selection", "selection rule", "selection rule", ""),
    ],
)
def test_a_parameter_has_the_words_and_the_symbol_of_its_meaning(name: str, meaning: str, shown: str, short: str) -> None:
    assert parameter_name(name, meaning) == shown
    assert symbol(name, meaning) == short


def test_plain_names_have_greek_letters() -> None:
    assert plain_name("body.density", "density rho") == "density ρ"
    assert plain_name("friction.static", "friction coefficient muS at rest") == "friction coefficient μS at rest"


def test_every_declared_parameter_has_a_name_that_can_be_typeset() -> None:
    found = declared()
    assert len(found) > 300
    parser = MathTextParser("path")
    for one in found:
        text = parameter_name(one.name, one.declared.meaning)
        assert text
        for mathematics in re.findall(r"\$[^$]+\$", text):
            parser.parse(mathematics)
        words = re.sub(r"\$[^$]+\$", "", text)
        assert not re.search(r"[_.`]|\b(alpha|rho|omega|mu[0SD]?)\b", words), text


@pytest.mark.parametrize(
    ("units", "values", "name"),
    [
        ("m", [0.0, 23.4], "m"),
        ("m", [-1.2e-2, 3e-3], "mm"),
        ("m", [7e-13], "nm"),
        ("m/s", [1e-6, 1e-4], "µm/s"),
        ("m s-1", [1.58e-9], "nm/s"),
        ("Pa", [-1.3e3, np.nan], "kPa"),
        ("N", [8e13, np.inf], "TN"),
        ("J/m²", [9.3e8], "MJ/m²"),
        ("s", [3e9], "year"),
        ("1", [1e-6], "1"),
        ("m^-1 s", [3.0], "s/m"),
        ("m", [0.0], "m"),
        ("m", [], "m"),
    ],
)
def test_the_largest_value_chooses_the_unit(units: str, values: list[float], name: str) -> None:
    assert readable_unit(units, values)[0] == name


def test_a_logarithmic_axis_of_many_decades_is_in_si() -> None:
    assert readable_unit("m/s", [1e-15, 0.3], log=True) == ("m/s", 1.0)
    assert readable_unit("m/s", [1e-8, 1e-4], log=True) == ("µm/s", 1e-6)


@given(
    st.sampled_from(["s", "m", "m/s", "Pa", "Pa/m", "N", "N/m", "J", "J/m²"]),
    st.lists(st.floats(1e-9, 1e14), min_size=1, max_size=3),
)
def test_the_unit_has_its_size_and_the_largest_value_is_readable_in_it(units: str, values: list[float]) -> None:
    name, size = readable_unit(units, *values)
    if name in SIZES:
        assert size == SIZES[name]
    sizes = [one for one, _ in sizes_of(units)]
    top = max(values) / size
    assert top >= 0.49 or size == min(sizes)
    assert size == max(sizes) or top < 1.01 * sizes[sizes.index(size) - 1] / size


def test_panels_have_letters_and_a_single_one_has_none() -> None:
    axes = Figure().subplots(1, 3)
    letter_panels(axes, ["load"])
    assert [panel.get_title(loc="left") or panel.get_title() for panel in axes] == ["(a)  load", "(b)", "(c)"]
    alone = Figure().subplots()
    letter_panels([alone], ["load"])
    assert alone.get_title() == "load"


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("title", [r"$\frac{1$ of \bad", "$5 and $6", "two\nlines\tand \x07", "x" * 400])
def test_titles_of_users_are_never_read_as_formulas(title: str) -> None:
    figure = Figure()
    set_title(figure, title)
    set_title(figure.subplots(), title)
    assert image(figure, "png")
    assert max(len(line) for line in figure.get_suptitle().splitlines()) <= 90


def test_the_title_is_that_of_the_scenario_and_survives_a_file(tmp_path: Path) -> None:
    scenario = ss.load_scenario("fig6-slab")
    run = ss.simulate(scenario)
    assert run.plot().get_suptitle() == run.window(0).plot().get_suptitle() == scenario.title != ""
    again = ss.open_solution(run.to_netcdf(tmp_path / "run.nc"))
    assert again.plot.slip().axes[0].get_title(loc="left") == scenario.title
    untitled = replace(scenario, title="")
    assert ss.simulate(untitled).title == "fig6-slab"
    assert ss.simulate(SLAB_PROBLEM, 1.0, title="mine").plot().get_suptitle() == "mine"


@pytest.mark.slow
def test_a_resumed_run_keeps_its_title(tmp_path: Path) -> None:
    ss.simulate("fig6-slab", 3.0, checkpoint=tmp_path / "run.nc")
    assert ss.resume(tmp_path / "run.nc", 4.0).title == ss.load_scenario("fig6-slab").title  # type: ignore[union-attr]


def test_a_problem_from_python_has_no_title() -> None:
    figure = ss.simulate(SLAB_PROBLEM, 7.0).plot()
    assert figure.get_suptitle() == ""
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)", "(b)", "(c)"]


Floats = NDArray[np.float64]

# What readers without one kind of cones see, in linear RGB: Machado, Oliveira & Fernandes 2009, severity 1.
VISIONS = {
    "usual": [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
# Linear RGB to the cone responses of Oklab, and their cube roots to lightness and two contrasts: Ottosson 2020.
CONES = [
    [0.4122214708, 0.5363325363, 0.0514459929],
    [0.2119034982, 0.6806995451, 0.1073969566],
    [0.0883024619, 0.2817188376, 0.6299787005],
]
OPPONENT = [
    [0.2104542553, 0.7936177850, -0.0040720468],
    [1.9779984951, -2.4285922050, 0.4505937099],
    [0.0259040371, 0.7827717662, -0.8086757660],
]
# Differences below some 0.02 are invisible; colours of a key, far apart on a page, need several times as much.
LEAST = 0.095


def oklab(colours: list[str], vision: str) -> Floats:
    """Return lightness and the two contrasts of colours, as readers with this vision see them."""
    encoded = np.array([to_rgb(colour) for colour in colours])
    linear = np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)
    seen = np.clip(linear @ np.array(VISIONS[vision]).T, 0.0, 1.0)
    return np.cbrt(seen @ np.array(CONES).T) @ np.array(OPPONENT).T


def least_distance(colours: list[str], vision: str) -> float:
    return min(float(np.linalg.norm(one - other)) for one, other in combinations(oklab(colours, vision), 2))


@pytest.mark.parametrize("vision", VISIONS)
@pytest.mark.parametrize("count", range(2, COLOURS_IN_KEY + 1))
def test_readers_can_tell_the_colours_of_counts_apart(count: int, vision: str) -> None:
    assert least_distance(shades(count), vision) > LEAST


@pytest.mark.parametrize("count", range(3, COLOURS_IN_KEY + 1))
def test_higher_counts_are_darker(count: int) -> None:
    assert (np.diff(oklab(shades(count), "usual")[:, 0]) < -0.02).all()


def test_the_measure_of_distance_finds_colours_that_are_too_close() -> None:
    usual = [mpl.colors.to_hex(colour) for colour in mpl.colormaps["viridis"](np.linspace(0.05, 0.95, COLOURS_IN_KEY))]
    assert min(least_distance(usual, vision) for vision in VISIONS) < 0.6 * LEAST
    assert least_distance(["#009E73", "#A2A2A2"], "protanopia") < least_distance(["#009E73", "#A2A2A2"], "usual")


X = np.linspace(0.0, 1.0, 41)


@pytest.mark.parametrize(
    "smooth", [X, X**2, np.sin(7.0 * X), np.exp(5.0 * X), np.tanh(20.0 * (X - 0.5)), np.sqrt(X), np.ones(41), 1.0 / (0.05 + X)]
)
def test_smooth_curves_do_not_jump(smooth: Floats) -> None:
    assert not jumps(smooth).any()


@pytest.mark.parametrize("smooth", [np.zeros(41), X, np.sin(7.0 * X), X**2])
@pytest.mark.parametrize("place", [0, 1, 17, 38, 39])
@pytest.mark.parametrize("height", [-2.0, 2.0])
def test_a_step_is_a_jump_where_it_is(smooth: Floats, place: int, height: float) -> None:
    assert np.flatnonzero(jumps(smooth + height * (X[place] < X))).tolist() == [place]


def test_a_single_member_apart_jumps_on_both_sides() -> None:
    values = X.copy()
    values[20] += 3.0
    assert np.flatnonzero(jumps(values)).tolist() == [19, 20]


def test_noise_below_a_twentieth_of_the_range_is_no_jump() -> None:
    assert not jumps(X + np.where(np.arange(41) == 20, 0.04, 0.0)).any()


def test_missing_members_are_beside_no_jump() -> None:
    values = np.where(X > 0.5, 5.0, 0.0)
    values[20:22] = np.nan
    assert not jumps(values).any()
    assert not jumps(np.full(4, np.nan)).any()


def test_counts_jump_wherever_they_change() -> None:
    assert jumps(np.array([1.0, 1.0, 2.0, 2.0, np.nan, 3.0, 4.0]), whole=True).tolist() == [False, True, False, False, False, True]


def share(*values: float) -> ShownQuantity:
    members = xr.DataArray(np.array(values), dims="member")
    return ShownQuantity(members, xr.zeros_like(members), "share", is_flag=False, ends=("slides", "sticks"))


def test_shares_of_0_and_1_have_two_colours_with_words() -> None:
    assert colours_of(share(0.0, 1.0, np.nan)).key == ((0.0, "slides"), (1.0, "sticks"))


def test_a_share_has_a_scale_from_0_to_1_on_which_a_little_differs_from_nothing() -> None:
    colours = colours_of(share(0.0, 0.001, 0.06))
    assert (colours.key, colours.norm.vmax) == ((), 1.0)
    for vision in VISIONS:
        assert least_distance([mpl.colors.to_hex(colours.of(value)) for value in (0.0, 0.001)], vision) > LEAST
