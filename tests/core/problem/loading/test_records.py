"""Records of accelerometers: samples as a history, even times behind rounded ones, files of scenarios, and what `check` says."""

from __future__ import annotations

import tracemalloc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import Given
from stickslip.foundation.quantities import MOST_SAMPLES
from stickslip.problem.accelerogram import Accelerogram
from stickslip.problem.even_times import interval_of
from stickslip.problem.loading import PiecewiseLinear, Steps
from stickslip.problem.scenarios.packed import packed, unpacked
from stickslip.problem.scenarios.scenario import Scenario, read_scenario
from stickslip.run.check.asked import Fact
from stickslip.run.check.examine import examine
from tests.command_line import Command

BLOCK = ss.SpringBlock(mass=1.0, stiffness=1e-9, normal_force=GRAVITY)
DRY = ss.friction.Coulomb(static=0.1, dynamic=0.1)


def problem_of(record: object, **others: object) -> ss.Problem:
    return ss.Problem(BLOCK, DRY, initial_load=0.0, ground_acceleration=record, one_way=True, **others)  # type: ignore[arg-type]


def fact(problem: ss.Problem, name: str) -> Fact:
    return next(one for one in examine(Scenario(problem, 5.0)).derived if one.name == name)


def test_between_samples_it_is_straight_and_after_the_last_it_is_zero() -> None:
    record = Accelerogram([1.0, 3.0, -2.0], 0.5)
    assert record.at([0.0, 0.25, 0.5, 0.75, 0.999]).tolist() == pytest.approx([1.0, 2.0, 3.0, 0.5, -1.99], rel=1e-14)
    assert record.at([1.0, 5.0]).tolist() == [0.0, 0.0]
    assert record.duration == 1.0
    assert [one.start for one in record.segments] == [0.0, 0.5, 1.0]


@pytest.mark.parametrize("seed", range(5))
def test_a_record_is_the_piecewise_linear_history_that_falls_to_zero_at_its_end(seed: int) -> None:
    drawn = np.random.default_rng(seed)
    values, interval = drawn.normal(size=40), float(drawn.uniform(0.01, 0.1))
    own = Accelerogram(values, interval, scale=2.0, polarity=-1, offset=0.25)
    by_hand = PiecewiseLinear(interval * np.arange(40), -2.0 * (values - 0.25))
    until = np.linspace(0.0, 39 * interval * (1 - 1e-12), 200)
    assert own.at(until) == pytest.approx(by_hand.at(until), rel=1e-12, abs=1e-13)
    runs = [ss.simulate(problem_of(one), 39 * interval) for one in (own, by_hand)]
    assert runs[0].slip(39 * interval) == pytest.approx(float(runs[1].slip(39 * interval)), rel=1e-12)


def test_what_is_after_the_record_keeps_the_velocity_of_the_ground() -> None:
    problem = problem_of(Accelerogram([2.0, 2.0, 2.0], 0.5))
    assert problem.ground is not None
    assert problem.ground.velocity_at([1.0, 7.0]).tolist() == [2.0, 2.0]
    assert problem.ground.displacement_at(7.0) == pytest.approx(13.0, rel=1e-14)


def test_polarity_turns_a_record_round_and_a_factor_below_zero_does_too() -> None:
    record = Accelerogram([1.0, 2.0], 0.1)
    assert record.scaled(-3.0).samples.tolist() == replace(record, polarity=-1, scale=3.0).samples.tolist() == [-3.0, -6.0]


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"polarity": 2}, "Accelerogram: polarity must be 1 or -1, got 2"),
        ({"polarity": 0.5}, "Accelerogram: polarity must be a whole number up to 16, got 0.5"),
        ({"scale": 0.0}, "Accelerogram: scale must be greater than 0 (a pure number), got 0"),
        ({"interval": 0.0}, "Accelerogram: interval must be greater than 0 s, got 0"),
        ({"values": [1.0]}, f"Accelerogram: values must have 2 to {MOST_SAMPLES} numbers, got 1"),
        ({"values": [1.0, float("nan")]}, "Accelerogram: values[1] must be finite, got nan"),
        ({"values": np.array([0.0, np.inf])}, "Accelerogram: values[1] must be finite, got inf"),
    ],
)
def test_what_no_record_can_be_is_refused_in_one_line(fields: dict[str, object], message: str) -> None:
    with pytest.raises(InputError) as refused:
        Accelerogram(**{"values": [0.0, 1.0], "interval": 0.01} | fields)  # type: ignore[arg-type]
    assert str(refused.value) == message


