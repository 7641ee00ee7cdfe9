"""Chains that are solved: printed numbers, single blocks, an independent solver, symmetry, energies, and resuming."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.chains.compiled import memory as at
from stickslip.extensions.chains.run import CHANGE_NAMES, ChainRun
from stickslip.extensions.chains.solver import ChainSolver, solve_chain
from tests.extensions.chains.reference import matrix_of, solve

COULOMB = ss.friction.Coulomb(static=1.0, dynamic=0.8)


def chain_of_ten(direction: str = "forward") -> ss.Chain:
    law, start = ss.friction.Coulomb(static=1.0, dynamic=0.7), -np.random.default_rng(1).uniform(0.0, 0.5, 10)
    return ss.Chain(law, 10, 1.0, 10.0, 1.0, 1.0, 1e-3, initial_slip=start, direction=direction)


def random_chain(seed: int) -> ss.Chain:
    """Return a chain of 3 to 7 blocks that differ, under Coulomb's law or one that is straight in slip."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(3, 8))
    weak = ss.friction.LinearSlipWeakening(1.0, 0.7, float(rng.uniform(0.05, 0.5)), memory=("all", "since-arrest")[seed // 3 % 2])
    bent = ss.friction.PiecewiseLinearSlip([0.0, 0.1, 0.3], [1.0, 0.8, 0.7], memory=("all", "since-arrest")[seed % 2])
    law = (ss.friction.Coulomb(1.0, 0.75), weak, bent)[seed % 3]
    numbers = [rng.uniform(*ends, n) for ends in ((0.5, 2.0), (0.5, 2.0), (0.8, 1.5), (-0.2, 0.2))]
    mass, stiffness, normal, start = numbers
    coupling, damping = float(rng.uniform(1.0, 4.0)), float(rng.uniform(0.0, 0.3)) * (seed % 2)
    ends, direction = ("free", "fixed", "periodic")[seed // 2 % 3], ("both", "forward")[seed // 5 % 2]
    return ss.Chain(
        law, n, mass, coupling, stiffness, normal, 1e-2, damping=damping, ends=ends, initial_slip=start, direction=direction
    )  # fmt: skip


def changes_but_knots(run: ChainRun) -> np.ndarray:
    return run.changes[run.changes["kind"] != CHANGE_NAMES.index("knot")]


def without_touches(changes: np.ndarray) -> np.ndarray:
    """Leave out an arrest whose block slips again within 1e-5 s, and that onset: DOP853 does not see where a rate touches 0."""
    kept, last = np.ones(len(changes), bool), {}
    for n, change in enumerate(changes):
        before = last.get(change["block"], n)
        if change["kind"] == 0 and changes["kind"][before] == 1 and change["time"] - changes["time"][before] < 1e-5:
            kept[[before, n]] = False
        last[change["block"]] = n
    return changes[kept]


# ---- printed numbers and single blocks -------------------------------------------------------------------------------------


def test_two_blocks_change_when_issue_72_says():
    run = solve_chain(ss.Chain(COULOMB, 2, 1.0, 1.2, 1.0, [1.0, 1.3], 1e-3), 1118.0, keep="changes")
    expected = [1000.0, 1002.122606772294, 1080.660396306022, 1082.781954136647, 1117.329029773771]
    assert run.changes["time"] == pytest.approx(expected, rel=0, abs=1e-11)
    assert run.changes["block"].tolist() == [0, 0, 1, 1, 0]
    assert run.events["size"].tolist() == [1, 1]


def test_ten_blocks_change_as_often_as_issue_72_says():
    run = solve_chain(chain_of_ten(), 1500.0, keep="changes")
    assert run.count_of_changes == len(run.changes) == 156
    assert run.changes["time"][-1] == pytest.approx(1450.807006456, rel=0, abs=1e-8)
    assert run.slip.sum() == pytest.approx(7.291176445, rel=0, abs=1e-9)


def test_one_block_slips_as_closed_form_says():
    """Slip from strength S to sliding friction 0.8 S: a half period of the oscillator, pulled at V meanwhile."""
    run = solve_chain(ss.Chain(COULOMB, 1, 4.0, 0.0, 9.0, 2.0, 1e-2), 30.0, keep="changes")
    omega, step, speed = 1.5, 0.4 / 9.0, 1e-2
    # u' = V (1 - cos wt) + (step w) sin wt is 0 again at wt = 2 pi - 2 atan(step w / V)
    lasting = (2.0 * np.pi - 2.0 * np.arctan2(step * omega, speed)) / omega
    onset = 2.0 / 9.0 / speed
    moved = speed * (lasting - np.sin(omega * lasting) / omega) + step * (1.0 - np.cos(omega * lasting))
    assert run.changes["time"][:2] == pytest.approx([onset, onset + lasting], rel=1e-14, abs=0)
    assert run.events["moment"][0] == pytest.approx(moved, rel=1e-13, abs=0)
    assert run.events["largest_rate"][0] == pytest.approx(speed + np.hypot(speed, step * omega), rel=1e-13, abs=0)
    assert run.events["heat"][0] == pytest.approx(1.6 * moved, rel=1e-13, abs=0)


@pytest.mark.parametrize("law", [COULOMB, ss.friction.LinearSlipWeakening(0.8, 0.5, 0.05, memory="since-arrest")])
def test_equal_blocks_are_one_spring_block(law):
    """Bit for bit among each other; with the solver of a single block to its tolerance."""
    equal = solve_chain(ss.Chain(law, 5, 2.0, 3.0, 1.5, 1.2, 1e-2), 300.0, keep="changes")
    body = ss.SpringBlock(mass=2.0, stiffness=1.5, normal_force=1.2)
    block = ss.simulate(ss.Problem(body, law, 1e-2, initial_load=0.0), 300.0)
    slips = equal.at(np.linspace(0.0, 300.0, 301)).slip
    assert len(equal.events) >= 3
    assert (slips == slips[:, :1]).all()
    assert (equal.events["size"] == 5).all()
    assert slips[:, 0] == pytest.approx(block.slip(np.linspace(0.0, 300.0, 301)), rel=0, abs=1e-8)


def test_equal_blocks_touch_zero_rate_together():
    """Under constant friction the rate is V (1 - cos wt): it touches 0 once in each period, which is an event as of one block."""
    run = solve_chain(ss.Chain(ss.friction.Coulomb(1.0, 1.0), 3, 1.0, 2.0, 4.0, 1.0, 1e-2), 125.0, keep="changes")
    assert run.count_of_events == 31
    assert run.changes["kind"].tolist() == [*[CHANGE_NAMES.index("onset")] * 3, *[CHANGE_NAMES.index("arrest")] * 3] * 31 + [0] * 3
    assert (run.slip == run.slip[0]).all()
    assert run.slip == pytest.approx([1e-2 * (100.0 - np.sin(200.0) / 2.0)] * 3, rel=1e-12, abs=0)


def test_blocks_without_coupling_are_blocks_of_their_own():
    many = solve_chain(ss.Chain(COULOMB, 3, [1.0, 2.0, 3.0], 0.0, [1.0, 1.5, 2.0], [1.0, 1.3, 0.7], 1e-2), 500.0, keep="changes")
    for j, numbers in enumerate(((1.0, 1.0, 1.0), (2.0, 1.5, 1.3), (3.0, 2.0, 0.7))):
        mass, stiffness, normal = numbers
        alone = solve_chain(ss.Chain(COULOMB, 1, mass, 0.0, stiffness, normal, 1e-2), 500.0, keep="changes")
        own = many.changes[many.changes["block"] == j]
        assert len(own) == len(alone.changes) > 4
        assert own["time"] == pytest.approx(alone.changes["time"], rel=1e-12, abs=0)
        assert many.slip[j] == pytest.approx(alone.slip[0], rel=1e-12, abs=0)


# ---- against an independent solver -----------------------------------------------------------------------------------------


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("seed", range(10))
def test_random_chains_agree_with_dop853(seed):
    one = random_chain(seed)
    run, other = solve_chain(one, 60.0, keep="changes"), solve(one, 60.0)
    own = without_touches(changes_but_knots(run))
    assert own["block"].tolist() == other.changes[:, 1].tolist()
    assert own["time"] == pytest.approx(other.changes[:, 0], rel=0, abs=1e-6)
    assert run.slip == pytest.approx(other.slip, rel=0, abs=1e-8)


CURVED = {
    "rate": ss.friction.HyperbolicRate(1.0, 0.6, 3.0),
    "slip": ss.friction.ExponentialSlipWeakening(1.0, 0.7, 0.1, memory="since-arrest"),
    "net slip": ss.friction.SinusoidalSlip(1.0, 0.2, 10.0),
    "Carlson and Langer": ss.friction.FromExpression("(1 - s)/(1 + 2*a*v/(1 - s))", {"s": 0.05, "a": "2 s/m"}, static=1.0),
    "knots": ss.friction.ParabolicSlipWeakening(1.0, 0.7, 0.2, 0.02),
}


@pytest.mark.sampled(every=10)
@pytest.mark.parametrize("name", CURVED)
@pytest.mark.parametrize("seed", [0, 1])
def test_laws_that_are_not_straight_agree_with_dop853(name, seed):
    rng = np.random.default_rng(seed)
    normal, start, mass = rng.uniform(0.8, 1.4, 4), rng.uniform(-0.05, 0.05, 4), rng.uniform(0.7, 1.5, 4)
    laws = [CURVED[name], CURVED[name], COULOMB, CURVED[name]] if seed else CURVED[name]
    one = ss.Chain(laws, 4, mass, 1.3, 1.0, normal, 1e-2, damping=0.2 * seed, initial_slip=start)
    run, other = solve_chain(one, 110.0, keep="changes"), solve(one, 110.0)
    own = changes_but_knots(run)
    assert own["block"].tolist() == other.changes[:, 1].tolist()
    assert own["time"] == pytest.approx(other.changes[:, 0], rel=0, abs=1e-6)
    assert run.slip == pytest.approx(other.slip, rel=0, abs=1e-8)
    assert abs(run.energy().error) < 1e-12 * run.energy().driver
    assert run.state.now[at.RESIDUAL] < 1e-13


@pytest.mark.parametrize("ends", ["free", "fixed", "periodic"])
def test_a_lattice_agrees_with_dop853(ends):
    rng = np.random.default_rng(3)
    normal, start = rng.uniform(0.8, 1.4, (3, 4)), rng.uniform(-0.05, 0.05, 12)
    one = ss.Chain(COULOMB, (3, 4), 1.0, (1.5, 0.7), 1.0, normal, 1e-2, ends=ends, initial_slip=start)
    run, other = solve_chain(one, 80.0, keep="changes"), solve(one, 80.0)
    assert run.changes["block"].tolist() == other.changes[:, 1].tolist()
    assert run.changes["time"] == pytest.approx(other.changes[:, 0], rel=0, abs=1e-7)
    assert run.slip == pytest.approx(other.slip, rel=0, abs=1e-9)


# ---- symmetry, energies, and what a run keeps ------------------------------------------------------------------------------


def turned(one: ss.Chain) -> ss.Chain:
    """Return the chain turned end for end."""
    numbers = [one.values(name)[::-1] for name in ("mass", "stiffness", "normal_force", "damping", "initial_slip")]
    mass, stiffness, normal, damping, start = numbers
    return ss.Chain(
        one.friction, one.blocks, mass, one.coupling, stiffness, normal, one.pull_rate,
        damping=damping, ends=one.ends, initial_slip=start, direction=one.direction,
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(6))
def test_a_chain_turned_end_for_end_has_the_same_bits(seed):
    one = random_chain(seed)
    run, other = (solve_chain(each, 300.0, keep="changes") for each in (one, turned(one)))
    assert (run.slip == other.slip[::-1]).all()
    assert (run.changes["time"] == other.changes["time"]).all()
    assert sorted(run.changes["block"]) == sorted(one.count - 1 - other.changes["block"])


def test_a_symmetric_chain_stays_symmetric():
    normal = [1.0, 1.2, 0.9, 1.1, 0.9, 1.2, 1.0]
    run = solve_chain(ss.Chain(COULOMB, 7, 1.0, 5.0, 1.0, normal, 1e-2), 2000.0)
    assert len(run.events) > 10
    assert (run.slip == run.slip[::-1]).all()


@pytest.mark.parametrize("seed", range(10))
def test_energies_balance(seed):
    run = solve_chain(random_chain(seed), 500.0)
    energy = run.energy()
    assert abs(energy.error) < 1e-12 * (energy.driver + energy.springs_at_start)
    events = run.events
    balance = events["springs_before"] + events["work"] - events["heat"] - events["dashpot"] - events["springs_after"]
    assert np.abs(balance[1:]).max(initial=0.0) < 1e-12 * energy.springs
    assert energy.heat > 0.1 * energy.driver


def test_a_run_that_is_resumed_has_the_same_bits():
    one = chain_of_ten("both")
    whole = solve_chain(one, 1500.0, keep="changes")
    first = solve_chain(one, 700.3, keep="changes")
    rest = solve_chain(one, 1500.0, first.state, keep="changes")
    assert np.concatenate((first.changes, rest.changes)).tobytes() == whole.changes.tobytes()
    assert np.concatenate((first.events, rest.events)).tobytes() == whole.events.tobytes()
    for name, values in whole.state.arrays.items():
        assert rest.state.arrays[name].tobytes() == values.tobytes()
    assert rest.slip.tobytes() == whole.slip.tobytes()


def test_steps_are_the_same_however_often_the_solver_returns():
    one = chain_of_ten("both")
    whole, solver, done = solve_chain(one, 1500.0), ChainSolver(one), False
    while not done:
        done, _, _ = solver.go_on(1500.0, budget=7)
    assert all(solver.state.arrays[name].tobytes() == values.tobytes() for name, values in whole.state.arrays.items())


def test_motion_is_that_of_the_run():
    run = solve_chain(chain_of_ten("both"), 1500.0, keep="changes")
    last = run.changes[-40:]
    there = run.at(last["time"])
    assert there.slip[np.arange(40), last["block"]] == pytest.approx(last["slip"], rel=0, abs=1e-13)
    assert run.at([1500.0]).slip[0] == pytest.approx(run.slip, rel=0, abs=0)
    assert run.at([1500.0, 0.0]).slip[1] == pytest.approx(run.chain.values("initial_slip"), rel=0, abs=0)


# ---- no change is missed ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(20))
def test_motion_between_changes_breaks_no_rule(seed):
    """At rest the load stays within the strength, and in slip the rate keeps its sign: seen at 4000 times."""
    one = random_chain(100 + seed)
    run = solve_chain(one, 60.0, keep="changes")
    times = np.linspace(0.0, 60.0, 4001)
    motion, own = run.at(times), changes_but_knots(run)
    load = -motion.slip @ matrix_of(one).T + one.values("stiffness") * (1e-2 * times[:, None] - motion.slip)
    laws, which = one.laws
    for j in range(one.count):
        mine = own[own["block"] == j]
        after = np.searchsorted(mine["time"], times, side="right")
        rests = np.append(True, mine["kind"] == CHANGE_NAMES.index("arrest"))[after]
        assert (motion.slip_rate[rests, j] == 0.0).all()
        largest = one.values("normal_force")[j] * laws[which[j]].static_coefficient(0.0)
        assert (load[rests, j] <= largest * (1.0 + 1e-12)).all()
        assert one.direction == "forward" or (load[rests, j] >= -largest * (1.0 + 1e-12)).all()
        signs = [np.sign(motion.slip_rate[(after == k) & ~rests, j]) for k in range(1, len(mine) + 1)]
        assert all(np.ptp(each) <= 1 for each in signs if len(each))
