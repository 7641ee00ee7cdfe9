"""Where a search begins: with what a record shows, beside the values given."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.inference import Inference
from tests.extensions.inference.laboratory import CoulombBlock, correlated
from tests.extensions.inference.velocity_steps import GUESS, TRUE, record

BLOCK = CoulombBlock()


def stick_slip(events: float = 5.0, noise: float = 2e-3, step: float = 2e-4, seed: int = 0) -> dict[str, Any]:
    """Friction of a Coulomb block (static 0.65, dynamic 0.5) at the load cell, with white noise."""
    time = np.arange(0.0, 0.077 * events, step)
    force, _ = BLOCK.sampled(time, 345.0)
    friction = force / BLOCK.normal + noise * correlated(len(time), 0.0, seed)
    return {"time (s)": time, "mu": friction, "load point (mm)": 1e3 * BLOCK.pull * time}


def guess(static: float = 0.7, dynamic: float = 0.4, stiffness: float = 4e6, mass: float = 2.0) -> ss.Problem:
    return ss.Problem(
        ss.SpringBlock(mass, stiffness, 1e3), ss.friction.Coulomb(static, dynamic), pull_rate=1e-3, initial_load=345.0
    )


def begun(problem: ss.Problem, data: Any, free: list[str], **options: Any) -> Inference:
    return ss.studies.infer(problem, data, free, **({"starts": 1, "sensor": "spring"} | options))


@pytest.mark.slow
def test_each_event_from_its_rest_is_found_from_numbers_with_which_nothing_slips() -> None:
    """With static friction 0.7 no part of the record reaches its strength: the given start tells a search nothing."""
    study = begun(guess(), stick_slip(), ["static", "dynamic"], parts="rests")
    for name, value in (("friction.static", 0.65), ("friction.dynamic", 0.5)):
        row = study.table.loc[name]
        assert row.low <= value <= row.high, (name, row.low, row.high)
        assert row.uncertainty < 1e-3
    assert study.table.start["friction.static"] == pytest.approx(0.65, abs=0.01)
    said = "the search begins with what the record shows: friction.static 0.65"
    assert any(one.startswith(said) and one.endswith("; also with the values given") for one in study.notes), study.notes


@pytest.mark.slow
def test_levels_slope_and_duration_of_events_are_where_a_search_begins() -> None:
    study = begun(guess(0.9, 0.3, 9e6, 7.0), stick_slip(12.0), ["static", "dynamic", "stiffness", "mass"], by="features")
    start = study.table.start
    assert start["friction.static"] == pytest.approx(BLOCK.static, rel=0.01)
    assert start["friction.dynamic"] == pytest.approx(BLOCK.dynamic, rel=0.01)
    assert start["body.stiffness"] == pytest.approx(BLOCK.stiffness, rel=0.05)
    assert start["body.mass"] == pytest.approx(BLOCK.mass, rel=0.2)


@pytest.mark.slow
def test_plateaus_and_transients_of_velocity_steps_are_where_a_search_begins() -> None:
    start = begun(GUESS, record(), ["reference", "a", "b", "distance"], sensor="contact").table.start
    assert start["friction.reference"] == pytest.approx(TRUE.reference, abs=1e-3)
    assert start["friction.a"] - start["friction.b"] == pytest.approx(TRUE.a - TRUE.b, abs=2e-4)
    assert start["friction.a"] == pytest.approx(TRUE.a, rel=0.5)  # the spring hides some of the direct effect
    assert start["friction.distance"] == pytest.approx(TRUE.distance, rel=0.7)


def test_a_start_that_the_user_chose_is_taken() -> None:
    study = begun(guess(), stick_slip(12.0), ["static", "dynamic"], by="features", begin_at={"static": 0.69})
    assert study.table.start["friction.static"] == 0.69
    assert study.table.start["friction.dynamic"] == pytest.approx(0.5, rel=0.01)


@pytest.mark.slow
def test_a_stiffness_that_the_record_contradicts_is_asked_about() -> None:
    question = "shear rises by 4"
    wrong, right = (begun(guess(stiffness=one), stick_slip(12.0), ["dynamic"], by="features").notes for one in (6e6, 4e6))
    assert any(question in one and one.endswith("should it be free?") for one in wrong)
    assert not any(question in one for one in right)


@pytest.mark.slow
def test_of_many_parts_some_are_fitted_and_a_note_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(import_module("stickslip.extensions.inference.infer"), "MOST_PARTS", 3)
    monkeypatch.setattr(import_module("stickslip.extensions.inference.infer"), "MOST_SEARCHED", 2)
    study = begun(guess(), stick_slip(6.0), ["static", "dynamic"], parts="rests")
    begins = [part.begins for part in study.parts]
    assert begins == pytest.approx([0.0, 0.16, 0.39], abs=0.02)
    assert "3 parts between rests, each with a run of its own, evenly spread among 6" in " ".join(study.notes)
    assert len(study.table) == 5  # two numbers, and the load at each of three starts
    for name, value in (("friction.static", 0.65), ("friction.dynamic", 0.5)):
        assert study.table.value[name] == pytest.approx(value, abs=3.0 * study.table.uncertainty[name])
