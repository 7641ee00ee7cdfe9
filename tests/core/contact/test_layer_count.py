"""Verdicts and growth rates of sliding layers against mpmath, a search without counts, and each other; discs against values."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact import layer_count
from stickslip.contact.disturbance import Response
from stickslip.contact.layer_discs import LinePieces
from stickslip.contact.layer_modes import LayerModes
from stickslip.contact.layer_response import response_of
from stickslip.contact.sliding import Sliding
from stickslip.contact.steady import _Steady, steady_slidings
from stickslip.contact.wave_modes import Growth
from stickslip.problem.bodies import OfLayers
from tests.core.contact.layer_truth import exact_root, sought_roots
from tests.core.contact.modes import modes_of

BUNDLED = ("pipe-and-collar", "low-velocity-zone", "bowed-string-tenth", "steel-on-granite")
APART = ss.TwoSlabs([153.182], [1522.85], [3978.43], [64.585], [2281.08], [1333.82], 215497, driver_impedance=6.05855e6)
TWO_STATES = ss.friction.TwoStateRateAndState(
    reference=0.6, a=0.0113806, b=0.0132177, distance=7.56559e-3, second_b=-0.00510055, second_distance=0.121047, rate=19.9491e-3
)
FEW = 30
"""With more roots than this a search does not find them all."""
GROWTHS = {0.64: 2.756e-5, 1.0: 1.134e-3, 40.0: 3.21e-5, 60.0: 2.14e-5, 95.7: 1.34e-5, 500.0: 2.57e-6}
"""Growth rate (1/s) of the root farthest to the right on APART under TWO_STATES at slip rates (m/s), by mpmath."""


def sliding_of(body: OfLayers, law: Any, rate: float) -> tuple[Sliding, Response, float]:
    steady = _Steady(ss.Problem(body, law, pull_rate=rate, initial_rate="steady"))
    return steady.sliding(rate), steady.friction.response(rate), steady.problem.normal


def growth_of(sliding: Sliding) -> Growth:
    return Growth(sliding.growth, 2.0 * math.pi / sliding.period)


def drawn_law(draw: np.random.Generator, body: OfLayers) -> tuple[Any, float]:
    """Draw a law with one or two states, and a slip rate, around what decides stability on a body."""
    a = 10.0 ** draw.uniform(-3.0, -1.5)
    b, spring = a * draw.uniform(0.3, 3.0), body.stiffness if body.is_driven_rigidly else body.impedance / body.two_way_time
    distance = 10.0 ** draw.uniform(-1.5, 1.5) * body.normal_load * max(abs(b - a), 1e-4) / spring
    rate = 10.0 ** draw.uniform(-4.0, 4.0) * distance / body.two_way_time
    numbers = {"reference": 0.6, "a": a, "b": b, "distance": distance, "rate": rate}
    if draw.uniform() < 0.6:
        return ss.friction.RateAndState(**numbers), rate
    other = {"second_b": b * draw.uniform(-0.8, 0.8), "second_distance": distance * 10.0 ** draw.uniform(-2.0, 2.0)}
    return ss.friction.TwoStateRateAndState(**numbers, **other), rate


def check_motion(body: OfLayers, law: Any, rate: float, seed: int) -> None:
    """Compare what is said of a motion with itself, and with roots that are sought elsewhere."""
    sliding, felt, normal = sliding_of(body, law, rate)
    assert sliding.stable is not None
    assert sliding.stable is not (sliding.growth > 0.0)
    assert ("unstable" in str(sliding)) is ("grows" in str(sliding) or "at once" in str(sliding))
    roots = sought_roots(body, normal, felt, growth_of(sliding), seed)
    farthest = max(roots.tolist(), key=lambda one: one.real, default=complex(-math.inf))
    if sliding.stable:
        assert farthest.real < 0.0
    else:
        assert sliding.growth * (1.0 + 1e-7) >= farthest.real > 0.0
        if math.isfinite(sliding.growth):
            root = exact_root(body, normal, felt, complex(*growth_of(sliding)))
            assert sliding.growth == pytest.approx(root.real, rel=1e-7, abs=1e-13 * abs(root))


# ---- what was said wrongly --------------------------------------------------------------------------------------------------


def test_slow_sliding_of_a_string_at_a_tenth_of_its_length_grows_at_the_rate_of_the_exact_root():
    body = ss.load_scenario("bowed-string-tenth").problem.body
    distance = 0.3 * body.normal_load * 0.005 / body.stiffness
    rate = 0.01 * distance / body.two_way_time
    law = ss.friction.RateAndState(a=0.010, b=0.015, distance=distance, reference=0.6, rate=rate)
    sliding, felt, normal = sliding_of(body, law, rate)
    assert str(sliding) == "unstable: a small disturbance grows at 0.672106 /s"
    assert sliding.growth == pytest.approx(exact_root(body, normal, felt, 0.672 + 0j).real, rel=1e-12, abs=0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("rate", GROWTHS)
def test_fast_sliding_of_two_slabs_grows_as_slowly_as_the_exact_root_does(rate: float):
    """To 1e-6 of the growth rate, beyond 1e-15 of the root: at 500 m/s it swings 5e9 times as fast as it grows."""
    sliding, felt, normal = sliding_of(APART, TWO_STATES, rate)
    root = exact_root(APART, normal, felt, complex(*growth_of(sliding)))
    assert root.real == pytest.approx(GROWTHS[rate], rel=2e-3, abs=0.0)
    assert sliding.growth == pytest.approx(root.real, rel=1e-6, abs=1e-15 * abs(root))
    assert sliding.stable is False


def test_two_slabs_have_the_critical_rates_at_which_roots_cross_the_axis_and_no_others():
    problem = ss.Problem(APART, TWO_STATES, pull_rate=1.0, initial_rate="steady")
    found = steady_slidings(problem)
    assert [one.rate for one in found.changes] == pytest.approx([2.70163e-5, 0.637151], rel=1e-5, abs=0.0)
    assert [one.stable_above for one in found.changes] == [True, False]
    for change in found.changes:
        below, above = (_Steady(problem).sliding(change.rate * share) for share in (1.0 - 1e-6, 1.0 + 1e-6))
        assert (below.stable, above.stable) == ((False, True) if change.stable_above else (True, False))
        unstable = below if change.stable_above else above
        felt = _Steady(problem).friction.response(change.rate)
        root = exact_root(APART, problem.normal, felt, complex(*growth_of(unstable)))
        assert abs(root.real) < 1e-7 * unstable.growth + 1e-13 * abs(root)


# ---- motions drawn at random ------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("seed", range(6))
def test_no_verdict_on_a_bundled_body_contradicts_its_growth_rate_or_a_root(seed: int):
    draw = np.random.default_rng(100 + seed)
    body = ss.load_scenario(BUNDLED[seed % len(BUNDLED)]).problem.body
    check_motion(body, *drawn_law(draw, body), seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(180))
def test_no_verdict_of_many_on_bundled_bodies_contradicts_its_growth_rate_or_a_root(seed: int):
    draw = np.random.default_rng(1000 + seed)
    body = ss.load_scenario(BUNDLED[seed % len(BUNDLED)]).problem.body
    check_motion(body, *drawn_law(draw, body), seed)


def drawn_body(draw: np.random.Generator) -> OfLayers:
    """Draw layers on one side or on both, with any drivers, some with drag or a mass at the contact."""

    def layers() -> list[list[float]]:
        number = int(draw.integers(1, 3))
        ranges = (1.0, 3.0), (3.0, 3.6), (2.7, 3.8)
        return [[10.0 ** draw.uniform(*both) for _ in range(number)] for both in ranges]

    def driver() -> float:
        return float(draw.choice([math.inf, 0.0, 10.0 ** draw.uniform(5.0, 8.0)]))

    one, other, normal = layers(), layers(), 10.0 ** draw.uniform(4.0, 8.5)
    numbers: dict[str, Any] = {"driver_impedance": driver(), "travel_time_error": 0.05}
    kind, mass = draw.integers(0, 3), 10.0 ** draw.uniform(1.0, 6.0) * float(draw.integers(0, 2))
    if kind == 0:
        drag = [10.0 ** draw.uniform(1.0, 4.0)] * len(one[0]) if draw.integers(0, 2) else None
        return ss.LayeredSlab(*one, normal, contact_mass=mass, drag=drag, **numbers)
    numbers["other_driver_impedance"] = driver()
    if kind == 1:
        return ss.TwoSlabs(*one, *other, normal, **numbers)
    return ss.TwoSlabs(*one, *other, normal, sides="joined", contact_mass=mass, **numbers)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(100))
def test_no_verdict_on_layers_drawn_at_random_contradicts_its_growth_rate_or_a_root(seed: int):
    draw = np.random.default_rng(3000 + seed)
    body = drawn_body(draw)
    if sum(body.cells.counts) < 200:
        check_motion(body, *drawn_law(draw, body), seed)


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("seed", range(6))
def test_as_many_roots_are_counted_as_are_found(seed: int):
    """On small bodies with a mass, beyond lines with few roots: all of them, each once, by the secant method from 6 000 places."""
    draw = np.random.default_rng(seed)
    body = [
        ss.LayeredSlab([10.0, 20.0], [2000.0] * 2, [1000.0, 2000.0], 1e6, driver_impedance=3e5, contact_mass=500.0),
        ss.TwoSlabs([10.0], [2000.0], [1000.0], [30.0], [2500.0], [1500.0], 1e6, sides="joined", contact_mass=900.0),
    ][seed % 2]
    time = body.two_way_time * 10.0 ** draw.uniform(-0.5, 0.5)
    above = np.array([-draw.uniform(0.3, 2.0), draw.uniform(-0.5, 0.5) * time]) * body.impedance / 1e6
    felt = Response(above, np.array([1.0, time]))
    modes = modes_of(body, 1e6, felt)
    assert isinstance(modes, LayerModes)
    found = sought_roots(body, 1e6, felt, modes.growth(), seed, number=6000)
    found = np.concatenate([found, found.conj()])
    assert modes.growth().rate > 0.0
    compared = 0
    for share in (0.5, 0.8, 0.9, 0.95, 0.99, 1.1):
        line = share * modes.growth().rate
        counted = modes.roots_beyond(line)
        if counted <= FEW:
            beyond = [one for one in found if one.real > line]
            swings = [one.imag if abs(one.imag) > 1e-9 * abs(one) else 0.0 for one in beyond]
            assert counted == len({(f"{one.real:.5e}", f"{swing:.5e}") for one, swing in zip(beyond, swings, strict=True)})
            compared += counted > 0
    assert compared


# ---- how it is known --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", BUNDLED)
@pytest.mark.parametrize("line", [0.0, 0.02, -0.03])
def test_no_phase_turns_by_more_than_its_bound(name: str, line: float):
    """At 4 places of each of 500 pieces; the widest bounds are not more than twice what is found."""
    body, draw = ss.load_scenario(name).problem.body, np.random.default_rng(1)
    period, cells = math.pi / body.cells.time, sum(body.cells.counts)
    s = period * (line + 1j * draw.uniform(0.0, 3.0, 500))
    half = 10.0 ** draw.uniform(-6.0, -1.0, 500) * period / cells
    a, b = np.array([1.3, 0.2 / period]) * body.impedance, np.array([0.7, 0.3 / period])

    def value(at: np.ndarray) -> np.ndarray:
        above, below = response_of(body, at)
        return (a[0] + a[1] * at) * below + (b[0] + b[1] * at) * above

    piece = LinePieces(body, s, half)
    bound = piece.bound(a, b).angle + piece.turned
    known, places = bound < 2.0, np.array([[-1.0], [-0.5], [0.5], [1.0]])
    shares = (np.abs(np.angle(value(s + 1j * places * half) / value(s))) / bound)[:, known]
    assert np.mean(known) > 0.9
    assert 0.5 < np.max(shares) <= 1.0 + 1e-9


@pytest.mark.parametrize("growth", [-1.0, 0.0, 1.0, math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("stable", [True, False, None])
def test_no_sentence_contradicts_its_verdict(stable: bool | None, growth: float):
    text = str(Sliding(1.0, 1.0, (), stable, growth, math.inf))
    assert not (text.startswith("stable") and "grows" in text)
    assert not (text.startswith("unstable") and "fades" in text)


def test_what_takes_too_many_pieces_to_count_is_not_decided(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(layer_count, "CUTS_OF_PIECE", 1)
    monkeypatch.setattr(LayerModes, "found_growing", [])
    sliding = sliding_of(APART, TWO_STATES, 0.64)[0]
    assert sliding.verdict == "not decided"
    assert str(sliding) == "not decided: too many modes, or one of them so close to keeping its size that rounding decides"
    assert not sliding.lasts
