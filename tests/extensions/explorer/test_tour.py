"""Every number that the tour tells is calculated here, from runs of its own settings; and its texts have a form."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.explorer.model.setting import Setting
from stickslip.extensions.explorer.model.strip import strip_of
from stickslip.extensions.explorer.model.tour import TOUR, TourStep
from stickslip.solution.solution import Solution

NUMBER = re.compile(r"(?<![\w.])\d[\d.]*(?:e[+-]?\d+)?(?<!\.)")
Claims = dict[str, float]
"""The numbers of a step's texts as they are written, and what they must be, in the unit of the text."""


def only_event(solution: Solution) -> dict[str, float]:
    (row,) = solution.events.to_dict("records")
    return {str(name): float(value) for name, value in row.items()}


def fastest_between(run: Solution, start: float, end: float) -> float:
    """The time at which slip is fastest, to a 20 000th of the interval."""
    times = np.linspace(start, end, 20_001)
    return float(times[run.slip_rate(times).argmax()])


def two_systems(run: Solution) -> Claims:
    event = only_event(run)
    slab = only_event(ss.simulate("fig6-slab"))
    printed = ss.simulate("fig6-block-printed")
    assert len(printed.events) == 0
    assert float(run.problem.parameters["body.stiffness"].value) * 10 == printed.problem.parameters["body.stiffness"].value
    return {
        "3.511": event["peak_rate"],
        "2.226": event["end"],
        "2.061": event["slip"],
        "4.102": slab["peak_rate"],
        "5.714": slab["end"],
        "3.43e14": printed.problem.parameters["body.stiffness"].value,
    }


def law_of_slip(run: Solution) -> Claims:
    event, wavenumber = only_event(run), run.problem.parameters["friction.wavenumber"].value
    maximum = math.pi / (2 * wavenumber)
    assert run.problem.load == pytest.approx(1.5e8)
    return {
        "1": 100 * (run.problem.initial_slip - maximum),
        "10.2": event["peak_rate"],
        "1.568": event["peak_time"],
        "0.3142": maximum,
    }


def pulses(run: Solution) -> Claims:
    event, found = only_event(run), run.pulses()
    wavenumber = run.problem.parameters["friction.wavenumber"].value
    assert len(found) == event["pulses"] == 3
    assert wavenumber == 10 * Setting.bundled("fig5-slab-printed").scenario().problem.parameters["wavenumber"].value
    first, second, third = (
        fastest_between(run, start, start + length) for start, length in zip(found.start, found.duration, strict=True)
    )
    return {
        "0.1257": 2 * math.pi / wavenumber,
        "0.154": first,
        "2.257": second,
        "4.359": third,
        "5.714": event["end"],
        "0.376": event["slip"],
    }


def law_of_rate(run: Solution) -> Claims:
    assert ss.uniqueness(run.problem).regime == "regular"
    assert len(run.shocks) == 0
    times = np.linspace(0.0, run.duration, 2001)
    load = run.load(times)
    return {"0.1": run.problem.parameters["alpha"].value, "60": load[0] / 1e6, "85.5": load.max() / 1e6}


def folds(run: Solution) -> Claims:
    contact = ss.uniqueness(run.problem)
    (fold,) = contact.folds
    stuck, middle, fast = sorted(float(rate) for rate in contact.admissible(70e6))
    assert stuck == 0.0
    return {
        "1": run.problem.parameters["alpha"].value,
        "1.259": fold.rate,
        "64.47": fold.load / 1e6,
        "80": run.problem.strength / 1e6,
        "70": float(run.load(TOUR[4].cursor)) / 1e6,
        "0.377": middle,
        "2.704": fast,
    }


def jump(run: Solution) -> Claims:
    event, problem = only_event(run), run.problem
    value = {name: problem.parameters[name].value for name in ("static", "dynamic", "alpha", "normal_stress")}
    closed = value["normal_stress"] * (value["static"] - value["dynamic"]) / problem.body.impedance - 1 / value["alpha"]
    assert float(run.slip_rate(0.0)) == pytest.approx(closed, rel=1e-12)
    return {
        "80": problem.load / 1e6,
        "4.102": float(run.slip_rate(0.0)),
        "39.8": float(run.traction(0.0)) / 1e6,
        "5.714": event["end"],
        "23.44": event["slip"],
        "1": 1.0,  # of the formula
    }


def critical(run: Solution) -> Claims:
    problem = run.problem
    value = {name: problem.parameters[name].value for name in ("static", "dynamic", "alpha", "normal_stress")}
    closed = problem.body.impedance / (value["normal_stress"] * (value["static"] - value["dynamic"]))
    found = ss.uniqueness(problem).critical_value
    assert found == pytest.approx(closed, rel=1e-12)
    assert value["alpha"] - closed == pytest.approx(1e-6)
    return {"0.196": closed, "2.603e-05": float(run.slip_rate(0.0)), "0.1408": 1e3 * only_event(run)["peak_rate"]}


def hysteresis(run: Solution) -> Claims:
    up, down = run.shocks.to_dict("records")
    assert (up["cause"], down["cause"]) == ("fold", "fold")
    return {
        "80": up["traction_before"] / 1e6,
        "2.243": up["time"],
        "64.47": float(run.load(down["time"])) / 1e6,
        "5.213": down["time"],
        "4": 4.0,  # of the paper's figure
    }


