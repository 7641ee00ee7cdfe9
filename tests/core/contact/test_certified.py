"""Folds with proof: closed forms, 50-digit arithmetic and dense scans; and what rounding leaves open is said."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.contact.branches import branches_of, resistance
from stickslip.contact.critical import critical_normal_stress, critical_value, margin
from stickslip.contact.folds import certificate
from stickslip.contact.lowest_slope import lowest_slope
from stickslip.contact.uniqueness import uniqueness_of
from stickslip.engine.input.branch_table import table_of_branches
from stickslip.engine.state.layout import BranchRow
from stickslip.friction import LAWS, FromExpression
from stickslip.friction.formula.expression import nodes_of
from stickslip.problem import Resistance
from stickslip.problem.scenarios.scenario import read_scenario
from stickslip.problem.scenarios.templates import template
from tests.core.friction.drawn import laws
from tests.limits import examples

from .laws import ALPHA_C, SLAB, S, Z, closed_critical_value, hyperbolic, slab_problem

mpmath = pytest.importorskip("mpmath")

WIDTHS = [1e-2, 3e-4, 1e-5]
HEIGHT = 0.05
RATE_LAWS = sorted(kind for kind, law in LAWS.items() if law.state is None)


def bump(width: float) -> ss.Problem:
    """Friction with a bump at 1 m/s."""
    return slab_problem(FromExpression(f"0.5 + {HEIGHT}*exp(-((v-1)/w)**2)", {"w": width}))


def folds_of_bump(width: float) -> list[float]:
    """Where Z = 2 S height x exp(-x^2) / width with x = (v - 1) / width, by Lambert's W."""
    with mpmath.workdps(50):
        share = mpmath.mpf(Z) * mpmath.mpf(width) / (2 * mpmath.mpf(S) * mpmath.mpf(HEIGHT))
        x = [mpmath.sqrt(-mpmath.lambertw(-2 * share**2, k) / 2).real for k in (0, -1)]
        return [1 + mpmath.mpf(width) * one for one in x]


def slope_of(problem: ss.Problem, rates: np.ndarray) -> np.ndarray:
    """g' by a complex step through the law's own formula."""
    law, step = problem.friction, 1e-100
    values = law.piece_coefficient(0, np.complex128(problem.law_slip), rates + 1j * step)
    return Z + S * np.imag(values) / step


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("text", ["0.3 + 0.2*exp(-v/v1)", "0.3 + 0.2/(1 + v/v1)"])
def test_a_fold_is_enclosed_to_rounding_wherever_cells_are_cut(text):
    """A cell is cut at its geometric middle, so that a cut may take off little of it: the search must go on nevertheless."""
    for rate in np.geomspace(0.01, 1.0, 30):
        problem = replace(slab_problem(FromExpression(text, {"v1": rate})), body=replace(SLAB, normal_stress=20.0 * Z * rate))
        (fold,) = uniqueness_of(problem).folds
        assert fold.enclosure[1] - fold.enclosure[0] < 1e-13 * fold.rate


@pytest.mark.parametrize("width", WIDTHS)
def test_a_bump_of_any_width_has_its_two_folds(width):
    found = uniqueness_of(bump(width))
    assert found.certificate == "proven"
    assert found.undecided == ()
    assert found.regime == "irregular"
    assert "Proven by interval arithmetic" in found.summary
    assert len(found.folds) == 2
    for fold, rate in zip(found.folds, folds_of_bump(width), strict=True):
        assert fold.rate == pytest.approx(float(rate), rel=1e-12, abs=0)
        low, high = fold.enclosure
        assert low <= rate <= high
        assert high - low <= 1e-12 * fold.rate
        assert low <= fold.rate <= high


@pytest.mark.parametrize("width", WIDTHS)
def test_the_engine_is_given_the_folds_of_a_bump(width):
    table, stick_to = table_of_branches(bump(width), 0.0)
    wanted = [float(one) for one in folds_of_bump(width)]
    assert BranchRow.of(table).rate_from.tolist() == pytest.approx([0.0, wanted[1]], rel=1e-12, abs=0)
    assert BranchRow.of(table).rate_to[0] == pytest.approx(wanted[0], rel=1e-12, abs=0)
    assert stick_to == 0.0


@pytest.mark.parametrize("width", WIDTHS)
def test_a_bump_has_its_critical_normal_stress(width):
    """Friction falls most steeply at x = 1/sqrt(2), by height sqrt(2/e) / width."""
    problem = bump(width)
    exact = Z * width / (HEIGHT * math.sqrt(2.0 / math.e))
    assert critical_normal_stress(resistance(problem)) == pytest.approx(exact, rel=1e-12, abs=0)
    low, high = uniqueness_of(problem).critical_stress_between
    assert low <= exact * (1 + 1e-15)
    assert exact * (1 - 1e-15) <= high
    assert high - low <= 1e-12 * exact
    assert margin(problem) == pytest.approx(1.0 - S / exact, rel=1e-12, abs=0)


