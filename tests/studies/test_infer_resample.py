"""Records with more samples than are fitted: means, with what is sharp and what is missing as it was."""

from __future__ import annotations

import numpy as np
import pytest

from stickslip.studies.inference.record import Record
from stickslip.studies.inference.resample import resampled
from tests.studies.laboratory import correlated

TIME = np.arange(20_000) * 0.01
NOISE = 1e-3 * correlated(len(TIME), 0.0, 1)


def read(friction: object, time: object = TIME) -> Record:
    return Record.read({"time (s)": time, "mu": friction})


def test_a_record_of_few_samples_stays() -> None:
    record = read(0.6 + NOISE)
    assert resampled(record, len(record)) == (record, ())


def test_hum_is_averaged_and_does_not_become_a_slow_wave() -> None:
    """A wave of 100.05 samples in 10 s looks, at each tenth sample, like one of 0.05 in 10 s; in means it is gone."""
    hum = 1e-2 * np.sin(2.0 * np.pi * 10.005 * TIME)
    made, said = resampled(read(0.6 + hum + NOISE), 2000)
    picked = (0.6 + hum + NOISE)[::10]
    assert np.abs(np.convolve(picked - 0.6, np.full(100, 0.01), "valid")).max() > 5e-3
    assert np.abs(np.convolve(made.measured["friction"] - 0.6, np.full(100, 0.01), "valid")).max() < 5e-4
    assert len(made) < 2100
    assert said[0].startswith(f"the 20000 samples of record became {len(made)}: means over 10")


def test_means_are_those_of_numpy_and_tell_how_much_surer_they_are() -> None:
    made, _ = resampled(read(0.6 + NOISE), 2000)
    assert made.relative is not None
    inner = made.relative == 1.0
    assert inner.sum() > 1900
    times, means = (values.reshape(-1, 10).mean(axis=1) for values in (TIME, 0.6 + NOISE))
    groups = {round(t, 6): mean for t, mean in zip(times, means, strict=True)}
    for t, value in list(zip(made.time[inner], made.measured["friction"][inner], strict=True))[:50]:
        assert value == pytest.approx(groups[round(t, 6)], rel=1e-12)
    assert made.relative[0] == pytest.approx(np.sqrt(10.0))
    assert made.time[[0, -1]] == pytest.approx(TIME[[0, -1]])


def test_a_step_and_a_gap_stay_where_they_are() -> None:
    keep = (TIME < 50.0) | (TIME > 60.0)
    friction = 0.6 + 0.05 * (TIME > 100.003) + NOISE
    made, _ = resampled(read(friction[keep], TIME[keep]), 2000)
    at = np.searchsorted(made.time, 100.003)
    assert made.time[at] - made.time[at - 1] == pytest.approx(0.01)
    assert made.measured["friction"][at] - made.measured["friction"][at - 1] > 0.04
    assert np.diff(made.time).max() == pytest.approx(10.01, abs=0.11)
    assert ((made.time < 50.0) | (made.time > 60.0)).all()


def test_missing_samples_stay_missing_and_are_not_averaged_with_others() -> None:
    friction = np.where((TIME > 70.0) & (TIME < 70.145), np.nan, 0.6 + NOISE)
    made, _ = resampled(read(friction), 2000)
    known = made.measured["friction"][np.isfinite(made.measured["friction"])]
    assert known == pytest.approx(0.6, abs=6e-3)
    missing = ~np.isfinite(made.measured["friction"])
    assert ((made.time[missing] > 70.0) & (made.time[missing] < 70.145)).all()
    assert missing.any()
