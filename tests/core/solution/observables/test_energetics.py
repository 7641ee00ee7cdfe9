"""Slip events as seismologists account for them, against closed forms; every row of the table balances."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.history.history import History
from stickslip.solution.observables.energetics import ENERGETICS_COLUMNS
from stickslip.solution.observables.energy.pulses import PULSE_COLUMNS
from tests.core.solution.observables.runs import LOSSY, RUNS, run_of
from tests.problems import IMPEDANCE, MODULUS, SLAB, THICKNESS, scaled_rate, slip_law_slab

F = ss.friction
COULOMB = F.Coulomb(0.8, 0.3)
TRAVEL = THICKNESS / SLAB.wave_speed
LOAD, FAR, SLIDING = 8.5e7, 2e7, 3e7
MATCHED = replace(SLAB, driver_impedance=SLAB.impedance)
ONE_EVENT = ss.Problem(MATCHED, COULOMB, initial_load=LOAD, far_stress=FAR)
"""It slides for a travel time, until the far stress arrives."""


def coulomb_block(damping: float, load: float = 4.1) -> ss.Problem:
    return ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0, damping=damping), F.Coulomb(0.4, 0.3), initial_load=load)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", RUNS)
def test_every_event_balances(name: str) -> None:
    """In both tables, to 1e-9 of heat and of what is released, however late the event is; its pulses are those that are counted."""
    run = run_of(name)
    table, rows = run.energetics(), run.catalogue(energy=True)
    assert list(table) == list(ENERGETICS_COLUMNS)
    assert len(table) == len(rows) == len(run.events) > 0
    left = table.elastic + table.work - table.kinetic - table.heat - table.damped
    assert (left.abs() < 1e-9 * table.heat).all()
    assert (table.fracture >= 0.0).all()
    assert (table.fracture < table.heat).all()
    assert rows.end.notna().all()
    assert (rows.balance.abs() < 1e-9 * rows.released).all()
    assert (rows.heat > 0.0).all()
    assert (rows.damped > 0.0).all() == name.startswith("block")
    assert np.bincount(run.pulses().event, minlength=len(run.events)).tolist() == run.events.pulses.tolist()


@pytest.mark.parametrize("name", ["slab, rate law, maximal", "slab, slip law", "block, damped"])
def test_balance_notices_a_wrong_slip_rate(name: str) -> None:
    run = run_of(name)
    wrong = scaled_rate(run.history.store, 1.001)
    history = History(wrong, run.problem, run.history.round_trip_time, run.history.ramp, run.history.duration)
    table, rows = replace(run, history=history).energetics(), replace(run, history=history).catalogue(energy=True)
    assert (rows.balance.abs() > 1e-7 * rows.released).all()
    if name == "slab, slip law":
        assert (table.balance.abs() > 1e-7 * table.heat).all()


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_block_overshoots_by_all_of_its_drop(direction: float) -> None:
    """Coulomb friction, no damping: half an oscillation about the sliding friction, all that the spring gives becomes heat."""
    event = ss.simulate(coulomb_block(0.0, direction * 4.1), 2.0, rtol=1e-12).energetics(0.0).iloc[0]
    drop = 4.1 - 3.0
    assert event.slip == pytest.approx(direction * 2 * drop / 50.0, rel=1e-11, abs=0.0)
    assert event.elastic == pytest.approx(3.0 * abs(event.slip), rel=1e-11, abs=0.0)
    assert event.heat == pytest.approx(3.0 * abs(event.slip), rel=1e-11, abs=0.0)
    assert event.static_drop == pytest.approx(direction * 2 * drop, rel=1e-11, abs=0.0)
    assert event.dynamic_drop == pytest.approx(drop, rel=1e-12, abs=0.0)
    assert event.overshoot == pytest.approx(1.0, rel=1e-11, abs=0.0)
    assert (event.kinetic, event.fracture, event.waves, event.efficiency) == (pytest.approx(0.0, abs=1e-15), 0.0, 0.0, 0.0)
    assert math.isnan(event.radiation_efficiency)


@pytest.mark.parametrize("direction", [1.0, -1.0])
def test_a_drop_is_from_the_static_strength_though_the_event_begins_in_motion(direction: float) -> None:
    """Coulomb friction drops at once: a block moves, against sliding friction, before its slip rate counts as an event.

    Its spring then has drops of 2 (static - dynamic) normal force, and so has friction from rest to rest.
    """
    problem = replace(coulomb_block(0.0), initial_load=None, initial_excess=0.0, pull_rate=1e-3)
    run = ss.simulate(problem if direction > 0.0 else mirrored(problem), 100.0, rtol=1e-12)
    assert len(run.events) == 3
    drop = direction * 2.0 * (4.0 - 3.0)
    assert run.events.traction_before.to_numpy() == pytest.approx(direction * 4.0, rel=1e-12, abs=0.0)
    assert run.events.traction_drop.to_numpy() == pytest.approx(drop, rel=1e-3, abs=0.0)  # while it slips, the driver goes on
    assert run.energetics().dynamic_drop.to_numpy() == pytest.approx(1.0, rel=1e-12, abs=0.0)
    table = ss.catalogue(run.problem, run.duration, rtol=1e-12)
    assert table.traction_before.to_numpy() == pytest.approx(direction * 4.0, rel=1e-12, abs=0.0)


def mirrored(problem: ss.Problem) -> ss.Problem:
    """Return the same problem pulled backwards."""
    return replace(problem, initial_excess=None, initial_load=-4.0, pull_rate=-1e-3)


@pytest.mark.parametrize("mass", [0.0, 1e5])
def test_a_slab_gives_way_at_its_static_strength_with_and_without_mass_at_the_contact(mass: float) -> None:
    slab = replace(SLAB, contact_mass=mass)
    run = ss.simulate(ss.Problem(slab, F.Coulomb(0.8, 0.3), pull_rate=0.1, initial_excess=-1e5), 20.0, rtol=1e-12)
    assert run.events.traction_before[0] == pytest.approx(8e7, rel=1e-12, abs=0.0)
    assert run.energetics().dynamic_drop[0] == pytest.approx(5e7, rel=1e-12, abs=0.0)


BUMPS = ss.Problem(ss.SpringBlock(2.0, 1.0, 10.0, damping=4.0), F.SinusoidalSlip(0.5, 0.1, 2.0), pull_rate=0.01, initial_excess=0.0)
"""A damped block that creeps over bumps and never rests."""


def test_events_within_a_slip_count_from_friction_where_they_begin() -> None:
    """Friction was 5 at rest before the slip; where the rate passes 0.2 m/s after it has turned, friction is what holds there."""
    run = ss.simulate(BUMPS, 900.0)
    fast = run.catalogue(0.2)
    assert (run.history.store.mode == 1).all()
    assert run.events.traction_before[0] == pytest.approx(5.0, rel=1e-12, abs=0.0)
    at_the_threshold = run.traction(fast.start.to_numpy(), side="left")
    assert len(fast) == 3
    for time in (fast.start, fast.end):
        assert run.slip_rate(time.to_numpy()) == pytest.approx(0.2, rel=1e-12, abs=0.0)
    assert (at_the_threshold < 4.5).all()
    assert fast.traction_before.to_numpy() == pytest.approx(at_the_threshold, rel=1e-9, abs=0.0)


def test_what_damping_takes_is_a_blocks_radiation() -> None:
    """Overshoot exp(-zeta pi / sqrt(1 - zeta^2)), apparent stress half the drop times what that lacks of 1."""
    event = ss.simulate(coulomb_block(3.0), 2.0, rtol=1e-12).energetics(0.0).iloc[0]
    share = 3.0 / (2.0 * math.sqrt(100.0))
    left, drop = math.exp(-share * math.pi / math.sqrt(1.0 - share**2)), 1.1
    assert event.overshoot == pytest.approx(left, rel=1e-10, abs=0.0)
    apparent = 0.5 * drop * (1.0 - left)
    assert event.apparent_stress == pytest.approx(apparent, rel=1e-10, abs=0.0)
    assert event.efficiency == pytest.approx(apparent / (apparent + 3.0), rel=1e-10, abs=0.0)
    assert event.radiation_efficiency == 1.0


def test_a_slab_under_coulomb_friction_overshoots_fully_and_keeps_no_waves() -> None:
    """Rigid driver: a round trip of sliding, an overshoot of 100 %, and no waves left."""
    event = ss.simulate(ss.Problem(SLAB, COULOMB, initial_load=LOAD), 20.0, rtol=1e-12).energetics().iloc[0]
    drop = LOAD - SLIDING
    assert event.slip == pytest.approx(2 * drop * THICKNESS / MODULUS, rel=1e-12, abs=0.0)
    assert event.elastic == pytest.approx(SLIDING * event.slip, rel=1e-12, abs=0.0)
    assert event.dynamic_drop == pytest.approx(drop, rel=1e-12, abs=0.0)
    assert event.overshoot == pytest.approx(1.0, rel=1e-12, abs=0.0)
    assert [event.kinetic, event.waves] == pytest.approx([0.0, 0.0], rel=0.0, abs=1e-12 * event.heat)
    assert event.fracture == 0.0


def test_a_matched_driver_takes_the_radiation_of_the_closed_form() -> None:
    """Behind the driver goes Z v^2: of the far stress' unloading wave first, then of the slip. No drop beyond the sliding one."""
    run = ss.simulate(ONE_EVENT, 20.0, rtol=1e-12)
    event = run.energetics().iloc[0]
    unloading, moving = (FAR - LOAD) / (2 * IMPEDANCE), (FAR + LOAD - 2 * SLIDING) / (2 * IMPEDANCE)
    radiated, trapped = IMPEDANCE * unloading**2 * TRAVEL, 0.5 * SLAB.density * THICKNESS * moving**2
    assert event.radiated == pytest.approx(radiated, rel=1e-12, abs=0.0)
    assert event.trapped == pytest.approx(trapped, rel=1e-12, abs=0.0)
    assert event.kinetic == pytest.approx(trapped, rel=1e-12, abs=0.0)
    assert event.waves == pytest.approx(radiated + trapped, rel=1e-12, abs=0.0)
    assert event.apparent_stress == pytest.approx((radiated + trapped) / event.slip, rel=1e-12, abs=0.0)
    assert event.efficiency == pytest.approx((radiated + trapped) / (radiated + trapped + event.heat), rel=1e-12, abs=0.0)
    assert event.overshoot == pytest.approx(0.0, rel=0.0, abs=1e-12)
    later = radiated + IMPEDANCE * moving**2 * TRAVEL
    at = run.energy([TRAVEL / 2, TRAVEL, 2 * TRAVEL, 20.0]).radiated.values
    assert at == pytest.approx([radiated / 2, radiated, later, later], rel=1e-12, abs=0.0)


