"""Field and energy inside layers: against one slab of the same impedance, and by continuity and balance."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.core.problem.bodies.layers import CASES, COULOMB, DENSITY, NORMAL, ONE, RATE_LAW, SOFT, SPEED, THICKNESS, TWO, T, layered
from tests.messages import refused

SHORT = ("rate law", "slip law", "contact mass", "fold and dead load", "states", "lossy driver", "far stress in steps")


def assert_same_inside(run: Any, slab: Any, x: Any, of_slab: Any) -> None:
    """Compare fields and energies with those of a uniform slab at the places `of_slab` (m)."""
    end = slab.duration
    t = np.append(np.linspace(max(0.0, end - 40.0) + 0.0123, end - 0.0345, 9), [0.0321, end - 0.0011])
    for one, other in zip(run.field(x, t[:, None]), slab.field(of_slab, t[:, None]), strict=True):
        np.testing.assert_allclose(one, other, rtol=3e-9, atol=3e-9 * np.abs(other).max())
    ours, known = run.energy(t), slab.energy(t)
    size = max(float(np.abs(known[name]).max()) for name in ("work", "stored"))
    for name in ("work", "stored", "elastic", "kinetic", "heat", "radiated", "trapped", "balance"):
        # The work of a driver that gives way adds up rounding over millions of round trips at rest.
        share = 1e-9 if end < 1e6 else 2e-7
        np.testing.assert_allclose(ours[name], known[name], rtol=1e-8, atol=share * size, err_msg=name)


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("name", SHORT)
def test_the_inside_of_layers_of_equal_impedance_is_that_of_one_slab(name: str) -> None:
    body, problem, duration = CASES[name]
    slab, run = (
        ss.simulate(ss.Problem(one, **problem), duration)
        for one in (ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL, **body), layered(0.3, 0.4, 0.3, **body))
    )
    x = np.linspace(0.0, THICKNESS, 12)
    assert_same_inside(run, slab, x, x)
    ours, known = (one.catalogue(energy=True) for one in (run, slab))
    for name in ("released", "work", "heat", "trapped", "balance"):
        np.testing.assert_allclose(ours[name], known[name], rtol=1e-6, atol=1e-8 * known.heat.max(), err_msg=name)


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("sides", ["apart", "joined"])
@pytest.mark.parametrize("name", TWO)
def test_the_inside_of_two_equal_slabs_is_that_of_one(name: str, sides: str) -> None:
    # Apart, the face of the other slab of half the impedance moves half the slip backwards, less what the drivers pull in the mean.
    driver, factor = (4e6 if name == "lossy" else np.inf), (2.0 if sides == "joined" else 0.5)
    two = ss.TwoSlabs(*ONE, *ONE, NORMAL, driver_impedance=driver, other_driver_impedance=driver, sides=sides)
    one = ss.ElasticSlab(factor * DENSITY, SPEED, THICKNESS, NORMAL, driver_impedance=factor * driver)
    run, slab = (ss.simulate(ss.Problem(body, **TWO[name]), 40.0) for body in (two, one))
    x, t = np.linspace(0.0, THICKNESS, 9), np.linspace(0.0123, 39.97, 23)[:, None]
    first, other, known = run.field(x, t), run.field(-x - 1e-9, t), slab.field(x, t)
    if sides == "joined":
        np.testing.assert_allclose(first.velocity, known.velocity, rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(other.velocity, known.velocity, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(first.stress, 0.5 * known.stress, rtol=1e-9, atol=1.0)
    else:
        np.testing.assert_allclose(first.velocity - other.velocity, known.velocity, rtol=1e-6, atol=1e-6)
        # only one driver is pulled: what its steps do to one slab, they do not do to the other
        np.testing.assert_allclose(0.5 * (first.stress + other.stress), known.stress, rtol=1e-6, atol=1.0)
        slip = run.slip(t[:, 0])
        np.testing.assert_allclose(first.displacement[:, 0] - other.displacement[:, 0], slip, rtol=1e-9, atol=1e-6)
    energy, of_slab = run.energy(t[:, 0]), slab.energy(t[:, 0])
    size = float(np.abs(of_slab.work).max() + np.abs(of_slab.stored).max())
    for name in ("heat", "balance"):
        np.testing.assert_allclose(energy[name], of_slab[name], rtol=1e-8, atol=1e-9 * size, err_msg=name)


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("law", [RATE_LAW, COULOMB])
@pytest.mark.parametrize("driver", [np.inf, 4e6, 0.0])
def test_velocity_and_stress_are_continuous_and_energies_balance(driver: float, law: Any) -> None:
    rng = np.random.default_rng(7)
    for count in (2, 4):
        speed, thick = rng.uniform(1500.0, 4000.0, count), rng.uniform(500.0, 4000.0, count)
        body = ss.LayeredSlab(thick, rng.uniform(2000.0, 3000.0, count), speed, NORMAL, driver, travel_time_error=0.05)
        loading = {"pull_rate": 0.2} if driver == np.inf else {"far_stress": 78e6, "pull_rate": 0.0}
        run = ss.simulate(ss.Problem(body, law, initial_load=79.9e6 if driver else 80e6, **loading), 40.0)
        place = np.cumsum(body.stacks[0].thickness)
        t = rng.uniform(0.0, 40.0, 50)[:, None]
        near, far = run.field(place[:-1] * (1.0 - 1e-13), t), run.field(place[:-1] * (1.0 + 1e-13), t)
        np.testing.assert_allclose(near.velocity, far.velocity, rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(near.stress, far.stress, rtol=1e-9, atol=1e-2)
        if driver == np.inf:
            np.testing.assert_allclose(run.field(place[-1], t).velocity, 0.2, rtol=1e-9, atol=1e-12)
        face = run.field(0.0, t[:, 0])
        np.testing.assert_allclose(face.velocity, run.slip_rate(t[:, 0]), rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(face.stress, run.traction(t[:, 0]), rtol=1e-9, atol=1.0)
        energy = run.energy(t[:, 0])
        largest = max(float(np.abs(energy[name]).max()) for name in ("work", "stored", "heat"))
        assert largest > 0.0
        np.testing.assert_allclose(energy.balance, 0.0, rtol=0.0, atol=1e-9 * largest)


def test_displacement_is_the_integral_of_velocity() -> None:
    run = ss.simulate(ss.Problem(ss.LayeredSlab(**SOFT, normal_stress=NORMAL), RATE_LAW, 1e-12, initial_excess=0.0), 20 * T)
    moments = np.linspace(0.0, 20 * T, 2001)
    x = np.array([0.0, 400.0, 1700.0, 8000.0])
    moved = run.field(x, moments[:, None]).displacement
    middle = run.field(x, 0.5 * (moments[1:] + moments[:-1])[:, None]).velocity
    np.testing.assert_allclose(np.diff(moved, axis=0).sum(axis=0), (middle * np.diff(moments)[:, None]).sum(axis=0), rtol=1e-2)


def test_what_layers_do_not_have_inside_is_refused_in_one_line() -> None:
    run = ss.simulate(ss.Problem(ss.LayeredSlab(**SOFT, normal_stress=NORMAL), RATE_LAW, 1e-12, initial_excess=0.0), 20 * T)
    with refused("field: x must lie between 0 (the contact) and 9000 m (the driver)"):
        run.field(-1.0, 0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("sides", ["one", "apart", "joined"])
def test_the_energy_of_a_layer_is_that_of_its_stress_and_velocity(sides: str) -> None:
    """Sums over 4000 places of each layer, to 2e-3 of the largest energy; together the layers hold what the run says, to 1e-12."""
    soft, stiff = ([400.0, 900.0], [2500.0, 2900.0], [1000.0, 3000.0]), ([700.0], [2700.0], [2000.0])
    body: Any = ss.LayeredSlab(*soft, NORMAL) if sides == "one" else ss.TwoSlabs(*soft, *stiff, NORMAL, sides=sides)
    run = ss.simulate(ss.Problem(body, COULOMB, pull_rate=1e-3, initial_excess=0.0), 3.0)
    layers = [(0.0, 400.0, 2500.0, 1000.0), (400.0, 1300.0, 2900.0, 3000.0), (-700.0, 0.0, 2700.0, 2000.0)][: 2 + (sides != "one")]
    times = np.array([0.0, 0.31, 0.97, 2.6])
    elastic, kinetic = [], []
    for low, high, density, speed in layers:
        x = low + (np.arange(4000) + 0.5) / 4000 * (high - low)
        found = run.field(x, times[:, None])
        elastic.append(np.mean(found.stress**2, axis=1) * (high - low) / (2.0 * density * speed**2))
        kinetic.append(np.mean(found.velocity**2, axis=1) * (high - low) * density / 2.0)
    energy = run.energy(times)
    for name, known in (("elastic_in_layer", elastic), ("kinetic_in_layer", kinetic)):
        expected = np.transpose(known) - np.transpose(known)[0]
        np.testing.assert_allclose(energy[name], expected, rtol=0.0, atol=2e-3 * np.abs(expected).max(), err_msg=name)
    for name in ("elastic", "kinetic"):
        whole = energy[name].to_numpy()
        np.testing.assert_allclose(energy[f"{name}_in_layer"].sum("layer"), whole, rtol=1e-12, atol=1e-12 * np.abs(whole).max())
