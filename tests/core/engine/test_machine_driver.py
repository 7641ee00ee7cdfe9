"""A driver with a mass, a proportional and an integral gain: exact against an own integrator, closed forms, and its neighbours."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.history.phase_index import standing_behind
from stickslip.engine.state.layout import Store, keep_only, trimmed
from stickslip.foundation.errors import InputError
from stickslip.problem.bodies import ElasticSlab
from stickslip.run.reference.slab import StuckSlab
from tests.core.engine.machine_steps import Slab

STRESS, THICKNESS = 1e6, 100.0
RIGID = ElasticSlab(2800.0, 3500.0, THICKNESS, STRESS)
Z, T = RIGID.impedance, 0.5 * RIGID.two_way_time
COULOMB = ss.friction.Coulomb(0.6, 0.4)
STRIBECK = ss.friction.ExponentialStribeck(static=0.6, dynamic=0.4, rate=0.02)


def slab(inertia: float = 0.0, impedance: float = 1.0, gain: float = 0.0, **others: float) -> ElasticSlab:
    """Return the slab with a machine, in units of Z T, Z and Z / T."""
    return replace(
        RIGID, driver_inertia=inertia * Z * T, driver_impedance=impedance * Z, driver_integral_gain=gain * Z / T, **others
    )


CASES = [
    (slab(2.6, 0.12), COULOMB),
    (slab(0.5, 4.2, contact_mass=0.1 * Z * T), STRIBECK),
    (slab(0.0, 0.43, 0.94), COULOMB),
    (slab(0.0, 1.5, 0.02, contact_mass=0.2 * Z * T), STRIBECK),
    (slab(1.3, 0.55, 0.3), COULOMB),
    (slab(0.05, 2.0, 0.4, contact_mass=0.05 * Z * T), STRIBECK),
]


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize(("body", "law"), CASES)
@pytest.mark.parametrize("stepped", [False, True])
def test_run_agrees_with_the_method_of_steps(body: ElasticSlab, law: ss.FrictionLaw, stepped: bool) -> None:
    trips, pull = 6, 0.03
    history = ss.loading.Steps([0.0, 3.3 * T], [pull, 2.5 * pull]) if stepped else pull
    solution = ss.simulate(ss.Problem(body, law, pull_rate=history, initial_excess=-2e4), 2.0 * trips * T)
    own = Slab(
        Z,
        T,
        body.contact_mass,
        0.6 * STRESS,
        (lambda v: 0.4 * STRESS) if law is COULOMB else (lambda v: STRESS * (0.4 + 0.2 * math.exp(-v / 0.02))),
        body.driver_inertia,
        body.driver_impedance,
        body.driver_integral_gain,
        (lambda t: pull if t < 3.3 * T else 2.5 * pull) if stepped else (lambda t: pull),
        (3.3 * T,) if stepped else (),
        0.6 * STRESS - 2e4,
    )
    rate, load, machine, events = own.run(trips)
    assert len(events) >= 1
    time = np.linspace(1e-3 * T, 2.0 * trips * T * 0.9999, 3001)
    far = np.abs(load(time) - solution.load(time)) > 1e-7 * STRESS
    assert far.mean() < 3e-3  # next to a front, whose time is known to 1e-13 s only
    assert np.abs(solution.slip_rate(time) - rate(time))[~far].max() < 1e-8 * np.abs(rate(time)).max()
    driven = solution.field(THICKNESS, time[time < time[-1] - T]).velocity
    apart = np.abs(driven - machine(time[time < time[-1] - T]))
    assert np.quantile(apart, 0.995) < 1e-8 * np.abs(driven).max()


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("inertia", "gain"), [(0.0, 0.02), (1.3, 0.3), (0.4, 1e-3)])
def test_a_far_stress_acts_beside_an_integral_gain_as_the_method_of_steps_says(inertia: float, gain: float) -> None:
    trips, pull, beyond, body = 6, 0.03, 4e4, slab(inertia, 0.55, gain)
    problem = ss.Problem(body, COULOMB, pull_rate=pull, initial_excess=-2e4, far_stress=0.6 * STRESS - 2e4 + beyond)
    solution = ss.simulate(problem, 2.0 * trips * T)
    machine = body.driver_inertia, body.driver_impedance, body.driver_integral_gain
    start = 0.6 * STRESS - 2e4, beyond
    own = Slab(Z, T, 0.0, 0.6 * STRESS, lambda v: 0.4 * STRESS, *machine, lambda t: pull, (), *start)
    rate, load, driver, events = own.run(trips)
    assert len(events) >= 1
    time = np.linspace(1e-3 * T, 2.0 * trips * T * 0.9999, 3001)
    far = np.abs(load(time) - solution.load(time)) > 1e-7 * STRESS
    assert far.mean() < 3e-3  # next to a front, whose time is known to 1e-13 s only
    assert np.abs(solution.slip_rate(time) - rate(time))[~far].max() < 1e-8 * np.abs(rate(time)).max()
    known = time[time < time[-1] - T]
    apart = np.abs(solution.field(THICKNESS, known).velocity - driver(known))
    assert np.quantile(apart, 0.995) < 1e-8 * np.abs(driver(known)).max()


def test_a_gain_that_vanishes_leaves_the_far_stress_its_slip() -> None:
    """The motion tends to that without a gain in proportion to the gain, with the far stress below and above the initial load."""
    for far in (5.2e5, 8e5):
        problem = ss.Problem(slab(0.0, 0.5), COULOMB, pull_rate=0.01, far_stress=far, initial_excess=0.0)
        slipped = [
            ss.simulate(replace(problem, body=slab(0.0, 0.5, gain)), 20.0 * T).slip(20.0 * T) for gain in (0.0, 1e-9, 1e-5, 1e-4)
        ]
        assert slipped[1] == pytest.approx(slipped[0], rel=1e-7, abs=0.0)
        assert (slipped[3] - slipped[0]) / (slipped[2] - slipped[0]) == pytest.approx(10.0, rel=0.01, abs=0.0)


def test_step_of_the_far_stress_moves_a_mass_as_an_exponential() -> None:
    inertia, impedance, step, when = 0.7 * Z * T, 1.5 * Z, 1e4, 0.25 * T
    body = replace(RIGID, driver_inertia=inertia, driver_impedance=impedance)
    far = ss.loading.Steps([0.0, when], [1e5, 1e5 + step])
    solution = ss.simulate(ss.Problem(body, COULOMB, initial_load=1e5, far_stress=far), 3.5 * T)
    since = np.linspace(0.0, 1.9 * T, 50)
    expected = 1e5 + 2.0 * Z * step / (impedance + Z) * -np.expm1(-(impedance + Z) * since / inertia)
    assert np.allclose(solution.load(when + T + since), expected, rtol=1e-13, atol=0.0)
    rate = solution.field(THICKNESS, when + since[:40]).velocity
    assert np.allclose(2.0 * Z * rate, expected[:40] - 1e5, rtol=1e-11, atol=1e-9)


def test_without_mass_and_integral_gain_it_is_the_impedance_to_the_bit() -> None:
    problem = ss.Problem(replace(RIGID, driver_impedance=0.5 * Z), COULOMB, pull_rate=0.01, initial_excess=-1e4)
    known = ss.simulate(problem, 20.0 * T).history.store.pieces
    body = replace(RIGID, driver_impedance=0.5 * Z, driver_inertia=0.0, driver_integral_gain=0.0)
    assert np.array_equal(ss.simulate(replace(problem, body=body), 20.0 * T).history.store.pieces, known)


def test_a_mass_without_bound_is_a_rigid_driver() -> None:
    problem = ss.Problem(RIGID, COULOMB, pull_rate=0.01, initial_excess=-1e4)
    rigid, time = ss.simulate(problem, 20.0 * T), np.linspace(0.0, 20.0 * T, 300)
    infinite = ss.simulate(replace(problem, body=replace(RIGID, driver_impedance=Z, driver_inertia=math.inf)), 20.0 * T)
    assert np.array_equal(infinite.history.store.pieces, rigid.history.store.pieces)
    apart = [
        np.abs(ss.simulate(replace(problem, body=slab(mass, 1.0)), 20.0 * T).slip(time) - rigid.slip(time)).max()
        for mass in (1e4, 1e5, 1e6)
    ]
    assert apart[0] / apart[1] == pytest.approx(10.0, rel=1e-2)
    assert apart[1] / apart[2] == pytest.approx(10.0, rel=1e-3)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(("body", "law"), CASES)
@pytest.mark.parametrize("history", [0.03, ss.loading.Sinusoidal(mean=0.03, amplitude=0.01, period=5.0 * T)])
def test_energy_balances_with_the_work_of_the_gains(body: ElasticSlab, law: ss.FrictionLaw, history: object) -> None:
    solution = ss.simulate(ss.Problem(body, law, pull_rate=history, initial_excess=-2e4), 20.0 * T)
    energy = solution.energy(np.linspace(0.1 * T, 20.0 * T, 23))
    assert np.abs(energy.balance).max() < 1e-12 * np.abs(energy.work).max()
    assert float(energy.radiated[-1]) > 0.0
    events = solution.catalogue(0.0, energy=True)
    events = events[events.end.notna()]
    assert events.empty or np.abs(events.balance).max() < 1e-9 * np.abs(energy.work).max()


def test_rests_are_leaped_over_once_the_waves_have_died() -> None:
    """Springs in series, ki and G/h, hold the contact: the stress that an event drops is built up again at their stiffness."""
    pull = 1e-9
    solution = ss.simulate(ss.Problem(slab(0.0, 0.3, 0.2), COULOMB, pull_rate=pull, initial_excess=-1.0), 6e6)
    events = solution.events
    assert len(events) == 2
    assert len(solution.history) < 2000
    assert np.diff(events.start)[0] == pytest.approx(events.slip[0] / pull, rel=1e-6)
    energy = solution.energy([2e6, 5.9e6])
    assert np.abs(energy.balance).max() < 1e-12 * np.abs(energy.work).max()
    settled = pull * 0.2 / (0.2 + 1.0)
    assert solution.field(THICKNESS, 4e6).velocity == pytest.approx(settled, rel=1e-6)


def test_rest_is_for_ever_where_the_gain_cannot_free_the_contact() -> None:
    body = replace(slab(0.0, 0.5, 1e-3), driver_integral_gain=0.0, driver_inertia=0.02 * Z * T)
    solution = ss.simulate(ss.Problem(body, COULOMB, pull_rate=1e-3, initial_load=3e5), 300.0 * T)
    assert not len(solution.events)
    assert float(solution.load(299.0 * T)) == pytest.approx(3e5 + 0.5 * Z * 1e-3, rel=1e-9)


@pytest.mark.slow
def test_run_goes_on_bit_for_bit(tmp_path) -> None:
    problem = ss.Problem(slab(0.5, 0.6, 0.2), COULOMB, pull_rate=0.03, initial_excess=-2e4)
    whole = ss.simulate(problem, 30.0 * T)
    path = ss.simulate(problem, 13.7 * T).to_netcdf(tmp_path / "part.nc")
    longer = ss.resume(path, 30.0 * T)
    assert np.array_equal(longer.history.store.pieces, whole.history.store.pieces)


@pytest.mark.parametrize("body", [slab(0.5, 0.3, 0.2), slab(0.0, 0.3, 0.2), slab(0.5, 0.6, contact_mass=0.2 * Z * T)])
@pytest.mark.parametrize("share", [0.3, 0.6])
def test_motion_of_the_driver_is_known_after_its_start_was_forgotten(body: ElasticSlab, share: float) -> None:
    """A catalogue keeps the waves in the slab and what follows; rate and push come back from one load and its wave."""
    history = ss.simulate(ss.Problem(body, COULOMB, pull_rate=0.03, initial_excess=-1e3), 35.0 * T).history
    past, many = int(share * len(history)), len(history)
    store = Store(history.store.pieces.copy(), history.store.state.copy())
    standing, _, _ = standing_behind(trimmed(store, past), history.round_trip_time)
    kept = np.concatenate([np.unique(standing), np.arange(past, many)])
    keep_only(store, many, kept)
    known = replace(history, store=trimmed(store, len(kept))).machine
    time = np.linspace(known.start[0], 36.0 * T, 999)
    assert time[0] > 5.0 * T
    assert np.abs(known.at(time) - history.machine.at(time)).max() < 1e-12 * np.abs(known.at(time)).max()
    assert known.work(time[0], time[-1]) == pytest.approx(history.machine.work(time[0], time[-1]), rel=1e-10)
    with pytest.raises(InputError, match="has forgotten what came before"):
        known.at(np.array([0.0]))


@pytest.mark.parametrize(
    "body", [slab(0.6, 2.0, 0.5, contact_mass=0.3 * Z * T), slab(0.0, 2.0, 0.5, contact_mass=0.3 * Z * T), slab(0.8, 1.5)]
)
def test_growth_of_steady_sliding_solves_its_equation(body: ElasticSlab) -> None:
    law = ss.friction.ExponentialStribeck(static=0.6, dynamic=0.4, rate=0.02, viscosity=0.5)
    found = ss.studies.steady(ss.Problem(body, law, pull_rate=0.01, initial_rate="steady"), from_rest=False)
    sliding = found.slidings[0]
    s = complex(sliding.growth, 2.0 * math.pi / sliding.period if math.isfinite(sliding.period) else 0.0)
    machine = body.driver_inertia * s + body.driver_impedance + body.driver_integral_gain / s
    echo = (Z - machine) / (Z + machine) * cmath.exp(-2.0 * s * T)
    slope = STRESS * (-0.2 / 0.02 * math.exp(-sliding.rate / 0.02) + 0.5)
    terms = body.contact_mass * s, slope, Z * (1.0 - echo) / (1.0 + echo)
    assert abs(sum(terms)) < 1e-8 * sum(abs(term) for term in terms)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"driver_inertia": 1.0}, "driver_inertia needs a finite driver_impedance"),
        ({"driver_integral_gain": 1.0}, "driver_integral_gain needs a finite driver_impedance"),
        ({"driver_integral_gain": 1.0, "driver_impedance": 0.0}, "nothing damps the driver"),
        (
            {"driver_integral_gain": 1.0, "driver_impedance": Z, "driver_inertia": math.inf},
            "driver_integral_gain needs a finite driver_inertia",
        ),
        ({"driver_inertia": -1.0, "driver_impedance": Z}, "driver_inertia must be at least 0"),
        ({"driver_integral_gain": -1.0, "driver_impedance": Z}, "driver_integral_gain must be at least 0"),
        ({"driver_integral_gain": math.inf, "driver_impedance": Z}, "driver_integral_gain must be finite"),
        ({"driver_integral_gain": math.nan, "driver_impedance": Z}, "driver_integral_gain must be finite"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(fields: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message) as error:
        replace(RIGID, **fields)
    assert "\n" not in str(error.value)


def test_what_is_too_quick_or_stands_on_moving_ground_is_refused() -> None:
    with pytest.raises(InputError, match="leave driver_inertia out"):
        ss.simulate(ss.Problem(slab(1e-6), COULOMB, initial_excess=0.0), 1.0)
    with pytest.raises(InputError, match="a driver with a mass or an integral gain is not followed on ground that moves"):
        ss.Problem(
            slab(1.0), COULOMB, initial_excess=-1e4, ground_velocity=ss.loading.Sinusoidal(mean=0.0, amplitude=0.1, period=1.0)
        )


def test_what_does_not_follow_a_machine_says_so() -> None:
    problem = ss.Problem(slab(0.5, 0.6, 0.2), COULOMB, pull_rate=0.03, initial_excess=-2e4)
    with pytest.raises(InputError, match="mass or an integral gain is not in it"):
        StuckSlab(problem.body, 1e5, 0.1)
    with pytest.raises(InputError, match="masses or an integral gain"):
        ss.studies.predictability(ss.simulate(problem, 5.0 * T))