def test_both_folds_of_a_bump_that_moves_with_slip_are_found():
    """The bump moves along the rate as the contact slips: at every slip its two folds are found."""
    law = FromExpression(f"0.5 + {HEIGHT}*exp(-((v - 1 - 0.1*sin(u))/w)**2)", {"w": 1e-4})
    exact = [float(one) - 1.0 for one in folds_of_bump(1e-4)]
    for slip in (0.0, 0.7, 2.0, 5.0):
        first, second = branches_of(resistance(slab_problem(law), slip))
        center = 1.0 + 0.1 * math.sin(slip)
        assert [first.rate_to - center, second.rate_from - center] == pytest.approx(exact, rel=0, abs=1e-14)


@pytest.mark.parametrize("kind", RATE_LAWS)
def test_the_example_of_every_law_is_proven(kind):
    problem = slab_problem(example_of(kind))
    assert uniqueness_of(problem).certificate == "proven"
    assert all(fold.enclosure is not None for fold in uniqueness_of(problem).folds)


def example_of(kind: str) -> ss.friction.FrictionLaw:
    """A law with the values of its example."""
    return read_scenario(template("slab", kind), "drawn").problem.friction


@settings(max_examples=examples(60))
@given(law=st.sampled_from(RATE_LAWS).flatmap(laws), slip=st.floats(0.0, 3.0))
def test_proof_and_dense_scan_agree_on_drawn_laws(law, slip):
    """Laws without narrow features: every change of sign on 20 000 slip rates is in a proven interval, and no other exists."""
    g = resistance(slab_problem(law), slip)
    if not law.depends_on_rate:
        return
    proof = certificate(g)
    grid = np.unique(np.concatenate(([0.0], np.geomspace(1e-9 * min(g.scales), 1e3 * max(g.scales), 20_000), g.rate_knots)))
    rising = g.slope(grid) > 0.0
    turns = np.flatnonzero(rising[1:] != rising[:-1])
    places = list(zip(grid[turns], grid[turns + 1], strict=True))
    sure = [place for place in places if not any(low <= place[1] and place[0] <= high for low, high in proof.undecided)]
    found = [turn for turn in proof.turns if not any(low <= turn[1] and turn[0] <= high for low, high in proof.undecided)]
    assert len(sure) == len(found)
    for (low, high), turn in zip(sure, found, strict=True):
        assert low * (1 - 1e-9) <= turn[1]
        assert turn[0] <= high * (1 + 1e-9)
    if proof.rises_at_rest is not None:
        assert rising[0] == proof.rises_at_rest


FEATURES = (
    "{a}*exp(-((v-{c})/{w})**2)",
    "{a}*tanh((v-{c})/{w})",
    "{a}*sin(v/{w})*exp(-((v-{c})/(6*{w}))**2)",
    "{a}/(1+((v-{c})/{w})**2)",
)


def with_features(seed: int) -> tuple[ss.Problem, np.ndarray]:
    """A law with one to four bumps, steps and ripples, and slip rates that resolve them all."""
    rng = np.random.default_rng(seed)
    text, rates = "0.6 + 0.1/(1 + v)", [np.linspace(0.0, 20.0, 20_001), np.geomspace(1e-8, 1e4, 4001)]
    for _ in range(rng.integers(1, 5)):
        width, center = 10.0 ** rng.uniform(-4.0, 0.0), round(float(rng.uniform(0.2, 5.0)), 6)
        size = round(float(rng.choice([-1.0, 1.0]) * rng.uniform(0.005, 0.04)), 6)
        text += " + " + str(rng.choice(FEATURES)).format(a=f"({size})", c=center, w=f"{width:.6e}")
        rates.append(center + width * np.linspace(-40.0, 40.0, 20_001))
    together = np.unique(np.concatenate(rates))
    return slab_problem(FromExpression(text)), together[together >= 0.0]


@pytest.mark.sampled(every=20)
@pytest.mark.parametrize("seed", range(40))
def test_laws_with_narrow_features_have_the_folds_of_a_dense_scan(seed):
    problem, rates = with_features(seed)
    found = uniqueness_of(problem)
    with np.errstate(over="ignore", invalid="ignore"):
        slope = slope_of(problem, rates)
    usable = np.isfinite(slope)
    rates, slope = rates[usable], slope[usable]
    turns = np.flatnonzero((slope[1:] > 0.0) != (slope[:-1] > 0.0))
    assert found.certificate == "proven"
    assert len(found.folds) == len(turns)
    for fold, low, high in zip(found.folds, rates[turns], rates[turns + 1], strict=True):
        assert low * (1 - 1e-12) <= fold.rate <= high * (1 + 1e-12)
        assert fold.enclosure[1] - fold.enclosure[0] <= 1e-9 * fold.rate
    lowest = lowest_slope(resistance(problem))
    assert lowest.verdict == "proven"
    assert lowest.at_least <= slope.min() * (1 + 1e-12) if slope.min() > 0 else lowest.at_least <= slope.min() * (1 - 1e-12)
    assert lowest.at_most - lowest.at_least <= 1e-9 * max(Z, abs(lowest.at_least))


