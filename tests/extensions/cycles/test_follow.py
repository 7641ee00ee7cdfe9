"""Branches of cycles: their edges against steady sliding, closed forms, searches by runs, and what the branches themselves say."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from tests.extensions.cycles.problems import DAMPING, DISTANCE, FALL, HEAVY, NORMAL, OVER, SLOW, A, B, rate_and_state, stribeck


def test_a_branch_loses_stick_turns_back_unstable_and_ends_in_steady_sliding() -> None:
    """A subcritical Hopf point: it lies where S mu'(V) = -c, in closed form, and stick ends where `find` says: both to 1e-9."""
    start = ss.studies.cycle(stribeck(0.2, initial_load=0.0))
    branch = ss.studies.follow(start, "pull_rate", to=0.5, steps=10)
    hopf = OVER * math.log(NORMAL * FALL / (OVER * DAMPING))
    back = [one for one in branch.points if not one.sticks]
    assert [edge.name for edge in branch.edges] == ["loss of stick"]
    assert back, "the branch without rest follows"
    assert min(one.value for one in back) == pytest.approx(0.2, rel=1e-12), "back to where it began"
    whole = ss.studies.follow(ss.studies.cycle(stribeck(0.1, initial_load=0.0)), "pull_rate", to=0.5, steps=10)
    assert [edge.name for edge in whole.edges] == ["loss of stick", "steady sliding"]
    lost, steady = whole.edges
    assert steady.value == pytest.approx(hopf, rel=1e-9)
    assert steady.value == pytest.approx(ss.studies.steady(start.problem).changes[0].pull_rate, rel=1e-9)
    assert lost.value == pytest.approx(branch.edges[0].value, rel=1e-9), "wherever the branch begins"
    found = ss.studies.find(stribeck(0.2, initial_load=0.0), "pull_rate", 0.30222, 0.30223, within=1e-10, duration=2.0)
    assert found.low * (1.0 - 1e-9) <= lost.value <= found.high * (1.0 + 1e-9)
    assert {one.stable for one in whole.points if one.sticks and not one.edge} == {True}
    assert {one.stable for one in back} == {False}
    lost_too = min(back, key=lambda one: abs(one.value - lost.value))
    assert lost_too.measures.period == pytest.approx(lost.orbit.period, rel=1e-4)


