"""Samples that a logger has repeated: they are seen, said and left out; equal samples that are measurements stay."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.record.repeats import repeats_in
from tests.extensions.inference import velocity_steps
from tests.extensions.inference.laboratory import correlated
from tests.problems import Floats

TIME = np.linspace(0.0, 49.9, 500)


def held(values: Any, which: Any) -> Floats:
    """Return values, those at some places replaced by the one before (zero-order hold)."""
    last = np.maximum.accumulate(np.where(which, 0, np.arange(len(values))))
    return np.asarray(np.asarray(values)[last])


def some(count: int, share: float, seed: int) -> Any:
    which = np.random.default_rng(seed).random(count) < share
    which[:2] = which[-2:] = False
    return which


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("digit", [0.0, 2e-5], ids=["fine", "digitised"])
@pytest.mark.parametrize("memory", [0.0, 10.0], ids=["white", "remembers itself"])
def test_repeats_in_noise_are_seen(seed: int, digit: float, memory: float) -> None:
    values = 0.6 + 1e-2 * np.sin(TIME) + 3e-4 * correlated(500, memory, seed)
    values = np.round(values / digit) * digit if digit else values
    which = some(500, 0.2, seed)
    found = repeats_in(held(values, which))
    assert found[which].all()
    assert found[~which].sum() < 0.1 * 500
    assert not repeats_in(values).any()


def test_a_slow_sensor_on_a_fast_logger_is_measured_where_its_value_is_new() -> None:
    values = np.repeat(0.6 + 3e-4 * correlated(200, 0.0, 1), 10)
    assert repeats_in(values).sum() == 1800
    assert not repeats_in(values).reshape(-1, 10)[:, 0].any()


def test_repeats_in_a_steady_motion_are_seen_by_what_it_then_makes_up_for() -> None:
    for rates in ((1e-6, 1e-6), (1e-6, 1e-5)):
        moved = np.where(TIME < 25.0, rates[0] * TIME, rates[0] * 25.0 + rates[1] * (TIME - 25.0))
        which = some(500, 0.1, 3)
        assert (repeats_in(held(moved, which)) == which).mean() > 0.97
        assert not repeats_in(moved).any()


STEPPED: Floats = np.where((TIME.astype(int) // 5) % 2 == 0, 1e-6, 1e-5)
HOLDS = np.cumsum(np.where((TIME.astype(int) // 3) % 2 == 0, 1e-6, 0.0))
STICKS = np.cumsum(np.isin(np.arange(500) % 25, (20, 21, 22)) * np.random.default_rng(5).random(500))
COARSE = np.round((0.6 + 3e-4 * correlated(500, 0.0, 4)) / 4e-4) * 4e-4


@pytest.mark.parametrize(
    "values",
    [
        STEPPED, STICKS, HOLDS, COARSE, np.full(500, 0.6), np.floor(0.4 * np.arange(500.0)),
        np.where(TIME < 20.0, 0.6, 0.6 + 1e-3 * np.sin(TIME)), np.nan * TIME,
    ],
    ids=["rates", "sticks and slips", "holds", "coarse digits", "constant", "digits of a slow motion", "steady first", "no number"],
)  # fmt: skip
def test_equal_samples_that_are_measurements_stay(values: Any) -> None:
    assert not repeats_in(values).any()


def columns(seed: int = 1) -> dict[str, Any]:
    random = np.random.default_rng(seed)
    return {
        "time (s)": TIME,
        "shear stress (MPa)": 3.0 + 3e-3 * random.standard_normal(500),
        "normal stress (MPa)": 5.0 + 3e-3 * random.standard_normal(500),
        "load point (um)": 1.0 * TIME + 0.3 * random.standard_normal(500),
    }


def test_rows_that_are_repeats_as_a_whole_are_left_out_and_said() -> None:
    which = some(500, 0.2, 2)
    given = {name: values if name.startswith("time") else held(values, which) for name, values in columns().items()}
    record = ss.studies.Record.read(given)
    assert len(record) == 500 - which.sum()
    assert record.time == pytest.approx(TIME[~which])
    assert sum(f"exactly in {which.sum()} of 500 rows" in note for note in record.notes) == 3


def test_a_column_that_repeats_alone_has_no_number_there_and_a_normal_load_is_interpolated() -> None:
    which = some(500, 0.2, 2)
    given = columns()
    shear = ss.studies.Record.read(given | {"shear stress (MPa)": held(given["shear stress (MPa)"], which)})
    assert len(shear) == 500
    assert np.isnan(shear.measured["friction"]).tolist() == which.tolist()
    normal = ss.studies.Record.read(given | {"normal stress (MPa)": held(given["normal stress (MPa)"], which)})
    assert np.isfinite(normal.measured["friction"]).all()
    assert normal.normal is not None
    assert len(np.unique(normal.normal)) == 500


def repeating(seed: int, column: str | None = None) -> Any:
    """Return a record of velocity steps in which every fifth row, or a value of every fifth row, is the one before."""
    data = velocity_steps.record(seed=seed)
    which = some(len(data), 0.2, seed)
    for name in data.columns if column is None else [column]:
        if not name.startswith("time"):
            data[name] = held(data[name].to_numpy(), which)
    return data, int(which.sum())


@pytest.fixture(scope="module")
def whole() -> Any:
    """The fit of the record without repeats."""
    return velocity_steps.inferred(velocity_steps.record(), velocity_steps.TWO)


@pytest.mark.slow
@pytest.mark.parametrize("column", [None, "mu"], ids=["rows", "one column"])
def test_intervals_count_no_repeats(whole: Any, column: str | None) -> None:
    """The noise is that of the sensor, and the standard uncertainty that of 80 % of the samples."""
    data, count = repeating(1, column)
    study = velocity_steps.inferred(data, velocity_steps.TWO)
    assert any(note.startswith(f"friction repeats the sample before it exactly in {count} of 1501 rows") for note in study.notes)
    assert study.model.samples == 1501 - count
    assert study.fit.noise.item() == pytest.approx(2e-4, rel=0.06)
    wider = study.table.uncertainty / whole.table.uncertainty
    assert wider.to_numpy() == pytest.approx(np.full(2, 0.8**-0.5), rel=0.08)


@pytest.mark.slow
@pytest.mark.parametrize("column", [None, "mu"], ids=["rows", "one column"])
def test_intervals_of_records_with_repeats_hold_the_truth_as_often_as_they_say(column: str | None) -> None:
    """Of 40 records 35 hold: 95 % of 40 are 38 +- 1.4."""
    held_by = dict.fromkeys(velocity_steps.TWO, 0)
    for seed in range(40):
        table = velocity_steps.inferred(repeating(seed, column)[0], velocity_steps.TWO).table
        for name in held_by:
            held_by[name] += table.low[name] <= velocity_steps.TRUTH[name] <= table.high[name]
    assert min(held_by.values()) >= 35, held_by
