"""Steady sliding and rest on layers: growth rates against those of a uniform slab, other methods, and exact runs."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.contact.disturbance import Response
from stickslip.contact.layer_response import growth_on_layers, response_of, taken_by_layers
from stickslip.contact.steady import steady_slidings
from stickslip.problem.bodies import OfLayers
from stickslip.run.check.stability import stability_of
from stickslip.run.reference.slab import growth_rate
from tests.core.contact.modes import modes_of

DENSITY, SPEED, THICKNESS, S = 2800.0, 3500.0, 1e4, 1e8
Z, R = DENSITY * SPEED, 2 * THICKNESS / SPEED
AGEING = {"a": 0.01, "b": 0.015, "rate": 1e-6, "reference": 0.6, "distance": 0.1}


def cut(*shares: float, driver: float = math.inf, mass: float = 0.0) -> ss.LayeredSlab:
    """The paper's slab cut into layers of one kind, which have these shares of its thickness."""
    count = len(shares)
    thickness = [THICKNESS * share for share in shares]
    return ss.LayeredSlab(thickness, [DENSITY] * count, [SPEED] * count, S, driver_impedance=driver * Z, contact_mass=mass)


def uniform(driver: float = math.inf, mass: float = 0.0) -> ss.ElasticSlab:
    return ss.ElasticSlab(DENSITY, SPEED, THICKNESS, S, driver_impedance=driver * Z, contact_mass=mass)


def soft(**numbers: float) -> ss.LayeredSlab:
    return ss.LayeredSlab([1e3, 8e3], [DENSITY] * 2, [SPEED / 2, SPEED], S, **numbers)


def two(sides: str, **numbers: float) -> ss.TwoSlabs:
    """Unlike slabs, one of two layers, on both sides of a contact."""
    return ss.TwoSlabs([1e3, 4e3], [DENSITY] * 2, [SPEED / 2, SPEED], [3e3], [7000.0], [SPEED], S, sides=sides, **numbers)


def response(body: OfLayers, s: np.ndarray) -> np.ndarray:
    above, below = response_of(body, s)
    return above / below


# ---- layers of one kind are a uniform slab ----------------------------------------------------------------------------------


@pytest.mark.parametrize("driver", [math.inf, 3.0, 0.4, 0.0, 1.0])
def test_layers_of_one_kind_resist_as_a_uniform_slab_does(driver: float):
    """Z (1 - r E)/(1 + r E), to 1e-13 at 200 places in both halves of the plane; slow ones keep their digits."""
    draw = np.random.default_rng(5)
    s = draw.uniform(-1.0, 3.0, 200) + 1j * draw.uniform(-30.0, 30.0, 200)
    echo = uniform(driver).reflection * np.exp(-s * R)
    assert response(cut(0.2, 0.5, 0.3, driver=driver), s) == pytest.approx(Z * (1 - echo) / (1 + echo), rel=1e-11)
    slow = np.array([1e-15, 1e-12j])
    if driver == math.inf:
        assert response(cut(0.2, 0.8), slow) * slow == pytest.approx(Z * SPEED / THICKNESS, rel=1e-14)


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("driver", [math.inf, 3.0, 0.4, 0.0, 1.0])
@pytest.mark.parametrize("share", [-1.1, -0.97, -0.5, -1e-7, 0.0, 0.3])
def test_without_mass_they_grow_as_on_a_uniform_slab(driver: float, share: float):
    felt = Response(np.array([share * Z / S]), np.ones(1))
    known, found = modes_of(uniform(driver), S, felt), modes_of(cut(0.2, 0.8, driver=driver), S, felt)
    assert found.growth().rate == pytest.approx(known.growth().rate, rel=1e-9, abs=0.0)
    assert found.verdict is known.verdict


