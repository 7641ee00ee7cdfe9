"""What a series shows of its program is named: ringing, a shift by a step, a wrong echo, the order. A right one shows nothing."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.schemes.benchmarks import benchmark_of, judge_series
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.run import SCHEMES, run_scheme
from stickslip.extensions.schemes.traits import orders_of
from tests.extensions.schemes.finite_volumes import Contact, Moved, Side, moved

STEPS = 2000


@cache
def run_of(name: str) -> ss.Solution:
    return ss.simulate(benchmark_of(name).scenario)


def series_of(name: str, *, late: float = 0.0, steps: int = STEPS) -> Series:
    """The exact series of a benchmark; its values may be those of times before, by a share of its step."""
    run = run_of(name)
    time = np.linspace(0.0, benchmark_of(name).scenario.duration, steps + 1)
    at = np.clip(time - late * time[1], 0.0, time[-1])
    return Series(time, run.slip(at) - run.problem.initial_slip, run.slip_rate(at), run.traction(at), "mine")


def traits(series: Series, name: str) -> tuple[str, ...]:
    (found,) = judge_series(series, name).judgements
    return found.traits


@pytest.mark.parametrize("name", ["smooth-slip", "linear-weakening", "two-slabs", "varying-normal-load", "moving-ground"])
def test_a_right_series_shows_nothing(name: str) -> None:
    assert traits(series_of(name), name) == ()


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(
    ("late", "words"), [(1.0, "a step late"), (-1.0, "a step early"), (0.5, "half a step late"), (-0.5, "half a step early")]
)
def test_a_series_at_other_times_is_named_although_it_passes(late: float, words: str) -> None:
    found = judge_series(series_of("smooth-slip", late=late), "smooth-slip").judgements[0]
    assert found.passed
    (told,) = found.traits
    assert told == f"mine has its slip, slip rate and traction {words}: write the values of the time that stands beside them"


def test_a_slip_rate_alone_between_the_times_is_named_alone() -> None:
    """As of leap-frog, whose velocities stand between its displacements."""
    base = series_of("smooth-slip")
    found = traits(replace(base, rate=series_of("smooth-slip", late=0.5).rate), "smooth-slip")
    assert [text.partition(":")[0] for text in found] == ["mine has its slip rate half a step late"]


def test_a_series_with_rounded_digits_is_not_called_shifted() -> None:
    base = series_of("smooth-slip")
    assert traits(replace(base, slip=base.slip * (1.0 + 3e-7), rate=base.rate * (1.0 - 3e-7)), "smooth-slip") == ()


@pytest.mark.parametrize("late", [-1e-9, 1e-9])
def test_a_sample_on_either_side_of_a_jump_at_rest_is_not_called_shifted(late: float) -> None:
    """Echoes make traction jump while these slabs rest, at times that are samples: a rounded time is before or after them."""
    assert traits(series_of("two-slabs", late=late), "two-slabs") == ()


def test_half_a_step_early_is_not_called_a_step_early_for_jumps_on_samples() -> None:
    """Under Coulomb friction traction only jumps, and half a step cannot be told from a step where jumps are on samples."""
    assert traits(replace(series_of("dwell"), traction=series_of("dwell", late=-0.5).traction), "dwell") == ()


def test_ringing_is_named_with_its_size_and_period() -> None:
    """0.3 m/s about the exact slip rate, in 5 steps, from 1 s on."""
    base = series_of("linear-weakening")
    rings = 0.3 * np.sin(2.0 * np.pi * np.arange(STEPS + 1) / 5.0) * (base.time > 1.0)
    (found,) = traits(replace(base, rate=base.rate + rings), "linear-weakening")
    assert found.startswith("mine rings from 1.0")
    assert " swings about the exact one by 0.2" in found
    assert found.endswith("with a period of 5 steps")


def test_a_bad_slip_rate_without_swings_does_not_ring() -> None:
    base = series_of("linear-weakening")
    assert traits(replace(base, rate=base.rate + 0.3 * np.sin(2.0 * base.time)), "linear-weakening") == ()


@pytest.mark.parametrize("steps", [20, 60])
def test_swings_over_many_steps_are_no_ringing(steps: int) -> None:
    """A wrong mass or stiffness has them: their period is that of the motion, and not of a mesh."""
    base = series_of("smooth-slip")
    assert traits(replace(base, rate=base.rate + 0.5 * np.sin(2.0 * np.pi * np.arange(STEPS + 1) / steps)), "smooth-slip") == ()


@pytest.mark.parametrize("size", [0.01, 0.05])
def test_white_noise_is_no_ringing(size: float) -> None:
    base, noise = series_of("smooth-slip"), np.random.default_rng(1).normal(size=STEPS + 1)
    assert traits(replace(base, rate=base.rate + size * base.rate.max() * noise), "smooth-slip") == ()


@pytest.mark.parametrize(("scheme", "rings"), [("mass-redistribution", True), ("newmark", True), ("theta", False), ("sbp4", False)])
def test_schemes_that_ring_after_a_shock_are_told_from_those_that_do_not(scheme: str, rings: bool) -> None:
    scenario = benchmark_of("coulomb").scenario
    found = traits(run_scheme(scenario.problem, 5.0, SCHEMES[scheme], 40), replace(scenario, duration=5.0))  # type: ignore[arg-type]
    assert [text.split()[1] for text in found] == ["rings"] * rings


def written(own: Moved) -> Series:
    """A series of the slip at times, with the means of the steps before and after as slip rate and traction."""
    time = np.append(own.time, own.time[-1] + own.time[1])
    rate, traction = (np.append(values, values[-1]) for values in (own.rate, own.traction))
    return Series(time, np.append(0.0, own.slip), rate, traction, "mine")


ROCK, TWO = (2800.0,), 2000.0 / 7000.0
COULOMB = Contact(0.8, lambda v: 0.3, 0.0, lambda t: 1e8)


def coulomb(driver: float) -> Series:
    side = Side(ROCK, (3500.0,), (1,), driver)
    return written(moved((side,), COULOMB, 8e7 * (1.0 + 1e-9), 1e4 / 3500.0, 9.0, refined=100))


def layers(beyond: float) -> Series:
    """The benchmark soft-layer, with another impedance of the stiff layer, as a share of the right one."""
    side = Side((2800.0, 2800.0 * beyond), (1750.0, 3500.0), (2, 8))
    contact = Contact(0.8, lambda v: 0.3 + 0.5 / (1.0 + v), 2.0, lambda t: 1e8)
    return written(moved((side,), contact, 8e7 * (1.0 + 1e-9), TWO, 14.0, refined=15))


def shaken(driver: float) -> Series:
    """The benchmark moving-ground, whose top is free, with another driver."""
    contact = replace(COULOMB, static=0.37, mu=lambda v: 0.37, normal=lambda t: 360e3, ground=moves)
    return written(moved((Side((1900.0,), (160.0,), (1,), driver),), contact, 9.6e4, 0.125, 2.0, refined=60))


def moves(t: float) -> float:
    return float(np.interp(t, [0.1, 0.2, 0.4], [0.0, -0.3, 0.0]))


AT_DRIVER = "of the driver: 1 of the stress comes back there, the series fits to"
AT_TOP = AT_DRIVER.replace("1 of", "-1 of")
AT_LAYER = "of where layer 1 meets layer 2: 0.3333 of the stress comes back there, the series fits to"
WRONG: dict[str, tuple[Any, str, str]] = {
    "right driver": (lambda: coulomb(np.inf), "coulomb", ""),
    "free for rigid": (lambda: coulomb(0.0), "coulomb", f"an echo with the wrong sign {AT_DRIVER} -1"),
    "absorbed": (lambda: coulomb(9.8e6), "coulomb", f"no echo {AT_DRIVER} 0"),
    "rigid for free": (
        lambda: shaken(np.inf),
        "moving-ground",
        f"an echo with the wrong sign {AT_TOP} 1",
    ),
    "right top": (lambda: shaken(0.0), "moving-ground", ""),
    "right layer": (lambda: layers(1.0), "soft-layer", ""),
    "sign of the interface": (lambda: layers(0.25), "soft-layer", f"an echo with the wrong sign {AT_LAYER} -0.3333"),
    "no interface": (lambda: layers(0.5), "soft-layer", f"no echo {AT_LAYER} 0"),
    "size of the interface": (lambda: layers(2.5), "soft-layer", f"an echo of the wrong size {AT_LAYER} 0.6667"),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("wrong", WRONG)
def test_an_echo_of_the_wrong_sign_or_size_is_named_with_its_place(wrong: str) -> None:
    make, name, words = WRONG[wrong]
    found = [text for text in traits(make(), name) if "echo" in text]
    assert found == [f"mine has {words}"] * bool(words)


@pytest.mark.parametrize(("name", "factor"), [("bow-at-a-tenth", 0.5), ("moving-ground", -1.0)])
def test_another_convention_is_no_wrong_echo(name: str, factor: float) -> None:
    base = series_of(name)
    (found,) = judge_series(replace(base, slip=factor * base.slip, rate=factor * base.rate), name).judgements
    assert [hint.partition(" the exact")[0] for hint in found.hints] in (["mine has half of"], ["mine has the opposite sign of"])
    assert found.traits == ()


def test_the_order_of_several_series_is_told() -> None:
    """Slip with an error of 0.2 step, and a slip rate with one of step^2."""
    several = []
    for steps in (500, 1000, 2000):
        one = series_of("smooth-slip", steps=steps)
        step = float(one.time[1])
        several.append(replace(one, slip=one.slip + 0.2 * step * one.time, rate=one.rate + step**2, name=f"s{steps}"))
    study = judge_series(several, "smooth-slip")
    assert study.told[-1] == "errors fall with the step as its power 1.00 in slip and 2.00 in slip rate: s500, s1000, s2000"
    assert orders_of(study.measured[:1]) == ""
    assert orders_of([study.measured[0]] * 2) == ""
