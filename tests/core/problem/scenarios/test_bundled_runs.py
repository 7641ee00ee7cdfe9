"""The bundled scenarios, run: what their comments say, against numbers computed outside the package by two other methods."""

import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.scenarios.scenario import load_scenario

R = 2e4 / 3500
YEAR = 31_557_600.0


def first_event(name: str) -> pd.Series:
    solution = ss.simulate(name)
    assert solution.status.ok
    events = solution.catalogue(event_rate=0.0)
    assert solution.problem.body.has_waves or len(solution.shocks) == 0 < 1 == len(events)
    return events.iloc[0]


@pytest.mark.parametrize(
    ("name", "end", "slip", "peak_rate", "peak_time", "pulses"),
    [
        ("fig5-slab-printed", 7.584372, 6.0571375e-4, None, R, 1),
        ("fig5-slab-reconstructed", R, 0.376105283, 10.204432, None, 3),
        ("fig5-slab-u0-1e-2", R, 1.2428558, None, 1.5676733, 1),
        ("fig6-slab", R, 23.4402332474, None, R, 1),
        ("fig7-slab-critical", R, 5.65875644e-4, 1.40832223e-4, R, 1),
        ("fig5-block-reconstructed-k", 3.029102456, 2.721335481, 5.538637, 2.579243, None),
        ("fig5-block-reconstructed-omega", 0.586014899, 0.273505101, 1.757632, 0.442580, None),
        ("fig6-block-reconstructed", 2.226453818, 2.061159848, 3.511221, 1.839772, None),
    ],
)
def test_the_first_event_has_its_verified_numbers(
    name: str, end: float, slip: float, peak_rate: float | None, peak_time: float | None, pulses: int | None
) -> None:
    """Each number to the digits that are given: half a unit of its last place. Nothing but waves makes the slip rate jump."""
    event = first_event(name)
    assert event.start == 0.0
    for value, expected in ((event.end, end), (event.slip, slip), (event.peak_rate, peak_rate), (event.peak_time, peak_time)):
        if expected is not None:
            assert value == pytest.approx(expected, rel=0.0, abs=0.51 * 10.0 ** _last_place(expected))
    assert pulses is None or event.pulses == pulses


def test_the_printed_slab_under_constant_load_peaks_at_the_closed_form() -> None:
    """Without pulling, the peak is at cot(omega 5e-3 m) Z / (amplitude omega S) exactly."""
    scenario = load_scenario("fig5-slab-u0-1e-2")
    still = replace(scenario, problem=replace(scenario.problem, pull_rate=0.0))
    expected = 9.8e6 / (2.5e8 * math.tan(0.025))
    assert ss.simulate(still).events.peak_time[0] == pytest.approx(expected, rel=1e-9, abs=0)


def test_the_cycles_of_the_block_are_all_alike() -> None:
    scenario = load_scenario("cycles-block")
    run = ss.simulate(scenario)
    events = run.events
    assert len(events) == 7
    assert events.slip.max() == pytest.approx(0.164279, rel=0, abs=5e-7)
    assert events.slip.max() == pytest.approx(events.slip.min(), rel=1e-9, abs=0)
    recurrence = events.start.diff().iloc[1:]
    assert recurrence.mean() / YEAR == pytest.approx(events.slip[0] / 0.035, rel=1e-6, abs=0)
    assert recurrence.max() == pytest.approx(recurrence.min(), rel=1e-9, abs=0)
    energy = run.energy([run.duration])
    assert abs(float(energy.balance[0] / energy.heat[0])) < 1e-8


def test_the_cycles_of_the_slab_do_not_depend_on_the_tolerance() -> None:
    """Small slips lead in each main one; main slips do not depend on the tolerance, so they are not chaos of rounding."""
    scenario = load_scenario("cycles-slab")
    runs = [ss.simulate(replace(scenario, rtol=rtol)) for rtol in (1e-10, 1e-13)]
    main = [(events := run.catalogue(event_rate=0.0))[events.slip > 1e-5] for run in runs]
    assert len(main[0]) == 7
    assert main[0].slip.between(2.0e-5, 2.5e-5).all()
    assert main[0].start.diff().iloc[1:].between(4.2e-3, 4.6e-3).all()
    assert main[0].slip.to_numpy() == pytest.approx(main[1].slip.to_numpy(), rel=1e-6, abs=0)
    assert main[0].start.to_numpy() == pytest.approx(main[1].start.to_numpy(), rel=1e-7, abs=1e-9)
    small = runs[0].catalogue(event_rate=0.0)
    assert len(small) - len(main[0]) > 15
    assert len(runs[0].history) < 5000
    energy = runs[0].energy([runs[0].duration])
    assert abs(float(energy.balance[0] / energy.heat[0])) < 1e-8


def peaks(solution: ss.Solution, low: float, high: float) -> float:
    """Largest friction coefficient between two times (s)."""
    time, traction = (np.asarray(one) for one in solution.curve("traction"))
    return float(traction[(time >= low) & (time <= high)].max() / solution.problem.normal)