@pytest.mark.sampled(every=16)
@pytest.mark.parametrize("seed", range(16))
def test_with_mass_and_states_they_grow_or_fade_as_on_a_uniform_slab(seed: int):
    draw = np.random.default_rng(seed)
    numbers = {"driver": 10.0 ** draw.uniform(-1, 1) if seed % 4 else math.inf}
    numbers["mass"] = 10.0 ** draw.uniform(4, 8) if seed % 3 else 0.0
    time, high, low = R * 10.0 ** draw.uniform(-1.5, 1.5), draw.uniform(-0.9, 1.5), draw.uniform(-2.0, 2.0)
    felt = Response(np.array([low, high * time]) * Z / S, np.array([1.0, time]))
    known, found = modes_of(uniform(**numbers), S, felt), modes_of(cut(0.1, 0.3, 0.6, **numbers), S, felt)
    assert found.growth().rate == pytest.approx(known.growth().rate, rel=1e-9, abs=0.0)
    assert found.verdict is known.verdict


@pytest.mark.parametrize("driver", [0.01, 0.4, 1.0, 3.0])
def test_they_take_away_what_a_uniform_slab_does(driver: float):
    assert taken_by_layers(cut(0.2, 0.8, driver=driver)) == pytest.approx(min(driver, 1.0 / driver) * Z, rel=1e-12)


def test_a_disturbance_of_rest_grows_as_on_a_uniform_slab_and_slower_where_layers_are_softer():
    for weakening in (3.5e6, 1e7, 2.5e8):
        assert growth_on_layers(cut(0.2, 0.8), weakening) == pytest.approx(growth_rate(uniform(), weakening / S), rel=1e-12)
    assert growth_on_layers(cut(0.2, 0.8), 3.4e6) == 0.0
    law = ss.friction.SinusoidalSlip(0.6, 0.3, 1.0)
    text = stability_of(ss.Problem(soft(), law, initial_slip=3.14, initial_excess=0.0))
    above = brentq(lambda s: s * response(soft(), np.array([s + 0j]))[0].real - 0.3 * S * abs(math.cos(3.14)), 1e-3, 1e3)
    assert f"a small disturbance grows at {above:.6g} /s" in text


# ---- unlike layers, and two sides -------------------------------------------------------------------------------------------

BODIES = {
    "soft layer": soft(),
    "soft layer on a half-space": soft(driver_impedance=3e6),
    "soft layer and a mass": soft(contact_mass=1e5),
    "apart": two("apart"),
    "joined": two("joined"),
    "joined, giving way": two("joined", driver_impedance=2e7, other_driver_impedance=5e6),
}


@pytest.mark.parametrize("name", BODIES)
def test_slow_disturbances_meet_springs_in_series(name: str):
    body = BODIES[name]
    if body.is_driven_rigidly:
        s = np.array([1e-9 + 0j])
        assert (s * response(body, s)).real == pytest.approx(body.stiffness, rel=1e-12)


@pytest.mark.parametrize("name", BODIES)
def test_layers_only_take_energy(name: str):
    draw = np.random.default_rng(1)
    s = 10.0 ** draw.uniform(-4, 1, 400) + 1j * draw.uniform(-40, 40, 400)
    assert (response(BODIES[name], s).real > 0.0).all()


@pytest.mark.sampled(every=6)
@pytest.mark.parametrize("name", BODIES)
def test_no_root_lies_farther_right_than_the_one_that_is_found(name: str):
    """Newton's method from 3 000 places finds none, and the one found solves the equation to 1e-9 of Z."""
    body, time = BODIES[name], 2.0
    felt = Response(np.array([-0.3, 0.4 * time]) * body.impedance / S, np.array([1.0, time]))
    rate, frequency = modes_of(body, S, felt).growth()

    def miss(s: np.ndarray) -> np.ndarray:
        phi = np.polyval(felt.numerator[::-1], s) / np.polyval(felt.denominator[::-1], s)
        return (body.contact_mass * s + response(body, s) + S * phi) / body.impedance

    if rate != 0.0:  # which stands for modes that fade ever more slowly, under a rigid driver
        assert abs(miss(np.array([complex(rate, frequency)]))[0]) < 1e-9
    draw = np.random.default_rng(7)
    s = draw.uniform(-1.0, 2.0, 3000) + 1j * draw.uniform(0.0, 30.0, 3000)
    with np.errstate(all="ignore"):
        for _ in range(30):
            step = 1e-7 * (abs(s) + 1e-3)
            here = miss(s)
            s = s - here * step / (miss(s + step) - here)
        roots = s.real[abs(miss(s)) < 1e-8]
    assert len(roots) > 100
    assert roots.max() <= rate + 1e-7 * abs(rate)
    assert modes_of(body, S, felt).verdict is (rate <= 0.0)


