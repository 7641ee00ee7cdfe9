"""What a dashpot at a contact does: to slip, to energies, to uniqueness and stability, and that all bodies have the same one."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.branches import resistance
from stickslip.contact.rules.selection import load_bound
from stickslip.problem.scenarios import Scenario
from stickslip.run.check.examine import examine
from stickslip.run.reference.slab import CoulombSlab, growth_rate
from tests.core.problem.bodies.dashpot import DROP, LAW, SLAB, WEAKENING
from tests.core.run.reference.method_of_steps import method_of_steps

Z, R = SLAB.impedance, SLAB.two_way_time
ROUGH = ss.friction.HyperbolicRate(0.8, 0.6, 0.2)


def layered(slab: ss.ElasticSlab, **given: Any) -> ss.LayeredSlab:
    """Return a slab as one layer."""
    numbers = [slab.thickness], [slab.density], [slab.wave_speed], slab.normal_stress
    return ss.LayeredSlab(*numbers, driver_impedance=slab.driver_impedance, contact_damping=slab.contact_damping, **given)


def two_slabs(slab: ss.ElasticSlab, sides: str) -> ss.TwoSlabs:
    """Return two slabs that are together what a slab is: of half its density side by side, or of twice its density in series."""
    density = slab.density * (0.5 if sides == "joined" else 2.0)
    one = [slab.thickness], [density], [slab.wave_speed]
    driver = slab.driver_impedance * density / slab.density
    drivers = {"driver_impedance": driver, "other_driver_impedance": driver}
    return ss.TwoSlabs(*one, *one, slab.normal_stress, sides=sides, contact_damping=slab.contact_damping, **drivers)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("dashpot", [0.5, 2.0, 3.0])
def test_each_round_trip_changes_coulomb_slip_by_the_factor_1_less_2_z_over_z_plus_d(dashpot: float) -> None:
    """Not pulled, v = excess / (Z + D) at first, and an echo brings the excess over sliding friction times 1 - 2 Z / (Z + D).

    Where that is below 0 (D < Z) the contact stops; at D = 3 Z it halves, time and again. Within 1e-12.
    """
    slab = replace(SLAB, contact_damping=dashpot * Z)
    run = ss.simulate(ss.Problem(slab, LAW, pull_rate=0.0, initial_excess=1e6), 4.5 * R)
    factor = max(1.0 - 2.0 / (1.0 + dashpot), 0.0)
    rates = (DROP + 1e6) / (Z + slab.contact_damping) * factor ** np.arange(4)
    assert run.slip_rate((np.arange(4) + 0.5) * R) == pytest.approx(rates, rel=1e-12, abs=1e-15)
    assert float(run.slip(4.0 * R)) == pytest.approx(R * rates.sum(), rel=1e-12)
    energy = run.energy(4.0 * R)
    assert float(energy.damped[0]) == pytest.approx(slab.contact_damping * R * float((rates**2).sum()), rel=1e-12)
    assert float(energy.heat[0]) == pytest.approx(0.5e8 * R * float(rates.sum()), rel=1e-12)


@pytest.mark.slow
@pytest.mark.sampled(every=10)
@pytest.mark.parametrize("law", [WEAKENING, ROUGH, LAW], ids=["slip", "rate", "Coulomb"])
@pytest.mark.parametrize("driver", [math.inf, 0.4 * Z], ids=["rigid", "leaky"])
def test_the_method_of_steps_finds_the_same_motion(law: ss.friction.FrictionLaw, driver: float) -> None:
    """scipy's DOP853 to 1e-12 from one breaking point to the next: slip within 1e-9 of its largest."""
    problem = ss.Problem(replace(SLAB, driver_impedance=driver), law, pull_rate=0.3, initial_excess=1e6)
    run, steps = ss.simulate(problem, 5.0 * R), method_of_steps(problem, 5.0 * R, 1e-12)
    times = np.linspace(0.0, 5.0 * R, 300)
    slip = steps.slip(times)
    assert abs(run.slip(times) - slip).max() < 1e-9 * slip.max()


