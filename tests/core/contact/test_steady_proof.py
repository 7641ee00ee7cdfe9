"""Proofs of where steady sliding changes its stability under a law with states."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact import steady_proof
from stickslip.contact.disturbance import Response
from stickslip.contact.kinds import rigid, uniform
from stickslip.contact.steady import proven_slidings, steady_slidings
from stickslip.contact.steady_proof import slope_symbols
from stickslip.contact.wave_proof import of_slab
from stickslip.friction.formula.operations.sets import Disc
from tests.core.contact.modes import modes_of

NORMAL, DISTANCE, RATE = 1e6, 1e-5, 1e-6
WEAKER = {"reference": 0.6, "a": 0.01, "b": 0.015, "distance": DISTANCE, "rate": RATE}
CRITICAL = NORMAL * 0.005 / DISTANCE
"""Critical stiffness (N/m) of very slow sliding: S (b - a)/Dc."""


def found_for(law: Any, stiffness: float, mass: float = 10.0, damping: float = 0.0) -> Any:
    body = ss.SpringBlock(mass, stiffness, NORMAL, damping=damping)
    return proven_slidings(ss.Problem(body, law, pull_rate=1e-6))


@pytest.mark.sampled(every=6)
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


@pytest.mark.slow
def test_what_only_touches_is_not_proven_and_rounding_makes_no_changes():
    """With K = S (b - a)/Dc the block is unstable at any rate, but ever less so towards a rate of 0."""
    found = found_for(ss.friction.RateAndState(**WEAKER), CRITICAL)
    assert not found.proven
    assert found.changes == ()


TWO = {"a": 0.01, "b": 0.009, "second_b": 0.006, "distance": DISTANCE, "second_distance": DISTANCE, "rate": RATE, "reference": 0.6}


def test_slabs_under_two_states_are_found_by_search():
    slab = ss.ElasticSlab(2800.0, 3500.0, 10.0, NORMAL)
    law = ss.friction.TwoStateRateAndState(**TWO)
    found = proven_slidings(ss.Problem(slab, law, pull_rate=1e-6, initial_rate="steady"))
    assert not found.proven
    assert len(found.changes) == 1
    assert "found between 1e-15 and 1000 m/s, not proven" in str(found)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("evolution", ["ageing", "slip"])
def test_two_states_over_the_same_distance_act_as_one(evolution: str):
    """The critical rate is then that of Rice & Ruina, sqrt(S a Dc/m) for twice the critical stiffness of slow sliding."""
    found = found_for(ss.friction.TwoStateRateAndState(**TWO, evolution=evolution), 2.0 * CRITICAL)
    (change,) = found.changes
    exact = math.sqrt(NORMAL * 0.01 * DISTANCE / 10.0)
    assert (found.proven, change.stable_above) == (True, False)
    assert change.enclosure[0] < exact < change.enclosure[1] < change.enclosure[0] * (1.0 + 1e-6)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("seed", range(2))
def test_blocks_under_two_states_change_where_eigenvalues_do(seed: int):
    """Eigenvalues of four equations of motion, at 15 rates away from the changes; slopes from states alone, by hand."""
    drawn = np.random.default_rng(seed)
    (a, b, c), (one, two) = drawn.uniform(0.004, 0.012, 3), 10.0 ** drawn.uniform(-6, -3, 2)
    c *= drawn.choice([-0.5, 1.0])
    law = ss.friction.TwoStateRateAndState(**(TWO | {"a": a, "b": b, "second_b": c, "distance": one, "second_distance": two}))
    mass, damping = 10.0 ** drawn.uniform(1, 5), drawn.choice([0.0, 1e4])
    stiffness = NORMAL * max(b + c - a, 1e-3) / min(one, two) * drawn.choice([0.1, 0.5, 1.5])
    found = found_for(law, stiffness, mass, damping)
    assert found.proven
    for rate in np.geomspace(1e-6, 1e2, 15).tolist():
        if all(abs(rate / change.rate - 1.0) > 1e-2 for change in found.changes):
            fade, sign = np.array([rate / one, rate / two]), np.array([b, c])
            # the unknowns are the force of the spring, log v and the logarithms of the states; ageing: y' = v/L (1/y - v y)
            matrix = np.zeros((4, 4))
            matrix[0, 1] = -stiffness * rate
            matrix[1] = np.array([1.0, -damping * rate - NORMAL * a, *(-NORMAL * sign)]) / (mass * rate)
            matrix[2:, 1], matrix[2:, 2:] = -fade, -np.diag(fade)
            assert bool(np.linalg.eigvals(matrix).real.max() < 0.0) == is_said_stable(found, rate), rate


@pytest.mark.slow
def test_states_that_feel_each_other_are_proven():
    """mu = f + A z^2 with z' = (x - z)/T and x' = (v - x)/T - c z, against eigenvalues of equations written by hand."""
    law = ss.friction.FromExpression(
        "f + A*z**2",
        {"f": 0.4, "A": -5.0, "T": 0.01, "c": 20.0},
        evolution="dz/dt = (x - z)/T; dx/dt = (v - x)/T - c*z",
    )
    body = ss.SpringBlock(10.0, 2e4, 1e4, damping=50.0)
    changes = steady_proof.proven_changes(rigid.ANSWERS.judge(body, 1e4, 2), law, 0.0, (9e-4, 2e-3))

    def stable(v: float) -> bool:
        z = v / 1.2  # x = z, and (v - z)/T = c z
        matrix = [[0.0, -2e4, 0.0, 0.0], [0.1, -5.0, 1e3 * 10.0 * z, 0.0], [0.0, 0.0, -100.0, 100.0], [0.0, 100.0, -20.0, -100.0]]
        return bool(np.linalg.eigvals(np.array(matrix)).real.max() < 0.0)

    (change,) = changes
    assert stable(change.low * (1.0 - 1e-6)) != stable(change.high * (1.0 + 1e-6))
    assert change.stable_above == stable(0.9) != stable(1e-3)


@pytest.mark.sampled(every=2)
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


@pytest.mark.parametrize("seed", range(2))
def test_friction_that_is_the_same_at_any_rate_changes_nothing(seed: int):
    """Dahl's law neither damps nor drives an undamped block: rounding must not look like changes of stability."""
    drawn = np.random.default_rng(seed)
    law = ss.friction.Dahl(sliding=drawn.uniform(0.05, 0.9), stiffness=10.0 ** drawn.uniform(2, 6))
    body = ss.SpringBlock(10.0 ** drawn.uniform(-3, 4), 10.0 ** drawn.uniform(1, 9), 10.0 ** drawn.uniform(0, 7))
    found = steady_slidings(ss.Problem(body, law, pull_rate=10.0 ** drawn.uniform(-9, 1)))
    assert found.changes == ()
    assert found.slidings[0].stable is None


