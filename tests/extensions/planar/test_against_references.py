"""The planar solver against two methods that share no code with it: the slab as a volume, and convolution over all history."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.solver import PlanarSolver
from tests.extensions.planar.convolution import convolution
from tests.extensions.planar.planar_cases import weakening_patch, weakening_plane
from tests.extensions.planar.planar_methods import PlanarCase, volume

DURATION = 7.0  # in units of h/c: three echoes


def slab_of(case: PlanarCase) -> ss.PlanarSlab:
    """The contact of a reference case, as a user would state it."""
    body = ss.ElasticSlab(case.density, case.wave_speed, case.thickness, 1.0, driver_impedance=case.driver_impedance)
    law = ss.friction.LinearSlipWeakening(static=1.1, dynamic=0.5, distance=0.8)
    shape = np.shape(case.initial_load)
    dynamic = case.friction.dynamic.reshape(shape)  # type: ignore[attr-defined]
    plane = {"width": case.length[1], "width_nodes": shape[1]} if len(shape) > 1 else {}
    return ss.PlanarSlab(
        ss.Problem(body, law, initial_load=1.0),
        nodes=shape[0],
        length=case.length[0],
        along={"initial.load": case.initial_load, "friction.dynamic": dynamic},
        barrier=case.locked,
        **plane,
    )


def slip_at_the_end(case: PlanarCase, duration: float, steps: int) -> np.ndarray:
    run = PlanarSolver(slab_of(case), duration, steps_per_round_trip=steps)
    while run.advance(10_000):
        pass
    assert run.time == pytest.approx(duration, rel=1e-9, abs=0.0)
    return np.asarray(run.now().slip)


@pytest.mark.slow
@pytest.mark.parametrize("driver", [inf, 0.0], ids=["rigid", "dead load"])
def test_a_patch_slips_as_in_the_volume(driver: float) -> None:
    """To 5e-4 of the largest slip, with errors that fall as the square of the step, or nearly: nodes begin and end to slip."""
    case = weakening_patch(driver_impedance=driver)
    truth = volume(case, DURATION, 512).slip[-1]
    errors = [np.abs(slip_at_the_end(case, DURATION, steps) - truth).max() / truth.max() for steps in (128, 256)]
    assert errors[1] < 5e-4
    assert errors[1] < 0.5 * errors[0]


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("driver", [inf, 0.3])
def test_a_patch_slips_as_convolution_says(driver: float) -> None:
    case = weakening_patch(driver_impedance=driver)
    truth = convolution(case, DURATION, 256).slip[-1]
    assert np.abs(slip_at_the_end(case, DURATION, 256) - truth).max() < 1e-3 * truth.max()


@pytest.mark.slow
def test_a_plane_slips_as_in_the_volume() -> None:
    case = weakening_plane()
    truth = volume(case, 5.0, 128).slip[-1]
    assert np.abs(slip_at_the_end(case, 5.0, 128) - truth).max() < 1e-3 * truth.max()


@pytest.mark.slow
def test_a_barrier_holds_as_in_the_volume() -> None:
    locked = np.abs(np.arange(64) / 64 * 4.0 - 2.0) > 1.0
    case = weakening_patch(locked=locked)
    truth = volume(case, DURATION, 512).slip[-1]
    found = slip_at_the_end(case, DURATION, 256)
    assert not found[locked].any()
    assert np.abs(found - truth).max() < 1e-3 * truth.max()