def test_waves_of_an_event_exclude_those_of_earlier_events() -> None:
    run = run_of("slab, just above critical")
    table, rows = run.energetics(), run.events
    assert len(table) > 1
    before, after = (run.energy(times).trapped.values for times in (rows.start[:6], rows.end[:6]))
    assert (before[1:] > 0.1 * after[1:]).all()
    assert table.waves.to_numpy()[:6] == pytest.approx(after - before, rel=0.0, abs=1e-6 * after.max())


WEAKENING = F.LinearSlipWeakening(0.8, 0.3, 0.5)
WEAKENED = {
    "slab": (ss.Problem(SLAB, WEAKENING, initial_excess=1e5), 40.0, 0.5e8 * 0.25),
    "slab with contact mass": (ss.Problem(replace(SLAB, contact_mass=1e6), WEAKENING, initial_excess=1e5), 40.0, 0.5e8 * 0.25),
    "block": (
        ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), F.LinearSlipWeakening(0.4, 0.3, 0.01), initial_excess=1e-3),
        10.0,
        0.1 * 10.0 * 0.005,
    ),
}


@pytest.mark.parametrize("name", WEAKENED)
def test_linear_slip_weakening_has_the_fracture_energy_of_its_triangle(name: str) -> None:
    """S (mu_s - mu_d) D / 2 where it slips further than D."""
    problem, duration, expected = WEAKENED[name]
    run = ss.simulate(problem, duration, rtol=1e-12)
    first, law = run.pulses(0.0).iloc[0], problem.friction
    assert isinstance(law, F.LinearSlipWeakening)
    assert first.slip > law.distance
    assert first.fracture == pytest.approx(expected, rel=1e-11, abs=0.0)
    assert first.weakening_slip == pytest.approx(law.distance, rel=1e-12, abs=0.0)
    assert first.smallest_traction == pytest.approx(law.dynamic * problem.normal, rel=1e-15, abs=0.0)
    assert run.energetics(0.0).fracture[0] == pytest.approx(run.pulses(0.0).query("event == 0").fracture.sum(), rel=1e-14, abs=0.0)


