"""What each selection rule does: the branches it keeps, the levels of its jumps, and the loop under a load that rises and falls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.areas import area
from stickslip.contact.branches import branches_of, rate_on, resistance
from stickslip.contact.rules.selection import OF_LEVELS, RULES, levels, selection_table
from stickslip.problem.resistance import Branch
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.limits import examples

from .laws import ALPHA_C, S, Wavy, Z, hyperbolic, q_of, slab_problem, wavy_laws


def potential(rate, alpha):
    """Integral of g from 0 to a slip rate under law (15)."""
    return 0.5 * Z * rate**2 + 0.3 * S * rate + 0.5 * S / alpha * math.log1p(alpha * rate)


@pytest.mark.parametrize("alpha", [0.3, 1e6])
def test_the_loop_of_the_hyperbolic_law_has_the_area_of_the_closed_form(alpha):
    """Perfect delay jumps at muS S from 0 to vB and at the lower fold from v1 to 0."""
    q = q_of(alpha)
    v_b, v_1 = (q**2 - 1) / alpha, (q - 1) / alpha
    fold = 0.3 * S + Z / alpha * (2 * q - 1)
    exact = (0.8 * S * v_b - potential(v_b, alpha)) + (potential(v_1, alpha) - fold * v_1)
    loop = ss.uniqueness(slab_problem(hyperbolic(alpha))).loop
    assert loop.area == pytest.approx(exact, rel=1e-10, abs=0)
    assert loop.branches == (-1, 0, -1)
    assert [jump.direction for jump in loop.jumps] == ["up", "down"]
    assert loop.area > 0.0


def test_a_loop_over_several_branches_has_the_area_between_its_jumps():
    integrate = pytest.importorskip("scipy.integrate")
    found = ss.uniqueness(slab_problem(Wavy(mean=0.7, amplitude=0.25, beat=2.0, fade=5.0, turn=1.3)), 1.0)
    assert len(found.branches) >= 3
    g, total = found.resistance, 0.0
    for jump in found.loop.jumps:
        rest = integrate.quad(lambda v, load=jump.load: load - float(found.g(v)), jump.rate_before, jump.rate_after, limit=200)[0]
        assert rest > 0.0  # each jump goes where the load exceeds the resistance, or back where it falls short of it
        total += rest
    assert found.loop_area == pytest.approx(total, rel=1e-7, abs=0)
    assert {jump.load for jump in found.loop.jumps} <= {jump.load for jump in found.jumps}
    assert g.strength > 0.0


def test_a_unique_rate_has_no_loop():
    found = ss.uniqueness(slab_problem(hyperbolic(0.1)))
    assert (found.loop_area, found.loop.jumps, found.loop.branches) == (0.0, (), (-1, 0, -1))
    block = ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), hyperbolic(1.0), initial_excess=0.0)
    assert (ss.uniqueness(block).loop, ss.uniqueness(block).loop_area) == (None, 0.0)


def test_a_run_encloses_the_area_of_the_loop():
    solution = ss.simulate("fig4-loop")
    (time, rate), (_, load) = solution.curve("slip_rate", points=20_001), solution.curve("load", points=20_001)
    area = float(np.sum(0.5 * (load[1:] + load[:-1]) * np.diff(rate)))
    assert time[-1] > 5.3
    assert area == pytest.approx(ss.uniqueness(solution.problem).loop_area, rel=1e-6, abs=0)


def maxwell_level(alpha):
    """Excess and rate of equal areas: x = alpha v solves x^2 / (2 q^2) + x / (1 + x) = ln(1 + x)."""
    mpmath = pytest.importorskip("mpmath")
    with mpmath.workdps(40):
        q2 = mpmath.mpf(alpha) * 50 / mpmath.mpf("9.8")
        start = max(2 * (q_of(alpha) - 1), float(mpmath.sqrt(2 * q2 * mpmath.log(1 + q2))))
        x = mpmath.findroot(lambda x: x**2 / (2 * q2) + x / (1 + x) - mpmath.log(1 + x), start)
        return float(Z * x / alpha + 0.5 * S / (1 + x) - 0.5 * S), float(x / alpha)


def settle(table, branch, excess):
    """The branch (-1: stick) after the load has moved to a new excess, as the table's docstring says."""
    if branch < 0:
        return -1 if excess <= table.stick_to else table.climb(-1, excess)
    if excess > table.keep_to[branch]:
        return table.climb(branch, excess)
    return table.descend(branch, excess) if excess < table.keep_from[branch] else branch


def test_the_rules_have_one_list_of_names():
    assert tuple(RULES) == SELECTION_RULES


@pytest.mark.parametrize("alpha", [1.0, 1e6])
def test_the_maxwell_level_of_the_hyperbolic_law_cuts_equal_areas(alpha):
    excess, rate = maxwell_level(alpha)
    (branch,), table = selection_table(slab_problem(hyperbolic(alpha), "maxwell"))
    assert table.stick_to == table.keep_from[0] == pytest.approx(excess, rel=1e-13, abs=0)
    assert rate_on(resistance(slab_problem(hyperbolic(alpha))), branch, table.stick_to) == pytest.approx(rate, rel=1e-12, abs=0)


