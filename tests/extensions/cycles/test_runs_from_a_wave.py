"""What is said of a run that begins with a given wave: its motion is proven as any other, and the time before is not known."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine import check_history
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.solution.observables.proof_of_run import proof_of_run

STRING = ss.load_scenario("drill-string").problem
DRIVE = 2000.0


def of_string(pull: float, **changes: float) -> LimitCycle:
    """Return the cycle of the bundled drill string behind a drive that gives way."""
    body = replace(STRING.body, driver_impedance=DRIVE, **changes)
    return ss.studies.cycle(replace(STRING, body=body, pull_rate=pull), near=50.0)


@cache
def plain() -> LimitCycle:
    return of_string(9.0)


@cache
def behind_a_machine() -> LimitCycle:
    return of_string(4.0, driver_integral_gain=300.0)


@cache
def with_a_state() -> LimitCycle:
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=0.01, rate=1e-6)
    slab = ss.ElasticSlab(2800, 3500, 1000, 1e8, contact_mass=1e6, driver_impedance=1e8)
    start = {"initial_load": 6.2e7, "initial_state": "steady", "initial_rate": 0.024}
    return ss.studies.cycle(ss.Problem(slab, law, pull_rate=0.02, **start), near=25.0)


@cache
def of_layers() -> LimitCycle:
    pipe = STRING.body
    same = {name: [getattr(pipe, name)] * 2 for name in ("inner_diameter", "density", "shear_modulus")}
    numbers = {name: getattr(pipe, name) for name in ("weight_on_bit", "bit_radius", "inertia")}
    body = ss.SectionedString([443.0, 1329.0], [0.16, pipe.outer_diameter], **same, **numbers, driver_impedance=DRIVE)
    return ss.studies.cycle(replace(STRING, body=body, pull_rate=8.2), near=50.0)


EVERY = pytest.mark.parametrize("found", [plain, behind_a_machine, with_a_state, of_layers])


@EVERY
def test_its_motion_is_proven_and_its_energies_balance(found: Callable[[], LimitCycle]) -> None:
    """Loads and strength at rest to 1e-13 of the normal load, states to 1e-12, balance to 1e-12 of the heat."""
    cycle = found()
    proof, normal = cycle.run.proven, cycle.problem.normal
    assert proof.compared > 0.9 * proof.pieces > 0
    assert max(proof.load, proof.rest) < 1e-13 * normal
    assert proof.states < 1e-12
    assert proof.rate < 1e-12 * cycle.greatest_rate
    energy = cycle.run.energy(cycle.begin + np.linspace(0.0, 1.0, 5) * cycle.period)
    assert np.abs(energy["balance"].values).max() < 1e-12 * energy["heat"].values[-1]


@EVERY
def test_loads_of_another_pull_rate_are_found_wrong(found: Callable[[], LimitCycle]) -> None:
    history = found().run.history
    other = replace(history.problem, pull_rate=1.001 * history.problem.first_pull_rate)
    assert proof_of_run(replace(history, problem=other)).load > 1e-6 * other.normal


@EVERY
def test_its_file_and_what_goes_on_from_there_know_as_much(found: Callable[[], LimitCycle], tmp_path: Path) -> None:
    """The proof of the file is the same, and that of two periods as good; a wave of another shape is refused."""
    cycle, path = found(), tmp_path / "cycle.nc"
    cycle.run.to_netcdf(path)
    assert ss.open_solution(path).proven == cycle.run.proven
    longer = ss.resume(path, cycle.begin + 2.0 * cycle.period)
    assert longer.history.given == cycle.run.history.given > 0
    assert max(longer.proven.load, longer.proven.rest) < 1e-13 * cycle.problem.normal
    again = longer.slip_rate(cycle.begin + (1.0 + np.linspace(0.1, 0.9, 5)) * cycle.period)
    once = cycle.run.slip_rate(cycle.begin + np.linspace(0.1, 0.9, 5) * cycle.period)
    assert again == pytest.approx(once, abs=1e-7 * cycle.greatest_rate)
    given = cycle.run.history.begun_with
    assert given is not None
    with pytest.raises(ss.InputError, match="history_begun_with"):
        check_history(replace(cycle.run.history, begun_with=given[1:]), path)


@EVERY
def test_what_is_in_the_body_before_is_refused_and_its_start_is_called_a_wave(found: Callable[[], LimitCycle]) -> None:
    cycle = found()
    run, before = cycle.run, 0.5 * cycle.begin
    refusal = r"^the run begins with a given wave: what is in the body is known from [\d.]+ s on$"
    for read in (run.energy, run.drive_rate, run.drive_traction, lambda time: run.field(100.0, time)):
        with pytest.raises(ss.InputError, match=refusal):
            read(before)
    assert dict(run.account.lines())["start"].startswith("not that of the scenario: a given wave, until ")
    assert "not that of the scenario: a given wave" in repr(run)
    assert "initial load" not in repr(run)
    assert run.shown == (cycle.begin, run.duration)
