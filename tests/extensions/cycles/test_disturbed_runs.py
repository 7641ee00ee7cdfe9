"""How disturbances grow by two runs that differ a little: beside multipliers, closed forms, shifts in time and own integrations."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.disturbed.growth_of_pair import growth_of_pair
from stickslip.extensions.cycles.disturbed.measure import Measure, first_disturbance
from stickslip.extensions.cycles.disturbed.pair import Pair
from stickslip.extensions.cycles.disturbed.stand import Stand
from stickslip.extensions.cycles.exponent import MeasuredGrowth
from tests.extensions.cycles.problems import coulomb, rate_and_state


def string(**changes: Any) -> ss.Problem:
    """Return the bundled drill string with other numbers, by their paths with two underscores."""
    problem = ss.load_scenario("drill-string").problem
    for name, value in changes.items():
        problem = problem.parameters[name.replace("__", ".")].put(value)
    return problem


def grown(problem: ss.Problem, skip: float, duration: float) -> MeasuredGrowth:
    """Return the growth in a pair of runs."""
    return growth_of_pair(problem, skip, duration, 1e-10, lambda text: None)


def test_the_exponent_of_a_string_on_a_cycle_is_its_multiplier_over_its_period() -> None:
    """Period and multiplier are those of docs/cycles.md, by Newton's and Arnoldi's iterations: to 3e-3."""
    found = ss.studies.lyapunov(string(body__driver_impedance=2000.0, loading__pull_rate=8.95), 300.0, skip=100.0)
    assert found.exponent == pytest.approx(math.log(0.9101) / 5.336266, rel=3e-3)
    assert "measured on two runs that differ by 1e-06" in found.text


def test_a_pair_of_runs_of_a_rigid_body_tells_what_the_equation_of_disturbances_does() -> None:
    """To the standard error, and to 2 %."""
    cycle = ss.studies.cycle(rate_and_state())
    found = grown(cycle.problem, 0.0, 60.0 * cycle.period)
    wanted = math.log(abs(cycle.multipliers[0])) / cycle.period
    assert abs(found.exponent - wanted) < found.error
    assert found.exponent == pytest.approx(wanted, rel=0.02)


def test_a_pair_of_runs_of_a_slab_without_mass_tells_what_its_echoes_do() -> None:
    """The mean over phases and the same round trips: to 5 standard errors of a tenth of the size."""
    slab = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=1e4, normal_stress=1e8)
    weakening = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    problem = ss.Problem(slab, weakening, pull_rate=0.1, initial_excess=1.0)
    pair, echoes = grown(problem, 720.0, 2400.0), ss.studies.lyapunov(problem, 2400.0, skip=720.0)
    begin = float(echoes.table["time"].searchsorted(pair.time[0]))
    counted = echoes.table.iloc[int(begin) :]
    wanted = float(np.ptp(counted["growth"].iloc[[0, -1]]) / np.ptp(counted["time"].iloc[[0, -1]]))
    assert (pair.growth[-1] - pair.growth[0]) / pair.counted == pytest.approx(wanted, rel=0.02)


STEEL = ss.friction.ExponentialStribeck(static=0.5, dynamic=0.3, rate="50 mm/s")
STRONGER = ss.friction.RateAndState(reference=0.6, a=0.015, b=0.01, distance="10 um")


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("problem", "times", "to"),
    [
        (string(body__driver_impedance=2000.0, loading__pull_rate=9.3), (120.0, 300.0), 1e-4),
        (
            ss.Problem(
                ss.ElasticSlab(2800.0, 3500.0, 10.0, 1e6, driver_impedance=5e6),
                STRONGER,
                pull_rate=1e-2,
                initial_load=6.1e5,
                initial_state="1 ms",
            ),
            (0.6, 1.2),
            1e-5,
        ),
        (
            ss.Problem(
                ss.PositionLoop(1.0, 100.0, 10.0, integral_gain=50.0, derivative_gain=5.0),
                STEEL,
                pull_rate=1.0,
                initial_rate=1.1,
                initial_load=3.0,
            ),
            (20.0, 150.0),
            0.03,
        ),
    ],
    ids=["string with a bit", "slab under a law with a state", "position loop"],
)
def test_disturbances_of_steady_sliding_fade_at_the_rate_of_the_leading_root(
    problem: ss.Problem, times: tuple[float, float], to: float
) -> None:
    """The roots of the characteristic equation, as `ss.studies.steady` finds them."""
    assert ss.studies.lyapunov(problem, times[1], skip=times[0]).exponent == pytest.approx(
        ss.studies.steady(problem).slidings[-1].growth, rel=to
    )


def test_under_a_pull_that_swings_disturbances_of_sliding_fade_with_the_dashpot() -> None:
    """A linear equation with damping c has the exponent -c / 2m, whatever drives it: to 1e-3."""
    block = ss.SpringBlock(mass=1.0, stiffness=100.0, normal_force=1.0, damping=0.4)
    pull = ss.loading.Sinusoidal(mean=1.0, amplitude=0.5, period=3.0)
    problem = ss.Problem(block, ss.friction.Coulomb(0.1, 0.1), pull_rate=pull, initial_rate=1.0, initial_load=1.0)
    assert ss.studies.lyapunov(problem, 60.0, skip=10.0).exponent == pytest.approx(-0.2, rel=1e-3)


MACHINE = {"body__driver_impedance": 2000.0, "body__driver_inertia": 800.0, "body__driver_integral_gain": 300.0}
LAYERS = ss.load_scenario("pipe-and-collar").problem.parameters["body.inertia"].put(30.0)


@pytest.mark.parametrize(
    "problem",
    [string(), string(**MACHINE), LAYERS, replace(rate_and_state(), initial_load=5.9, initial_state=10.0), coulomb()],
    ids=["rigid drive", "machine", "layers", "state", "rest"],
)
def test_a_shift_in_time_is_no_disturbance(problem: ss.Problem) -> None:
    """A run that is a little ahead stays so, to 1e-3, and all but 1e-3 of that is taken away; a machine's motion is differenced."""
    pair = Pair.begin(problem, 640.0 * min(problem.round_trip_time, 7.0), 1e-11, shifts=True)
    pair.differ_by(pair.stand.flow.times(0.0))
    for _ in range(60):
        stand = pair.lead()
    measure = Measure.of(pair.run)
    measure.see(stand)
    ahead = 1e-7 * pair.interval
    pair.differ_by(pair.flow(stand, measure).times(ahead))
    for _ in range(6):
        stand = pair.lead()
    between = Stand(pair.other).at(stand.phases) - stand.here
    _, left = pair.apart(stand, measure)
    wanted = pair.flow(stand, measure).times(ahead)
    size = float(np.linalg.norm(measure.scaled(wanted, stand)))
    assert np.linalg.norm(measure.scaled(between - wanted, stand)) < 1e-3 * size
    assert left < 1e-3 * size


