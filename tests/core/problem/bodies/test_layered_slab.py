"""A slab of layers: published numbers, and a slab cut into layers of equal impedance."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.core.problem.bodies.layers import CASES, COULOMB, DENSITY, NORMAL, ONE, RATE_LAW, SOFT, SPEED, THICKNESS, TWO, T, layered
from tests.messages import refused


def test_a_soft_layer_turns_one_slip_into_two() -> None:
    # Goupillaud's recursion outside the package: 9.204081633 m/s until 4 T, 13.965527813 m/s from 36 T to 40 T, 26.479553652 m
    run = ss.simulate(ss.Problem(ss.LayeredSlab(**SOFT, normal_stress=NORMAL), RATE_LAW, 1e-12, initial_excess=0.0), 60 * T)
    shocks = run.shocks
    np.testing.assert_allclose(shocks.time / T, [0.0, 4.0, 36.0, 40.0], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(shocks.rate_after, [9.204081633, 0.0, 13.965527813, 0.0], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(run.slip(60 * T), 26.479553652, rtol=1e-10, atol=0.0)


def test_coulomb_friction_answers_each_round_trip_of_a_soft_layer() -> None:
    run = ss.simulate(ss.Problem(ss.LayeredSlab(**SOFT, normal_stress=NORMAL), COULOMB, 1e-12, initial_excess=0.0), 60 * T)
    np.testing.assert_allclose(run.shocks.time / T, [0.0, 4.0, 8.0, 12.0, 16.0, 20.0], rtol=1e-12, atol=1e-12)
    rates = [10.204082, 3.401361, 5.668934, 4.913076, 5.165029, 0.0]
    np.testing.assert_allclose(run.shocks.rate_after, rates, rtol=1e-6, atol=1e-12)


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("shares", [(0.2, 0.8), (0.3, 0.4, 0.3)])
@pytest.mark.parametrize("name", CASES)
def test_layers_of_equal_impedance_are_one_slab(name: str, shares: tuple[float, ...]) -> None:
    body, problem, duration = CASES[name]
    runs = [
        ss.simulate(ss.Problem(one, **problem), duration)
        for one in (ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL, **body), layered(*shares, **body))
    ]
    times = np.linspace(0.0, duration, 2001)
    slip, cut = (run.slip(times) for run in runs)
    assert runs[0].status.name == runs[1].status.name
    np.testing.assert_allclose(cut, slip, rtol=1e-8, atol=1e-9 * slip.max())
    np.testing.assert_allclose(runs[1].events.start, runs[0].events.start, rtol=1e-9, atol=1e-9)


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "no layers": ({"thickness": [], "density": [], "wave_speed": []}, "LayeredSlab: thickness must have 1 to "),
    "other length": ({"density": [DENSITY]}, "LayeredSlab: thickness, density and wave_speed need one number for each layer, got"),
    "no thickness": ({"thickness": [0.0, 8e3]}, "LayeredSlab: thickness[0] must be greater than 0 m, got 0"),
    "too many cells": ({"thickness": [1e-3, 8e3]}, "LayeredSlab: travel times from 5.71e-07 to 2.29 s: 4096 cells"),
    "too many layers": (dict.fromkeys(SOFT, [1e3] * 4097), "LayeredSlab: 4097 layers are more than the 4096 cells"),
    "contrast": ({"density": [1e300, DENSITY]}, "LayeredSlab: density[0] must lie within 1e+50 kg/m^3, got 1e+300"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_layers_are_refused_in_one_line(name: str) -> None:
    change, words = BAD[name]
    with refused(begins=words):
        ss.LayeredSlab(**(SOFT | change), normal_stress=NORMAL)  # type: ignore[arg-type]


@pytest.mark.parametrize(("sides", "factor"), [("apart", 0.5), ("joined", 2.0)])
@pytest.mark.parametrize("name", TWO)
def test_two_equal_slabs_are_one_of_half_or_twice_the_impedance(name: str, sides: str, factor: float) -> None:
    driver = 4e6 if name == "lossy" else np.inf
    two = ss.TwoSlabs(*ONE, *ONE, NORMAL, driver_impedance=driver, other_driver_impedance=driver, sides=sides)
    one = ss.ElasticSlab(factor * DENSITY, SPEED, THICKNESS, NORMAL, driver_impedance=factor * driver)
    runs = [ss.simulate(ss.Problem(body, **TWO[name]), 40.0) for body in (one, two)]
    times = np.linspace(0.0, 40.0, 1001)
    slip, of_two = (run.slip(times) for run in runs)
    np.testing.assert_allclose(of_two, slip, rtol=1e-11, atol=1e-12 * slip.max())
    assert (two.impedance, two.stiffness) == pytest.approx((one.impedance, one.stiffness), rel=1e-14)
    if name != "lossy":
        block, known = two.equivalent_block(), one.equivalent_block()
        assert (block.mass, block.stiffness) == pytest.approx((known.mass, known.stiffness), rel=1e-14)


def test_two_slabs_refuse_a_mass_between_them() -> None:
    with refused('TwoSlabs: contact_mass needs sides = "joined"'):
        ss.TwoSlabs(*ONE, *ONE, NORMAL, contact_mass=1.0)


def test_a_run_of_layers_is_shown() -> None:
    run = ss.simulate("low-velocity-zone")
    assert "LayeredSlab" in repr(run)
    assert len(run.catalogue()) == 2


@pytest.mark.parametrize("body", [layered(0.2, 0.8), ss.TwoSlabs(*ONE, *ONE, NORMAL), ss.LayeredSlab(**SOFT, normal_stress=NORMAL)])
def test_a_contact_at_its_strength_slips_only_if_it_is_pulled(body: Any) -> None:
    assert ss.simulate(ss.Problem(body, RATE_LAW, 0.0, initial_excess=0.0), 40.0).slip(40.0) == 0.0
    pulled = ss.simulate(ss.Problem(body, RATE_LAW, 1e-12, initial_excess=0.0), 1.0)
    assert list(pulled.shocks.cause[:1]) == ["start"]
    assert pulled.events.start[0] == 0.0


@pytest.mark.parametrize("sides", ["apart", "joined"])
def test_a_normal_load_that_varies_leaves_alone_what_unlike_drivers_send(sides: str) -> None:
    """One driver is rigid, the other gives way. Nothing changes before a step of the normal load, nor by one to the same load."""
    two = ss.TwoSlabs(*ONE, *ONE, NORMAL, other_driver_impedance=4e6, sides=sides)
    plain = ss.Problem(two, COULOMB, pull_rate=0.3, initial_excess=0.0)
    pressed = replace(plain, normal_load=ss.loading.Steps([0.0, 10.0], [NORMAL, NORMAL]))
    times = np.linspace(0.0, 40.0, 801)
    slip, under_steps = (ss.simulate(one, 40.0).slip(times) for one in (plain, pressed))
    np.testing.assert_allclose(under_steps, slip, rtol=1e-10, atol=1e-12 * slip.max())
    with refused("got other_driver_impedance = 4e+06 Pa s/m"):
        two.equivalent_block()
