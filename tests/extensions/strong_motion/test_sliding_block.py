"""The rigid block is exact: closed forms, an independent integration with 40 digits, the engine, and a motion with its answers."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.strong_motion.compiled import rigid_block
from stickslip.extensions.strong_motion.sliding_block import ShakenBlock
from tests.extensions.strong_motion.integrated_exactly import integrated_exactly
from tests.extensions.strong_motion.made import made_motion

DISPLACEMENT, PEAK, VELOCITY, AT, SLIPS, SLIDING, FIRST, LAST = range(8)
PLUS, MINUS = 0.2717904016874443, 0.23928403328862974


def answer(load, interval, forward, backward=math.inf):
    return ShakenBlock(np.asarray(load, float), interval).slide(np.array([forward]), backward)[0]


def random_load(random: np.random.Generator, samples: int) -> np.ndarray:
    """Return noise that passes a few Hz, with whole numbers in some draws, so that it touches a yield exactly."""
    width = int(random.integers(1, 6))
    load = np.convolve(random.normal(size=samples + width - 1), np.ones(width) / width, "valid")
    return np.round(load * 2.0) / 2.0 if random.random() < 0.3 else load


# ---- closed forms ---------------------------------------------------------------------------------------------------------


def test_a_rectangular_pulse_moves_it_by_newmarks_formula():
    """Newmark 1965: A t0 of velocity, less N: D = V^2/(2 N) (1 - N/A), here with edges of a microsecond."""
    pulse, strength, lasting = 3.0, 1.2, 0.5
    load = np.zeros(1_000_001)
    load[1:500_001] = pulse
    found = answer(load, 1e-6, strength)
    speed = pulse * lasting
    assert found[DISPLACEMENT] == pytest.approx(speed**2 / (2 * strength) * (1 - strength / pulse), rel=5e-6)
    assert found[VELOCITY] == pytest.approx((pulse - strength) * lasting, rel=5e-6)
    assert found[LAST] == pytest.approx(speed / strength, rel=5e-6)
    assert found[SLIPS] == 1


def test_a_triangular_pulse_moves_it_by_its_cubics():
    """Load 2 at its middle, yield 1: it starts at 0.5 s, is fastest at 1.5 s, with 0.5 m/s, and stops at 1 + sqrt(2)/2 + 0.5 s."""
    found = answer([0.0, 2.0, 0.0, 0.0], 1.0, 1.0)
    begin, top = 0.5, 1.5
    # from 1.5 s on the rate is 0.5 - s^2 until 2 s, when it is 0.25; then the load is 0 and it falls by 1 m/s^2
    at_two = 0.5 * 0.5 - 0.5**3 / 3.0
    rising = 2.0 * 0.5**3 / 6.0
    falling = 0.25 * 0.5 + 0.5 * 0.0 + (0.5 * 0.5**2 - 2.0 * 0.5**3 / 6.0)
    moved = rising + falling + at_two + 0.25**2 / 2.0
    assert found[[DISPLACEMENT, VELOCITY, AT, FIRST, LAST]] == pytest.approx([moved, 0.5, top, begin, 2.25], rel=1e-14)
    assert found[SLIDING] == pytest.approx(1.75, rel=1e-14)


def test_after_the_record_it_slides_on_until_it_stops():
    """Load 3 throughout, yield 1: 2 m/s^2 for 4 s, then 8 m/s that end in 8 s."""
    found = answer([3.0, 3.0, 3.0], 2.0, 1.0)
    assert found[[DISPLACEMENT, VELOCITY, LAST, SLIDING]] == pytest.approx([16.0 + 32.0, 8.0, 12.0, 12.0], rel=1e-15)


def test_it_rests_under_a_load_that_only_reaches_its_yield():
    found = answer([0.0, 1.0, 0.0, 1.0, 1.0, 0.0], 0.1, 1.0)
    assert found[[DISPLACEMENT, VELOCITY, SLIPS, SLIDING]].tolist() == [0.0, 0.0, 0.0, 0.0]
    assert np.isnan(found[[AT, FIRST, LAST]]).all()


def test_it_stops_and_slips_again_within_one_segment():
    """The load falls to -3 and rises to 5 within a second: a block with a little speed stops, waits, and slips once more."""
    found = answer([0.0, 1.2, -3.0, 5.0, 0.0], 1.0, 1.0)
    exact = integrated_exactly([0.0, 1.2, -3.0, 5.0, 0.0], 1.0, 1.0)
    assert found[SLIPS] == exact.slips == 2
    assert found[DISPLACEMENT] == pytest.approx(exact.displacement, rel=1e-14)


def test_it_turns_round_at_once_where_the_load_holds_it_the_other_way():
    load = [0.0, 2.0, -6.0, -6.0, 4.0, 0.0]
    found, exact = answer(load, 0.5, 1.0, 2.0), integrated_exactly(load, 0.5, 1.0, 2.0)
    assert found[SLIPS] == exact.slips == 2
    assert found[[DISPLACEMENT, PEAK, VELOCITY]] == pytest.approx([exact.displacement, exact.furthest, exact.fastest], rel=1e-13)


# ---- random records -------------------------------------------------------------------------------------------------------


@pytest.mark.sampled(every=12)
@pytest.mark.parametrize("seed", range(60))
def test_random_records_agree_with_forty_digits(seed: int):
    """Relative to the largest displacement that a push through the whole record can make; a touched yield may count as a slip."""
    random = np.random.default_rng(seed)
    load, interval = random_load(random, int(random.integers(2, 400))), float(random.choice([0.005, 0.01, 1 / 3]))
    forward = float(random.choice([0.5, 1.0, random.uniform(0.02, 1.5)]))
    backward = float(random.choice([math.inf, forward, random.uniform(0.1, 2.0)]))
    found, exact = answer(load, interval, forward, backward), integrated_exactly(load, interval, forward, backward)
    size = max(exact.furthest, 1e-3 * interval**2)
    assert found[[DISPLACEMENT, PEAK]] == pytest.approx([exact.displacement, exact.furthest], rel=0, abs=2e-12 * size)
    assert found[VELOCITY] == pytest.approx(exact.fastest, rel=1e-11)
    if math.isfinite(exact.last_stop):
        assert found[LAST] == pytest.approx(exact.last_stop, abs=1e-6 * interval)


def test_the_two_polarities_of_a_record_are_two_answers_and_mirror_each_other():
    load = random_load(np.random.default_rng(7), 3000)
    one, other = answer(load, 0.01, 0.3), answer(-load, 0.01, 0.3)
    assert abs(one[DISPLACEMENT] - other[DISPLACEMENT]) > 0.01 * one[DISPLACEMENT]
    both, mirrored = answer(load, 0.01, 0.3, 0.5), answer(-load, 0.01, 0.5, 0.3)
    assert both[DISPLACEMENT] == -mirrored[DISPLACEMENT]
    assert both[SLIPS] == mirrored[SLIPS]


@pytest.mark.parametrize("samples", [63, 64, 65, 127, 128, 129, 1000])
def test_rest_is_passed_over_without_missing_a_sample(samples: int):
    """One sample alone is above the yield, at every place, with blocks of all lengths at the end."""
    for place in {0, 1, 62, 63, 64, 65, samples // 2, samples - 2, samples - 1} & set(range(samples)):
        load = np.zeros(samples)
        load[place] = -2.0
        assert answer(-load, 0.01, 1.0)[SLIPS] == (place < samples - 1 or place > 0)
        assert answer(load, 0.01, 1.0, 1.0)[DISPLACEMENT] == -answer(-load, 0.01, 1.0, 1.0)[DISPLACEMENT] != 0.0
        assert answer(load, 0.01, 1.0)[SLIPS] == 0


def test_many_yields_at_once_are_each_one_alone():
    load = random_load(np.random.default_rng(3), 2000)
    yields = np.array([0.7, 0.1, 3.0, 0.25])
    block = ShakenBlock(load, 0.01)
    alone = np.vstack([block.slide(yields[n : n + 1]) for n in range(4)])
    assert np.array_equal(block.slide(yields), alone, equal_nan=True)
    assert block.slide(yields)[2, 0] == 0.0


# ---- the motion in time ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("backward", [math.inf, 0.6])
def test_the_motion_in_time_begins_ends_and_peaks_as_the_answer_says(backward: float):
    load = random_load(np.random.default_rng(11), 1500)
    block = ShakenBlock(load, 0.02)
    found, motion = block.slide(np.array([0.4]), backward)[0], block.motion(0.4, backward)
    time = np.linspace(0.0, found[LAST], 400_001)
    place, rate = motion.displacement(time), motion.velocity(time)
    assert motion.displacement(1e3) == found[DISPLACEMENT]
    assert motion.velocity(1e3) == 0.0
    assert abs(motion.velocity(found[AT])) == pytest.approx(found[VELOCITY], rel=1e-12)
    assert np.abs(place).max() == pytest.approx(found[PEAK], rel=1e-6)
    assert np.abs(rate).max() == pytest.approx(found[VELOCITY], rel=1e-6)
    assert (rate != 0.0).mean() * found[LAST] == pytest.approx(found[SLIDING], rel=2e-3)
    moved = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(time) * (rate[1:] + rate[:-1]))])
    assert np.abs(moved - place).max() < 1e-6 * found[PEAK]


# ---- the engine, and a motion with its answers ----------------------------------------------------------------------------------


def test_a_motion_has_its_two_displacements():
    """Integrated once with 40 digits; the two polarities differ."""
    motion = made_motion()
    for polarity, moved in ((1, PLUS), (-1, MINUS)):
        found = answer(-polarity * motion.acceleration, motion.interval, 0.980665)
        assert found[DISPLACEMENT] == pytest.approx(moved, rel=1e-13)


def test_it_agrees_with_the_engine():
    """A block on a spring that is too loose to be felt, as scenario sliding-block-shaken, at yields around its own."""
    problem = ss.load_scenario("sliding-block-shaken").problem
    body, ground = replace(problem.body, stiffness=1e-9 * problem.body.stiffness), problem.ground_acceleration
    load = -np.array(ground.values)
    interval = float(ground.times[-1]) / (len(load) - 1)
    off = []
    for strength in (0.05, 0.1, 0.17, 0.25):
        law = ss.friction.Coulomb(*[(strength * 9.80665 * body.mass + problem.load) / problem.normal] * 2)
        run = ss.simulate(replace(problem, body=body, friction=law), 30.0, rtol=1e-12)
        found = answer(load, interval, strength * 9.80665)
        off.append(abs(float(run.slip(30.0)) / found[DISPLACEMENT] - 1.0))
    assert np.median(off) < 1e-9
    assert max(off) < 1e-8


def test_uncompiled_it_does_the_same(monkeypatch: pytest.MonkeyPatch):
    """The plain function, without machine code, on a record with slips in both directions."""
    load = random_load(np.random.default_rng(5), 300)
    compiled = answer(load, 0.01, 0.3, 0.4)
    for name in (
        "slide_blocks",
        "slide_once",
        "slide_through",
        "next_above",
        "come_to_rest",
        "keep",
        "note",
        "onset",
        "stop_after",
    ):
        monkeypatch.setattr(rigid_block, name, getattr(getattr(rigid_block, name), "__wrapped__", getattr(rigid_block, name)))
    monkeypatch.setattr("stickslip.extensions.strong_motion.sliding_block.slide_blocks", rigid_block.slide_blocks)
    assert answer(load, 0.01, 0.3, 0.4)[:8] == pytest.approx(compiled[:8], rel=1e-10)
