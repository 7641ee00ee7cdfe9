"""Loading that varies in time: closed forms of a stuck body, scipy, its breaks and their echoes, leaps over rest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.loading import HoldAndSlide, LoadingHistory, PiecewiseLinear, Sinusoidal, Steps
from tests.core.engine.problems import away_from_jumps
from tests.core.run.reference.method_of_steps import method_of_steps

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
LOSSY = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=4e6)
MATCHED = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=9.8e6)
WITH_MASS = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, contact_mass=2e6)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
ROUND = SLAB.two_way_time
COULOMB = ss.friction.Coulomb(0.8, 0.6)

HISTORIES: dict[str, LoadingHistory] = {
    "slow tone": Sinusoidal(0.3, 0.5, 37.3, 0.4),
    "fast tone": Sinusoidal(0.2, 0.3, 1.1, -0.4),
    "tone of the slab": Sinusoidal(0.1, 0.3, ROUND),
    "twice that": Sinusoidal(0.1, 0.3, 0.5 * ROUND, 2.0),
    "tone alone": Sinusoidal(0.0, 0.3, 7.3),
    "steps": Steps((0.0, 3.0, 7.7, 12.0), (0.3, -0.1, 0.6, 0.0)),
    "steps at echoes": Steps((0.0, 0.5 * ROUND, 1.5 * ROUND, 4.0 * ROUND), (0.3, -0.1, 0.6, 0.2)),
    "piecewise linear": PiecewiseLinear((1.0, 3.0, 7.7, 12.0), (0.1, 0.7, -0.2, 0.3)),
    "hold and slide": HoldAndSlide(0.5, 2.1, (3.3, 1.9)),
}
EACH = pytest.mark.parametrize("name", HISTORIES)


# ---- at rest: closed forms ---------------------------------------------------------------------------------


def scaled(history: LoadingHistory, share: float) -> LoadingHistory:
    """The same history of a smaller value."""
    if isinstance(history, Sinusoidal):
        return Sinusoidal(share * history.mean, share * history.amplitude, history.period, history.phase)
    if isinstance(history, HoldAndSlide):
        return HoldAndSlide(share * history.slide, history.slide_time, history.hold_times, share * history.hold)
    assert isinstance(history, PiecewiseLinear | Steps)
    return type(history)(history.times, tuple(share * value for value in history.values))


def stuck_load(problem: ss.Problem, t: float) -> float:
    """Load minus the initial one of a slab at rest under a rigid driver, bounce by bounce: 2 Z V(t - h/c) each; eqs (7)-(13)."""
    half, drag, begin = 0.5 * ROUND, SLAB.impedance, problem.first_pull_rate
    bounces = math.floor(t / ROUND)
    left = t - bounces * ROUND
    total = math.fsum(2.0 * drag * float(problem.pull_rate_at(left + k * ROUND - half)) for k in range(1, bounces + 1))
    if left < half:
        return total + drag * begin * left / half
    return total - drag * begin * (ROUND - left) / half + 2.0 * drag * float(problem.pull_rate_at(left - half))


@pytest.mark.sampled(every=14)
@EACH
def test_a_stuck_slab_sums_its_bounces(name: str) -> None:
    """To 1e-12 of the largest change of the load and 4 ulp of it, over 300 round trips that are leaped over where they can be."""
    problem = ss.Problem(SLAB, COULOMB, pull_rate=scaled(HISTORIES[name], 1e-3), initial_load=3e7)
    run = ss.simulate(problem, 300.0 * ROUND)
    times = np.random.default_rng(1).uniform(0.0, run.duration, 300)
    expected = np.array([stuck_load(problem, t) for t in times])
    assert run.status.ok
    assert run.slip(run.duration) == 0.0
    assert np.abs(run.load(times) - 3e7 - expected).max() < 1e-12 * np.abs(expected).max() + 4.0 * np.spacing(3e7)
    assert np.abs(expected - SLAB.stiffness * problem.first_pull_rate * times).max() > 1e-3 * np.abs(expected).max()


@pytest.mark.sampled(every=9)
@EACH
def test_a_stuck_block_follows_its_driver(name: str) -> None:
    """K times what was pulled, by quadrature; to 1e-11 of the largest change."""
    history = scaled(HISTORIES[name], 1e-3)
    problem = ss.Problem(BLOCK, COULOMB, pull_rate=history, initial_load=3e13)
    run = ss.simulate(problem, 500.0)
    times = np.sort(np.random.default_rng(2).uniform(0.0, run.duration, 60))
    edges = np.unique(np.concatenate([[0.0], times, [s.start for s in history.segments], np.arange(0.0, 500.0, 0.5)]))
    parts = [quad(history.at, low, high, epsrel=1e-13)[0] for low, high in zip(edges[:-1], edges[1:] - 1e-13, strict=True)]
    expected = BLOCK.stiffness * np.interp(times, edges, np.append(0.0, np.cumsum(parts)))
    assert np.abs(run.load(times) - 3e13 - expected).max() < 1e-11 * np.abs(expected).max()


def test_a_matched_driver_is_radiation_damping() -> None:
    """No reflection: Z v = beta - tau with beta = Zd V(t - h/c) + s, from h/c on; to rounding of the load, 4e-15."""
    history = Sinusoidal(2.0, 1.5, 3.7)
    problem = ss.Problem(MATCHED, COULOMB, pull_rate=history, initial_load=7e7, far_stress=5e7)
    run = ss.simulate(problem, 40.0)
    times = np.linspace(0.5 * ROUND, 40.0, 500)
    load = MATCHED.impedance * history.at(times - 0.5 * ROUND) + 5e7
    assert np.abs(run.load(times) - load).max() < 4e-15 * load.max()
    slides = run.slip_rate(times) > 0.0
    assert slides.any()
    assert not slides.all()
    rate = (load - COULOMB.dynamic * 1e8) / MATCHED.impedance
    assert np.abs(run.slip_rate(times) - rate)[slides].max() < 1e-14 * rate.max()


# ---- in slip: another method ---------------------------------------------------------------------------------

BODIES = {"slab": SLAB, "lossy": LOSSY, "mass": WITH_MASS, "block": BLOCK}
LAWS = {
    "coulomb": COULOMB,
    "linear": ss.friction.LinearSlipWeakening(0.8, 0.6, 0.8),
    "sinusoidal": ss.friction.SinusoidalSlip(0.8, 0.1, 3.0),
    "hyperbolic": ss.friction.HyperbolicRate(0.8, 0.6, 1.0),
}
SLIDING = ("slow tone", "fast tone", "steps", "piecewise linear", "hold and slide")


@pytest.mark.sampled(every=17)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", BODIES)
def test_runs_under_every_history_agree_with_the_method_of_steps(body: str, law: str) -> None:
    """Slip to 2e-8 of all of it, slip rate to 1e-6 of the largest; the energy balance to 1e-12 of the heat."""
    for name in SLIDING if (body, law) == ("slab", "hyperbolic") else SLIDING[len(body + law) % 3 :: 3]:
        normal = 1e14 if body == "block" else 1e8
        problem = ss.Problem(BODIES[body], LAWS[law], pull_rate=HISTORIES[name], initial_excess=-8e-4 * normal)
        ours, theirs = ss.simulate(problem, 14.0), method_of_steps(problem, 14.0, rtol=1e-11)
        times = np.linspace(0.0, 14.0, 241)
        slip = theirs.slip(times)
        assert ours.status.ok
        assert np.ptp(slip) > 0.0
        assert np.abs(ours.slip(times) - slip).max() < 2e-8 * np.ptp(slip)
        away, rates = away_from_jumps(ours, times), theirs.slip_rate(times)
        assert np.abs(ours.slip_rate(times) - rates)[away].max() < 1e-6 * np.abs(rates).max()
        energy = ours.energy(np.linspace(0.0, 14.0, 40))
        assert np.abs(energy.balance).max() < 1e-12 * energy.heat.max()


FAR = {
    "tone": Sinusoidal(7.8e7, 6e6, 7.3, 0.4),
    "steps": Steps((0.0, 3.0, 7.7, 12.0), (7.9e7, 8.5e7, 7e7, 8.2e7)),
    "piecewise linear": PiecewiseLinear((1.0, 3.0, 7.7, 12.0), (7.9e7, 8.5e7, 7e7, 8.2e7)),
}


@pytest.mark.slow
@pytest.mark.sampled(every=12)
@pytest.mark.parametrize("impedance", [0.0, 4e6, 9.8e6, 3e7])
@pytest.mark.parametrize("name", FAR)
def test_a_varying_far_stress_agrees_with_the_method_of_steps(name: str, impedance: float) -> None:
    """Besides a steady pull and a steady growth of its own; slip, load and energies as above."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=impedance)
    problem = ss.Problem(slab, LAWS["linear"], pull_rate=0.01, far_stress=FAR[name], far_stress_rate=1e4, initial_load=7.9e7)
    ours, theirs = ss.simulate(problem, 14.0), method_of_steps(problem, 14.0, rtol=1e-11)
    times = np.linspace(0.0, 14.0, 241)
    slip, away = theirs.slip(times), away_from_jumps(ours, times)
    assert np.ptp(slip) > 0.0
    assert np.abs(ours.slip(times) - slip).max() < 1e-9 * np.ptp(slip)
    assert np.abs(ours.load(times) - theirs.load(times))[away].max() < 1e-6 * 1e8
    energy = ours.energy(np.linspace(0.0, 14.0, 40))
    assert np.abs(energy.balance).max() < 1e-12 * energy.heat.max()
    assert (energy.radiated[-1] > 0.0) == (impedance > 0.0)


