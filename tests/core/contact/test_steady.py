"""Steady sliding: its rates, its growth rates against closed forms and other methods, and the rates at which stability changes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.disturbance import Response
from stickslip.contact.kinds.rigid import ModesOfBlock
from stickslip.contact.steady import steady_slidings
from stickslip.run.reference.rate_and_state import SteadySliding
from tests.core.contact.modes import modes_of

DENSITY, SPEED, THICKNESS, S = 2800.0, 3500.0, 1e4, 1e8
Z, R = DENSITY * SPEED, 2 * THICKNESS / SPEED
STRIBECK = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
AGEING = {"a": 0.01, "b": 0.015, "rate": 1e-6, "reference": 0.6}


def slab(driver: float = math.inf, mass: float = 0.0) -> ss.ElasticSlab:
    """A slab under a driver whose impedance is given as a multiple of its own."""
    return ss.ElasticSlab(DENSITY, SPEED, THICKNESS, S, driver_impedance=driver * Z, contact_mass=mass)


def slope(share: float) -> Response:
    """Friction without states, whose slope by the slip rate is a share of Z."""
    return Response(np.array([share * Z / S]), np.ones(1))


def miss(body: ss.ElasticSlab, response: Response, s: np.ndarray) -> np.ndarray:
    """The characteristic equation as it is derived, over Z: nothing in it is shared with the search for its roots."""
    echo, phi = np.exp(-s * R), np.polyval(response.numerator[::-1], s) / np.polyval(response.denominator[::-1], s)
    waves = (1 - body.reflection * echo) / (1 + body.reflection * echo)
    return body.contact_mass * s / Z + waves + S * phi / Z


# ---- growth of a disturbance ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("driver", [math.inf, 3.0, 0.4, 0.0])
@pytest.mark.parametrize("share", [-0.97, -0.5, -0.2, -1e-7, 0.3])
def test_each_echo_multiplies_a_disturbance_of_a_massless_contact_by_its_gain(driver: float, share: float):
    """abs(r (1 - 2 Z / g')) in one round trip, which closes with a change of sign or without one. To 1e-12."""
    body = slab(driver)
    gain = body.reflection * (2.0 / (1.0 + share) - 1.0)  # of the disturbance itself, with its sign
    found = modes_of(body, S, slope(share))
    rate, frequency = found.growth()
    echoed = math.log(abs(body.reflection)) + math.log1p(-share) - math.log1p(share)
    assert rate == pytest.approx(echoed / R, rel=1e-12, abs=0.0)
    assert frequency == pytest.approx(math.pi / R if gain < 0.0 else 0.0, rel=1e-12, abs=0.0)
    assert found.verdict is (abs(gain) < 1.0)


@pytest.mark.parametrize("share", [-1.1, -3.0])
def test_nothing_stays_where_friction_falls_faster_than_waves_carry_away(share: float):
    assert modes_of(slab(), S, slope(share)).growth().rate == math.inf
    assert modes_of(slab(0.5), S, slope(share)).verdict is False


@pytest.mark.parametrize("share", [0.0, -0.1, 0.1])
def test_a_matched_driver_lets_every_disturbance_leave(share: float):
    assert modes_of(slab(1.0), S, slope(share)).growth().rate == -math.inf


def test_constant_friction_under_a_rigid_driver_is_neutral():
    for body in (slab(), slab(mass=1e6)):
        assert modes_of(body, S, slope(0.0)).verdict is None
        assert modes_of(body, S, slope(0.0)).growth().rate == 0.0
    block = ss.SpringBlock(1.0, 100.0, S)
    assert modes_of(block, S, slope(0.0)).verdict is None
    assert modes_of(block, S, slope(0.0)).growth() == (0.0, 10.0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("rate", [1e-12, 1e-6, 1.0])
@pytest.mark.parametrize("distance", [1e-5, 0.1, 2.0])
def test_growth_under_rate_and_state_is_that_of_the_closed_equation(rate: float, distance: float):
    """Through twelve decades of the pull rate, against Newton's method on S (a - b/(1 + s T))/V + Z coth(s h/c). To 1e-9."""
    law = ss.friction.RateAndState(**AGEING, distance=distance)
    found = steady_slidings(ss.Problem(slab(), law, pull_rate=rate, initial_load=6e7, initial_state=1.0)).slidings[0]
    known = SteadySliding(S, law.a, law.b, distance, rate).slab_growth(Z, 0.5 * R)
    assert found.growth == pytest.approx(known.real, rel=1e-9, abs=0.0)
    assert 2 * math.pi / found.period == pytest.approx(abs(known.imag), rel=1e-9, abs=1e-12 * abs(known.real))


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("seed", range(20))
def test_no_root_lies_farther_right_than_the_one_that_is_found(seed: int):
    """Newton's method from 2 000 places finds none, and the root found solves the equation to 1e-9 of Z."""
    draw = np.random.default_rng(seed)
    body = slab(10.0 ** draw.uniform(-1, 1) if seed % 4 else math.inf, mass=10.0 ** draw.uniform(4, 8) if seed % 3 else 0.0)
    time = R * 10.0 ** draw.uniform(-1.5, 1.5)
    high, low = draw.uniform(-0.9, 1.5), draw.uniform(-2.0, 2.0)  # Phi at high and at low frequencies, in Z
    response = Response(np.array([low, high * time]) * Z / S, np.array([1.0, time]))
    growth, frequency = modes_of(body, S, response).growth()
    s = (draw.uniform(-3.0, 3.0, 2000) + 1j * draw.uniform(0.0, 40.0, 2000)) / R
    with np.errstate(all="ignore"):
        for _ in range(30):
            step = 1e-7 * (abs(s) + 1e-3)
            here = miss(body, response, s)
            s = s - here * step / (miss(body, response, s + step) - here)
        roots = s.real[abs(miss(body, response, s)) < 1e-8]
    assert len(roots) > 100
    if math.isfinite(frequency) and growth != 0.0:
        assert abs(miss(body, response, np.complex128(complex(growth, frequency)))) < 1e-9
    assert max(roots) <= growth + 1e-7 * abs(growth) + 1e-12
    if growth != 0.0:  # which stands for modes that fade ever more slowly, under a rigid driver
        assert modes_of(body, S, response).verdict is (growth < 0.0)


def test_routh_agrees_with_the_roots():
    draw = np.random.default_rng(3)
    for _ in range(300):
        equation = draw.uniform(-0.2, 1.0, draw.integers(2, 6))
        equation[-1] = 1.0
        roots = np.polynomial.polynomial.polyroots(equation)
        if abs(roots.real).min() > 1e-6:
            assert ModesOfBlock(equation).verdict is bool((roots.real < 0.0).all())


def swings(run: ss.Solution, found: Any, start: float) -> np.ndarray:
    """The factors by which a disturbance of the slip rate grows in a period (or 1 / growth), from a time on."""
    step = found.period if math.isfinite(found.period) else 1.0 / abs(found.growth)
    times = np.arange(start, run.duration, step)
    apart = run.slip_rate(times) - found.rate
    return (apart[1:] / apart[:-1]) / math.exp(found.growth * step)


GROWING = {
    "block": (ss.SpringBlock(1.0, 1e3, 10.0, damping=5.0), STRIBECK, 0.08),
    "fading block": (ss.SpringBlock(1.0, 1e3, 10.0, damping=5.0), STRIBECK, 0.12),
    "slab": (slab(), ss.friction.HyperbolicRate(0.8, 0.3, 0.05), 1.0),
    "slab on a half-space": (slab(3.0), ss.friction.HyperbolicRate(0.8, 0.3, 0.15), 1.0),
    "slab with a mass": (slab(mass=3e7), ss.friction.HyperbolicRate(0.8, 0.3, 0.1), 1.0),
    "block, rate and state": (ss.SpringBlock(1e3, 4e8, 1e6), ss.friction.RateAndState(**AGEING, distance=1e-5), 1e-4),
    "slab, rate and state": (slab(mass=1e5), ss.friction.RateAndState(**AGEING, distance=0.1), 0.1),
}


@pytest.mark.sampled(every=7)
@pytest.mark.parametrize("name", GROWING)
def test_a_small_disturbance_of_an_exact_run_grows_as_it_is_said_to(name: str):
    """From a slip rate that is 1e-7 off, after other modes have faded: to 1e-3 in each period."""
    body, law, rate = GROWING[name]
    found = steady_slidings(ss.Problem(body, law, pull_rate=rate, initial_rate="steady")).slidings[0]
    problem = ss.Problem(
        body,
        law,
        pull_rate=rate,
        initial_rate=rate * (1.0 + 1e-7),
        far_stress=found.traction if not body.is_driven_rigidly else None,
    )
    step = found.period if math.isfinite(found.period) else 1.0 / abs(found.growth)
    run = ss.simulate(problem, 10.3 * step, rtol=1e-12)
    assert swings(run, found, 3.1 * step) == pytest.approx(1.0, rel=1e-3)


# ---- a block ----------------------------------------------------------------------------------------------------------------


def test_the_critical_pull_rate_of_a_damped_block_is_proven():
    """S mu'(V) = -D at V = v1 ln(S 0.2 / (v1 D)) = 0.103972 m/s, to 1e-13; the proof encloses it."""
    problem = ss.Problem(ss.SpringBlock(1.0, 1000.0, 10.0, damping=5.0), STRIBECK, pull_rate=0.05, initial_load=0.0)
    found = steady_slidings(problem)
    (change,) = found.changes
    exact = 0.05 * math.log(10.0 * 0.2 / (0.05 * 5.0))
    assert found.proven
    assert change.stable_above
    assert change.pull_rate == change.rate == pytest.approx(exact, rel=1e-13, abs=0.0)
    low, high = change.enclosure
    assert low <= exact <= high
    assert high - low < 1e-14
    assert found.slidings[0].stable is False
    assert found.slidings[0].traction == pytest.approx(3.0 + 2.0 * math.exp(-1.0), rel=1e-14, abs=0.0)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("mass", [1e-3, 1.0, 1e9])
def test_the_critical_stiffness_is_that_of_rice_and_ruina(mass: float):
    """K = S (b - a)/Dc (1 + m V^2/(S a Dc)): a block 1e-9 softer is unstable, one 1e-9 stiffer is stable."""
    law, rate, normal = ss.friction.RateAndState(**AGEING, distance=1e-5), 1e-4, 1e6
    critical = normal * 0.005 / 1e-5 * (1.0 + mass * rate**2 / (normal * 0.01 * 1e-5))
    for share, stable in ((1.0 - 1e-9, False), (1.0 + 1e-9, True)):
        body = ss.SpringBlock(mass, critical * share, normal)
        assert steady_slidings(ss.Problem(body, law, pull_rate=rate)).slidings[0].stable is stable


# ---- drivers that give way --------------------------------------------------------------------------------------------------


def test_a_soft_driver_lets_the_contact_slide_at_another_rate():
    """Zd v + S mu(v) = s + Zd V, with s the initial load; to 1e-12. With s = S mu(V) it slides at the pull rate."""
    law, body = ss.friction.HyperbolicRate(0.8, 0.3, 0.01), slab(2.0)
    found = steady_slidings(ss.Problem(body, law, pull_rate=12.57, initial_load=9e7))
    (one,) = found.slidings
    zd = body.driver_impedance
    assert zd * one.rate + one.traction == pytest.approx(9e7 + zd * 12.57, rel=1e-12, abs=0.0)
    assert one.rate > 12.6
    assert "Not at the pull rate of 12.57 m/s, because the driver gives way" in str(found)
    at_pull = S * float(law.coefficient(0.0, 12.57))
    told = steady_slidings(ss.Problem(body, law, pull_rate=12.57, initial_load=9e7, far_stress=at_pull))
    assert told.slidings[0].rate == pytest.approx(12.57, rel=1e-12, abs=0.0)
    assert "pull rate" not in str(told)


@pytest.mark.parametrize("driver", [0.3, 2.5])
def test_stability_under_a_soft_driver_ends_where_friction_falls_by_what_it_radiates(driver: float):
    """S mu'(v) = -min(Zd, Z^2/Zd), to 1e-12; the pull rate is that of the balance."""
    law, body = ss.friction.HyperbolicRate(0.8, 0.3, 2.0), slab(driver)
    found = steady_slidings(ss.Problem(body, law, pull_rate=5.0, initial_load=6e7))
    (change,) = found.changes
    taken = Z * min(driver, 1.0 / driver)
    exact = (math.sqrt(S * 0.5 * 2.0 / taken) - 1.0) / 2.0
    assert found.proven
    assert change.rate == pytest.approx(exact, rel=1e-12, abs=0.0)
    assert change.pull_rate == pytest.approx(
        exact + (S * float(law.coefficient(0.0, exact)) - 6e7) / body.driver_impedance, rel=1e-12, abs=0.0
    )


def test_a_contact_mass_changes_what_a_soft_driver_withstands():
    """More than Z^2/Zd, which is what it withstands without a mass; seen on both sides of the change, to 1e-9."""
    law, body = ss.friction.HyperbolicRate(0.8, 0.3, 2.0), slab(4.0, mass=2e7)
    found = steady_slidings(ss.Problem(body, law, pull_rate=5.0, initial_load=6e7))
    (change,) = found.changes
    fall = -S * law.slopes(0.0, change.rate)[1]
    assert 0.25 * Z < fall < 4.0 * Z
    assert modes_of(body, S, slope(-fall / Z * (1 + 1e-9))).verdict is False
    assert modes_of(body, S, slope(-fall / Z * (1 - 1e-9))).verdict is True


def test_a_dead_load_has_no_critical_pull_rate():
    law = ss.friction.HyperbolicRate(0.8, 0.3, 1.0)
    found = steady_slidings(ss.Problem(slab(0.0), law, pull_rate=2.6, initial_load=6e7))
    assert [one.rate for one in found.slidings] == pytest.approx([2.0 / 3.0], rel=1e-12, abs=0.0)
    assert found.can_rest
    assert found.changes == ()


def test_what_is_said_of_steady_sliding_behind_a_soft_drive_can_be_printed():
    """Of the bundled drill string, whose strength is a number of numpy."""
    problem = ss.load_scenario("drill-string").problem.parameters["body.driver_impedance"].put(2000.0)
    found = steady_slidings(problem.parameters["loading.pull_rate"].put(8.95))
    assert found.can_rest is False
    assert str(found).startswith("At ")


def test_friction_that_turns_without_end_has_an_answer_without_critical_rates():
    """dmu/dv = 0.05 cos v, which keeps changing its sign: stable or not at the pull rate, and nothing is proven of the rest."""
    for rate, stable in ((1.0, True), (3.0, False)):
        found = steady_slidings(ss.Problem(slab(), "0.5 + 0.05*sin(v)", pull_rate=rate, initial_load=0.0))
        assert found.slidings[0].stable is stable
        assert (found.changes, found.proven) == ((), False)


# ---- what does not slide steadily -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("problem", "why"),
    [
        (ss.Problem(slab(), ss.friction.SinusoidalSlip(1.0, 0.5, 50.0), pull_rate=0.1, initial_load=0.0), "changing with slip"),
        (ss.Problem(slab(), STRIBECK, initial_load=0.0), "nothing pulls"),
        (ss.Problem(slab(2.0), STRIBECK, initial_load=0.0, far_stress_rate=1e3), "the far stress keeps changing"),
        (ss.Problem(slab(0.0), STRIBECK, initial_load=1e7), "does not pull hard enough"),
    ],
)
def test_where_nothing_slides_steadily_the_reason_is_said(problem: ss.Problem, why: str):
    found = steady_slidings(problem)
    assert found.slidings == ()
    assert why in str(found)
    assert found.settled is None


def test_slip_weakening_that_has_ended_slides_steadily():
    law = ss.friction.LinearSlipWeakening(0.8, 0.5, 0.1)
    found = steady_slidings(ss.Problem(slab(), law, pull_rate=0.1, initial_load=0.0))
    assert found.slidings[0].traction == pytest.approx(5e7, rel=1e-14, abs=0.0)
    assert found.slidings[0].stable is None


def test_backward_sliding_mirrors_forward_sliding():
    ahead, back = (
        steady_slidings(ss.Problem(slab(2.0), STRIBECK, pull_rate=sign * 0.3, initial_load=sign * 4e7)).slidings[0]
        for sign in (1, -1)
    )
    assert (back.rate, back.traction, back.growth) == (-ahead.rate, -ahead.traction, ahead.growth)
