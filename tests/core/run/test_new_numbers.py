"""What a run with numbers that were not run before takes besides a run with known ones, counted in calls and not by a clock.

The calls are counted in a process of its own: what other tests have left behind is not the run's.
"""

import json
import subprocess
import sys

import pytest

MOST_CALLS = 1500
"""Largest number of calls, of Python's functions and of those written in C; there were 1750 when single numbers went as arrays."""
MOST_KNOWN = 440
"""Largest number of calls of a run whose numbers are known; there were 460."""
COUNT = """
import json, sys
import stickslip as ss

def calls(scenario):
    count = 0
    def note(_, event, __):
        nonlocal count
        count += event in ("call", "c_call")
    sys.setprofile(note)
    try:
        ss.simulate(scenario)
    finally:
        sys.setprofile(None)
    return count

known = ss.load_scenario("fig6-slab")
for alpha in (0.11, 0.9):  # without and with folds; loads what only the first runs need
    ss.simulate(known.with_values({"friction.alpha": alpha}))
new = [calls(known.with_values({"friction.alpha": alpha})) for alpha in (0.13, 0.4, 0.7)]
print(json.dumps([new, calls(known.with_values({"friction.alpha": 0.13}))]))
"""


@pytest.fixture(scope="module")
def counted() -> tuple[list[int], int]:
    shown = subprocess.run([sys.executable, "-c", COUNT], capture_output=True, text=True, check=True).stdout
    new, known = json.loads(shown)
    return new, known


def test_new_numbers_of_a_law_cost_few_calls(counted: tuple[list[int], int]) -> None:
    assert max(counted[0]) <= MOST_CALLS


def test_known_numbers_cost_a_third_of_that(counted: tuple[list[int], int]) -> None:
    assert 0 < counted[1] <= MOST_KNOWN