# ---- breaks, leaps, where it ends ---------------------------------------------------------------------------------


def test_breaks_and_their_echoes_are_ends_of_pieces() -> None:
    """A break at t is met at t + h/c and at every round trip from there on, to 4 ulp of the time; jumps are shocks."""
    history = Steps((0.0, 3.0, 7.7), (1.0, 3.0, 2.0))
    run = ss.simulate(ss.Problem(SLAB, COULOMB, pull_rate=history, initial_load=8.5e7), 40.0)
    edges = run.history.start
    for time in (3.0, 7.7):
        for echo in range(5):
            arrives = time + (0.5 + echo) * ROUND
            assert np.abs(edges - arrives).min() <= 4.0 * np.spacing(arrives)
    shocks = run.shocks
    first = shocks[shocks.cause == "loading"].time.to_numpy()
    assert first == pytest.approx([3.0 + 0.5 * ROUND, 7.7 + 0.5 * ROUND], rel=1e-15)
    jump = 2.0 * SLAB.impedance * np.array([2.0, -1.0])  # 2 Z V
    assert run.load(first) - run.load(first, side="left") == pytest.approx(jump, rel=1e-12)


def test_centuries_of_tides_at_rest_are_leaped_over() -> None:
    """A plate and a tide of ten times its stress rate: slip begins where the closed form first reaches the strength; few pieces.

    Onset to 1e-9 s at 80 years, where a float resolves 5e-7 s: so to 2 ulp of the time.
    """
    plate, tide, period = 1e-9, 1e-8, 44_712.0
    problem = ss.Problem(BLOCK, COULOMB, pull_rate=Sinusoidal(plate, tide, period), initial_excess=-BLOCK.stiffness * 2.5)
    run = ss.simulate(problem, 100.0 * ss.YEAR, max_events=1)
    turn = 2.0 * math.pi / period

    def missing(t: float) -> float:
        return plate * t + tide / turn * (1.0 - math.cos(turn * t)) - 2.5

    swing = 2.0 * tide / turn / plate  # the tide's own reach, as a time of the plate's
    cycles = np.arange(math.floor((2.5 / plate - swing) / period) - 2, math.ceil(2.5 / plate / period) + 2)
    grid = (cycles[:, None] * period + np.linspace(0.0, period, 200)).ravel()
    above = np.flatnonzero(np.array([missing(t) for t in grid]) > 0.0)[0]
    onset = brentq(missing, grid[above - 1], grid[above], xtol=1e-9, rtol=1e-15)
    assert run.events.start[0] == pytest.approx(onset, rel=0.0, abs=2.0 * np.spacing(onset) + 1e-6)
    assert abs(run.events.start[0] - 2.5 / plate) > 1000.0
    assert len(run.history) < 3000