def test_pulses_over_a_wave_of_friction_have_its_fracture_energy() -> None:
    """From a maximum of friction, where slip is slowest, down to the next minimum: S a pi / omega, over a slip of pi / omega."""
    run = ss.simulate(slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0, rtol=1e-12)
    pulses = run.pulses()
    assert list(pulses) == list(PULSE_COLUMNS)
    assert pulses.event.tolist() == [0, 0, 0]
    assert pulses.fracture[1:].to_numpy() == pytest.approx(np.full(2, 5e7 * math.pi / 50.0), rel=1e-8, abs=0.0)
    assert pulses.weakening_slip[1:].to_numpy() == pytest.approx(np.full(2, math.pi / 50.0), rel=1e-5, abs=0.0)
    assert pulses.smallest_traction.to_numpy() == pytest.approx(np.full(3, 5e7), rel=1e-14, abs=0.0)
    assert pulses.peak_rate.max() == run.events.peak_rate[0]
    assert pulses.slip.sum() == pytest.approx(run.events.slip[0], rel=1e-14, abs=0.0)


def test_radiation_is_the_integral_of_the_velocity_at_the_driver() -> None:
    """Across rests that were leaped over, too; the driver moves."""
    problem = ss.Problem(LOSSY, COULOMB, 0.01, initial_excess=1e5, far_stress=7e7, far_stress_rate=1e3)
    run = ss.simulate(problem, 400.0, rtol=1e-12)
    assert run.history.rests.any()
    nodes, weights = np.polynomial.legendre.leggauss(6)
    edges = np.unique(np.concatenate([run.breaks + TRAVEL, np.arange(0.0, 400.0, TRAVEL), [400.0]]))
    edges = edges[edges <= 400.0]
    times = edges[:-1, None] + np.diff(edges)[:, None] * 0.5 * (1.0 + nodes)
    beyond = run.field(THICKNESS, times.ravel()).velocity.reshape(times.shape) - 0.01
    by_hand = LOSSY.driver_impedance * (beyond**2 @ (0.5 * weights)) @ np.diff(edges)
    assert float(run.energy(400.0).radiated[0]) == pytest.approx(by_hand, rel=1e-9, abs=0.0)