def slopes_at(law: Any, rate: float) -> tuple[float, float, float, float]:
    """Return mu_v, mu_theta, f_v and f_theta of a rate-and-state law in steady sliding, by central differences."""

    def slope(f: Any, x: float) -> float:
        step = 1e-6 * abs(x)
        return (f(x + step) - f(x - step)) / (2.0 * step)

    theta = law.distance / rate
    change = {"ageing": lambda y: 1.0 - y, "slip": lambda y: -y * math.log(y)}[law.evolution]
    mu_v = slope(lambda v: float(law.coefficient(0.0, v, math.log(law.rate * theta / law.distance))), rate)
    mu_t = slope(lambda t: float(law.coefficient(0.0, rate, math.log(law.rate * t / law.distance))), theta)
    f_v = slope(lambda v: change(v * theta / law.distance), rate)
    f_t = slope(lambda t: change(rate * t / law.distance), theta)
    return mu_v, mu_t, f_v, f_t


def roots_are_left(law: Any, body: ss.SpringBlock, rate: float) -> bool:
    """Return True if all eigenvalues of the block's equations of motion are to the left."""
    mu_v, mu_t, f_v, f_t = slopes_at(law, rate)
    # the unknowns are the force of the spring, the slip rate and the state
    m, d, k, s = body.mass, body.damping, body.stiffness, body.normal_force
    matrix = np.array([[0.0, -k, 0.0], [1.0 / m, -(d + s * mu_v) / m, -s * mu_t / m], [0.0, f_v, f_t]])
    return bool(np.linalg.eigvals(matrix).real.max() < 0.0)


def modes_are_left(law: Any, slab: ss.ElasticSlab, rate: float, points: int = 40) -> bool:
    """Return True if all eigenvalues of a slab are to the left whose wave on its round trip is a polynomial on Chebyshev's points.

    Eigenvalues at frequencies above 20/R are left out: there are too few points for them.
    """
    mu_v, mu_t, f_v, f_t = slopes_at(law, rate)
    z, s, mass = slab.impedance, slab.normal_stress, slab.contact_mass
    # the unknowns are the wave, which leaves at its last point and is back at its first, the state, and the slip rate of a mass
    x = np.cos(np.pi * np.arange(points + 1) / points)
    weight = np.r_[2.0, np.ones(points - 1), 2.0] * (-1.0) ** np.arange(points + 1)
    by_place = np.outer(weight, 1.0 / weight) / (x[:, None] - x + np.eye(points + 1))
    by_place -= np.diag(by_place.sum(axis=1))
    size = points + 1 + (mass > 0.0)
    load, state = np.eye(size)[0], np.eye(size)[points]
    slip_rate = np.eye(size)[points + 1] if mass else (load - s * mu_t * state) / (z + s * mu_v)
    leaves = slab.reflection * (2.0 * z * slip_rate - load)
    wave = np.vstack((np.eye(points, size), leaves))
    matrix = np.zeros((size, size))
    matrix[:points] = -2.0 / slab.two_way_time * by_place[:points] @ wave
    matrix[points] = f_v * slip_rate + f_t * state
    if mass:
        matrix[points + 1] = (load - (z + s * mu_v) * slip_rate - s * mu_t * state) / mass
    modes = np.linalg.eigvals(matrix)
    return bool(modes.real[np.abs(modes.imag) * slab.two_way_time < 20.0].max() < 0.0)


