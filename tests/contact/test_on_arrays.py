"""The law and the contact equation on arrays: equal to what the engine compiles, and to closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.on_arrays import ContactOnArrays
from stickslip.foundation.errors import InputError
from stickslip.friction import LAWS
from stickslip.friction.contract import one_argument
from stickslip.friction.law import FrictionLaw
from tests.engine.drawn import SLAB, example_law, example_problem


@pytest.mark.parametrize("kind", [kind for kind in LAWS if example_law(kind).trees()])
def test_values_are_those_of_the_law_and_slopes_those_of_a_complex_step(kind: str) -> None:
    """Values rel 1e-13; slopes by slip and rate rel 1e-12, by state central differences rel 1e-6."""
    law, rng = example_law(kind), np.random.default_rng(len(kind))
    slip, rate = rng.uniform(0.0, 2.0, (4, 25)), 10.0 ** rng.uniform(-6.0, 1.0, (4, 25))
    states = rng.uniform(0.2, 0.6, (len(law.states), *slip.shape))
    state = one_argument(list(states))
    found = ContactOnArrays(law, 1e12, 1.0).friction(slip, rate, state)
    assert found.value == pytest.approx(law.coefficient(slip, rate, state), rel=1e-13)
    if law.state is None:
        slopes = np.array([law.slopes(u, v) for u, v in zip(slip.flat, rate.flat, strict=True)]).T.reshape(2, *slip.shape)
        assert found.by_slip == pytest.approx(slopes[0], rel=1e-12, abs=1e-14)
        assert found.by_rate == pytest.approx(slopes[1], rel=1e-12, abs=1e-14)
        assert (found.by_state == 0.0).all()
    for n, by_state in enumerate(found.by_state if len(states) > 1 else [found.by_state] * len(states)):
        step = 1e-6 * (np.arange(len(states)) == n)[:, None, None]
        ends = [law.coefficient(slip, rate, one_argument(list(states + way * step))) for way in (-1.0, 1.0)]
        assert by_state == pytest.approx((ends[1] - ends[0]) / 2e-6, rel=1e-5, abs=1e-8)


@pytest.mark.parametrize("kind", LAWS)
def test_slip_rates_are_those_of_the_compiled_engine(kind: str) -> None:
    """At the slip, state and load of a run on a massless contact: rel 1e-9 of the fastest, the tolerance of the run."""
    problem = example_problem(kind, "slab")
    law = problem.friction
    if ss.uniqueness(problem).regime != "regular":
        with pytest.raises(InputError, match="several slip rates may solve"):
            ContactOnArrays(law, SLAB.impedance, 1e8).rate(1.2 * problem.strength, np.zeros(3))
        return
    run = ss.simulate(problem, 2.2 * SLAB.two_way_time, rtol=1e-11)
    times = np.linspace(0.0, run.history.duration, 101)[1:]
    at = run.history.find(times, "right")
    forward = run.history.mode(at) >= 0
    assert forward.any()
    contact = ContactOnArrays(law, SLAB.impedance, 1e8)
    found = contact.rate(run.load(times), run.history.law_slip(at.recorded()), run.history.state(at.recorded()))
    rate = run.slip_rate(times)
    assert found[forward] == pytest.approx(rate[forward], rel=1e-9, abs=1e-9 * np.abs(rate).max())


def test_each_point_has_its_own_stress_and_load() -> None:
    """Coulomb friction in closed form, v = (load - S mu) / Z: rel 1e-14."""
    normal, load = np.array([1e6, 1e7, 1e8]), np.array([[2e6], [7e7]])
    contact = ContactOnArrays(ss.friction.LinearSlipWeakening(0.6, 0.6, 1.0), 4.9e6, normal)
    assert contact.rate(load, 0.0) == pytest.approx(np.maximum(load - 0.6 * normal, 0.0) / 4.9e6, rel=1e-14)


def test_state_rates_and_their_slopes() -> None:
    """Ageing law in closed form."""
    law: FrictionLaw = ss.friction.RateAndState(0.6, 0.01, 0.015, "1e-4 m", rate="1e-6 m/s")
    contact = ContactOnArrays(law, 4.9e6, 1e8)
    state, rate = np.array([-1.0, 0.0, 2.0]), np.array([1e-6, 1e-3, 1.0])
    found = contact.state_rate(0.0, rate, state)
    assert found.value == pytest.approx(1e-6 / 1e-4 * np.exp(-state) - rate / 1e-4, rel=1e-13)
    assert found.by_rate == pytest.approx(np.full(3, -1e4), rel=1e-13)
    with pytest.raises(InputError, match="has no state"):
        ContactOnArrays(ss.friction.Coulomb(0.6, 0.6), 1.0, 1.0).state_rate(0.0, 1.0, 0.0)


def test_a_law_with_a_narrow_fall_is_refused_before_it_is_used() -> None:
    """A ridge of 1e-5 m/s, which no grid of slip rates would meet."""
    law = ss.friction.FromExpression("0.6 + 0.1*exp(-((v - 0.7)/1e-5)**2)")
    with pytest.raises(InputError, match="several slip rates may solve"):
        ContactOnArrays(law, 4.9e6, 1e8).rate(7e7, 0.0)


@pytest.mark.parametrize("wrong", [0.0, -1.0, float("nan"), np.array([1.0, 0.0])])
def test_bad_numbers_are_refused(wrong: Any) -> None:
    with pytest.raises(InputError, match="impedance must be finite and above 0"):
        ContactOnArrays(ss.friction.Coulomb(0.6, 0.5), wrong, 1.0)
