"""Lyapunov exponents: of a slab beside its own interval map, of cycles beside their multipliers, and of chaos beside an own run."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.signal import lfilter

import stickslip as ss
from stickslip.extensions.cycles import exponent
from stickslip.extensions.cycles.exponent import drift_of, error_of_mean
from stickslip.extensions.cycles.growth_of_echoes import growth_on_pieces, ranges_of_rate
from tests.command_line import Command
from tests.extensions.cycles.problems import DISTANCE, NORMAL, REFERENCE, SLOW, coulomb, rate_and_state, stribeck

IMPEDANCE, STRESS, STATIC, DYNAMIC, ALPHA, BACK, FAR, TRIP = 9.8e6, 1e8, 0.8, 0.3, 0.3, -0.9, 2.46e8, 2e4 / 3500.0


def slab(load: float, **changes: Any) -> ss.Problem:
    """Return a slab whose far end gives way under a steady stress, so that its load is constant in each half of a round trip."""
    far_end = IMPEDANCE * (1.0 - BACK) / (1.0 + BACK)
    body = ss.ElasticSlab(2800.0, 3500.0, 1e4, STRESS, driver_impedance=far_end)
    law = ss.friction.HyperbolicRate(STATIC, DYNAMIC, ALPHA)
    return ss.Problem(body, law, **{"pull_rate": 0.0, "initial_load": load, "far_stress": FAR} | changes)


def own_map(load: float, trips: int) -> np.ndarray:
    """Return ln|factor| in both halves of each round trip, by the map of the load that an own iteration goes through."""
    root = math.sqrt(ALPHA * STRESS * (STATIC - DYNAMIC) / IMPEDANCE)
    fold = STRESS * DYNAMIC + IMPEDANCE / ALPHA * (2.0 * root - 1.0)
    falls, inflow = STRESS * (STATIC - DYNAMIC), (1.0 + BACK) * FAR
    loads, rates, slips, found = [load, 0.0], [0.0, 0.0], False, []
    for trip in range(trips):
        for half in (0, 1):
            if trip:
                loads[half] = BACK * (2.0 * IMPEDANCE * rates[half] - loads[half]) + inflow
            elif half:
                loads[1] = inflow - BACK * load
            slips = loads[half] >= fold if slips else loads[half] > STRESS * STATIC
            rates[half], slope = 0.0, math.inf
            if slips:
                linear = IMPEDANCE + ALPHA * (STRESS * DYNAMIC - loads[half])
                rest = STRESS * DYNAMIC - loads[half] + falls
                rates[half] = (math.sqrt(linear**2 - 4.0 * IMPEDANCE * ALPHA * rest) - linear) / (2.0 * IMPEDANCE * ALPHA)
                slope = IMPEDANCE - falls * ALPHA / (1.0 + ALPHA * rates[half]) ** 2
            found.append(math.log(abs(BACK * (1.0 - 2.0 * IMPEDANCE / slope))))
    return np.array(found)


def test_the_exponent_of_a_slab_is_that_of_its_interval_map_on_the_same_orbit() -> None:
    """Forty round trips, of which the first eight do not count; then many on another orbit. To 1e-6, and to 4 standard errors."""
    short = ss.studies.lyapunov(slab(7e7), 40.0 * TRIP, skip=8.0 * TRIP)
    assert short.exponent == pytest.approx(own_map(7e7, 40)[16:].mean() / TRIP, rel=1e-6)
    long = ss.studies.lyapunov(slab(7e7), 2000.0 * TRIP)
    assert long.chaotic is True
    assert long.error < 0.1 * long.exponent
    assert abs(long.exponent - own_map(7.1e7, 20_000)[400:].mean() / TRIP) < 4.0 * long.error
    assert long.horizon == pytest.approx(math.log(0.1 / 1e-11) / long.exponent, rel=1e-9)
    assert long.table["growth"].iloc[-1] == pytest.approx(long.exponent * 1600.0 * TRIP, rel=1e-9)


def test_where_the_slip_rate_changes_the_mean_over_phases_is_an_integral() -> None:
    """Pieces of a pulled slab, the ends of which lie on folds and echoes, beside scipy's quadrature. To 1e-6."""
    run = ss.simulate(slab(7e7, pull_rate=2.0), 6.0 * TRIP)
    history, found = run.history, growth_on_pieces(run.history)

    def integrand(time: float) -> float:
        rate = float(run.slip_rate(time))
        slope = IMPEDANCE - STRESS * (STATIC - DYNAMIC) * ALPHA / (1.0 + ALPHA * rate) ** 2
        return math.log(abs(1.0 - 2.0 * IMPEDANCE / slope)) / TRIP

    slips = np.flatnonzero((history.store.mode != 0) & (np.ptp(history.store.rate, axis=1) > 1e-3))
    assert len(slips) >= 3
    for piece in slips[:6].tolist():
        begin = float(history.start[piece])
        end = begin + float(history.store.speed[piece] + history.store.bend[piece])
        assert found[piece] == pytest.approx(quad(integrand, begin, end, epsrel=1e-9)[0], rel=1e-6)
    assert not found[history.store.mode == 0].any()


