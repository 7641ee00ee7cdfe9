"""The equations that the field inside the slab obeys, on random problems: waves, contact, driver, start.

Tolerances are shares of the normal stress S, of the rate S/Z and of the displacement S h/G, without relative part, unless said.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from numpy.typing import NDArray

import stickslip as ss
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from stickslip.solution.observables.asked import Field
from tests.core.engine import problems
from tests.core.engine.drawn import few, ran
from tests.core.engine.drawn import problems as random_problems
from tests.core.solution.observables.runs import slab_of

Floats = NDArray[np.float64]
ROUNDING = 1e-13
NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)
DRIVERS = {"rigid": math.inf, "dead load": 0.0, "matched": 1.0, "softer": 0.3, "stiffer": 3.0}
LAWS = {"slip law": problems.slip_law, "rate law": problems.rate_law}


LOADINGS = ("constant", "steps", "ramps", "tone")


def varying(kind: str, around: float, spread: float, round_trip: float) -> float | LoadingHistory:
    """A loading that does much in three round trips."""
    times = tuple(share * round_trip for share in (0.0, 0.3, 0.9, 1.7))
    values = tuple(around + share * spread for share in (1.0, -0.5, 0.7, 0.2))
    histories = {"constant": around, "steps": Steps(times, values), "ramps": PiecewiseLinear(times, values)}
    return histories.get(kind, Sinusoidal(around, spread, 0.37 * round_trip, 0.5))


def random_run(driver: str, law: str, mass: float, seed: int, loading: str = "constant") -> ss.Solution:
    """Three round trips of a slab that slips at once; under a driver that gives way also with a far stress of its own."""
    rng = np.random.default_rng([seed, 5, *driver.encode(), *law.encode()])
    slab = problems.slab(rng)
    slab = replace(slab, driver_impedance=DRIVERS[driver] * slab.impedance, contact_mass=mass * slab.density * slab.thickness)
    problem = problems.problem(rng, slab, LAWS[law](rng, slab))
    if driver != "rigid":
        stress = rng.uniform(0.2, 1.0) * slab.normal_stress
        growth = rng.uniform(0.0, 0.1) * stress / slab.two_way_time
        far = varying(loading, stress, 0.05 * stress, slab.two_way_time)
        problem = replace(problem, far_stress=far, far_stress_rate=growth)
    elif loading != "constant":
        spread = 0.03 * slab.normal_stress / slab.impedance
        problem = replace(problem, pull_rate=varying(loading, problem.first_pull_rate, spread, slab.two_way_time))
    return ss.simulate(problem, 3.3 * slab.two_way_time, rtol=1e-12)


@pytest.fixture(
    scope="module",
    params=[
        *((driver, law, mass, "constant") for driver in DRIVERS for law in LAWS for mass in (0.0, 0.03)),
        *((driver, "slip law", 0.0, loading) for driver in ("rigid", "dead load", "softer") for loading in LOADINGS[1:]),
    ],
    ids=lambda of: f"{of[0]}, {of[1]}, {'with' if of[2] else 'no'} contact mass, {of[3]}",
)
def run(request: pytest.FixtureRequest) -> ss.Solution:
    driver, law, mass, loading = request.param
    return random_run(driver, law, mass, seed=1, loading=loading)


def pulled(problem: ss.Problem, time: Floats) -> Floats:
    """How far (m) the driver has come: Gauss's rule between the times and the breaks of the loading."""
    history = problem.pull_rate
    breaks = [segment.start for segment in history.segments] if isinstance(history, LoadingHistory) else []
    edges = np.unique(np.concatenate([[0.0], time, breaks]))
    half, middle = 0.5 * np.diff(edges)[:, None], 0.5 * (edges[:-1] + edges[1:])[:, None]
    parts = half[:, 0] * (problem.pull_rate_at(middle + half * NODES) @ WEIGHTS)
    return np.asarray(np.append(0.0, np.cumsum(parts))[np.searchsorted(edges, time)])


def scales(slab: ss.ElasticSlab) -> Field:
    """Displacement, rate and stress that the normal stress makes."""
    stress = slab.normal_stress
    return Field(*(np.asarray(size) for size in (stress / slab.stiffness, stress / slab.impedance, stress)))


def moments(run: ss.Solution, count: int = 400) -> Floats:
    return np.random.default_rng(7).uniform(0.0, run.history.duration, count)


# ---- the equations, on random problems ----------------------------------------------------------------------------------------


def parallelogram(run: ss.Solution, speed: float = 1.0) -> Field:
    """What the corners of parallelograms of characteristics sum to, with alternating signs; zero for every wave of that speed."""
    slab, time = slab_of(run), moments(run)
    rng, duration = np.random.default_rng(8), run.history.duration
    place = rng.uniform(0.0, slab.thickness, len(time))
    room = np.minimum(np.minimum(place, slab.thickness - place) / slab.wave_speed, np.minimum(time, duration - time))
    delay = room * rng.uniform(0.2, 0.9, len(time))
    length = speed * slab.wave_speed * delay
    corners = (place, time + delay), (place, time - delay), (place + length, time), (place - length, time)
    later, earlier, ahead, behind = (run.field(*corner) for corner in corners)
    sums = (np.abs(a + b - c - d) / size for a, b, c, d, size in zip(later, earlier, ahead, behind, scales(slab), strict=True))
    return Field(*sums)