def test_a_block_that_swings_back_drops_from_its_load() -> None:
    """Friction so weak that the block turns round at once: there the spring pushes back, and the contact slides against that."""
    problem = ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), F.Coulomb(0.11, 0.1), initial_load=6.0)
    run = ss.simulate(problem, 2.0, rtol=1e-12)
    table = run.energetics(0.0)
    assert table.dynamic_drop[:2].to_numpy() == pytest.approx([5.0, 3.0], rel=1e-11, abs=0.0)  # the load is 6, then 2 - 6 = -4
    assert table.overshoot[:2].to_numpy() == pytest.approx([1.0, 1.0], rel=1e-11, abs=0.0)


def test_friction_that_does_not_fall_has_no_overshoot() -> None:
    problem = ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), F.Coulomb(0.4, 0.4), pull_rate=0.1, initial_excess=0.0)
    event = ss.simulate(problem, 0.5).energetics(0.0).iloc[0]
    assert event.slip > 0.0
    assert event.dynamic_drop == pytest.approx(0.0, rel=0.0, abs=1e-11)
    assert math.isnan(event.overshoot)


def test_a_run_without_events_has_empty_tables() -> None:
    run = ss.simulate(ss.Problem(SLAB, COULOMB, initial_load=1e7), 20.0)
    assert run.energetics().empty
    assert list(run.energetics()) == list(ENERGETICS_COLUMNS)
    assert run.pulses().empty


@pytest.mark.parametrize("name", ["block, damped", "block, bumps", "slab, contact mass"])
def test_event_that_begins_and_ends_at_the_same_rate_gains_no_kinetic_energy_at_the_contact(name: str) -> None:
    """Events are from rest to rest, or cut where the slip rate passes a threshold: the mass holds the same at both ends."""
    problem, duration = (BUMPS, 900.0) if name == "block, bumps" else RUNS[name]
    run = ss.simulate(problem, duration, rtol=1e-12)
    threshold = 0.2 if name == "block, bumps" else 0.3 * float(run.events["peak_rate"].min())
    table, rows = run.energetics(threshold), run.catalogue(threshold, energy=True)
    assert (abs(run.slip_rate(rows.end)) == pytest.approx(threshold, rel=1e-6)) == (name == "block, bumps")
    assert (rows.balance.abs() < 1e-9 * rows.released).all()
    waves = np.zeros(len(rows))
    if name.startswith("slab"):
        waves = wave_kinetic(run, rows.end.to_numpy()) - wave_kinetic(run, rows.start.to_numpy())
    assert table.kinetic.to_numpy() == pytest.approx(waves, rel=1e-3, abs=1e-9 * float(rows.released.max()))


def wave_kinetic(run: ss.Solution, times: np.ndarray) -> np.ndarray:
    """Kinetic energy of the slab (J/m^2) by a sum over its thickness."""
    x = THICKNESS * (np.arange(20_000) + 0.5) / 20_000
    return np.array([0.5 * SLAB.density * np.mean(run.field(x, time).velocity ** 2) * THICKNESS for time in times])


def test_trapped_energy_is_given_in_joules_and_as_a_share() -> None:
    """It is that of the energies at the end; strength^2 / (2 K) is what a slab at its static strength holds."""
    problem, duration = RUNS["slab, slip law"]
    run = ss.simulate(problem, float(ss.simulate(problem, duration).events["peak_time"][0]))  # ends while it slips
    energy, _, rest = run.trapped_note.partition(" J/m2 in waves at the end, ")
    trapped = float(run.energy(run.history.duration).trapped[0])
    assert float(energy) == pytest.approx(trapped, rel=1e-5, abs=0.0)
    held = run.problem.strength**2 / (2.0 * SLAB.stiffness)
    assert float(rest.split()[0]) == pytest.approx(100.0 * trapped / held, rel=0.05, abs=0.0)
