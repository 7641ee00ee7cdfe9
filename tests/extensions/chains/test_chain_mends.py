"""Chains where a narrow law, a touch of zero rate, the order of lists, or a wrong argument led astray."""

from __future__ import annotations

from math import inf

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.extensions.chains.solver import ChainSolver, solve_chain

STRIBECK = {n: ss.friction.ExponentialStribeck(static=0.6, dynamic=0.3, rate=0.02, exponent=float(n)) for n in (1, 2)}
COULOMB = ss.friction.Coulomb(static=1.0, dynamic=0.8)


def alone(law: ss.friction.FrictionLaw, pull_rate: float, initial_slip: float = 0.0) -> ss.Chain:
    return ss.Chain(law, 1, 1.0, 0.0, 1.0, 1.0, pull_rate, initial_slip=initial_slip)


# ---- laws whose curve the series do not see --------------------------------------------------------------------------------


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("exponent", [1, 2])
@pytest.mark.parametrize("initial_slip", [-0.7, -5.0, -50.0])
def test_an_exponential_law_is_seen_from_far_above_its_rate(exponent, initial_slip):
    """The first slip, at rates of up to 2500 times that of the law: beside a SpringBlock to 1e-10 of the slip, energy to 1e-12."""
    law = STRIBECK[exponent]
    run = solve_chain(alone(law, 1e-3, initial_slip), 20.0)
    body = ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), law, 1e-3, initial_load=-initial_slip)
    block = ss.simulate(body, 20.0, rtol=1e-12)
    moved = float(block.slip(20.0))
    assert run.slip[0] - initial_slip == pytest.approx(moved, rel=1e-10, abs=0)
    assert abs(run.energy().error) < 1e-12 * initial_slip**2
    assert "proven on complex discs" in run.proof()


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("exponent", [1, 2])
def test_two_blocks_under_an_exponential_law_agree_with_dop853(exponent):
    """Two blocks that slip from the start, to where the first one turns back: to 1e-10 m of DOP853 at 1e-13."""
    law = STRIBECK[exponent]
    run = solve_chain(ss.Chain(law, 2, 1.0, 0.5, 1.0, 1.0, 1e-3, initial_slip=[-5.0, -4.0]), 8.0, keep="changes")
    first = run.changes[run.changes["kind"] != 0]["time"][0]

    def slope(t: float, y: np.ndarray) -> list[float]:
        drag = [0.3 + 0.3 * np.exp(-((abs(v) / 0.02) ** exponent)) for v in y[2:]]
        pull = [1e-3 * t - y[0] + 0.5 * (y[1] - y[0]), 1e-3 * t - y[1] + 0.5 * (y[0] - y[1])]
        return [y[2], y[3], pull[0] - drag[0], pull[1] - drag[1]]

    end = first - 1e-6
    found = solve_ivp(slope, (0.0, end), [-5.0, -4.0, 0.0, 0.0], "DOP853", rtol=1e-13, atol=1e-13, max_step=0.002)
    assert run.at([end]).slip[0] == pytest.approx(found.y[:2, -1], rel=0, abs=1e-10)


# ---- touches of zero rate --------------------------------------------------------------------------------------------------


def test_each_touch_of_zero_rate_is_an_event_as_of_a_single_block():
    """The rate V (1 - cos wt) touches 0 once in each period, however long ago it began; slip to 1e-11 m of the closed form."""
    law = ss.friction.Coulomb(0.5, 0.5)
    run = solve_chain(alone(law, 0.05), 500.0, keep="changes")
    block = ss.simulate(ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), law, 0.05, initial_load=0.0), 500.0)
    touches = 10.0 + 2.0 * np.pi * np.arange(1, 78)
    assert run.count_of_events == len(touches) == len(block.events) - 1
    assert run.changes["time"][run.changes["kind"] == 1] == pytest.approx(touches, rel=0, abs=1e-5)
    assert run.slip[0] == pytest.approx(0.05 * (490.0 - np.sin(490.0)), rel=0, abs=1e-11)


def test_a_touch_of_zero_rate_heals_no_law():
    """A law that forgets slip at an arrest keeps it over a touch, as a single block's does: slip to 1e-7 m of its."""
    law = ss.friction.PiecewiseLinearSlip([0.0, 1.0, 2.0], [0.5, 0.5, 0.3], memory="since-arrest")
    run = solve_chain(alone(law, 0.05), 500.0)
    block = ss.simulate(ss.Problem(ss.SpringBlock(1.0, 1.0, 1.0), law, 0.05, initial_load=0.0), 500.0, rtol=1e-11)
    assert run.slip[0] == pytest.approx(float(block.slip(500.0)), rel=0, abs=1e-7)


