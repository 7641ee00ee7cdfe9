"""Units, titles and letters are chosen by the same functions in all figures."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import matplotlib as mpl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from matplotlib.mathtext import MathTextParser

import stickslip as ss
from stickslip.figures.names import parameter_name, plain_name, symbol
from stickslip.figures.panels import letter_panels, set_title
from stickslip.figures.style import UNITS, image, unit_of
from stickslip.scenarios.library import names
from stickslip.scenarios.parameter_paths import ParameterPath, parameter_paths
from tests.figures.legible import SIZES, SLAB_PROBLEM


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
        ("friction.amplitude", "amplitude a of the oscillation", "amplitude $a$ of the oscillation", "$a$"),
        ("friction.rate", "slip rate v_s at which it is half", "slip rate $v_{s}$ at which it is half", "$v_{s}$"),
        ("friction.exponent", "exponent of v / rate: 1 or 2", "exponent of $v$ / rate", ""),
        ("friction.distance", "slip over which friction falls (often Dc)", "slip over which friction falls", ""),
        ("friction.dynamic", "friction after `distance` of slip", "friction after distance of slip", ""),
        ("friction.distance", "slip over which it falls by a factor e", "slip over which it falls by a factor e", ""),
        ("friction.values[2]", "the values", "the values [2]", ""),
        ("friction.parameters.alpha", "values of the parameters", r"$\alpha$", r"$\alpha$"),
        ("friction.parameters.drop", "values of the parameters", "drop", ""),
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


mpl.use("Agg")


@pytest.mark.parametrize(
    ("units", "values", "name"),
    [
        ("m", [0.0, 23.4], "m"),
        ("m", [-1.2e-2, 3e-3], "mm"),
        ("m", [0.6], "m"),
        ("m", [7e-13], "nm"),
        ("m/s", [1e-6, 1e-4], "µm/s"),
        ("m s-1", [1.58e-9], "nm/s"),
        ("Pa", [6.3e7], "MPa"),
        ("Pa", [-1.3e3, np.nan], "kPa"),
        ("Pa", [999.0], "Pa"),
        ("N", [8e13, np.inf], "TN"),
        ("J/m²", [9.3e8], "MJ/m²"),
        ("s", [3e9], "year"),
        ("s", [571.0], "s"),
        ("1", [1e-6], "1"),
        ("m^-1 s", [3.0], "s/m"),
        ("m", [0.0], "m"),
        ("m", [], "m"),
    ],
)
def test_the_largest_value_chooses_the_unit(units: str, values: list[float], name: str) -> None:
    assert unit_of(units, values)[0] == name


def test_a_logarithmic_axis_of_many_decades_is_in_si() -> None:
    assert unit_of("m/s", [1e-15, 0.3], log=True) == ("m/s", 1.0)
    assert unit_of("m/s", [1e-8, 1e-4], log=True) == ("µm/s", 1e-6)


@given(st.sampled_from(sorted(UNITS)), st.lists(st.floats(1e-9, 1e14), min_size=1, max_size=3))
def test_the_unit_has_its_size_and_the_largest_value_is_readable_in_it(units: str, values: list[float]) -> None:
    name, size = unit_of(units, *values)
    if name in SIZES:
        assert size == SIZES[name]
    sizes = [one for one, _ in UNITS[units]]
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


def test_a_resumed_run_keeps_its_title(tmp_path: Path) -> None:
    ss.simulate("fig6-slab", 3.0, checkpoint=tmp_path / "run.nc")
    assert ss.resume(tmp_path / "run.nc", 4.0).title == ss.load_scenario("fig6-slab").title  # type: ignore[union-attr]


def test_a_problem_from_python_has_no_title() -> None:
    figure = ss.simulate(SLAB_PROBLEM, 7.0).plot()
    assert figure.get_suptitle() == ""
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["(a)", "(b)", "(c)"]