HEAVY, DRIVE, TURNS = 20.0, 20_000.0, 4.0
"""Inertia of a bit (kg m^2), impedance of its drive (N m s) and rate of it (rad/s): the string rests and slips chaotically."""
OF_WAVE, OF_RATE = 1e4, 10.0
"""Sizes of a wave (N m) and a rate (rad/s) by which disturbances are measured here."""


def paces(push: float, pushed: float, rate: float, ahead: float) -> tuple[float, float]:
    """Return how fast the rate of the bit and its disturbance grow under a load and its disturbance."""
    body, normal, falls = CHAOTIC.body, CHAOTIC.normal, 0.3 * math.exp(-0.9 * rate)
    resists = body.impedance + normal * (0.0033 - 0.9 * falls)
    return (push - body.impedance * rate - normal * (0.5 + falls + 0.0033 * rate)) / HEAVY, (pushed - resists * ahead) / HEAVY


def own_sizes(trips: int, steps: int) -> list[float]:
    """Return the logarithm of the size of a disturbance after each round trip, by the method of steps.

    Heun's method with steps of one length, on the load that a round trip before has left, with the linear equation of a
    disturbance; a rest ends that of the rate. The first round trip's load is a straight line, and waves are disturbed after it.
    """
    impedance, trip = CHAOTIC.body.impedance, CHAOTIC.round_trip_time
    back, step = (impedance - DRIVE) / (impedance + DRIVE), trip / steps
    sent, turn = 2.0 * impedance * DRIVE * TURNS / (impedance + DRIVE), np.pi * np.arange(steps + 1) / steps
    load, rate, ahead = np.linspace(0.0, sent, steps + 1), 0.0, 0.0
    lead: Any = np.zeros(steps + 1)
    found: list[float] = []
    for n in range(trips):
        rates, push, pushed = [(rate, ahead)], load.tolist(), lead.tolist()
        for k in range(steps):
            if rate > 0.0 or push[k + 1] > 0.8 * CHAOTIC.normal:
                pace, grows = paces(push[k], pushed[k], rate, ahead)
                later = paces(push[k + 1], pushed[k + 1], max(rate + step * pace, 0.0), ahead + step * grows)
                rate, ahead = rate + 0.5 * step * (pace + later[0]), ahead + 0.5 * step * (grows + later[1])
            if rate <= 0.0:
                rate = ahead = 0.0
            rates.append((rate, ahead))
        moved = 2.0 * impedance * np.array(rates)
        load, lead = back * (moved[:, 0] - load) + sent, back * (moved[:, 1] - lead)
        if n == 0:
            lead = back * sum(np.cos(m * turn + m) / (m + 1) for m in range(8))
        size = math.hypot(np.linalg.norm(lead[:-1]) / math.sqrt(steps) / abs(back) / OF_WAVE, ahead / OF_RATE)
        if n > 0:
            size_before, scale = found[-1] if found else 0.0, 1.0 / size
            found.append(size_before + math.log(size))
            lead, ahead = lead * scale, ahead * scale
    return found


