"""What a run with numbers that were not run before takes besides a run with known ones, counted in calls and not by a clock."""

import sys

import pytest

import stickslip as ss

MOST_CALLS = 1500
"""Largest number of calls, of Python's functions and of those written in C; there were 1750 when single numbers went as arrays."""
MOST_KNOWN = 440
"""Largest number of calls of a run whose numbers are known; there were 460."""


def _calls(scenario) -> int:
    """Return how many functions a run calls."""
    count = 0

    def note(_, event, __):
        nonlocal count
        count += event in ("call", "c_call")

    before = sys.getprofile()
    sys.setprofile(note)
    try:
        ss.simulate(scenario)
    finally:
        sys.setprofile(before)
    return count


@pytest.fixture(scope="module")
def scenario():
    known = ss.load_scenario("fig6-slab")
    for alpha in (0.11, 0.9):  # without and with folds; loads what only the first runs need
        ss.simulate(known.with_values({"friction.alpha": alpha}))
    return known


@pytest.mark.parametrize("alpha", [0.13, 0.4, 0.7])
def test_new_numbers_of_a_law_cost_few_calls(scenario, alpha):
    assert _calls(scenario.with_values({"friction.alpha": alpha})) <= MOST_CALLS


def test_known_numbers_cost_a_third_of_that(scenario):
    again = scenario.with_values({"friction.alpha": 0.13})
    ss.simulate(again)
    assert _calls(again) <= MOST_KNOWN
