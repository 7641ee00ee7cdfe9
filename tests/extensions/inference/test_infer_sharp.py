"""Sharp events: intervals where runs bend or jump between samples, and numbers of which only combinations are determined."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.record.resample import Jumps, spread, unsure
from tests.extensions.inference.laboratory import CoulombSlab, WeakeningSlab, correlated

STRESS, NOISE, SLIP_NOISE, EVERY = 2.9e6, 2e3, 5e-8, 2e-6
BODY = {"body.thickness": 0.1, "body.density": 1180.0, "initial.load": STRESS}
JUMPING = {"friction.static": 0.6, "friction.dynamic": 0.5, **BODY}
WEAKENING = {"friction.static": 0.6, "friction.dynamic": 0.5, "friction.distance": 2e-5, **BODY}
SLAB = ss.ElasticSlab(1200.0, 1300.0, 0.101, 5e6)
BOUNDS = {"initial.load": (2.89e6, 2.91e6)}
DRAWS = 150


def guess(law: Any) -> ss.Problem:
    return ss.Problem(SLAB, law, pull_rate=1e-3, initial_load=STRESS)


def table(time: Any, clean: tuple[Any, Any], seed: int) -> pd.DataFrame:
    shear, slip = (
        one + size * correlated(len(time), 0.0, 2 * seed + i)
        for i, (one, size) in enumerate(zip(clean, (NOISE, SLIP_NOISE), strict=True))
    )
    return pd.DataFrame({"time (s)": time, "tau (Pa)": shear, "load rate (m/s)": 1e-3, "slip (m)": slip})


def jumping(seed: int, free: Any = tuple(JUMPING), observe: str = "shear_stress") -> Inference:
    """Fit the record of a slab under Coulomb friction, with samples that are nowhere near the jumps on purpose."""
    true, shift = CoulombSlab(), EVERY * np.random.default_rng(1000 + seed).random()
    time = np.append(np.linspace(0.0, 4.9e-3, 200), np.arange(4.9e-3, true.onset(STRESS) + 1.9 * true.trip, EVERY)[1:] + shift)
    law = ss.friction.Coulomb(0.6005, 0.49)
    return ss.studies.infer(
        guess(law), table(time, true.sampled(time, STRESS), seed), free, observe=observe, starts=1, bounds=BOUNDS
    )


@pytest.fixture(scope="module")
def weakening() -> Callable[[int], Inference]:
    true = WeakeningSlab()
    clock, shear, slip = true.run(STRESS, 5.7e-3)

    def infer(seed: int) -> Inference:
        time = np.append(np.linspace(0.0, 4.9e-3, 200), np.arange(4.9e-3, 5.7e-3, EVERY)[1:])
        clean = np.interp(time, clock, shear), np.interp(time, clock, slip)
        law = ss.friction.LinearSlipWeakening(0.6005, 0.49, 2.2e-5)
        return ss.studies.infer(
            guess(law), table(time, clean, seed), tuple(WEAKENING), observe="shear_stress,slip", starts=1, bounds=BOUNDS
        )

    return infer


def test_the_closed_form_of_a_slab_that_jumps_is_the_run_of_the_engine() -> None:
    true = CoulombSlab()
    time = np.linspace(0.0, true.onset(STRESS) + 1.9 * true.trip, 2001)
    body = ss.ElasticSlab(true.density, true.wave_speed, true.thickness, true.normal)
    run = ss.simulate(ss.Problem(body, ss.friction.Coulomb(0.6, 0.5), pull_rate=1e-3, initial_load=STRESS), time[-1])
    shear, slip = true.sampled(time, STRESS)
    assert run.traction(time) == pytest.approx(shear, rel=1e-12)
    assert run.slip(time) == pytest.approx(slip, abs=1e-15)


def test_a_jump_between_samples_is_spread_and_makes_both_samples_unsure() -> None:
    time = np.arange(6.0)
    data = np.array([0.0, 0.0, 0.0, 1.0, 1.0, 1.0])
    for at in (2.2, 2.5, 2.9):
        jumps = Jumps(np.array([at]), np.array([1.0]))
        values = spread((time > at).astype(float), time, jumps, 2)
        assert values == pytest.approx([0.0, 0.0, 0.5 - (at - 2.0) / 2.0, 0.5 + (3.0 - at) / 2.0, 1.0, 1.0])
    added = unsure(time, data, Jumps(np.array([4.1]), np.array([1.0])))  # the jump of the data is elsewhere
    assert added == pytest.approx([0.0, 0.0, 24**-0.5, 24**-0.5, 0.0, 0.0])


@pytest.mark.slow
def test_static_friction_of_a_sharp_event_is_no_surer_than_the_mean_of_the_samples_before_it(weakening: Any) -> None:
    """The level of shear is known to the noise over the root of the number of samples, however sharp the event is."""
    study = weakening(0)
    least = NOISE / np.sqrt(600) / 5e6
    assert study.table.uncertainty["friction.static"] > least
    for name, value in WEAKENING.items():
        row = study.table.loc[name]
        assert abs(row.value - value) < 3.0 * row.uncertainty, name
    assert not any("smoothly" in note for note in study.notes)


@pytest.mark.slow
def test_a_jump_is_found_and_its_time_is_as_unsure_as_the_samples_are_apart() -> None:
    study, true = jumping(0), CoulombSlab()
    for name, value in JUMPING.items():
        row = study.table.loc[name]
        assert abs(row.value - value) < 3.0 * row.uncertainty, name
    trip = 2.0 * study.values["body.thickness"] / true.wave_speed
    assert abs(trip - true.trip) < EVERY
    width = study.table.uncertainty["body.thickness"] / study.values["body.thickness"] * true.trip
    assert width == pytest.approx(EVERY / np.sqrt(6.0), rel=0.2)  # its two ends are each unsure by the twelfth part of the square


@pytest.mark.slow
def test_words_say_that_impedance_and_travel_time_are_determined_and_density_wave_speed_and_thickness_are_not() -> None:
    study = jumping(1, (*JUMPING, "wave_speed"), "shear_stress,slip")
    (note,) = [one for one in study.notes if "none of the three" in one]
    assert "body.density*body.wave_speed (to 0.0" in note
    assert "body.thickness/body.wave_speed (to 0." in note
    assert note.endswith("%), but none of the three: fix one of them")
    values, true = study.values, CoulombSlab()
    assert values["body.density"] * values["body.wave_speed"] == pytest.approx(true.density * true.wave_speed, rel=2e-3)
    assert values["body.thickness"] / values["body.wave_speed"] == pytest.approx(0.5 * true.trip, rel=1e-2)
    assert not np.isfinite(study.table.uncertainty[["body.density", "body.wave_speed", "body.thickness"]]).any()


def covered(infer: Callable[[int], Inference], truth: dict[str, float]) -> dict[str, float]:
    held = dict.fromkeys(truth, 0)
    for seed in range(DRAWS):
        found = infer(seed).table
        for name, value in truth.items():
            held[name] += found.low[name] <= value <= found.high[name]
    return {name: count / DRAWS for name, count in held.items()}


@pytest.mark.slow
def test_intervals_of_a_sharp_event_of_a_slab_hold_the_truth_as_often_as_they_say(weakening: Any) -> None:
    shares = covered(weakening, WEAKENING)
    assert 0.92 <= np.mean(list(shares.values())) <= 0.98, shares
    assert min(shares.values()) >= 0.89, shares  # each of six shares of 150 draws: three standard errors of 1.8 %


@pytest.mark.slow
def test_intervals_from_jumps_between_samples_hold_the_truth_as_often_as_they_say() -> None:
    """Thickness follows from the places of two jumps between samples, whose distribution has no tails: it is held more often."""
    shares = covered(jumping, JUMPING)
    assert 0.92 <= np.mean(list(shares.values())) <= 0.99, shares
    assert min(shares.values()) >= 0.89, shares
