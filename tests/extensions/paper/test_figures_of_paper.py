"""Figures 1 to 7 of the paper show its symbols, its set K and runs side by side, in units and legibly."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import stickslip as ss
from stickslip.extensions.paper.figures import comparison, resistance, systems
from stickslip.figures.style import image
from tests.core.figures.legible import BLOCK_PROBLEM, LAW, LOOP, SLAB, SLAB_PROBLEM, has_unit, illegible, labels

pytestmark = pytest.mark.usefixtures("closed_figures")


def test_systems_show_the_papers_symbols() -> None:
    figure = systems.draw_systems(systems.systems_data(BLOCK_PROBLEM, SLAB_PROBLEM))
    shown = {text.get_text() for axes in figure.axes for text in axes.texts}
    assert {"$m$", "$K$", "$S$", "$V$", "$h$", r"$\tau$", "$u(t)$", "$u(0,t)$", "$D_0+Vt$", "$u(h,t)=D_0+Vt$"} <= shown


def test_laws_have_a_panel_each() -> None:
    dataset = systems.laws_data({"slip": ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)}, {"rate": LAW}, 2.0, 10.0)
    assert float(dataset.coefficient_along_rate[0, 0]) == pytest.approx(0.8, rel=1e-15)
    figure = systems.draw_laws(dataset)
    assert len(labels(figure)) == 4
    assert all(has_unit(text) for text in labels(figure))


def test_corners_of_an_irregular_contact_have_their_closed_form() -> None:
    found = resistance.corners(SLAB_PROBLEM, 6.0)
    assert found["A"] == (0.0, 8e7)
    assert found["B"][0] == pytest.approx(4.10204081633, rel=1e-11)
    assert found["C"][1] == pytest.approx(64471887.242, rel=1e-11)
    assert found["D"] == (0.0, found["C"][1])


def test_a_regular_contact_has_no_corners() -> None:
    regular = replace(SLAB_PROBLEM, friction=replace(LAW, alpha=0.1))
    assert resistance.corners(regular, 6.0) == {}
    figure = resistance.draw_resistance(resistance.resistance_data({"regular": regular, "irregular": SLAB_PROBLEM}, 6.0))
    dashed = [sum(line.get_linestyle() == "--" for line in axes.lines) for axes in figure.axes]
    assert dashed == [0, 1]


def test_the_run_follows_the_loop_up_and_down() -> None:
    dataset = resistance.loop_data(ss.simulate(LOOP, 5.7))
    up, down = dataset.run_load[: int(dataset.run_turn) + 1], dataset.run_load[int(dataset.run_turn) :]
    last_digit = 1e-15 * float(dataset.run_load.max())
    assert (np.diff(up) >= -last_digit).all()
    assert (np.diff(down) <= last_digit).all()
    assert float(dataset.run_load.max()) == pytest.approx(60e6 + SLAB.impedance * 2.6, rel=1e-9)
    figure = resistance.draw_hysteresis(dataset)
    assert all(has_unit(text) for text in labels(figure))
    assert {"A", "B", "C", "D", "E", "to O"} <= {text.get_text() for text in figure.axes[0].texts}


@pytest.fixture(scope="module")
def side_by_side() -> xr.Dataset:
    solutions = {"block": ss.simulate(BLOCK_PROBLEM, 7.0), "slab": ss.simulate(SLAB_PROBLEM, 7.0)}
    return comparison.comparison_data(solutions, 7.0)


def test_comparison_draws_the_shock_at_the_start(side_by_side: xr.Dataset) -> None:
    rate = side_by_side.slab_slip_rate
    assert rate[0] == 0.0
    assert float(rate[1]) == pytest.approx(4.10204081633, rel=1e-11)
    assert side_by_side.slab_time[0] == side_by_side.slab_time[1] == 0.0


def test_systems_are_compared_over_the_same_time_in_the_same_units(side_by_side: xr.Dataset) -> None:
    figure = comparison.draw_comparison(side_by_side)
    assert len({axes.get_xlim() for axes in figure.axes}) == 1
    assert figure.axes[0].get_ylabel() == figure.axes[1].get_ylabel() == "slip $u$ (m)"
    assert [axes.get_title(loc="left")[:3] for axes in figure.axes] == ["(a)", "(d)", "(b)", "(e)", "(c)", "(f)"]
    small = side_by_side.assign(block_slip=1e-6 * side_by_side.block_slip.assign_attrs(side_by_side.block_slip.attrs))
    small["block_slip"].attrs = side_by_side.block_slip.attrs
    assert comparison.draw_comparison(small).axes[0].get_ylabel() == "slip $u$ (µm)"


def test_runs_side_by_side_are_legible_and_name_their_units(side_by_side: xr.Dataset) -> None:
    figure = comparison.draw_comparison(side_by_side)
    assert len(labels(figure)) == 8
    assert all(has_unit(text) for text in labels(figure))
    assert illegible(figure) == []


@pytest.mark.slow
def test_a_dataset_read_back_draws_the_same(side_by_side: xr.Dataset, tmp_path: Path) -> None:
    side_by_side.to_netcdf(tmp_path / "data.nc", engine="h5netcdf")
    again = xr.load_dataset(tmp_path / "data.nc", engine="h5netcdf")
    assert image(comparison.draw_comparison(side_by_side), "png", 50.0) == image(comparison.draw_comparison(again), "png", 50.0)


@pytest.mark.slow
def test_the_same_figure_gives_the_same_bytes() -> None:
    dataset = systems.systems_data(BLOCK_PROBLEM, SLAB_PROBLEM)
    for kind in ("png", "svg"):
        assert image(systems.draw_systems(dataset), kind) == image(systems.draw_systems(dataset), kind)