# ---- the same bits ---------------------------------------------------------------------------------------------------------


def rows_with_budget(chain: ss.Chain, duration: float, budget: float) -> tuple[bytes, bytes]:
    solver, done, events, changes = ChainSolver(chain, None, True), False, [], []
    while not done:
        done, some, others = solver.go_on(duration, int(min(budget, 1e9)))
        events.append(some)
        changes.append(others)
    return np.concatenate(events).tobytes(), np.concatenate(changes).tobytes()


def test_all_rows_have_the_same_bits_however_often_the_solver_returns():
    start = -np.random.default_rng(1).uniform(0.0, 0.5, 30)
    chain = ss.Chain(ss.friction.Coulomb(1.0, 0.7), 30, 1.0, 10.0, 1.0, 1.0, 1e-3, initial_slip=start)
    whole = rows_with_budget(chain, 1500.0, inf)
    assert len(whole[0]) > 1000
    for budget in (1, 7, 100):
        assert rows_with_budget(chain, 1500.0, budget) == whole


# ---- what is given ---------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def run() -> ss.extensions.chains.run.ChainRun:
    return solve_chain(ss.Chain(COULOMB, 3, 1.0, 2.0, 1.0, [1.0, 1.2, 1.4], 0.1), 50.0)


@pytest.mark.parametrize(
    ("asked", "wanted"),
    [
        (lambda run: run.at(None), "ChainRun: a time must be a number in s or a text with a unit"),
        (lambda run: run.at([]), "ChainRun: times must be at least one, got none"),
        (lambda run: run.at([[1, 2], [3, 4]]), "ChainRun: a time must be"),
        (lambda run: run.at(np.ones((2, 2))), "ChainRun: times must be a number or a list of numbers, got 2 by 2"),
        (lambda run: run.at("1 m"), "ChainRun: a time must be"),
        (lambda run: run.at([1.0, 51.0]), "ChainRun: times must lie from 0 to 50 s, got 51 s"),
        (lambda run: run.motion(1, 10, -5), "ChainRun: count must be a whole number above 0, got -5"),
        (lambda run: run.motion(1, 10, 0), "ChainRun: count must be a whole number above 0, got 0"),
        (lambda run: run.motion(None, 10), "ChainRun: start must be"),
        (lambda run: run.chain.values("masss"), "Chain: 'masss' is no number of each block; did you mean 'mass'?"),
    ],
)
def test_what_a_run_cannot_answer_is_refused_in_one_line(run, asked, wanted):
    with pytest.raises(ss.InputError) as caught:
        asked(run)
    assert wanted in str(caught.value)
    assert "\n" not in str(caught.value)


def test_lists_of_unequal_length_are_refused_with_their_place():
    with pytest.raises(ss.InputError, match=r"Chain: mass\[1\] must be .*got \[2, 3\]"):
        ss.Chain(COULOMB, 3, [1, [2, 3], 4], 1.0, 1.0, 1.0, 1e-3)
    with pytest.raises(ss.InputError, match=r"Chain: coupling\[1\] must be .*got \[2, 3\]"):
        ss.Chain(COULOMB, 3, 1.0, [1, [2, 3]], 1.0, 1.0, 1e-3)


def test_lattices_are_given_as_lists_or_as_arrays():
    given = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]
    for blocks in ((2, 3), np.array([2, 3])):
        for mass in (given, np.array(given)):
            chain = ss.Chain(COULOMB, blocks, mass, 1.0, 1.0, 1.0, 1e-3)
            assert chain.shape == (2, 3)
            assert chain.values("mass").tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]


def test_times_may_be_texts_with_units(run):
    seconds = run.motion(1.0, 2.0, 3).slip
    assert (run.motion("1 s", "2000 ms", 3).slip == seconds).all()
    assert (run.at(["1 s", 1.5, "2 s"]).slip == seconds).all()
    assert run.at("1 s").slip.shape == (1, 3)


def test_a_run_and_a_chain_are_shown_in_few_lines(run):
    assert repr(run).splitlines()[:2] == ["stickslip ChainRun", "  3 blocks, up to 50 s"]
    assert "but for" in repr(run)
    assert "3 blocks, up to 50 s" in run._repr_html_()
    assert repr(run.chain).startswith("Chain(friction=Coulomb(static=1, dynamic=0.8), blocks=3, mass=1.0")
    assert "normal_force=[1.0, 1.2, 1.4]" in repr(run.chain)
    many = ss.Chain([COULOMB] * 400, 400, np.linspace(1.0, 3.0, 400), 1.0, 1.0, 1.0, 1e-3)
    assert "mass=<400 numbers, 1 to 3>" in repr(many)
    assert "friction=<400 laws, 1 different>" in repr(many)
