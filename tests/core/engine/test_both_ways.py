"""Friction that differs with the direction of slip, against integrators of their own and against its mirror image."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.friction import (
    BothWays,
    Coulomb,
    FrictionLaw,
    HyperbolicRate,
    LinearSlipWeakening,
    PiecewiseLinearRate,
    SelfEnergising,
)
from stickslip.solution.observables.proof_of_run import proof_of_run

BLOCK = ss.SpringBlock(mass=1.0, stiffness=100.0, normal_force=10.0)
SWAYS = ss.loading.Sinusoidal(mean=0.0, amplitude=0.2, period=3.0)
"""Pull rate (m/s): the driver sways by 0.19 m, that is 19 N in the spring of a block that rests under 6 N at most."""
END = 12.0
SLAB = ss.ElasticSlab(thickness="5 m", density=2700, wave_speed="1 km/s", normal_stress="1 MPa")
LAWS: dict[str, tuple[FrictionLaw, FrictionLaw]] = {
    "coulomb": (Coulomb(static=0.6, dynamic=0.5), Coulomb(static=0.35, dynamic=0.3)),
    "one coefficient each": (Coulomb(static=0.5, dynamic=0.5), Coulomb(static=0.2, dynamic=0.2)),
    "of the rate": (HyperbolicRate(static=0.6, dynamic=0.4, alpha=8.0), HyperbolicRate(static=0.4, dynamic=0.35, alpha=3.0)),
    "by points": (PiecewiseLinearRate(rates=(0.0, 0.1, 0.4), coefficients=(0.5, 0.3, 0.45)), Coulomb(static=0.3, dynamic=0.25)),
    "more knots backwards": (
        PiecewiseLinearRate(rates=(0.0, 0.2), coefficients=(0.4, 0.5)),
        PiecewiseLinearRate(rates=(0.0, 0.05, 0.1, 0.3), coefficients=(0.4, 0.25, 0.3, 0.2)),
    ),
    "of slip": (
        LinearSlipWeakening(static=0.6, dynamic=0.3, distance="5 cm"),
        LinearSlipWeakening(static=0.35, dynamic=0.2, distance="12 cm"),
    ),
}


def block(law: FrictionLaw, pull_rate: ss.loading.LoadingHistory = SWAYS) -> ss.Problem:
    return ss.Problem(BLOCK, law, pull_rate=pull_rate, initial_load=0.0)


def integrated(forward: FrictionLaw, backward: FrictionLaw, times: np.ndarray) -> np.ndarray:
    """Return the slip (m) of the block at times (s), by an integrator that knows rest, and slip forwards and backwards."""
    turn = 2.0 * math.pi / 3.0
    laws = {1: forward, -1: backward}
    found = np.zeros(len(times))

    def load(t: float, u: float) -> float:
        return 100.0 * (0.2 / turn * (1.0 - math.cos(turn * t)) - u)

    def friction(way: int, path: float, v: float) -> float:
        return 10.0 * float(laws[way].coefficient(path, max(way * v, 0.0)))

    t, u, v, path, way = 0.0, 0.0, 0.0, 0.0, 0
    for _ in range(200):
        strength = {one: 10.0 * float(law.static_coefficient(path)) for one, law in laws.items()}
        if way == 0:

            def room(at: float, held: float = u, most: dict[int, float] = strength) -> float:
                return max(load(at, held) - most[1], -load(at, held) - most[-1])

            fine = np.linspace(t, END, 20001)
            over = np.array([room(at) for at in fine]) > 0.0
            start = (
                END
                if not over.any()
                else brentq(room, fine[over.argmax() - 1], fine[over.argmax()], xtol=1e-14)
                if not over[0]
                else t
            )
            here = (times >= t) & (times <= start)
            found[here], t = u, start
            if t >= END:
                break
            way, v = (1 if load(t, u) > 0.0 else -1), 0.0

        def move(at: float, y: np.ndarray, way: int = way) -> list[float]:
            return [y[1], load(at, y[0]) - way * friction(way, y[2], y[1]), abs(y[1])]

        def stops(at: float, y: np.ndarray, way: int = way, begun: float = t) -> float:
            return way * y[1] if at > begun + 1e-6 else 1.0

        stops.terminal, stops.direction = True, -1.0  # type: ignore[attr-defined]
        way_of = solve_ivp(move, (t, END), [u, v, path], events=stops, rtol=1e-11, atol=1e-13, max_step=0.005, dense_output=True)
        here = (times >= t) & (times <= way_of.t[-1])
        found[here] = way_of.sol(times[here])[0]
        t, (u, _, path) = float(way_of.t[-1]), way_of.y[:, -1]
        if t >= END:
            break
        v = 0.0
        strength = {one: 10.0 * float(law.static_coefficient(path)) for one, law in laws.items()}
        way = 1 if load(t, u) > strength[1] else -1 if -load(t, u) > strength[-1] else 0
    return found


@pytest.mark.slow
@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", LAWS)
def test_a_block_slides_as_an_integrator_of_two_laws_does(name: str) -> None:
    """Slip within 1e-7 m of 0.1 m, which is the integrator's own error at kinks; the other way round it is 1e-2 m off."""
    forward, backward = LAWS[name]
    times = np.linspace(0.0, END, 241)
    run = ss.simulate(block(BothWays(forward=forward, backward=backward)), END)
    truth = integrated(forward, backward, times)
    assert run.status.name == "finished"
    assert np.abs(run.slip(times) - truth).max() < 1e-7
    assert np.abs(run.slip(times) - integrated(backward, forward, times)).max() > 1e-2
    assert truth.max() > 0.01  # it slips both ways
    assert np.diff(truth).min() < -1e-4


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", LAWS)
def test_the_mirror_image_of_a_run_is_the_run_of_the_mirrored_laws(name: str) -> None:
    """Slip of the block to 1e-12 m, and slip rate of a slab to 1e-9 m/s: the same numbers but for the rounding of loads."""
    forward, backward = LAWS[name]
    times, mirrored = np.linspace(0.0, END, 241), ss.loading.Sinusoidal(mean=0.0, amplitude=-0.2, period=3.0)
    one = ss.simulate(block(BothWays(forward=forward, backward=backward)), END)
    other = ss.simulate(block(BothWays(forward=backward, backward=forward), mirrored), END)
    assert np.abs(one.slip(times) + other.slip(times)).max() < 1e-9
    runs = []
    for law, amplitude in (
        (BothWays(forward=forward, backward=backward), 0.5),
        (BothWays(forward=backward, backward=forward), -0.5),
    ):
        pulled = ss.loading.Sinusoidal(mean=0.0, amplitude=amplitude, period=0.15)
        runs.append(ss.simulate(ss.Problem(SLAB, law, pull_rate=pulled, initial_load=0.0), 0.4))
    times = np.linspace(0.0, 0.4, 801)
    assert np.abs(runs[0].slip(times) + runs[1].slip(times)).max() < 1e-9
    assert runs[0].slip_rate(times).min() < -0.01
    assert runs[0].slip_rate(times).max() > 0.01