def test_the_exponent_of_a_cycle_is_its_multiplier_over_its_period() -> None:
    """To 1e-6; the sum of all exponents is that of all multipliers, to 1e-6."""
    cycle = ss.studies.cycle(rate_and_state())
    found = ss.studies.lyapunov(cycle.problem, 16.0 * cycle.period, skip=0.0, rtol=1e-12)
    assert found.exponent == pytest.approx(math.log(abs(cycle.multipliers[0])) / cycle.period, rel=1e-6)
    assert found.error < 1e-6 * abs(found.exponent)
    assert found.chaotic is False
    assert math.isinf(found.horizon)
    assert found.per_event == pytest.approx(math.log(abs(cycle.multipliers[0])), rel=1e-6)
    assert found.sum_of_all == pytest.approx(np.log(np.abs(cycle.multipliers)).sum() / cycle.period, rel=1e-6)


def test_a_motion_that_still_grows_towards_its_cycle_is_not_called_chaotic() -> None:
    """Next to unstable steady sliding a disturbance grows as the motion does, until this comes to a cycle of which it fades."""
    cycle = ss.studies.cycle(rate_and_state())
    started = replace(cycle.problem, initial_rate=1.05 * SLOW, initial_load=REFERENCE * NORMAL, initial_state=DISTANCE / SLOW)
    fades = math.log(abs(cycle.multipliers[0])) / cycle.period
    early = ss.studies.lyapunov(started, 3000.0, rtol=1e-7)
    assert early.chaotic is None
    assert "the motion still drifts, the range of its slip rate grows by a factor 2." in early.text
    assert "give a longer run" in early.text
    assert abs(early.exponent - fades) < 4.0 * early.error
    late = ss.studies.lyapunov(started, 12_000.0, skip=8000.0, rtol=1e-7)
    assert late.chaotic is False
    assert late.exponent == pytest.approx(fades, rel=0.01)


@pytest.mark.parametrize(
    ("problem", "cure"),
    [
        (slab(7e7, pull_rate=2.0), "a shorter duration, or several such runs from other initial loads, and their mean"),
        (rate_and_state(), "to leave out less at the start (a shorter skip), or a shorter duration"),
    ],
)
def test_a_full_history_is_refused_with_what_helps_here(problem: ss.Problem, cure: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exponent, "MAX_PIECES", 100)
    with pytest.raises(ss.InputError) as refused:
        ss.studies.lyapunov(problem, "1 hour")
    assert "its history reached the limit of 100 pieces at" in str(refused.value)
    assert str(refused.value).endswith(f"what helps: {cure}")


def test_where_nothing_slips_disturbances_stay_as_they_are_but_for_the_driver() -> None:
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
    held, giving = (
        ss.studies.lyapunov(ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, **far), law, initial_load=1e6), 40.0 * TRIP)
        for far in ({}, {"driver_impedance": 1e8})
    )
    assert held.chaotic is None
    assert held.text.startswith("disturbances stay as they are: the largest Lyapunov exponent is 0 1/s")
    assert "longer run" not in held.text
    assert giving.exponent == pytest.approx(math.log((1e8 - IMPEDANCE) / (1e8 + IMPEDANCE)) / TRIP, rel=1e-12)
    for one in (held, giving):
        assert one.text.endswith("nothing slips from 45.7143 s on, and a contact at rest sends disturbances back as they are")


