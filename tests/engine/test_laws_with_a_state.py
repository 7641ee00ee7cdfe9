"""Laws with a state of their own, built in and typed, against integrators that share no code with the package.

The truths are written with signed slip rates, by hand: scipy's DOP853 for a block, or Radau where it is stiff, with events at onset
and arrest where the law sticks; and the method of steps for a slab, whose slip rate scipy's brentq finds from the contact equation.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from tests.engine.drawn import example_problem

Floats = NDArray[np.float64]
CLOSE = 1e-7
"""Largest difference (1) from the truth, relative to the largest slip, slip rate or state."""

AXIS = ss.SpringBlock(mass=10.0, stiffness=2e5, normal_force=100.0)
FAULT = ss.SpringBlock(mass=1e6, stiffness=1e7, normal_force=1e8)
SLAB = ss.ElasticSlab(density=2800.0, wave_speed=3500.0, thickness=100.0, normal_stress=1e7)
SWING = ss.loading.Sinusoidal(mean=0.0, amplitude=2e-3, period=0.2)


class Truth(NamedTuple):
    """A law, and by hand: friction coefficient and rate of change of the state from signed slip rate (m/s) and state."""

    law: Any
    mu: Callable[[float, float], float]
    change: Callable[[float, float], float]


def bristles(v: float, z: float) -> float:
    """dz/dt (m/s) under LUGRE."""
    return v - 1e4 * abs(v) * z / (0.1 + 0.05 * math.exp(-((v / 1e-3) ** 2)))


def flash_state(v: float, psi: float) -> float:
    """dpsi/dt (1/s) under FLASH."""
    y = max(abs(v), 1e-300) / 1e-6
    x = (0.2 + (0.4 - 0.004 * math.log(y)) / (1.0 + (abs(v) / 0.1) ** 8) ** 0.125) / 0.01
    return -abs(v) / 0.4 * (psi - 0.01 * (x + math.log1p(-math.exp(-2.0 * x)) - math.log(y)))


LUGRE = Truth(
    ss.friction.LuGre(static=0.15, dynamic=0.1, rate=1e-3, stiffness=1e4, damping=3.0, viscosity=0.04),
    lambda v, z: 1e4 * z + 3.0 * bristles(v, z) + 0.04 * v,
    bristles,
)
TYPED_LUGRE = LUGRE._replace(
    law=ss.friction.FromExpression(
        "s*z + d*(v - s*v*z/(low + fall*exp(-(v/r)**2))) + c*v",
        {"s": "1e4 1/m", "d": "3 s/m", "c": "0.04 s/m", "low": 0.1, "fall": 0.05, "r": "1 mm/s"},
        evolution="dz/dt = v - s*v*z/(low + fall*exp(-(v/r)**2))",
        state_unit="m",
        at_reversal="changes-sign",
    )
)
DAHL = Truth(
    ss.friction.Dahl(sliding=0.1, stiffness=1e4),
    lambda v, z: 1e4 * z,
    lambda v, z: v - abs(v) * 1e5 * z,
)
FLASH = Truth(
    ss.friction.FlashHeating(reference=0.6, a=0.01, b=0.014, distance=0.4, weakened=0.2, weakening_rate=0.1),
    lambda v, psi: 0.01 * math.asinh(v / 2e-6 * math.exp(psi / 0.01)),
    flash_state,
)
HEALING = Truth(
    ss.friction.FromExpression("0.3 + 0.05*v + z", evolution="dz/dt = (0.2 - z)/0.5 - v*z/2e-3"),
    lambda v, z: math.copysign(0.3 + 0.05 * abs(v) + z, v),
    lambda v, z: (0.2 - z) / 0.5 - abs(v) * z / 2e-3,
)


def largest_difference(run: Any, t: Floats, slip: Floats, state: Floats) -> float:
    """The larger of the largest relative differences of slip and state."""
    slips = np.abs(run.slip(t) - slip).max() / np.abs(slip).max()
    return max(float(slips), float(np.abs(run.state(t) - state).max() / np.abs(state).max()))


# ---- block ---------------------------------------------------------------------------------------------------------------------


def block_truth(
    one: Truth, body: Any, force: Callable[[float], float], start: tuple[float, ...], t: Floats, method: str = "DOP853"
) -> Floats:
    """Slip, slip rate and state at times t, by scipy; `force` is that of the spring (N) without slip."""

    def right(now: float, y: Floats) -> list[float]:
        u, v, w = y
        return [v, (force(now) - body.stiffness * u - body.normal_force * one.mu(v, w)) / body.mass, one.change(v, w)]

    found = solve_ivp(right, (0.0, t[-1]), start, method, t, rtol=1e-11, atol=[1e-15, 1e-14, 1e-16], max_step=t[-1] / 500)
    return np.asarray(found.y)


def swing(t: float) -> float:
    """Displacement of the driver under SWING (m)."""
    w = 2.0 * math.pi / 0.2
    return 2e-3 / w * (1.0 - math.cos(w * t))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("one", [LUGRE, TYPED_LUGRE, DAHL], ids=["lugre", "typed-lugre", "dahl"])
@pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])
def test_a_reversing_axis_follows_its_hysteresis_loop(one: Truth, way: float) -> None:
    pull = ss.loading.Sinusoidal(0.0, way * SWING.amplitude, SWING.period)
    problem = ss.Problem(AXIS, one.law, pull_rate=pull, initial_load=0.0)
    run, t = ss.simulate(problem, 0.5), np.linspace(0.0, 0.5, 251)
    slip, _, state = block_truth(one, AXIS, lambda now: way * AXIS.stiffness * swing(now), (0.0, 0.0, 0.0), t)
    assert (np.diff(np.sign(run.slip_rate(t[1:]))) != 0.0).sum() >= 4  # it does reverse
    assert largest_difference(run, t, slip, state) < CLOSE
    friction = AXIS.normal_force * np.array([one.mu(v, w) for v, w in zip(run.slip_rate(t), run.state(t), strict=True)])
    assert np.abs(run.traction(t) - friction).max() < CLOSE * np.abs(friction).max()


def test_a_typed_state_gives_the_numbers_of_the_law_of_the_package() -> None:
    runs = [ss.simulate(ss.Problem(AXIS, one.law, pull_rate=SWING, initial_load=0.0), 0.5) for one in (LUGRE, TYPED_LUGRE)]
    t = np.linspace(0.0, 0.5, 101)
    assert np.allclose(runs[0].slip(t), runs[1].slip(t), rtol=1e-9, atol=0.0)


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])
def test_bristles_hold_a_load_below_the_strength_and_spring_back(way: float) -> None:
    problem = ss.Problem(AXIS, LUGRE.law, pull_rate=0.0, initial_load=way * 9.0)
    run, t = ss.simulate(problem, 0.2), np.linspace(0.0, 0.2, 201)
    slip, _, state = block_truth(LUGRE, AXIS, lambda now: way * 9.0, (0.0, 0.0, 0.0), t)
    assert largest_difference(run, t, slip, state) < CLOSE
    assert 0.15 * AXIS.normal_force > 9.0  # below the strength
    assert np.abs(slip).max() < 1e-4  # held by the bristles
    assert np.diff(np.sign(run.slip_rate(t[1:]))).any()  # which spring back


def test_flash_heating_weakens_a_block_in_an_earthquake_and_swings_back() -> None:
    state = float(FLASH.law.steady_state(1e-6))
    problem = ss.Problem(FAULT, FLASH.law, pull_rate=0.01, initial_load=0.7e8, initial_state=state)
    run, t = ss.simulate(problem, 6.0), np.linspace(0.0, 6.0, 121)
    slip, rate, psi = block_truth(FLASH, FAULT, lambda now: 0.7e8 + 1e5 * now, (0.0, problem.rate, state), t, "Radau")
    assert rate.max() > 1.0
    assert rate.min() < -0.01
    assert largest_difference(run, t, slip, psi) < CLOSE


def stick_slip(force: Callable[[float], float], z: float, t: Floats) -> tuple[Floats, Floats]:
    """Slip and state at times t of a block that sticks under HEALING, forward; scipy finds onset and arrest."""
    body, now, u = ss.SpringBlock(mass=1.0, stiffness=2e3, normal_force=10.0), 0.0, 0.0
    slip, state = np.full_like(t, np.nan), np.full_like(t, np.nan)
    exact: dict[str, Any] = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15, "dense_output": True}

    def slips(s: float, y: Floats) -> list[float]:
        net = force(s) - body.stiffness * y[0] - body.normal_force * (0.3 + 0.05 * y[1] + y[2])
        return [y[1], net / body.mass, HEALING.change(y[1], y[2])]

    while now < t[-1]:
        at_rest, level = (now, z), u

        def held(s: float, at_rest: tuple[float, float] = at_rest, level: float = level) -> float:
            healed = 0.2 + (at_rest[1] - 0.2) * math.exp(-(s - at_rest[0]) / 0.5)
            return force(s) - body.stiffness * level - body.normal_force * (0.3 + healed)

        grid = np.linspace(now, t[-1], 4000)
        over = next((k for k in range(1, len(grid)) if held(grid[k]) > 0.0), None)
        onset = t[-1] if over is None else float(brentq(held, grid[over - 1], grid[over], xtol=1e-15))
        inside = (t >= now) & (t <= onset)
        slip[inside], state[inside] = u, 0.2 + (z - 0.2) * np.exp(-(t[inside] - now) / 0.5)
        z = 0.2 + (z - 0.2) * math.exp(-(onset - now) / 0.5)
        if over is None:
            break

        def stops(s: float, y: Floats, onset: float = onset) -> float:
            return float(y[1]) if s > onset + 1e-6 else 1.0

        stops.terminal, stops.direction = True, -1.0  # type: ignore[attr-defined]
        found = solve_ivp(slips, (onset, t[-1]), [u, 0.0, z], events=stops, **exact)
        now = float(found.t[-1])
        inside = (t >= onset) & (t <= now)
        slip[inside], state[inside] = found.sol(t[inside])[0], found.sol(t[inside])[2]
        u, z = float(found.y[0, -1]), float(found.y[2, -1])
    return slip, state


@pytest.mark.parametrize("way", [1.0, -1.0], ids=["forward", "backward"])
def test_a_typed_law_that_heals_at_rest_gives_stick_slip(way: float) -> None:
    body = ss.SpringBlock(mass=1.0, stiffness=2e3, normal_force=10.0)
    problem = ss.Problem(body, HEALING.law, pull_rate=way * 2e-3, initial_load=0.0)
    run, t = ss.simulate(problem, 4.0), np.linspace(0.0, 4.0, 401)
    slip, state = stick_slip(lambda s: 4.0 * s, 0.2, t)
    assert len(run.catalogue(0.0)) >= 3
    assert largest_difference(run, t, way * slip, state) < CLOSE


def test_a_law_with_a_state_starts_healed_at_rest_or_steady() -> None:
    body = ss.SpringBlock(mass=1.0, stiffness=2e3, normal_force=10.0)
    assert ss.Problem(body, HEALING.law, initial_load=0.0).states[0] == pytest.approx(0.2, rel=1e-14)
    assert ss.Problem(AXIS, LUGRE.law, initial_load=0.0).states[0] == 0.0
    steady = ss.Problem(AXIS, LUGRE.law, pull_rate=-1e-3)
    assert steady.rate == -1e-3
    assert steady.states[0] == pytest.approx(-(0.1 + 0.05 * math.exp(-1.0)) / 1e4, rel=1e-14)
    assert ss.simulate(steady, 1.0).slip_rate(1e-6) == pytest.approx(-1e-3, rel=1e-6)


# ---- slab ----------------------------------------------------------------------------------------------------------------------


def slab_truth(one: Truth, problem: Any, t: Floats) -> tuple[Floats, Floats]:
    """Slip and state at times t of a massless slab with a rigid driver: one round trip after the other."""
    body, pull, trip = problem.body, problem.pull_rate, problem.body.two_way_time
    ramp = body.shear_modulus * pull / body.thickness
    past: list[Any] = []

    def load(s: float) -> float:
        if s <= trip or not past:
            return float(problem.load + ramp * s)
        return load(s - trip) - 2.0 * body.impedance * (rate(s - trip) - pull)

    def rate(s: float) -> float:
        n = min(int(s / trip), len(past) - 1)
        return solved(load(s), float(past[n](s)[1]))

    def solved(force: float, w: float) -> float:
        def missing(v: float) -> float:
            return body.impedance * v + body.normal_stress * one.mu(v, w) - force

        far = 1.0
        while missing(far) < 0.0 or missing(-far) > 0.0:
            far *= 10.0
        return float(brentq(missing, -far, far, xtol=1e-18, rtol=1e-14))

    y, n = np.array([0.0, *problem.states]), 0
    while n * trip < t[-1]:
        found = solve_ivp(
            lambda s, y: [v := solved(load(s), float(y[1])), one.change(v, float(y[1]))],
            (n * trip, (n + 1) * trip), y, "DOP853", dense_output=True, rtol=1e-11, atol=1e-15, first_step=1e-9, max_step=4e-4,
        )  # fmt: skip
        past.append(found.sol)
        y, n = found.y[:, -1], n + 1
    values = np.array([past[min(int(s / trip), n - 1)](s) for s in t])
    return values[:, 0], values[:, 1]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("one", "load"), [(LUGRE, 2.0e6), (LUGRE, -2.0e6), (DAHL, 1.5e6), (FLASH, 7.2e6)])
def test_a_slab_follows_the_method_of_steps(one: Truth, load: float) -> None:
    state = {} if one is not FLASH else {"initial_state": float(FLASH.law.steady_state(1e-6))}
    problem = ss.Problem(SLAB, one.law, pull_rate=0.0, initial_load=load, **({"initial_state": 0.0} | state))
    trip = SLAB.two_way_time
    run, t = ss.simulate(problem, 2.4 * trip), np.linspace(0.0, 2.4 * trip, 49)
    slip, state_then = slab_truth(one, problem, t)
    assert largest_difference(run, t, slip, state_then) < CLOSE


def test_a_massless_contact_whose_friction_falls_with_slip_rate_ends_in_words() -> None:
    law = ss.friction.FromExpression("0.6 + z - 0.2*(1 - exp(-v/0.01))", evolution="dz/dt = -z")
    problem = ss.Problem(SLAB, law, initial_load=0.61e7)
    assert "as long as friction" in ss.uniqueness(problem).summary
    with pytest.raises(ss.InputError, match="no step from here obeys the contact equation"):
        ss.simulate(problem, 1.0)
    with_mass = ss.ElasticSlab(2800.0, 3500.0, 100.0, 1e7, contact_mass=1e3)
    assert ss.simulate(ss.Problem(with_mass, law, initial_load=0.61e7), 0.1).status.ok


@pytest.mark.parametrize("kind", ["lugre", "dahl"])
def test_a_slab_that_hangs_in_its_bristles_finishes_at_loose_tolerances(kind: str) -> None:
    """Forces that nearly balance have no direction. Slip after twenty round trips: rel 10 rtol of that at 1e-10."""
    problem = example_problem(kind, "slab")
    exact = float(ss.simulate(problem, 3.0).slip(3.0))
    for rtol in np.geomspace(1e-6, 1e-8, 5):
        run = ss.simulate(problem, 3.0, rtol=float(rtol))
        assert run.status.ok
        assert float(run.slip(3.0)) == pytest.approx(exact, rel=10.0 * rtol, abs=0.0)
