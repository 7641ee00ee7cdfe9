"""Leaps over slow sliding of a slab under rate and state, against runs without leaps and against the equations of a spring."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.engine.creep import slow
from stickslip.problem.limits import leaps_over
from tests.core.run.long_runs.problems import differences, stopped_and_continued

SLAB = ss.ElasticSlab(2700.0, 3000.0, 1e4, 50e6)
TURN = SLAB.two_way_time
PER_LOAD = TURN / (2.0 * SLAB.impedance)
"""The slip that takes away a load of 1 Pa, m."""
AGEING = ss.friction.RateAndState(0.6, 0.01, 0.015, 0.02)
YEAR = ss.YEAR


def slid(law: ss.FrictionLaw, speed: float, load: float, *states: float, body: ss.ElasticSlab = SLAB) -> ss.Problem:
    given = dict(zip(("initial_state", "initial_second_state"), states, strict=False))
    return ss.Problem(body, law, pull_rate=speed, initial_load=load, **given)


TWO_STATES = ss.friction.TwoStateRateAndState(reference=0.6, a=0.01, b=0.012, distance=0.02, second_b=0.004, second_distance=0.1)
CASES: dict[str, tuple[ss.Problem, float]] = {
    "to an event and after it": (slid(AGEING, 1e-5, 29e6, 1e4), 1.28e4),
    "backward": (slid(AGEING, -1e-5, -29e6, 1e4), 8e3),
    "slip law": (slid(ss.friction.RateAndState(0.6, 0.01, 0.014, 0.03, evolution="slip"), 3e-6, 29e6, 1e5), 1.5e4),
    "PRZ law": (slid(ss.friction.RateAndState(0.6, 0.02, 0.01, 0.05, evolution="prz"), 1e-5, 28e6, 1e5), 2e4),
    "contact mass": (slid(AGEING, 1e-5, 29e6, 1e4, body=replace(SLAB, contact_mass=1e3)), 1.1e4),
    "two states": (slid(TWO_STATES, 5e-6, 29e6, 1e4, 1e5), 2e4),
}


@lru_cache
def runs(case: str) -> tuple[ss.Solution, ss.Solution]:
    """Return the run with leaps and the one without."""
    problem, trips = CASES[case]
    end = trips * TURN
    return ss.simulate(problem, end), ss.simulate(problem, end, creep_rtol=0.0)


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("case", CASES)
def test_where_a_leap_lands_the_run_without_leaps_is_within_its_error(case: str) -> None:
    """The first leap, in slip, slip rate and state; errors of later ones grow with the errors of the first.

    The slip agrees within the error that the leap states and 1e-12 of the slip, slip rate and state to 1e-4.
    """
    run, every = runs(case)
    assert len(run.creep) > 0
    assert len(run.history) < 0.6 * len(every.history)
    first = run.creep.iloc[0]
    assert first.round_trips > 0.1 * CASES[case][1]
    there = first.end + np.array([0.0, 0.3, 1.0, 2.0]) * TURN * (1.0 + 1e-9)
    slip = every.slip(there)
    np.testing.assert_allclose(run.slip(there), slip, rtol=1e-12, atol=first.error)
    assert first.error <= 1.1e-6 * np.abs(slip).max()
    np.testing.assert_allclose(run.slip_rate(there), every.slip_rate(there), rtol=1e-4, atol=0.0)
    np.testing.assert_allclose(run.state(there), every.state(there), rtol=1e-4, atol=0.0)


def test_a_pattern_of_waves_is_leaped_over_and_still_there_after_it() -> None:
    """After an event waves bounce in the slab: their tractions differ by megapascals between the offsets of a round trip.

    The last leap lands with the same pattern as the run without leaps: tractions agree to 1e-4 of their range. Slip agrees to
    1e-6, which is what the first leap did to the time of the event.
    """
    run, every = runs("to an event and after it")
    end = run.duration
    assert run.creep.round_trips.iloc[-1] > 1e3
    last = end - TURN * np.linspace(0.01, 0.99, 99)
    found, traction = run.traction(last), every.traction(last)
    spread = float(np.ptp(traction))
    assert spread > 1e6
    shift = abs(float(run.slip(end) - every.slip(end)))
    assert shift <= 1e-6 * float(every.slip(end))
    assert np.median(np.abs(found - traction)) <= 1e-3 * spread + shift / PER_LOAD
    assert len(run.history) < 0.2 * len(every.history)


def reader(history: Any, trip: int) -> Any:
    """Return a function that reads polynomials of the history (pieces, terms) at phases (s) of a round trip."""
    rows = np.flatnonzero(history.store.trip == trip)
    begins, widths = history.store.phase_from[rows], history.store.speed[rows]

    def read(phase: Any, polynomials: Any) -> Any:
        k = np.searchsorted(begins, phase, side="right") - 1
        return np.polynomial.polynomial.polyval((phase - begins[k]) / widths[k], polynomials[rows[k]].T, tensor=False)

    return read


def test_the_ripple_of_the_states_is_what_the_averaged_motion_lacks_without_it() -> None:
    """Sixteen round trips among waves of megapascals, 400 round trips after an event, when the state grows by 1/400 in each.

    Against the run without leaps the state is right to 1e-8 with the ripple, and a hundred times worse without it. Within
    the last round trip states are right to 1e-2 of what the ripple adds to them, and slip rates to 1e-3.
    """
    problem, _ = CASES["to an event and after it"]
    _, every = runs("to an event and after it")
    history = every.history
    trips = history.store.trip
    last, passed = int(trips[np.argmax(history.store.rate[:, 0])]) + 400, 16
    at = reader(history, last)

    def log_rate(phase: Any) -> Any:
        return np.log(at(phase, history.store.rate))

    offsets = slow.Offsets.of(np.append(history.store.phase_from[trips == last], TURN), log_rate, TURN, 1e-7)
    motion = slow.SlowMotion(problem, offsets)
    states = history.store.state[[np.flatnonzero(trips == n)[0] for n in (last + 1, last + 1 + passed)], 0, 0]
    found = motion.later(motion.start(np.exp(log_rate(offsets.phase.ravel())), states[:1]), passed)
    off = np.abs(found[:, motion.size] + motion.at(found).state_begins[:, 0] - states[1])
    assert off[slow.BOTH] <= 1e-8
    assert off[slow.PLAIN] >= 100.0 * off[slow.BOTH]
    trip = slow.RoundTrip(motion, motion.later(found, -1), found)
    rate, states_there = trip.with_ripple()
    at, phase = reader(history, last + passed), offsets.phase.ravel()
    ripple, quicker = trip.at_begin.ripple[0, slow.BOTH], trip.at_begin.quicker[slow.BOTH]
    assert np.abs(states_there[0] - at(phase, history.store.state[:, 0])).max() <= 1e-2 * np.abs(ripple).max()
    assert np.abs(np.log(rate / at(phase, history.store.rate))).max() <= 1e-3 * np.abs(quicker).max()


def test_the_push_of_a_contact_mass_has_its_closed_form() -> None:
    """Where the slip rate grows as exp(k phi) within the round trip, the mass takes m k v of the direct effect a S."""
    problem = slid(AGEING, 1e-5, 29e6, 1e4, body=replace(SLAB, contact_mass=1e3))
    edges, k = np.linspace(0.0, TURN, 5), 0.7
    motion = slow.SlowMotion(problem, slow.Offsets(edges, TURN))
    log_rate = np.log(1e-9) + k * motion.offsets.phase.ravel()
    y = np.tile(np.concatenate([log_rate, [2.0, 0.0]]), (3, 1))
    assert motion.push(y) == pytest.approx(1e3 * k * np.exp(log_rate.max()) / (AGEING.a * 50e6), rel=1e-6, abs=0.0)


def test_years_agree_with_the_equations_of_a_spring_without_mass() -> None:
    """Before the first event the slab is a spring of stiffness 2 Z/T, to (T over the time of change) squared.

    The equations are integrated here by scipy in log rate and log state, with local errors of 1e-12; slip and state agree to 1e-5.
    """
    speed, load, state = 1e-9, 28e6, 1e8
    end = 70.0 * YEAR

    def change(_: float, y: Any) -> list[float]:
        rate, theta = np.exp(y[0]), np.exp(y[1])
        ages = 1.0 / theta - rate / AGEING.distance
        grows = ((speed - rate) / PER_LOAD / 50e6 - AGEING.b * ages) / AGEING.a
        return [grows, ages, rate]

    reference = np.log(1e-6 * state / AGEING.distance)
    start = np.log(1e-6) + (load / 50e6 - AGEING.reference - AGEING.b * reference) / AGEING.a
    spring = solve_ivp(change, (0.0, end), [start, np.log(state), 0.0], method="LSODA", rtol=1e-12, atol=1e-13)
    run = ss.simulate(slid(AGEING, speed, load, state), end)
    assert len(run.creep) == 1
    assert len(run.history) < 1000
    at = end * (1.0 - 1e-12)
    assert float(run.slip(at)) == pytest.approx(spring.y[2, -1], rel=1e-5, abs=0.0)
    assert float(run.state(at)) == pytest.approx(np.exp(spring.y[1, -1]), rel=1e-5, abs=0.0)


def test_slip_is_the_integral_of_the_slip_rate_through_a_leap() -> None:
    """Over a leap of 2e7 round trips, from before it to after it, by Gauss's rule on each piece of the history: to 1e-10."""
    run = ss.simulate(slid(AGEING, 1e-9, 28e6, 1e8), 2e7 * TURN)
    store = run.history.store
    powers = np.arange(1, store.rate.shape[1] + 1)
    grown = np.cumsum(store.speed * (store.rate / powers).sum(axis=1))
    np.testing.assert_allclose(store.slip[1:], grown[:-1], rtol=1e-10, atol=0.0)


