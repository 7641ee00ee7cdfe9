"""Implicit steps: collocation against polynomials, stiff contacts against scipy and against the contact without mass, lag."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.engine.series import radau_nodes
from stickslip.engine.series.radau_nodes import DERIVATIVE, INTEGRAL, NODES_OF_STEP, POINT, STAGES
from stickslip.engine.state.layout import TERMS
from tests.core.engine.compiled import compiled
from tests.core.engine.states_truth import Truth, block_truth

SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
STRENGTHENING = ss.friction.VelocityStrengthening(0.6, 0.01, 1e-6)
FALLING = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)


def test_the_weights_integrate_to_the_order_of_radau() -> None:
    """Sum of weights times x^k is 1/(k+1) up to k = 2 s - 2, and no further; the start has no weight. Absolute 1e-14."""
    weights = INTEGRAL[-1]
    assert abs(weights[0]) < 1e-15
    for k in range(2 * STAGES - 1):
        assert weights @ POINT**k == pytest.approx(1.0 / (k + 1), rel=0.0, abs=1e-14)
    assert abs(weights @ POINT ** (2 * STAGES - 1) - 1.0 / (2 * STAGES)) > 1e-12


def test_derivatives_and_integrals_are_exact_for_polynomials() -> None:
    for k in range(NODES_OF_STEP):
        slope = k * POINT ** (k - 1) if k else np.zeros(NODES_OF_STEP)
        assert DERIVATIVE @ POINT**k == pytest.approx(slope, rel=0.0, abs=1e-11)
        assert INTEGRAL @ POINT**k == pytest.approx(POINT ** (k + 1) / (k + 1), rel=0.0, abs=1e-14)


def test_interpolation_keeps_the_digits() -> None:
    """exp(3 x) at the points: the polynomial returns its values to 4 ulp of the largest, and the last terms bound its error."""
    values, out, rest = np.exp(3.0 * POINT), np.empty(TERMS), np.empty(TERMS)
    interpolate, last_terms = compiled(radau_nodes.interpolate), compiled(radau_nodes.last_terms)
    interpolate(values, out, rest)
    assert np.polyval(out[::-1], POINT) == pytest.approx(values, rel=0.0, abs=4.0 * np.spacing(values[-1]))
    x = np.linspace(0.0, 1.0, 201)
    error = float(np.abs(np.polyval(out[::-1], x) - np.exp(3.0 * x)).max())
    assert 1e-9 < error < last_terms(out) < 1e3 * error


def first_trip(problem: ss.Problem, mass: float, times: Any) -> Any:
    """Slip and slip rate of a slab's contact with mass until the first echo, by scipy's Radau."""
    body: Any = problem.body

    def derivative(t: float, y: Any) -> list[float]:
        load = problem.load + body.stiffness * problem.pull_rate * t
        return [y[1], (load - body.impedance * y[1] - problem.normal * float(problem.friction.coefficient(y[0], y[1]))) / mass]

    done = solve_ivp(derivative, (0.0, times[-1]), [0.0, 0.0], method="Radau", rtol=1e-10, atol=1e-16, t_eval=times)
    assert done.success
    return done.y


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("mass", [1.0, 1e3, 3e5])
def test_a_stiff_contact_agrees_with_scipy(mass: float) -> None:
    """The contact settles 3e8 times a second and slower; slip to 1e-8 of its end, in at most 400 pieces."""
    problem = ss.Problem(replace(SLAB, contact_mass=mass), STRENGTHENING, pull_rate=1e-3, initial_excess=1e4)
    times = np.linspace(0.0, 5.0, 41)[1:]
    run = ss.simulate(problem, 5.0)
    slip, rate = first_trip(problem, mass, times)
    assert run.slip(times) == pytest.approx(slip, rel=0.0, abs=1e-8 * slip[-1])
    assert run.slip_rate(times) == pytest.approx(rate, rel=0.0, abs=1e-8 * rate[-1])
    assert len(run.history) < 400


# ---- lagged friction -----------------------------------------------------------------------------------------------------------


def test_a_lag_does_what_a_contact_mass_does() -> None:
    """Z time dw/dt = load - g(w): until the first echo w is the slip rate of a contact of mass Z time. Absolute 1e-8 of it."""
    time = 0.05
    lagged = ss.Problem(SLAB, ss.friction.LaggedFriction(FALLING, time), pull_rate=1e-3, initial_excess=1e3)
    heavy = ss.Problem(replace(SLAB, contact_mass=SLAB.impedance * time), FALLING, pull_rate=1e-3, initial_excess=1e3)
    times = np.linspace(0.0, 0.99 * SLAB.two_way_time, 100)
    by_mass = ss.simulate(heavy, times[-1]).slip_rate(times)
    by_lag = ss.simulate(lagged, times[-1])
    assert by_mass[-1] > 1.0
    assert by_lag.state(times) == pytest.approx(by_mass, rel=0.0, abs=1e-8 * by_mass[-1])
    rate = (by_lag.load(times) - 1e8 * FALLING.coefficient(0.0, by_mass)) / SLAB.impedance
    assert by_lag.slip_rate(times)[1:] == pytest.approx(rate[1:], rel=0.0, abs=1e-7 * by_mass[-1])


def test_lag_heals_at_rest() -> None:
    """At rest w falls as exp(-t / time) and the strength rises with it; when it is gone, rest is leapt over."""
    problem = ss.Problem(SLAB, ss.friction.LaggedFriction(FALLING, 1.0), pull_rate=0.05 / ss.YEAR, initial_excess=1.0)
    run = ss.simulate(problem, 1e6)
    stop = float(run.events.end[0])
    w = run.state(stop + np.array([0.0, 1.0, 5.0, 20.0]))
    assert w[1:] == pytest.approx(w[0] * np.exp([-1.0, -5.0, -20.0]), rel=1e-9)
    assert float(run.state(1e5)) == 0.0
    assert len(run.history) < 3000


def test_a_lag_that_is_healing_gives_way_earlier() -> None:
    """A dead load that rises again while the contact still heals: it slips where the load meets S mu(w), not S mu(0)."""
    slab = replace(SLAB, driver_impedance=SLAB.impedance)
    law = ss.friction.LaggedFriction(FALLING, 5.0)
    problem = ss.Problem(slab, law, initial_load=4e7, far_stress=4e7, far_stress_rate=5e6, initial_state=3.0)
    run = ss.simulate(problem, 12.0)
    begin = float(run.catalogue(0.0).start[0])
    assert begin > 1.0
    held = 1e8 * FALLING.coefficient(0.0, 3.0 * np.exp(-begin / 5.0))
    assert float(run.load(begin)) == pytest.approx(float(held), rel=1e-9)
    assert held < 0.99 * 8e7


def test_a_lag_with_a_direct_effect_agrees_with_scipy() -> None:
    law = ss.friction.LaggedFriction(ss.friction.ExponentialStribeck(0.6, 0.4, 0.1), 0.02, direct=0.01, direct_rate=1e-3)
    block = ss.SpringBlock(1e3, 1e6, 1e5)
    problem = ss.Problem(block, law, initial_excess=5e3)

    def friction(v: float, w: float) -> float:
        return 0.4 + 0.2 * math.exp(-w / 0.1) + 0.01 * (math.asinh(v / 2e-3) - math.asinh(w / 2e-3))

    times, run = np.linspace(0.0, 0.04, 30), ss.simulate(problem, 0.04)
    one = Truth(law, friction, lambda v, w: ((v - w) / 0.02,))
    slip, _, state = block_truth(one, block, lambda _: problem.load, (0.0, 0.0, 0.0), times)
    assert run.slip_rate(times).max() > 0.1
    assert run.slip(times) == pytest.approx(slip, rel=0.0, abs=1e-8 * slip.max())
    assert run.state(times) == pytest.approx(state, rel=0.0, abs=1e-7 * state.max())


def test_laws_that_cannot_lag_are_refused() -> None:
    for law in (ss.friction.Coulomb(0.6, 0.5), ss.friction.LinearSlipWeakening(0.6, 0.5, 0.1)):
        with pytest.raises(ss.InputError, match=r"^LaggedFriction: rate must be a [^\n]*$"):
            ss.friction.LaggedFriction(law, 0.1)


@pytest.mark.parametrize("rtol", [1e-5, 1e-8, 1e-12])
@pytest.mark.parametrize("direct", [0.0, 1e-9])
def test_no_step_walks_along_an_unstable_solution(direct: float, rtol: float) -> None:
    """Slip begins 1e8 times faster than the load changes, and the rounding of loads is all that a tight tolerance sees of the
    slow end: neither a backward solution nor a storm. The massless run is the limit: slip to 1e-6 (rtol), at least 1e-5."""
    loop = ss.load_scenario("fig4-loop")
    lagged = replace(loop.problem, friction=ss.friction.LaggedFriction(FALLING, 1e-8, direct=direct))
    run, exact = ss.simulate(lagged, loop.duration, rtol=rtol), ss.simulate(loop)
    assert run.status.ok
    assert float(run.slip(5.5)) == pytest.approx(float(exact.slip(5.5)), rel=max(1e-5, rtol))
    assert (run.slip_rate(np.linspace(0.0, loop.duration, 2001)) >= -1e-9).all()
    assert len(run.history) < 500


@pytest.mark.parametrize("name", ["velocity-steps-block", "slide-hold-slide-block"])
def test_the_lag_of_a_small_mass_behind_a_step_of_the_pull_rate_is_not_called_rounding(name: str) -> None:
    """Mass settles in 4e-8 s there, and no step of 0.1 s follows that: the steps that stall are not said to lose digits."""
    assert ss.simulate(name).rounding_note == ""