def test_velocity_steps_end_in_steady_sliding() -> None:
    """Friction before each step is that of steady sliding, (a - b) ln 10 less a decade; the peaks are those of the description."""
    run = ss.simulate("velocity-steps-block")
    law, pull = run.problem.friction, run.problem.pull_rate
    for time, rate in zip((*pull.times[1:], run.duration), pull.values, strict=True):
        coefficient = float(run.traction(time, side="left")) / run.problem.normal
        assert coefficient == pytest.approx(0.6 - 0.003 * math.log(rate / 1e-6), rel=0, abs=1e-7), time
        assert float(law.steady_coefficient(rate)) == pytest.approx(coefficient, rel=0, abs=1e-7)
    assert peaks(run, 200.0, 250.0) - 0.6 == pytest.approx(0.017, rel=0, abs=5e-4)
    assert peaks(run, 500.0, 510.0) - 0.6 == pytest.approx(0.038, rel=0, abs=5e-4)


def test_holds_heal_friction() -> None:
    """The peaks of the description; b ln 10 more for ten times longer; half as much under the slip law."""
    scenario = load_scenario("slide-hold-slide-block")
    sliding = 0.6 - 0.003 * math.log(10.0)
    slip_law = replace(scenario.problem, friction=replace(scenario.problem.friction, evolution="slip"))
    grown = {}
    for name, run in (("ageing", ss.simulate(scenario)), ("slip", ss.simulate(replace(scenario, problem=slip_law)))):
        begins = [one.start for one in run.problem.pull_rate.segments][2::2]
        grown[name] = [peaks(run, begin, begin + 30.0) - sliding for begin in begins]
    assert grown["ageing"] == pytest.approx([0.024, 0.052, 0.082], rel=0, abs=5e-4)
    assert grown["ageing"][2] - grown["ageing"][1] == pytest.approx(0.013 * math.log(10.0), rel=0.01, abs=0)
    assert grown["slip"] == pytest.approx([0.5 * one for one in grown["ageing"]], rel=0.11, abs=0)


def test_tides_choose_the_hour() -> None:
    """The strength is reached when the spring's own load, in closed form, gets there first: a root finder says when."""
    run = ss.simulate("tides-block")
    problem, events = run.problem, run.catalogue(event_rate=0.0)
    pull, stiffness = problem.pull_rate, problem.body.stiffness
    assert len(events) == 7
    before = (0.5 * pull.period - events.start % pull.period) / 3600.0
    assert before.between(0.35, 1.55).all()

    def load(time: np.ndarray) -> np.ndarray:
        swing = pull.amplitude * pull.period / math.pi * np.sin(math.pi * time / pull.period) ** 2
        return stiffness * (pull.mean * time + swing)

    grid = np.arange(0.0, 1.1 * events.start[0], 60.0)
    first = grid[np.flatnonzero(load(grid) > 1e12)[0]]
    exact = brentq(lambda time: float(load(np.asarray(time))) - 1e12, first - 60.0, first)
    assert events.start[0] == pytest.approx(exact, rel=0, abs=1e-3)


def test_each_crest_of_a_passing_wave_triggers_slip() -> None:
    scenario = load_scenario("stress-pulse-slab")
    run = ss.simulate(scenario)
    assert run.events.start.tolist() == pytest.approx([2.375, 6.499], rel=0, abs=5e-4)
    assert run.events.start[0] == pytest.approx(2.375, rel=1e-13, abs=0)  # 0.7143 * 0.16 MPa/s from 1.5 s on
    assert run.events.duration.tolist() == pytest.approx([1.0, 1.0], rel=1e-9, abs=0)  # until its echo is back
    assert run.events.slip.tolist() == pytest.approx([0.075, 0.0705], rel=0, abs=5e-4)
    alone = ss.simulate(replace(scenario, problem=replace(scenario.problem, far_stress=None)))
    assert alone.catalogue(event_rate=0.0).empty


def _last_place(value: float) -> int:
    """Exponent of the last decimal place of a number as written."""
    mantissa, _, exponent = repr(value).partition("e")
    return int(exponent or 0) - min(len(mantissa.partition(".")[2]), 12)


@pytest.mark.parametrize("name", ["fig5-block-printed", "fig6-block-printed", "fig7-block-critical"])
def test_printed_and_critical_blocks_have_no_macroscopic_event(name: str) -> None:
    solution = ss.simulate(name)
    assert solution.status.ok
    assert solution.catalogue(event_rate=0.0).slip.max() < 8e-3


def test_the_loop_of_figure_4_jumps_at_its_folds() -> None:
    solution = ss.simulate("fig4-loop")
    assert solution.shocks.cause.tolist() == ["fold", "fold"]
    assert solution.load(R / 2) == pytest.approx(85.48e6, rel=1e-12, abs=0)
    up, down = solution.shocks.itertuples()
    assert solution.load(up.time) == pytest.approx(80e6, rel=1e-12, abs=0)
    assert solution.load(down.time) == pytest.approx(64_471_887.242, rel=0, abs=1e-3)
    assert (up.time, down.time) == pytest.approx((2.243, 5.213), rel=0, abs=5e-4)
    assert down.rate_after == 0.0