@pytest.mark.slow
def test_energy_balances_across_leaped_rest() -> None:
    """A slab slips, rests for hours under a hold, a ramp and a tone, and slips again: balance to 1e-11 of the heat."""
    ramp = PiecewiseLinear((0.0, 40.0, 50.0, 4000.0, 40_000.0), (1.0, 1.0, 0.0, 0.0, 1e-3))
    for history in (ramp, Sinusoidal(1e-3, 2e-2, 300.0), HoldAndSlide(1e-3, 100.0, (3000.0, 10_000.0))):
        run = ss.simulate(ss.Problem(SLAB, COULOMB, pull_rate=history, initial_excess=0.0), 60_000.0, max_events=40)
        energy = run.energy(np.linspace(0.0, run.history.duration, 50))
        assert len(run.events) >= 4
        assert np.diff(run.history.store.trip).max() > 20
        assert np.abs(energy.balance).max() < 1e-11 * energy.heat.max()
        assert (energy.radiated == 0.0).all()


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("impedance", "until"), [(9.8e6, 1e6), (4e6, 1e6), (0.0, 1e4)])
def test_a_lossy_slab_rests_until_the_loading_changes(impedance: float, until: float) -> None:
    """Leaped over once its waves have left, which a free driver never lets out; then it slips.

    Energies as above; what is radiated never shrinks.
    """
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8, driver_impedance=impedance)
    far = Steps((0.0, 10.0, until), (5e7, 6e7, 9e7))
    run = ss.simulate(ss.Problem(slab, COULOMB, far_stress=far, initial_load=5e7), until + 30.0)
    assert run.status.ok
    assert run.events.start.to_numpy() == pytest.approx([until + 0.5 * ROUND], rel=1e-12)
    assert np.diff(run.history.store.trip).max() > 100_000 or impedance == 0.0
    energy = run.energy(np.linspace(0.0, run.history.duration, 20))
    assert np.abs(energy.balance).max() < 1e-11 * energy.heat.max()
    assert (np.diff(energy.radiated) >= 0.0).all()


