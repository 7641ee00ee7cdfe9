"""Cycles of bodies of layers: layers alike are a uniform body, runs come to them at the pace of the multipliers, energies close."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine import check_history
from stickslip.extensions.cycles.limit_cycle import LimitCycle
from stickslip.extensions.cycles.section import onsets
from stickslip.extensions.cycles.waves.fronts import Fronts
from stickslip.extensions.cycles.waves.path import path_of
from stickslip.problem.scenarios import find_parameter

DENSITY, SPEED, THICKNESS, NORMAL, DRIVE = 2800.0, 3500.0, 1000.0, 1e8, 1e8
STRING = ss.load_scenario("drill-string").problem
PIPE: Any = STRING.body
PULL, SOFT = 8.2, 2000.0


def sections(lengths: list[float], outer: list[float], **changes: Any) -> ss.SectionedString:
    """Return the bundled drill string in two sections of these lengths and outer diameters (m), behind a drive that gives way."""
    same = {name: [getattr(PIPE, name)] * 2 for name in ("inner_diameter", "density", "shear_modulus")}
    numbers = {name: getattr(PIPE, name) for name in ("weight_on_bit", "bit_radius", "inertia")}
    return ss.SectionedString(lengths, outer, **same | numbers | {"driver_impedance": SOFT} | changes)


@cache
def of_string(body: Any, pull: float = PULL) -> LimitCycle:
    return ss.studies.cycle(replace(STRING, body=body, pull_rate=pull), near=70.0)


@cache
def thick_and_thin() -> LimitCycle:
    """Return the cycle of a string whose first quarter is thicker than the rest."""
    return of_string(sections([443.0, 1329.0], [0.16, PIPE.outer_diameter]))


@cache
def of_slab(body: Any) -> LimitCycle:
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=0.01, rate=1e-6)
    return ss.studies.cycle(ss.Problem(body, law, pull_rate=0.02, initial_load=6.2e7, initial_state="steady"), near=40.0)


def test_a_string_of_two_sections_alike_has_the_cycle_of_one() -> None:
    """Period and slip to 1e-11; the multiplier, known by differences of runs, to 1e-5."""
    drive = 4.0 * PIPE.impedance
    whole = of_string(replace(PIPE, driver_impedance=drive), 8.7)
    cut = of_string(sections([PIPE.length / 3.0, PIPE.length / 1.5], [PIPE.outer_diameter] * 2, driver_impedance=drive), 8.7)
    assert cut.period == pytest.approx(whole.period, rel=1e-11)
    assert cut.slip == pytest.approx(whole.slip, rel=1e-11)
    assert cut.multipliers[0] == pytest.approx(whole.multipliers[0], abs=1e-5)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("sides", "share"), [("apart", 2.0), ("joined", 0.5)])
def test_two_slabs_alike_have_the_cycle_of_the_slab_that_they_are_together(sides: str, share: float) -> None:
    """Twice the impedance each where one slips on the other, half where both slip: period to 1e-10, multiplier to 1e-6."""
    whole = of_slab(ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL, driver_impedance=DRIVE))
    halves = [[0.5 * THICKNESS] * 2, [share * DENSITY] * 2, [SPEED] * 2]
    drives = {"driver_impedance": share * DRIVE, "other_driver_impedance": share * DRIVE}
    other = [THICKNESS], [share * DENSITY], [SPEED]
    both = of_slab(ss.TwoSlabs(*map(tuple, halves), *map(tuple, other), NORMAL, sides=sides, **drives))
    assert both.period == pytest.approx(whole.period, rel=1e-10)
    assert both.multipliers[0] == pytest.approx(whole.multipliers[0], abs=1e-6)
    assert both.stick_share == 0.0


def test_a_plain_run_comes_to_the_cycle_of_layers_at_the_pace_of_the_multiplier() -> None:
    """The period to 1e-10 at its end; the pace to 1e-3, where intervals are still 1e-7 to 1e-5 s off."""
    cycle = thick_and_thin()
    run = ss.simulate(replace(cycle.problem), 150.0, 1e-12)
    off = np.diff(onsets(run.history).time) - cycle.period
    assert off[-3:] == pytest.approx(np.zeros(3), abs=1e-9 * cycle.period)
    close = np.flatnonzero((np.abs(off[:-1]) < 1e-5) & (np.abs(off[:-1]) > 1e-7))
    assert np.mean(off[close + 1] / off[close]) == pytest.approx(cycle.multipliers[0].real, rel=1e-3)


def test_in_a_period_the_drive_of_layers_works_for_heat_and_radiation_and_stores_nothing() -> None:
    """What all sections store comes back, to 1e-9 of the heat; sums of the torque at the drive, which has kinks, to 1e-6."""
    cycle = thick_and_thin()
    energy = cycle.run.energy(np.array([cycle.begin, cycle.begin + cycle.period]))
    gained = {str(name): np.squeeze(np.diff(energy[name].values, axis=0)) for name in energy.data_vars}
    times = cycle.begin + np.linspace(0.0, cycle.period, 20_001)
    torque = cycle.run.drive_traction(times)
    work, radiated = (float(np.trapezoid(power, times)) for power in (PULL * torque, torque**2 / SOFT))
    assert radiated > 0.1 * work
    assert work == pytest.approx(float(gained["heat"]) + radiated, rel=1e-6)
    for name in ("stored", "kinetic_in_layer", "elastic_in_layer"):
        assert np.abs(gained[name]).max() < 1e-9 * gained["heat"]


def test_the_run_of_a_cycle_of_layers_comes_back_from_its_file_with_the_waves_inside(tmp_path: Path) -> None:
    """Stress inside the second section and stored energy have the same bits; waves of another shape are refused."""
    run, path = thick_and_thin().run, tmp_path / "cycle.nc"
    run.to_netcdf(path)
    kept = ss.open_solution(path)
    assert kept.field(900.0, 3.0).stress == run.field(900.0, 3.0).stress
    assert kept.energy(3.0).identical(run.energy(3.0))
    given = run.history.begun_with
    assert given is not None
    with pytest.raises(ss.InputError, match="history_begun_with"):
        check_history(replace(run.history, begun_with=given[:, :1]), path)


def test_a_cycle_on_a_branch_along_the_impedance_of_a_section_is_that_found_there() -> None:
    """Period to 1e-9."""
    begin, value = thick_and_thin(), 0.1601
    parameter = find_parameter(begin.scenario, "body.outer_diameter[0]", "follow")
    path = path_of(begin.orbit, begin.scenario, parameter, 1e-4)  # type: ignore[arg-type] # a body with waves
    there = path.at_value(value, begin.orbit.place, begin.period).orbit
    own = of_string(sections([443.0, 1329.0], [value, PIPE.outer_diameter]))
    assert there.period == pytest.approx(own.period, rel=1e-9)
    assert there.period != pytest.approx(begin.period, rel=1e-5)


@pytest.mark.slow
def test_a_branch_along_the_impedance_of_a_section_ends_at_the_cycle_found_there() -> None:
    branch = ss.studies.follow(thick_and_thin(), "body.outer_diameter[0]", to=0.1602, steps=1)
    own = of_string(sections([443.0, 1329.0], [0.1602, PIPE.outer_diameter]))
    assert branch.table["period"].iloc[-1] == pytest.approx(own.period, rel=1e-8)
    assert branch.table["multiplier_1"].iloc[-1] == pytest.approx(own.multipliers[0].real, abs=1e-4)


def test_a_length_of_a_section_is_no_number_to_follow() -> None:
    with pytest.raises(ss.InputError, match=r"follow: body\.length\[0\] changes how the travel times compare, and so, in steps"):
        ss.studies.follow(thick_and_thin(), "body.length[0]", to=450.0, steps=1)


@pytest.mark.parametrize(
    ("body", "why"),
    [
        (sections([180.0, 1800.0], [0.16, 0.127], driver_impedance=np.inf), "to a cycle; give the driver a finite impedance"),
        (sections([180.0, 1800.0], [0.16, 0.127], driver_impedance=np.inf, drag=[0.5, 0.5]), "leaves waves that rest there"),
        (sections([180.0, 1800.0], [0.16, 0.127], driver_impedance=0.0), "a dead load holds the body nowhere"),
        (sections([180.0, 1800.0], [0.16, 0.127], inertia=0.0), "which has no states, each moment of the round trip"),
        (sections([180.0, 1800.0], [0.16, 0.127], driver_inertia=2000.0), "behind layers"),
    ],
    ids=["rigid", "rigid with drag", "dead load", "no mass", "machine"],
)
def test_layers_without_cycles_are_refused_with_the_reason(body: ss.SectionedString, why: str) -> None:
    with pytest.raises(ss.InputError, match=why):
        ss.studies.cycle(replace(STRING, body=body, pull_rate=PULL))


def test_drag_in_front_of_a_rigid_drive_leaves_fronts_that_rest_where_it_is_lumped() -> None:
    """Of fronts in 12 cells between two ends that send all back one is left whole, to 1e-9; a drive that gives way takes all."""
    for drive, least, most in ((np.inf, 1.0 - 1e-9, 1.0 + 1e-9), (SOFT, 0.0, 0.97)):
        body = sections([885.0, 885.0], [PIPE.outer_diameter] * 2, driver_impedance=drive, drag=[0.5, 0.5], drag_step=0.2)
        fronts = Fronts(replace(STRING, body=body, pull_rate=PULL), body)
        cells = sum(body.cells.counts)
        grown = np.linalg.eigvals(fronts.stepped(np.eye(cells), np.zeros(cells)))
        assert least <= np.abs(grown).max() <= most
