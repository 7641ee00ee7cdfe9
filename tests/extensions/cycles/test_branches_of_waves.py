"""Branches of cycles of strings: folds, edges and corners beside long runs, and multipliers from the disturbances of a return."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.cycles.branch import BranchOfCycles
from stickslip.extensions.cycles.edges import CycleEdge
from stickslip.extensions.cycles.reaching import first_place, range_of
from stickslip.extensions.cycles.section import onsets
from stickslip.extensions.cycles.waves.ends import end_of_rests
from stickslip.solution import Solution

F = ss.friction
WEAK = F.ExponentialStribeck(0.8, 0.7, 1.1)
"""Friction that falls by an eighth: a string under it comes to rest in the softest way."""
RISING = F.FromExpression("0.5 + 0.3*exp(-v/r) + 0.01*v", {"r": 1.1})


def string(pull: float, law: ss.friction.FrictionLaw) -> ss.Problem:
    """Return the bundled drill string under a law, behind a drive of four times its impedance, at a pull rate (rad/s)."""
    problem = ss.load_scenario("drill-string").problem
    body = replace(problem.body, driver_impedance=4.0 * problem.body.impedance)
    return replace(problem, body=body, friction=law, pull_rate=pull)


@cache
def branch() -> BranchOfCycles:
    return ss.studies.follow(ss.studies.cycle(string(8.225, WEAK), near=90.0), "pull_rate", to=8.3, steps=2)


def run_beside(edge: CycleEdge, pull: float, law: ss.friction.FrictionLaw, periods: int) -> Solution:
    """Return a run at a pull rate (rad/s) that begins with the wave of the cycle next to an edge."""
    section = edge.orbit.section.with_problem(string(pull, law))
    run, code = section.run_from(edge.orbit.closed.start, periods * edge.orbit.period)
    solution: Solution = run.solution(code)
    return solution


def test_cycles_of_a_string_turn_back_where_a_multiplier_is_one_and_runs_find_none_beyond() -> None:
    """The multiplier, which the search for the fold does not use, to 1e-6; a run below has the period of a cycle, to 1e-7."""
    fold = branch().edges[0]
    assert fold.name == "fold of cycles"
    assert fold.orbit.multipliers[0] == pytest.approx(1.0, abs=1e-6)
    below, above = (run_beside(fold, fold.value + off, WEAK, 60) for off in (-1e-3, 1e-3))
    settled = ss.studies.cycle(string(fold.value - 1e-3, WEAK), near=90.0)
    assert settled.stable
    assert np.diff(onsets(below.history).time)[-3:] == pytest.approx(np.full(3, settled.period), rel=1e-7)
    assert len(onsets(above.history).time) <= 1  # that of the start


def test_cycles_with_and_without_rest_of_a_string_are_one_branch() -> None:
    """Stable with rest, then unstable with rest down to where stick is lost, then without rest; the way back ends at the start."""
    points = branch().points
    fold, loss = (one.value for one in branch().edges)
    assert [one.name for one in branch().edges] == ["fold of cycles", "loss of stick"]
    assert loss < fold
    after = [one for one in points if not one.sticks]
    assert len(after) >= 2
    assert points[-len(after) :] == tuple(after)
    assert all(abs(one.multipliers[0]) > 1.0 for one in after)
    assert after[0].measures.least_rate < 1e-3 < after[-1].measures.least_rate
    assert after[-1].value == pytest.approx(8.225, rel=1e-12)
    assert after[0].measures.period == pytest.approx(points[-len(after) - 1].measures.period, rel=1e-4)


def test_where_stick_is_lost_rest_and_least_slip_rate_vanish_at_one_value() -> None:
    """Cycles without rest say where their least slip rate would be 0: the last cycle with rest is within 1e-6 of it."""
    edge = branch().edges[1]
    assert edge.orbit.section.at_onset
    last = [one for one in branch().points if one.sticks][-1]
    assert last.measures.stick_share < 1e-3
    assert last.value == pytest.approx(edge.value, rel=1e-6)


def test_where_steps_along_a_branch_become_short_the_arrest_of_long_runs_begins_to_move_another_way() -> None:
    """Lines through the times of arrest in runs on both sides meet at the edge, to 5e-6 of the pull rate.

    There slip is about to come to rest a moment earlier, which is grazed. Next to it two kinks of the wave are nearer to each other
    than a mesh tells apart, so that steps lead a little beyond it.
    """
    cycle = ss.studies.cycle(string(8.0551, RISING), near=90.0)
    parameter, begin, _ = range_of(cycle, "pull_rate", 14.0)
    end = end_of_rests(*first_place(cycle, parameter, (begin, 14.0)))
    assert end.edge is not None
    lines = []
    for offs in ((-2e-4, -1e-4), (1e-4, 2e-4)):
        pulls, arrests = [end.edge.value + off for off in offs], []
        for pull in pulls:
            history = run_beside(end.edge, pull, RISING, 60).history
            modes, begun = history.store.mode, onsets(history).time[-2]
            stops = history.start[1:][(modes[:-1] == 1) & (modes[1:] == 0)]
            arrests.append(float(stops[stops > begun][0] - begun))
        lines.append(np.polyfit(np.array(pulls) - end.edge.value, arrests, 1))
    assert lines[0][0] > 0.0 > lines[1][0]
    meet = (lines[1][1] - lines[0][1]) / (lines[0][0] - lines[1][0])
    assert abs(meet) < 5e-6 * end.edge.value


@pytest.mark.slow
def test_a_branch_of_a_string_leads_from_stick_slip_back_to_steady_sliding() -> None:
    """The edge in steady sliding is where small disturbances of it begin to grow, and there the multiplier of small cycles is 1."""
    found = ss.studies.follow(ss.studies.cycle(string(7.45, WEAK), near=90.0), "pull_rate", to=8.3, steps=2)
    assert [one.name for one in found.edges] == ["fold of cycles", "loss of stick", "steady sliding"]
    hopf = found.edges[2].value
    growths = [ss.studies.steady(string(hopf + off, WEAK)).slidings[-1].growth for off in (-1e-4, 1e-4)]
    assert growths[0] > 0.0 > growths[1]
    assert abs(found.points[-2].multipliers[0]) == pytest.approx(1.0, abs=1e-3)


def heavy_slab(pull: float) -> ss.Problem:
    """Return a slab with a mass under Coulomb friction behind a drive of four times its impedance, at a pull rate (m/s)."""
    slab = ss.ElasticSlab(2800, 3500, 655.874, 52.6784e6, driver_impedance=39.805e6, contact_mass=2.13428e6)
    return ss.Problem(slab, F.Coulomb(0.737176, 0.400326), pull_rate=pull, initial_load=0.0)


def period_of_slab(pull: float) -> float:
    return float(ss.studies.cycle(heavy_slab(pull)).period)


def test_a_branch_goes_on_behind_the_corner_where_the_periods_of_cycles_found_one_by_one_bend() -> None:
    """Lines through two periods on each side meet there, to 1e-6; the first cycle behind it is that found alone, to 1e-9."""
    begin = ss.studies.cycle(heavy_slab(1.00247))
    parameter, pull, to = range_of(begin, "pull_rate", 3.0)
    end = end_of_rests(*first_place(begin, parameter, (pull, to)))
    assert end.edge is not None
    assert end.onward is not None
    assert end.edge.name == "corner"
    before, behind = (1.00246, 1.00247), (1.00249, 1.0025)
    sides = [np.polyfit(np.array(two) - 1.00248, [period_of_slab(one) for one in two], 1) for two in (before, behind)]
    assert end.edge.value == pytest.approx(1.00248 + float(np.roots(sides[0] - sides[1])[0]), abs=1e-6)
    first = end.onward[1]
    assert first.value > end.edge.value
    assert first.orbit.period == pytest.approx(period_of_slab(first.value), rel=1e-9)


def test_hysteresis_to_where_a_branch_is_given_up_reaches_at_least_so_far() -> None:
    """Behind the corner a jump of the period, by 1.3 % within 2e-5 m/s, ends the branch, and that is said once."""
    given_up = ss.studies.follow(ss.studies.cycle(heavy_slab(1.0151)), "pull_rate", to=3.0, steps=6)
    assert len(given_up.edges) == 1
    assert period_of_slab(given_up.edges[0].value + 1e-5) < 0.99 * given_up.points[-1].measures.period
    assert "hysteresis between loading.pull_rate = 1.0151 m/s and at least 1.0151" in repr(given_up)
