"""The study of sliding: its table, statistics, files and figures, and what it refuses."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.strong_motion.sliding_block import ShakenBlock
from stickslip.foundation.constants import GRAVITY
from tests.extensions.strong_motion.made import made_motion

RECORDS = {"a": made_motion(), "b": made_motion("x", 1.4, 0.9), "c": made_motion("y", 0.7, 2.1)}
YIELDS = [0.05, 0.1, 0.2]


@pytest.fixture(scope="module")
def study() -> ss.studies.SlidingDisplacements:
    return ss.studies.sliding(RECORDS, YIELDS, unit="cm")


def slid(motion, factor: float, coefficient: float, backward: float = math.inf) -> float:
    block = ShakenBlock(-factor * motion.acceleration, motion.interval)
    return float(block.slide(np.array([coefficient * GRAVITY]), backward)[0, 0])


def test_each_row_is_one_record_polarity_and_yield(study: ss.studies.SlidingDisplacements):
    table = study.table
    assert len(table) == 3 * 2 * 3
    assert not table.duplicated(["record", "polarity", "yield_coefficient"]).any()
    for row in table.itertuples():
        assert row.displacement == slid(RECORDS[row.record], row.polarity, row.yield_coefficient)
        assert row.pga == RECORDS[row.record].measures.pga
        assert row.yield_ratio == pytest.approx(row.yield_coefficient * GRAVITY / row.pga)
    assert table.polarity.tolist() == [1, 1, 1, -1, -1, -1] * 3


def test_a_positive_acceleration_slides_the_block_backward_under_polarity_one():
    """So it does in a run of the engine: the load gains -m a. Most programs have it the other way: polarity -1."""
    times = [0.0, 0.5, 1.0, 1.5]
    push = ss.loading.PiecewiseLinear(times, [0.0, 3.0, 0.0, 0.0])
    forward = ss.studies.sliding({"push": push}, 0.1, polarity=-1).table.displacement[0]
    assert forward > 0.0
    assert ss.studies.sliding({"push": push}, 0.1, polarity=1).table.displacement[0] == 0.0
    block = ss.SpringBlock(mass=1.0, stiffness=1e-9, normal_force=GRAVITY)
    law = ss.friction.Coulomb(0.1, 0.1)
    for sign in (1.0, -1.0):
        ground = ss.loading.PiecewiseLinear(times, [0.0, 3.0 * sign, 0.0, 0.0])
        run = ss.simulate(ss.Problem(block, law, initial_load=0.0, ground_acceleration=ground, one_way=True), 5.0)
        assert float(run.slip(5.0)) == pytest.approx(forward if sign < 0.0 else 0.0, rel=1e-7)


def test_records_are_scaled_by_factors_or_to_a_peak():
    by_factor = ss.studies.sliding(RECORDS, 0.1, scale=[1.0, 2.0], polarity=1).table
    assert by_factor.displacement[1] == slid(RECORDS["a"], 2.0, 0.1)
    assert by_factor.level.tolist() == by_factor.scale.tolist() == [1.0, 2.0] * 3
    to_peak = ss.studies.sliding(RECORDS, 0.1, scale_to_pga=["0.4 g", "2 m/s^2"]).table
    assert to_peak.pga.to_numpy() == pytest.approx(np.tile([0.4 * GRAVITY] * 2 + [2.0] * 2, 3), rel=1e-14)
    factor = 2.0 / RECORDS["c"].measures.pga
    assert to_peak.displacement.iloc[-1] == pytest.approx(slid(RECORDS["c"], -factor, 0.1), rel=1e-12)


def test_yields_may_have_a_unit_and_a_backward_one():
    one, other = (ss.studies.sliding(RECORDS, given, polarity=1).table for given in ("0.980665 m/s^2", 0.1))
    assert one.displacement.to_numpy() == pytest.approx(other.displacement.to_numpy(), rel=1e-12)
    same = ss.studies.sliding(RECORDS, YIELDS, backward="same").table
    expected = [
        slid(RECORDS[row.record], row.polarity, row.yield_coefficient, row.yield_coefficient * GRAVITY) for row in same.itertuples()
    ]
    assert same.displacement.tolist() == expected
    assert (same.peak_displacement >= same.displacement.abs()).all()
    assert (same.peak_displacement > same.displacement.abs()).any()


def test_statistics_are_those_of_all_cases_at_each_yield(study: ss.studies.SlidingDisplacements):
    for row in study.statistics.itertuples():
        values = study.table.displacement[study.table.yield_coefficient == row.yield_coefficient]
        assert (row.cases, row.at_rest) == (6, int((values == 0.0).sum()))
        assert (row.mean, row.median, row.least, row.most) == pytest.approx(
            (values.mean(), values.median(), values.min(), values.max())
        )
        logarithms = np.log(values[values > 0.0])
        assert row.std_ln == pytest.approx(logarithms.std() if len(logarithms) > 1 else math.nan, nan_ok=True)


def test_a_record_is_summarised_unscaled(study: ss.studies.SlidingDisplacements):
    records = ss.studies.sliding(RECORDS, 0.1, scale=3.0).records
    assert records.equals(study.records)
    assert records.pga.tolist() == [one.measures.pga for one in RECORDS.values()]
    assert records.samples.tolist() == [1001] * 3


def test_the_file_has_the_words_and_units_of_the_field(study: ss.studies.SlidingDisplacements, tmp_path):
    table = pd.read_csv(study.to_csv(tmp_path / "a.csv"), comment="#")
    assert table["permanent displacement (cm)"].to_numpy() == pytest.approx(100.0 * study.table.displacement.to_numpy(), rel=1e-14)
    assert table["PGA (g)"].to_numpy() == pytest.approx(study.table.pga.to_numpy() / GRAVITY, rel=1e-14)
    assert table["PGV (cm/s)"].to_numpy() == pytest.approx(100.0 * study.table.pgv.to_numpy(), rel=1e-14)
    assert table["yield coefficient (g)"].tolist() == YIELDS * 6
    assert table["significant duration D5-95 (s)"].tolist() == study.table.duration.tolist()
    assert "status" not in table
    assert "backward yield coefficient (g)" not in table
    assert "rigid" in (tmp_path / "a.csv").read_text().splitlines()[0]
    inches = ss.studies.sliding(RECORDS, YIELDS, unit="in", backward="same").in_words()
    assert inches["PGV (in/s)"].to_numpy() == pytest.approx(study.table.pgv.to_numpy() / 0.0254, rel=1e-14)
    assert {"peak displacement (in)", "backward yield coefficient (g)"} <= set(inches)


def test_what_does_not_slide_is_said():
    found = ss.studies.sliding(RECORDS, [0.1, 5.0])
    assert found.table.displacement[found.table.yield_coefficient == 5.0].tolist() == [0.0] * 6
    (note,) = found.notes
    assert note == "6 of 12 cases do not slide, displacement 0: the yield is not below the PGA"
    assert note in repr(found)


def test_figures_draw_what_the_tables_say(study: ss.studies.SlidingDisplacements):
    data = study.to_dataset()
    one = data.displacement.sel(level=1.0).where((data.record == "b") & (data.polarity == -1), drop=True)
    expected = study.table[(study.table.record == "b") & (study.table.polarity == -1)]
    assert one.values.ravel().tolist() == expected.displacement.tolist()
    axes = study.plot().axes[0]
    median = next(line for line in axes.lines if line.get_label() == "median")
    assert median.get_ydata() == pytest.approx(100.0 * study.statistics["median"].to_numpy())
    assert axes.get_yscale() == "log"
    assert "(cm)" in axes.get_ylabel()
    shaken, moving, moved = study.plot_record("c", yields=0.05).axes
    ends = [line.get_ydata()[-1] for line in moved.lines[:2]]
    rows = study.table[(study.table.record == "c") & (study.table.yield_coefficient == 0.05)]
    assert ends == pytest.approx(100.0 * rows.displacement.to_numpy(), rel=1e-12)
    assert [max(line.get_ydata()) for line in moving.lines[:2]] == pytest.approx(100.0 * rows.peak_velocity.to_numpy(), rel=1e-4)
    assert np.abs(shaken.lines[0].get_ydata()).max() * GRAVITY == pytest.approx(RECORDS["c"].measures.pga)
    assert sorted(line.get_ydata()[0] for line in shaken.lines[1:3]) == pytest.approx([-0.05, 0.05])


def test_a_record_in_a_figure_is_named_by_a_part_that_no_other_has(study: ss.studies.SlidingDisplacements):
    with pytest.raises(ss.InputError, match="no record has 'z' in their name"):
        study.plot_record("z")
    with pytest.raises(ss.InputError, match=r"yields must be one of the study, 0.05, 0.1, 0.2, got 0.3"):
        study.plot_record("a", yields=0.3)


# ---- columns --------------------------------------------------------------------------------------------------------------


def column(wave_speed: float) -> ss.ElasticSlab:
    return ss.ElasticSlab(1900.0, wave_speed, 20.0, 360e3, driver_impedance=0.0)


@pytest.mark.slow
def test_a_stiff_column_is_the_rigid_block_in_both_analyses():
    """Each time its wave speed doubles, the difference at least halves; the coupled column keeps ringing while it slides."""
    rigid = ss.studies.sliding({"a": RECORDS["a"]}, [0.05, 0.1]).table.displacement.to_numpy()
    for analysis, first in (("coupled", 0.05), ("decoupled", 0.02)):
        off = []
        for wave_speed in (2000.0, 4000.0):
            found = ss.studies.sliding({"a": RECORDS["a"]}, [0.05, 0.1], analysis=analysis, column=column(wave_speed))
            assert found.ok
            off.append(np.abs(found.table.displacement.to_numpy() / rigid - 1.0).max())
        assert off[0] < first
        assert off[1] < 0.6 * off[0]


def test_a_soft_column_is_another_answer_in_each_analysis():
    """Coupled as a run of the engine by hand; decoupled as a block under the mean acceleration of the stuck column."""
    soft, mass, motion = column(160.0), 1900.0 * 20.0, RECORDS["a"]
    law = ss.friction.Coulomb(*[0.1 * GRAVITY * mass / 360e3] * 2)
    coupled, decoupled = (
        ss.studies.sliding({"a": motion}, 0.1, analysis=one, column=soft, polarity=1).table.displacement[0]
        for one in ("coupled", "decoupled")
    )
    ground = motion.history(1.0)
    problem = ss.Problem(soft, law, initial_load=0.0, ground_acceleration=ground, one_way=True)
    run = ss.simulate(problem, 25.0)
    assert coupled == pytest.approx(float(run.slip(25.0)), rel=1e-3)
    stuck = ss.simulate(ss.Problem(soft, ss.friction.Coulomb(9.0, 9.0), initial_load=0.0, ground_acceleration=ground), 15.0)
    time = 0.0005 * np.arange(30_000)
    block = ShakenBlock(stuck.load(time) / mass, 0.0005)
    assert decoupled == pytest.approx(block.slide(np.array([0.1 * GRAVITY]))[0, 0], rel=1e-3)
    rigid = slid(motion, 1.0, 0.1)
    assert abs(coupled / rigid - 1.0) > 0.1
    assert abs(decoupled / coupled - 1.0) > 0.01


def test_a_column_may_yield_backward_too():
    found = ss.studies.sliding({"a": RECORDS["a"]}, 0.08, backward=0.1, analysis="coupled", column=column(4000.0), polarity=1).table
    rigid = ss.studies.sliding({"a": RECORDS["a"]}, 0.08, backward=0.1, polarity=1).table
    assert found.displacement[0] == pytest.approx(rigid.displacement[0], abs=0.02 * rigid.peak_displacement[0])


# ---- refusals -------------------------------------------------------------------------------------------------------------

EVEN = ss.loading.PiecewiseLinear([0.0, 0.1, 0.2], [0.0, 1.0, 0.0])
WRONG = {
    "no record": (([], 0.1), {}, "needs at least one record"),
    "no yield": ((EVEN, []), {}, "yields must have at least one number"),
    "yield 0": ((EVEN, 0.0), {}, "yields must be above 0: a part of g"),
    "yield below 0": ((EVEN, [0.1, -0.1]), {}, "got -0.1"),
    "yield of another unit": ((EVEN, "0.1 m"), {}, "yields must be above 0"),
    "two scales": ((EVEN, 0.1), {"scale": 2.0, "scale_to_pga": 0.4}, "give scale or scale_to_pga, not both"),
    "a scale below 0": ((EVEN, 0.1), {"scale": -1.0}, "polarity=-1 turns a record round"),
    "a polarity of 2": ((EVEN, 0.1), {"polarity": 2}, "polarity must be 1"),
    "a polarity in words": ((EVEN, 0.1), {"polarity": "normal"}, "polarity must be 1"),
    "an analysis in another word": ((EVEN, 0.1), {"analysis": "couple"}, "did you mean 'coupled'"),
    "a column that is too much": ((EVEN, 0.1), {"column": column(200.0)}, "a rigid block has none"),
    "a column that lacks": ((EVEN, 0.1), {"analysis": "coupled"}, "needs a column"),
    "a block as a column": ((EVEN, 0.1), {"analysis": "coupled", "column": ss.SpringBlock(1.0, 1.0, 1.0)}, "got SpringBlock"),
    "a unit of another kind": ((EVEN, 0.1), {"unit": "s"}, "unit must be one of m, cm, mm, in, ft"),
    "a baseline in another word": ((EVEN, 0.1), {"baseline": "median"}, "baseline must be None or 'mean'"),
    "numbers alone": (([[0.0, 1.0, 0.0]], 0.1), {}, "numbers alone have no interval"),
    "an array alone": ((np.zeros(3), 0.1), {}, "records must be"),
    "a sinusoid": ((ss.loading.Sinusoidal(0.0, 1.0, 1.0), 0.1), {}, "must have samples in straight lines, got Sinusoidal"),
    "uneven times": ((ss.loading.PiecewiseLinear([0.0, 0.1, 0.3], [0.0] * 3), 0.1), {}, "must have even times"),
    "silence to a peak": (
        (ss.loading.PiecewiseLinear([0.0, 0.1], [0.0] * 2), 0.1),
        {"scale_to_pga": 0.4},
        "its acceleration is 0 throughout",
    ),
    "too few backward": ((EVEN, [0.1, 0.2, 0.3]), {"backward": [0.1, 0.2]}, "one for each of 3 yields, got 2"),
    "an unknown argument": ((EVEN, 0.1), {"polarities": 1}, "did you mean 'polarity'"),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_makes_no_study_is_refused_in_one_line(case: str):
    given, named, message = WRONG[case]
    with pytest.raises(ss.InputError) as refused:
        ss.studies.sliding(*given, **named)
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)
    assert str(refused.value).startswith("sliding: ") or "0 throughout" in message


def test_the_mean_is_taken_off_only_if_that_is_asked():
    motion = RECORDS["a"]
    offset = ss.loading.PiecewiseLinear((0.01 * np.arange(1001)).tolist(), (motion.acceleration + 0.05).tolist())
    as_it_is, put_right = (ss.studies.sliding(offset, 0.1, baseline=one).table.displacement for one in (None, "mean"))
    expected = [slid(motion, sign, 0.1) for sign in (1, -1)]
    assert put_right.to_numpy() == pytest.approx(expected, rel=1e-3)
    assert abs(as_it_is[0] / expected[0] - 1.0) > 0.05


def test_ground_that_does_not_come_to_rest_is_told():
    motion = RECORDS["a"]
    offset = ss.loading.Accelerogram((motion.acceleration + 0.05).tolist(), 0.01)
    drift = [one for one in ss.studies.sliding({"far": offset}, 0.1).notes if "baseline" in one]
    assert len(drift) == 1
    assert "at the end of far (up to" in drift[0]
    assert not any("baseline" in one for one in ss.studies.sliding({"far": offset}, 0.1, baseline="mean").notes)


def test_records_of_one_name_are_told_apart():
    found = ss.studies.sliding([made_motion("same"), made_motion("same", 2.0), made_motion("other")], 0.1)
    assert found.records.record.tolist() == ["same (1)", "same (2)", "other"]