@pytest.mark.slow
@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("law", [WEAKENING, ROUGH], ids=["slip", "rate"])
@pytest.mark.parametrize("driver", [math.inf, 0.4 * Z], ids=["rigid", "leaky"])
def test_one_layer_and_two_slabs_that_are_one_slip_as_the_slab(law: ss.friction.FrictionLaw, driver: float) -> None:
    """Slip, what is damped and heat within 1e-9; each balances to 1e-12 of its heat, and its loads are proven to be found again."""
    slab, times = replace(SLAB, driver_impedance=driver), np.linspace(0.0, 5.0 * R, 40)
    runs = [
        ss.simulate(ss.Problem(body, law, pull_rate=0.3, initial_excess=1e6), 5.0 * R)
        for body in (slab, layered(slab), two_slabs(slab, "joined"), two_slabs(slab, "apart"))
    ]
    first = runs[0].energy(times)
    assert float(first.damped[-1]) > 0.01 * float(first.heat[-1])
    for run in runs:
        energy = run.energy(times)
        for name in ("damped", "heat"):
            assert np.asarray(energy[name]) == pytest.approx(np.asarray(first[name]), rel=1e-9, abs=1e-9 * float(first.heat[-1]))
        assert run.slip(times) == pytest.approx(runs[0].slip(times), rel=1e-9, abs=1e-12)
        assert abs(energy.balance).max() < 1e-12 * float(energy.heat[-1])
        assert run.proven.relative < 1e-11
        assert run.proven.load < 1e-11 * slab.normal_stress


@pytest.mark.parametrize("body", [SLAB, layered(SLAB), replace(SLAB, contact_mass=1e6)], ids=["slab", "layer", "mass"])
def test_events_say_what_the_dashpot_took_and_it_is_not_in_their_waves(body: Any) -> None:
    """elastic + work = kinetic + heat + damped within 1e-12, and D times the integral of v^2, by 100 001 points, within 1e-6."""
    run = ss.simulate(ss.Problem(body, WEAKENING, pull_rate=0.3, initial_excess=1e6), 3.0 * R)
    table, times = run.energetics(), np.linspace(0.0, 3.0 * R, 100_001)
    event = table.iloc[0]
    inside = times <= event.start + float(run.events.duration.iloc[0])
    taken = body.contact_damping * np.trapezoid(run.slip_rate(times[inside]) ** 2, times[inside])
    assert event.damped == pytest.approx(taken, rel=1e-3)
    assert abs(table.balance).max() < 1e-12 * event.heat
    assert event.waves == pytest.approx(event.radiated + event.trapped, abs=1e-9 * event.heat)  # nothing was trapped before it
    assert event.efficiency == pytest.approx(event.waves / (event.waves + event.heat + event.damped), rel=1e-12)


def test_traction_is_that_of_friction_and_the_stress_beside_the_contact_has_the_dashpot_too() -> None:
    """load = Z v + stress, stress = S mu + D v, within 1e-12 of the normal stress."""
    run = ss.simulate(ss.Problem(SLAB, WEAKENING, pull_rate=0.3, initial_excess=1e6), R)
    at = 0.4 * R
    rate, slip = float(run.slip_rate(at)), float(run.slip(at))
    assert float(run.traction(at)) == pytest.approx(1e8 * float(WEAKENING.coefficient(slip)), rel=1e-12)
    stress = float(run.field([0.0], at).stress[0])
    assert stress == pytest.approx(float(run.traction(at)) + SLAB.contact_damping * rate, rel=1e-12)
    assert float(run.load(at)) == pytest.approx(stress + Z * rate, rel=1e-12)


@pytest.mark.parametrize("body", [SLAB, layered(SLAB), two_slabs(SLAB, "apart"), two_slabs(SLAB, "joined")])
def test_rate_weakening_is_irregular_only_beyond_impedance_and_dashpot(body: Any) -> None:
    """S (muS - muD) alpha against Z + D, 1e-6 below and above."""
    limit = (body.impedance + body.contact_damping) / DROP
    laws = [ss.friction.HyperbolicRate(0.8, 0.5, share * limit) for share in (1.0 - 1e-6, 1.0 + 1e-6)]
    found = [ss.uniqueness(ss.Problem(body, law, initial_excess=0.0)) for law in laws]
    assert [one.regime for one in found] == ["regular", "irregular"]
    assert found[0].critical_value == pytest.approx(limit, rel=1e-12)
    assert found[0].summary.endswith("Here Z is that of the waves and the dashpot of the contact together.")
    plain = ss.uniqueness(ss.Problem(replace(body, contact_damping=0.0), laws[0], initial_excess=0.0))
    assert plain.regime == "irregular"
    assert "dashpot" not in plain.summary


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("make", [lambda one: one, layered], ids=["slab", "layer"])
@pytest.mark.parametrize(
    ("driver", "taken"), [(math.inf, 0.0), (0.4 * Z, 0.4 * Z), (2.5 * Z, 0.4 * Z)], ids=["rigid", "soft", "hard"]
)
def test_steady_sliding_withstands_the_dashpot_and_what_the_driver_takes(make: Any, driver: float, taken: float) -> None:
    """S drop alpha / (1 + alpha v)^2 = D + min(Zd, Z^2/Zd), with Zd that of a driver that gives way: within 1e-6."""
    law = ss.friction.HyperbolicRate(0.8, 0.5, 1.2)
    body = make(replace(SLAB, driver_impedance=driver))
    edge = (math.sqrt(DROP * 1.2 / (SLAB.contact_damping + taken)) - 1.0) / 1.2
    found = ss.studies.steady(ss.Problem(body, law, pull_rate=2.0, initial_excess=0.0, far_stress=7e7 if taken else None))
    assert [one.rate for one in found.changes] == pytest.approx([edge], rel=1e-6)


