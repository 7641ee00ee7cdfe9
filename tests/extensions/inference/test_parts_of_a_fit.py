"""The arithmetic inside a fit, each piece by itself: against closed forms, full matrices and records of known shape."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.inference.certainty.certainty import _covariance
from stickslip.extensions.inference.fit import search
from stickslip.extensions.inference.fit.by_features import _with_gap
from stickslip.extensions.inference.fit.free import DELAY, SERVO, TREND, Free
from stickslip.extensions.inference.fit.memory import (
    ACTIVE,
    WHITE,
    ResidualBlock,
    independent_columns,
    spreads_of,
    unevenness,
)
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part, shortened
from stickslip.extensions.inference.fit.setup import LATER, SAMPLES_OF_PART, at_rests, own_of, parts_of, scales_of
from stickslip.extensions.inference.fitted_record import FittedRecord
from stickslip.extensions.inference.record import loading
from stickslip.extensions.inference.record.features import Samples, features_in
from stickslip.extensions.inference.record.noise import LOSSES, OUTLYING, cost_of, weights
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.errors import InputError
from tests.extensions.inference.laboratory import correlated

RANDOM = np.random.default_rng(7)


@pytest.mark.parametrize("loss", LOSSES)
@pytest.mark.parametrize("size", [0.3, 0.9, 1.1, 4.0])
def test_weights_are_derivatives_of_the_cost(loss: str, size: float) -> None:
    """Central differences in the squared residual, to 1e-8."""
    squared, step = (size * OUTLYING) ** 2, 1e-5
    costs = [cost_of(np.sqrt(np.array([squared + side * step])), loss) for side in (1.0, -1.0)]
    assert weights(np.array([size * OUTLYING]), loss)[0] == pytest.approx((costs[0] - costs[1]) / (2.0 * step), rel=1e-8)


def sawtooth(events: int) -> Record:
    """Friction that rises by 0.1 in 10 s and falls by it within 0.1 s, of which the last event is followed by 10 s of rise."""
    time = np.arange(0.0, 10.0 * (events + 1), 0.02)
    phase = np.mod(time, 10.0)
    friction = 0.5 + np.where(phase < 9.9, 0.1 * phase / 9.9, 0.1 - (phase - 9.9))
    return Record(time, {"friction": friction})


def test_two_events_give_one_row_of_features_and_three_give_two() -> None:
    for events in (2, 3):
        record = sawtooth(events)
        samples = Samples(record.time, record.measured)

        def between(begin: float, end: float, one: Samples = samples) -> Samples:
            inside = (one.time >= begin) & (one.time <= end)
            return Samples(one.time[inside], {name: values[inside] for name, values in one.values.items()})

        found = features_in(samples, between, "friction")
        assert {len(values) for values in found.values()} == {events - 1}
        assert found["recurrence"] == pytest.approx(10.0, abs=1e-3)
        assert found["time"] == pytest.approx(9.95 + 10.0 * np.arange(1, events), abs=0.02)
        assert found["friction_drop"] == pytest.approx(0.1, rel=0.02)


def test_noise_of_means_is_that_of_the_samples_over_the_root_of_their_number() -> None:
    """White noise at uneven times on a straight line: within 10 %, where leaving out one of the three weights is 20 % and more."""
    time = np.cumsum(RANDOM.uniform(0.2, 1.8, 40_000))
    values = 3.0 * time + RANDOM.normal(0.0, 0.5, len(time))
    sums = [np.append(0.0, np.cumsum(one)) for one in (time, values)]
    for width in (2, 4, 16):
        assert loading._noise_of_means(sums[0], sums[1], width) == pytest.approx(0.5 / np.sqrt(width), rel=0.1)


def test_as_many_parts_as_allowed_are_kept_and_one_more_is_told_by_its_factor(monkeypatch: pytest.MonkeyPatch) -> None:
    time = np.arange(200.0)
    values = np.repeat([0.0, 1.0, 0.0, 1.0], 50)
    allowed = np.full(8, 0.1)
    monkeypatch.setattr(loading, "MOST_PARTS", 4)
    assert loading.straight_parts(time, values, allowed, 0) == ([0, 50, 100, 150, 200], 1.0)
    monkeypatch.setattr(loading, "MOST_PARTS", 3)
    assert loading.straight_parts(time, values, allowed, 0)[1] > 1.0


def test_two_samples_are_a_part_of_a_record_and_one_is_none() -> None:
    record = sawtooth(2)
    assert len(record.part(0.0, 0.02)) == 2
    with pytest.raises(InputError, match="fewer than two samples"):
        record.part(0.0, 0.01)


def test_steps_of_free_numbers_that_start_at_zero_follow_the_record() -> None:
    time, slip = np.array([5.0, 10.0, 15.0]), np.array([2.0, np.nan, 6.0])
    problem = SimpleNamespace(first_pull_rate=-3.0, body=SimpleNamespace(impedance=1.0))
    moved = scales_of(Part(Record(time, {"slip": slip}), None, ("slip",)), problem)  # type: ignore[arg-type]
    assert moved["initial.slip"] == pytest.approx(0.4)
    assert moved[TREND] == pytest.approx(0.025)
    assert moved[DELAY] == moved[SERVO] == pytest.approx(0.1)
    still = scales_of(Part(Record(time, {"friction": slip}), None, ("friction",)), problem)  # type: ignore[arg-type]
    assert still["initial.slip"] == pytest.approx(0.1 * 3.0 * 10.0)


def test_parts_between_rests_begin_a_little_after_each_event() -> None:
    record = sawtooth(3)
    found = at_rests(Part(record, None, ("friction",)))
    begins = [one.begins for one in found]
    lows = [9.98, 19.98, 29.98]
    lasting = np.diff([*lows, 40.0])
    assert begins[0] == 0.0
    assert np.allclose(begins[1:], np.array(lows) + LATER * lasting, atol=0.05)
    assert all(len(one.record) >= SAMPLES_OF_PART for one in found)


@pytest.mark.parametrize(("number", "share", "stay"), [(2, 0.1, 1), (2, 0.5, 1), (3, 0.3, 2), (3, 0.9, 1), (2, 0.0, 2)])
def test_of_several_parts_the_last_ones_are_left_out_as_a_whole(number: int, share: float, stay: int) -> None:
    parts = [Part(sawtooth(1), None, ("friction",)) for _ in range(number)]
    kept = shortened(parts, share)
    assert len(kept) == stay
    assert all(one is other for one, other in zip(kept, parts, strict=False))


def test_independent_columns_span_all_that_changes_and_nothing_else() -> None:
    first, second = RANDOM.normal(size=(2, 50))
    for third in (second, first - 3.0 * second):
        slopes = np.column_stack([first, 1e-6 * second, np.zeros(50), 1e-6 * third])
        found = independent_columns(slopes)
        assert found.shape == (50, 2)
        assert np.allclose(found.T @ found, np.eye(2), atol=1e-12)
        assert np.allclose(found @ (found.T @ slopes), slopes, rtol=0, atol=1e-12 * np.abs(slopes).max(axis=0))


def blocks_of(*lengths: int) -> list[ResidualBlock]:
    ends = np.append(0, np.cumsum(lengths)).tolist()
    return [ResidualBlock(slice(first, last), np.cumsum(RANDOM.uniform(0.5, 1.5, last - first))) for first, last in pairwise(ends)]


def test_nothing_is_said_of_two_samples_that_hold_all_of_the_leverage() -> None:
    slopes = np.zeros((100, 1))
    slopes[40:42] = 1.0
    assert unevenness(np.random.default_rng(3).normal(size=100), slopes, WHITE, blocks_of(100)) == (1.0, 1.0)


def test_unevenness_compares_the_samples_that_hold_half_of_the_leverage_with_the_others() -> None:
    slopes = np.where(np.arange(100) < 10, 3.02, 1.0)[:, None]  # the first ten hold 91 of 181
    residual = RANDOM.normal(size=100) * np.where(np.arange(100) < 10, 30.0, 1.0)
    assert ACTIVE == 0.5
    found = unevenness(residual, slopes, WHITE, blocks_of(100)).found
    assert found == pytest.approx(np.sqrt(np.mean(residual[:10] ** 2) / np.mean(residual[10:] ** 2)), rel=1e-12)


def test_sentences_name_their_record_where_there_are_two() -> None:
    problem = ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), ss.friction.RateAndState(0.6, 0.01, 0.008, 1e-3), pull_rate=1e-3)
    for records in ([sawtooth(2)], [sawtooth(2), sawtooth(3)]):
        told = parts_of(problem, records, None, None, "contact")[1]
        assert told
        assert all(one.startswith("record: ") == (len(records) > 1) for one in told)


def test_a_search_that_jumps_led_away_ends_where_it_began(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(search, "sharp_cost", lambda _, x, __: float(np.sum(x**2)))
    for end, best in ((2.0, 1.0), (0.5, 0.5)):
        monkeypatch.setattr(search, "solved", lambda *_, end=end, **__: np.array([end]))
        cost, x = search._followed(None, np.array([1.0]), "linear", search.Best())  # type: ignore[arg-type]
        assert (cost, x[0]) == (best**2, best)


def test_a_file_without_times_is_named_with_the_line_of_its_headings(tmp_path: Path) -> None:
    file = tmp_path / "record.csv"
    file.write_text("# from the rig\nfriction,slip\n0.6,1\n0.6,2\n")
    with pytest.raises(InputError, match=r"record\.csv, line 2: no column 'time'"):
        Record.read(str(file))
    with pytest.raises(InputError, match=r"^record: no column 'time'"):
        Record.read({"friction": [0.6, 0.6]})


@pytest.mark.parametrize("larger", [1.0, 3.0])
def test_residuals_that_are_larger_where_they_count_widen_the_covariance(larger: float) -> None:
    """One number of constant influence but on ten samples of a hundred: White's covariance, where it is the larger one."""
    slopes = np.where(np.arange(400) < 40, 3.02, 0.1)[:, None]
    residual = RANDOM.normal(size=400) * np.where(np.arange(400) < 40, larger, 1.0)
    model = SimpleNamespace(independent=400, of_means=False, samples=400, inflation=0.0, memory={}, every=1, sizes={"slip": 1.0})
    record = SimpleNamespace(measured={"slip": residual})
    block = ResidualBlock(slice(0, 400), np.arange(400.0))
    model.parts, model.weights = [SimpleNamespace(record=record)], lambda _: np.ones(400)
    model.blocks = lambda _: [("slip", block)]
    found, uneven = _covariance(model, residual, slopes, 1.0)  # type: ignore[arg-type]
    plain = 1.0 / float(np.sum(slopes**2))
    assert (uneven["slip"].found > 1.0) == (larger > 1.0)
    if larger == 1.0:
        assert found[0, 0] == pytest.approx(plain, rel=0.02)  # Student's factor for 399 degrees of freedom is 1.003
    else:
        influence = slopes / np.sum(slopes**2)
        most = max(float(one[0, 0]) for one in spreads_of(influence, residual, [block]))
        assert most > 5.0 * plain
        assert found[0, 0] == pytest.approx(most, rel=0.02)


