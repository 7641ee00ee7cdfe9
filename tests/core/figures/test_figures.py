"""Every figure is made without error and says what its axes are, in units."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.contact.regime_map import regime_map
from stickslip.contact.steady import steady_traction
from stickslip.figures.contact import admissible, regimes
from stickslip.figures.runs.run import draw_run
from stickslip.figures.style import INK
from stickslip.foundation.axis import Axis
from tests.core.figures.legible import BLOCK, BLOCK_PROBLEM, LAW, LOOP, SLAB, SLAB_PROBLEM, has_unit, illegible, labels, size_of


def lines_of(figure: Figure) -> dict[str, np.ndarray]:
    """What is drawn under each name of the legend: points (x, y)."""
    return {str(line.get_label()): line.get_xydata() for line in figure.axes[0].lines if not str(line.get_label()).startswith("_")}


def test_the_set_of_any_problem_is_coloured_by_stability() -> None:
    figure = admissible.draw_admissible(admissible.admissible_data(SLAB_PROBLEM))
    drawn = lines_of(figure)
    assert {"stick", "slip, stable", "slip, unstable", "jump, perfect-delay"} == set(drawn)
    assert all(has_unit(text) for text in labels(figure))
    rate, load = drawn["slip, stable"].T
    shown = np.isfinite(load)
    assert rate[shown].min() == pytest.approx(1.25876975726, rel=1e-11)
    assert load[shown] * 1e6 == pytest.approx(9.8e6 * rate[shown] + 3e7 + 5e7 / (1 + rate[shown]), rel=1e-14)
    rate, load = drawn["slip, unstable"].T
    assert rate[np.isfinite(load)].max() == pytest.approx(1.25876975726, rel=1e-2)
    assert len(figure.axes[0].texts) == 2  # the arrows of the two jumps


def test_a_run_is_drawn_over_its_set() -> None:
    solution = ss.simulate(LOOP, 5.7)
    figure = admissible.draw_admissible(admissible.admissible_data(LOOP, solution))
    rate, load = lines_of(figure)["run"].T
    assert load.min() == pytest.approx(60.0, abs=0.1)
    assert load.max() == pytest.approx(60.0 + 9.8 * 2.6, rel=1e-9)
    slips = rate > 0.0
    assert load[slips] == pytest.approx(9.8 * rate[slips] + 30 + 50 / (1 + rate[slips]), rel=1e-8)
    assert {"its start", "its end"} <= set(lines_of(figure))


def test_under_a_slip_law_the_run_is_drawn_over_the_set_of_each_slip() -> None:
    """Each set and each point in slip satisfy load = Z v + S (mu0 + a sin(omega u)) at their own slip: relative 1e-9."""
    run = ss.simulate("fig5-slab-reconstructed")
    data = admissible.admissible_data(run.problem, run)

    def load(slip: np.ndarray, rate: np.ndarray) -> np.ndarray:
        return 9.8e6 * rate + 1e8 * (1.0 + 0.5 * np.sin(50.0 * slip))

    strength, rate = float(data.strength), data.slip_rate.values
    assert data.set_slip.values[[0, -1]] == pytest.approx(run.slip([0.0, 12.0]), rel=1e-12)
    assert data.set_excess.values + strength == pytest.approx(load(data.set_slip.values[:, None], rate), rel=1e-9, abs=0.0)
    assert np.ptp(data.set_strength.values) > 0.9e8  # of 1e8 Pa: the sets lie at all phases of the law
    slips = data.path_slip_rate.values > 0.0
    on_path = load(data.path_law_slip.values[slips], data.path_slip_rate.values[slips])
    assert data.path_excess.values[slips] + strength == pytest.approx(on_path, rel=1e-9, abs=0.0)
    figure = admissible.draw_admissible(data)
    bar = figure.axes[1]
    assert bar.get_ylabel() == "slip $u$ (mm)"
    figure.draw_without_rendering()
    ticks = [float(text.get_text()) for text in bar.get_yticklabels()]
    assert ticks == pytest.approx(1e3 * bar.get_yticks(), rel=1e-12)


def test_arrows_follow_the_path_from_its_start() -> None:
    solution = ss.simulate(LOOP, 5.7)
    axes = admissible.draw_admissible(admissible.admissible_data(LOOP, solution)).axes[0]
    path = lines_of(axes.figure)["run"]
    (start,) = lines_of(axes.figure)["its start"]
    assert start.tolist() == path[0].tolist()
    arrows = [text for text in axes.texts if text.arrow_patch is not None and text.arrow_patch.get_edgecolor() == to_rgba(INK)]
    assert len(arrows) > 4
    size = np.array([np.ptp(axes.get_xlim()), np.ptp(axes.get_ylim())])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*(np.diff(path, axis=0) / size).T))])
    apart = max(0.3, along[-1] / 14)
    for k, arrow in enumerate(arrows):
        before, at, after = (
            np.array([np.interp((k + 0.5) * apart + d, along, path[:, j]) for j in (0, 1)]) for d in (-0.02, 0, 0.02)
        )
        head, tail = np.array(arrow.xy, float), np.array(arrow.xyann, float)
        assert np.hypot(*((0.5 * (head + tail) - at) / size)) < 0.01
        assert ((head - tail) / size) @ ((after - before) / size) > 0.0


def test_near_the_critical_value_loads_are_differences() -> None:
    critical = replace(SLAB_PROBLEM, friction=replace(LAW, alpha=0.196 + 1e-6))
    figure = admissible.draw_admissible(admissible.admissible_data(critical))
    text = figure.axes[0].get_ylabel()
    assert "minus static strength" in text
    _, load = lines_of(figure)["slip, unstable"].T
    assert np.nanmin(load) * size_of(text) == pytest.approx(ss.uniqueness(critical).window[0], rel=1e-9)


def test_slip_backwards_shows_the_mirrored_set() -> None:
    backwards = replace(SLAB_PROBLEM, initial_excess=None, initial_load=-81e6)
    figure = admissible.draw_admissible(admissible.admissible_data(backwards, ss.simulate(backwards, 12.0)))
    low, high = figure.axes[0].get_xlim()
    assert low == -high < 0.0
    assert lines_of(figure)["run"][:, 0].min() < 0.0


def test_a_plateau_is_drawn_as_a_continuum() -> None:
    law = ss.friction.PiecewiseLinearRate((0.0, 1.0, 2.0, 6.0), (0.6, 0.65, 0.65 - 0.098, 0.5))
    drawn = lines_of(admissible.draw_admissible(admissible.admissible_data(replace(SLAB_PROBLEM, friction=law))))
    rate, load = drawn["slip, continuum"].T
    flat = np.isfinite(load) & (rate >= 1.0) & (rate <= 2.0)
    assert load[flat] == pytest.approx(np.full(flat.sum(), 74.8), rel=1e-14)


@pytest.mark.parametrize("body", [BLOCK, replace(SLAB, contact_mass=1.0)])
def test_inertia_leaves_no_set_to_draw(body: ss.SpringBlock | ss.ElasticSlab) -> None:
    with pytest.raises(ss.InputError, match="inertia"):
        admissible.admissible_data(replace(SLAB_PROBLEM, body=body))


def test_the_result_of_uniqueness_draws_its_set() -> None:
    wavy = replace(SLAB_PROBLEM, friction=lambda u, v: (0.5 + 0.2 * np.sin(u)) / (1.0 + v))
    for problem, slip in ((SLAB_PROBLEM, None), (wavy, 1.0)):
        contact = ss.uniqueness(problem, slip)
        figure = contact.plot(dpi=100.0)
        highest = lines_of(figure)["stick"][:, 1].max()
        assert 1e6 * highest == pytest.approx(float(contact.g(0.0)), rel=1e-12)
    with pytest.raises(ss.InputError, match="inertia"):
        ss.uniqueness(BLOCK_PROBLEM).plot()


def test_the_map_of_regimes_marks_the_problem() -> None:
    found = regime_map(SLAB_PROBLEM, Axis("alpha", 0.01, 10.0, 6, log=True), Axis("normal_stress", 1e7, 5e8, 5))
    figure = regimes.draw_regimes(SLAB_PROBLEM, found)
    assert labels(figure) == [r"weakening parameter $\alpha$ (s/m)", "normal stress $S$ on the contact (MPa)"]
    assert lines_of(figure)["the scenario"].tolist() == [[1.0, 100.0]]
    (curve,) = figure.axes[0].collections[1:]
    points = np.concatenate(curve.get_segments())
    assert points[:, 0] * points[:, 1] * 0.5 == pytest.approx(np.full(len(points), 9.8), rel=1e-13)
    assert figure.axes[0].get_xscale() == "log"
    edges = np.asarray(figure.axes[0].collections[0].get_coordinates())[0, :, 0]  # type: ignore[attr-defined]
    ratios = edges[1:] / edges[:-1]
    assert ratios == pytest.approx(1000.0 ** (np.array([0.5, 1, 1, 1, 1, 0.5]) / 5), rel=1e-12), "halfway in equal ratios"


def test_a_run_is_legible_and_names_its_units() -> None:
    figure = draw_run(ss.simulate(SLAB_PROBLEM, 7.0))
    assert len(labels(figure)) == 4
    assert all(has_unit(text) for text in labels(figure))
    assert illegible(figure) == []


def test_years_are_shown_as_years() -> None:
    figure = draw_run(ss.simulate(SLAB_PROBLEM, 10 * ss.YEAR))
    assert figure.axes[2].get_xlabel().endswith("(year)")
    assert figure.axes[2].lines[0].get_xdata()[-1] == pytest.approx(10.0, rel=1e-12)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("gives_way", [False, True])
def test_the_figure_of_steady_sliding_has_the_edge_from_rest(gives_way: bool) -> None:
    """Between the critical rate and the edge, a contact from rest sticks; one behind a driver that gives way slides more slowly."""
    slab = replace(SLAB, driver_impedance=0.5 * SLAB.impedance) if gives_way else SLAB
    law = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.3, rate="1 m/s", viscosity="0.02 s/m")
    far = {"far_stress": 0.31 * slab.normal_stress} if gives_way else {}
    problem = ss.Problem(replace(slab, contact_mass=1e6), law, pull_rate="20 m/s", initial_load=0.0, **far)
    found = ss.studies.steady(problem)
    assert found.from_rest is not None
    assert found.from_rest.sticks_at is not None
    axes = found.plot().axes[0]
    (edge,) = (line for line in axes.lines if line.get_label().startswith("edge of sticking from rest"))
    rate, pull = edge.get_xdata()[0], found.from_rest.sticks_at
    if gives_way:
        held = slab.driver_impedance * (pull - rate) + problem.far_stress
        assert held == pytest.approx(float(steady_traction(problem, np.array([rate]))[0]), rel=1e-9)
        assert rate < pull
    else:
        assert rate == pytest.approx(pull, rel=1e-12)
    (span,) = axes.patches
    assert span.get_extents().transformed(axes.transData.inverted()).x1 == pytest.approx(rate, rel=1e-9)
