"""Declared fields: one set of rules for single numbers and for arrays, and the docstrings that are made from them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import LARGEST, LARGEST_WHOLE, SMALLEST, Quantity, fields_of
from stickslip.friction import LAWS
from stickslip.loading import HISTORIES

EDGES = (
    0.0,
    -0.0,
    1.0,
    1.5,
    SMALLEST,
    0.5 * SMALLEST,
    LARGEST,
    2.0 * LARGEST,
    LARGEST_WHOLE,
    LARGEST_WHOLE + 1.0,
    math.inf,
    math.nan,
)
NUMBERS = st.one_of(st.sampled_from([*EDGES, *(-edge for edge in EDGES)]), st.floats())
BOUNDS = st.sampled_from([None, 0.0, 1.0, -2.0])


@given(
    quantity=st.builds(
        Quantity, st.just("m"), st.just("length"), above=BOUNDS, at_least=BOUNDS, infinite=st.booleans(), whole=st.booleans()
    ),
    values=st.lists(NUMBERS, max_size=20),
)
def test_arrays_are_held_to_the_rules_of_single_numbers(quantity: Quantity, values: list[float]) -> None:
    def is_accepted(value: float) -> bool:
        try:
            return quantity.check("Owner", "field", value) == value
        except InputError:
            return False

    assert quantity.allows(np.array(values, float)).tolist() == [is_accepted(value) for value in values]


@pytest.mark.parametrize(
    ("quantity", "value", "message"),
    [
        (Quantity("m", ""), True, 'must be a number in m or a text with a unit such as "10 m", got True'),
        (
            Quantity("m", ""),
            "1",
            "must be a number in m or a text with a unit such as \"10 m\", got '1': write a number without quotes",
        ),
        (Quantity("m", ""), math.nan, "must be finite, got nan"),
        (
            Quantity("m", ""),
            -(10**400),
            'must be a number in m or a text with a unit such as "10 m", got a whole number beyond 1e300',
        ),
        (Quantity("1", "", whole=True), 1.5, "must be a whole number up to 16, got 1.5"),
        (Quantity("1", "", above=0), 0.0, r"must be greater than 0 \(a pure number\), got 0"),
        (Quantity("m", "", at_least=1), 0.5, "must be at least 1 m, got 0.5"),
        (Quantity("m", ""), -1e60, r"must lie within 1e\+50 m, got -1e\+60"),
        (Quantity("m", "", above=0), 1e-60, "must be at least 1e-50 m, got 1e-60"),
    ],
)
def test_messages_say_where_what_and_what_is_allowed(quantity: Quantity, value: object, message: str) -> None:
    with pytest.raises(InputError, match=f"^Owner: field {message}$"):
        quantity.check("Owner", "field", value)


@pytest.mark.parametrize("kind", [*LAWS.values(), *HISTORIES.values()], ids=lambda kind: kind.kind)
def test_docstrings_list_every_field_and_the_source(kind: type) -> None:
    text = kind.__doc__ or ""
    section = text.partition("Parameters\n    ----------\n")[2]
    assert text.count("Parameters\n") == 1
    for name, (declared, _) in fields_of(kind).items():
        assert f"    {name}\n" in section
        assert declared.meaning[1:] in section
    assert kind.source in text  # type: ignore[attr-defined] # laws and histories have one
