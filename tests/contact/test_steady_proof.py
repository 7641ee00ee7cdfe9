"""Proofs of where steady sliding of a block changes its stability under a law with one state."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact import steady_proof
from stickslip.contact.steady import proven_slidings, steady_slidings

NORMAL, DISTANCE, RATE = 1e6, 1e-5, 1e-6
WEAKER = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": DISTANCE, "rate": RATE}
CRITICAL = NORMAL * 0.005 / DISTANCE
"""Critical stiffness (N/m) of very slow sliding: S (b - a)/Dc."""


def found_for(law: Any, stiffness: float, mass: float = 10.0, damping: float = 0.0) -> Any:
    body = ss.SpringBlock(mass, stiffness, NORMAL, damping=damping)
    return proven_slidings(ss.Problem(body, law, pull_rate=1e-6))


@pytest.mark.parametrize("evolution", ["ageing", "slip", "prz"])
@pytest.mark.parametrize("mass", [1e-3, 1e6])
def test_the_critical_rate_of_rice_and_ruina_is_enclosed(evolution: str, mass: float):
    """K = S (b - a)/Dc (1 + m V^2/(S a Dc)) at V = sqrt(S a Dc/m) for K twice the slow one: inside an enclosure 1e-6 wide."""
    found = found_for(ss.friction.RateAndState(**WEAKER, evolution=evolution), 2.0 * CRITICAL, mass)
    (change,) = found.changes
    exact = math.sqrt(NORMAL * 0.01 * DISTANCE / mass)
    assert found.proven
    assert not change.stable_above
    assert change.pull_rate == pytest.approx(exact, rel=1e-9, abs=0.0)
    low, high = change.enclosure
    assert low < exact < high < low * (1.0 + 1e-6)
    assert "(proven by interval arithmetic between 1e-15 and 1000 m/s)" in str(found)


@pytest.mark.parametrize(("b", "share", "stable"), [(0.015, 0.9, False), (0.005, 1e-3, True)])
def test_no_change_is_proven_where_there_is_none(b: float, share: float, stable: bool):
    """A block softer than S (b - a)/Dc is unstable at any rate; friction that grows with the rate is stable at any rate."""
    found = found_for(ss.friction.RateAndState(**(WEAKER | {"b": b})), share * CRITICAL)
    assert (found.changes, found.proven, found.slidings[0].stable) == ((), True, stable)
    assert (
        f"{'stable' if stable else 'unstable'} at any other slip rate, too (proven between 1e-15 and 1000 m/s)"
        in str(found).lower()
    )


def test_what_only_touches_is_not_proven_and_rounding_makes_no_changes():
    """With K = S (b - a)/Dc the block is unstable at any rate, but ever less so towards a rate of 0."""
    found = found_for(ss.friction.RateAndState(**WEAKER), CRITICAL)
    assert not found.proven
    assert found.changes == ()


def test_slabs_and_several_states_are_found_by_search():
    two = ss.friction.TwoStateRateAndState(
        a=0.01, b=0.009, second_b=0.006, distance=1e-5, second_distance=1e-5, rate=1e-6, reference=0.6
    )
    slab = ss.Problem(
        ss.ElasticSlab(2700.0, 3000.0, 1.0, NORMAL),
        ss.friction.RateAndState(**WEAKER),
        pull_rate=1e-6,
        initial_load=6e5,
        initial_state=10.0,
    )
    for found in (found_for(two, 2.0 * CRITICAL), proven_slidings(slab)):
        assert not found.proven
        assert "found between 1e-15 and 1000 m/s, not proven" in str(found) or not found.changes


@pytest.mark.parametrize("kind", ["LuGre", "FlashHeating"])
def test_other_laws_with_one_state_are_proven(kind: str):
    """The changes are those of the search, to 1e-9, and lie in their enclosures."""
    law = getattr(ss.friction, kind)
    problem = ss.Problem(ss.SpringBlock(100.0, 1e9 if kind == "LuGre" else 1e3, NORMAL), law(**law.example), pull_rate=1e-6)
    found, searched = proven_slidings(problem), steady_slidings(problem)
    assert found.proven
    assert len(found.changes) == {"LuGre": 2, "FlashHeating": 0}[kind]
    for change, other in zip(found.changes, searched.changes, strict=True):
        assert change.rate == pytest.approx(other.rate, rel=1e-9, abs=0.0)
        assert change.enclosure[0] <= other.rate <= change.enclosure[1] < change.enclosure[0] * (1.0 + 1e-6)


def test_a_state_that_a_user_types_is_proven():
    """mu = f + A z with z' = B - (B + v/d) z: the only steady state is z = B/(B + v/d); roots of the cubic equation by numpy."""
    law = ss.friction.FromExpression(
        "f + A*z", {"f": 0.4, "A": 0.2, "B": "0.1 1/s", "d": "1 mm"}, evolution="dz/dt = B - (B + v/d)*z"
    )
    body = ss.SpringBlock(10.0, 2e5, 1e4, damping=50.0)
    found = proven_slidings(ss.Problem(body, law, pull_rate=1e-4, initial_load=4e3))
    assert found.proven

    def stable(v: float) -> bool:
        fade, push = 0.1 + v / 1e-3, -1e4 * 0.2 * 0.1 / (0.1 + v / 1e-3) / 1e-3
        return bool(np.roots([10.0, 50.0 + 10.0 * fade, 2e5 + 50.0 * fade + push, 2e5 * fade]).real.max() < 0.0)

    rates = np.geomspace(1e-9, 1e2, 400)
    seen = [stable(v) for v in rates.tolist()]
    turns = [i for i in range(399) if seen[i] != seen[i + 1]]
    assert len(turns) == len(found.changes) > 0
    for i, change in zip(turns, found.changes, strict=True):
        assert rates[i] <= change.rate <= rates[i + 1]
        assert change.stable_above is seen[i + 1]


