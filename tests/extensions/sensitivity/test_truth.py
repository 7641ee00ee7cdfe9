"""Sensitivities against closed forms, an independent integration of the variational equation, and their own error estimates."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss

CLOSE = 1e-9
"""Tolerance of derivatives (1): runs agree with closed forms to 1e-13, and a step takes two or three digits of them."""

BLOCK = {"stiffness": 1e3, "mass": 1.0, "normal_force": 10.0, "static": 0.6, "dynamic": 0.4, "pull_rate": 0.1}


def coulomb(numbers: dict[str, float]) -> ss.Problem:
    block = ss.SpringBlock(*(numbers[name] for name in ("mass", "stiffness", "normal_force")))
    law = ss.friction.Coulomb(numbers["static"], numbers["dynamic"])
    return ss.Problem(block, law, pull_rate=numbers["pull_rate"], initial_load=0.0)


def stick_slip(numbers: dict[str, Any]) -> dict[str, Any]:
    """Return what is known of the first slip of a block under Coulomb friction, also for complex numbers."""
    k, m, s, pull = (numbers[name] for name in ("stiffness", "mass", "normal_force", "pull_rate"))
    drop, pace = s * (numbers["static"] - numbers["dynamic"]), cmath.sqrt(k / m)
    lasts = 2.0 / pace * (math.pi - cmath.atan(drop * pace / (k * pull)))
    start, slip = s * numbers["static"] / (k * pull), pull * lasts + 2.0 * drop / k
    return {"start": start, "duration": lasts, "end": start + lasts, "slip": slip, "traction_drop": 2.0 * drop, "pace": pace}


def slip_at(numbers: dict[str, Any], time: float) -> Any:
    """Return the slip at a time in or after one of the slips, also for complex numbers."""
    one, pull, k = stick_slip(numbers), numbers["pull_rate"], numbers["stiffness"]
    drop = one["traction_drop"] / 2.0
    period = one["duration"] + 2.0 * drop / (k * pull)
    turns = math.floor(((time - one["start"]) / period).real)
    since = time - one["start"] - turns * period
    if since.real >= one["duration"].real:
        return (turns + 1) * one["slip"]
    angle = one["pace"] * since
    return turns * one["slip"] + pull * (since - cmath.sin(angle) / one["pace"]) + drop / k * (1.0 - cmath.cos(angle))


def slope(function: Callable[[dict[str, Any]], Any], numbers: dict[str, float], name: str) -> float:
    """Return a derivative of a closed form, by a step into the complex plane."""
    step = 1e-20 * numbers[name]
    return float(function(numbers | {name: numbers[name] + 1j * step}).imag / step)


@pytest.mark.parametrize(
    ("of", "numbers"),
    [
        ("start", ("static", "pull_rate")),
        ("end", ("mass", "stiffness")),
        ("duration", ("dynamic", "normal_force")),
        ("slip", ("stiffness", "static")),
        ("traction_drop", ("normal_force", "mass")),
    ],
)
def test_numbers_of_an_event_have_the_derivatives_of_the_closed_form(of: str, numbers: tuple[str, ...]) -> None:
    found = ss.studies.sensitivity(coulomb(BLOCK), numbers, of, event=0, duration=0.3)
    for number in numbers:
        true = slope(lambda values: stick_slip(values)[of], BLOCK, number)
        scale = abs(stick_slip(BLOCK)[of]) / BLOCK[number]
        assert found.by(number)[0] == pytest.approx(true, rel=CLOSE, abs=CLOSE * scale), number


def test_the_recurrence_is_that_of_the_closed_form_and_the_last_event_may_be_asked_for() -> None:
    found = ss.studies.sensitivity(coulomb(BLOCK), "static", "recurrence", event=-1, duration=0.7)
    true = slope(lambda one: stick_slip(one)["duration"] + stick_slip(one)["traction_drop"] / (1e3 * 0.1), BLOCK, "static")
    assert found.derivatives[0, 0] == pytest.approx(true, rel=CLOSE)
    assert found.table.event.tolist() == [3]


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.sampled(every=8)
def test_the_error_estimate_covers_the_error_and_is_small(seed: int) -> None:
    draw = np.random.default_rng(seed)
    numbers = {name: value * float(draw.uniform(0.7, 1.4)) for name, value in BLOCK.items()}
    numbers["static"] = numbers["dynamic"] + float(draw.uniform(0.05, 0.3))
    name, time = str(draw.choice(list(BLOCK))), float(draw.uniform(0.2, 2.0))
    found = ss.studies.sensitivity(coulomb(numbers), name, "slip", at=time, duration=time)
    true = slope(lambda one: slip_at(one, time), numbers, name)
    scale = slip_at(numbers, time).real / numbers[name]
    assert found.errors[0, 0] <= 1e-7 * max(scale, abs(true))
    assert abs(found.derivatives[0, 0] - true) <= found.errors[0, 0]


def test_a_slab_that_weakens_with_slip_has_the_derivatives_of_its_growth() -> None:
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=10e3, normal_stress=1e8)
    law = ss.friction.LinearSlipWeakening(0.6, 0.5, 0.5)
    problem = ss.Problem(slab, law, pull_rate=0.0, initial_excess=1e5)
    numbers = {"density": 2800.0, "wave_speed": 3500.0, "normal_stress": 1e8, "distance": 0.5, "excess": 1e5, "static": 0.6}
    times = np.array([0.05, 0.2])

    def slip(one: dict[str, Any], time: float) -> Any:
        falls = one["normal_stress"] * (one["static"] - 0.5) / one["distance"]
        return one["excess"] / falls * (cmath.exp(falls * time / (one["density"] * one["wave_speed"])) - 1.0)

    found = ss.studies.sensitivity(problem, list(numbers), "slip", at=times, duration=0.2)
    for number in numbers:
        true = [slope(lambda one, t=time: slip(one, t), numbers, number) for time in times]
        assert found.by(number) == pytest.approx(true, rel=CLOSE), number


def test_a_pulse_of_a_slab_ends_with_its_echo_whose_time_is_the_thickness() -> None:
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=10e3, normal_stress=1e8)
    problem = ss.Problem(slab, ss.friction.Coulomb(0.6, 0.5), pull_rate=1e-3, initial_excess=0.0)
    trip = 2.0 * 10e3 / 3500.0
    found = ss.studies.sensitivity(problem, ["thickness", "dynamic"], "slip", at=[0.5 * trip, 1.5 * trip], duration=1.6 * trip)
    loads = 2800.0 * 3500.0**2 * 1e-3  # G V: the load grows by this over the thickness (Pa m/s)
    rate = 1e7 / (2800.0 * 3500.0)

    def slip(thickness: float, time: float) -> float:
        lasts = min(time, 2.0 * thickness / 3500.0)
        return rate * lasts + 0.5 * loads / thickness * lasts**2 / (2800.0 * 3500.0)

    step = 1.0
    for n, time in enumerate((0.5 * trip, 1.5 * trip)):
        by_hand = (slip(10e3 + step, time) - slip(10e3 - step, time)) / (2.0 * step)
        assert found.by("thickness")[n] == pytest.approx(by_hand, rel=1e-6)
        assert found.by("dynamic")[n] == pytest.approx(-1e8 * min(time, trip) / (2800.0 * 3500.0), rel=CLOSE)


def test_rate_and_state_agrees_with_the_variational_equation() -> None:
    mass, stiffness, normal, pull, rate, state, load = 1.0, 50.0, 1.0, 1e-3, 2e-3, 3.0, 0.62
    numbers = {"reference": 0.6, "a": 0.011, "b": 0.016, "distance": 2e-3}
    law = ss.friction.RateAndState(**numbers, rate=1e-3)
    start: dict[str, float] = {"initial_rate": rate, "initial_state": state, "initial_load": load}
    problem = ss.Problem(ss.SpringBlock(mass, stiffness, normal), law, pull_rate=pull, **start)
    times = np.array([0.4, 1.0, 2.5])
    found = ss.studies.sensitivity(problem, ["friction.a", "friction.b", "body.mass"], "slip", at=times, duration=2.5)

    def pace(y: Any, a: Any, b: Any, m: Any) -> Any:
        force, v, theta = y[0], y[1], y[2]
        w = np.log(1e-3 * theta / 2e-3)
        mu = a * np.arcsinh(v / 2e-3 * np.exp((0.6 + b * w) / a))
        return np.array([stiffness * (pull - v), (force - normal * mu) / m, 1.0 - v * theta / 2e-3, v])

    def with_slopes(_: float, flat: Any) -> Any:
        """Return dy/dt, and d/dt of the derivatives of y, with derivatives by a step into the complex plane."""
        y, grown, numbers = flat[:4], flat[4:].reshape(3, 4), np.array([0.011, 0.016, 1.0])
        rows = [pace(y, *numbers)]
        for n in range(3):
            moved = numbers + 1e-30j * (np.arange(3) == n)
            rows.append(pace(y + 1e-30j * grown[n], *moved).imag / 1e-30)
        return np.concatenate([rows[0].real, *rows[1:]])

    begin = np.concatenate(([load, rate, state, 0.0], np.zeros(12)))
    true = solve_ivp(with_slopes, (0.0, 2.5), begin, "DOP853", times, rtol=1e-12, atol=1e-16).y
    assert found.values == pytest.approx(true[3], rel=1e-10)
    for n, number in enumerate(("a", "b", "mass")):
        assert found.by(number) == pytest.approx(true[4 + 4 * n + 3], rel=1e-8), number


def test_there_is_no_number_behind_an_event_that_grazes() -> None:
    """A block slides from twice the pull rate: its slip rate swings about the pull rate, and all but touches 0."""
    block, law = ss.SpringBlock(1.0, 1e3, 10.0), ss.friction.Coulomb(0.6, 0.4)
    problem = ss.Problem(block, law, pull_rate=0.1, initial_rate=0.2 + 1e-11, initial_load=4.0)
    touches = math.pi / math.sqrt(1e3)
    found = ss.studies.sensitivity(problem, "initial.rate", "slip", at=[0.5 * touches, 1.5 * touches], duration=0.2)
    pace = math.sqrt(1e3)
    assert found.by("initial.rate")[0] == pytest.approx(math.sin(pace * 0.5 * touches) / pace, rel=CLOSE)
    assert np.isnan(found.by("initial.rate")[1])
    (note,) = found.notes
    assert note.startswith("no derivative with respect to initial.rate at 0.149019 s: between initial.rate = 0.199999998")
    assert "a change of the contact appears or vanishes: number 2, at 99.345" in note
    assert note.endswith("where it comes to rest for one of the values only")