def test_a_record_is_refused_as_a_pull_rate() -> None:
    with pytest.raises(InputError, match=r"pull_rate must be in m/s, got a history of values in m/s\^2"):
        ss.Problem(BLOCK, DRY, initial_load=0.0, pull_rate=Accelerogram([0.0, 1.0], 0.1))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    "make", [lambda t, a: PiecewiseLinear(t, a), lambda t, a: Steps(t, a), lambda t, a: Accelerogram(a, 0.005)]
)
def test_samples_of_a_problem_take_the_memory_that_is_stated(make: object) -> None:
    count = 100_000
    times, values = 0.005 * np.arange(count), np.sin(0.1 * np.arange(count))
    tracemalloc.start()
    problem = problem_of(make(times, values))  # type: ignore[operator]
    held, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert problem.ground is not None
    kept = 2 if make(times[:3], values[:3]).kind != "accelerogram" else 1  # type: ignore[operator]
    ground = 5 * 8
    assert held < 1.1 * count * (kept * 32 + 24 + ground + 16)


def test_a_million_samples_make_a_problem() -> None:
    values = np.sin(0.1 * np.arange(MOST_SAMPLES))
    assert problem_of(Accelerogram(values, 0.005)).ground_acceleration.at(0.005) == values[1]  # type: ignore[union-attr]


@pytest.mark.parametrize("kind", ["given", "list", "array", "whole numbers", "texts"])
def test_numbers_are_checked_alike_at_once_and_one_by_one(kind: str) -> None:
    forms = {
        "given": [1.0, Given(2.0, 0.2039, "g")],
        "list": [1.0, 2.0],
        "array": np.array([1.0, 2.0], np.float32),
        "whole numbers": np.array([1, 2], np.uint8),
        "texts": ["1 m/s^2", "2 m/s^2"],
    }
    assert Accelerogram(forms[kind], 0.1).samples.tolist() == [1.0, 2.0]  # type: ignore[arg-type]


def test_unsigned_times_that_fall_are_seen_to_fall() -> None:
    with pytest.raises(InputError, match=r"times must ascend, but \[2\] = 1 follows 2"):
        PiecewiseLinear(np.array([0, 2, 1], np.uint8), [0.0, 1.0, 2.0])


@pytest.mark.parametrize("seed", range(8))
def test_even_times_are_found_behind_rounded_ones(seed: int) -> None:
    drawn = np.random.default_rng(seed)
    interval = float(drawn.choice([0.005, 0.01, 0.02, 0.0025, 1 / 256, 1 / 60, 0.024, 1 / 3]))
    decimals, count = int(drawn.integers(2, 6)), int(drawn.integers(400, 4000))
    begins = float(drawn.choice([0.0, 12.34, 3.0]))
    times = np.round(begins + interval * np.arange(count), decimals)
    assert interval_of(times) == interval
    if decimals <= 4:  # single precision holds these
        assert interval_of(times.astype(np.float32).astype(float)) == interval


def test_eight_hundred_rows_in_four_seconds_are_two_hundred_a_second() -> None:
    assert interval_of(np.round(0.005 * np.arange(800), 2)) == 0.005


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda t: np.delete(t, slice(50, 53)), "from 0.49 to 0.53 s it is 0.04 s: fill this gap of 3 samples, or give"),
        (lambda t: np.append(t[:50], t[50:] * 1.3 - 0.3 * t[50]), "it is 0.013 s: resample the record evenly, or give"),
        (lambda t: np.append(t[:50], t[50:] - 0.2), "it is -0.19 s: sort the rows"),
    ],
)
def test_times_that_are_not_even_are_refused_with_the_place(change: object, said: str) -> None:
    times = np.round(0.01 * np.arange(100), 2)
    with pytest.raises(InputError) as refused:
        interval_of(change(times))  # type: ignore[operator]
    assert said in str(refused.value)


@pytest.mark.parametrize("seed", range(3))
def test_packed_numbers_come_back_to_the_last_bit(seed: int) -> None:
    numbers = np.random.default_rng(seed).normal(size=777).tolist()
    assert unpacked(packed(numbers), "m/s^2", 1000) == numbers
    given = [Given(9.80665, 1.0, "g"), *numbers]
    again = unpacked(packed(given), "m/s^2", 1000)
    assert again == given
    assert isinstance(again[0], Given)
    assert again[0].unit == "g"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: "12 apples", "a text that is not one of packed numbers"),
        (lambda text: text.replace("100 numbers", "101 numbers"), "packed numbers that are damaged: they are not 101"),
        (lambda text: text.replace("100 numbers", "99 numbers"), "packed numbers that are damaged: they are not 99"),
        (lambda text: text.replace("100 numbers", "1001 numbers"), "1001 packed numbers, where 1000 are allowed"),
        (lambda text: f"{text[:-20]}{'A' * 16}{text[-4:]}", "packed numbers that are damaged"),
    ],
)
def test_a_text_that_holds_no_packed_numbers_is_refused(change: object, said: str) -> None:
    text = packed(np.random.default_rng(1).normal(size=100).tolist())
    with pytest.raises(InputError) as refused:
        unpacked(change(text), "m/s^2", 1000)  # type: ignore[operator]
    assert str(refused.value) == said


