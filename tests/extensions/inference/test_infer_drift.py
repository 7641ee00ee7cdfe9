"""A record whose friction falls with slip: its drift is free by itself, what is left is told, and a search has an end."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.fit.plateaus import PlateauDrift
from stickslip.extensions.inference.fit.progress import OutOfTime, SearchProgress
from stickslip.extensions.inference.fit.setup import parts_of
from stickslip.extensions.inference.fit.starting import shown_drift
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.record.record import Record
from tests.extensions.inference.double_shear import FREE, GUESS, LONG, Rig
from tests.extensions.inference.laboratory import correlated

FALLING = Rig(trend=-2.0)
TWO = Rig(times=(0.0, 20.0), rates=(1e-5, 1e-4), lasts=40.0)
NEAR = replace(
    GUESS,
    body=ss.SpringBlock(20.0, FALLING.stiffness, FALLING.normal),
    friction=ss.friction.RateAndState(0.62, 0.008, 0.0125, 15e-6, 1e-5),
)
"""The machine without its drift."""


def seen(rig: Rig, seed: int = 1) -> PlateauDrift:
    parts, _ = parts_of(GUESS, [Record.read(rig.record(seed))], None, None, "contact")
    found = shown_drift(GUESS, parts)
    assert found is not None
    return found


@cache
def told() -> tuple[Inference, list[str]]:
    """Return the fit of a record whose friction falls with slip, of which nobody has told it, and its progress."""
    said: list[str] = []
    return ss.studies.infer(GUESS, FALLING.record(), FREE, starts=2, progress=said.append), said


@pytest.mark.slow
def test_a_drift_of_plateaus_is_free_by_itself_and_the_law_is_found() -> None:
    """Least squares without the drift is off by 5 to 16 %, the reference by three standard errors."""
    study, said = told()
    for name, value in {**FALLING.truth, "record.trend": -2.0}.items():
        row = study.table.loc[name]
        assert row.low <= value <= row.high, (name, row.value, row.uncertainty)
    for name, share in {"friction.a": 0.015, "friction.b": 0.01, "friction.distance": 0.01, "body.stiffness": 0.02}.items():
        assert study.values[name] == pytest.approx(FALLING.truth[name], rel=share)
    note = "plateaus of friction fall with slip: record.trend is free, too, and is -2"
    assert any(one.startswith(note) and one.endswith("trend='none' leaves it out") for one in study.notes)
    assert said[0] == "plateaus of friction fall with slip: record.trend is free, too"
    assert not any("without derivatives" in one for one in said)
    assert int(said[-1].rpartition(", ")[2].split()[0]) < 700  # a search without derivatives takes more than 2000


@pytest.mark.slow
def test_a_user_who_says_no_is_told_what_is_left_and_nothing_goes_on_in_vain() -> None:
    said: list[str] = []
    study = ss.studies.infer(NEAR, FALLING.record(), ["b", "reference"], trend="none", progress=said.append)
    assert set(study.values) == {"friction.b", "friction.reference"}
    look = study.looks["friction"][0]
    assert look.kind == "drift with slip"
    assert look.size == pytest.approx(-2.0, abs=0.1)
    start = "what is left of friction looks like a drift with slip of -2"
    assert any(one.startswith(start) and one.endswith("free record.trend") for one in study.notes)
    assert not any("without derivatives" in one for one in said)


def test_plateaus_show_a_drift_with_slip_or_with_time_and_none_where_there_is_none() -> None:
    for rig in (Rig(), TWO):
        for trend, creep in ((-2.0, 0.0), (3.0, 0.0), (0.0, -1e-4)):
            look = seen(replace(rig, trend=trend, creep=creep))
            assert look.seen
            assert look.told
            assert look.with_slip == (creep == 0.0)
            assert look.value == pytest.approx(trend or creep, abs=4.0 * look.error)
            assert look.error < 0.1 * abs(trend or creep)
        assert not seen(rig).seen


@pytest.mark.slow
def test_a_drift_with_time_is_one_with_time_and_two_drifts_are_two() -> None:
    rig = replace(TWO, creep=-1e-4, trend=4.0)
    study = ss.studies.infer(NEAR, rig.record(), ["a", "reference"], starts=1)
    for name, value in {"record.drift": -1e-4, "record.trend": 4.0, "friction.a": 0.008, "friction.reference": 0.62}.items():
        assert study.values[name] == pytest.approx(value, abs=4.0 * study.table.uncertainty[name]), name


@pytest.mark.slow
def test_from_two_plateaus_it_is_said_that_levels_cannot_tell_a_drift_from_the_effect_of_rate() -> None:
    study = ss.studies.infer(NEAR, replace(TWO, trend=-2.0).record(), ["b", "reference"], starts=1)
    assert any(one.startswith("each of the 2 rates comes once: levels cannot tell a drift") for one in study.notes)
    assert study.values["record.trend"] == pytest.approx(-2.0, abs=4.0 * study.table.uncertainty["record.trend"])


@pytest.mark.slow
def test_a_drift_that_the_fit_does_not_need_is_held_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("stickslip.extensions.inference.fit.plateaus"), "DRIFT_WORTH_A_TRY", 0.0)
    said: list[str] = []
    study = ss.studies.infer(NEAR, TWO.record(), ["a", "reference"], starts=1, progress=said.append)
    assert any("record." in one and "is free, too" in one for one in said)
    assert set(study.values) == {"friction.a", "friction.reference"}
    assert not any("is free, too" in one for one in study.notes)
    assert not any("record." in one for one in study.notes if one.startswith("the search begins"))
    assert 0.61 < study.table.start["friction.reference"] < 0.63


@pytest.mark.slow
def test_after_its_time_a_search_gives_the_best_numbers_so_far_and_says_what_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("stickslip.extensions.inference.fit.progress"), "LOOKED", -1.0)
    said: list[str] = []
    study = ss.studies.infer(GUESS, FALLING.record(), FREE, trend="none", max_time="1 ns", progress=said.append)
    assert not study.estimate.finished
    start = "these are the best numbers so far: stopped after"
    note = next(one for one in study.notes if one.startswith(start))
    assert "times the noise is left" in note
    assert "max_time=2e-09 gives it twice the time" in note
    assert np.isfinite(list(study.values.values())).all()
    assert study.curves.residual.notna().all()


def test_time_that_is_over_is_told_once_and_not_before_a_trial_has_succeeded() -> None:
    now = 0.0
    told = SearchProgress(lambda text: None, 3.0, lambda: now)
    now = 10.0
    told.run()
    told.tried(None, np.zeros(0), np.full(3, 1e5))  # type: ignore[arg-type]
    told.run()
    told.succeeded = True
    with pytest.raises(OutOfTime, match=r"stopped after 3 s of processor time and 3 runs; .* max_time=6 "):
        told.run()
    told.run()
    assert told.limit == math.inf


def test_progress_has_misfit_trials_and_words(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("stickslip.extensions.inference.fit.progress"), "LOOKED", -1.0)
    said: list[str] = []
    ss.studies.infer(NEAR, FALLING.record(), ["reference"], starts=1, trend="none", progress=said.append)
    last = [one for one in said if one.startswith("fit")][-1]
    assert "times the noise is left (a drift" in last
    assert last.endswith(" runs so far")


@pytest.mark.parametrize(
    ("options", "message"), [({"trend": "yes"}, "infer: trend 'yes' is unknown"), ({"max_time": 0.0}, "max_time")]
)
def test_options_that_cannot_be_used_are_one_line(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.studies.infer(NEAR, TWO.record(), ["a"], **options)


def drawn(seed: int, **numbers: Any) -> Rig:
    """Return a rig with five plateaus at random rates, at least 5 s long."""
    random = np.random.default_rng(seed)
    rates = [float(random.choice([3e-6, 1e-5, 3e-5, 1e-4]))]
    while len(rates) < 5:
        rate = float(random.choice([3e-6, 1e-5, 3e-5, 1e-4]))
        rates += [rate] if rate != rates[-1] else []
    return Rig(rates=tuple(rates), wobble=0.0, rate=25.0, **numbers)


@pytest.mark.slow
@pytest.mark.parametrize("memory", [0.0, 20.0])
def test_no_record_of_40_without_a_drift_gets_one_and_all_of_40_with_one_do(memory: float) -> None:
    """Measured: 0 of 80 without a drift get one, and all of 40 with one of 2 /m.

    With noise that remembers itself for 0.8 s all of 16 with one of 5e-5 /s get one, 2 of them with slip and not with time.
    """
    freed = dict[tuple[float, float], dict[str, int]]()
    for trend, creep in ((0.0, 0.0), (-2.0, 0.0) if memory == 0.0 else (0.0, -5e-5)):
        count = {"record.trend": 0, "record.drift": 0}
        for seed in range(40):
            rig = drawn(seed, trend=trend, creep=creep)
            record = rig.record(seed)
            if memory:
                record["mu"] = rig.run[0] + rig.noise * correlated(len(rig.clock), memory, seed)
            found = ss.studies.infer(NEAR, record, FREE, starts=1).values
            count = {name: number + int(name in found) for name, number in count.items()}
        freed[trend, creep] = count
    assert freed.pop((0.0, 0.0)) == {"record.trend": 0, "record.drift": 0}
    right, wrong = ("record.trend", "record.drift") if memory == 0.0 else ("record.drift", "record.trend")
    (counted,) = freed.values()
    assert counted[right] >= (40 if memory == 0.0 else 32)
    assert counted[right] + counted[wrong] >= 40
    assert counted[wrong] <= (2 if memory == 0.0 else 8)


@pytest.mark.slow
def test_a_record_of_33_000_samples_is_followed_within_its_intervals() -> None:
    rig, said = replace(LONG, trend=-2.0), list[str]()
    study = ss.studies.infer(GUESS, rig.record(), FREE, progress=said.append)
    for name, value in {**rig.truth, "record.trend": -2.0}.items():
        row = study.table.loc[name]
        assert row.low <= value <= row.high, (name, row.value, row.uncertainty)
        assert row.value == pytest.approx(value, rel=0.01)
    assert int(said[-1].rpartition(", ")[2].split()[0]) < 1000