def test_the_two_cycles_at_one_value_are_those_that_runs_come_to_and_part_at() -> None:
    """Runs that start 1 % inside and outside of the unstable cycle come to steady sliding and to stick-slip."""
    load = DAMPING * 0.2 + NORMAL * (0.3 + FALL * math.exp(-0.2 / OVER))
    unstable = ss.studies.cycle(stribeck(0.2, initial_rate=0.2, initial_load=load + 5.0), near=0.7)
    assert unstable.stable is False
    ends = []
    for share in (0.99, 1.01):
        start = load + share * (float(unstable.orbit.place[0]) - load)
        run = ss.simulate(stribeck(0.2, initial_rate=0.2, initial_load=start), 20.0)
        ends.append(bool((run.history.store.mode[len(run.history) // 2 :] == 0).any()))
    assert ends == [False, True]


@pytest.mark.slow
def test_a_branch_under_rate_and_state_friction_ends_at_the_critical_stiffness() -> None:
    """K = S (b - a) / D (1 + m V^2 / (S a D)) (Gu et al. 1984, with inertia), to 1e-9; the amplitude falls as a square root."""
    critical = NORMAL * (B - A) / DISTANCE * (1.0 + HEAVY * SLOW**2 / (NORMAL * A * DISTANCE))
    branch = ss.studies.follow(ss.studies.cycle(rate_and_state()), "body.stiffness", to=1.1 * critical, steps=10)
    assert [edge.name for edge in branch.edges] == ["steady sliding"]
    assert branch.edges[0].value == pytest.approx(critical, rel=1e-9)
    near = [one for one in branch.points if not one.edge and one.value > 0.9999 * critical]
    shares = [one.measures.amplitude**2 / (critical - one.value) for one in near]
    assert shares == pytest.approx([shares[-1]] * len(shares), rel=1e-2)
    assert {one.stable for one in branch.points} == {True}


def small_cycle(evolution: str, share: float) -> tuple[float, float]:
    """Return the coefficient of |z|^2 z in the normal form at the Hopf point, and the amplitude over the pull rate next to it.

    Time in D / V, load in S a, slip rate in V; x is ln(theta V / D), and inertia m V^2 / (S a D) is 3. Kuznetsov 2004, Elements of
    Applied Bifurcation Theory, eq. 5.63.
    """
    inertia, critical = 3.0, (B / A - 1.0) * (1.0 + 3.0)

    def slopes(stiffness: float) -> Any:
        return np.array([[0.0, -stiffness, 0.0], [1.0 / inertia, -1.0 / inertia, -B / A / inertia], [0.0, -1.0, -1.0]])

    def second(a: Any, b: Any) -> Any:
        of_state = a[2] * b[2] if evolution == "ageing" else -a[1] * b[1] - a[1] * b[2] - a[2] * b[1]
        return np.array([0.0, a[1] * b[1] / inertia, of_state])

    def third(a: Any, b: Any, c: Any) -> Any:
        of_state = -a[2] * b[2] * c[2] if evolution == "ageing" else a[1] * b[1] * c[1]
        return np.array([0.0, -2.0 * a[1] * b[1] * c[1] / inertia, of_state])

    matrix = slopes(critical)
    values, right = np.linalg.eig(matrix)
    others, left = np.linalg.eig(matrix.T)
    q, p, omega = right[:, values.imag.argmax()], left[:, others.imag.argmin()], values.imag.max()
    p = p / np.conj(np.vdot(p, q))
    still, twice = np.linalg.solve(matrix, second(q, q.conj())), np.linalg.solve(2j * omega * np.eye(3) - matrix, second(q, q))
    cubic = 0.5 * np.vdot(p, third(q, q, q.conj()) - 2.0 * second(q, still) + second(q.conj(), twice)).real
    growth = np.linalg.eigvals(slopes(share * critical)).real.max()
    return float(cubic), float(2.0 * abs(q[1]) * math.sqrt(abs(growth / cubic)))


@pytest.mark.parametrize("evolution", ["ageing", "slip"])
def test_cycles_past_the_critical_stiffness_have_the_size_and_the_stability_of_the_normal_form(evolution: str) -> None:
    """The coefficient of Lyapunov is below 0: cycles are stable, and where steady sliding is not. Sizes to 1e-3, at 0.999 K."""
    cubic, amplitude = small_cycle(evolution, 0.999)
    assert cubic < 0.0
    problem = rate_and_state(evolution)
    nearer = replace(problem, body=replace(problem.body, stiffness=0.999 * problem.body.stiffness / 0.9))
    found = ss.studies.cycle(nearer)
    assert found.stable is True
    assert found.amplitude == pytest.approx(amplitude * SLOW, rel=1e-3)
    assert ss.studies.steady(nearer).slidings[0].growth > 0.0


def two_states(stiffness: float) -> ss.Problem:
    """Return the block of Gu et al. 1984, section 5 (b1 = a, b2 = 0.84 a, L1 = 0.048 L2, slip law), nearly without inertia."""
    law = ss.friction.TwoStateRateAndState(
        reference=0.6, a=A, b=A, distance=DISTANCE, second_b=0.84 * A, second_distance=DISTANCE / 0.048, evolution="slip"
    )
    return ss.Problem(ss.SpringBlock(100.0, stiffness, NORMAL), law, pull_rate=SLOW)


def test_the_period_doubles_under_two_states_and_the_doubled_cycle_is_there_beyond_the_edge() -> None:
    """The multiplier is -1 at the edge to 1e-6; beyond it the cycle is unstable, and a stable one has about twice its period."""
    critical = 802.799465
    branch = ss.studies.follow(ss.studies.cycle(two_states(0.9 * critical)), "body.stiffness", to=0.85 * critical, steps=3)
    assert [edge.name for edge in branch.edges] == ["period doubling"]
    edge = branch.edges[0]
    assert edge.orbit.multipliers[0].real == pytest.approx(-1.0, abs=1e-6)
    assert 0.86 < edge.value / critical < 0.87
    stable = {one.value > edge.value: one.stable for one in branch.points if not one.edge}
    assert stable == {True: True, False: False}
    doubled = ss.studies.cycle(two_states(0.86 * critical))
    assert doubled.stable is True
    assert doubled.period == pytest.approx(2.0 * edge.orbit.period, rel=0.03)


@pytest.mark.slow
def test_edges_from_both_sides_of_a_grazed_rest_agree() -> None:
    """Stick is lost where unstable cycles without rest begin to rest: by bisection of runs, and by the least rate, to 1e-9."""
    lost = ss.studies.follow(ss.studies.cycle(stribeck(0.28, initial_load=0.0)), "pull_rate", to=0.35, steps=5).edges[0]
    load = DAMPING * 0.2 + NORMAL * (0.3 + FALL * math.exp(-0.2 / OVER))
    unstable = ss.studies.cycle(stribeck(0.2, initial_rate=0.2, initial_load=load + 5.0), near=0.7)
    up = ss.studies.follow(unstable, "pull_rate", to=0.5, steps=10)
    assert up.edges[0].name == "first stick"
    assert up.edges[0].value == pytest.approx(lost.value, rel=1e-9)
    assert any(one.sticks and one.value < 0.3 for one in up.points), "stick-slip follows, downwards"


def swinging(s1: float, amplitude: float) -> ss.Problem:
    """Return a block under friction that falls, rises and falls again around the pull rate, with less swing than ends in rest."""
    law = ss.friction.FromExpression(
        "0.5 + s1*(v/v0-1) - s3*(v/v0-1)**3 + s5*(v/v0-1)**5", {"s1": s1, "s3": 0.2, "s5": 0.4, "v0": "1 m/s"}
    )
    load = 0.5 * NORMAL + amplitude * 1e3**0.5
    return ss.Problem(ss.SpringBlock(1.0, 1e3, NORMAL), law, pull_rate=1.0, initial_rate=1.0, initial_load=load)


@pytest.mark.slow
def test_a_branch_goes_around_a_fold_of_cycles_and_comes_back_unstable() -> None:
    """By averages over a period the fold lies at s1 = 9 s3^2 / (40 s5), where the amplitude is sqrt(3 s3 / (5 s5)): both to 1e-4.

    On the other side the branch ends where s1 = 0, exactly; the fold is the same from two starts to 1e-9.
    """
    folds = []
    for start in (0.005, -0.005):
        branch = ss.studies.follow(ss.studies.cycle(swinging(start, 0.85), near=4.0), "friction.parameters.s1", to=0.05, steps=5)
        folds.append(branch.edges[0])
    assert {edge.name for edge in folds} == {"fold of cycles"}
    assert folds[0].value == pytest.approx(9.0 * 0.2**2 / (40.0 * 0.4), rel=1e-4)
    assert folds[0].value == pytest.approx(folds[1].value, rel=1e-9)
    assert folds[0].orbit.multipliers[0].real == pytest.approx(1.0, abs=1e-6)
    at_fold = next(one for one in branch.points if one.edge == "fold of cycles")
    assert at_fold.measures.amplitude == pytest.approx((3.0 * 0.2 / (5.0 * 0.4)) ** 0.5, rel=1e-3)
    assert branch.edges[1].name == "steady sliding"
    assert branch.edges[1].value == pytest.approx(0.0, abs=1e-11)
    stable = [one.stable for one in branch.points if not one.edge]
    assert (stable[0], stable[-1]) == (True, False)


FREQUENCY, COUPLED = 20.0, 0.01


def two_frequencies(zeta: float, coupled: float) -> ss.Problem:
    """Return the block of `swinging` with two states that swing by themselves, damped by `zeta`, and change friction a little."""
    law = ss.friction.FromExpression(
        "0.5 + s1*(v/v0-1) - s3*(v/v0-1)**3 + s5*(v/v0-1)**5 + coupled*y",
        {"s1": 0.02, "s3": 0.2, "s5": 0.4, "v0": "1 m/s", "coupled": coupled, "zeta": zeta, "omega": f"{FREQUENCY} 1/s"},
        evolution="dy/dt = omega*z; dz/dt = -omega*(y + zeta*z) + omega*(v/v0 - 1)",
    )
    start: dict[str, Any] = {"initial_rate": 1.0, "initial_load": 0.5 * NORMAL + 0.85 * 1e3**0.5}
    return ss.Problem(ss.SpringBlock(1.0, 1e3, NORMAL), law, pull_rate=1.0, initial_state=0.5, initial_second_state=0.1, **start)


def own_monodromy(zeta: float, start: Any, period: float) -> Any:
    """Return end and matrix of disturbances of load, slip rate and two states after a time, by DOP853."""

    def paces(_: float, y: Any) -> Any:
        (load, _, first, second), a = y[:4], y[1] - 1.0
        mu, slope = 0.5 + 0.02 * a - 0.2 * a**3 + 0.4 * a**5 + COUPLED * first, 0.02 - 0.6 * a**2 + 2.0 * a**4
        own = [-1e3 * a, load - NORMAL * mu, FREQUENCY * second, -FREQUENCY * (first + zeta * second) + FREQUENCY * a]
        slopes = np.zeros((4, 4))
        slopes[0, 1], slopes[1, :3], slopes[2, 3] = -1e3, [1.0, -NORMAL * slope, -NORMAL * COUPLED], FREQUENCY
        slopes[3, 1:] = FREQUENCY, -FREQUENCY, -FREQUENCY * zeta
        return np.concatenate([own, (slopes @ y[4:].reshape(4, 4)).ravel()])

    end = solve_ivp(paces, (0.0, period), [*start, *np.eye(4).ravel()], method="DOP853", rtol=1e-13, atol=1e-12).y[:, -1]
    return end[:4], end[4:].reshape(4, 4)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("coupled", [0.0, COUPLED])
def test_a_pair_of_multipliers_leaves_the_unit_circle_at_an_edge(coupled: float) -> None:
    """Without coupling exp(-(zeta -+ i root(4 - zeta^2)) omega T / 2), and the edge at 0 to 1e-12; with it |.| = 1 to 1e-8."""
    begin = ss.studies.cycle(two_frequencies(0.002, coupled), near=1.0)
    branch = ss.studies.follow(begin, "friction.parameters.zeta", to=-0.006, steps=1)
    assert [edge.name for edge in branch.edges] == ["Neimark-Sacker"]
    edge = branch.edges[0]
    stable = {one.value > edge.value: one.stable for one in branch.points if not one.edge}
    assert stable == {True: True, False: False}
    if not coupled:
        turns = cmath.exp(-(0.002 - 1j * math.sqrt(4.0 - 0.002**2)) * FREQUENCY * begin.period / 2.0)
        assert min(abs(begin.multipliers - turns)) == pytest.approx(0.0, abs=1e-9)
        assert edge.value == pytest.approx(0.0, abs=1e-12)
        return
    start = [edge.orbit.place[0], 1.0, *edge.orbit.place[1:]]
    end, matrix = own_monodromy(edge.value, start, edge.orbit.period)
    assert end == pytest.approx(start, rel=1e-9, abs=1e-9)
    pair = [one for one in np.linalg.eigvals(matrix) if one.imag != 0.0]
    assert np.abs(pair) == pytest.approx(np.ones(2), abs=1e-8)
    assert abs(edge.orbit.multipliers[0]) == pytest.approx(1.0, abs=1e-10)
