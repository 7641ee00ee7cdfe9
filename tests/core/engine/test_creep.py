"""Leaps over creep against brute force: the same contact with every round trip run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import stickslip as ss
from stickslip.engine.creep.pattern import Pattern, monotone_parts
from stickslip.engine.history.history import Epoch
from stickslip.engine.history.series import horner
from stickslip.engine.state.layout import TERMS
from tests.core.engine.creep_truth import ROUND, printed

F = ss.friction
SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=10e3, normal_stress=100e6)


@cache
def brute_force(problem: ss.Problem, trips: int) -> ss.Solution:
    """Every round trip run."""
    return ss.simulate(problem, trips * ROUND, creep_rtol=0.0)


def means(solution: ss.Solution, trips: np.ndarray) -> np.ndarray:
    """Mean of the slips at the start and the end of round trips, m: what leaps over creep are about."""
    return 0.5 * (solution.slip(trips * ROUND) + solution.slip((trips + 1) * ROUND)) - solution.problem.initial_slip


def trips_of(solution: ss.Solution) -> Iterator[tuple[int, int, float]]:
    """Of each leap: first round trip, the one on which it lands, bound of the error (m)."""
    for row in solution.creep.itertuples():
        yield round(row.start / ROUND), round(row.end / ROUND), row.error


KINKED = F.PiecewiseLinearSlip(slips=(0.0, 8e-4, 1.2e-3, 1e-2), coefficients=(0.6, 0.599984, 0.599975, 0.5997))


# ---- the printed slab ---------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("tolerance", [2e-5, 1e-4, 1e-3])
def test_slip_stays_within_the_bound_of_each_leap(tolerance: float) -> None:
    """A hundred times faster: averaged slip within the bound where a leap lands, within the tolerance all along."""
    exact, solution = brute_force(printed(100), 420), ss.simulate(printed(100), 420 * ROUND, creep_rtol=tolerance)
    assert len(solution.creep) > 0
    for first, last, error in trips_of(solution):
        behind, inside = np.arange(last, last + 3), np.arange(first, last)
        assert error <= 1.001 * tolerance * means(exact, behind[:1])[0]
        assert np.abs(means(solution, behind) - means(exact, behind)).max() <= error
        assert (np.abs(means(solution, inside) - means(exact, inside)) <= tolerance * means(exact, inside)).all()


@pytest.mark.slow
def test_no_leap_passes_over_a_feature_of_the_law() -> None:
    """A bump a hundredth as wide as the leap is long, 1 % of whose height holds the contact back for thousands of round trips.

    Without the guards of the formula the leap ends at 0.04 m as if there were no bump. Slip is held below it: -30 % within 1e-2.
    """
    slab = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
    slips = []
    for bump in ("", "+ 0.002*exp(-((u - 0.02)/2e-4)**2)"):
        law = ss.friction.FromExpression(f"0.6 - 0.001*u {bump}")
        problem = ss.Problem(slab, law, pull_rate=1e-6, initial_excess=0.0)
        solution = ss.simulate(problem, 4e4, creep_rtol=1e-3)
        assert solution.status.ok
        assert solution.creep.round_trips.sum() > 1000
        slips.append(float(solution.slip(4e4)))
    assert slips[0] == pytest.approx(0.0412, rel=1e-3)
    assert slips[1] == pytest.approx(0.0198, rel=1e-2)  # it creeps up the flank of the bump, load 0.002 S = 0.058 G/h m


# ---- other laws, the other direction --------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("law", "excess", "pull", "trips"),
    [
        (F.ExponentialSlipWeakening(static=0.8, dynamic=0.3, distance=30.0), 1e4, 2e-6, 420),  # stable for ever
        (F.ExponentialSlipWeakening(static=0.8, dynamic=0.3, distance=14.0), 1e2, 1e-5, 200),  # once it has slipped 0.56 m
        (KINKED, 1e3, 5e-7, 500),
    ],
    ids=["stable", "after-an-event", "kinks"],
)
def test_slip_under_other_laws_stays_within_the_tolerance_in_both_directions(
    law: F.FrictionLaw, excess: float, pull: float, trips: int
) -> None:
    """Weakening, strengthening, kinks: within the tolerance of brute force; and backwards the same with the other sign."""
    problem = ss.Problem(SLAB, law, pull_rate=pull, initial_excess=excess)
    exact, solution = brute_force(problem, trips), ss.simulate(problem, trips * ROUND, creep_rtol=1e-4)
    row = np.arange(trips - 1)
    assert len(solution.creep) > 0
    assert (np.abs(means(solution, row) - means(exact, row)) <= 1e-4 * means(exact, row)).all()
    back = replace(problem, pull_rate=-pull, initial_excess=None, initial_load=-problem.load)
    mirrored = ss.simulate(back, trips * ROUND, creep_rtol=1e-4)
    time = np.linspace(0.0, trips * ROUND, 500)
    np.testing.assert_allclose(mirrored.slip(time), -solution.slip(time), rtol=1e-6, atol=0.0)


WEAKENING = [
    F.LinearSlipWeakening(static=0.677, dynamic=0.525, distance=0.4),
    F.ExponentialSlipWeakening(static=0.7, dynamic=0.2, distance=0.5),
]


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("law", WEAKENING, ids=lambda law: law.kind)
def test_bounds_hold_where_slip_goes_up_and_down(law: F.FrictionLaw) -> None:
    """Thin slabs near instability, pulled fast: waves of slip that the leap drops, seen over two round trips only."""
    rng, leaps = np.random.default_rng(7), 0
    while leaps < 3:
        near, tolerance = 0.02 + np.linspace(0.0, 0.02, 50), 10 ** rng.uniform(-3.5, -2.3)
        steepest = float(np.abs(np.diff(law.coefficient(near, 0.0 * near)) / np.diff(near)).max())
        slab = replace(SLAB, thickness=float(rng.uniform(0.5, 0.85)) * SLAB.shear_modulus / (SLAB.normal_stress * steepest))
        pull, excess = 10 ** rng.uniform(-6, -4.5) * slab.thickness / 300.0, 10 ** rng.uniform(2, 4.5)
        problem = ss.Problem(slab, law, pull_rate=pull, initial_slip=0.02, initial_excess=excess)
        end, row = 300 * slab.two_way_time, np.arange(299)
        solution, exact = (ss.simulate(problem, end, creep_rtol=rtol) for rtol in (tolerance, 0.0))
        slips = [0.5 * (run.slip(row * slab.two_way_time) + run.slip((row + 1) * slab.two_way_time)) for run in (solution, exact)]
        off = np.abs(slips[0] - slips[1])
        assert (off <= tolerance * (slips[1] - 0.02)).all()
        for landed in solution.creep.start_row + solution.creep.round_trips:
            assert off[landed : landed + 3].max() <= solution.creep.error.max()
            leaps += 1


def test_no_leap_passes_over_a_kink_of_the_law() -> None:
    """The exact engine passes a knot in slip."""
    problem = ss.Problem(SLAB, KINKED, pull_rate=5e-7, initial_excess=1e3)
    solution = ss.simulate(problem, 500 * ROUND, creep_rtol=1e-4)
    assert len(solution.creep) > 1
    for first, last, _ in trips_of(solution):
        slips = solution.slip(np.array([first, last]) * ROUND)
        assert KINKED.piece_at(slips[0]) == KINKED.piece_at(slips[1])


@cache
def years(tolerance: float) -> ss.Solution:
    """Run the printed slab up to its second pulse, after 332 days."""
    return ss.simulate(printed(1), 5.026e6 * ROUND, creep_rtol=tolerance)


@pytest.mark.slow
def test_time_after_years_of_creep_is_sharp() -> None:
    """At the second pulse, local times count from a whole number of round trips."""
    run = years(1e-5)
    window = run.window(int(run.events.slip.iloc[2:].argmax()) + 2)
    assert window.epoch.trip > 5_000_000
    assert 0.0 <= window.epoch.offset < ROUND
    assert window.event.start == pytest.approx(window.epoch.trip * ROUND + window.epoch.offset, rel=1e-15, abs=0.0)
    peak = float(window.event.peak_after)
    near = peak + np.array([0.0, 1e-9, 2e-9])  # a float of seconds since the start has a resolution of 4e-9 s here
    np.testing.assert_allclose(np.diff(window.event_slip(near)), window.event.peak_rate * 1e-9, rtol=1e-5, atol=0.0)


@pytest.mark.slow
def test_slip_has_no_gap_at_the_borders_of_a_leap() -> None:
    run = years(1e-5)
    for epoch in (Epoch(0, 0.0), Epoch(41_000, 1.234), Epoch(5_025_990, 5.678)):
        history = run.history.seen_from(epoch)
        for leap in run.creep.itertuples():
            for row in (leap.start_row, leap.start_row + leap.round_trips):
                border = float(history.seconds(np.array([row]), np.zeros(1))[0])
                time = border + np.spacing(max(abs(border), ROUND)) * np.arange(-8.0, 9.0)
                slip = history.slipped(history.find(time, "right"))
                assert np.ptp(slip) < 1e-11 * slip[0]


@pytest.mark.slow
def test_the_printed_slab_creeps_for_years_without_gaps() -> None:
    """Creep behind the first pulse as well: 330 days, 5 million round trips, the second pulse; and the energy balances."""
    second = []
    for tolerance in (1e-5, 1e-6):
        solution = years(tolerance)
        start, end = solution.creep.end.iloc[1], solution.duration
        second.append(brentq(lambda t: float(solution.slip(t)) - solution.problem.initial_slip - 1.6, start, end, xtol=1e-6))  # noqa: B023
    assert solution.creep.round_trips.sum() > 5_000_000
    assert second[0] == pytest.approx(second[1], rel=0.0, abs=ROUND)
    before = solution.creep.end.to_numpy()[:2] + 1.5 * ROUND
    energy = solution.energy(before)
    bound = 1.5e8 * np.cumsum(solution.creep.error.to_numpy())[:2]  # an error of slip is one of heat
    assert (np.abs(energy.balance.to_numpy()) < bound).all()
    assert (bound < 1e-5 * energy.heat.to_numpy()).all()


# ---- the machinery ------------------------------------------------------------------------------------------------------------


def test_leaps_are_stored_and_listed_and_shown(tmp_path) -> None:  # type: ignore[no-untyped-def]
    """Leaps are in the table, in the summary and in the file; the waves within are not known."""
    solution = ss.simulate(printed(100), 300 * ROUND, creep_rtol=1e-4)
    again = ss.open_solution(solution.to_netcdf(tmp_path / "creep.nc"))
    assert list(solution.creep.columns) == ["start", "end", "start_row", "round_trips", "error", "time_error"]
    assert again.creep.equals(solution.creep)
    time = np.linspace(0.0, 300 * ROUND, 500)
    np.testing.assert_array_equal(again.slip(time), solution.slip(time))
    assert f"over {solution.creep.round_trips.sum()} round trips" in repr(solution)
    with pytest.raises(ss.InputError, match="leap over creep"):
        solution.energy(float(solution.creep.start.iloc[0]) + 2 * ROUND)
    assert len(ss.simulate(printed(100), 20 * ROUND).creep) == 0


class Columns:
    """`Pattern.above` for several lifts."""

    def __init__(self, pattern: Pattern, lifts: np.ndarray) -> None:
        found = [pattern.above(float(lift)) for lift in lifts]
        self.area, self.length, self.border = (np.array([getattr(a, name) for a in found]) for name in ("area", "length", "border"))


def test_areas_and_lengths_above_a_level_agree_with_quadrature() -> None:
    """Area, length and border sum of a load in pieces, against quadrature and differences."""
    rng = np.random.default_rng(3)
    load = np.zeros((3, TERMS))
    load[:, :5] = rng.normal(size=(3, 5))
    theta, speed, bend = np.array([0.0, 1.0, 1.5]), np.array([1.0, 0.3, 2.0]), np.array([0.0, 0.2, 0.0])
    pattern = Pattern(monotone_parts(load, theta, speed, bend))

    def above(lift: float, power: int) -> float:
        total = 0.0
        for p, a, b in zip(load, speed, bend, strict=True):

            def density(xi: float, p: np.ndarray = p, a: float = a, b: float = b) -> float:
                value = float(horner(p[None, :], np.array([xi]))[0]) + lift
                return (max(value, 0.0) if power else float(value > 0.0)) * (a + 2.0 * b * xi)

            total += quad(density, 0.0, 1.0, limit=400, points=np.linspace(0.02, 0.98, 49))[0]
        return total

    lifts = np.array([-0.7, 0.4])
    found = Columns(pattern, lifts)
    np.testing.assert_allclose(found.area, [above(lift, 1) for lift in lifts], rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(found.length, [above(lift, 0) for lift in lifts], rtol=1e-3, atol=1e-3)
    step = 1e-6
    below, beyond = Columns(pattern, lifts - step), Columns(pattern, lifts + step)
    np.testing.assert_allclose(found.border, (beyond.length - below.length) / (2 * step), rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(found.length, (beyond.area - below.area) / (2 * step), rtol=1e-8, atol=0.0)