SCENARIO = """
[body]
kind = "spring-block"
mass = 1
stiffness = 1e-9
normal_force = 9.80665
[friction]
kind = "coulomb"
static = 0.1
dynamic = 0.1
[loading]
one_way = true
[loading.ground_acceleration]
{0}
[initial]
load = 0
[run]
duration = 5
"""
ROWS = "time (s),acceleration (g)\n0.00,0\n0.01,0.3\n0.02,-0.3\n0.03,0.1\n"


def scenario_in(folder: Path, table: str, rows: str = ROWS) -> Scenario:
    (folder / "made.csv").write_text(rows)
    (folder / "made.toml").write_text(SCENARIO.format(table))
    return ss.load_scenario(folder / "made.toml")


def test_a_scenario_names_a_file_and_needs_no_kind(tmp_path: Path) -> None:
    found = scenario_in(tmp_path, 'file = "made.csv"\npolarity = -1\nscale = 2')
    record = found.problem.ground_acceleration
    assert isinstance(record, Accelerogram)
    assert record.samples.tolist() == pytest.approx([0.0, -0.6 * GRAVITY, 0.6 * GRAVITY, -0.2 * GRAVITY], rel=1e-15)
    assert record.origin.startswith("made.csv, sha256 ")
    assert record.origin.endswith(": 4 samples every 10 ms, 0.3 g at most")


def test_a_scenario_holds_its_record_and_gives_it_back_to_the_last_bit(tmp_path: Path) -> None:
    found = scenario_in(tmp_path, 'file = "made.csv"')
    text = found.to_toml()
    assert "4 numbers given in g, float64, zlib, base64: " in text
    again = read_scenario(text, "again")
    assert again == found
    run = ss.simulate(found)
    run.to_netcdf(tmp_path / "run.nc")
    stored = ss.open_solution(tmp_path / "run.nc")
    assert stored.problem == found.problem
    assert stored.slip(5.0) == run.slip(5.0)


def test_a_long_history_is_packed_and_a_short_one_a_list() -> None:
    times = 0.01 * np.arange(20_000)
    for count, is_packed in ((100, False), (20_000, True)):
        problem = problem_of(PiecewiseLinear(times[:count], np.sin(times[:count])))
        text = Scenario(problem, 1.0).to_toml()
        assert ("base64" in text) == is_packed
        assert read_scenario(text, "again").problem == problem


def test_the_mean_is_taken_off_on_request_only(tmp_path: Path) -> None:
    rows = ROWS.replace("0.3\n", "0.4\n")
    plain = scenario_in(tmp_path, 'file = "made.csv"', rows).problem.ground_acceleration
    level = scenario_in(tmp_path, 'file = "made.csv"\nbaseline = "mean"', rows).problem.ground_acceleration
    assert isinstance(plain, Accelerogram)
    assert isinstance(level, Accelerogram)
    assert plain.offset == 0.0
    assert level.samples.mean() == pytest.approx(0.0, abs=1e-15)
    assert level.offset == pytest.approx(plain.samples.mean(), rel=1e-15)


@pytest.mark.parametrize(
    ("table", "rows", "said"),
    [
        ('file = "gone.csv"', ROWS, "'gone.csv': no such file beside the scenario"),
        ('file = "made.csv"\nbaseline = "line"', ROWS, "baseline must be \"mean\", or left out, got 'line'"),
        ('file = "made.csv"\nchecksum = "sha256:0123456789abcdef"', ROWS, "is another file than that of the checksum"),
        ('file = "made.csv"\nchecksum = "no"', ROWS, 'checksum must be text as "sha256:'),
        ('file = "made.csv"\nvalues = [1.0, 2.0]', ROWS, "and values exclude each other"),
        ('file = "made.csv"\ninterval = 1', ROWS, "and interval exclude each other"),
        (
            'file = "made.csv"',
            ROWS.replace("0.03", "0.05"),
            "the interval varies: it is 0.01 s, but from 0.02 to 0.05 s it is 0.03 s",
        ),
        ('file = "made.csv"', ROWS.replace("0.3\n", "nan\n"), "line 3: ground_acceleration must be finite"),
        ('file = "made.csv"', ROWS.replace("acceleration", "velocity"), "'ground_acceleration'; a velocity is not differentiated"),
        ('fil = "made.csv"', ROWS, "'fil' is unknown; did you mean 'file'?"),
        ('file = "made.csv"', ROWS.partition("\n")[0], "a record needs at least two samples, got 0"),
        ("file = 3", ROWS, "file must be text in quotes, got 3"),
    ],
)
def test_a_file_that_is_no_record_is_refused_in_one_line(tmp_path: Path, table: str, rows: str, said: str) -> None:
    with pytest.raises(InputError) as refused:
        scenario_in(tmp_path, table, rows)
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


