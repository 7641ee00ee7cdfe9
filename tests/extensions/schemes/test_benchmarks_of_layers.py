"""The exact series of layers, two sides, a bow, a varying normal load and moving ground, beside closed forms and finite volumes."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
import xarray as xr

from stickslip.extensions.schemes.benchmarks import exact_series
from tests.extensions.schemes.finite_volumes import Contact, Moved, Side, fold_of, moved, orders


@cache
def exact(name: str) -> xr.Dataset:
    return exact_series(name)


def coulomb(static: float, dynamic: float, normal: Any, **more: Any) -> Contact:
    return Contact(static, lambda v: dynamic, 0.0, normal, **more)


class Case(NamedTuple):
    """What `moved` is given."""

    sides: tuple[Side, ...]
    contact: Contact
    load: float
    cell: float
    apart: bool = False


def soft_layer() -> Case:
    def mu(v: Any) -> Any:
        return 0.3 + 0.5 / (1.0 + v)

    side = Side((2800.0, 2800.0), (1750.0, 3500.0), (2, 8), start=(0.0, 1e-12))
    contact = Contact(0.8, mu, fold_of(mu, 4.9e6, 1e8, 100.0), lambda t: 1e8)
    return Case((side,), contact, 8e7 * (1 + 1e-12), 2000.0 / 7000.0)


def two_slabs() -> Case:
    steel, granite = 7850.0 * 3200.0**2 / 0.048, 2650.0 * 3000.0**2 / 0.09
    share = 1e-3 * steel / (steel + granite)  # of the driver's velocity at the contact, which begins at rest
    sides = Side((7850.0,), (3200.0,), (1,), start=(share, 1e-3)), Side((2650.0,), (3000.0,), (2,), start=(-share, 0.0))
    return Case(sides, coulomb(0.7, 0.6, lambda t: 5e6), 3.5e6, 1.5e-5, apart=True)


def bow_at_a_tenth() -> Case:
    def mu(v: Any) -> Any:
        return 0.35 + 0.4 * np.exp(-v / 0.01) + 0.45 * np.exp(-v / 0.1)

    sides = tuple(Side((2.715e-3,), (202.6,), (count,), 350.0, (0.0, 0.05)) for count in (1, 9))
    contact = Contact(1.2, mu, fold_of(mu, 2 * 2.715e-3 * 202.6, 0.6, 1.0), lambda t: 0.6)
    return Case(sides, contact, 0.21, 0.069 / 202.6)


def varying_normal_load() -> Case:
    contact = coulomb(0.8, 0.6, lambda t: float(np.interp(t, [1.0, 3.0, 5.0], [1e8, 7.5e7, 1e8])))
    return Case((Side((2800.0,), (3500.0,), (1,)),), contact, 7e7, 1e4 / 3500.0)


def moving_ground() -> Case:
    contact = coulomb(0.37, 0.37, lambda t: 360e3, ground=lambda t: float(np.interp(t, [0.1, 0.2, 0.4], [0.0, -0.3, 0.0])))
    return Case((Side((1900.0,), (160.0,), (1,), 0.0),), contact, 9.6e4, 0.125)


class Meshes(NamedTuple):
    """What is run until when (s), on meshes refined by the first number and then by 2 and 4 times that; the error that is left."""

    make: Callable[[], Case]
    until: float
    first: int
    left: float


CASES = {
    "soft-layer": Meshes(soft_layer, 14.0, 1, 1e-11),
    "two-slabs": Meshes(two_slabs, 1e-4, 8, 1e-8),
    "bow-at-a-tenth": Meshes(bow_at_a_tenth, 0.0205, 5, 1e-3),
    "varying-normal-load": Meshes(varying_normal_load, 9.0, 20, 1e-7),
    "moving-ground": Meshes(moving_ground, 1.0, 20, 1e-4),
}
ROUNDING = 1e-7
"""Below this share of the largest slip nothing more is to be gained, as the series is read between its 4001 times."""


def run(name: str, refined: int, courant: float) -> Moved:
    case = CASES[name].make()
    how = {"apart": case.apart, "refined": refined, "courant": courant}
    return moved(case.sides, case.contact, case.load, case.cell, CASES[name].until, **how)


def errors(name: str, courant: float) -> list[float]:
    """Return the mean distance in slip, as a share of the largest slip, on three meshes."""
    right, found = exact(name), []
    for finer in (1, 2, 4):
        own = run(name, round(CASES[name].first * finer / courant), courant)
        ends = own.time + own.time[1]
        inside = ends <= float(right.time[-1])
        slip = np.interp(ends[inside], right.time, right.slip)
        found.append(float(np.abs(own.slip[inside] - slip).mean() / slip.max()))
    return found


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", CASES)
def test_characteristics_converge_to_the_series_by_their_first_order_or_better(name: str) -> None:
    """Where the slip rate is constant or straight between echoes, they are right at once."""
    found = errors(name, 1.0)
    assert found[-1] < CASES[name].left
    assert found[-1] < ROUNDING or 0.5 * sum(orders(found)) > 0.9


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("name", [name for name in CASES if name != "bow-at-a-tenth"])  # whose slip hardly depends on fronts
def test_finite_volumes_that_blunt_each_front_converge_by_half_an_order_or_better(name: str) -> None:
    found = errors(name, 0.5)
    assert found[-1] < 0.04
    assert 0.5 * sum(orders(found)) > 0.4


def test_a_soft_layer_slips_twice_at_the_rates_of_goupillaud() -> None:
    """At 9.204081633 m/s until 0.4 h/c, and at 13.965527813 m/s from 3.6 h/c on; h/c is the time through a slab of 10 cells."""
    right, trip = exact("soft-layer"), 2e4 / 7000.0
    assert right.shock_time.to_numpy() == pytest.approx(trip * np.array([0.0, 0.4, 3.6, 4.0]), rel=1e-12, abs=1e-12)
    assert right.shock_rate_after.to_numpy() == pytest.approx([9.204081633, 0.0, 13.965527813, 0.0], rel=1e-9, abs=1e-12)


def test_two_slabs_slip_by_their_impedances_in_series_until_the_nearer_end_answers() -> None:
    """Then the load falls by twice what the steel has sent out; in the meantime it grows by what the driver has sheared."""
    steel, granite = 7850.0 * 3200.0, 2650.0 * 3000.0
    series = steel * granite / (steel + granite)
    right = exact("two-slabs")
    assert right.shock_time.to_numpy() == pytest.approx([0.0, 3e-5, 6e-5], rel=1e-12, abs=1e-15)
    first = 5e5 / series
    assert right.shock_rate_after.to_numpy()[0] == pytest.approx(first, rel=1e-9, abs=0.0)
    grown = float(right.shock_rate_before[1]) - first
    stiffness = 1.0 / (0.048 / (7850.0 * 3200.0**2) + 0.09 / (2650.0 * 3000.0**2))
    assert grown == pytest.approx(stiffness * 1e-3 * 3e-5 / series, rel=1e-6, abs=0.0)
    fallen = float(right.shock_rate_before[1] - right.shock_rate_after[1])
    assert fallen == pytest.approx(2.0 * series / steel * first, rel=1e-2, abs=0.0)


def test_slip_follows_a_normal_load_that_varies_in_closed_form() -> None:
    """From 2 s, where 0.8 S is 70 MPa, Z v = 70 MPa - 0.6 S, until the echo of the start stops it after 2 h/c."""
    right, trip = exact("varying-normal-load"), 2e4 / 3500.0
    assert right.shock_time.to_numpy() == pytest.approx([2.0, 2.0 + trip], rel=1e-11, abs=0.0)
    times = np.array([1.9, 2.1, 2.9, 3.5, 5.5, 7.7, 7.8])
    normal = np.interp(times, [1.0, 3.0, 5.0], [1e8, 7.5e7, 1e8])
    rate = np.where((times > 2.0) & (times < 2.0 + trip), (7e7 - 0.6 * normal) / 9.8e6, 0.0)
    assert np.interp(times, right.time, right.slip_rate) == pytest.approx(rate, rel=1e-9, abs=1e-12)


def test_a_column_slips_on_moving_ground_in_closed_form_until_the_first_echo() -> None:
    """Z v = initial load + Z (velocity that the ground has gone back) - strength, for 2 h/c = 0.25 s from the ground's start."""
    right, impedance = exact("moving-ground"), 1900.0 * 160.0
    times = right.time.to_numpy()[right.time < 0.349]
    back = np.interp(times, [0.1, 0.2, 0.4], [0.0, 0.3, 0.0])
    rate = np.maximum(9.6e4 + impedance * back - 0.37 * 360e3, 0.0) / impedance
    assert right.slip_rate.to_numpy()[: times.size] == pytest.approx(rate, rel=1e-9, abs=1e-12)