def test_the_size_of_the_motion_of_a_slab_is_the_range_of_its_slip_rate_in_each_sixteenth_of_the_run() -> None:
    """Loads, and so slip rates, are constant in each half of a round trip; a sixteenth has two: to rounding."""
    run = ss.simulate(slab(7e7), 32.0 * TRIP)
    times = TRIP * (np.arange(64).reshape(16, 4) + 0.5) / 2.0
    wanted = np.ptp(run.slip_rate(times.ravel()).reshape(16, 4), axis=1)
    assert ranges_of_rate(run.history, 0.0, 32.0 * TRIP) == pytest.approx(wanted[wanted > 0.0], rel=1e-9)
    assert len(np.unique(wanted)) > 8


def test_a_drift_is_told_from_chance() -> None:
    """Sizes that grow e times in all, with noise of a tenth and none; and noise without a drift, taken for one once in 100."""
    draws = np.random.default_rng(5)
    for count in (8, 400):
        rise = np.linspace(-0.5, 0.5, count)
        assert drift_of(np.exp(rise)) == pytest.approx(1.0, abs=0.1)
        assert drift_of(np.exp(-rise + 0.1 * draws.standard_normal(count))) == pytest.approx(-1.0, abs=0.3)
        noise = np.exp(0.5 * draws.standard_normal((200, count)))
        assert sum(drift_of(one) != 0.0 for one in noise) <= 2
        assert drift_of(np.exp(0.05 * rise)) == 0.0


def test_a_contact_that_rests_ends_all_disturbances_and_steady_sliding_has_its_own_growth() -> None:
    rests = ss.studies.lyapunov(coulomb(), 3.0)
    assert rests.exponent == rests.sum_of_all == -math.inf
    assert rests.chaotic is False
    assert "each rest ends all disturbances" in rests.text
    steady = stribeck(0.4, initial_rate=0.4, initial_load=3.85)
    found = ss.studies.lyapunov(steady, 60.0)
    assert found.exponent == pytest.approx(ss.studies.steady(steady).slidings[-1].growth, rel=1e-12)
    assert "steady sliding" in found.text


def test_the_error_of_a_mean_is_that_of_increments_that_depend_on_each_other() -> None:
    """Increments x' = p x + noise: the variance of the mean of n is (noise / (1 - p))^2 / n. The mean of 60 draws, to 15 %."""
    draws, count = np.random.default_rng(3), 4096
    for dependence in (-0.6, 0.0, 0.9):
        values = lfilter([1.0], [1.0, -dependence], draws.standard_normal((60, count)), axis=1)
        squares = [error_of_mean(one, np.ones(count), float(one.mean())) ** 2 for one in values]
        assert np.mean(squares) == pytest.approx(1.0 / (1.0 - dependence) ** 2 / count, rel=0.15)


def test_the_exponent_of_a_chain_is_that_of_its_disturbed_runs() -> None:
    chain = ss.Chain(
        ss.friction.Coulomb(0.6, 0.5), 12, 1.0, 10.0, 1.0, 1.0, "1 mm/s", initial_slip=ss.Drawn("uniform", -0.5, 0.0, seed=1)
    )
    found, parted = ss.studies.lyapunov(chain, 1500.0), ss.simulate(chain, 1500.0).predictability()
    assert (found.exponent, found.error) == (parted.exponent, parted.exponent_error)
    assert found.per_event == pytest.approx(math.log(parted.growth_per_event))
    with pytest.raises(ss.InputError, match="lyapunov: skip is for runs"):
        ss.studies.lyapunov(chain, 1500.0, skip=1.0)


A, B, LENGTHS, PULL, MASS, WEIGHT = 0.01, (0.01, 0.0084), (1e-5, 1e-5 / 0.048), 1e-6, 1e3, 10.0
"""Two states under the slip law, with the ratios of Becker 2000, Phys. Rev. E 61, 1: chaos below 0.86 of the critical 803 N/m."""


