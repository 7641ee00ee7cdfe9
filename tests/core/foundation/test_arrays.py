"""Single numbers and those of many members go through the same functions, and get the same answers."""

import math

import numpy as np
import pytest

from stickslip.foundation.arrays import anywhere, at_least, everywhere

NUMBERS = (-1.0, -0.0, 0.0, 5e-324, 2.0, math.inf, -math.inf, math.nan)


@pytest.mark.parametrize("kind", [float, np.float64])
@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("least", [0.0, 1e-10, -3.0])
def test_a_single_number_is_bounded_as_one_of_many_is(number, least, kind):
    np.testing.assert_array_equal(at_least(least, kind(number)), at_least(least, np.array([number]))[0])


@pytest.mark.parametrize("flag", [True, False, np.True_, np.False_, 0.0, 0.3])
def test_a_single_flag_counts_as_one_of_many_does(flag):
    many = np.array([flag])
    assert everywhere(flag) is everywhere(many) is bool(flag)
    assert anywhere(flag) is anywhere(many) is bool(flag)


def test_one_flag_of_many_decides():
    flags = np.array([True, False])
    assert anywhere(flags)
    assert not everywhere(flags)
