"""Loading histories by themselves: values, segments, and one line for every mistake, in Python."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.quantities import fields_of, quantity
from stickslip.problem.loading import (
    HISTORIES,
    VARYING,
    HoldAndSlide,
    LoadingHistory,
    PiecewiseLinear,
    Segment,
    Sinusoidal,
    Steps,
    Tone,
)

SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
LOSSY = replace(SLAB, driver_impedance=2e6)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14)
LAW = ss.friction.LinearSlipWeakening(0.8, 0.7, 0.1)
STEPS = Steps([0.0, 1.0], [1.0, 2.0])
VALUE = f'a number in {VARYING}, or a text with a unit such as "10 m/s"'
HINT = "; what varies in time is one of stickslip.loading, such as Steps([0.0, 10.0], [1e-6, 1e-5])"
NUMBER = 'a number in {0} or a text with a unit such as "10 {0}", got {1}'
FAR = "Problem: far_stress and far_stress_rate need a slab with a finite driver_impedance"


def test_every_kind_is_registered_under_its_name_and_says_what_it_is() -> None:
    for kind, history in HISTORIES.items():
        assert history.kind == kind
        assert history.__doc__
        assert set(history.example) <= set(fields_of(history))


def test_every_history_has_its_values_at_times() -> None:
    ramp = PiecewiseLinear([1.0, 3.0], [2.0, 6.0])
    assert ramp.at([-1.0, 0.0, 1.0, 2.0, 3.0, 9.0]).tolist() == [2.0, 2.0, 2.0, 4.0, 6.0, 6.0]
    assert STEPS.at([-1.0, 0.0, np.nextafter(1.0, 0.0), 1.0, 5.0]).tolist() == [1.0, 1.0, 1.0, 2.0, 2.0]
    slides = HoldAndSlide(3.0, 10.0, [1.0, 2.0], hold=0.5)
    assert slides.at([0.0, 10.0, 11.0, 21.0, 22.9, 23.0, 99.0]).tolist() == [3.0, 0.5, 3.0, 0.5, 0.5, 3.0, 3.0]
    tone = Sinusoidal(1.0, 2.0, period=4.0, phase=0.5)
    times = np.array([-3.0, 0.0, 1.0, 17.3])
    np.testing.assert_allclose(tone.at(times), 1 + 2 * np.sin(np.pi / 2 * np.maximum(times, 0) + 0.5), rtol=1e-14, atol=1e-14)
    assert [one.first for one in (ramp, STEPS, slides)] == [2.0, 1.0, 3.0]
    assert tone.first == pytest.approx(1 + 2 * np.sin(0.5), rel=1e-15, abs=0)


def problem(**loading: Any) -> ss.Problem:
    return ss.Problem(LOSSY, LAW, initial_excess=-1.0, **loading)


@dataclass(frozen=True)
class Own(LoadingHistory):
    """A history as a user writes it."""

    kind: ClassVar[str] = "own"
    height: float = quantity(VARYING, "height")
    starts: tuple[float, ...] = (0.0, 1.0)
    frequency: float = 1.0

    @property
    def segments(self) -> tuple[Segment, ...]:
        return tuple(Segment(start, self.height, 0.0) for start in self.starts)

    @property
    def tone(self) -> Tone:
        return Tone(0.0, self.frequency, 0.0)


class Bare(LoadingHistory):
    segments = (Segment(0.0, 1.0, 0.0),)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Steps(5, [1]), "Steps: times must be a list of numbers in s, got int"),  # type: ignore[arg-type]
        (lambda: Steps([0, 1], [1, 2, 3]), "Steps: 2 times but 3 values"),
        (lambda: Steps([0, 1], "ab"), f"Steps: values must be a list of numbers in {VARYING}, got str"),
        (lambda: Steps([0, 1], [1, "a"]), f"Steps: values[1] must be {VALUE}, got 'a'"),
        (lambda: Steps([0, 2, 1], [1, 2, 3]), "Steps: times must ascend, but [2] = 1 follows 2; sort the points"),
        (lambda: Steps([0, 0], [1, 2]), "Steps: times must ascend, but [1] = 0 follows 0; keep one point of each, or their mean"),
        (lambda: Steps([1, 2], [1, 2]), "Steps: times must begin with 0, from which the first value holds, got 1"),
        (lambda: Steps([0], [1]), "Steps: times must have 2 to 1000000 numbers, got 1"),
        (lambda: Steps([0, np.inf], [1, 2]), "Steps: times[1] must be finite, got inf"),
        (lambda: PiecewiseLinear([0, 1, 2], [1, 2]), "PiecewiseLinear: 3 times but 2 values"),
        (lambda: PiecewiseLinear([-1, 1], [1, 2]), "PiecewiseLinear: times[0] must be at least 0 s, got -1"),
        (lambda: PiecewiseLinear([0, 1], [1, np.nan]), "PiecewiseLinear: values[1] must be finite, got nan"),
        (
            lambda: PiecewiseLinear(np.arange(1e6 + 1.0), np.arange(1e6 + 1.0)),
            "PiecewiseLinear: times must have 2 to 1000000 numbers, got 1000001",
        ),
        (lambda: Sinusoidal(1, 1, 0), "Sinusoidal: period must be greater than 0 s, got 0"),
        (lambda: Sinusoidal(1, 1, -5), "Sinusoidal: period must be greater than 0 s, got -5"),
        (lambda: Sinusoidal(1, np.nan, 5), "Sinusoidal: amplitude must be finite, got nan"),
        (lambda: Sinusoidal("a", 1, 5), f"Sinusoidal: mean must be {VALUE}, got 'a'"),  # type: ignore[arg-type]
        (lambda: HoldAndSlide(1, 0, [1]), "HoldAndSlide: slide_time must be greater than 0 s, got 0"),
        (lambda: HoldAndSlide(1, 1, 3), "HoldAndSlide: hold_times must be a list of numbers in s, got int"),  # type: ignore[arg-type]
        (lambda: HoldAndSlide(1, 1, []), "HoldAndSlide: hold_times must have 1 to 10000 numbers, got 0"),
        (lambda: HoldAndSlide(1, 1, [-3]), "HoldAndSlide: hold_times[0] must be greater than 0 s, got -3"),
        (lambda: problem(pull_rate="steps"), f"Problem: pull_rate must be {NUMBER.format('m/s', repr('steps'))}{HINT}"),
        (lambda: problem(pull_rate=None), f"Problem: pull_rate must be {NUMBER.format('m/s', None)}{HINT}"),
        (lambda: problem(far_stress=[1, 2]), f"Problem: far_stress must be {NUMBER.format('Pa', [1, 2])}{HINT}"),
        (
            lambda: problem(far_stress_rate=STEPS),
            "Problem: far_stress_rate must be a number in Pa/s: what may vary in time is pull_rate or far_stress",
        ),
        (
            lambda: problem(pull_rate=STEPS, far_stress=STEPS),
            "Problem: only one of pull_rate and far_stress may vary in time",
        ),
        (lambda: replace(problem(far_stress=STEPS), body=SLAB), FAR),
        (lambda: replace(problem(far_stress=STEPS), body=BLOCK), FAR),
        (lambda: problem(pull_rate=Bare()), "Bare: a loading history must be a frozen dataclass with a kind"),
        (
            lambda: problem(pull_rate=Own(1.0, (1.0, 2.0))),
            "Own: segments must begin with one at 0 s and ascend, got starts [1.0, 2.0]",
        ),
        (
            lambda: problem(pull_rate=Own(1.0, (0.0, 0.0))),
            "Own: segments must begin with one at 0 s and ascend, got starts [0.0, 0.0]",
        ),
        (lambda: problem(pull_rate=Own(1.0, ())), "Own: segments must begin with one at 0 s and ascend, got starts []"),
        (
            lambda: problem(pull_rate=Own(1.0, frequency=0.0)),
            "Own: segments and tone must be finite, and the tone's frequency above 0 rad/s",
        ),
    ],
)
def test_mistakes_are_refused_in_one_line(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(ss.InputError) as caught:
        make()
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("how", "message"),
    [
        ({"creep_rtol": 1e-6}, "creep_rtol must be 0 here: leaps over creep need a constant pull rate"),
        ({"shortest_event": 1e-6}, "shortest_event must be 0 here: events are lumped under a constant pull and normal load only"),
    ],
)
def test_options_that_need_a_constant_pull_refuse_another(how: dict[str, float], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        ss.simulate(ss.Problem(SLAB, LAW, pull_rate=STEPS, initial_excess=-1.0), 1.0, **how)  # type: ignore[arg-type] # that is the point


SOFT = replace(SLAB, driver_impedance=1e6)
ROCK = {"friction": ss.friction.RateAndState(0.6, a=0.01, b=0.012, distance=1e-5), "initial_load": 5e7, "initial_state": 1.0}


@pytest.mark.parametrize(
    ("fields", "missing"),
    [
        ({"pull_rate": Steps([0, 5], [1e-6, 1e-5])}, "a constant pull rate and normal load"),
        ({"body": BLOCK, "pull_rate": Steps([0, 5], [1e-6, 1e-5])}, "a constant pull rate and normal load"),
        ({"body": SOFT, "far_stress": Steps([0, 5], [5e7, 6e7])}, "a constant far stress"),
        ({"body": SOFT, "far_stress_rate": 1.0}, "a constant far stress"),
        ({"body": replace(SOFT, driver_inertia=1e3)}, "a driver without a mass and an integral gain"),
        ({"ground_acceleration": PiecewiseLinear([0, 1, 2], [0, 1, 0])}, "ground at rest"),
        ({"body": ss.LayeredSlab([100.0], [2800.0], [3500.0], SLAB.normal_stress)}, "a body of one layer"),
        ({"pull_rate": 0.0}, "a pull rate that is not 0"),
    ],
)
def test_the_reason_why_steady_sliding_cannot_be_leapt_over_is_the_right_one(fields: dict[str, Any], missing: str) -> None:
    problem = ss.Problem(**{"body": SLAB, "pull_rate": 1e-6} | ROCK | fields)
    with pytest.raises(ss.InputError, match=f"creep_rtol must be 0 here: leaps over creep need {missing}$"):
        ss.simulate(problem, 1.0, creep_rtol=1e-6)


def test_a_period_too_short_for_a_round_trip_is_refused() -> None:
    tone = Sinusoidal(1e-9, 1e-9, period=1e-9)
    with pytest.raises(
        ss.InputError, match=r"^the loading's period of 1e-09 s is too short: at least about 0\.000359 s is needed$"
    ):
        ss.simulate(ss.Problem(SLAB, LAW, pull_rate=tone, initial_excess=-1.0), 1.0)


def test_an_own_history_runs_and_is_saved_once_it_is_known(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A constant pull cut into two segments is a constant pull; its file is written only where its kind is known."""
    mine = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=Own(1e-3), initial_excess=1e11), 5.0)
    steady = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=1e-3, initial_excess=1e11), 5.0)
    times = np.linspace(0.0, 5.0, 301)
    np.testing.assert_allclose(mine.slip(times), steady.slip(times), rtol=1e-9, atol=1e-12)
    with pytest.raises(ss.InputError, match=r'^save: files do not know Own: set stickslip.loading.HISTORIES\["own"\] = Own'):
        mine.to_netcdf(tmp_path / "mine.nc")
    monkeypatch.setitem(HISTORIES, "own", Own)
    loaded = ss.open_solution(mine.to_netcdf(tmp_path / "mine.nc"))
    assert loaded.problem == mine.problem
    assert (loaded.slip(times) == mine.slip(times)).all()


def test_a_run_says_how_it_is_loaded() -> None:
    said = repr(ss.simulate("stress-pulse-slab"))
    assert "  loading         pull rate 0 m/s, far stress piecewise-linear, 5.9 MPa at first, initial load 5.9 MPa" in said
    said = repr(ss.simulate("tides-block"))
    assert "  loading         pull rate sinusoidal, 0.035 m/year at first, initial load 59 TN" in said
    assert "  loading         pull rate 0.05 m/year, initial load 80 MPa" in repr(ss.simulate("fig6-slab"))


def test_an_export_says_how_it_is_loaded(tmp_path: Path) -> None:
    run = ss.simulate("stress-pulse-slab")
    head = run.to_scec(tmp_path / "wave.txt", 10.0).read_text(encoding="utf-8").splitlines()
    assert "# pull_rate=0 m/s" in head
    assert "# far_stress=piecewise-linear, 5.9 MPa at first" in head