def own_exponent(stiffness: float, lasts: float, every: float) -> tuple[float, float]:
    """Return the exponent and its error, by LSODA on load, ln(v / V), two states and one disturbance, across the flow."""

    def paces(_: float, y: Any) -> list[float]:
        load, log, first, second = y[:4].tolist()
        rate = PULL * math.exp(min(log, 50.0))
        argument = 0.5 * math.exp(min(600.0, log + (0.6 + B[0] * first + B[1] * second) / A))
        root = argument / math.hypot(1.0, argument)
        inertia, (a, b, c, d) = MASS * rate, y[4:].tolist()
        grows = (load - WEIGHT * A * math.asinh(argument)) / inertia
        (one, other), (by_one, by_other) = (rate / length for length in LENGTHS), (first + log, second + log)
        pull = a / inertia - (grows + WEIGHT * A * root / inertia) * b - WEIGHT * root * (B[0] * c + B[1] * d) / inertia
        moved = [-stiffness * rate * b, pull, -one * ((by_one + 1.0) * b + c), -other * ((by_other + 1.0) * b + d)]
        return [stiffness * (PULL - rate), grows, -one * by_one, -other * by_other, *moved]

    y, scale, growth = np.array([0.601 * WEIGHT, 0.0, 0.0, 0.0, 0.003, 0.5, 0.7, 0.2]), np.array([100.0, 1.0, 1.0, 1.0]), []
    for _ in range(int(lasts / every)):
        y = solve_ivp(paces, (0.0, every), y, method="LSODA", rtol=1e-8, atol=1e-10).y[:, -1]
        flow = scale * paces(0.0, y)[:4]
        across = scale * y[4:]
        across -= flow * (flow @ across) / (flow @ flow)
        growth.append(math.log(np.linalg.norm(across)))
        y[4:] = across / np.linalg.norm(across) / scale
    parts = [part.mean() / every for part in np.array_split(growth[len(growth) // 5 :], 10)]
    return float(np.mean(parts)), float(np.std(parts)) / 3.0


def test_a_block_under_two_state_friction_is_chaotic_as_an_own_integration_has_it() -> None:
    """To 3 standard errors of both."""
    law = ss.friction.TwoStateRateAndState(0.6, A, B[0], LENGTHS[0], B[1], LENGTHS[1], evolution="slip")
    start = {"initial_load": 0.601 * WEIGHT, "initial_rate": PULL, "initial_state": LENGTHS[0] / PULL}
    block = ss.SpringBlock(mass=MASS, stiffness=675.0, normal_force=WEIGHT)
    problem = ss.Problem(block, law, pull_rate=PULL, initial_second_state=LENGTHS[1] / PULL, **start)
    found = ss.studies.lyapunov(problem, 30_000.0)
    own, error = own_exponent(675.0, 30_000.0, 400.0)
    assert found.exponent > 0.0
    assert not found.found.drift
    assert abs(found.exponent - own) < 3.0 * math.hypot(found.error, error)
    assert found.error < 0.4 * found.exponent
    assert found.sum_of_all < -10.0


def test_the_command_says_how_fast_disturbances_grow(tmp_path: Path, command: Command) -> None:
    table, figure = tmp_path / "a.csv", tmp_path / "a.png"
    given = "fig6-slab", "--set", "loading.pull_rate=0.1", "--duration", "1000 s"
    done = command("lyapunov", *given, "--out", str(table), "--figure", str(figure))
    assert done.code == 0
    assert "the largest Lyapunov exponent is" in done.out
    assert table.read_text(encoding="utf-8").splitlines()[-1].startswith("1000.0,")
    assert figure.stat().st_size > 0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (("drill-string", "--duration", "20 s"), "lyapunov: duration must be longer than skip by 19 round trips of 1.26991 s"),
        (("fig6-slab",), "lyapunov: duration must be longer than skip by two round trips of 5.71429 s"),
        (("fig6-slab", "--duration", "100 s", "--skip", "100 s"), "lyapunov: skip must be less than the duration 100 s, got 100 s"),
        (("block", "--duration", "5 s"), "lyapunov: in the first 2.5 s the contact passes the pull rate fewer than two times"),
        (("block", "--duration", "5 m"), "lyapunov: duration"),
    ],
)
def test_what_cannot_be_followed_is_refused_in_one_line(given: tuple[str, ...], said: str, command: Command) -> None:
    assert command("lyapunov", *given).refusal.startswith(said)
