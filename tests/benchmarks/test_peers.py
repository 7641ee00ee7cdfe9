"""The benchmark's peers solve the same problems: other methods, other code, the same answers."""

from __future__ import annotations

import warnings
from types import ModuleType

import numpy as np
import pytest

pytest.importorskip("scipy")

from benchmarks.problems import CASES, DRIVEN, EVENT, SHOCKS, TRANSIT, Case
from benchmarks.runner import UnavailableError

from benchmarks import c_peer, chain, heyoka_peer, ours, scipy_peer, stiff


def error(method: ModuleType, case: Case, tolerance: float) -> float:
    """Largest error of the slip over the total slip (or relative error of the arrest's time) against the reference."""
    try:
        return float(method.runner(case, tolerance).error())
    except UnavailableError as reason:
        pytest.skip(str(reason))


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_scipy_agrees_with_the_reference(case: Case) -> None:
    assert error(scipy_peer, case, 1e-12) < 2e-9


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("case", stiff.CASES, ids=lambda case: case.name)
def test_radau_and_the_engine_agree_with_the_reference_on_stiff_contacts(case: Case) -> None:
    assert float(stiff.radau(case, 1e-8).error()) < 2e-9
    assert float(ours.runner(case, 1e-9).error()) < 1e-11


@pytest.mark.parametrize("case", [TRANSIT, EVENT], ids=lambda case: case.name)
def test_heyoka_agrees_with_the_reference(case: Case) -> None:
    if heyoka_peer.heyoka is None:
        pytest.skip("heyoka is not installed")
    assert error(heyoka_peer, case, 1e-15) < 2e-9


def test_jitcdde_agrees_with_the_reference() -> None:
    """It solves the slab as a neutral delay equation, which is another formulation, too."""
    pytest.importorskip("jitcdde")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # setuptools and sympy of its own
        from benchmarks import jitcdde_peer

        assert error(jitcdde_peer, DRIVEN, 1e-8) < 5e-7


@pytest.mark.slow
@pytest.mark.sampled(every=4)
@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_same_algorithm_in_c_takes_the_same_steps(case: Case) -> None:
    """Step by step the same: as many steps, the same slip to rounding (which the problem amplifies)."""
    try:
        in_c = c_peer.runner(case, 1e-10)
    except UnavailableError as reason:
        pytest.skip(str(reason))
    compiled = ours.runner(case, 1e-10)
    in_c.run()
    compiled.run()
    assert in_c.steps() == compiled.steps()
    total = float(np.ptp(case.reference))
    assert in_c.slip(case.times) == pytest.approx(compiled.slip(case.times), rel=0.0, abs=1e-10 * total)


def test_the_engine_agrees_with_the_closed_form() -> None:
    """The reference of this problem is no run of the engine but a closed form in 50 digits."""
    assert error(ours, SHOCKS, 1e-6) < 1e-14


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_the_error_shows_a_wrong_answer(case: Case) -> None:
    run = ours.runner(case, 1e-10)
    run.run()
    assert case.error(run.slip(case.times) * (1.0 + 1e-6), case.arrest) > 5e-7


@pytest.mark.parametrize(("count", "duration"), [(40, 300.0), (200, 600.0)])
def test_a_chain_by_series_in_c_has_the_same_onsets_and_slip(count: int, duration: float) -> None:
    """Of 200 blocks only if it looks closely at each step: else it misses an onset, 344 for 345."""
    if chain.library() is None:
        pytest.skip("no C compiler")
    found, exact = chain.in_c(count, duration, samples=64), chain.ours(count, duration)
    assert found.onsets == exact.onsets
    assert found.slip == pytest.approx(exact.slip, rel=1e-12, abs=0.0)
    if count == 200:
        assert chain.in_c(count, duration, samples=8).onsets == exact.onsets - 1