@pytest.mark.sampled(every=4)
@pytest.mark.parametrize(("name", "rate"), [("soft layer", 0.1), ("soft layer and a mass", 0.1), ("apart", 0.1), ("joined", 0.02)])
def test_a_small_disturbance_of_an_exact_run_grows_as_it_is_said_to(name: str, rate: float):
    """From a slip rate that is 1e-7 off, after other modes have faded: to 1e-3 in each period."""
    distance = 0.01 if name == "joined" else 0.1  # joined sides are stiffer
    body, law = BODIES[name], ss.friction.RateAndState(**(AGEING | {"distance": distance}))
    found = steady_slidings(ss.Problem(body, law, pull_rate=rate, initial_rate="steady")).slidings[0]
    assert found.growth > 0.0
    run = ss.simulate(ss.Problem(body, law, pull_rate=rate, initial_rate=rate * (1.0 + 1e-7)), 8.0 * found.period, rtol=1e-12)
    times = np.arange(4.0, 7.5, 0.5) * found.period
    apart = run.slip_rate(times) - rate
    assert -apart[1:] / apart[:-1] == pytest.approx(math.exp(0.5 * found.growth * found.period), rel=1e-3)


def test_two_drivers_that_give_way_are_one():
    """Joined sides meet the sum of the drivers, sides apart what they are in series: Zd v + S mu(v) = s + Zd V."""
    law, load, pull = ss.friction.HyperbolicRate(0.8, 0.3, 0.01), 9e7, 12.0
    for sides, together in (("joined", 2e7 + 5e6), ("apart", 1.0 / (1.0 / 2e7 + 1.0 / 5e6))):
        body = two(sides, driver_impedance=2e7, other_driver_impedance=5e6)
        (one,) = steady_slidings(ss.Problem(body, law, pull_rate=pull, initial_load=load)).slidings
        assert together * one.rate + one.traction == pytest.approx(load + together * pull, rel=1e-12)
        run = ss.simulate(ss.Problem(body, law, pull_rate=pull, initial_load=load), "200 s")
        assert run.slip_rate(200.0) == pytest.approx(one.rate, rel=1e-6)


# ---- drag behind drivers that give way --------------------------------------------------------------------------------------

STRENGTHENS = ss.friction.FromExpression("0.6 + 0.05*tanh(v/0.5)")
DRAGGED = {"driver_impedance": 5e6, "drag": [300.0, 100.0]}
ON_BOTH = {"other_driver_impedance": 8e6, "other_drag": [200.0]}


@pytest.mark.sampled(every=14)
@pytest.mark.parametrize("far", [None, "66 MPa"])
@pytest.mark.parametrize(
    "body",
    [
        soft(**DRAGGED),
        soft(**DRAGGED | {"driver_impedance": 0.0}),
        two("apart", **DRAGGED | ON_BOTH),
        two("joined", **DRAGGED | ON_BOTH),
        two("joined", **DRAGGED | ON_BOTH | {"driver_impedance": 0.0}),
        two("apart", **DRAGGED | ON_BOTH | {"driver_impedance": math.inf}),
        two("apart", **DRAGGED | ON_BOTH | {"other_driver_impedance": math.inf}),
    ],
)
def test_a_run_comes_to_the_steady_sliding_against_drag(body: OfLayers, far: str | None):
    """To 1e-9 after 800 s; and the far stress that is said to keep the pull rate does so, to 1e-12."""
    problem = ss.Problem(body, STRENGTHENS, pull_rate=1.0, initial_excess=0.0, far_stress=far)
    found = steady_slidings(problem)
    (sliding,) = found.slidings
    assert sliding.stable
    assert float(ss.simulate(problem, 800.0).slip_rate(800.0)) == pytest.approx(sliding.rate, rel=1e-9, abs=0.0)
    assert abs(sliding.rate - 1.0) > 1e-3
    if body.driver_impedance:
        kept = ss.Problem(body, STRENGTHENS, pull_rate=1.0, initial_excess=0.0, far_stress=found.traction_at_pull_rate)
        assert steady_slidings(kept).slidings[0].rate == pytest.approx(1.0, rel=1e-12, abs=0.0)
