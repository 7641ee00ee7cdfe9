"""Values of the field inside the slab: gradients, energy, closed forms, fronts, late windows, and what users get wrong."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.solution.observables.asked import Field
from tests.core.solution.observables.runs import slab_of
from tests.problems import (
    IMPEDANCE,
    MODULUS,
    ROUND,
    SLAB,
    THICKNESS,
    rate_law_slab,
    slip_law_block,
    slip_law_slab,
)

F = ss.friction


# ---- between fronts: gradients and energy --------------------------------------------------------------------------------------


def breaks(run: ss.Solution) -> Floats:
    """Times (s) at which the wave that leaves the contact may break: where pieces of the history meet, and their echoes."""
    slab = slab_of(run)
    echoes = run.breaks[:, None] + slab.two_way_time * np.arange(math.ceil(run.duration / slab.two_way_time) + 1)
    return np.append(echoes[echoes <= run.duration], [-0.5 * slab.two_way_time, 0.5 * slab.two_way_time])


def fronts(run: ss.Solution, time: float) -> Floats:
    """Places (m) of all that left the contact or the driver at breaks; both ends of the slab included."""
    slab, left = slab_of(run), breaks(run)
    places = np.concatenate([time - left, left + slab.two_way_time - time]) * slab.wave_speed
    inside = places[(places > 0.0) & (places < slab.thickness)]
    return np.unique(np.concatenate([[0.0], inside, [slab.thickness]]))


def gauss(edges: Floats) -> tuple[Floats, Floats]:
    """Nodes and weights between edges."""
    node, weight = np.polynomial.legendre.leggauss(24)
    width = np.diff(edges)[:, None]
    return (edges[:-1, None] + 0.5 * width * (1.0 + node)).ravel(), (0.5 * width * weight).ravel()


SMOOTH = {
    "slip law": slip_law_slab(50.0, 1e-3, extra_load=3430.0),
    "rate law": rate_law_slab(),
    "contact mass": replace(rate_law_slab(), body=replace(SLAB, contact_mass=1e6)),
    "dead load": replace(rate_law_slab(), body=replace(SLAB, driver_impedance=0.0), pull_rate=0.3),
    "softer driver": replace(rate_law_slab(), body=replace(SLAB, driver_impedance=3e6), pull_rate=0.3, far_stress=7e7),
}


@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("time", [4.9, 11.9])
def test_stress_is_the_gradient_of_displacement(name: str, time: float) -> None:
    """u(h) - u(0) is the integral of sigma / G over x, to 1e-12 of it; 1 % more stress would not do."""
    run = ss.simulate(SMOOTH[name], 12.0)
    x, weight = gauss(fronts(run, time))
    low, high = run.field([0.0, THICKNESS], time).displacement
    assert run.field(x, time).stress @ weight / MODULUS == pytest.approx(high - low, rel=1e-12, abs=0.0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", SMOOTH)
@pytest.mark.parametrize("time", [1.3, 7.0])
def test_the_energy_of_the_field_is_the_stored_one(name: str, time: float) -> None:
    """rho v^2 / 2 + sigma^2 / 2G over the thickness, and the contact mass's: 1e-12 of the energy; 1e-3 more stress shows."""
    run = ss.simulate(SMOOTH[name], 12.0)
    slab = slab_of(run)

    def energy(time: float, wrong: float = 1.0) -> float:
        x, weight = gauss(fronts(run, time))
        at = run.field(x, time)
        density = 0.5 * slab.density * at.velocity**2 + 0.5 * (wrong * at.stress) ** 2 / MODULUS
        return float(density @ weight) + 0.5 * slab.contact_mass * float(run.slip_rate(time)) ** 2

    stored = float(run.energy(time).stored[0])
    size = energy(0.0)
    assert energy(time) - energy(0.0) == pytest.approx(stored, rel=0.0, abs=1e-12 * size)
    assert energy(time, 1.001) - energy(time) > 1e-9 * size


# ---- closed forms --------------------------------------------------------------------------------------------------------------


