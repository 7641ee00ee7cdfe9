"""Pieces of waves in layers that are merged: beside runs that merge nothing, counted, lumped, taken up again, and for an hour."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.state.layout import NEVER
from stickslip.problem.loading import Sinusoidal
from stickslip.run.exact_run import ExactRun
from stickslip.run.options import CallOptions
from stickslip.run.run_loop import WholeHistory, run_to_end

RPM = np.pi / 30
SOFT = {"driver_impedance": "1 kN m s", "driver_inertia": "2900 kg m^2", "driver_integral_gain": "500 N m/rad"}
SLIP_IN_A_MINUTE = 240.200589
"""Slip (rad) of `machine_above_collars` after 60 s, by a run that merges and lumps nothing: 2 821 940 pieces."""


def above_collars(**machine: Any) -> ss.Problem:
    """Return the bundled pipe and collars with a machine on top."""
    problem = ss.load_scenario("pipe-and-collar").problem
    return replace(problem, body=replace(problem.body, **machine))


def machine_above_collars() -> ss.Problem:
    """Return them with a mass on top: each fold makes jumps that go through all cells, and these make more folds."""
    return above_collars(driver_inertia=2000.0)


def layers(draw: np.random.Generator) -> ss.Problem:
    """Return layers with random numbers behind a random machine, under a law that weakens with slip rate."""
    density, speed = draw.uniform(1800, 2800, 2), draw.uniform(1000, 3500, 2)
    impedance = float(density[-1] * speed[-1])
    body = ss.LayeredSlab(
        [*draw.uniform(20, 60, 2)], [*density], [*speed], 1e6, travel_time_error=0.05, driver_impedance=0.5 * impedance,
        driver_inertia=draw.uniform(0.02, 0.1) * impedance, driver_integral_gain=0.0,
    )  # fmt: skip
    law = ss.friction.ExponentialStribeck(static=0.6, dynamic=0.4, rate=draw.uniform(0.2, 0.6))
    return ss.Problem(body, law, pull_rate=draw.uniform(0.02, 0.1), initial_excess=-1e4)


def unmerged(problem: ss.Problem, duration: float) -> ss.Solution:
    """Return a run in which nothing is merged."""
    run = ExactRun.begin(problem, CallOptions.of(problem, duration=duration, shortest_event=0.0).check("test", problem))
    run.count.merge_above = run.count.merge_at = NEVER
    return run_to_end(run, WholeHistory(run))


def test_merged_pieces_of_a_machine_above_collars_are_fewer_and_tell_the_same() -> None:
    problem, time = machine_above_collars(), np.linspace(0.0, 40.0, 400)
    merged, known = ss.simulate(problem, 40.0), unmerged(problem, 40.0)
    assert len(known.history) > 60_000
    assert len(merged.history) < 0.7 * len(known.history)
    np.testing.assert_allclose(merged.slip(time), known.slip(time), rtol=1e-9, atol=1e-9)
    assert len(merged.events) == len(known.events)
    np.testing.assert_allclose(merged.events.start, known.events.start, rtol=1e-9, atol=1e-9)
    assert "were merged, which changed the waves by" in merged.rounding_note
    assert known.rounding_note == ""


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("seed", [0, 2, 4])
def test_merged_pieces_of_random_layers_tell_the_same(seed: int) -> None:
    problem = layers(np.random.default_rng(seed))
    duration = 200.0 * problem.round_trip_time
    merged, known = ss.simulate(problem, duration), unmerged(problem, duration)
    time = np.linspace(0.0, duration, 300)
    size = float(known.slip(duration))
    assert size > 0.0
    assert len(merged.history) <= len(known.history)
    np.testing.assert_allclose(merged.slip(time), known.slip(time), rtol=1e-9, atol=1e-9 * size)
    np.testing.assert_allclose(merged.load(time), known.load(time), rtol=1e-6, atol=1e-6 * problem.strength)


@pytest.mark.slow
def test_a_normal_load_that_varies_on_layers_tells_the_same_merged() -> None:
    body = ss.LayeredSlab([1000.0, 8000.0], [2800.0, 2800.0], [1750.0, 3500.0], 1e8)
    pressed = Sinusoidal(mean=1e8, amplitude=1e7, period=3.0)
    problem = ss.Problem(body, ss.friction.Coulomb(0.6, 0.4), pull_rate=0.5, initial_excess=-1e6, normal_load=pressed)
    merged, known = ss.simulate(problem, 150.0), unmerged(problem, 150.0)
    assert len(merged.history) < len(known.history)
    time = np.linspace(0.0, 150.0, 300)
    np.testing.assert_allclose(merged.slip(time), known.slip(time), rtol=1e-9, atol=1e-9)


@pytest.mark.slow
def test_energies_balance_where_pieces_are_merged() -> None:
    run = ss.simulate(machine_above_collars(), 18.0)
    energy = run.energy(np.array([13.0, 18.0]))
    assert float(np.abs(energy.balance).max()) < 1e-9 * float(energy.heat.max())


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("shortest", [None, "2 ms"])
def test_a_run_with_merged_pieces_is_taken_up_again_bit_for_bit(shortest: str | None, tmp_path: Path) -> None:
    whole = ss.simulate(machine_above_collars(), 34.0, shortest_event=shortest)
    file = tmp_path / "part.nc"
    ss.simulate(machine_above_collars(), 31.3, shortest_event=shortest).to_netcdf(file)
    again = ss.resume(file, 34.0)
    assert isinstance(again, ss.Solution)
    assert np.array_equal(again.history.store.pieces, whole.history.store.pieces)


def test_lumped_pieces_are_few_and_right_on_average() -> None:
    """A minute in pieces of the shortest event, beside the same minute with every jump resolved."""
    problem = machine_above_collars()
    shortest = 2e-3
    run = ss.simulate(problem, 60.0, shortest_event=shortest)
    assert len(run.history) < 2.0 * 60.0 / shortest
    assert float(run.slip(60.0)) == pytest.approx(SLIP_IN_A_MINUTE, rel=1e-2)


def test_soft_torque_turns_ever_more_evenly_in_fewer_pieces() -> None:
    """At 140 rpm the waves of the start fade, and with them the jumps: 12 pieces are left of each round trip if none merge."""
    run = ss.simulate(replace(above_collars(**SOFT), pull_rate=140 * RPM), "15 min")
    assert run.status.name == "finished"
    bit = run.slip_rate(np.linspace(850.0, 900.0, 1000)) / RPM
    assert bit.min() == pytest.approx(140.0, abs=0.1)
    assert bit.max() == pytest.approx(140.0, abs=0.1)
    assert np.bincount(run.history.store.trip)[-2] <= 6


@pytest.mark.slow
@pytest.mark.parametrize("speed", [100, 140])
def test_an_hour_of_soft_torque_above_pipe_and_collars_ends(speed: int) -> None:
    run = ss.simulate(replace(above_collars(**SOFT), pull_rate=speed * RPM), "1 h")
    assert run.status.name == "finished"
    assert len(run.history) < 1_000_000
    assert run.slip_rate(np.linspace(3500.0, 3600.0, 1000)).mean() / RPM == pytest.approx(speed, abs=1e-3)


@pytest.mark.slow
def test_a_minute_of_a_machine_above_collars_ends_by_itself_and_exactly_if_asked_to() -> None:
    problem = machine_above_collars()
    run = ss.simulate(problem, 60.0)
    assert len(run.history) < 500_000
    assert "right only on average" in run.lumping_note
    assert float(run.slip(60.0)) == pytest.approx(SLIP_IN_A_MINUTE, rel=3e-3)
    exact = ss.simulate(problem, 60.0, shortest_event=0.0)
    assert len(exact.history) < 1_000_000
    assert float(exact.slip(60.0)) == pytest.approx(SLIP_IN_A_MINUTE, rel=1e-7)
    assert exact.lumping_note == ""
