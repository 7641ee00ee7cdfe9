"""Implicit steps are verified between their points: features of the law that are narrow, hidden or lost in rounding, and failures.

Truth is scipy: LSODA with steps bounded by what the narrowest feature of the law allows, and DOP853 up to the arrest.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import odeint, solve_ivp

import stickslip as ss
from stickslip.engine.series.radau_nodes import (
    DERIVATIVE_IN_MIDDLE,
    INTEGRAL_TO_MIDDLE,
    MIDDLE,
    NODES_OF_STEP,
    POINT,
    VALUE_IN_MIDDLE,
)

NORMAL = 1e8
SLAB = ss.ElasticSlab(2800, 3500, 1e4, NORMAL)
Z = float(SLAB.impedance)
FALLING = ss.friction.HyperbolicRate(0.8, 0.3, 0.05)


def test_values_between_the_points_are_exact_for_polynomials() -> None:
    """Absolute 1e-13 for values and integrals, 1e-11 for slopes."""
    for k in range(NODES_OF_STEP):
        slope = k * MIDDLE ** (k - 1) if k else np.zeros(len(MIDDLE))
        assert VALUE_IN_MIDDLE @ POINT**k == pytest.approx(MIDDLE**k, rel=0.0, abs=1e-13)
        assert DERIVATIVE_IN_MIDDLE @ POINT**k == pytest.approx(slope, rel=0.0, abs=1e-11)
        assert INTEGRAL_TO_MIDDLE @ POINT**k == pytest.approx(MIDDLE ** (k + 1) / (k + 1), rel=0.0, abs=1e-13)


# ---- against scipy, up to the arrest ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Slide:
    """A slab in its first round trip: an expression of u or v, with contact mass or lag, slides and stops under a falling load."""

    expression: str
    variable: str
    width: float
    mass: float
    lag: float = 0.0

    @property
    def problem(self) -> ss.Problem:
        law: Any = ss.friction.FromExpression(self.expression)
        if self.lag > 0.0:
            law = ss.friction.LaggedFriction(law, self.lag)
        return ss.Problem(replace(SLAB, contact_mass=self.mass), law, pull_rate=-2.0, initial_excess=1e7)

    def equations(self) -> tuple[int, Callable[[float, Any], list[float]], Callable[[float, Any], float]]:
        """Unknowns, right-hand side, and what falls through zero at the arrest."""
        code = compile(self.expression, "law", "eval")
        names = {"exp": lambda x: math.exp(min(x, 700.0)), "tanh": math.tanh, "sin": math.sin}
        mass, lag, initial, slope = self.mass, self.lag, self.problem.load, SLAB.stiffness * self.problem.pull_rate

        def friction(u: float, v: float) -> float:
            return NORMAL * float(eval(code, names, {"u": u, "v": max(v, 0.0)}))

        def load(t: float) -> float:
            return initial + slope * t

        def with_mass(t: float, y: Any) -> list[float]:
            return [y[1], (load(t) - Z * y[1] - friction(y[0], y[1])) / mass]

        def with_both(t: float, y: Any) -> list[float]:
            return [y[1], (load(t) - Z * y[1] - friction(y[0], y[2])) / mass, (y[1] - y[2]) / lag]

        def with_lag(t: float, y: Any) -> list[float]:
            rate = (load(t) - friction(y[0], y[1])) / Z
            return [rate, (rate - y[1]) / lag]

        if mass == 0.0:
            return 2, with_lag, lambda t, y: load(t) - friction(y[0], y[1])
        return (3, with_both, lambda t, y: y[1]) if lag > 0.0 else (2, with_mass, lambda t, y: y[1])

    def truth(self) -> tuple[float, float]:
        """Slip and time at the arrest."""
        unknowns, derivative, falls = self.equations()
        settles = 20.0 * max(self.lag, self.mass / Z)
        limits = (self.width / 4.0, self.width / 4.0) if self.variable == "u" else (settles / 40.0 * self.width, self.width)
        times = np.append(np.linspace(0.0, settles, 200), np.linspace(settles, 4.0, 2001)[1:])
        y = np.zeros((1, unknowns))
        for last in range(len(times) - 1):
            limit = limits[0] if times[last] < settles else limits[1]
            ahead = times[last : last + 2]
            y = odeint(derivative, y[-1], ahead, rtol=1e-12, atol=1e-15, hmax=limit, mxstep=10**7, tfirst=True)
            if falls(float(ahead[1]), y[-1]) <= 0.0:
                break
        falls.terminal, falls.direction = True, -1.0  # type: ignore[attr-defined] # scipy reads them from the function
        done = solve_ivp(derivative, (ahead[0], ahead[1] + 1e-3), y[0], method="DOP853", rtol=1e-12, atol=1e-15, events=falls)
        return float(done.y[0, -1]), float(done.t[-1])


def check(slide: Slide, **options: float) -> None:
    """Slip at the arrest and its time, to 1e-7 relative."""
    slip, end = slide.truth()
    run = ss.simulate(slide.problem, 1.01 * end, **options)
    assert run.status.ok
    assert float(run.catalogue(0.0).end[0]) == pytest.approx(end, rel=1e-7, abs=0.0)
    assert float(run.slip(end)) == pytest.approx(slip, rel=1e-7, abs=0.0)


def drawn(seed: int) -> Slide:
    """A random feature of a width of 1e-4 to 1 m or m/s, in slip or slip rate."""
    draw = np.random.default_rng(seed)
    lagged = seed % 3 == 0
    variable = "v" if lagged or seed % 3 == 1 else "u"
    width, centre = float(10.0 ** draw.uniform(-4.0, 0.0)), float(draw.uniform(0.1, 0.7))
    height = float(draw.uniform(0.005, 0.03) * draw.choice([-1.0, 1.0]))
    shape = ("exp(-{z}**2)", "tanh({z})", "sin({z})", "1/(1 + {z}**2)")[seed // 3 % 4]
    width = max(width, 1e-3 if variable == "v" else 3e-4)  # what is narrower is a matter of the patience of scipy
    if "sin" in shape:
        width = max(width, 1e-2)
    base = "0.6 + 0.02*u" if variable == "u" else "0.5 + 0.1/(1 + 2*v)"
    expression = f"{base} + {height!r}*" + shape.format(z=f"(({variable} - {centre!r})/{width!r})")
    mass = float(10.0 ** draw.uniform(3.0, 4.5))
    lag = float(10.0 ** draw.uniform(-3.5, -2.0)) if lagged else 0.0
    return Slide(expression, variable, width, 0.0 if lagged and draw.random() < 0.5 else mass, lag)


@pytest.mark.sampled(every=24)
@pytest.mark.parametrize("seed", range(24))
def test_implicit_steps_meet_random_features_of_the_law(seed: int) -> None:
    check(drawn(seed))


@pytest.mark.parametrize("mass", [1e3, 1e5])
def test_a_bump_between_the_points_of_a_long_step_is_met(mass: float) -> None:
    """A millimetre wide: steps without a proof pass over it, and the slip, to 1e-7 relative, is that without the bump."""
    law = ss.friction.FromExpression("0.6 + 0.05*exp(-((u - 1)/0.001)**2)")
    problem = ss.Problem(replace(SLAB, contact_mass=mass), law, initial_excess=1e7)

    def derivative(_: float, y: Any) -> list[float]:
        friction = NORMAL * (0.6 + 0.05 * math.exp(-((1e3 * (y[0] - 1.0)) ** 2)))
        return [y[1], (problem.load - Z * y[1] - friction) / mass]

    slip = odeint(derivative, [0.0, 0.0], [0.0, 4.0], rtol=1e-12, atol=1e-15, hmax=2e-4, mxstep=10**6, tfirst=True)[-1, 0]
    assert float(ss.simulate(problem, 4.0).slip(4.0)) == pytest.approx(slip, rel=1e-7, abs=0.0)


# ---- wrong or failing once -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("thickness", [1e4, 3e3])
def test_a_lagged_contact_leaves_rest(thickness: float) -> None:
    """The slip rate that rises from rest as the square of time is no failure; no number of the history is missing."""
    slab = replace(SLAB, thickness=thickness, contact_mass=1e6)
    problem = ss.Problem(slab, ss.friction.LaggedFriction(FALLING, 1e-2), pull_rate=0.5, initial_excess=1e7)
    run = ss.simulate(problem, 60.0)
    assert run.status.ok
    store = run.history.store
    assert all(np.isfinite(table).all() for table in (store.load, store.rate, store.state, store.slip, store.law_slip))


@pytest.mark.slow
def test_rate_and_state_slides_through_a_load_of_zero() -> None:
    """The load passes through 0, where the slip rate is far below 1e-30 m/s, and grows again: theta by DOP853, v by bisection.

    Until the first echo; slip to 1e-7 of the slip since the start, theta to 1e-9 relative.
    """
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-2)
    problem = ss.Problem(SLAB, law, pull_rate=8.0, initial_load=-7.6e7, initial_state=1e6)
    run = ss.simulate(problem, 5.7, rtol=1e-10)
    assert run.status.ok
    slope = SLAB.stiffness * 8.0

    def rate(load: float, w: float) -> float:
        """Solve Z v + S mu(v) = load by bisection, in s = arcsinh(v / scale)."""
        scale = 2.0 * law.rate * math.exp(-(law.reference + law.b * w) / law.a)
        size = abs(load)
        low, s, high = 0.0, 0.0, size / (NORMAL * law.a)
        for _ in range(200):
            s = 0.5 * (low + high)
            low, high = (s, high) if Z * scale * math.sinh(s) + NORMAL * law.a * s < size else (low, s)
        return math.copysign(scale * math.sinh(s), load)

    def derivative(t: float, y: Any) -> list[float]:
        v = rate(-7.6e7 + slope * t, y[1])
        return [v, float(law.state_rate(law, 0.0, abs(v), y[1]))]

    times = np.array([1.0, 2.5, 4.0, 5.6])
    start = [0.0, law.inner_state(1e6)]
    done = solve_ivp(derivative, (0.0, 5.6), start, method="DOP853", rtol=1e-11, atol=1e-14, t_eval=times, max_step=0.01)
    scale = float(np.abs(done.y[0]).max())
    assert scale > 1e-12
    assert run.slip(times) == pytest.approx(done.y[0], rel=0.0, abs=1e-7 * scale)
    assert run.state(times) == pytest.approx(law.outer_state(done.y[1]), rel=1e-9, abs=0.0)
    assert (run.slip_rate(np.array([0.5, 1.0])) < 0.0).all()
    assert (run.slip_rate(np.array([5.0, 5.6])) > 0.0).all()


@pytest.mark.parametrize(("thickness", "normal"), [(3e3, 1e8), (5e4, 2e8)])
def test_a_load_that_passes_through_zero_turns_the_slip(thickness: float, normal: float) -> None:
    """The slip rate has the sign of the load at all times: what rounding makes of a rate near zero turns nothing."""
    slab = ss.ElasticSlab(2800, 3500, thickness, normal)
    problem = ss.Problem(
        slab, ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-2), pull_rate=0.5, initial_load=-2e7, initial_state=1e6
    )
    run = ss.simulate(problem, 12.0, rtol=1e-8)
    assert run.status.ok
    times = np.linspace(0.01, 12.0, 500)
    load = run.load(times)
    mode = run.history.mode(run.history.find(times, "right"))
    clear = np.abs(load) > 1.0
    assert (mode[clear] == np.sign(load[clear])).all()


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("rtol", [1e-5, 1e-7, 1e-9])
@pytest.mark.parametrize(("mass", "lag"), [(3e3, 0.0), (0.0, 0.05), (1e5, 0.05)])
def test_the_tolerance_rules_the_error(mass: float, lag: float, rtol: float) -> None:
    """Slip after 1.2 s, relative to scipy's: below rtol."""
    slide = Slide("0.5 + 0.1/(1 + 2*v)" + ("" if lag > 0.0 else " + 0.02*sin(3*u)"), "v", 1.0, mass, lag)
    unknowns, derivative, _ = slide.equations()
    done = solve_ivp(derivative, (0.0, 1.2), np.zeros(unknowns), method="DOP853", rtol=1e-13, atol=1e-16)
    assert float(ss.simulate(slide.problem, 1.2, rtol=rtol).slip(1.2)) == pytest.approx(float(done.y[0, -1]), rel=rtol, abs=0.0)
