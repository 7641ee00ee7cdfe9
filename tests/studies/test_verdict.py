"""Verdicts on made-up errors whose order is known, and differences between runs that are known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.studies.regularisations import difference, passage
from stickslip.studies.verdict import Errors, Verdict, groups, judge, local_orders, order_of

SIZES = 0.1 / 4.0 ** np.arange(8)
NEAR, FAR = ("perfect-delay",), ("maxwell",)


def verdict(near: object, far: object, changes: object, apart: float = 1.0, floor: float = 1e-9) -> Verdict:
    fill = np.ones(8)
    return judge(Errors(SIZES, {NEAR: near * fill, FAR: far * fill}, changes * fill, {NEAR: apart, FAR: apart}, floor))


@pytest.mark.parametrize("power", [0.5, 2 / 3, 1.0])
def test_a_power_is_found(power: float) -> None:
    found = verdict(0.3 * SIZES**power, 1.0, SIZES**power)
    assert found.rules == NEAR
    for order in (found.order.power, found.order.first, found.order.last):
        assert order == pytest.approx(power, rel=1e-9, abs=0.0)
    assert found.order.points == 4
    assert f"order {power:.2f}" in found.text


def test_the_order_is_that_of_the_smallest_sizes() -> None:
    errors = SIZES + 0.02 * SIZES**0.5
    order = order_of(SIZES, errors)
    assert order.last < order.power < order.first < 1.0
    assert local_orders(SIZES, errors)[1:] == pytest.approx(np.diff(np.log(errors)) / np.diff(np.log(SIZES)), rel=1e-12, abs=0.0)
    assert math.isnan(local_orders(SIZES, errors)[0])


def test_errors_below_the_accuracy_are_left_out() -> None:
    errors = np.maximum(SIZES**2, 1e-6) * np.where(np.arange(8) % 2, 1.0, 0.9)
    order = order_of(SIZES, np.maximum(SIZES**2, 1e-6), floor=2e-6)
    assert order.power == pytest.approx(2.0, rel=1e-9, abs=0.0)
    assert math.isnan(order_of(SIZES, errors, floor=1.0).power)


def test_errors_at_the_accuracy_are_an_answer_without_an_order() -> None:
    found = verdict(1e-12, 1.0, 1e-12)
    assert found.rules == NEAR
    assert "cannot be measured" in found.text


def test_a_limit_far_from_every_rule_is_no_rule() -> None:
    found = verdict(0.5 + SIZES, 0.6, SIZES)
    assert found.rules == ()
    assert "an answer of their own, order 1.00" in found.text


def test_runs_that_do_not_settle_are_no_rule() -> None:
    found = verdict(0.5 + 0.1 * np.sin(np.arange(8)), 0.6, 0.2)
    assert found.rules == ()
    assert found.text.startswith("no rule yet")


def test_near_a_rule_but_not_falling_is_no_rule() -> None:
    assert verdict(0.2, 1.0, 1e-12).rules == ()


def test_rules_with_the_same_answer_are_one_group() -> None:
    apart = {(a, b): 0.0 if "x" not in (a, b) or a == b else 1.0 for a in "axb" for b in "axb"}
    assert groups("axb", apart, 0.1) == [("a", "b"), ("x",)]


SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)


def coulomb(dynamic: float) -> ss.Solution:
    return ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, dynamic), initial_load=80e6 * (1 + 1e-15 * 8)), 8.0)


def test_the_difference_of_two_coulomb_runs_has_its_closed_form() -> None:
    """Both slide at (beta - muD S)/Z for one round trip R, then rest: |difference| = dv t up to R, then dv R."""
    one, other = coulomb(0.3), coulomb(0.5)
    found = difference(one, other, 8.0)
    gap, trip = 0.2 * SLAB.normal_stress / SLAB.impedance, SLAB.two_way_time
    assert found.largest == pytest.approx(gap * trip, rel=1e-12, abs=0.0)
    assert found.end == pytest.approx(gap * trip, rel=1e-12, abs=0.0)
    assert found.mean == pytest.approx(gap * trip * (8.0 - trip / 2) / 8.0, rel=1e-9, abs=0.0)
    assert difference(other, one, 8.0).end == -found.end


def test_passage_has_its_closed_form() -> None:
    """v = v0 (1 - exp(-Z t / m)) under Coulomb friction on a contact with mass."""
    slab = ss.ElasticSlab(2800, 3500, 1e4, 1e8, contact_mass=9.8e6)
    run = ss.simulate(ss.Problem(slab, ss.friction.Coulomb(0.8, 0.3), initial_load=81e6), 5.0)
    fastest = 51e6 / slab.impedance
    assert passage(run, 0.5 * fastest, True, 0.0, (0.0, 5.0)) == pytest.approx(math.log(2.0), rel=1e-9, abs=0.0)
    assert math.isnan(passage(run, 0.5 * fastest, False, 0.0, (0.0, 5.0)))
    assert math.isnan(passage(run, 2.0 * fastest, True, 0.0, (0.0, 5.0)))