def test_a_pull_that_stops_locks_the_contact() -> None:
    """For ever only behind the last break."""
    pull = Steps((0.0, 100.0, 1e7, 2e7), (1e-3, 0.0, 4e-7, 0.0))
    run = ss.simulate(ss.Problem(SLAB, COULOMB, pull_rate=pull, initial_load=3e7), 1e9)
    assert run.status.name == "locked for ever"
    assert float(run.load(1e9)) > 4e7
    assert len(run.history) < 100


# ---- the laboratory's tests ---------------------------------------------------------------------------------

RATE_AND_STATE = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)
MACHINE = ss.SpringBlock(1e3, 2e12, 1e8)  # so stiff that the block moves as it is pulled


def sheared(history: LoadingHistory, until: float) -> ss.Solution:
    law = RATE_AND_STATE
    rate = history.first
    start = {"initial_load": 1e8 * float(law.steady_coefficient(rate)), "initial_state": float(law.steady_state(rate))}
    return ss.simulate(ss.Problem(MACHINE, law, pull_rate=history, **start), until)


def test_a_velocity_step_shows_direct_effect_and_evolution() -> None:
    """mu jumps by up to a ln(V2/V1), then falls to (a - b) ln(V2/V1): 2 % for the spring gives, 1e-6 for the steady state."""
    run = sheared(Steps((0.0, 50.0), (1e-6, 1e-5)), 100.0)
    before, after = float(run.traction(49.0)), float(run.traction(100.0))
    peak = float(run.traction(np.linspace(50.0, 52.0, 4000)).max())
    law = RATE_AND_STATE
    assert (after - before) / 1e8 == pytest.approx((law.a - law.b) * math.log(10.0), rel=1e-6)
    assert (peak - before) / 1e8 == pytest.approx(law.a * math.log(10.0), rel=0.2)
    assert (peak - before) / 1e8 < law.a * math.log(10.0)