def test_steady_sliding_behind_a_soft_driver_bears_friction_and_dashpot() -> None:
    """Far stress + Zd (V - v) = S mu(v) + D v within 1e-12, of a slab and of the same as one layer."""
    slab = replace(SLAB, driver_impedance=0.4 * Z)
    for body in (slab, layered(slab)):
        problem = ss.Problem(body, ROUGH, pull_rate=2.0, initial_excess=0.0, far_stress=9e7)
        sliding = ss.studies.steady(problem).slidings[-1]
        friction = 1e8 * float(ROUGH.coefficient(0.0, sliding.rate))
        held = 9e7 + 0.4 * Z * (2.0 - sliding.rate)
        assert friction + slab.contact_damping * sliding.rate == pytest.approx(held, rel=1e-12)
        assert sliding.traction == pytest.approx(friction, rel=1e-12)


def test_a_disturbance_of_rest_grows_as_the_dashpot_lets_it() -> None:
    """s (Z coth(s R / 2) + D) = -S mu'(u) within 1e-12, and `check` says the same of one layer."""
    fall = 1e8 * 0.3 / 2.0
    s = growth_rate(SLAB, 0.3 / 2.0)
    assert s * (Z / math.tanh(0.5 * s * R) + SLAB.contact_damping) == pytest.approx(fall, rel=1e-12)
    said = [examine(Scenario(ss.Problem(body, WEAKENING, initial_excess=0.0), 1.0)).stability for body in (SLAB, layered(SLAB))]
    assert all(f"grows at {s:.6g} /s" in one for one in said)


def test_loads_stay_within_the_bound_for_which_branches_are_sought() -> None:
    """A dashpot of 20 Z takes more than waves do, and a pull of 5 m/s brings a load far beyond friction."""
    problem = ss.Problem(replace(SLAB, contact_damping=20.0 * Z), ROUGH, pull_rate=5.0, initial_excess=0.0)
    run = ss.simulate(problem, 60.0 * R)
    largest = abs(run.load(np.linspace(0.0, 60.0 * R, 6000))).max()
    assert 0.5e9 < largest < load_bound(problem, resistance(problem))


@pytest.mark.slow
def test_a_run_goes_on_from_its_file_bit_for_bit(tmp_path: Path) -> None:
    problem = ss.Problem(SLAB, WEAKENING, pull_rate=0.3, initial_excess=1e6)
    ss.simulate(problem, 2.0 * R).to_netcdf(tmp_path / "half.nc")
    resumed, whole = ss.resume(tmp_path / "half.nc", 5.0 * R), ss.simulate(problem, 5.0 * R)
    times = np.linspace(0.0, 5.0 * R, 500)
    assert resumed.problem == problem
    assert np.array_equal(resumed.slip(times), whole.slip(times))
    assert np.array_equal(resumed.load(times), whole.load(times))
    assert float(resumed.energy(5.0 * R).damped[0]) == float(whole.energy(5.0 * R).damped[0])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (-1.0, "ElasticSlab: contact_damping must be at least 0 Pa s/m, got -1"),
        (math.inf, "ElasticSlab: contact_damping must be"),
        ("3 Pa", "ElasticSlab: contact_damping must be .*'Pa' does not convert to Pa s/m"),
    ],
)
def test_a_dashpot_that_is_none_is_refused_in_one_line(given: Any, message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as refused:
        replace(SLAB, contact_damping=given)
    assert "\n" not in str(refused.value)


def test_the_closed_form_without_a_dashpot_refuses_one() -> None:
    with pytest.raises(ss.InputError, match=r"^CoulombSlab: a dashpot at the contact is not in it: set contact_damping to 0$"):
        CoulombSlab(SLAB, 0.8, 0.5)