CHAOTIC = string(body__driver_impedance=DRIVE, loading__pull_rate=TURNS, body__inertia=HEAVY)


def test_disturbances_of_a_chaotic_string_grow_as_an_own_integration_has_it() -> None:
    """From the third to the sixteenth round trip of the same motion, in which it slips six times; each step to 0.03."""
    pair = Pair.begin(CHAOTIC, 60.0, 1e-11, shifts=False)
    measure, stand = Measure.of(pair.run), pair.stand
    measure.waves[:], measure.numbers[0] = OF_WAVE, OF_RATE
    pair.differ_by(first_disturbance(stand, measure).times(1e-7))
    growth = []
    for _ in range(16):
        way, apart = pair.apart(pair.lead(), measure)
        growth.append(math.log(apart / 1e-7))
        pair.differ_by(way.times(1e-7))
    own = np.diff(own_sizes(17, 3200))
    assert np.abs(growth[1:] - own).max() < 0.03
    assert own.sum() > 2.0


@pytest.mark.slow
def test_the_exponent_of_a_chaotic_string_is_that_of_an_own_integration() -> None:
    """To 3 standard errors of both."""
    found = ss.studies.lyapunov(CHAOTIC, 300.0, skip=60.0)
    sizes = np.array(own_sizes(800, 400))[100:]
    parts = np.array([np.ptp(part[[0, -1]]) / (len(part) - 1) for part in np.array_split(sizes, 12)]) / CHAOTIC.round_trip_time
    own, error = float(parts.mean()), float(parts.std(ddof=1)) / math.sqrt(12.0)
    assert found.chaotic is True
    assert abs(found.exponent - own) < 3.0 * math.hypot(found.error, error)
    assert error < 0.3 * own


@pytest.mark.parametrize(
    ("problem", "said"),
    [
        (
            ss.Problem(
                ss.ElasticSlab(2800.0, 3500.0, 10.0, 1e6),
                ss.friction.LinearSlipWeakening(0.6, 0.5, "1 mm"),
                pull_rate=1e-2,
                initial_load=0.0,
            ),
            "lyapunov: under LinearSlipWeakening friction changes with all slip: the motion never comes to one that stays",
        ),
        (string(body__driver_impedance=100.0, loading__pull_rate=1.0), "lyapunov: the contact comes to rest for ever"),
        (string(loading__pull_rate=1e-3), "lyapunov: two runs could be compared"),
    ],
    ids=["slip weakening", "rest for ever", "long rests"],
)
def test_what_no_pair_of_runs_tells_is_refused_in_one_line(problem: ss.Problem, said: str) -> None:
    with pytest.raises(ss.InputError) as refused:
        ss.studies.lyapunov(problem, 1000.0)
    assert str(refused.value).startswith(said)


@pytest.mark.slow
def test_the_bundled_drill_string_becomes_chaotic_slowly() -> None:
    """Its rigid drive sends all back, and waves become ever rougher: disturbances grow e times in about 270 s."""
    found = ss.studies.lyapunov("drill-string", 5000.0)
    assert found.chaotic is True
    assert 0.002 < found.exponent < 0.006