def test_a_matched_driver_sends_nothing_back() -> None:
    """Radiation damping: Z v = tau0 - S mu(u) for ever, and inside the slab the same a travel time later; then all has left.

    mu rises from 0.3 at rate k S/Z per metre and second: v = v0 exp(-k t). Relative 1e-12 of the largest.
    """
    slab = replace(SLAB, driver_impedance=IMPEDANCE)
    law = F.PiecewiseLinearSlip((0.0, 100.0), (0.3, 0.8))
    run = ss.simulate(ss.Problem(slab, law, initial_load=7e7), 60.0, rtol=1e-13)
    decay, rate = 0.5 / 100.0 * slab.normal_stress / IMPEDANCE, 4e7 / IMPEDANCE
    x, t = np.linspace(0.0, THICKNESS, 41), np.linspace(0.0, 60.0, 101)[1:, None]
    left = t - x / slab.wave_speed
    velocity = np.where(left >= 0.0, rate * np.exp(-decay * np.maximum(left, 0.0)), 0.0)
    off_front = np.abs(left) > 1e-9
    at = run.field(x, t)
    assert np.abs(at.velocity - velocity)[off_front].max() < 1e-12 * rate
    assert np.abs(at.stress - (7e7 - IMPEDANCE * velocity))[off_front].max() < 1e-12 * 7e7
    moved = rate / decay * -np.expm1(-decay * np.maximum(left, 0.0))
    assert np.abs(at.displacement - (7e7 * x / MODULUS + moved)).max() < 1e-12 * rate / decay
    assert np.abs(run.load(t) - 7e7).max() == 0.0


DROP, AFTER = 5e7, 3e7  # Coulomb: 0.8 and 0.3 of 100 MPa


def coulomb() -> ss.Solution:
    return ss.simulate(ss.Problem(SLAB, F.Coulomb(0.8, 0.3), pull_rate=1e-12, initial_excess=0.0), 8.0)


@pytest.mark.parametrize("place", [0.0, 0.3, 0.5, 0.9])
def test_fronts_have_two_sides(place: float) -> None:
    """Coulomb friction: a step leaves the contact at 0, comes back from the driver at h/c, and brings the contact to rest at R.

    Before, between and behind, rate and stress are 0, 80 MPa; 50 MPa / Z, 30 MPa; 0, -20 MPa: relative 1e-9 (the slow driver).
    """
    run, x = coulomb(), place * THICKNESS
    going, coming = x / SLAB.wave_speed, ROUND - x / SLAB.wave_speed
    states = {
        (going, "left"): (0.0, 8e7),
        (going, "right"): (DROP, AFTER),
        (coming, "left"): (DROP, AFTER),
        (coming, "right"): (0.0, -2e7),
    }
    for (time, side), (moving, stress) in states.items():
        at = run.field(x, time, side)
        assert float(at.velocity) * IMPEDANCE == pytest.approx(moving, rel=1e-9, abs=0.1)
        assert float(at.stress) == pytest.approx(stress, rel=1e-9, abs=0.1)
    near = run.field(x, [going * (1 - 1e-9), going * (1 + 1e-9)] if place else [1e-9, 2e-9]).stress
    assert (near[0] > 7.9e7) == (place > 0.0)
    assert near[1] == pytest.approx(AFTER, rel=1e-9, abs=0.0)


# ---- late, in local time, and what users get wrong -----------------------------------------------------------------------------


@pytest.mark.parametrize("mass", [0.0, 1e6])
def test_the_field_is_as_sharp_after_900_years_as_after_ten_seconds(mass: float) -> None:
    """In local time, before, in and behind an event: 1e-12 of the largest. Seconds of the run, 4e-6 apart, would show."""
    pull, windows = 1e-3 / ss.YEAR, []
    for wait in (10.0, 900 * ss.YEAR):
        problem = rate_law_slab()
        body = replace(SLAB, contact_mass=mass)
        problem = replace(problem, body=body, pull_rate=pull, initial_excess=-SLAB.stiffness * pull * wait)
        windows.append(ss.simulate(problem, wait + 30.0, rtol=1e-13).window(0))
    x, t = np.linspace(0.0, THICKNESS, 57), np.linspace(-8.0, 25.0, 331)[:, None]
    early, late = (window.field(x, t) for window in windows)
    seconds = windows[1].solution.field(x, windows[1].solution.events.start[0] + t)
    for name in Field._fields:
        size = np.abs(getattr(early, name)).max()
        assert np.abs(getattr(late, name) - getattr(early, name)).max() < 1e-12 * size, name
    assert np.abs(seconds.displacement - late.displacement).max() > 1e-9
    contact = windows[1].field(0.0, t[:, 0])
    assert contact.displacement == pytest.approx(windows[1].event_slip(t[:, 0]), rel=0.0, abs=0.0)