CLAIMS: tuple[Callable[[Solution], Claims], ...] = (
    two_systems,
    law_of_slip,
    pulses,
    law_of_rate,
    folds,
    jump,
    critical,
    hysteresis,
)


def spelled(text: str, value: float) -> str:
    """Write a value with as many digits as the text has."""
    if "e" in text:
        digits = len(text.partition("e")[0].replace(".", "")) - 1
        return f"{value:.{digits}e}".replace("e+", "e")
    return f"{value:.{len(text.partition('.')[2])}f}"


@pytest.mark.parametrize(("step", "claims"), list(zip(TOUR, CLAIMS, strict=True)), ids=[step.title for step in TOUR])
def test_every_number_of_the_tour_is_that_of_its_own_run(step: TourStep, claims: Callable[[Solution], Claims]) -> None:
    told = set(NUMBER.findall(" ".join((step.text, step.look, step.question))))
    known = claims(ss.simulate(step.setting.scenario()))
    assert told == set(known)
    assert {text: spelled(text, value) for text, value in known.items()} == {text: text for text in known}


@pytest.mark.parametrize("step", TOUR, ids=lambda step: step.title)
def test_a_step_is_short_and_can_be_shown(step: TourStep) -> None:
    assert 40 <= len(step.text.split()) <= 80
    assert len(step.look.split()) <= 25
    assert len(step.question.split()) <= 25
    assert step.question.endswith("?")
    scenario = step.setting.scenario()
    assert 0.0 <= step.cursor <= scenario.duration
    strip = strip_of(scenario, replace(step.strip, points=5))
    assert strip.refused == {}
    assert strip.values[0] <= strip.here <= strip.values[-1]


def test_the_tour_has_eight_steps_with_titles_of_their_own() -> None:
    assert len({step.title for step in TOUR}) == len(TOUR) == 8


# ---- what the questions ask for --------------------------------------------------------------------------------------------


def test_the_stiff_block_does_not_slip_and_the_strip_shows_where_that_begins() -> None:
    step = TOUR[0]
    strip = strip_of(step.setting.scenario(), replace(step.strip, low=1.5e14, high=3.0e14, points=31, log=False))
    # by the linear theory of the start, S (static - dynamic) alpha = 2 sqrt(K m)
    limit = (1e14 * 0.5 * 1.0 / 2) ** 2 / 2.8e12
    runs_away = np.nan_to_num(strip.results["peak_rate"]) > 0.1
    assert runs_away[strip.values < 0.9 * limit].all()
    assert not runs_away[strip.values > 1.1 * limit].any()


def test_a_pulse_comes_later_the_closer_the_start_is_to_the_maximum() -> None:
    strip = strip_of(TOUR[1].setting.scenario(), replace(TOUR[1].strip, points=9))
    scenarios = (TOUR[1].setting.with_value("initial.slip", value).scenario() for value in strip.values.tolist())
    assert (np.diff([only_event(ss.simulate(one))["peak_time"] for one in scenarios]) < 0).all()


def test_slip_grows_with_the_thickness_in_steps_of_one_pulse() -> None:
    strip = strip_of(TOUR[2].setting.scenario(), replace(TOUR[2].strip, points=30))
    steps = strip.results["slip"] / (2 * math.pi / 50)
    np.testing.assert_allclose(steps, steps.round(), rtol=0, atol=0.03)
    assert set(steps.round()) == {1, 2, 3, 4, 5, 6}
    assert (np.diff(steps.round()) >= 0).all()


@pytest.mark.parametrize("k", [3, 4, 6])
def test_the_strip_in_alpha_shows_where_the_contact_becomes_irregular(k: int) -> None:
    strip = strip_of(TOUR[k].setting.scenario(), replace(TOUR[k].strip, points=9))
    np.testing.assert_array_equal(strip.results["irregular"], strip.values > 0.196)
    assert {0.0, 1.0} == set(strip.results["irregular"])


def test_the_rate_after_the_jump_is_a_straight_line_in_normal_stress() -> None:
    strip = strip_of(TOUR[5].setting.scenario(), replace(TOUR[5].strip, points=9))
    rate, jumps = strip.results["peak_rate"], strip.values > 19.6e6
    np.testing.assert_allclose(rate[jumps], strip.values[jumps] * 0.5 / 9.8e6 - 1.0, rtol=1e-7)
    assert np.isnan(rate[~jumps]).all()


def test_the_lesson_asks_the_question_of_each_step_within_its_time() -> None:
    """The answers on that page are run with the page itself."""
    page = (Path(__file__).parents[3] / "docs" / "explorer-lesson.md").read_text(encoding="utf-8")
    plan = re.findall(r"^\| (\d+) \| (.+?) \| (.+) \|$", page, re.MULTILINE)
    minutes = [int(minute) for minute, _, _ in plan]
    assert minutes == sorted(set(minutes))
    assert (minutes[0], max(minutes) < 45) == (0, True)
    for number, step in enumerate(TOUR, start=1):
        ((_, what, asked),) = [row for row in plan if f"tep {number}:" in row[1]]
        assert step.title.lower() in what
        assert re.split(r"(?<=[.?]) ", step.question)[-1] in asked
        assert f"### Step {number}: " in page