def is_said_stable(found: Any, rate: float) -> bool:
    """Return whether sliding at a rate is stable according to the changes on both sides of it."""
    below, above = ([one for one in found.changes if (one.rate < rate) is side] for side in (True, False))
    if below:
        return bool(below[-1].stable_above)
    return not above[0].stable_above if above else bool(found.slidings[0].stable)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("seed", range(6))
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
            assert roots_are_left(law, body, rate) == is_said_stable(found, rate), rate


@pytest.mark.sampled(every=16)
@pytest.mark.parametrize("seed", range(16))
def test_slabs_drawn_at_random_change_where_eigenvalues_do(seed: int):
    """Eigenvalues of a slab whose waves are polynomials have the sign that the proof says, at 15 rates away from the changes."""
    drawn = np.random.default_rng(seed)
    distance, z = 10.0 ** drawn.uniform(-6, -3), 9.8e6
    a, b = drawn.uniform(0.004, 0.012), drawn.uniform(0.006, 0.02)
    law = ss.friction.RateAndState(reference=0.6, a=a, b=b, distance=distance, rate=1e-6, evolution=("ageing", "slip")[seed % 2])
    slow = NORMAL * max(b - a, 1e-3) / distance
    thickness = 3.43e10 / (slow * drawn.choice([0.8, 1.5, 4.0]))
    driver = (math.inf, z * 10.0 ** drawn.uniform(0.5, 3), z * 10.0 ** drawn.uniform(-1, 0.5), 0.0)[seed // 2 % 4]
    mass = drawn.choice([0.0, 0.3]) * 2800.0 * thickness
    slab = ss.ElasticSlab(2800.0, 3500.0, thickness, NORMAL, driver_impedance=driver, contact_mass=mass)
    problem = ss.Problem(slab, law, pull_rate=1e-6, initial_rate="steady")
    found = proven_slidings(problem)
    assert found.proven
    assert [one.rate for one in found.changes] == pytest.approx([one.rate for one in steady_slidings(problem).changes], rel=1e-8)
    for rate in np.geomspace(1e-4, 30.0, 15) * distance / slab.two_way_time:
        if all(abs(rate / one.rate - 1.0) > 1e-2 for one in found.changes):
            assert modes_are_left(law, slab, float(rate)) == is_said_stable(found, float(rate)), rate


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("driver", [1e6, 9.8e6])
@pytest.mark.parametrize("mass", [0.0, 1e4])
def test_a_driver_that_gives_way_lets_slow_sliding_run_away(driver: float, mass: float):
    """With Zd <= Z sliding is unstable up to v = S (b - a)/Zd, where friction falls as fast as the driver gives way."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 10.0, NORMAL, driver_impedance=driver, contact_mass=mass)
    found = proven_slidings(ss.Problem(slab, ss.friction.RateAndState(**WEAKER), pull_rate=1e-6, initial_rate="steady"))
    (change,) = found.changes
    exact = NORMAL * 0.005 / driver
    assert (found.proven, change.stable_above) == (True, True)
    assert change.enclosure[0] < exact < change.enclosure[1] < change.enclosure[0] * (1.0 + 1e-6)
    assert "(proven by interval arithmetic between 1e-15 and 1000 m/s)" in str(found)


def test_two_close_changes_of_a_slab_are_told_apart_and_one_that_only_touches_is_not_proven():
    """Friction z^3/3 - e^2 z of a state z' = (v - v0 - z)/T falls between v0 - e and v0 + e: there a rigid driver is no help."""
    slab = ss.ElasticSlab(2800.0, 3500.0, 10.0, NORMAL)

    def changes(half_width: float) -> Any:
        law = ss.friction.FromExpression(
            "f + A*(z**3/3 - e**2*z)",
            {"f": 0.4, "A": 10.0, "e": half_width, "v0": 0.5, "T": 1e-3},
            evolution="dz/dt = (v - v0 - z)/T",
        )
        return steady_proof.proven_changes(uniform.ANSWERS.judge(slab, NORMAL, 1), law, 0.0, (0.1, 1.0))

    first, second = changes(1e-4)
    assert (first.stable_above, second.stable_above) == (False, True)
    for found, exact in ((first, 0.4999), (second, 0.5001)):
        assert found.low < exact < found.high < found.low * (1.0 + 1e-6)
    assert changes(0.0) is None


def drawn_slab(drawn: np.random.Generator) -> ss.ElasticSlab:
    own = 10.0 ** drawn.uniform(-1.0, 1.0)
    driver = (math.inf, 0.0, own, *(own * 10.0 ** drawn.uniform(-1.5, 1.5, 3)))[drawn.integers(0, 6)]
    mass = drawn.choice([0.0, 10.0 ** drawn.uniform(-2.0, 1.5)])
    return ss.ElasticSlab(own, 1.0, 10.0 ** drawn.uniform(-2.3, 1.2), 1.0, driver_impedance=driver, contact_mass=mass)


def count_says_stable(slab: ss.ElasticSlab, slopes: Any) -> bool | None:
    """Return the verdict of Nyquist's count of roots."""
    mu_v, mu_w, f_v, f_w = slopes.tolist()
    response = Response(np.array([mu_w * f_v - mu_v * f_w, mu_v]), np.array([-f_w, 1.0]))
    return modes_of(slab, 1.0, response).verdict


def close_to_its_edge(drawn: np.random.Generator, slab: ss.ElasticSlab, slopes: Any, width: float) -> ss.ElasticSlab:
    """Return the slab with a thickness at which stability changes, or with its own if all are the same, moved by about `width`."""
    low, high = 1e-3 * slab.thickness, 1e2 * slab.thickness
    thick = count_says_stable(replace(slab, thickness=high), slopes)
    if thick != count_says_stable(replace(slab, thickness=low), slopes):
        for _ in range(14):
            middle = math.sqrt(low * high)
            low, high = (low, middle) if count_says_stable(replace(slab, thickness=middle), slopes) == thick else (middle, high)
        slab = replace(slab, thickness=high)
    return replace(slab, thickness=slab.thickness * (1.0 + width * drawn.uniform(-1.0, 1.0)))


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("width", [0.0, 0.3])
@pytest.mark.parametrize("late", [-1.0, 1.0])
def test_no_slopes_in_a_cell_that_is_decided_have_another_count_of_roots(width: float, late: float):
    """Nyquist's count of roots at slopes in 60 cells: rigid drivers, soft ones and dead loads, with mass and without.

    Many slabs are about as thick as one that changes its stability, so that the bounds have nothing to spare.
    """
    drawn = np.random.default_rng(int(1e4 * width) + (late > 0.0))
    decided = 0
    for _ in range(60):
        slab, sign = drawn_slab(drawn), drawn.choice([-1.0, 1.0], p=[0.3, 0.7])
        fade = 10.0 ** drawn.uniform(-1.5, 1.5)
        middle = slab.impedance * np.array([sign * 10.0 ** drawn.uniform(-2, 1), late * fade * 10.0 ** drawn.uniform(-2, 2)])
        middle = np.array([*middle, 1.0, -fade])
        radius = width * 10.0 ** drawn.uniform(-1, 0) * np.abs(middle) * drawn.uniform(0, 1, 4) * [1, 1, 0, 1]
        slab = close_to_its_edge(drawn, slab, middle, width or 0.1)
        discs = {
            name: Disc.of(np.array([at]), np.array([by]))
            for name, at, by in zip(itertools.chain(*slope_symbols(1)), middle.tolist(), radius.tolist(), strict=True)
        }
        with np.errstate(all="ignore"):
            stable, unstable = (bool(one[0]) for one in of_slab(slab, 1.0, discs))
        assert not (stable and unstable)
        decided += stable or unstable
        ends = (-1.0, 1.0) if width else (0.0,)
        for place in itertools.product(ends, ends, (0.0,), ends):
            slopes = middle + np.array(place) * radius
            truth = count_says_stable(slab, slopes) if stable or unstable else None
            assert truth is None or not (unstable if truth else stable), (slab, slopes)
    assert decided >= (60 if width == 0.0 else 40)


def test_discs_that_do_not_hold_the_steady_states_prove_nothing(monkeypatch: pytest.MonkeyPatch):
    """With discs half as wide as the change of the state in a cell no cell is decided."""
    law = ss.friction.RateAndState(**WEAKER)
    body = ss.SpringBlock(10.0, 3.0 * CRITICAL, NORMAL)
    assert steady_proof.proven_changes(rigid.ANSWERS.judge(body, NORMAL, 1), law, 0.0, (1e-9, 1e-3)) == []
    monkeypatch.setattr(steady_proof, "WIDER", 0.5)
    assert steady_proof.proven_changes(rigid.ANSWERS.judge(body, NORMAL, 1), law, 0.0, (1e-9, 1e-3)) is None