@pytest.mark.parametrize("seed", range(5))
def test_friction_that_is_the_same_at_any_rate_changes_nothing(seed: int):
    """Dahl's law neither damps nor drives an undamped block: rounding must not look like changes of stability."""
    drawn = np.random.default_rng(seed)
    law = ss.friction.Dahl(sliding=drawn.uniform(0.05, 0.9), stiffness=10.0 ** drawn.uniform(2, 6))
    body = ss.SpringBlock(10.0 ** drawn.uniform(-3, 4), 10.0 ** drawn.uniform(1, 9), 10.0 ** drawn.uniform(0, 7))
    found = steady_slidings(ss.Problem(body, law, pull_rate=10.0 ** drawn.uniform(-9, 1)))
    assert found.changes == ()
    assert found.slidings[0].stable is None


def roots_are_left(law: Any, body: ss.SpringBlock, rate: float) -> bool:
    """Return True if all roots of the block's equation are to the left, by numpy, from slopes by central differences."""

    def slope(f: Any, x: float) -> float:
        step = 1e-6 * abs(x)
        return (f(x + step) - f(x - step)) / (2.0 * step)

    theta = law.distance / rate
    change = {"ageing": lambda y: 1.0 - y, "slip": lambda y: -y * math.log(y)}[law.evolution]
    mu_v = slope(lambda v: float(law.coefficient(0.0, v, math.log(law.rate * theta / law.distance))), rate)
    mu_t = slope(lambda t: float(law.coefficient(0.0, rate, math.log(law.rate * t / law.distance))), theta)
    f_v = slope(lambda v: change(v * theta / law.distance), rate)
    f_t = slope(lambda t: change(rate * t / law.distance), theta)
    # the unknowns are the force of the spring, the slip rate and the state
    m, d, k, s = body.mass, body.damping, body.stiffness, body.normal_force
    matrix = np.array([[0.0, -k, 0.0], [1.0 / m, -(d + s * mu_v) / m, -s * mu_t / m], [0.0, f_v, f_t]])
    return bool(np.linalg.eigvals(matrix).real.max() < 0.0)


@pytest.mark.parametrize("seed", range(12))
def test_laws_drawn_at_random_change_where_eigenvalues_do(seed: int):
    """Eigenvalues of three equations of motion, at 15 rates away from the changes, have the sign that the proof says."""
    drawn = np.random.default_rng(seed)
    a, b = drawn.uniform(0.004, 0.02, 2)
    evolution = ("ageing", "slip")[seed % 2]
    law = ss.friction.RateAndState(reference=0.6, a=a, b=b, distance=10.0 ** drawn.uniform(-6, -3), rate=1e-6, evolution=evolution)
    slow = NORMAL * max(b - a, 1e-3) / law.distance
    body = ss.SpringBlock(
        10.0 ** drawn.uniform(-2, 4), slow * drawn.choice([0.5, 1.5, 3.0]), NORMAL, damping=drawn.choice([0.0, 1e4])
    )
    problem = ss.Problem(body, law, pull_rate=1e-6)
    found = proven_slidings(problem)
    assert found.proven
    assert [one.rate for one in found.changes] == pytest.approx([one.rate for one in steady_slidings(problem).changes], rel=1e-9)
    for rate in np.geomspace(1e-8, 1e2, 15).tolist():
        if all(abs(rate / one.rate - 1.0) > 1e-2 for one in found.changes):
            below = [one for one in found.changes if one.rate < rate]
            stable = (
                below[-1].stable_above
                if below
                else (found.slidings[0].stable if not found.changes else not found.changes[0].stable_above)
            )
            assert roots_are_left(law, body, rate) == stable, rate


def test_discs_that_do_not_hold_the_steady_states_prove_nothing(monkeypatch: pytest.MonkeyPatch):
    """With discs half as wide as the change of the state in a cell no cell is decided."""
    law = ss.friction.RateAndState(**WEAKER)
    body = ss.SpringBlock(10.0, 3.0 * CRITICAL, NORMAL)
    assert steady_proof.proven_changes(body, NORMAL, law, 0.0, (1e-9, 1e-3)) == []
    monkeypatch.setattr(steady_proof, "WIDER", 0.5)
    assert steady_proof.proven_changes(body, NORMAL, law, 0.0, (1e-9, 1e-3)) is None
