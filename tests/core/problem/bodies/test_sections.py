"""A string of sections: against a string of one section, slabs of layers with the same numbers, and waves by recursion."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from tests.messages import refused

RPM = math.pi / 30.0
RHO, STIFF = 7850.0, 79.3e9
BIT = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate=1.1, exponent=1, viscosity=0.0033)
PIPE = {"density": RHO, "shear_modulus": STIFF, "outer_diameter": 0.127, "inner_diameter": 0.1086, "normal_torque": 15e3}
TWO: dict[str, Any] = {
    "length": [180.0, 1800.0],
    "outer_diameter": [0.1651, 0.127],
    "inner_diameter": [0.0714, 0.1086],
    "density": [RHO] * 2,
    "shear_modulus": [STIFF] * 2,
    "normal_torque": 15e3,
    "driver_impedance": 4e3,
}
PROBLEM: dict[str, Any] = {"friction": BIT, "pull_rate": 60.0 * RPM, "initial_load": 0.0}


def sections(*lengths: float, **more: Any) -> ss.SectionedString:
    """Return the pipe cut into sections of these lengths."""
    alike = {name: [PIPE[name]] * len(lengths) for name in ("outer_diameter", "inner_diameter", "density", "shear_modulus")}
    return ss.SectionedString(list(lengths), **alike, normal_torque=PIPE["normal_torque"], **more)  # type: ignore[arg-type]


def as_slab(string: ss.SectionedString) -> ss.LayeredSlab:
    """Return the slab of layers with the numbers of a string, with the polar moments and speeds worked out here."""
    both = zip(string.outer_diameter, string.inner_diameter, strict=True)
    inertia = [rho * math.pi * ((d / 2) ** 4 - (e / 2) ** 4) / 2 for rho, (d, e) in zip(string.density, both, strict=True)]
    speed = [math.sqrt(g / rho) for g, rho in zip(string.shear_modulus, string.density, strict=True)]
    assert string.normal_torque is not None
    return ss.LayeredSlab(
        list(string.length), inertia, speed, string.normal_torque, string.driver_impedance, string.inertia, drag=string.drag
    )


@pytest.mark.parametrize("more", [{"driver_impedance": 4e3}, {"driver_impedance": 4e3, "inertia": 50.0}, {"inertia": 305.0}])
@pytest.mark.parametrize("lengths", [(1980.0,), (180.0, 1800.0)])
def test_sections_of_equal_impedance_are_one_string(lengths: tuple[float, ...], more: dict[str, float]) -> None:
    strings = ss.TorsionalString(1980.0, **PIPE, **more), sections(*lengths, **more)  # type: ignore[arg-type]
    time = np.linspace(0.0, 40.0, 2001)
    angle, cut = (ss.simulate(ss.Problem(one, **PROBLEM), 40.0).slip(time) for one in strings)
    assert angle[-1] > 100.0
    np.testing.assert_allclose(cut, angle, rtol=0.0, atol=1e-9 * angle[-1])
    assert strings[1].impedance == pytest.approx(strings[0].impedance, rel=1e-14)
    assert strings[1].stiffness == pytest.approx(strings[0].stiffness, rel=1e-14)


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize(
    "change", [{}, {"inertia": 50.0}, {"drag": [0.05, 0.02]}, {"length": [120.0, 1841.5], "density": [7850.0, 2700.0]}]
)
def test_a_string_moves_as_the_slab_with_its_numbers(change: dict[str, Any]) -> None:
    string = ss.SectionedString(**(TWO | change))
    runs = [ss.simulate(ss.Problem(one, **PROBLEM), 25.0) for one in (string, as_slab(string))]
    time = np.linspace(0.0, 25.0, 501)
    angle, slip = (run.slip(time) for run in runs)
    assert angle[-1] > 20.0
    np.testing.assert_allclose(angle, slip, rtol=0.0, atol=1e-8 * slip[-1])
    energies = [run.energy(np.linspace(0.0, 25.0, 11)) for run in runs]
    np.testing.assert_allclose(energies[0].kinetic, energies[1].kinetic, rtol=1e-6, atol=1e-3)
    assert float(np.abs(energies[0].balance).max()) < 1e-8 * float(energies[0].work.max())


def test_a_step_of_torque_turns_the_bit_as_waves_in_two_sections_do() -> None:
    # by hand: the drop over Z1 at first; a share of the wave comes back from the pipe, and counts twice where friction stays
    string = ss.SectionedString(**(TWO | {"driver_impedance": math.inf}))
    first, second = (math.sqrt(RHO * STIFF) * math.pi / 32.0 * (d**4 - e**4) for d, e in ((0.1651, 0.0714), (0.127, 0.1086)))
    run = ss.simulate(ss.Problem(string, ss.friction.Coulomb(0.8, 0.5), 1e-12, initial_excess=0.0), 0.5)
    drop, trip = 0.3 * 15e3, 2.0 * 180.0 / math.sqrt(STIFF / RHO)
    share = (first - second) / (first + second)  # of the velocity that comes back from the softer pipe
    np.testing.assert_allclose(run.shocks.time[:3], [0.0, trip, 2.0 * trip], rtol=1e-12, atol=1e-12)
    rates = drop / first * np.array([1.0, 1.0 + 2.0 * share, 1.0 + 2.0 * share + 2.0 * share**2])
    np.testing.assert_allclose(run.shocks.rate_after[:3], rates, rtol=1e-10)


def test_short_heavy_collars_are_a_lump_of_inertia() -> None:
    collar = {"length": [9.0, 1800.0], "outer_diameter": [0.33, 0.127], "inner_diameter": [0.0714, 0.1086], "inertia": 5.0}
    string = ss.SectionedString(**(TWO | collar))
    lump = ss.TorsionalString(1800.0, **PIPE, driver_impedance=4e3, inertia=5.0 + 9.0 * string.inertia_per_length[0])  # type: ignore[arg-type]
    runs = [ss.simulate(ss.Problem(one, **PROBLEM), 6.0) for one in (string, lump)]
    end, other = (float(run.slip(6.0)) for run in runs)
    assert abs(end / other - 1.0) < 0.01


def test_the_equivalent_block_has_the_stiffness_of_springs_in_series() -> None:
    block = ss.SectionedString(**(TWO | {"driver_impedance": math.inf, "inertia": 7.0})).equivalent_block()
    rigidity = [STIFF * math.pi / 32.0 * (d**4 - e**4) for d, e in ((0.1651, 0.0714), (0.127, 0.1086))]
    assert block.stiffness == pytest.approx(1.0 / (180.0 / rigidity[0] + 1800.0 / rigidity[1]), rel=1e-12)
    assert block.normal_torque == 15e3
    one = ss.TorsionalString(1980.0, **PIPE).equivalent_block()  # type: ignore[arg-type]
    assert sections(180.0, 1800.0, inertia=7.0).equivalent_block().inertia == pytest.approx(one.inertia + 7.0, rel=1e-12)
    with refused("driver_impedance = 4000 N m s", begins="SectionedString: equivalent_block needs a rigid driver"):
        ss.SectionedString(**TWO).equivalent_block()


BAD: dict[str, tuple[dict[str, Any], str]] = {
    "no sections": ({"length": [], "density": []}, "length must have 1 to "),
    "other length": (
        {"density": [RHO]},
        "length, outer_diameter, inner_diameter, density and shear_modulus need one number for each section, got 2 of length, ",
    ),
    "drag of one": ({"drag": [0.1]}, "length, outer_diameter, inner_diameter, density, shear_modulus and drag need one number"),
    "no wall": ({"inner_diameter": [0.0714, 0.127]}, "inner_diameter[1] must be below outer_diameter[1] = 0.127 m, got 0.127"),
    "negative": ({"inner_diameter": [-0.1, 0.1]}, "inner_diameter[0] must be at least 0 m, got -0.1"),
    "weight and torque": ({"weight_on_bit": 1e5, "bit_radius": 0.15}, "give either normal_torque, or weight_on_bit and bit_radius"),
    "nothing": ({"normal_torque": None}, "give either normal_torque, or weight_on_bit and bit_radius"),
    "no radius": ({"normal_torque": None, "weight_on_bit": 1e5}, "give either normal_torque, or weight_on_bit and bit_radius"),
    "step": ({"drag_step": 0.7}, "drag_step must be at most 0.5, got 0.7"),
    "cells": ({"length": [1e-4, 1800.0]}, "travel times from "),
    "no steel": ({"shear_modulus": [STIFF, 0.0]}, "shear_modulus[1] must be greater than 0 Pa, got 0"),
}


@pytest.mark.parametrize("name", BAD)
def test_bad_sections_are_refused_in_one_line(name: str) -> None:
    change, words = BAD[name]
    with refused(begins=f"SectionedString: {words}"):
        ss.SectionedString(**(TWO | change))


def test_a_weight_and_a_radius_make_the_torque() -> None:
    string = ss.SectionedString(**(TWO | {"normal_torque": None, "weight_on_bit": "100 kN", "bit_radius": "150 mm"}))
    assert (string.normal_load, string.normal_field) == (15e3, "weight_on_bit")
    assert replace(string, weight_on_bit=8e4).normal_load == 12e3