def touching(shift: float) -> ss.Problem:
    """g' = S (0.3 (v - 1)^2 + shift) up to rounding: for shift = 0 it touches 0 at 1 m/s without changing its sign."""
    return slab_problem(FromExpression("0.6 - a*v + 0.1*(v - 1)**3", {"a": Z / S - shift}))


def test_a_root_that_only_touches_is_not_decided():
    found = uniqueness_of(touching(0.0))
    assert found.certificate == "not decided"
    ((low, high),) = found.undecided
    assert low <= 1.0 <= high
    assert high - low <= 1e-7
    assert found.regime == "regular"
    assert found.folds == ()
    assert "does not decide whether g = Z v + S mu(v) turns between" in found.summary
    assert certificate(resistance(touching(0.0))).regime is None


@pytest.mark.parametrize("shift", [-1e-10, 1e-10])
def test_beside_a_root_that_only_touches_all_is_decided(shift):
    """1e-10 of friction per m/s is 1e-9 of what the two parts of g' are: bounds of g' are narrower than that."""
    found = uniqueness_of(touching(shift))
    assert found.certificate == "proven"
    half = math.sqrt(-shift / 0.3) if shift < 0.0 else 0.0
    assert [fold.rate for fold in found.folds] == pytest.approx([1.0 - half, 1.0 + half] if half else [], rel=0, abs=1e-11)
    assert certificate(resistance(touching(shift))).regime == ("irregular" if half else "regular")


def test_at_the_critical_value_the_start_is_not_decided():
    found = uniqueness_of(slab_problem(hyperbolic(ALPHA_C)))
    assert found.certificate == "not decided"
    ((low, high),) = found.undecided
    assert low == 0.0
    assert high < 1e-13
    assert found.regime == "regular"


def test_a_plateau_is_not_decided():
    flat = ss.friction.PiecewiseLinearRate(rates=(0.0, 1.0, 2.0, 6.0), coefficients=(0.6, 0.65, 0.65 - Z / S, 0.5))
    found = uniqueness_of(slab_problem(flat))
    assert found.regime == "continuum"
    assert found.certificate == "not decided"
    assert found.undecided == ((1.0, 2.0),)


def test_kinks_are_folds_of_no_width():
    law = ss.friction.PiecewiseLinearRate(rates=(0.0, 1.0, 2.0, 6.0), coefficients=(0.6, 0.65, 0.5, 0.5))
    found = uniqueness_of(slab_problem(law))
    assert [fold.enclosure for fold in found.folds] == [(1.0, 1.0), (2.0, 2.0)]
    assert found.certificate == "proven"


def test_too_many_cells_are_left_undecided():
    problem = slab_problem(FromExpression("0.6 + 0.001*cos(300*v)*exp(-v)"))
    found = certificate(resistance(problem), 300)
    assert found.verdict == "not decided"
    assert found.evaluations <= 350
    rates = np.linspace(0.0, 3.0, 300_001)
    slope = slope_of(problem, rates)
    for i in np.flatnonzero((slope[1:] > 0.0) != (slope[:-1] > 0.0)):
        assert any(low <= rates[i + 1] and rates[i] <= high for low, high in (*found.turns, *found.undecided))


@pytest.mark.parametrize(
    ("law", "name"), [(hyperbolic(1.0), "alpha"), (ss.friction.ExponentialStribeck(0.6, 0.4, rate=0.1, exponent=2), "rate")]
)
def test_a_critical_value_is_enclosed(law, name):
    problem = slab_problem(law)
    found = critical_value(problem, name)
    closed = closed_critical_value(law)[1]
    assert found.certificate == "proven"
    ((low, high),) = found.enclosures
    assert low < closed < high
    assert high - low <= 1e-10 * closed


def test_a_law_that_comes_from_another_process_has_the_same_proof():
    """Its formula is equal to that of the law that was sent, node by node, but none of its nodes is the same object."""
    law = ss.friction.PowerStribeck(0.9714, 0.0, rate=1e-3, exponent=1)
    assert law.trees()  # they are sent with it
    sent = pickle.loads(pickle.dumps(law))
    nodes_of.cache_clear()  # as in the other process
    certificate.cache_clear()
    found = certificate(Resistance(sent, Z, S, 0.0))
    certificate.cache_clear()
    assert found == certificate(Resistance(replace(law), Z, S, 0.0))
    assert found.regime == "irregular"
