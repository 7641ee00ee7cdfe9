"""Every registered law against its own claims, with drawn parameters."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from stickslip import ElasticSlab, InputError, Problem
from stickslip.friction import (
    LAWS,
    Coulomb,
    FrictionLaw,
    FromExpression,
    FromFunction,
    FromTable,
    LinearSlipWeakening,
    SinusoidalSlip,
)
from stickslip.friction.formula.differences import difference
from stickslip.problem.fields import INITIAL_STATES
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from stickslip.problem.scenarios.templates import template
from tests.limits import examples

from .drawn import compiled_value, laws

CHOICE = '# memory = "all"'


@pytest.mark.parametrize("kind", LAWS)
def test_exactly_the_laws_of_slip_offer_a_memory(kind: str) -> None:
    text = template("slab", kind)
    law = read_scenario(text, "new").problem.friction
    assert law.memory == "all"
    offered = "memory" in {field.name for field in fields(law)}
    assert offered == (text.count(CHOICE) == 1 and f'[friction]\nkind = "{kind}"' in text and kind not in ("sum", "product"))
    if kind in ("expression", "sum", "product"):
        return  # the example of an expression has no u; a sum or product has the memory of its slip law
    assert offered == law.depends_on_slip
    if offered:
        healing = read_scenario(text.replace(CHOICE, 'memory = "since-arrest"'), "new")
        assert healing.problem.friction.memory == "since-arrest"
        assert read_scenario(healing.to_toml(), "again").problem == healing.problem


@pytest.mark.parametrize("kind", ["sum", "product"])
def test_a_part_of_a_composite_decides(kind: str) -> None:
    text = template("slab", kind).replace(CHOICE, 'memory = "since-arrest"')
    assert read_scenario(text, "new").problem.friction.memory == "since-arrest"
    assert LAWS["sum"](SinusoidalSlip(0.6, 0.1, 5.0, memory="since-arrest"), Coulomb(0.1, 0.0)).memory == "since-arrest"


def test_memory_cannot_be_given_by_position() -> None:
    assert SinusoidalSlip(1.0, 0.5, 5.0) == SinusoidalSlip(mean=1.0, amplitude=0.5, wavenumber=5.0, memory="all")
    message = "LinearSlipWeakening: takes at most 3 arguments, static, dynamic, distance and by name memory; got 4"
    with pytest.raises(TypeError, match=f"^{message}$"):
        LinearSlipWeakening(0.6, 0.3, 0.1, "since-arrest")  # type: ignore[misc]


def test_what_users_bring_may_heal() -> None:
    made: list[Any] = [
        FromExpression("0.6 - 0.1*tanh(u)", memory="since-arrest"),
        FromFunction(lambda u, v: 0.6 - 0.1 * u / (1.0 + u * u), memory="since-arrest"),
        FromTable(slip=[0.0, 1.0], friction=[0.6, 0.5], memory="since-arrest"),
    ]
    assert [law.memory for law in made] == ["since-arrest"] * 3


REFUSED = {
    "table of rates": lambda: FromTable(rate=[0.0, 1.0], friction=[0.6, 0.5], memory="since-arrest"),
    "expression in v": lambda: FromExpression("0.6 - 0.1*tanh(v)", memory="since-arrest"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_laws_that_do_not_depend_on_slip_refuse_to_forget(name: str) -> None:
    with pytest.raises(InputError, match=r"^\w+: memory 'since-arrest' needs friction that depends on slip; allowed here: all$"):
        REFUSED[name]()


def test_unknown_memories_are_refused() -> None:
    with pytest.raises(InputError, match=r"^LinearSlipWeakening: memory 'since arrest' is unknown; did you mean 'since-arrest'\?$"):
        LinearSlipWeakening(0.6, 0.3, 0.1, memory="since arrest")  # type: ignore[arg-type]
    text = template("slab", "linear-slip-weakening").replace(CHOICE, 'memory = "none"')
    with pytest.raises(InputError, match=r"^new: \[friction\] memory 'none' is unknown; "):
        read_scenario(text, "new")
    text = template("slab", "hyperbolic-rate").replace('kind = "hyperbolic-rate"', 'kind = "hyperbolic-rate"\nmemory = "all"')
    with pytest.raises(InputError, match=r"^new: \[friction\] memory is unknown"):
        read_scenario(text, "new")


KINDS = pytest.mark.parametrize("kind", LAWS)
quick = settings(
    max_examples=examples(16), deadline=None, suppress_health_check=[HealthCheck.filter_too_much, HealthCheck.too_slow]
)
SLIPS = np.concatenate(([0.0], np.geomspace(1e-6, 10.0, 60), np.linspace(0.0, 4.0, 41)))
RATES = np.concatenate(([0.0], np.geomspace(1e-6, 10.0, 60), np.linspace(0.0, 4.0, 41)))


def stretch(law: FrictionLaw, i: int) -> tuple[float, float]:
    """Where piece i holds, cut at 3 m or 3 m/s beyond the last knot."""
    ends = [0.0, *law.knots, (law.knots[-1] if law.knots else 0.0) + 3.0]
    return max(ends[i], 0.0), max(ends[i + 1], 0.0)


def inside(law: FrictionLaw, i: int, data: st.DataObject) -> tuple[float, float]:
    """A slip and a slip rate at which piece i holds, off its knots."""
    share = st.floats(0.05, 0.95)
    low, high = stretch(law, i)
    bound, free = low + data.draw(share) * (high - low), data.draw(st.floats(0.01, 2.0))
    return (bound, free) if law.knot_variable == "slip" else (free, bound)


@pytest.mark.sampled(every=6)
@KINDS
@given(data=st.data())
@quick
def test_friction_stays_in_its_range_is_continuous_at_knots_and_depends_on_what_is_declared(kind: str, data: st.DataObject) -> None:
    law = data.draw(st.sampled_from(data.draw(laws(kind)).ways))
    low, high = law.range()
    mu = law.coefficient(SLIPS[:, None], RATES)
    assert np.isfinite(mu).all()
    assert mu.min() >= low - 1e-12
    assert mu.max() <= high + 1e-12
    assert low >= 0.0
    assert law.static_excess >= 0.0
    assert (law.static_coefficient(SLIPS) >= mu[:, 0] - 1e-15).all()
    assert 0.0 <= law.variation < math.inf
    assert all(0.0 < scale < math.inf for scale in law.rate_scales)
    assert law.depends_on_slip or np.ptp(mu, axis=0).max() == 0.0
    assert law.depends_on_rate or np.ptp(mu, axis=1).max() == 0.0
    assert len(law.pieces) == len(law.knots) + 1 == len(law.trees())
    assert list(law.knots) == sorted(set(law.knots))
    for i, knot in enumerate(law.knots):
        at = (knot, 0.3) if law.knot_variable == "slip" else (0.3, knot)
        assert law.piece_at(*at) == i + 1
        assert law.piece_coefficient(i, *at) == pytest.approx(law.piece_coefficient(i + 1, *at), rel=0, abs=1e-12)


@pytest.mark.sampled(every=5)
@KINDS
@given(data=st.data())
@quick
def test_the_tree_is_the_formula_and_its_slopes_are_derivatives(kind: str, data: st.DataObject) -> None:
    """The tree by `difference`, its rate slope and the slopes, against the numeric formula and central differences."""
    law = data.draw(st.sampled_from(data.draw(laws(kind)).ways))
    i = data.draw(st.integers(0, len(law.pieces) - 1))
    slip, rate = inside(law, i, data)
    start = data.draw(st.floats(0.0, 2.0))
    values = [float(law.piece_coefficient(i, *at)) for at in ((slip, rate), (start, 0.0))]
    step, slope = difference(law.trees()[i], law.numbers(i), start, slip - start, rate)
    size = 1.0 + max(map(abs, values))
    assert float(step) == pytest.approx(values[0] - values[1], rel=0, abs=1e-12 * size)
    eps = 1e-6
    by_rate = float(law.piece_coefficient(i, slip, rate + eps) - law.piece_coefficient(i, slip, rate - eps)) / (2 * eps)
    by_slip = float(law.piece_coefficient(i, slip + eps, rate) - law.piece_coefficient(i, slip - eps, rate)) / (2 * eps)
    wiggle = 1e-4 + 1e-6 * max(abs(by_rate), abs(by_slip)) + 1e-10 * size / eps
    assert float(slope) == pytest.approx(by_rate, rel=1e-4, abs=wiggle)
    if law.piece_at(slip, rate) == i:
        np.testing.assert_allclose(law.slopes(slip, rate)[:2], (by_slip, by_rate), rtol=1e-4, atol=wiggle)


@pytest.mark.sampled(every=7)
@KINDS
@given(data=st.data())
@settings(quick, max_examples=examples(10))
def test_compiled_code_is_the_formula(kind: str, data: st.DataObject) -> None:
    law = data.draw(st.sampled_from(data.draw(laws(kind)).ways))
    i = data.draw(st.integers(0, len(law.pieces) - 1))
    slip, rate = inside(law, i, data)
    reference = law.knots[max(i - 1, 0)] if law.knots and law.knot_variable == "slip" else 0.1
    out = compiled_value(law, i, reference, slip, rate)
    values = [float(law.piece_coefficient(i, *at)) for at in ((slip, rate), (reference, 0.0))]
    assert out[0] == pytest.approx(values[0] - values[1], rel=0, abs=1e-13 * (1.0 + 10.0 * max(map(abs, values))))
    np.testing.assert_allclose(out[:0:-1], law.slopes(slip, rate)[:2], rtol=1e-9, atol=1e-11)


@pytest.mark.sampled(every=5)
@KINDS
@given(data=st.data())
@quick
def test_a_law_written_to_a_scenario_is_read_back_to_the_last_digit(kind: str, data: st.DataObject) -> None:
    law = data.draw(laws(kind))
    start = {"initial_excess": 0.0} if law.sticks else {"initial_load": 6e7} | dict.fromkeys(INITIAL_STATES[: len(law.states)], 1e3)
    scenario = Scenario(Problem(ElasticSlab(2800, 3500, 1e4, 1e8), law, **start), 10.0)
    again = read_scenario(scenario.to_toml(), "written").problem.friction
    assert again == law
    assert repr(again) == repr(law)
    assert hash(again) == hash(law)
    assert (again.coefficient(SLIPS[:, None], RATES) == law.coefficient(SLIPS[:, None], RATES)).all()


CLOSED: dict[str, tuple[dict[str, Any], float, float, float]] = {
    "exponential-slip-weakening": ({"static": 0.7, "dynamic": 0.2, "distance": 0.5}, 0.5, 3.0, 0.2 + 0.5 / math.e),
    "power-slip-weakening": ({"static": 0.6, "dynamic": 0.2, "distance": 0.1, "exponent": 1 / 3}, 0.7, 3.0, 0.4),
    "parabolic-slip-weakening": ({"static": 0.6, "dynamic": 0.4, "distance": 0.4, "onset": 0.1}, 0.0, 0.0, 0.5875),
    "exponential-cohesive-zone": ({"static": 0.6, "dynamic": 0.4, "distance": 0.2, "offset": 0.1}, 0.1, 0.0, 0.6),
    "piecewise-linear-slip": ({"slips": [0.0, 0.1, 0.3], "coefficients": [0.5, 0.6, 0.4]}, 0.2, 9.0, 0.5),
    "piecewise-linear-rate": ({"rates": [0.1, 0.2], "coefficients": [0.5, 0.7]}, 9.0, 0.15, 0.6),
    "exponential-stribeck": (
        {"static": 0.6, "dynamic": 0.4, "rate": 0.1, "exponent": 2, "viscosity": 0.5},
        0.0,
        0.1,
        0.45 + 0.2 / math.e,
    ),
    "carlson-langer": ({"static": 0.6, "drop": 0.1, "rate": 0.5}, 0.0, 1.0, 0.18),
    "both-ways": ({"forward": Coulomb(0.6, 0.5), "backward": Coulomb(0.4, 0.3)}, 0.0, 1.0, 0.5),
    "self-energising": ({"law": Coulomb(0.45, 0.4), "gain": 0.8}, 0.0, 1.0, 0.4 / 0.68),
    "power-stribeck": ({"static": 0.6, "dynamic": 0.4, "rate": 0.1, "exponent": 3}, 0.0, 0.2, 0.4 + 0.2 / 9),
    "velocity-strengthening": (
        {"static": 0.6, "a": 0.01, "rate": 1e-6, "viscosity": 2.0},
        0.0,
        1e-6,
        0.6 + 0.01 * math.log(2) + 2e-6,
    ),
}


@pytest.mark.parametrize("kind", CLOSED)
def test_every_law_has_the_value_worked_out_by_hand(kind: str) -> None:
    fields, slip, rate, mu = CLOSED[kind]
    assert float(LAWS[kind](**fields).coefficient(slip, rate)) == pytest.approx(mu, rel=1e-14, abs=0)


def test_a_composite_combines_its_parts() -> None:
    slip = LAWS["linear-slip-weakening"](0.7, 0.5, 0.4)
    rate = LAWS["hyperbolic-rate"](1.0, 0.5, 1.0)
    product, total = LAWS["product"](slip, rate), LAWS["sum"](slip, Coulomb(0.2, 0.1))
    np.testing.assert_allclose(
        product.coefficient(SLIPS[:, None], RATES), slip.coefficient(SLIPS)[:, None] * rate.coefficient(0.0, RATES), rtol=1e-15
    )
    assert float(total.static_coefficient(0.0)) == pytest.approx(0.9, rel=1e-15)
    assert float(total.coefficient(1.0, 2.0)) == pytest.approx(0.6, rel=1e-15)
    assert (product.counts, product.knots, product.knot_variable) == ("path", (0.4,), "slip")
    assert LAWS["sum"](LAWS["sinusoidal-slip"](1.0, 0.5, 5.0), rate).counts == "net"


BAD = [
    (
        "sum",
        {"slip": "sinusoidal-slip", "rate": "sinusoidal-slip"},
        "rate must be a law of rate only, but sinusoidal-slip depends on slip",
    ),
    (
        "sum",
        {"slip": "hyperbolic-rate", "rate": "hyperbolic-rate"},
        "slip must be a law of slip only, but hyperbolic-rate depends on rate",
    ),
    ("product", {"slip": "sinusoidal-slip", "rate": "coulomb"}, "coulomb steps from static to sliding friction"),
    ("sum", {"slip": "table", "rate": "piecewise-linear-rate"}, "only one part may be piecewise"),
]


@pytest.mark.parametrize(("kind", "parts", "message"), BAD)
def test_parts_that_do_not_fit_are_refused(kind: str, parts: dict[str, str], message: str) -> None:
    made = {place: read_scenario(template("slab", part), "part").problem.friction for place, part in parts.items()}
    with pytest.raises(ValueError, match=message):
        LAWS[kind](**made)
