"""A body whose damping is not its impedance is solved rightly, or refused by name, by whatever solves the motion of bodies."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.bodies import BODIES
from stickslip.problem.limits import leaps_over
from tests.core.problem.bodies.dashpot import DROP, OWN, PROBLEM, SLAB, WEAKENING


def test_no_body_has_one_unless_it_is_given() -> None:
    plain = (
        ss.ElasticSlab(2800, 3500, 1e4, 1e8),
        ss.SoilColumn(1900, 160, 20.0, 4e5, 0.05),
        ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0),
        ss.RotatingBlock(1.0, 1e3, 10.0, damping=2.0),
        ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0).on_belt(),
        ss.RotatingBlock(1.0, 1e3, 10.0, damping=2.0).on_belt(),
        ss.PositionLoop(1.0, 1e3, 1e2, 10.0),
        ss.RotaryLoop(1.0, 1e3, 1e2, 10.0),
        ss.TorsionalString(2e3, 7850.0, 8e10, polar_moment=1e-5, normal_torque=10.0),
        ss.SectionedString([1e2, 2e3], [0.17, 0.13], [0.07, 0.11], [7850.0] * 2, [8e10] * 2, normal_torque=10.0),
        ss.LayeredSlab([1e3, 9e3], [2800, 2800], [1750, 3500], 1e8),
        ss.TwoSlabs([1e3], [2800], [1750], [9e3], [2800], [3500], 1e8),
    )
    assert {type(body) for body in plain} == set(BODIES.values())
    assert not any(body.dashpot for body in plain)
    for body in plain[:1] + plain[8:]:
        given = replace(body, contact_damping=0.25 * body.impedance)  # type: ignore[type-var] # all are dataclasses
        assert given.damping == pytest.approx(1.25 * body.impedance, rel=1e-15)
        assert given.equivalent_block().damping == pytest.approx(0.25 * body.impedance, rel=1e-15)
    assert OWN.dashpot == SLAB.dashpot == 4.9e6


def test_the_exact_solver_slips_at_the_stress_drop_over_the_damping() -> None:
    """(Z + D) v = S (muS - muD) + excess for the first round trip."""
    run = ss.simulate(PROBLEM, 5.0)
    assert float(run.slip_rate(1.0)) == pytest.approx((DROP + 1e6) / SLAB.damping, rel=1e-13, abs=0.0)


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("law", [ss.friction.HyperbolicRate(0.8, 0.6, 0.2), ss.friction.LinearSlipWeakening(0.8, 0.6, 2.0)])
@pytest.mark.parametrize("share", [0.0, 0.4, np.inf], ids=["dead load", "leaky", "rigid"])
def test_waves_keep_the_impedance_and_the_contact_equation_has_both(law: ss.friction.FrictionLaw, share: float) -> None:
    """(Z + D) v + S mu = load within 1e-9 of the load in slip, D times the integral of v^2 is damped, and all balances to 1e-12.

    The trapezoidal rule with 40 001 points makes an error of 1e-6 of that integral.
    """
    slab = replace(SLAB, driver_impedance=share * SLAB.impedance)
    run = ss.simulate(ss.Problem(slab, law, pull_rate=0.0, initial_excess=2e6), 30.0)
    times = np.linspace(0.0, run.duration, 40_001)
    rate, at = run.slip_rate(times), run.history.find(times, "right")
    moving = rate > 0.0
    assert moving.sum() > 1000
    load = run.history.excess(at) + run.problem.strength
    friction = slab.normal_stress * law.coefficient(run.slip(times), rate)
    assert (slab.damping * rate + friction)[moving] == pytest.approx(load[moving], rel=1e-9)
    taken, energy = slab.dashpot * np.trapezoid(rate**2, times), run.energy(times[-1:])
    assert float(energy.damped[0]) == pytest.approx(taken, rel=1e-4)
    assert abs(float(energy.balance[0])) < 1e-12 * taken


def test_files_do_not_take_it_for_the_body_whose_kind_it_has(tmp_path: Path) -> None:
    ss.simulate(replace(PROBLEM, body=OWN), 1.0).to_netcdf(tmp_path / "run.nc")
    with pytest.raises(ss.InputError, match=r"\[body\] kind 'SlabWithDashpot' is unknown"):
        ss.open_solution(tmp_path / "run.nc")


def test_runs_do_not_leap_by_sums_that_hold_for_waves_alone() -> None:
    creeping = ss.Problem(SLAB, WEAKENING, pull_rate=1e-9, initial_excess=0.0)
    assert leaps_over(creeping) == ""
    with pytest.raises(ss.InputError, match="leaps over creep need a contact that waves alone damp"):
        ss.simulate(creeping, 1.0, creep_rtol=1e-6)
    law = ss.friction.RateAndState(**ss.friction.RateAndState.example)
    assert leaps_over(ss.Problem(SLAB, law, pull_rate=1e-9, initial_load=0.6e8, initial_state=1e6)) == "steady sliding"
    plain = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
    assert leaps_over(ss.Problem(plain, law, pull_rate=1e-9, initial_load=0.6e8, initial_state=1e6)) == "slow sliding"


def test_leaps_over_steady_sliding_know_the_damping() -> None:
    """A run with leaps and one without end at the same slip, to 1e-9 of it."""
    law = ss.friction.VelocityStrengthening(0.6, 0.01, 1e-6)
    problem = ss.Problem(SLAB, law, pull_rate=1e-2, initial_excess=1e5)
    leaping, plain = (ss.simulate(problem, 8000.0, creep_rtol=tolerance) for tolerance in (None, 0.0))
    assert len(leaping.history) < 0.5 * len(plain.history)
    times = np.array([4000.0, 8000.0])
    assert leaping.slip(times) == pytest.approx(plain.slip(times), rel=1e-9, abs=0.0)