def test_the_error_of_samples_left_out_leaves_fitted_and_missing_ones_out() -> None:
    curves = pd.DataFrame({"quantity": ["slip"] * 4, "fitted": [True, True, False, False], "residual": [1.0, 3.0, 4.0, np.nan]})
    record = SimpleNamespace(curves=curves)
    assert FittedRecord.errors(record, {"slip": 2.0}, fitted=True) == pytest.approx(np.sqrt(5.0) / 2.0)  # type: ignore[arg-type]
    assert FittedRecord.errors(record, {"slip": 2.0}, fitted=False) == pytest.approx(2.0)  # type: ignore[arg-type]


@pytest.mark.parametrize("log", [True, False])
def test_the_width_of_a_value_is_what_a_small_step_of_the_searched_number_makes(log: bool) -> None:
    free = Free("friction.a", None, 0.02, 1e-3, 1.0, log, scale=7.0)  # type: ignore[arg-type]
    assert free.width(0.02, 1e-6) == pytest.approx(free.natural(free.searched(0.02) + 1e-6) - 0.02, rel=1e-5)


def test_events_behind_a_gap_within_one_recurrence_are_those_that_it_may_hide_one_of() -> None:
    """Samples each 0.1 s without those from 14 s to 16 s; events each 10 s."""
    time = np.arange(0.0, 60.0, 0.1)
    time = time[(time < 14.0) | (time > 16.0)]
    assert _with_gap(time, np.array([10.0, 20.0, 25.0, 30.0]), np.full(4, 10.0)).tolist() == [False, True, True, False]


