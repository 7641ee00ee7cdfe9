"""Runs side by side: the table against closed forms and the paper's verdicts, and what it refuses."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.paper.claims import CLAIMS, Outcome, Runs
from stickslip.extensions.studies.compare import COLUMNS, Comparison, compare, distinct
from stickslip.extensions.studies.figures.compare import drawn

FIG6 = ("fig6-block-reconstructed", "fig6-slab")


@pytest.fixture(scope="module")
def fig6() -> Comparison:
    return compare(*FIG6)


def test_drops_of_coulomb_friction_are_those_of_the_closed_form() -> None:
    """Slab: slips at the dynamic level for a round trip: dynamic drop (muS - muD) S, static drop twice that. Block: the same over
    its normal force. The pull is slow, not zero: 1e-6 of the drops."""
    law, pull = ss.friction.Coulomb(0.8, 0.3), 1e-9
    slab = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
    block = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
    runs = [ss.simulate(ss.Problem(body, law, pull_rate=pull, initial_excess=0.0), 10.0) for body in (slab, block)]
    table = compare(*runs, names=["slab", "block"]).table.set_index("name")
    for name, normal in (("slab", 1e8), ("block", 1e14)):
        row = table.loc[name]
        assert row.dynamic_drop == pytest.approx(0.5 * normal, rel=1e-6, abs=0.0)
        assert row.static_drop == pytest.approx(1.0 * normal, rel=1e-6, abs=0.0)
    assert (table.shocks["slab"] > 0, table.shocks["block"]) == (True, 0)
    assert list(table.load_unit) == ["Pa", "N"]


def test_smooth_and_jumping_are_what_the_paper_says(fig6: Comparison) -> None:
    """Claims 5 and 6: the block's slip rate is continuous, the slab's jumps; the verdicts come from the paper's own measurement."""
    runs = Runs()
    for row, claim in zip(fig6.table.itertuples(), (5, 6), strict=True):
        assert CLAIMS[claim](runs).outcome is Outcome.PRINTED
        assert (row.shocks == 0) == (claim == 5)
        assert row.shocks == len(runs.case(str(row.name)).shocks)


def test_the_table_is_that_of_the_runs(fig6: Comparison) -> None:
    assert list(fig6.table) == list(COLUMNS)
    for row in fig6.table.itertuples():
        run = fig6.runs[str(row.name)]
        assert row.events == len(run.events)
        assert row.slip == run.events.slip.max()
        assert row.duration == run.events.duration[0]
        assert row.status == "finished"
    assert list(fig6.table.regime) == ["regular", "irregular"]


def test_a_run_without_an_event_has_a_row_too() -> None:
    table = compare("fig7-block-critical", "fig7-slab-critical").table
    assert list(table.events) == [0, 1]
    assert pd.isna(table.slip[0])
    assert pd.isna(table.duration[0])
    assert 1e-9 < table.peak_rate[0] < 1e-4 * table.peak_rate[1]


def test_the_file_says_where_it_comes_from(fig6: Comparison, tmp_path: Path) -> None:
    path = fig6.to_csv(tmp_path / "both.csv")
    comment = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("#")]
    assert comment[0].startswith(f"# stickslip {ss.__version__}: runs side by side")
    assert "# slip (m): slip of the largest event, negative if it slips back" in comment
    assert "# stiffness = 34300000000000.0" in comment
    read = pd.read_csv(path, comment="#")
    pd.testing.assert_frame_equal(read, fig6.table, check_exact=True)
    assert [one.name for one in tmp_path.iterdir()] == ["both.csv"]


def test_compare_accepts_files_scenarios_and_solutions(tmp_path: Path) -> None:
    scenario = ss.load_scenario("fig6-slab")
    saved = ss.simulate(scenario).to_netcdf(tmp_path / "saved.nc")
    found = compare(saved, "fig6-slab", scenario, ss.open_solution(saved))
    assert list(found.runs) == ["saved", "fig6-slab", "fig6-slab (2)", "run"]
    assert found.table.slip.nunique() == 1
    longer = compare("fig6-slab", scenario, duration=7.0, rtol=1e-6)
    assert [(run.duration, run.rtol) for run in longer.runs.values()] == [(7.0, 1e-6)] * 2