def on_the_grid(law: dict[int, Callable[[float], float]], static: dict[int, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return times (s) and slip rates (m/s) of the slab: load(t) = load(t - T) - 2 Z v(t - T) + 2 Z V(t - T/2), point by point."""
    parts, trip, impedance = 400, 0.01, 2700.0 * 1000.0
    n = 40 * parts
    time = np.arange(n) * trip / parts
    load, rate, way = np.zeros(n), np.zeros(n), 0
    for k in range(n):
        late = time[k] - 0.5 * trip
        pull = 0.5 * math.sin(2.0 * math.pi * late / 0.15) if late > 0.0 else 0.0
        load[k] = (load[k - parts] - 2.0 * impedance * rate[k - parts] if k >= parts else 0.0) + 2.0 * impedance * pull
        if way != 0 and way * load[k] <= law[way](0.0):
            way = 0
        if way == 0:
            way = 1 if load[k] > static[1] else -1 if -load[k] > static[-1] else 0
        if way != 0:
            seen = way * load[k]
            rate[k] = way * brentq(lambda s: impedance * s + law[way](s) - seen, 0.0, seen / impedance, xtol=1e-15)  # noqa: B023
    return time, rate


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", ["coulomb", "one coefficient each", "of the rate", "by points"])
def test_a_slab_slides_as_the_method_of_steps_says(name: str) -> None:
    """Slip rates within 1e-8 m/s of 0.5 m/s, but for the few points of the grid next to a jump."""
    forward, backward = LAWS[name]
    law = {way: (lambda s, one=one: 1e6 * float(one.coefficient(0.0, s))) for way, one in ((1, forward), (-1, backward))}
    static = {1: 1e6 * float(forward.static_coefficient(0.0)), -1: 1e6 * float(backward.static_coefficient(0.0))}
    time, rate = on_the_grid(law, static)
    pulled = ss.loading.Sinusoidal(mean=0.0, amplitude=0.5, period=0.15)
    run = ss.simulate(ss.Problem(SLAB, BothWays(forward=forward, backward=backward), pull_rate=pulled, initial_load=0.0), 0.4)
    apart = np.abs(run.slip_rate(time) - rate)
    assert np.mean(apart > 1e-8) < 0.005
    assert rate.min() < -0.05


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("body", [BLOCK, SLAB], ids=["block", "slab"])
@pytest.mark.parametrize("name", LAWS)
def test_the_same_law_both_ways_has_the_bits_of_the_law(name: str, body: ss.SpringBlock | ss.ElasticSlab) -> None:
    pulled, end = (SWAYS, END) if body is BLOCK else (ss.loading.Sinusoidal(mean=0.0, amplitude=0.5, period=0.15), 0.4)
    times = np.linspace(0.0, end, 501)
    for law in LAWS[name]:
        plain, both = (
            ss.simulate(ss.Problem(body, one, pull_rate=pulled, initial_load=0.0), end) for one in (law, BothWays(law, law))
        )
        for quantity in ("slip", "slip_rate", "traction", "load"):
            assert np.array_equal(getattr(plain, quantity)(times), getattr(both, quantity)(times)), quantity


@pytest.mark.parametrize("name", LAWS)
def test_runs_of_two_laws_are_proven_and_a_run_of_other_laws_is_not(name: str) -> None:
    """All steps are proven anew to 1e-9 N of 10 N, loads and rest to 1e-11 N, energies to 1e-9 of the work."""
    forward, backward = LAWS[name]
    run = ss.simulate(block(BothWays(forward=forward, backward=backward)), END)
    proof = run.proven
    assert proof.unproven == 0
    assert proof.residual < 1e-9
    assert max(proof.load, proof.rest) < 1e-11
    energy = run.energy([END])
    assert abs(float(energy["balance"][0])) < 1e-9 * float(energy["heat"][0])
    wrong = replace(run.history, problem=block(BothWays(forward=backward, backward=forward)))
    found = proof_of_run(wrong)
    assert max(found.residual, found.load) > 0.1


def test_a_brake_shoe_leads_and_trails() -> None:
    """Friction 0.4 with gain 0.8 is 0.4 / 0.68 forwards and 0.4 / 1.32 backwards, to 1e-15; so are the two runs, to their bits."""
    law = SelfEnergising(law=Coulomb(static=0.45, dynamic=0.4), gain=0.8)
    assert float(law.coefficient(0.0, 0.1)) == pytest.approx(0.4 / 0.68, rel=1e-15, abs=0.0)
    assert float(law.ways[1].coefficient(0.0, 0.1)) == pytest.approx(0.4 / 1.32, rel=1e-15, abs=0.0)
    assert float(law.static_coefficient(0.0)) == pytest.approx(0.45 / 0.64, rel=1e-15, abs=0.0)
    two = BothWays(Coulomb(static=0.45 / 0.64, dynamic=0.4 / 0.68), Coulomb(static=0.45 / 1.36, dynamic=0.4 / 1.32))
    times = np.linspace(0.0, END, 241)
    assert np.abs(ss.simulate(block(law), END).slip(times) - ss.simulate(block(two), END).slip(times)).max() < 1e-12


def test_a_screw_is_raised_by_the_known_force() -> None:
    """The force W tan(a + phi) of statics, to 1e-14, from friction along the thread with gain tan(a) and normal load W / cos(a)."""
    slope, friction, weight = 0.3, 0.15, 100.0
    thread = SelfEnergising(law=Coulomb(static=friction, dynamic=friction), gain=math.tan(slope))
    for law, way in ((thread, 1.0), (thread.ways[1], -1.0)):
        along = way * weight / math.cos(slope) * float(law.coefficient(0.0, 0.1))
        force = (along + weight * math.sin(slope)) / math.cos(slope)
        assert force == pytest.approx(weight * math.tan(slope + way * math.atan(friction)), rel=1e-14, abs=0.0)


def test_a_block_on_a_shaken_table_creeps_the_easier_way() -> None:
    """Each period it slips as the closed form of one phase says, to 1e-4, the share of the soft spring; backwards never."""
    size, turn, resists = 4.0, 2.0 * math.pi / 0.2, 0.2 * 9.81
    start = math.asin(resists / size) / turn

    def rate(t: float) -> float:
        return size / turn * (math.cos(turn * start) - math.cos(turn * t)) - resists * (t - start)

    stop = brentq(rate, start + 0.02, start + 0.19)
    steps = np.polynomial.legendre.leggauss(20)
    slip = (
        0.5 * (stop - start) * sum(w * rate(0.5 * (stop + start) + 0.5 * (stop - start) * x) for x, w in zip(*steps, strict=True))
    )
    table = ss.SpringBlock(mass=1.0, stiffness=1e-3, normal_force=9.81)
    law = BothWays(forward=Coulomb(static=0.2, dynamic=0.2), backward=Coulomb(static=0.5, dynamic=0.5))
    shakes = ss.loading.Sinusoidal(mean=0.0, amplitude=-size, period=0.2)
    run = ss.simulate(ss.Problem(table, law, ground_acceleration=shakes, initial_load=0.0), 2.0)
    assert float(run.slip(2.0)) == pytest.approx(10.0 * slip, rel=1e-4, abs=0.0)
    assert run.slip_rate(np.linspace(0.0, 2.0, 2001)).min() == 0.0


def test_a_contact_that_opens_ends_the_run_in_words() -> None:
    """Under S0 (1 + 2 u) a block that is pushed back opens at u = -0.5 m, and the run ends there, to 1e-6 m."""
    law = ss.friction.SlipTimesRate(
        slip=ss.friction.FromExpression("1 + growth*u", {"growth": "2 / m"}, counts="net"),
        rate=ss.friction.HyperbolicRate(static=0.5, dynamic=0.3, alpha=1.0),
    )
    run = ss.simulate(ss.Problem(BLOCK, law, pull_rate=-1.0, initial_load=0.0), 5.0)
    assert not run.status.ok
    assert "friction" in run.status.message
    assert float(run.slip(run.duration)) == pytest.approx(-0.5, abs=1e-6, rel=0.0)
