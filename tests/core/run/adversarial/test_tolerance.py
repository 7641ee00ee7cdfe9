"""rtol rules the error: it falls with rtol for every kind of law and body, and stays below a stated multiple of it."""

from __future__ import annotations

import pytest

import stickslip as ss
from tests.core.run.adversarial.cases import TEMPLATES, Case, draw
from tests.core.run.adversarial.checks import CLAIM, decided_truth, errors
from tests.core.run.adversarial.truth import truth_of

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


RTOLS = (1e-4, 1e-6, 1e-8, 1e-10)
BOUND, FLOOR = 100.0, 1e-10
"""error <= BOUND rtol + FLOOR; the floor is for rounding and for the truth's own error."""

KINDS = {
    "bump in slip, block": ("bump(u)", "block"),
    "bump in slip, slab": ("bump(u)", "slab"),
    "step in slip, contact mass": ("step(u)", "mass"),
    "logistic in slip, matched driver": ("logistic(u)", "matched"),
    "tail in rate, block": ("tail(v)", "block"),
    "tail in rate, contact mass": ("tail(v)", "mass"),
    "bump in slip times logistic in rate": ("bump(u)+logistic(v)", "block"),
    "table of slip, block": ("table-bump(u)", "block"),
    "table of rate, block": ("table-bump(v)", "block"),
    "lag, block": ("lagged-bump(v)", "block"),
    "lag, slab": ("lagged-bump(v)", "slab"),
}


def first_case(template: str, body: str) -> Case:
    """The first case of a template with a body of a kind."""
    return next(case for case in (draw(template, seed) for seed in range(100)) if f", {body}," in case.name)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", KINDS)
def test_error_falls_with_rtol(kind: str) -> None:
    case = first_case(*KINDS[kind])
    truth = truth_of(case)
    share = truth_of(case.with_excess(1e-10)).total / truth.total - 1.0
    amplification = max(abs(share) / 1e-10, 1.0)  # of an error of the load, which no integrator can go below
    for rtol in RTOLS:
        found = errors(ss.simulate(case.problem, case.duration, rtol=rtol), truth)
        assert found.largest <= BOUND * rtol * amplification + FLOOR, f"{case.name}, rtol {rtol:g}: {found}"