@pytest.mark.sampled(every=5)
def test_the_field_obeys_the_wave_equation(run: ss.Solution) -> None:
    """d'Alembert: f(x, t + a) + f(x, t - a) = f(x + ca, t) + f(x - ca, t), for displacement, velocity and stress."""
    assert max(float(error.max()) for error in parallelogram(run)) < ROUNDING
    assert min(float(error.max()) for error in parallelogram(run, speed=1.01)) > 1e-6


def contact_errors(run: ss.Solution) -> Field:
    """Differences from the contact's slip and slip rate, and from beta - Z v."""
    slab, time = slab_of(run), moments(run)
    at, rate, size = run.field(0.0, time), run.slip_rate(time), scales(slab)
    errors = at.displacement - run.slip(time), at.velocity - rate, at.stress + slab.impedance * rate - run.load(time)
    return Field(*(np.abs(error) / share for error, share in zip(errors, size, strict=True)))


@pytest.mark.sampled(every=5)
def test_the_field_meets_the_contact(run: ss.Solution) -> None:
    """Slip and slip rate are the contact's; the slab pulls it with beta - Z v, which without contact mass is the friction."""
    slab, time = slab_of(run), moments(run)
    size = scales(slab)
    displacement, velocity, stress = (float(error.max()) for error in contact_errors(run))
    assert displacement == 0.0
    assert max(velocity, stress) < ROUNDING
    from_friction = float(np.abs(run.field(0.0, time).stress - run.traction(time)).max() / size.stress)
    assert (from_friction < ROUNDING) if slab.contact_mass == 0.0 else (from_friction > 1e-6)
    assert np.abs(run.slip_rate(time)).max() > 1e-3 * size.velocity


def driver_error(run: ss.Solution, wrong: float = 1.0) -> float:
    """Rigid: from u = D0 + V t and v = V. Else from a half-space that moves at V under the far stress s: sigma = s + Zd (V - v)."""
    slab, problem, time = slab_of(run), run.problem, moments(run)
    size, at = scales(slab), run.field(slab.thickness, time)
    if math.isinf(slab.driver_impedance):
        position = problem.initial_slip + problem.stress / slab.stiffness + pulled(problem, time)
        moved = np.abs(at.displacement - position) / size.displacement
        return float(np.maximum(moved, np.abs(at.velocity - problem.pull_rate_at(time)) / size.velocity).max())
    stress = problem.stress if problem.far_stress is None else problem.far_stress
    far = (stress.at(time) if isinstance(stress, LoadingHistory) else stress) + problem.far_stress_rate * time
    by_driver = far + wrong * slab.driver_impedance * (problem.pull_rate_at(time) - at.velocity)
    return float(np.abs(at.stress - by_driver).max() / size.stress)


@pytest.mark.sampled(every=5)
def test_the_field_meets_the_driver(run: ss.Solution) -> None:
    """It does so, and its stress (rigid) or rate (else) is not just what it was at the start."""
    assert driver_error(run) < ROUNDING
    at, size = run.field(slab_of(run).thickness, moments(run)), scales(slab_of(run))
    moves = np.abs(at.velocity - run.problem.first_pull_rate).max() > 1e-2 * size.velocity
    assert moves or np.ptp(at.stress) > 1e-3 * size.stress
    if 0.0 < slab_of(run).driver_impedance < math.inf:
        assert driver_error(run, wrong=1.01) > 1e-5


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("kind", ["hyperbolic-rate", "linear-slip-weakening", "sinusoidal-slip", "rate-and-state", "lagged"])
@given(data=st.data())
@few
def test_the_field_obeys_its_equations_under_random_laws(kind: str, data: st.DataObject) -> None:
    """Laws, drivers, loads and rules at random, at a loose rtol: the wave equation and both boundaries still hold to rounding."""
    problem = data.draw(random_problems(kind))
    assume(isinstance(problem.body, ss.ElasticSlab))
    run = ran(problem)
    assert max(float(error.max()) for error in parallelogram(run)) < ROUNDING
    assert max(float(error.max()) for error in contact_errors(run)) < ROUNDING
    assert driver_error(run) < ROUNDING


def test_the_field_starts_from_uniform_shear(run: ss.Solution) -> None:
    """Before anything has moved: uniform stress, displacement and velocity linear in x; the driver may start to pull at once."""
    slab, problem = slab_of(run), run.problem
    x = np.linspace(0.0, slab.thickness, 33)
    size = scales(slab)
    start = run.field(x, 0.0, side="left")
    initial_velocity = problem.rate + (problem.first_pull_rate - problem.rate) * x / slab.thickness
    assert np.abs(start.stress - problem.stress).max() < 1e-15 * size.stress
    assert np.abs(start.velocity - initial_velocity).max() < 1e-15 * size.velocity
    sheared = problem.initial_slip + problem.stress * x / slab.shear_modulus
    assert np.abs(start.displacement - sheared).max() < 1e-14 * size.displacement
    for name in ("velocity", "stress"):
        inside = slice(1, -1)
        now = getattr(run.field(x, 0.0), name)
        assert np.abs(now - getattr(start, name))[inside].max() < 1e-15 * getattr(size, name)


@pytest.mark.sampled(every=5)
def test_a_shorter_run_knows_the_same_field(run: ss.Solution) -> None:
    """What is on its way to the contact comes from the past alone."""
    slab = slab_of(run)
    cut = 1.7 * slab.two_way_time
    short = ss.simulate(run.problem, cut, rtol=1e-12)
    x = np.linspace(0.0, slab.thickness, 101)
    for name, size in zip(Field._fields, scales(slab), strict=True):
        assert np.abs(getattr(short.field(x, cut), name) - getattr(run.field(x, cut), name)).max() < 1e-11 * size, name
