"""Cycles of rigid bodies, against closed forms, an own monodromy matrix, own integrations, and differences of runs."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from tests.extensions.cycles.problems import (
    DAMPING,
    DISTANCE,
    DYNAMIC,
    FALL,
    HEAVY,
    LOWEST,
    MASS,
    NORMAL,
    OVER,
    REFERENCE,
    SLOW,
    SOFT,
    STATIC,
    STIFFNESS,
    A,
    B,
    coulomb,
    rate_and_state,
    stribeck,
)


@pytest.mark.parametrize("pull", [1e-3, 0.1, 1.0])
def test_a_block_under_coulomb_friction_repeats_itself_as_the_closed_form_says(pull: float) -> None:
    """Slip lasts 2 (pi - atan(a / V)) / omega with a = (muS - muD) S / sqrt(K m); each rest makes up for it. To 1e-12."""
    found = ss.studies.cycle(coulomb(pull))
    kick = (STATIC - DYNAMIC) * NORMAL / math.sqrt(STIFFNESS * MASS)
    slips = 2.0 * (math.pi - math.atan2(kick, pull)) / math.sqrt(STIFFNESS / MASS)
    slip = pull * slips + 2.0 * (STATIC - DYNAMIC) * NORMAL / STIFFNESS
    assert found.period == pytest.approx(slip / pull, rel=1e-12)
    assert found.slip == pytest.approx(slip, rel=1e-12)
    assert found.greatest_rate == pytest.approx(pull + math.hypot(pull, kick), rel=1e-12)
    assert (found.least_rate, found.stable, found.multipliers.tolist()) == (0.0, True, [0.0])
    assert found.stick_share == pytest.approx(1.0 - slips * pull / slip, rel=1e-11)
    assert found.greatest_traction == pytest.approx(STATIC * NORMAL, rel=1e-12)
    assert found.run.slip(found.period) == pytest.approx(slip, rel=1e-12)


def own_stribeck(pull: float) -> Any:
    """Return the equation of motion, with the disturbance of load and slip rate."""

    def paces(_: float, y: Any) -> list[float]:
        load, rate = y[:2]
        falls = FALL * math.exp(-rate / OVER)
        slope = -(DAMPING - NORMAL * falls / OVER) / MASS
        found = [STIFFNESS * (pull - rate), (load - DAMPING * rate - NORMAL * (LOWEST + falls)) / MASS]
        for n in (2, 4):
            found += [-STIFFNESS * y[n + 1], y[n] / MASS + slope * y[n + 1]]
        return found

    return paces


@pytest.mark.parametrize("pull", [0.16, 0.18, 0.2])
def test_the_unstable_cycle_under_a_stribeck_law_is_that_of_an_own_integration(pull: float) -> None:
    """Between the rate at which steady sliding becomes stable and that at which stick ends. Period to 1e-9, multiplier to 1e-7."""
    steady = DAMPING * pull + NORMAL * (LOWEST + FALL * math.exp(-pull / OVER))
    share = {0.16: 0.45, 0.2: 0.8, 0.18: 0.7}[pull]
    load = steady + share * pull * math.sqrt(STIFFNESS * MASS)
    found = ss.studies.cycle(stribeck(pull, initial_rate=pull, initial_load=load), near=0.7)
    assert found.stable is False
    assert found.stick_share == 0.0
    assert found.least_rate > 0.0
    start = [found.orbit.place[0], pull, 1.0, 0.0, 0.0, 1.0]
    end = solve_ivp(own_stribeck(pull), (0.0, found.period), start, method="DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
    assert end[:2] == pytest.approx(start[:2], rel=1e-9)
    paces = own_stribeck(pull)(0.0, end)[:2]
    assert found.multipliers[0].real == pytest.approx(end[2] - paces[0] / paces[1] * end[3], rel=1e-7)


def own_rate_and_state(evolution: str) -> Any:
    """Return the equation of load, slip rate and log(theta V0 / D), and of its disturbances, with the regularised law."""

    def paces(_: float, y: Any) -> Any:
        load, rate, log = y[:3]
        argument = rate / (2.0 * 1e-6) * math.exp((REFERENCE + B * log) / A)
        mu, root = A * math.asinh(argument), argument / math.sqrt(1.0 + argument**2)
        theta_pace = (1e-6 * math.exp(-log) - rate) / DISTANCE
        of_slip = -(rate / DISTANCE) * (math.log(rate / 1e-6) + log)
        slopes = np.array(
            [
                [0.0, -SOFT, 0.0],
                [1.0 / HEAVY, -NORMAL * A * root / rate / HEAVY, -NORMAL * B * root / HEAVY],
                [0.0, -1.0 / DISTANCE, -1e-6 * math.exp(-log) / DISTANCE]
                if evolution == "ageing"
                else [0.0, -(math.log(rate / 1e-6) + log + 1.0) / DISTANCE, -rate / DISTANCE],
            ]
        )
        own = [SOFT * (SLOW - rate), (load - NORMAL * mu) / HEAVY, theta_pace if evolution == "ageing" else of_slip]
        return np.concatenate([own, (slopes @ y[3:].reshape(3, 3)).ravel()])

    return paces


@pytest.mark.parametrize("evolution", ["ageing", "slip"])
def test_multipliers_under_rate_and_state_friction_are_those_of_an_own_monodromy_matrix(evolution: str) -> None:
    """Past the critical stiffness of Gu et al. 1984; the matrix by DOP853 at 1e-12, multipliers to 1e-6, closure to 1e-8."""
    found = ss.studies.cycle(rate_and_state(evolution))
    problem = found.problem
    log = math.log(problem.initial_state * 1e-6 / DISTANCE)
    start = np.concatenate([[problem.initial_load, SLOW, log], np.eye(3).ravel()])
    scale = [1.0, SLOW, 1.0, *np.outer([1.0, SLOW, 1.0], [1.0, 1.0 / SLOW, 1.0]).ravel()]
    paces = own_rate_and_state(evolution)
    end = solve_ivp(paces, (0.0, found.period), start, method="DOP853", rtol=1e-12, atol=1e-13 * np.array(scale)).y[:, -1]
    assert end[:3] == pytest.approx(start[:3], rel=1e-8)
    grown = np.array(scale[3:]).reshape(3, 3) ** -1 * end[3:].reshape(3, 3)
    own = sorted(np.linalg.eigvals(grown).real)
    assert own[-1] == pytest.approx(1.0, abs=1e-6)
    assert found.multipliers[0].real == pytest.approx(own[-2], rel=1e-6)
    assert found.stable is True


def test_the_derivative_of_the_return_is_that_of_differences_of_runs() -> None:
    """Central differences of 1e-4 of the extent, to 1e-5 of its largest entries."""
    orbit = ss.studies.cycle(rate_and_state()).orbit
    columns = []
    for n, extent in enumerate(orbit.extent):
        step = np.zeros(2)
        step[n] = 1e-4 * extent
        ends = [orbit.section.returned(orbit.place + sign * step, orbit.period).end for sign in (1.0, -1.0)]
        columns.append((ends[0] - ends[1]) / (2.0 * step[n]))
    scaled = orbit.extent / orbit.extent[:, None]
    assert orbit.closed.slopes() * scaled == pytest.approx(np.array(columns).T * scaled, abs=1e-5)


@pytest.mark.parametrize("near", [300.0, None])
def test_a_motion_that_decays_slowly_to_steady_sliding_is_no_cycle(near: float | None) -> None:
    """At 1.0001 times the critical stiffness (Gu et al. 1984) what is left of it loses 1e-4 of itself in a period."""
    problem = rate_and_state()
    stiff = ss.SpringBlock(HEAVY, 1.0001 * SOFT / 0.9, NORMAL)
    disturbed = replace(problem, body=stiff, initial_rate=1.01 * SLOW, initial_state="steady", initial_load=6.0)
    with pytest.raises(ss.InputError, match="leads to steady sliding: no other cycle is near this run"):
        ss.studies.cycle(disturbed, near=near)
