"""Orders of made-up errors, groups of rules, and the map of where a block stands for a slab."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.schemes.verdict import groups, local_orders
from stickslip.extensions.studies.analogy import QUANTITIES_COMPARED, Analogy, _stands, analogy, weakening
from stickslip.extensions.studies.figures import analogy as figure
from stickslip.foundation.axis import Axis
from stickslip.problem.equivalent_block import block_for
from stickslip.problem.scenarios.scenario import Scenario

CASE = ss.load_scenario("block-or-slab")
WAVELENGTH, ALPHA = "friction.parameters.wavelength", "friction.parameters.alpha"
X, Y = Axis(WAVELENGTH, 2.0, 41.6, 3, log=True), Axis(ALPHA, 0.00392, 3.92, 2, log=True)


@pytest.fixture(scope="module")
def found() -> Analogy:
    return analogy(CASE.problem, CASE.duration, X, Y)


def test_the_two_numbers_are_those_of_the_laws(found: Analogy) -> None:
    """alpha_w h = S a (2 pi / wavelength) h / G; alpha / alpha_c with alpha_c = Z / (S drop) = 0.392 s/m."""
    expected = 1e8 * 0.25 * 2 * np.pi / X.values * 1e4 / 3.43e10
    np.testing.assert_allclose(found.grid("weakening_slip"), np.array([expected] * 2), rtol=1e-12, atol=0.0)
    np.testing.assert_allclose(found.grid("weakening_rate"), np.array([Y.values / 0.392] * 3).T, rtol=1e-9, atol=0.0)
    rate = ss.load_scenario("fig6-slab").problem
    assert weakening(rate) == {"weakening_slip": 0.0, "weakening_rate": pytest.approx(1.0 / 0.196, rel=1e-12)}


def test_a_point_is_a_run_of_each(found: Analogy) -> None:
    row = found.table.iloc[0]
    problem = CASE.problem.parameters[WAVELENGTH].put(2.0)
    for name, one in (("slab", problem), ("block", block_for(problem))):
        run = ss.simulate(one, CASE.duration, 1e-8, max_events=1)
        event = run.events.iloc[0]
        for column in ("slip", "peak_rate", "duration"):
            assert row[f"{column}_{name}"] == event[column]
        assert row[f"pulses_{name}"] == event.pulses
        assert row[f"shocks_{name}"] == len(run.shocks)
    assert row.slip_ratio == row.slip_slab / row.slip_block


def test_the_block_stands_for_the_slab_in_the_slow_corner_only(found: Analogy) -> None:
    """At a wavelength of 41.6 m (weakening 1.10 of the stiffness) and alpha_c / 100; the slab slips a tenth of the block at the
    opposite corner."""
    assert found.grid("stands").tolist() == [[0.0, 0.0, 1.0], [0.0, 0.0, 0.0]]
    assert found.ratio("slip")[0, 2] == pytest.approx(0.989, abs=0.002)
    assert found.ratio("slip")[1, 0] < 0.15
    assert found.text.startswith("the block stands for the slab at 1 of 6 points")
    assert "slip up to 1.1 times the stiffness, and with slip rate up to 0.01 times the impedance" in found.text


def test_the_same_numbers_in_other_pulses_are_not_the_same() -> None:
    table = pd.DataFrame({f"{one}_ratio": [1.05, 1.05, 1.05, 1.15] for one in QUANTITIES_COMPARED})
    table["pulses_slab"], table["pulses_block"] = [1, 3, 2, 1], [1, 1, 2, 1]
    assert list(_stands(table, 0.1)) == [True, False, True, False]


def test_the_user_chooses_how_near_is_near() -> None:
    axes = Axis(WAVELENGTH, 20.0, 41.6, 2, log=True), Axis(ALPHA, 0.00392, 0.0392, 2, log=True)
    assert analogy(CASE.problem, CASE.duration, *axes, within=0.3).table.stands.all()
    assert not analogy(CASE.problem, CASE.duration, *axes, within=1e-3).table.stands.any()


def test_an_event_that_does_not_end_counts_as_unknown() -> None:
    short = analogy(CASE.problem, 1.0, X, Y)
    assert short.table.duration_ratio.isna().any()
    unknown = short.table[short.table.duration_ratio.isna()]
    assert not unknown.stands.any()
    at_rest = analogy(
        ss.load_scenario("second-event-maxwell").problem, 1e-3, Axis("alpha", 0.01, 0.02, 2), Axis("static", 0.9, 1.0, 2)
    )
    assert set(at_rest.table.status_slab) <= {"finished", "no slip event"}


def test_refused_points_are_named() -> None:
    problem = ss.load_scenario("fig6-slab").problem
    found = analogy(problem, 20.0, Axis("alpha", 0.5, 1.0, 2), Axis("dynamic", -0.1, 0.3, 2))
    assert list(found.table.status_slab) == ["refused", "refused", "enough events", "enough events"]
    assert list(found.table.slip_ratio.isna()) == [True, True, False, False]


@pytest.mark.parametrize(
    ("problem", "options", "message"),
    [
        (ss.load_scenario("fig6-block-printed").problem, {}, "needs a slab"),
        (ss.load_scenario("fig4-loop").problem, {}, "needs a rigid driver"),
        (ss.load_scenario("fig6-slab").problem, {"within": 0.0}, "within must lie between 0 and 1"),
    ],
)
def test_bad_axes_and_options_are_refused(problem: ss.Problem, options: dict[str, float], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        analogy(problem, 1.0, Axis("alpha", 1.0, 2.0, 2), Axis("static", 0.5, 0.8, 2), **options)


def test_the_figure_shows_the_ratios_and_both_lines(found: Analogy) -> None:
    dataset = figure.analogy_data(found)
    np.testing.assert_array_equal(dataset.slip_ratio.values, found.ratio("slip"))
    drawn = figure.draw_analogy(dataset)
    assert drawn.axes[2].get_xlabel() == "wavelength (m)"
    titles = [axes.get_title(loc="left") for axes in drawn.axes[:4]]
    assert titles[0] == "(a)  ratio of slips"
    assert titles[3] == "(d)  block stands for slab"
    key = [text.get_text() for text in drawn.legends[0].get_texts()]
    assert key[:2] == ["(d) all three ratios within 10 %, same pulses", "(d) not so"]


def test_the_order_is_that_between_two_sizes() -> None:
    sizes = 0.1 / 4.0 ** np.arange(8)
    orders = local_orders(sizes, sizes + 0.02 * sizes**0.5)
    assert math.isnan(orders[0])
    assert orders[1:] == pytest.approx(np.diff(np.log(sizes + 0.02 * sizes**0.5)) / np.diff(np.log(sizes)), rel=1e-12, abs=0.0)
    assert local_orders(sizes, 0.3 * sizes ** (2 / 3))[1:] == pytest.approx(2 / 3, rel=1e-9, abs=0.0)


def test_rules_with_the_same_answer_are_one_group() -> None:
    apart = {(a, b): 0.0 if "x" not in (a, b) or a == b else 1.0 for a in "axb" for b in "axb"}
    assert groups("axb", apart, 0.1) == [("a", "b"), ("x",)]


def test_studies_take_a_scenario_and_its_duration(tmp_path: Path) -> None:
    problem = ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), ss.friction.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=1.0)
    file = tmp_path / "one.toml"
    file.write_text(Scenario(problem, 3.0).to_toml())
    found = ss.studies.schemes(file, scheme="lag", cells=20, rtol=1e-6)
    assert found.exact["perfect-delay"].duration == 3.0
    assert found.problem == problem
    pushed = ss.studies.ensemble(file, members=1, rtol=1e-6)
    assert (pushed.reference.duration, pushed.reference.problem) == (3.0, problem)
    axes = Axis("body.thickness", 1e4, 2e4, 2), Axis("friction.alpha", 0.5, 1.0, 2)
    assert len(analogy(file, None, *axes, rtol=1e-6).table) == 4
    with pytest.raises(ss.InputError, match="ensemble: duration"):
        ss.studies.ensemble(problem)