def test_slip_is_counted_from_its_first_sample_and_friction_is_not() -> None:
    time = np.arange(200.0)
    moved = 5.0 + 0.01 * np.maximum(time - 100.0, 0.0)
    part = Part(Record(time, {"slip": moved, "friction": moved}), None, ("slip", "friction"))
    model: Any = SimpleNamespace(parts=[part])
    assert Model.data(model, 0, "slip") == pytest.approx(moved - 5.0, abs=1e-12)
    assert Model.data(model, 0, "friction") == pytest.approx(moved)


def test_the_load_of_each_part_is_free_within_fifty_standard_errors_of_what_was_measured() -> None:
    problem = ss.Problem(ss.SpringBlock(1.0, 1.0, 10.0), ss.friction.Coulomb(0.7, 0.5), pull_rate=1e-3, initial_load=5.0)
    parts = at_rests(Part(sawtooth(3), None, ("friction",)))
    for i, (one, part) in enumerate(zip(own_of(problem, parts, None), parts, strict=True)):
        load, error = part.first_load(10.0)
        assert (one.name, one.part, one.start) == ("initial.load", i, load)
        wide = 50.0 * max(error, 1e-6 * load)
        assert (load - one.low, one.high - load) == pytest.approx((wide, wide), rel=1e-6)


def test_means_of_noise_that_remembers_itself_are_allowed_as_much_as_single_samples() -> None:
    """White noise: five standard deviations of a mean over 1, 2, 4, ... samples. A memory of 64 samples: all alike up to there."""
    time = np.arange(8192.0)
    white, slow = (
        loading._allowed(
            time, values, loading._noise_of_means(np.append(0.0, np.cumsum(time)), np.append(0.0, np.cumsum(values)), 1), 0.0
        )
        for values in (correlated(8192, 0.0, 1), correlated(8192, 64.0, 1))
    )
    assert white[:6] == pytest.approx(5.0 * 2.0 ** (-0.5 * np.arange(6)), rel=0.1)
    assert slow[:6] == pytest.approx(slow[0], rel=0.06)
    assert slow[8] > 0.6 * slow[0] > 2.0
    assert slow[8:] / slow[8] == pytest.approx(2.0 ** (-0.5 * np.arange(6)), rel=1e-12)
