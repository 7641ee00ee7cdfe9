"""A range as it is typed: numbers with exponents, and a unit at one end."""

from __future__ import annotations

import pytest

from stickslip.foundation.axis import TypedRange


@pytest.mark.parametrize(
    ("typed", "low", "high"),
    [
        ("0..1e6", "0", "1e6"),
        ("1e-2..10:4:log", "1e-2", "10"),
        ("1E3..-2.5E+3", "1E3", "-2.5E+3"),
        ("1e3..1e6 m:3", "1e3 m", "1e6 m"),
        ("1e3 m..1e6", "1e3 m", "1e6 m"),
        ("40..120 rpm", "40 rpm", "120 rpm"),
        ("0.2..5.0:40", "0.2", "5.0"),
        ("1 mm..2 cm", "1 mm", "2 cm"),
    ],
)
def test_an_exponent_is_no_unit_and_a_unit_at_one_end_is_that_of_both(typed: str, low: str, high: str) -> None:
    found = TypedRange.of(typed, "range")
    assert found is not None
    assert (found.low, found.high) == (low, high)
