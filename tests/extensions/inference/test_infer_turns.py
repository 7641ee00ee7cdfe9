"""Steps of the drive and of the normal load between two samples: what is fitted there, and how sure the numbers then are."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.certainty.bends import rough_words
from stickslip.extensions.inference.certainty.unresolved import unresolved
from stickslip.extensions.inference.fit.asides import moved
from stickslip.extensions.inference.fit.at_drive import MANY_RATES
from stickslip.extensions.inference.fit.free import read_free
from stickslip.extensions.inference.fit.loosened import loosened
from stickslip.extensions.inference.fit.memory import Memory
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part, first_sizes
from stickslip.extensions.inference.fit.setup import parts_of
from stickslip.extensions.inference.fit.turns import changes_of, felt, moving
from stickslip.extensions.inference.record.corners import Corners, corners_of, jumps_of
from stickslip.extensions.inference.record.loading import loading_of
from stickslip.extensions.inference.record.record import Record
from stickslip.extensions.inference.record.resample import Jumps
from stickslip.extensions.inference.report import _left
from stickslip.problem.loading import PiecewiseLinear, Steps
from tests.extensions.inference import thinned_double_shear as double_shear

BODY = ss.SpringBlock(20.0, 1.5e8, 5e4)
LAW = ss.friction.RateAndState(0.62, 0.009, 0.0125, 15e-6)
STEPS = Steps([0.0, 40.03, 80.07], [1e-5, 3e-5, 1e-5])


def test_what_a_step_of_the_drive_does_is_at_a_known_time_and_is_not_spread_over_samples() -> None:
    """Friction after a step is steep between samples 0.2 s apart; as a jump that may move it was spread, by up to 0.003."""
    clock = np.arange(0.0, 120.0, 0.2)
    problem = ss.Problem(BODY, LAW, pull_rate=STEPS)
    record = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock)})
    model = Model(problem, (Part(record, STEPS, ("friction",), start="steady"),), (), sizes={"friction": 3e-4})
    run: Any = model.solve(np.zeros(0), 0)
    assert model.curves(run, np.zeros(0), 0)["friction"] == pytest.approx(run.traction(clock) / 5e4, abs=1e-12)
    assert not model.with_jumps(np.zeros(0)).unsure


def test_changes_of_loading_are_felt_when_they_come_to_the_contact() -> None:
    pressed = PiecewiseLinear([0.0, 10.0, 10.1, 20.0, 25.0], [5e4, 5e4, 6e4, 6e4, 6.01e4])
    problem = ss.Problem(BODY, LAW, pull_rate=STEPS, normal_load=pressed)
    assert felt(problem, 70.0, 0.1) == pytest.approx([10.0, 40.03])
    slab = ss.Problem(ss.ElasticSlab(2700.0, 3000.0, 30.0, 5e6), ss.friction.Coulomb(0.6, 0.5), pull_rate=STEPS, initial_load=1e6)
    assert felt(slab, 120.0, 0.1) == pytest.approx([40.04, 80.08])
    layers = replace(slab, body=ss.LayeredSlab([30.0, 60.0], [2700.0, 2900.0], [3000.0, 3000.0], 5e6))
    assert felt(layers, 120.0, 0.1) == pytest.approx([40.06, 80.1])  # after the way through all layers
    assert changes_of(STEPS, 70.0) == pytest.approx([40.03])


def test_only_jumps_soon_after_a_change_of_loading_belong_to_it() -> None:
    jumps = Jumps(np.array([3.9, 4.0, 4.3, 4.5, 9.0]), np.arange(5.0))
    kept = moving(jumps, np.array([4.0]), 0.1)
    assert kept.time.tolist() == [3.9, 4.5, 9.0]
    assert kept.height.tolist() == [0.0, 3.0, 4.0]


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize(("every", "within"), [(2, 0.004), (5, 0.008), (10, 0.008), (20, 0.012), (30, 0.02)])
def test_the_load_point_shows_the_servo_that_rounds_its_corners_also_between_two_samples(every: int, within: float) -> None:
    made = Record.read(double_shear.record(every, 1, every))
    rate: Any = loading_of(made)
    found = corners_of(made, rate.rate)
    assert found is not None
    assert found.seen
    assert found.servo == pytest.approx(double_shear.SERVO, abs=within)
    assert abs(found.servo - double_shear.SERVO) < 4.0 * found.spread
    assert len(found.unsure) == 5
    meets = np.array(double_shear.TIMES[1:]) + double_shear.SERVO - made.time[0]
    assert found.rate.times[1:] == pytest.approx(meets, abs=0.01)


def test_a_sharp_load_point_has_no_servo_and_rates_that_are_sampled_step_anywhere_between_two_samples() -> None:
    clock = np.arange(0.0, 120.0, 0.2)
    moved = 1e-5 * clock + 2e-5 * (np.maximum(clock - 40.03, 0.0) - np.maximum(clock - 80.07, 0.0))
    made = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock), "load point (m)": moved})
    found = corners_of(made, STEPS)
    assert found is not None
    assert not found.seen
    assert found.servo + 2.0 * found.spread < 0.05
    rates = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock), "load rate (m/s)": np.array(STEPS.at(clock))})
    sampled: Any = loading_of(rates)
    unsure: Any = corners_of(rates, sampled.rate)
    assert unsure.unsure == pytest.approx((0.1, 0.1))


def test_a_load_point_that_moves_as_no_servo_does_is_followed_as_it_is() -> None:
    clock = np.arange(0.0, 120.0, 0.02)
    ramp = PiecewiseLinear([0.0, 40.0, 41.0], [1e-5, 1e-5, 3e-5])
    fine = np.arange(0.0, 120.0, 0.001)
    moved = np.interp(clock, fine, np.append(0.0, np.cumsum(0.001 * np.array(ramp.at(0.5 * (fine[1:] + fine[:-1]))))))
    made = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock), "load point (m)": moved + 1e-9 * np.cos(37.0 * clock)})
    rate: Any = loading_of(made)
    assert corners_of(made, rate.rate) is None


def test_a_step_there_and_back_is_kept_however_short_it_is_beside_the_rest() -> None:
    """Ten seconds at a hundred times the rate, between hundreds of seconds at one rate: two corners, where they were made."""
    time = np.arange(0.0, 700.0, 0.25)
    moved = 1e-6 * time + 99e-6 * np.clip(time - 500.0, 0.0, 10.0)
    made = ss.studies.Record.read({"time (s)": time, "load point (m)": moved, "friction": np.full(len(time), 0.6)})
    found = corners_of(made, ss.loading.Steps((0.0, 500.0, 510.0), (1e-6, 1e-4, 1e-6)))
    assert found is not None
    np.testing.assert_allclose(found.rate.times[1:], (500.0, 510.0), atol=1e-6)
    np.testing.assert_allclose(found.rate.values, (1e-6, 1e-4, 1e-6), rtol=1e-9)


def test_what_is_too_short_to_be_seen_between_parts_of_one_rate_is_no_corner() -> None:
    time = np.arange(0.0, 700.0, 0.25)
    moved = 1e-6 * time + 99e-6 * np.clip(time - 500.0, 0.0, 0.5)
    made = ss.studies.Record.read({"time (s)": time, "load point (m)": moved, "friction": np.full(len(time), 0.6)})
    assert corners_of(made, ss.loading.Steps((0.0, 500.0, 500.5), (1e-6, 1e-4, 1e-6))) is None


def test_a_servo_leaves_the_lines_through_the_load_point_where_they_are_unless_the_machine_was_told_them() -> None:
    corners = Corners(STEPS, (0.01, 0.01), 0.0, 0.05, seen=False, keeps=False)
    clock = np.arange(0.0, 120.0, 0.2)
    part = Part(Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock)}), STEPS, ("friction",), corners=corners)
    time = np.linspace(0.0, 60.0, 600_001)

    def place(**options: bool) -> float:
        rate: Any = moved(part, {"record.servo": 0.1}, **options).loading
        return float(np.trapezoid(rate.at(time), time) - np.trapezoid(STEPS.at(time), time))

    assert place() == pytest.approx(0.0, abs=5e-9)
    assert place(asked=True) == pytest.approx(-2e-5 * 0.1, rel=1e-3)
    later: Any = moved(part, {"record.step_2": 0.3}).loading
    assert later.times == pytest.approx((0.0, 40.03, 80.37))


def test_a_normal_load_jumps_where_it_is_said_to_between_two_samples() -> None:
    pressing = PiecewiseLinear([0.0, 10.0, 10.5, 20.0], [5e4, 5e4, 6e4, 6e4])
    clock = np.arange(0.0, 30.0, 0.5)
    made = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock)})
    assert jumps_of(pressing, clock) == (1,)
    assert jumps_of(PiecewiseLinear([0.0, 10.0, 12.0], [5e4, 5e4, 6e4]), clock) == ()
    part = Part(made, None, ("friction",), pressing=pressing, jumps=(1,))
    found: Any = moved(part, {"record.jump_1": -0.15, "record.ramp": 0.1}).pressing
    assert found.at([10.0, 10.049, 10.1, 10.151, 10.5, 20.0]) == pytest.approx([5e4, 5e4, 5.5e4, 6e4, 6e4, 6e4], rel=1e-9)


FREE = ["a", "b", "distance", "stiffness", "reference", "record.trend"]


@pytest.mark.slow
def test_steps_between_two_samples_are_said_and_the_numbers_are_those_of_the_truth() -> None:
    study = ss.studies.infer(double_shear.GUESS, double_shear.record(10, 3, 1), FREE, starts=1)
    for name, row in study.table.iterrows():
        assert abs(row.value - double_shear.TRUTH[str(name)]) < 3.0 * row.uncertainty, name
    assert list(study.values) == [f"friction.{name}" for name in FREE[:3]] + [
        "body.stiffness",
        "friction.reference",
        "record.trend",
    ]
    assert any(note.startswith("5 steps of the drive happen between two samples, 100 ms apart") for note in study.notes)
    assert sum("smoothly" in note for note in study.notes) <= 1
    assert any(note.startswith("the load point shows a servo") for note in study.notes)


@pytest.mark.slow
@pytest.mark.parametrize("free", [FREE, [*FREE, "record.servo"]], ids=["servo not asked for", "servo free"])
def test_intervals_of_thinned_records_hold_the_truth_as_often_as_they_say(free: list[str]) -> None:
    """Of 40 records thinned 2 to 30 fold 36 hold: 95 % of 40 are 38 +- 1.4."""
    held = dict.fromkeys(double_shear.TRUTH, 0)
    for seed in range(40):
        random = np.random.default_rng(1000 + seed)
        every = int(random.integers(2, 31))
        found = ss.studies.infer(double_shear.GUESS, double_shear.record(every, int(random.integers(every)), seed), free, starts=1)
        for name in found.values:
            held[name] += found.table.low[name] <= double_shear.TRUTH[name] <= found.table.high[name]
    assert min(count for name, count in held.items() if name in found.values) >= 36, held


def test_one_sentence_says_with_which_numbers_a_run_bends_and_what_passes_a_sample_there() -> None:
    clock = np.arange(0.0, 120.0, 0.2)
    problem = ss.Problem(BODY, LAW, pull_rate=STEPS)
    record = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock)})
    model = Model(problem, (Part(record, STEPS, ("friction",), start="steady"),), (), sizes={"friction": 3e-4})
    said = rough_words(model, np.zeros(0), ["friction.a", "friction.b", "body.mass"], np.abs(clock - 40.03) < 0.5)
    assert len(said) == 1
    assert said[0].startswith(
        "the run does not change smoothly with friction.a, friction.b and body.mass, as where a step of the drive"
    )
    elsewhere = rough_words(model, np.zeros(0), ["friction.a"], np.abs(clock - 20.0) < 0.3)
    assert elsewhere == [
        "the run does not change smoothly with friction.a near 19.8 s; such samples are left out of its interval, which is rough: "
        "a profile tells more"
    ]
    assert rough_words(model, np.zeros(0), [], np.zeros(600, bool)) == []


@pytest.mark.parametrize(("memory", "left"), [(0.0, "looks like noise"), (1.5, "remembers itself for 1.5 s")])
def test_what_is_left_is_called_noise_only_if_it_forgets_itself(memory: float, left: str) -> None:
    study: Any = SimpleNamespace(features=None, model=SimpleNamespace(memory={"friction": Memory(memory, 1.0, 0.1)}))
    assert _left(study) == f"what is left {left}"


def test_a_load_point_that_a_servo_rounds_often_is_no_slip() -> None:
    """Followed by straight lines, each of 12 steps has some on its way from one rate to the next: more than 40 in all."""
    clock, servo = np.arange(0.0, 260.0, 0.01), 0.08
    moved = 1e-5 * clock
    for k in range(12):
        since = np.maximum(clock - 20.0 * (k + 1), 0.0)
        moved = moved + (-1.0) ** k * 2e-5 * (since + servo * np.expm1(-since / servo))
    moved = moved + 1e-8 * np.random.default_rng(1).standard_normal(len(clock))
    made = Record.read({"time (s)": clock, "mu": 0.6 + 1e-3 * np.sin(clock), "load point (m)": moved})
    lines: Any = loading_of(made)
    assert len(lines.rate.segments) > MANY_RATES
    (part,), notes = parts_of(ss.Problem(BODY, LAW, pull_rate=1e-5), [made], None, None, "contact")
    assert part.corners is not None
    assert any("shows a servo" in one for one in notes)
    assert not any("as slip does" in one for one in notes)


@pytest.mark.parametrize(("every", "said"), [(3, False), (6, True), (14, True), (20, True), (28, True)])
def test_steps_are_said_to_be_unresolved_however_far_apart_the_samples_are(every: int, said: bool) -> None:
    """A servo of 80 ms is resolved by samples 30 ms apart; far from it they show it, but not how it turns."""
    parts, _ = parts_of(double_shear.GUESS, [Record.read(double_shear.record(every, every // 2, 1))], None, None, "contact")
    free = read_free(double_shear.GUESS, FREE, {})
    model = Model(double_shear.GUESS, tuple(parts), free, sizes=first_sizes(parts))
    truth = np.array([one.searched(double_shear.TRUTH[one.name]) for one in free])
    told = unresolved(model, truth)
    assert len(told) == said
    assert all(one.startswith("5 steps of the drive happen between two samples") for one in told)


def loose_models() -> tuple[Model, Model]:
    """Return a model of two thinned records, and the same one in which the servo of the drive of both is free."""
    records = [Record.read(double_shear.record(20, 3, seed), 0.0, 50.0) for seed in (1, 2)]
    parts, _ = parts_of(double_shear.GUESS, records, None, None, "contact")
    free = read_free(double_shear.GUESS, ["a"], {})
    model = Model(double_shear.GUESS, tuple(parts), free, sizes=first_sizes(parts))
    return model, loosened(model, model.begin).model


def test_steps_of_each_record_are_free_also_where_those_of_another_one_are() -> None:
    model, loose = loose_models()
    one, *asides = loose.free
    assert {each.part for each in asides} == {0, 1}
    first = model.with_(free=(one, *(each for each in asides if each.part == 0)))
    again = loosened(first, first.begin).model.free
    assert {each.label for each in again} == {each.label for each in loose.free}
    servo = model.with_(free=(one, *read_free(double_shear.GUESS, ["record.servo"], {})))
    assert not any(each.aside and each.name == "record.servo" for each in loosened(servo, servo.begin).model.free)


@pytest.mark.slow
def test_a_search_that_goes_on_from_free_steps_has_each_of_them_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Many parts are searched in two turns, and a fit without derivatives goes on from the steps found."""
    infer, estimate = (import_module(f"stickslip.extensions.inference.{name}") for name in ("infer", "fit.estimate"))
    monkeypatch.setattr(infer, "MOST_SEARCHED", 1)
    monkeypatch.setattr(import_module("stickslip.extensions.inference.fit.search"), "SCREENED", 1)
    polished = list[int]()
    for name, value in {"ROUGH": 0.0, "COMPETES": -1e9, "is_rough": lambda *_: True, "told_by": lambda *_: ""}.items():
        monkeypatch.setattr(estimate, name, value)
    monkeypatch.setattr(estimate, "polished", lambda model, x, loss: polished.append(len(x)) or x)
    model, loose = loose_models()
    for begun, starts in ((model, 2), (loose, 1)):
        wishes: Any = SimpleNamespace(starts=starts, loss="linear", seed=0)
        found = infer._estimated(begun, wishes, lambda text: None)
        labels = [one.label for one in found.model.free]
        assert sorted(labels) == sorted({one.label for one in loose.free})
        assert len(found.searched) == len(labels)
    assert polished
