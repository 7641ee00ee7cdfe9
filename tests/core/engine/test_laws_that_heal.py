"""Laws that remember slip since the last arrest: closed forms, scipy, reversal, touches of rest, healing below the load, energy."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from tests.core.engine import problems
from tests.core.run.reference.method_of_steps import method_of_steps

F = ss.friction
BLOCK = ss.SpringBlock(2.0, 50.0, 10.0)
WEAKENING = F.LinearSlipWeakening(0.6, 0.4, 0.02, memory="since-arrest")  # S times slope: 100 N/m, above the stiffness


@dataclass(frozen=True)
class Cycle:
    """One event of a pulled block under linear slip weakening, by hand: from rest at the very strength."""

    slip: float
    duration: float


def cycle_by_hand(block: ss.SpringBlock, law: ss.friction.LinearSlipWeakening, pull: float) -> Cycle:
    """m x'' = K V t - K x + S slope x up to the distance, then m x'' = K V t - K x + S (static - dynamic), up to x' = 0."""
    drop = block.normal_force * (law.static - law.dynamic)
    ramp = block.stiffness * pull / block.mass
    growth = math.sqrt((drop / law.distance - block.stiffness) / block.mass)

    def ahead(t: float) -> float:
        return ramp / growth**2 * (math.sinh(growth * t) / growth - t) - law.distance

    weakened = brentq(ahead, 1e-9, 50 / growth, xtol=1e-15)
    rate = ramp / growth**2 * (math.cosh(growth * weakened) - 1.0)
    swing = math.sqrt(block.stiffness / block.mass)
    rest = pull * weakened + drop / block.stiffness  # where the spring balances dynamic friction, moving on at the pull rate
    a, b = law.distance - rest, (rate - pull) / swing

    def slowing(t: float) -> float:
        return pull + swing * (b * math.cos(swing * t) - a * math.sin(swing * t))

    last = brentq(slowing, 0.5 * math.pi / swing, 1.5 * math.pi / swing, xtol=1e-15)
    slip = rest + pull * last + a * math.cos(swing * last) + b * math.sin(swing * last)
    return Cycle(slip, weakened + last)


def pulled(law: Any, pull: float, **changes: Any) -> ss.Problem:
    return ss.Problem(BLOCK, law, pull_rate=pull, **({"initial_excess": 0.0} | changes))


@pytest.mark.parametrize("direction", [1, -1])
def test_cycles_of_a_block_are_all_alike_and_known(direction: int) -> None:
    """Each begins at rest at the healed strength: the same slip and duration, and slip / pull rate from one start to the next."""
    pull = 1e-3
    cycle = cycle_by_hand(BLOCK, WEAKENING, pull)
    start = {"initial_excess": 0.0} if direction > 0 else {"initial_excess": None, "initial_load": -6.0}
    problem = replace(pulled(WEAKENING, direction * pull), **start)
    run = ss.simulate(problem, 4.5 * cycle.slip / pull, rtol=1e-13)
    events = run.catalogue(0.0)
    assert len(events) == 5
    assert events.slip.to_numpy() == pytest.approx(np.full(5, direction * cycle.slip), rel=1e-11, abs=0.0)
    assert (events.end - events.start).to_numpy() == pytest.approx(np.full(5, cycle.duration), rel=1e-10, abs=0.0)
    assert np.diff(events.start) == pytest.approx(np.full(4, cycle.slip / pull), rel=1e-11, abs=0.0)
    assert float(run.slip(run.duration)) == pytest.approx(direction * 5 * cycle.slip, rel=1e-11, abs=0.0)
    assert len(ss.simulate(replace(problem, friction=replace(WEAKENING, memory="all")), run.duration).catalogue(1e-2)) == 1


HEALING = {
    "block": lambda rng: problems.block(rng),
    "slab": lambda rng: problems.slab(rng),
    "lossy slab": lambda rng: problems.slab(rng, driver_impedance=float(10 ** rng.uniform(5, 8))),
    "slab with mass": lambda rng: problems.slab(rng, contact_mass=1e6),
}
SEEDS = range(3)


def healing_problem(kind: str, seed: int) -> tuple[ss.Problem, float]:
    """A random slip law that heals, pulled so fast, or left to swing so far, that it comes to rest several times."""
    rng = np.random.default_rng([seed, 5, *kind.encode()])
    body = HEALING[kind](rng)
    law = replace(problems.slip_law(rng, body), memory="since-arrest")
    made = problems.problem(rng, body, law)
    return replace(made, pull_rate=0.03 * problems.rate_scale(body)), problems.duration(body, 4.3)


@pytest.mark.sampled(every=15)
@pytest.mark.parametrize(("kind", "seed"), [*itertools.product(HEALING, SEEDS), ("slab", 16)])
def test_random_problems_that_heal_agree_with_scipy(kind: str, seed: int) -> None:
    """In slab 16 a step reaches a knot of the law, and far beyond it, but for arrest, would go back over it."""
    problem, duration = healing_problem(kind, seed)
    ours, theirs = ss.simulate(problem, duration, rtol=1e-12), method_of_steps(problem, duration, rtol=1e-11)
    assert ours.status.ok
    times = np.linspace(0.0, duration, 241)
    slipped = theirs.slip(times) - problem.initial_slip
    assert np.abs(ours.slip(times) - problem.initial_slip - slipped).max() <= 1e-8 * np.ptp(slipped)
    energy = ours.energy(times)
    assert float(np.abs(energy.balance).max() / energy.heat[-1]) < 1e-8