def test_the_maxwell_level_just_above_critical_is_three_quarters_of_the_fold():
    # There g - S muS = -a s + b s^2 up to a relative 1e-5, and equal areas lie at 3/4 of the fold's depth
    (branch,), table = selection_table(slab_problem(hyperbolic(ALPHA_C + 1e-6), "maxwell"))
    assert table.stick_to == pytest.approx(0.75 * branch.excess_from, rel=1e-5, abs=0)


@pytest.mark.parametrize(
    ("rule", "stick_to", "keep_from"),
    [("perfect-delay", 0.0, -0.5 * S), ("minimal", 0.0, 0.0), ("maximal", -0.5 * S, -0.5 * S), ("maxwell", -0.5 * S, -0.5 * S)],
)
def test_tables_of_coulomb_friction_have_their_closed_form(rule, stick_to, keep_from):
    _, table = selection_table(slab_problem(ss.friction.Coulomb(0.8, 0.3), rule))
    assert (table.stick_to, table.keep_from[0]) == pytest.approx((stick_to, keep_from), rel=1e-15, abs=0)


@pytest.mark.parametrize("rule", SELECTION_RULES)
@pytest.mark.parametrize("law", [ss.friction.HyperbolicRate(0.3, 0.8, 2.0), ss.friction.SinusoidalSlip(1.0, 0.5, 5.0)])
def test_no_rule_matters_where_the_slip_rate_is_unique(law, rule):
    _, table = selection_table(slab_problem(law, rule))
    assert (table.stick_to, table.keep_from, table.keep_to) == (0.0, (0.0,), (math.inf,))


@pytest.mark.parametrize("rule", OF_LEVELS)
def test_levels_of_many_contacts_are_those_of_each(rule):
    """Contacts with fewer branches than others leave the last columns empty."""
    rng = np.random.default_rng(4)
    ends = rng.uniform(-1.0, 1.0, (50, 4, 2))
    many = rng.integers(1, 5, 50)
    ends[np.arange(4) >= many[:, None]] = math.inf, -math.inf
    stick_to, keep_from, keep_to = levels(rule, ends[..., 0], ends[..., 1])
    for n, count in enumerate(many):
        stable = tuple(Branch(1.0, 2.0, *pair) for pair in ends[n, :count].tolist())
        table = RULES[rule](None, stable)
        assert (stick_to[n], *keep_from[n, :count], *keep_to[n, :count]) == (table.stick_to, *table.keep_from, *table.keep_to)
        assert (keep_from[n, count:] > keep_to[n, count:]).all()


def best(rule, g, stable, excess):
    """The branch that a memoryless rule takes at an excess, by its own definition."""
    alive = [-1] if excess <= 0.0 else []
    alive += [i for i, b in enumerate(stable) if b.excess_from <= excess <= b.excess_to]
    if rule == "minimal":
        return alive[0]
    if rule == "maximal":
        return alive[-1]
    return min(alive, key=lambda i: 0.0 if i < 0 else area(g, 0.0, rate_on(g, stable[i], excess), excess))


@settings(max_examples=examples(5))
@given(law=wavy_laws, slip=st.floats(0.0, 10.0), share=st.floats(-0.5, 1.0), rule=st.sampled_from(SELECTION_RULES[1:]))
def test_memoryless_rules_agree_with_brute_force(law, slip, share, rule):
    g = resistance(slab_problem(law), slip)
    stable = branches_of(g)
    table = RULES[rule](g, stable)
    excess = share * 2.0 * S * law.amplitude
    edges = [
        table.stick_to,
        0.0,
        *table.keep_from,
        *table.keep_to,
        *(b.excess_from for b in stable),
        *(b.excess_to for b in stable),
    ]
    assume(all(abs(excess - edge) > 1e-3 for edge in edges))
    wanted = best(rule, g, stable, excess)
    starts = [-1, *(i for i in range(len(stable)) if table.keep_from[i] <= table.keep_to[i])]
    assert {settle(table, start, excess) for start in starts} == {wanted}


@settings(max_examples=examples(25))
@given(law=wavy_laws, slip=st.floats(0.0, 10.0), path=st.lists(st.floats(-0.5, 1.0), min_size=2, max_size=8))
def test_perfect_delay_takes_the_nearest_stable_root(law, slip, path):
    g = resistance(slab_problem(law), slip)
    stable = branches_of(g)
    table = RULES["perfect-delay"](g, stable)
    branch, last = -1, -math.inf
    for share in path:
        excess = share * 2.0 * S * law.amplitude
        alive = ([-1] if excess <= 0.0 else []) + [i for i, b in enumerate(stable) if b.excess_from <= excess <= b.excess_to]
        nearest = [i for i in alive if (i > branch) == (excess > last)]
        wanted = branch if branch in alive else min(nearest, key=lambda i, b=branch: abs(i - b))
        branch, last = settle(table, branch, excess), excess
        assert branch == wanted


def test_the_area_has_its_closed_form():
    g = resistance(slab_problem(hyperbolic(1e4)))
    for start, end, excess in [(0.0, 3.0, -1e7), (1e-7, 2e-3, 0.0), (0.5, 0.6, 4e6)]:
        log = math.log1p(1e4 * end) - math.log1p(1e4 * start)
        exact = 0.5 * Z * (end**2 - start**2) + 0.5 * S * log / 1e4 - (0.5 * S + excess) * (end - start)
        assert area(g, start, end, excess) == pytest.approx(exact, rel=1e-13, abs=0)
    assert np.isclose(area(g, 1.0, 1.0, 0.0), 0.0, rtol=0, atol=0)
