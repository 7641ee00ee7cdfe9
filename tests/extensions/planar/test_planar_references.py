"""The two reference methods of the planar slab against each other, the engine in 1D, and closed forms."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.reference import (
    CRITICAL_PATCH,
    SteadyFront,
    growth_rate_on_half_space,
    growth_rate_on_slab,
    linear_fracture_energy,
)
from stickslip.run.reference.slab import growth_rate
from tests.extensions.planar.convolution import convolution
from tests.extensions.planar.planar_cases import slip_difference, weakening_patch, weakening_plane
from tests.extensions.planar.planar_methods import (
    FrictionalVolume,
    LawAtNodes,
    PlanarCase,
    PlanarSeries,
    SlipWeakeningAtNodes,
    volume,
)

METHODS = (volume, convolution)
Method = Callable[[PlanarCase, float, int], PlanarSeries]


@pytest.mark.parametrize(
    ("method", "drivers"),
    [
        pytest.param(volume, ((math.inf, 0.05), (0.0, 0.0)), marks=pytest.mark.slow),
        (convolution, ((3e6, 0.0),)),
    ],
)
def test_uniform_slip_under_a_pull_and_under_other_drivers_is_that_of_the_engine(
    method: Method, drivers: tuple[tuple[float, float], ...]
) -> None:
    """Rate strengthening over one and a half round trips, against `simulate`: within 3e-4 of the largest slip."""
    law = ss.friction.FromExpression("0.5 + 0.2*v/(0.1 + v)")
    for impedance, pull in drivers:
        body = ss.ElasticSlab(2800.0, 3500.0, 1e4, normal_stress=1e8, driver_impedance=impedance)
        run = ss.simulate(ss.Problem(body, law, initial_load=5.6e7, pull_rate=pull), 9.1)
        friction = LawAtNodes(law, np.full(2, 1e8))
        case = PlanarCase(2800.0, 3500.0, 1e4, (1e4,), np.full(2, 5.6e7), friction, pull_rate=pull, driver_impedance=impedance)
        found = method(case, 9.0, 100)
        exact = run.slip(found.times)
        assert found.slip[:, 1] == pytest.approx(exact, abs=3e-4 * exact.max())
        smooth = np.abs(found.times % (0.5 * body.two_way_time)) > 0.05
        assert found.slip_rate[smooth, 1] == pytest.approx(run.slip_rate(found.times[smooth]), abs=2e-3 * run.slip_rate(0.0))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("driver_impedance", [math.inf, 0.3, 0.0])
def test_methods_agree_and_the_difference_falls(driver_impedance: float) -> None:
    """Weakening, echoes and arrest: 1.5e-3 of the largest slip at 128 steps in R; arrest and onset spoil order 2 a little."""
    case = weakening_patch(32, driver_impedance)
    coarse, fine = (slip_difference(volume(case, 6.0, n), convolution(case, 6.0, n)) for n in (64, 128))
    assert fine < 1.5e-3
    assert coarse / fine > 2.4


def test_methods_agree_in_3d_and_a_plane_without_change_along_z_is_a_line() -> None:
    case = weakening_plane()
    assert slip_difference(volume(case, 3.0, 96), convolution(case, 3.0, 96)) < 3e-3
    line = weakening_patch(32)
    friction = SlipWeakeningAtNodes((32, 4), 1.1, np.reshape(line.friction.dynamic, (32, 1)), 0.8)  # type: ignore[attr-defined]
    plane = replace(line, length=(4.0, 1.0), initial_load=np.repeat(line.initial_load[:, None], 4, 1), friction=friction)
    for method in METHODS:
        flat = method(line, 3.0, 64).slip[..., None]
        assert method(plane, 3.0, 64).slip == pytest.approx(np.repeat(flat, 4, 2), abs=1e-12)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("wavenumber", "expected"), [(0.0, 1.287839), (0.5, 1.186815), (1.0, 0.811499)])
def test_growth_on_a_slab(wavenumber: float, expected: float) -> None:
    """The volume method within 1e-3 of q coth(q h) = alpha_w, lambda = c sqrt(q^2 - k^2), alpha_w h = 1.5."""
    assert growth_rate_on_slab(1.5, wavenumber, 1.0, 1.0) == pytest.approx(expected, abs=1e-6)
    assert _measured_growth(volume, wavenumber, 1.0, 128) == pytest.approx(expected, rel=1e-3)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("method", METHODS)
def test_growth_on_a_half_space(method: Method) -> None:
    """Before the first echo: lambda = c sqrt(alpha_w^2 - k^2), within 1 %; unstable waves are longer than 2 pi / alpha_w."""
    expected = growth_rate_on_half_space(1.5, 1.0, 1.0)
    assert expected == pytest.approx(math.sqrt(1.25), rel=1e-15)
    assert _measured_growth(method, 1.0, 5.0, 300) == pytest.approx(expected, rel=1e-2)
    assert growth_rate_on_half_space(1.5, 1.6, 1.0) == 0.0


def test_uniform_growth_is_that_of_the_slab_in_1d() -> None:
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, normal_stress=1e8)
    weakening = 2.0 * slab.shear_modulus / slab.normal_stress / slab.thickness
    assert growth_rate_on_slab(2.0 / 1e4, 0.0, 1e4, 3500.0) == pytest.approx(growth_rate(slab, weakening), rel=1e-12)
    assert growth_rate_on_slab(0.9 / 1e4, 0.0, 1e4, 3500.0) == 0.0


def _measured_growth(method: Method, wavenumber: float, thickness: float, steps: int) -> float:
    """Growth rate of one wave along a contact that weakens by 1.5 G per slip and never arrests, late within 10 h / c or 9.9 s."""
    length = 2.0 * np.pi / wavenumber if wavenumber else 1.0
    wave = np.cos(2.0 * np.pi * np.arange(8) / 8) if wavenumber else np.ones(8)
    load, friction = 3e9 + 1.0 + 0.5 * wave, SlipWeakeningAtNodes((8,), 3e9, 1.5e9, 1e9)
    found = method(PlanarCase(1.0, 1.0, thickness, (length,), load, friction), 9.9, steps)
    assert (found.slip_rate > 0.0).all()
    early, late = (found.slip_rate[n] @ wave for n in (3 * len(found.times) // 4, -1))
    return float(np.log(late / early) / (found.times[-1] - found.times[3 * len(found.times) // 4]))


def _stiffness(nodes: int, patch: int, length: float, thickness: float) -> np.ndarray:
    """Stress by slip at the nodes of a patch, over G: k coth(k h) for each wave."""
    k = 2.0 * np.pi * np.abs(np.fft.fftfreq(nodes, length / nodes))
    with np.errstate(divide="ignore", invalid="ignore"):
        stiffness = np.where(k * thickness > 0.0, k / np.tanh(k * thickness), 1.0 / thickness)
    row = np.fft.ifft(stiffness).real
    return row[np.abs(np.subtract.outer(np.arange(patch), np.arange(patch)))]


def test_critical_patch_on_a_half_space() -> None:
    """The smallest eigenvalue, extrapolated in the period and then in dy, is 1.157774 within 3e-5."""
    spacings = []
    for patch in (16, 32, 64, 128):
        near, far = (np.linalg.eigvalsh(_stiffness(patch * share, patch, float(share), math.inf))[0] * 0.5 for share in (16, 32))
        spacings.append(far + (far - near) / 3.0)
    for order in (1, 2):
        spacings = [fine + (fine - coarse) / (2**order - 1) for coarse, fine in pairwise(spacings)]
    assert spacings[-1] == pytest.approx(CRITICAL_PATCH, abs=3e-5)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("share", "breaks"), [(0.93, False), (1.07, True)])
def test_a_patch_breaks_if_its_weakening_exceeds_the_critical_one(share: float, breaks: bool) -> None:
    """By the volume method, between barriers, 7 % below and above the threshold of the same nodes."""
    y = np.arange(64) / 16.0 - 2.0
    inside = (y >= -0.5) & (y < 0.5)
    weakening = share * np.linalg.eigvalsh(_stiffness(64, 16, 4.0, 2.0))[0]
    friction = SlipWeakeningAtNodes((64,), 1.0, 0.9, 0.1 / weakening)
    case = PlanarCase(1.0, 1.0, 2.0, (4.0,), np.full(64, 1.0 + 1e-5), friction, locked=~inside)
    slip = volume(case, 40.0, 128).slip[-1]
    assert (slip.max() > friction.distance[0]) == breaks
    assert breaks or slip.max() < 0.01 * friction.distance[0]


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("driver_impedance", [math.inf, 0.3, 0.0])
def test_energy_balance_of_the_volume_method(driver_impedance: float) -> None:
    """Energy and heat add up to a constant within 1e-12; the constant stems from the jump at the start, and is of order 1."""
    missing = []
    for steps in (64, 128):
        run = FrictionalVolume(weakening_patch(32, driver_impedance), steps, 5.0)
        sums = []
        while run.time < 5.0:
            run.advance()
            sums.append(run.energy() + run.heat)
        assert np.ptp(sums) < 1e-12 * run.heat
        missing.append(sums[-1] / run.heat)
    assert abs(missing[1]) < 2e-3
    assert missing[0] / missing[1] == pytest.approx(2.0, rel=0.1)


def test_steady_front_obeys_the_conditions_at_contact_and_driver() -> None:
    """No slip ahead and at the driver, the stress drop behind; slip grows towards drop h / G without end."""
    front = SteadyFront(2.0, 3.0, 5.0, 7.0)

    def displacement(xi: np.ndarray, x: float) -> np.ndarray:
        return 12.0 / (5.0 * np.pi) * np.arccos(np.exp(np.pi * (xi + 1j * x) / 6.0)).real - 2.0 * x / 5.0

    ahead, behind = np.linspace(0.1, 20.0, 50), -np.linspace(0.1, 20.0, 50)
    assert displacement(ahead + 0j, 0.0) == pytest.approx(np.zeros(50), abs=1e-14)
    assert displacement(np.append(ahead, behind), 3.0) == pytest.approx(np.zeros(100), abs=1e-14)
    assert (displacement(behind, 1e-6) - displacement(behind + 0j, 0.0)) / 1e-6 == pytest.approx(np.full(50, -0.4), rel=1e-4)
    speed = 0.8 * 7.0
    assert front.slip(-0.6 * behind, speed) == pytest.approx(displacement(behind + 0j, 0.0), rel=1e-12)
    assert (np.diff(front.slip(-0.6 * behind, speed)) > 0.0).all()
    assert front.slip(200.0, speed) == pytest.approx(front.final_slip) == 2.0 * 3.0 / 5.0
    assert front.slip(-1.0, speed) == 0.0


def test_inertia_of_a_front_is_the_energy_that_runs_along_with_it() -> None:
    """The integral of G u_xi^2 over the slab is (2 ln 2 / pi) h G0: rel 1e-5, by the midpoint rule, extrapolated."""

    def integral(count: int) -> float:
        size, angle = np.meshgrid(
            24.0 * (np.arange(6 * count) + 0.5) / (6 * count) - 12.0, (np.arange(count) + 0.5) * np.pi / 2 / count
        )
        place = np.exp(size + 1j * angle)
        slope = 2.0 / np.pi * (place / np.sqrt(1.0 - place**2)).real
        return float((slope**2).sum() * 4.0 / count * np.pi / 2 / count)

    front = SteadyFront(1.0, 1.0, 1.0, 1.0)
    assert 2.0 * integral(200) - integral(100) == pytest.approx(front.INERTIA * front.released_energy, rel=1e-5)


def test_speed_of_a_front_solves_its_equation_of_motion() -> None:
    front = SteadyFront(2.0, 3.0, 5.0, 7.0)
    energy = 0.6 * front.released_energy
    times = np.linspace(0.0, 4.0, 4001)
    speed = front.speed(times, energy, 2.0)
    slowness = np.sqrt(1.0 - (speed / 7.0) ** 2)
    missing = 1.0 - front.INERTIA * 3.0 / 49.0 * np.gradient(speed, times) / slowness**3
    assert missing[1:-1] == pytest.approx(np.full(3999, 0.6), abs=1e-5)
    assert speed[0] == pytest.approx(2.0, rel=1e-14)
    assert front.speed(1e9, energy, 2.0) == pytest.approx(7.0)
    assert front.speed(1e9, 1.5 * front.released_energy, 2.0) == 0.0
    assert linear_fracture_energy(0.4, 0.1) == pytest.approx(0.02)
