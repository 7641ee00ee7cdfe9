"""Friction that falls as a power of slip, against closed forms: its curve, its slopes, and where a block stops under it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.friction import PowerSlipWeakening

STATIC, DYNAMIC = 0.6, 0.2
EXPONENTS = pytest.mark.parametrize("exponent", [1.0 / 3.0, 0.4, 1.0, 2.0])


@EXPONENTS
def test_friction_its_slope_and_its_halving_are_those_of_the_power(exponent: float) -> None:
    """With y = 1 + d / L the slope is -exponent (static - dynamic) / L y^(-exponent - 1)."""
    distance = 0.1
    law = PowerSlipWeakening(STATIC, DYNAMIC, distance, exponent)
    slip = np.array([0.0, 1e-6, 0.03, 0.7, 40.0])
    fall, y = STATIC - DYNAMIC, 1.0 + slip / distance
    assert law.coefficient(slip) == pytest.approx(DYNAMIC + fall * np.exp(-exponent * np.log(y)), rel=4e-15)
    slope = -exponent * fall / distance * np.exp(-(exponent + 1.0) * np.log(y))
    assert law.slopes(slip, 1.0)[0] == pytest.approx(slope, rel=1e-13)
    half = distance * (2.0 ** (1.0 / exponent) - 1.0)
    assert float(law.coefficient(half)) == pytest.approx(DYNAMIC + 0.5 * fall, rel=1e-14)


def test_the_form_with_an_initial_slope_is_the_law_over_exponent_times_its_distance() -> None:
    """Chambon et al.: the curve begins as linear weakening over Dc does, and has lost about half of its fall at 2 Dc."""
    dc, exponent = 1e-4, 0.4
    law = PowerSlipWeakening(STATIC, DYNAMIC, exponent * dc, exponent)
    assert float(law.slopes(0.0, 1.0)[0]) == pytest.approx(-(STATIC - DYNAMIC) / dc, rel=1e-14)
    lost = (STATIC - float(law.coefficient(2.0 * dc))) / (STATIC - DYNAMIC)
    assert lost == pytest.approx(1.0 - 6.0**-0.4, rel=1e-14)
    assert 0.45 < lost < 0.55


def test_the_work_of_weakening_grows_as_the_power_two_thirds_of_slip_with_the_exponent_of_thermal_pressurisation() -> None:
    """The work above the friction reached, by quadrature, at a million and at eight million distances: four times as much."""
    law = PowerSlipWeakening(STATIC, DYNAMIC, 1e-6, 1.0 / 3.0)

    def work(slip: float) -> float:
        at = np.concatenate(([0.0], np.geomspace(1e-9, slip, 200_001)))
        return float(np.trapezoid(law.coefficient(at) - law.coefficient(slip), at))

    assert work(8.0) / work(1.0) == pytest.approx(4.0, rel=5e-4)


@EXPONENTS
def test_a_block_stops_where_the_work_of_its_spring_is_spent(exponent: float) -> None:
    """Load - K u does as much work as S mu: the integral of the power is a closed form. Slip to 1e-9."""
    block = ss.SpringBlock(mass=2.0, stiffness=30.0, normal_force=100.0)
    law, excess = PowerSlipWeakening(STATIC, DYNAMIC, 0.1, exponent), 1.0
    run = ss.simulate(ss.Problem(block, law, initial_excess=excess), 10.0)
    load = STATIC * block.normal_force + excess

    def gained(slip: float) -> float:
        y = 1.0 + slip / law.distance
        power = np.log(y) if exponent == 1.0 else (y ** (1.0 - exponent) - 1.0) / (1.0 - exponent)
        resisted = DYNAMIC * slip + (STATIC - DYNAMIC) * law.distance * power
        return float(load * slip - 0.5 * block.stiffness * slip**2 - block.normal_force * resisted)

    stop = brentq(gained, 1e-3, 10.0, xtol=1e-14, rtol=1e-14)
    assert run.events.slip[0] == pytest.approx(stop, rel=1e-9)


def test_members_of_a_sweep_over_the_exponent_are_the_runs_alone() -> None:
    block = ss.SpringBlock(mass=2.0, stiffness=30.0, normal_force=100.0)
    problem = ss.Problem(block, PowerSlipWeakening(STATIC, DYNAMIC, 0.1, 0.4), initial_excess=1.0)
    values = [1.0 / 3.0, 0.5, 2.5]
    swept = ss.sweep(problem, {"friction.exponent": values}, duration=5.0, quantities=["slip"])
    alone = [float(ss.simulate(problem.parameters["friction.exponent"].put(one), 5.0).slip(5.0)) for one in values]
    assert swept["slip"].to_numpy() == pytest.approx(alone, rel=1e-12)


def test_an_exponent_that_does_not_weaken_is_refused() -> None:
    with pytest.raises(ss.InputError, match=r"exponent must be greater than 0 .*, got 0"):
        PowerSlipWeakening(STATIC, DYNAMIC, 0.1, 0.0)