def test_the_checksum_of_the_file_is_accepted(tmp_path: Path) -> None:
    record = scenario_in(tmp_path, 'file = "made.csv"').problem.ground_acceleration
    assert isinstance(record, Accelerogram)
    own = record.origin.split()[2].rstrip(":")
    assert scenario_in(tmp_path, f'file = "made.csv"\nchecksum = "sha256:{own}"').problem.ground_acceleration == record


def test_times_that_begin_later_are_told_and_begin_the_run(tmp_path: Path) -> None:
    record = scenario_in(tmp_path, 'file = "made.csv"', ROWS.replace("0.0", "7.0")).problem.ground_acceleration
    assert isinstance(record, Accelerogram)
    assert record.origin.endswith("its first time, 7 s, is 0 s of the run")


def test_check_says_yield_peak_and_how_often_it_is_passed() -> None:
    """By hand: the block yields at 0.1 g, and the ground goes back by more than that in two of its three swings."""
    record = Accelerogram(GRAVITY * np.array([0.0, -0.3, 0.2, -0.05, 0.1, -0.2, 0.0]), 0.5)
    problem = problem_of(record)
    assert fact(problem, "yield").value == pytest.approx(0.1, rel=1e-14)
    assert fact(problem, "yield").meaning.endswith("passed 2 times")
    assert fact(problem, "PGA").value == pytest.approx(0.3, rel=1e-14)
    assert fact(problem, "last velocity").value == pytest.approx(-0.125 * GRAVITY, rel=1e-13)
    back = fact(replace(problem, one_way=False), "yield back")
    assert back.meaning.endswith("passed 1 time")


@pytest.mark.parametrize("body", ["slab", "layers", "damped column"])
def test_the_yield_of_a_column_is_that_of_its_whole_mass(body: str) -> None:
    mass = 2000.0 * 30.0
    of_kind = {
        "slab": ss.ElasticSlab(2000.0, 300.0, 30.0, mass * GRAVITY, driver_impedance=0.0),
        "damped column": ss.SoilColumn(2000.0, 300.0, 30.0, mass * GRAVITY, damping_ratio=0.1),
        "layers": ss.LayeredSlab([10.0, 20.0], [2000.0, 2000.0], [100.0, 200.0], mass * GRAVITY, driver_impedance=0.0),
    }
    problem = ss.Problem(of_kind[body], DRY, initial_load=0.0, ground_acceleration=Accelerogram([0.0, 1.0, 0.0], 0.1), one_way=True)
    assert fact(problem, "yield").value == pytest.approx(0.1, rel=1e-9)


def test_a_run_that_ends_before_its_record_is_warned_of() -> None:
    problem = problem_of(Accelerogram(np.sin(0.1 * np.arange(1000)), 0.01))
    for duration, warned in ((5.0, True), (12.0, False)):
        found = examine(Scenario(problem, duration)).warnings
        assert any("the record lasts 9.99 s, and the run 5 s" in one for one in found) == warned


def test_set_puts_a_record_under_a_scenario(tmp_path: Path, command: Command) -> None:
    (tmp_path / "made.csv").write_text(ROWS)
    changes = ("--set", f"loading.ground_acceleration={tmp_path / 'made.csv'}", "--set", "loading.ground_acceleration.scale=2")
    shown = command("check", "sliding-block-shaken", *changes)
    assert shown.code == 0
    assert "4 points" in shown.out
    assert "shaken ground: made.csv" in shown.out
    refused = command("check", "sliding-block-shaken", "--set", "loading.ground_acceleration=3").refusal
    assert "loading.ground_acceleration must be the file of a record, got 3" in refused


def test_an_offset_of_an_instrument_is_suspected_and_a_record_at_rest_is_not() -> None:
    time = 0.01 * np.arange(3001)
    swing = np.sin(2.0 * np.pi * time)
    for offset, suspected in ((0.0, False), (-0.05, True)):
        found = examine(Scenario(problem_of(Accelerogram(swing + offset, 0.01)), 40.0)).warnings
        assert any("the instrument's" in one for one in found) == suspected
        if suspected:
            assert "the ground ends at -1.5 m/s" in found[-1] or "-1.5 m/s" in "".join(found)


def test_no_sample_of_a_record_has_a_name_but_its_scale_has() -> None:
    problem = problem_of(Accelerogram([0.0, 1.0, 0.0], 0.1))
    names = [name for name in problem.parameters if "ground" in name]
    assert names == [f"loading.ground_acceleration.{one}" for one in ("interval", "scale", "polarity", "offset")]
    assert Scenario(problem, 1.0).with_values({"loading.ground_acceleration.scale": 3.0}).problem.ground_acceleration.scale == 3.0  # type: ignore[union-attr]
