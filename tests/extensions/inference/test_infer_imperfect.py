"""Inference from records that are not perfect: the answer is that of least squares, and what is left widens the intervals."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import least_squares

import stickslip as ss
from stickslip.extensions.inference.fit.memory import WHITE, Memory, ResidualBlock, memory_of, spread_by, spreads_of, unevenness
from stickslip.extensions.inference.fit.part import Part, approached
from stickslip.extensions.inference.record.record import Record
from stickslip.problem.loading import PiecewiseLinear, Steps
from tests.extensions.inference.laboratory import correlated

Floats = NDArray[np.float64]
SLOW, FAST = 22.9e-6, 228.4e-6
CLOCK = np.arange(1800) * 1e-3
LAW = ss.friction.RateAndState(0.49, 0.0062, 0.0044, 30e-6, SLOW, evolution="slip")
TRUTH = ss.Problem(ss.SpringBlock(8000.0, 1.6e11, 1e8), LAW, pull_rate=Steps([0.0, 0.738], [SLOW, FAST]))
GUESS = replace(TRUTH, friction=replace(LAW, a=0.0059, b=0.0045, distance=41e-6))
FREE = ["a", "b", "distance", "reference"]
NAMES = [f"friction.{name}" for name in FREE]


def friction(pull: Any) -> Floats:
    return np.asarray(ss.simulate(replace(TRUTH, pull_rate=pull), 1.8).traction(CLOCK) / 1e8)


def read(shear: Floats) -> dict[str, Floats]:
    return {"time (s)": CLOCK, "mu": shear}


@pytest.mark.slow
def test_the_answer_is_that_of_least_squares_also_where_the_loading_is_a_little_wrong() -> None:
    """A ramp of 55 ms is fitted as a step: noise estimated from the misfit made the answer worse than its own start."""
    ramp = PiecewiseLinear([0.0, 0.735, 0.79], [SLOW, SLOW, FAST])
    data = friction(ramp) + 3e-4 * correlated(1800, 50.0, 1) + 2e-5 * correlated(1800, 0.0, 2)

    def residual(x: Floats) -> Floats:
        law = replace(GUESS.friction, **dict(zip(FREE, np.exp(x).tolist(), strict=True)))
        return np.asarray(ss.simulate(replace(GUESS, friction=law), 1.8).traction(CLOCK) / 1e8 - data)

    plain = least_squares(residual, np.log([getattr(GUESS.friction, name) for name in FREE]), x_scale="jac")
    study = ss.studies.infer(GUESS, read(data), FREE, starts=1)
    assert study.fit.rms["friction"] == pytest.approx(np.sqrt(np.mean(plain.fun**2)), rel=1e-4)
    assert list(study.values.values()) == pytest.approx(np.exp(plain.x).tolist(), rel=1e-3)
    assert study.model.memory["friction"].time <= 1.799 / 8.0
    assert any("misses features of friction" in note or "is no noise but a drift or a misfit" in note for note in study.notes)
    for name, value in zip(NAMES, (LAW.a, LAW.b, LAW.distance, LAW.reference), strict=True):
        assert study.table.low[name] < value < study.table.high[name], name


@pytest.mark.slow
def test_a_value_and_its_interval_say_the_same() -> None:
    data = friction(TRUTH.pull_rate) + 3e-4 * correlated(1800, 50.0, 3)
    table = ss.studies.infer(GUESS, read(data), FREE, starts=1, profiles=True).table
    assert (table.high - table.low).to_numpy() == pytest.approx(2.0 * 1.96 * table.uncertainty.to_numpy(), rel=0.02)


def servo(time: Floats, lasts: float) -> Floats:
    return np.where(time < 0.738, SLOW, FAST + (SLOW - FAST) * np.exp(-(time - 0.738) / lasts))


def test_a_servo_is_the_exponential_approach_of_the_load_point() -> None:
    pull: Any = approached(TRUTH.pull_rate, 0.05)
    time = np.linspace(0.0, 1.8, 20_001)
    apart = pull.at(time) - servo(time, 0.05)
    assert np.abs(apart).max() < 2e-3 * FAST
    assert abs(np.trapezoid(apart, time)) < 1e-5 * 0.05 * FAST  # the load point comes to the same place


@pytest.mark.slow
def test_the_time_of_a_servo_is_found_and_the_law_with_it() -> None:
    after = 0.05 * np.linspace(0.0, 9.0, 300)
    pull = PiecewiseLinear([0.0, *(0.738 + after)], [SLOW, *servo(0.738 + after, 0.05)])
    data = friction(pull) + 1e-4 * correlated(1800, 0.0, 4)
    study = ss.studies.infer(GUESS, read(data), [*FREE, "record.servo"], starts=1)
    assert study.values["record.servo"] == pytest.approx(0.05, abs=1e-3)
    assert study.values["friction.distance"] == pytest.approx(30e-6, rel=0.02)
    assert isinstance(study.best.pull_rate, PiecewiseLinear)  # the best scenario has the servo in its loading
    with pytest.raises(ss.InputError, match=r"record\.servo needs a pull rate that changes in steps"):
        approached(pull, 0.1)


def test_weights_are_those_of_rsfit3000() -> None:
    """From the sample i on where the rate changes, (N/1)^p, (N/2)^p ..., and 1 before."""
    part = Part(Record.read(read(0.5 + 0.0 * CLOCK)), None, ("friction",))
    found = part.weights(TRUTH, 0.4)
    wanted = np.ones(1800)
    wanted[738:] = (1800.0 / np.arange(1, 1800 - 738 + 1)) ** 0.4
    assert found / found[0] == pytest.approx(wanted, rel=1e-12)
    assert np.mean(found**2) == pytest.approx(1.0, rel=1e-12)
    with pytest.raises(ss.InputError, match="the pull rate does not change"):
        part.weights(replace(TRUTH, pull_rate=SLOW), 0.4)


@pytest.mark.slow
def test_weights_and_windows_change_the_numbers_of_a_wrong_model_and_are_told() -> None:
    shear = friction(TRUTH.pull_rate) + 0.003 * CLOCK**2 + 5e-5 * correlated(1800, 0.0, 5)
    free = ["distance", "reference"]
    study = ss.studies.infer(GUESS, read(shear), free, starts=1, windows=True, trend="none")
    assert study.windows is not None
    assert study.windows.columns.tolist() == ["begin", "end", "samples", *NAMES[2:]]
    assert study.windows.loc[0, NAMES[2:]].tolist() == list(study.values.values())
    assert len(study.windows) == 4
    assert np.ptp(study.windows["friction.distance"]) > 0.1 * study.values["friction.distance"]
    assert any(note.startswith("over 4 windows of") for note in study.notes)
    weighted = ss.studies.infer(GUESS, read(shear), free, starts=1, weight=1.0, trend="none")
    assert abs(weighted.values["friction.distance"] / 30e-6 - 1.0) < abs(study.values["friction.distance"] / 30e-6 - 1.0)


@pytest.mark.slow
def test_each_run_of_a_search_is_told() -> None:
    said: list[str] = []
    ss.studies.infer(GUESS, read(friction(TRUTH.pull_rate)), ["a"], starts=2, progress=said.append)
    runs = [int(text.rpartition(", ")[2].split()[0]) for text in said if text.endswith("runs so far")]
    assert runs == sorted(runs)
    assert set(range(1, runs[-1])) <= set(runs)
    assert {text.partition(",")[0] for text in said} >= {"start 1 of 24", "fit 1 to all samples", "what the record determines"}


TIME = np.arange(1200) * 0.01
BLOCKS = [ResidualBlock(slice(0, 700), TIME[:700]), ResidualBlock(slice(700, 1200), TIME[700:])]
SLOPES = np.column_stack([np.ones(1200), TIME, np.exp(-(((TIME - 6.0) / 0.3) ** 2)), np.exp(-np.maximum(TIME - 4.0, 0.0))])
NOISE = Memory(0.2, 0.8, 0.6)


def drawn(seed: int, memory: Memory = NOISE) -> Floats:
    slow = memory.size * correlated(1200, memory.time / 0.01, seed) if memory.size else 0.0
    return np.asarray(slow + memory.white * np.random.default_rng(10_000 + seed).standard_normal(1200))


def left_of(noise: Floats) -> Floats:
    return np.asarray(noise - SLOPES @ np.linalg.lstsq(SLOPES, noise)[0])


def test_the_memory_of_noise_is_found_below_white_noise() -> None:
    found = np.array([memory_of(left_of(drawn(seed)), SLOPES, [ResidualBlock(slice(0, 1200), TIME)]) for seed in range(12)])
    assert np.median(found, axis=0) == pytest.approx(NOISE, rel=0.15)
    alone = [memory_of(left_of(drawn(seed, WHITE)), SLOPES, [ResidualBlock(slice(0, 1200), TIME)]) for seed in range(12)]
    assert [one.time for one in alone] == [0.0] * 12


def test_the_memory_of_many_samples_is_that_of_their_means() -> None:
    time = np.arange(20_000) * 1e-3
    noise = 0.8 * correlated(20_000, 200.0, 1) + 0.6 * correlated(20_000, 0.0, 2)
    found = memory_of(noise - noise.mean(), np.ones((20_000, 1)), [ResidualBlock(slice(0, 20_000), time)])
    assert found.time == pytest.approx(0.2, rel=0.4)
    assert found.white == pytest.approx(0.6, rel=0.1)


def test_covariances_are_the_products_with_whole_matrices() -> None:
    influence = np.linalg.pinv(SLOPES).T
    apart = np.abs(TIME[:, None] - TIME)
    same = np.equal.outer(np.arange(1200) < 700, np.arange(1200) < 700)
    whole = same * NOISE.size**2 * np.exp(-apart / NOISE.time) + NOISE.white**2 * np.eye(1200)
    np.testing.assert_allclose(spread_by(influence, NOISE, BLOCKS), influence.T @ whole @ influence, rtol=1e-9, atol=1e-18)
    rest = left_of(drawn(1))
    lag = np.abs(np.subtract.outer(np.arange(1200), np.arange(1200)))
    for width, found in zip((1, 2, 4, 8), spreads_of(influence, rest, BLOCKS), strict=False):
        weight = same * np.maximum(1.0 - lag / width, 0.0) * np.outer(rest, rest) * 1200 / (1200 - 4)
        np.testing.assert_allclose(found, influence.T @ weight @ influence, rtol=1e-9, atol=1e-18)


def test_a_misfit_is_told_from_noise_that_is_larger_somewhere() -> None:
    """A bump where the run changes is a misfit; noise that is larger there, and noise with a memory, are noise."""
    block = [ResidualBlock(slice(0, 1200), TIME)]
    bump = left_of(drawn(1, WHITE) + 12.0 * np.gradient(SLOPES[:, 2], TIME))
    assert unevenness(bump, SLOPES, WHITE, block).misfit > 2.0
    larger = left_of(drawn(1, WHITE) * (1.0 + 4.0 * SLOPES[:, 2]))
    found = unevenness(larger, SLOPES, WHITE, block)
    assert found.found > 1.2
    assert found.misfit == 1.0
    assert all(unevenness(left_of(drawn(seed)), SLOPES, NOISE, block).found == 1.0 for seed in range(20))