@pytest.mark.slow
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("share", [0.01, 0.3, 0.9])
def test_a_resumed_run_leaps_as_if_it_had_not_stopped(share: float, tmp_path: Path) -> None:
    """Bit for bit, stopped before a leap, within it, at the event after it and behind that."""
    problem, trips = CASES["to an event and after it"]
    end = trips * TURN
    whole, _ = runs("to an event and after it")
    assert differences(stopped_and_continued(ss.simulate(problem, share * end), end, tmp_path), whole) == []


@pytest.mark.slow
def test_a_note_says_slow_where_the_sliding_is_slow_and_steady_only_where_it_has_become_so() -> None:
    slow_note = ss.simulate(slid(AGEING, 1e-9, 28e6, 1e8), 50.0 * YEAR).creep_note
    assert "round trips of slow sliding" in slow_note
    assert "steadily" not in slow_note
    stable = ss.friction.RateAndState(0.6, 0.015, 0.01, 0.02)
    assert "slides steadily and stably at the driver's rate" in ss.simulate(slid(stable, 1e-9, 29e6, 1e8), 5e3 * YEAR).creep_note


def test_the_error_that_a_leap_states_grows_with_what_it_neglects(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a hundred times the inertia that the leap leaves out, it does not reach as far."""
    problem, far = CASES["to an event and after it"][0], runs("to an event and after it")[0].creep.round_trips.iloc[0]
    monkeypatch.setattr(slow, "INERTIA", 100.0 * slow.INERTIA)
    assert ss.simulate(problem, 1.15e4 * TURN).creep.round_trips.iloc[0] < far


@pytest.mark.parametrize(
    "other",
    [
        {"body": replace(SLAB, driver_impedance=1e7)},
        {"friction": ss.friction.LuGre(0.6, 0.3, 1e-3, 1e5), "initial_state": 0.0},
        {"pull_rate": ss.loading.Steps([0.0, 1e9], [1e-9, 2e-9])},
    ],
)
def test_other_problems_leap_over_steady_sliding_at_most(other: dict[str, Any]) -> None:
    assert leaps_over(replace(slid(AGEING, 1e-9, 28e6, 1e8), **other)) != "slow sliding"
