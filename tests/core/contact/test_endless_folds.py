"""Friction that rises and falls with the slip rate for ever: folds are known as far as the loads of a run go, and in a second."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.branches import resistance
from stickslip.contact.folds import MOST_FOLDS, certificate
from stickslip.contact.rules.selection import load_bound

F = ss.friction
SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
FEW = "0.675 + 0.125*sin(2*v)"
"""So few folds up to the loads of a run that each of its branches is told."""
FORMULAS = "0.6 - 0.1*v/(v+0.5) + 0.006*sin(50*v)", "0.6 - 0.1*v/(v+0.4) + 0.007*sin(40*v)", FEW


def endless(formula: str = FORMULAS[0], **given: object) -> ss.Problem:
    return ss.Problem(SLAB, F.FromExpression(formula), **{"pull_rate": 1.6e-9, "initial_excess": 0.0, **given})  # type: ignore[arg-type]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("formula", FORMULAS)
def test_folds_without_end_are_found_up_to_the_loads_of_a_run(formula: str) -> None:
    """Those that 200 000 slip rates show, each within its enclosure; 24 000 were searched, and the answer took minutes."""
    found = ss.uniqueness(endless(formula))
    g = found.resistance
    assert g is not None
    reach = certificate(g).reach
    rates = np.linspace(0.0, reach, 200_001)
    turns = rates[:-1][np.diff(np.sign(g.slope(rates))) != 0.0]
    folds = np.array([fold.rate for fold in found.folds])
    assert found.certificate == "proven"
    assert 0 <= len(turns) - len(folds) <= 1  # the last branch counts as endless
    assert np.abs(turns[: len(folds)] - folds).max() < rates[1]
    assert found.known_to is not None
    assert "at faster ones it goes on turning" in found.summary
    assert len(found.summary) < 3000


def test_all_slip_rates_are_found_at_a_load_within_reach_and_none_is_promised_beyond() -> None:
    found = ss.uniqueness(endless())
    assert found.known_to is not None
    load = 0.9 * found.known_to
    rates = np.linspace(0.0, 3.0 * load / 9.8e6, 400_001)
    crossings = np.count_nonzero(np.diff(np.sign(found.g(rates[1:]) - load)))
    assert len(found.admissible(load)) == crossings > 1
    with pytest.raises(ss.InputError, match="known for loads up to"):
        found.admissible(1.1 * found.known_to)


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("rule", ["perfect-delay", "minimal", "maximal"])
def test_a_run_under_such_a_law_goes_on(rule: str) -> None:
    run = ss.simulate(endless(initial_excess=1e6, selection=rule), 12.0)
    assert run.status.ok
    assert np.abs(run.load(np.linspace(0.0, 12.0, 2001))).max() < load_bound(run.problem, resistance(run.problem))


def test_loads_without_a_bound_are_refused_in_one_line() -> None:
    dead = replace(endless(), body=replace(SLAB, driver_impedance=0.0), initial_excess=1e6)
    for problem in (dead, endless(initial_load=3e8, initial_excess=None)):
        with pytest.raises(ss.InputError, match="may exceed") as error:
            ss.simulate(problem, 10.0)
        assert "\n" not in str(error.value)


def test_too_many_folds_and_too_many_for_maxwell_are_one_line() -> None:
    with pytest.raises(ss.InputError, match=f"turns more than {MOST_FOLDS} times"):
        ss.uniqueness(endless("0.6 + 0.006*sin(5000*v)"))
    with pytest.raises(ss.InputError, match="at most 150"):
        ss.uniqueness(endless(selection="maxwell"))


@pytest.mark.parametrize("seed", range(4))
def test_no_load_exceeds_its_bound(seed: int) -> None:
    """Random drivers, pull rates up to some m/s and starts, of loads that rise and fall: a fiftieth of the bound is reached."""
    rng = np.random.default_rng(seed)
    driver = np.inf if seed % 3 == 0 else float(9.8e6 * 10.0 ** rng.uniform(-1.5, 1.5))
    law = F.HyperbolicRate(0.8, 0.3, float(rng.uniform(0.1, 2.0)))
    problem = ss.Problem(
        replace(SLAB, driver_impedance=driver),
        law,
        pull_rate=float(rng.uniform(0.0, 3.0)),
        initial_load=float(rng.uniform(2e7, 1.5e8)),
    )
    run = ss.simulate(problem, 80.0, max_pieces=20_000)
    largest = np.abs(run.load(np.linspace(0.0, run.history.duration, 20_001))).max()
    bound = load_bound(problem, resistance(problem))
    assert 0.02 * bound < largest <= bound