def test_equal_names_are_numbered() -> None:
    assert distinct(["a", "b", "a", "a"]) == ["a", "b", "a (2)", "a (3)"]


def test_bad_comparisons_are_refused(fig6: Comparison) -> None:
    done = fig6.runs["fig6-slab"]
    for arguments, options, message in (
        (("fig6-slab",), {}, "needs two"),
        (("fig6-slab", "fig6-slap"), {}, "did you mean 'fig6-slab'"),
        (("fig6-slab", done), {"duration": 3.0}, "has been run: leave out duration and rtol"),
        (FIG6, {"names": ["one"]}, "names: 2 are needed, got 1"),
        (FIG6, {"duration": -1.0}, "duration must be greater than 0 s, got -1"),
        (FIG6, {"rtol": 1.0}, "rtol must be at most"),
        (FIG6, {"event": 1}, "fig6-block-reconstructed has no slip event 1: it has 1"),
    ):
        with pytest.raises(ss.InputError, match=message):
            compare(*arguments, **options)  # type: ignore[arg-type]


def test_the_figure_shows_friction_where_units_differ(fig6: Comparison) -> None:
    found = drawn(fig6)
    assert found.mixed
    (_, block), (_, slab) = found.lines["traction"]
    assert float(block[0]) == pytest.approx(0.8, rel=1e-12, abs=0.0)
    assert float(slab.min()) == pytest.approx(-0.399999969 / 100, rel=1e-4, abs=0.0)
    assert [float(time.max()) for time, _ in found.lines["slip"]] == [6.0, 6.0]  # the end of the block's run
    figure = fig6.plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["slip $u-u_0$ (m)", "slip rate $v$ (m/s)", r"friction $\tau/S$"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == list(FIG6)


def test_runs_of_very_different_lengths_share_no_seconds() -> None:
    runs = {"short": ss.simulate("fig6-slab"), "long": ss.simulate("second-event-maxwell")}
    found = drawn(Comparison(runs))
    assert found.shares
    assert float(found.lines["slip"][1][0].max()) == 1.0
    figure = Comparison(runs).plot()
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["short (7.143 s)", "long (480 years)"]
    assert "share of each run's own" in figure.axes[-1].get_xlabel()


def test_runs_of_different_size_share_an_axis_in_one_unit() -> None:
    """In units of their own, 0.27 m/s of the block would look larger than 4.1 m/s of the slab."""
    runs = {name: ss.simulate(name) for name in ("cycles-block", "fig6-slab")}
    slip_rate = Comparison(runs).plot().axes[1]
    assert slip_rate.get_ylabel() == "slip rate $v$ (m/s)"
    tops = [float(np.max(line.get_ydata())) for line in slip_rate.get_lines()[:2]]
    assert tops == pytest.approx([run.events.peak_rate.max() for run in runs.values()], rel=1e-2, abs=0.0)


def test_very_different_sizes_are_seen_on_a_logarithmic_axis() -> None:
    for axes in compare("fig7-block-critical", "fig7-slab-critical").plot().axes[:2]:
        assert axes.get_yscale() == "log"
        low, high = axes.get_ylim()
        for line in axes.get_lines():
            heights = np.asarray(line.get_ydata())
            assert np.nanmax(heights) < high
            assert (heights > low).mean() > 0.2


def test_runs_without_later_events_end_together() -> None:
    early, late = (ss.simulate("fig6-slab") for _ in range(2))
    short = ss.simulate(early.problem, 6.5)
    ends = [float(time.max()) for time, _ in drawn(Comparison({"short": short, "long": late})).lines["slip"]]
    assert ends == [6.5, 6.5]
    cut, whole = drawn(Comparison({"cut": ss.simulate(early.problem, 3.0), "long": late})).lines["slip"]
    assert float(cut[0].max()) == 3.0
    assert float(whole[0].max()) == pytest.approx(40.0 / 7.0, rel=1e-9, abs=0.0)


def test_one_event_of_each_run_is_shown_in_local_time() -> None:
    runs = {rule: ss.simulate(f"second-event-{rule}") for rule in ("maxwell", "maximal")}
    found = drawn(Comparison(runs, 1))
    assert not found.shares
    assert "since each event began" in Comparison(runs, 1).plot().axes[-1].get_xlabel()
    longest = max(run.events.duration.iloc[1] for run in runs.values())
    for run, (time, slip) in zip(runs.values(), found.lines["slip"], strict=True):
        event = run.events.iloc[1]
        at_end = np.interp(event.duration, time, slip)
        assert at_end == pytest.approx(event.slip, rel=1e-9, abs=0.0)
        assert (time.min(), time.max()) == pytest.approx((-0.1 * longest, 1.1 * longest), rel=1e-12, abs=0.0)


def test_an_unchanged_friction_is_drawn_as_its_change() -> None:
    slab = ss.load_scenario("fig7-slab-critical")
    figure = compare(slab, replace(slab, rtol=1e-8)).plot()
    assert figure.axes[2].get_ylabel().startswith("change of traction")
    assert figure.axes[1].get_yscale() == "linear"
    wide = compare("fig7-block-critical", "fig7-slab-critical").plot()
    assert wide.axes[1].get_yscale() == "log"


def test_the_dynamic_drop_is_exact_where_a_pulse_lasts_no_time() -> None:
    """Fig. 5, slab: from 3430 Pa above S (muS + a) down to S (muS - a), 1e8 Pa apart; relative 1e-9."""
    row = ss.studies.compare("fig5-slab-reconstructed", "fig5-block-reconstructed-omega").table.iloc[0]
    assert row.dynamic_drop == pytest.approx(1e8 + 3430.0, rel=1e-9)


def test_curves_that_lie_on_one_another_are_told_by_marks_at_places_of_their_own() -> None:
    """Four times the same run: colours and marks differ, wider lines lie below, and no two marks share a place."""
    run = ss.simulate("fig6-slab")
    figure = Comparison(dict.fromkeys("abcd", run)).plot()
    for axes in figure.axes:
        lines = axes.get_lines()[:4]
        assert len({line.get_color() for line in lines}) == len({line.get_marker() for line in lines}) == 4
        widths = [line.get_linewidth() for line in lines]
        assert widths == sorted(widths, reverse=True)
        places = np.sort([np.asarray(line.get_xdata(), float)[place] for line in lines for place in line.get_markevery()])  # type: ignore[union-attr]
        span = float(np.ptp(np.asarray(lines[0].get_xdata(), float)))
        assert len(places) == 24
        assert np.diff(places).min() > 0.5 * span / 24


def test_rules_of_one_scenario_are_its_runs_under_each() -> None:
    found = compare("second-event-maxwell", rules=True)
    assert list(found.runs) == ["perfect-delay", "maxwell", "minimal", "maximal"]
    assert list(found.table.rule) == list(found.runs)
    assert found.scenario == "The second event of the alpha = 1 slab, maxwell rule: each selection rule"
    labels = [text.get_text() for text in found.plot().legends[0].get_texts()]
    assert labels[1] == "maxwell (waits 394.3 years)"
    moving = ss.Problem(
        ss.ElasticSlab(2800, 3500, 1e4, 1e8),
        ss.friction.SlipPlusRate(ss.friction.SinusoidalSlip(0.5, 0.1, 5.0), ss.friction.HyperbolicRate(0.3, 0.1, 1.0)),
        pull_rate=1e-3,
        initial_excess=-1e6,
    )
    with pytest.raises(ss.InputError, match="there are no rules to compare"):
        compare(ss.simulate(moving, 1.0), rules=True)
