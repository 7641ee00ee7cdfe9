"""Parts of the inference: derivatives, records that are averaged, records of other laboratories, and coverage of intervals."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.record.record import Record
from stickslip.extensions.inference.record.resample import resampled
from stickslip.problem.loading import Steps
from tests.extensions.inference.laboratory import RateAndStateBlock, correlated, load_point

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


def test_a_straight_rise_is_averaged() -> None:
    """Twenty standard deviations within each ten samples; only at its two ends, where the record bends, samples stay."""
    made, _ = resampled(read(0.6 + 0.2 * np.clip(TIME - 100.0, 0.0, 5.0) + NOISE), 2000)
    assert len(made) < 2100


def test_missing_samples_stay_missing_and_are_not_averaged_with_others() -> None:
    friction = np.where((TIME > 70.0) & (TIME < 70.145), np.nan, 0.6 + NOISE)
    made, _ = resampled(read(friction), 2000)
    known = made.measured["friction"][np.isfinite(made.measured["friction"])]
    assert known == pytest.approx(0.6, abs=6e-3)
    missing = ~np.isfinite(made.measured["friction"])
    assert ((made.time[missing] > 70.0) & (made.time[missing] < 70.145)).all()
    assert missing.any()


SIZE = 1e-4
CLOCK = np.linspace(0.0, 60.0, 241)
STEPS = ([0.0, 20.0], [1e-6, 1e-5])
GUESS = ss.Problem(ss.SpringBlock(20.0, 6e7, 5e4), ss.friction.RateAndState(0.62, 0.008, 0.0125, 15e-6), pull_rate=1e-6)
FREE = ["friction.a", "friction.b", "friction.distance", "body.stiffness"]


def record() -> dict[str, Any]:
    noise = SIZE * np.random.default_rng(3).standard_normal(len(CLOCK))
    moved = load_point(CLOCK, *STEPS)
    run = ss.simulate(replace(GUESS, pull_rate=ss.loading.Steps(*STEPS)), CLOCK[-1])
    shear = run.traction(CLOCK) / run.problem.normal + noise
    return {"time (s)": CLOCK, "load point (m)": moved, "friction": shear, "standard deviation": np.full(len(CLOCK), SIZE)}


def with_number(problem: ss.Problem, name: str, factor: float) -> ss.Problem:
    place, _, last = name.partition(".")
    owner: Any = getattr(problem, place)
    changed: Any = {place: replace(owner, **{last: factor * getattr(owner, last)})}
    return replace(problem, **changed)


def test_derivatives_of_residuals_are_central_differences_of_runs_made_by_hand() -> None:
    """To 1e-6 of the largest of a column: 1e-7 is what the square of the step and the tolerance of runs leave."""
    study = ss.studies.infer(GUESS, record(), FREE, starts=1)
    model, x = study.model, study.estimate.searched
    found = model.fine(x).jacobian(x)
    size = study.model.sizes["friction"] * SIZE

    def residual(problem: ss.Problem) -> Any:
        return ss.simulate(problem, CLOCK[-1], rtol=1e-11).traction(CLOCK) / problem.normal / size

    for column, name in enumerate(FREE):
        by = [
            (residual(with_number(study.best, name, np.exp(h))) - residual(with_number(study.best, name, np.exp(-h)))) / (2.0 * h)
            for h in (1e-3, 5e-4)
        ]
        hand = (4.0 * by[1] - by[0]) / 3.0
        assert np.abs(found[:, column] - hand).max() < 1e-6 * np.abs(hand).max(), name


TIMES, RATES = [0.0, 60.0, 100.0], [1e-6, 1e-5, 1e-6]
TRUE = RateAndStateBlock()
NAMES = ("friction.a", "friction.b", "friction.distance", "body.stiffness", "friction.reference")
DRAWS = 200


def covered(per_sample: float, draws: int, first_seed: int = 0) -> dict[str, float]:
    """Share of records whose interval holds the truth, by number; the noise forgets itself within so many samples."""
    clock = np.linspace(0.0, 200.0, 1501)
    clean, moved = TRUE.friction(clock, TIMES, RATES), load_point(clock, TIMES, RATES)
    truth = dict(zip(NAMES, (TRUE.a, TRUE.b, TRUE.distance, TRUE.stiffness, TRUE.reference), strict=True))
    law = ss.friction.RateAndState(TRUE.reference, TRUE.a, TRUE.b, TRUE.distance)
    guess = ss.Problem(ss.SpringBlock(TRUE.mass, TRUE.stiffness, TRUE.normal), law, pull_rate=1e-6)
    held = dict.fromkeys(NAMES, 0)
    for seed in range(first_seed, first_seed + draws):
        friction = clean + 2e-4 * correlated(len(clock), per_sample, seed)
        data = {"time (s)": clock, "load point (m)": moved, "mu": friction}
        table = ss.studies.infer(guess, data, NAMES, starts=1).table
        for name in NAMES:
            held[name] += table.low[name] <= truth[name] <= table.high[name]
    return {name: count / draws for name, count in held.items()}


@pytest.mark.slow
@pytest.mark.parametrize("per_sample", [0.0, 10.0], ids=["white", "correlated"])
def test_intervals_of_95_percent_hold_the_truth_as_often_as_they_say(per_sample: float) -> None:
    shares = covered(per_sample, DRAWS)
    assert 0.92 <= np.mean(list(shares.values())) <= 0.98, shares
    assert min(shares.values()) >= 0.90, shares  # each of five shares of 200 draws: three standard errors of 1.5 %


RECORDS = Path(__file__).parent / "records"
PRINTED = 1e-9
"""Last digit of the friction coefficients in the files; the times have nine decimals, too, and friction changes by 0.01 in 1 s."""
LAW = ss.friction.RateAndState(reference=0.6, a=0.005, b=0.01, distance="10 um", rate="1 um/s", evolution="ageing")
BLOCK = ss.SpringBlock(mass="1 kg", stiffness=1e-3 / 1e-6 * 1e6, normal_force="1 MN")  # 0.001 of the normal force per um
PULLED = {"velocity_step": 1e-5, "slide_hold_slide": Steps([0.0, 100.0], [0.0, 1e-6])}


def problem_of(name: str) -> ss.Problem:
    return ss.Problem(BLOCK, LAW, pull_rate=PULLED[name], initial_load="600 kN", initial_state="10 s", initial_rate="1 um/s")


@pytest.mark.parametrize("name", PULLED)
def test_friction_is_that_of_an_older_program(name: str) -> None:
    record = Record.read(RECORDS / f"{name}.csv")
    run = ss.simulate(problem_of(name), record.clock[-1])
    np.testing.assert_allclose(run.traction(record.clock) / 1e6, record.measured["friction"], rtol=0.0, atol=4 * PRINTED)


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", PULLED)
def test_the_law_of_an_older_program_comes_back(name: str) -> None:
    problem = problem_of(name)
    begin = replace(problem, friction=replace(LAW, a=0.008, b=0.012, distance="20 um"), body=replace(BLOCK, stiffness=2e9))
    free = ["a", "b", "distance", "stiffness"]
    found = ss.studies.infer(begin, RECORDS / f"{name}.csv", free, start="problem", starts=1)
    np.testing.assert_allclose(list(found.values.values()), [0.005, 0.01, 1e-5, 1e9], rtol=1e-4, atol=0.0)
