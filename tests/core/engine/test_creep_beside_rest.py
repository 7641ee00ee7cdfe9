"""Creep of a slab beside rest, while waves of an event ring: leaps that take the pattern of the waves from the queue of echoes."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.creep.creep_landing import CreepLanding
from stickslip.engine.creep.creep_walk import Piece
from stickslip.engine.creep.planner import CreepPlan
from stickslip.engine.state.layout import TERMS, new_store
from stickslip.foundation.units import to_si
from tests.core.run.long_runs.problems import continued, differences

RINGS = ss.load_scenario("fig5-slab-u0-1e-2").problem
"""A slab that creeps under the crest of the wave that its first event leaves."""


def test_a_leap_beside_rest_lands_where_computing_each_round_trip_does() -> None:
    """Mean slip of the landing within the stated error; load of what rests to 1e-9 of the normal stress. Brute force: 130 trips."""
    fast = replace(RINGS, pull_rate=3e4 * RINGS.pull_rate)
    turn = fast.round_trip_time
    exact, leaping = (ss.simulate(fast, 110.0 * turn, creep_rtol=rtol) for rtol in (0.0, 1e-2))
    assert exact.status.ok
    (leap,) = leaping.creep.itertuples()
    assert leap.round_trips > 50
    landed = leaping.history.store.trip == leap.start_row + leap.round_trips
    assert leaping.history.store.phase_to[landed].sum() < 0.9 * turn * landed.sum()
    theirs, ours = (0.5 * float(run.slip(leap.end) + run.slip(leap.end + turn)) for run in (exact, leaping))
    assert abs(ours - theirs) <= leap.error < 1e-3
    times = leap.end + turn * np.linspace(0.0, 1.0, 400, endpoint=False)
    rests = (exact.slip_rate(times) == 0.0) & (leaping.slip_rate(times) == 0.0)
    assert 100 < rests.sum() < 400
    assert np.abs(leaping.load(times) - exact.load(times))[rests].max() <= 1e-9 * fast.normal


@pytest.fixture(scope="module")
def printed() -> ss.Solution:
    """Six years of the printed slab."""
    return ss.simulate(ss.load_scenario("fig5-slab-printed").problem, "6 years")


def test_only_what_slips_is_written_where_a_leap_lands(printed: ss.Solution) -> None:
    """The waves of the first events ring beside creep: a landing writes a part of the round trip, the rest stands as it was."""
    store, turn = printed.history.store, printed.problem.round_trip_time
    assert printed.status.ok
    assert len(printed.history) < 70_000
    shares = []
    for leap in printed.creep.itertuples():
        rows = store.trip == leap.start_row + leap.round_trips
        shares.append((store.phase_to[rows] - store.phase_from[rows]).sum() / turn)
    assert min(shares) < 0.8
    assert max(shares) <= 1.0 + 1e-12


def test_the_waves_tile_the_round_trip_after_each_leap(printed: ss.Solution) -> None:
    """No gap and no overlap, up to roundings of the offset."""
    turn = printed.problem.round_trip_time
    for leap in printed.creep.itertuples():
        _, low, high = printed.history.standing(int(leap.start_row + leap.round_trips))
        assert low[0] == 0.0
        assert high[-1] == turn
        assert np.abs(low[1:] - high[:-1]).max(initial=0.0) <= 4.0 * np.spacing(turn)


@pytest.mark.slow
def test_energy_balances_after_leaps_beside_rest(printed: ss.Solution) -> None:
    """To 1e-9 of the heat: the load of a leap is the mean over the whole round trip, not over what slips of it."""
    energy = printed.energy(np.array([printed.duration]))
    assert abs(float(energy["balance"].values[0])) <= 1e-9 * float(energy["heat"].values[0])


def test_a_catalogue_takes_no_leap_for_a_step_that_it_proves() -> None:
    """Its bound is that of the steps, below 1e-8 of the normal stress; the pieces of a leap are means over round trips."""
    problem = ss.load_scenario("fig5-slab-printed").problem
    told = ss.catalogue(problem, "6 years").attrs
    assert "leaps over" in told["creep"]
    number, unit = re.findall(r"holds to (\S+) (\w*Pa)", told["proven"])[0]
    assert to_si(float(number), unit, "Pa") <= 1e-8 * problem.normal


@pytest.mark.slow
def test_a_run_with_leaps_beside_rest_is_resumed_bit_for_bit(printed: ss.Solution, tmp_path: Path) -> None:
    """Wherever it is stopped."""
    problem = printed.problem
    ss.simulate(problem, 3.9 * ss.YEAR, checkpoint=tmp_path / "run.nc")
    assert differences(continued(tmp_path / "run.nc", printed.duration), printed) == []


@pytest.mark.slow
@pytest.mark.parametrize(("name", "most"), [("fig5-slab-printed", 400_000), ("fig5-slab-u0-1e-2", 600_000)])
def test_slabs_of_figure_5_go_on_for_400_years(name: str, most: int) -> None:
    """The mean traction of the last round trips is what the driver, less all slip, makes of that at the start: to 1e-4 of it.

    That is 3 mm of 36 m of slip, through all leaps.
    """
    run = ss.simulate(ss.load_scenario(name).problem, "400 years", max_pieces=most)
    assert run.status.ok
    problem, trip = run.problem, run.problem.round_trip_time
    times = run.duration - np.linspace(50.0, 10.0, 20_001) * trip
    held = problem.pull_rate * times.mean() - (run.slip(times).mean() - problem.initial_slip)
    assert run.traction(times).mean() == pytest.approx(problem.load + problem.body.stiffness * held, rel=1e-4)
    assert len(run.events) > 10


def test_a_piece_of_no_width_is_not_written_where_a_leap_lands() -> None:
    """It would begin where a piece of the pattern begins, and the queue of echoes would take out one for the other.

    Before, the slab of Fig. 5 slipped on the same 3e-8 s of half a million round trips, 234 years after its start.
    """
    store, turn, edge = new_store(5), RINGS.round_trip_time, 0.25 * RINGS.round_trip_time
    sliver = edge - 2.0 * np.spacing(turn)
    zeros = np.zeros(TERMS)
    ends = [0.0, 0.125 * turn, sliver, edge + 2.0 * np.spacing(turn)]
    pieces = [Piece(True, begin, end - begin, 0.0, 0.0, zeros, zeros) for begin, end in pairwise(ends)]
    begun = SimpleNamespace(slip_now=0.0, law_slip=0.0, piece=0)
    run: Any = SimpleNamespace(store=store, state=begun, count=begun)
    averaged: Any = SimpleNamespace(strength=SimpleNamespace(sign=1.0))
    past = CreepLanding(RINGS, averaged, CreepPlan([], 0.0), 0.0).write_landing(run, 2, 7, pieces, np.array([0.0, edge, turn]))
    assert past == 4
    assert store.phase_from[2:past].tolist() == [0.0, 0.125 * turn]
    assert store.phase_to[2:past].tolist() == [0.125 * turn, edge]