@pytest.mark.parametrize("pull", [1e-3, -1e-3])
def test_touching_rest_does_not_heal(pull: float) -> None:
    """Stable creep from rest at the strength, v ~ 1 - cos(w t), touches v = 0 once a swing: no arrest, it goes on weakening."""
    law = F.LinearSlipWeakening(0.6, 0.5, 0.04, memory="since-arrest")  # 25 N/m, half the stiffness: twice the pull rate
    run = ss.simulate(replace(pulled(law, pull), initial_excess=0.0 if pull > 0.0 else -12.0), 15.0)
    swing = math.sqrt((BLOCK.stiffness - 25.0) / BLOCK.mass)
    times = np.linspace(0.0, 15.0, 301)
    assert swing * times[-1] > 8 * math.pi
    expected = 2.0 * pull * (times - np.sin(swing * times) / swing)
    assert run.slip(times) == pytest.approx(expected, rel=0.0, abs=1e-9 * abs(pull) * 15.0)


def test_turning_round_does_not_heal() -> None:
    """The block swings back and forth: nothing but the rest at the end tells the two memories apart."""
    law = F.LinearSlipWeakening(0.3, 0.1, 0.5, memory="since-arrest")
    problem = ss.Problem(BLOCK, law, initial_load=20.0, pull_rate=1e-2)
    both = [ss.simulate(replace(problem, friction=replace(law, memory=memory)), 60.0) for memory in ("since-arrest", "all")]
    modes = both[0].history.store.mode
    arrest = float(both[0].history.start[np.flatnonzero(modes == 0)[0]])
    assert {1, -1} <= set(modes[: np.flatnonzero(modes == 0)[0]].tolist())
    times = np.linspace(0.0, arrest, 101)
    assert both[0].slip(times) == pytest.approx(both[1].slip(times), rel=0.0, abs=1e-12)
    assert both[0].traction(times[:-1]) == pytest.approx(both[1].traction(times[:-1]), rel=0.0, abs=1e-11)
    largest = [float(np.max(run.traction(np.linspace(arrest, 60.0, 200_001)))) for run in both]
    assert largest == pytest.approx([3.0, 1.0], rel=1e-5, abs=0.0)  # static and dynamic strength


def test_healing_below_the_load_slips_again_at_once() -> None:
    """Friction that rises with slip: each half swing leaves (k - K)/(k + K) of the excess, and the next begins in that instant."""
    rise = 150.0  # S dmu/du, N/m
    law = F.PiecewiseLinearSlip([0.0, 0.04], [0.2, 0.8], memory="since-arrest")
    run = ss.simulate(ss.Problem(BLOCK, law, initial_load=2.0 + 1.0), 30.0)
    half = math.pi * math.sqrt(BLOCK.mass / (BLOCK.stiffness + rise))
    kept = (rise - BLOCK.stiffness) / (rise + BLOCK.stiffness)
    swings = np.arange(12)
    expected = (1.0 - kept**swings) / BLOCK.stiffness
    assert run.slip(swings * half) == pytest.approx(expected, rel=0.0, abs=1e-12)
    assert run.status.ok
    assert float(run.load(30.0)) == pytest.approx(2.0, rel=1e-12, abs=0.0)


def test_a_healed_slab_jumps_back_into_slip() -> None:
    """Unloaded while friction rises with slip: rest comes smoothly, the healed strength is below the load, the slip rate jumps."""
    body = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
    law = F.PiecewiseLinearSlip([0.0, 1.0], [0.3, 0.9], memory="since-arrest")
    problem = ss.Problem(body, law, pull_rate=-0.03, initial_load=31e6)
    run, theirs = ss.simulate(problem, 5.0, rtol=1e-12), method_of_steps(problem, 5.0, rtol=1e-11)
    times = np.linspace(0.0, 5.0, 101)
    assert run.slip(times) == pytest.approx(theirs.slip(times), rel=0.0, abs=1e-9)
    healing = run.shocks[run.shocks.cause == "healing"]
    assert len(healing) >= 2
    assert healing.rate_before.to_numpy() == pytest.approx(np.zeros(len(healing)), rel=0.0, abs=1e-12)
    beyond = run.load(healing.time.to_numpy()) - 30e6
    assert healing.rate_after.to_numpy() == pytest.approx(beyond / body.impedance, rel=1e-6, abs=1e-12)


def test_initial_slip_does_not_enter_friction() -> None:
    for law in (WEAKENING, F.SinusoidalSlip(0.6, 0.2, 7.0, memory="since-arrest")):
        here, there = (ss.Problem(BLOCK, law, initial_slip=slip, initial_excess=0.1) for slip in (0.0, 0.3))
        assert there.law_slip == 0.0
        assert there.strength == here.strength
        assert replace(there, friction=replace(law, memory="all")).strength != here.strength
        times = np.linspace(0.0, 3.0, 31)
        assert ss.simulate(there, 3.0).slip(times) - 0.3 == pytest.approx(ss.simulate(here, 3.0).slip(times), rel=0.0, abs=1e-12)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("kind", ["sum", "product"])
def test_a_composite_remembers_as_its_slip_law(kind: str) -> None:
    one = 1.0 if kind == "product" else 0.2
    law = F.LAWS[kind](WEAKENING, F.ExponentialStribeck(one, 0.9 * one, 0.1))
    assert law.memory == "since-arrest"
    problem = pulled(law, 0.02)
    run, theirs = ss.simulate(problem, 20.0, rtol=1e-12), method_of_steps(problem, 20.0, rtol=1e-11)
    times = np.linspace(0.0, 20.0, 81)
    assert len(run.events) > 2
    assert run.slip(times) == pytest.approx(theirs.slip(times), rel=0.0, abs=1e-7 * float(run.slip(20.0)))
