"""Laws with features that leave no trace where a step begins, drawn at random, against scipy with steps that cannot miss them."""

from __future__ import annotations

import pytest

import stickslip as ss
from tests.adversarial.cases import TEMPLATES, draw
from tests.adversarial.checks import CLAIM, decided_truth, errors

SAMPLE = (
    "bump(u)",
    "step(u)",
    "ripple(u)",
    "bump(v)",
    "tail(v)",
    "logistic(v)",
    "bump(u)+logistic(v)",
    "table-bump(u)",
    "lagged-bump(v)",
)
"""Templates of the ordinary test run: each formula is compiled for a second or two."""
FEW, MANY = 3, 60


def _agrees(template: str, seed: int) -> None:
    case = draw(template, seed)
    truth = decided_truth(case)
    if truth is None:
        pytest.skip(f"rounding decides {case.name}, or it is stiff")
    found = errors(ss.simulate(case.problem, case.duration), truth)
    assert found.largest < CLAIM, f"{case.name}: {found}"


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("seed", range(FEW))
@pytest.mark.parametrize("template", SAMPLE)
def test_slip_and_end_of_the_event_are_those_of_scipy(template: str, seed: int) -> None:
    _agrees(template, seed)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(FEW, MANY))
@pytest.mark.parametrize("template", TEMPLATES)
def test_slip_and_end_are_those_of_scipy_for_many_laws(template: str, seed: int) -> None:
    _agrees(template, seed)


@pytest.mark.slow
@pytest.mark.parametrize("template", TEMPLATES)
def test_most_of_the_family_is_decided_in_double_precision(template: str) -> None:
    """At least half of the cases of each template are tests: the rest graze a feature or are stiff."""
    decided = [decided_truth(draw(template, seed)) is not None for seed in range(4)]
    assert sum(decided) >= 2