def test_between_events_of_a_rigid_driver_waves_keep_travelling() -> None:
    """Hours after its event, at rest, the slab still rings: its field is that of the round trip before, and one ramp more."""
    run = ss.simulate(SMOOTH["slip law"], 20_000.0)
    window = run.window(0)
    x, t = np.linspace(0.0, THICKNESS, 33), np.linspace(0.0, ROUND, 65)[:, None]
    late = 3_000
    assert len(run.shocks) == 2  # nothing has moved since
    early, later = window.field(x, 20.0 + t), window.field(x, 20.0 + late * ROUND + t)
    ramp = 2.0 * IMPEDANCE * run.problem.pull_rate * late
    assert np.ptp(early.velocity) > 1e-2
    assert np.abs(later.velocity - early.velocity).max() < 1e-7 * np.ptp(early.velocity)
    assert np.abs(later.stress - early.stress - ramp).max() < 1e-7 * np.abs(early.stress).max()
    assert np.abs(later.displacement - early.displacement - ramp * x / MODULUS).max() < 1e-8 * np.ptp(early.displacement)


def test_arrays_are_broadcast() -> None:
    run = coulomb()
    x, t = np.linspace(0.0, THICKNESS, 5), np.linspace(0.0, 8.0, 7)
    outer = run.field(x, t[:, None])
    assert outer.stress.shape == (7, 5)
    displacement, velocity, stress = run.field(x[2], t[3])
    assert displacement.shape == velocity.shape == stress.shape == ()
    assert stress == pytest.approx(outer.stress[3, 2], rel=1e-14, abs=0.0)  # linear algebra may sum a single point in another order
    assert run.field([], 1.0).velocity.shape == (0,)
    many = run.field(x[:, None, None], np.tile(t, (3, 1))).velocity
    np.testing.assert_allclose(many[4, 1], outer.velocity[:, 4], rtol=1e-14, atol=0.0)


def test_a_dataset_with_places_holds_the_field() -> None:
    run = ss.simulate(rate_law_slab(), 480 * ss.YEAR)
    x, t = np.linspace(0.0, THICKNESS, 5), np.linspace(0.0, 8.0, 7)
    for readings in (run, run.window(1)):
        dataset = readings.to_dataset(t, x=x)
        assert dataset.stress.dims == ("time", "x")
        assert {dataset[name].attrs["units"] for name in ("displacement", "velocity", "stress", "x")} == {"m", "m s-1", "Pa"}
        assert np.array_equal(dataset.velocity, readings.field(x, t[:, None]).velocity)
        assert dataset.attrs["scenario"]
        assert "displacement" not in readings.to_dataset(t)


def test_a_block_has_no_inside() -> None:
    run = ss.simulate(slip_law_block(5.0, MODULUS * 1e3), 3.0)
    with pytest.raises(ss.InputError, match="field: a block is rigid"):
        run.field(0.0, 1.0)
    with pytest.raises(ss.InputError, match="field: a block is rigid"):
        run.to_dataset([1.0], x=[0.0])


@pytest.mark.parametrize(
    ("x", "t", "side", "text"),
    [
        (-1.0, 0.0, "right", "field: x must lie between 0"),
        (10_001.0, 0.0, "right", r"10000 m \(the driver\)"),
        (np.nan, 0.0, "right", "field: x must lie"),
        (0.0, 9.0, "right", "times must lie between 0 and the end of the run, 8 s"),
        (0.0, -1e-9, "left", "times must lie between"),
        (0.0, np.nan, "left", "times must lie between"),
        (0.0, 0.0, "before", "side must be 'left' or 'right', got 'before'"),
    ],
)
def test_places_and_times_outside_are_refused(x: float, t: float, side: str, text: str) -> None:
    with pytest.raises(ss.InputError, match=text):
        coulomb().field(x, t, side)  # type: ignore[arg-type]
