"""Formulas on discs of complex numbers: no value lies outside, and centres are right to the rounding that is said."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest

from stickslip.friction.formula.bounds import on_discs
from stickslip.friction.formula.operations import OPERATIONS
from stickslip.friction.formula.operations.sets import Disc
from stickslip.friction.formula.text import to_text
from tests.core.engine.balls import DIGITS, EXACT, LEAVES, Drawn, drawn, farthest, values_of

MANY, NOTHING = 500, 1e100
NEGLIGIBLE = 1e-300
"""Size (1) of what underflows."""


def evaluated(one: Drawn, radius: tuple[float, ...]) -> Disc:
    given = (Disc.of(centre, r) for centre, r in zip(one.disc.centre, radius, strict=True))
    return on_discs(one.formula, {}, dict(zip(LEAVES, given, strict=True)))


def test_no_value_on_a_disc_of_complex_numbers_is_outside() -> None:
    """Two fifths of the discs say something, and a quarter of these are at most twice as large as they need to be."""
    known = tight = 0
    for seed in range(MANY):
        one = drawn(seed)
        radius = float(evaluated(one, one.disc.radius).radius)
        if radius < NOTHING:
            found = farthest(one, radius, NEGLIGIBLE)
            assert found <= 1.0 + 1e-12, f"seed {seed}: {to_text(one.formula)}, {one.disc}: {found}"
            known, tight = known + 1, tight + (found > 0.5)
    assert known > 0.4 * MANY
    assert tight > 0.25 * known


def test_a_value_is_right_to_the_rounding_that_is_said() -> None:
    """Against 60 digits; rounding that is said is within a factor of a thousand of what it is in one formula of twenty."""
    sharp = known = 0
    for seed in range(MANY):
        one = drawn(seed)
        found = evaluated(one, (0.0, 0.0, 0.0))
        if not found.radius < NOTHING:
            continue
        with mpmath.workdps(DIGITS):
            exact = values_of(one.formula, tuple(mpmath.mpf(x) for x in one.disc.centre), EXACT)[-1]
            off = float(abs(exact - mpmath.mpf(float(found.centre)))) if mpmath.im(exact) == 0 else 0.0
        assert off <= found.radius + NEGLIGIBLE, f"seed {seed}: {to_text(one.formula)}, {one.disc}"
        known, sharp = known + 1, sharp + (off > 1e-3 * found.radius)
    assert known > 0.6 * MANY
    assert sharp > 0.05 * known


def test_no_value_is_nearer_to_zero_than_the_lower_bound() -> None:
    """Relative 1e-9, for bounds above 1e-6: numpy's complex log1p loses the digits of smaller numbers."""
    for seed in range(MANY):
        one = drawn(seed)
        found = evaluated(one, one.disc.radius)
        if found.radius < NOTHING and found.least > 1e-6:
            with np.errstate(all="ignore"):
                values = np.abs(values_of(one.formula, tuple(one.points), np)[-1])
            assert (values >= found.least * (1.0 - 1e-9))[np.isfinite(values)].all(), to_text(one.formula)


@pytest.mark.parametrize("rule", sorted(OPERATIONS))
def test_a_rule_whose_radius_is_too_small_by_a_tenth_is_noticed(rule: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of each operation, in some random formula."""
    true = OPERATIONS[rule]

    def wrong(*arguments: Disc) -> Disc:
        found = true.disc(*arguments)
        return found._replace(radius=0.9 * np.asarray(found.radius))

    monkeypatch.setitem(OPERATIONS, rule, replace(true, disc=wrong))
    radii = ((one, float(evaluated(one, one.disc.radius).radius)) for one in map(drawn, range(MANY)))
    assert any(farthest(one, radius, NEGLIGIBLE) > 1.0 + 1e-12 for one, radius in radii if radius < NOTHING)
