"""Inference from records that scipy's integrator and closed forms have made: the numbers come back within their intervals."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.certainty.sampling import sample
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.record.loading import loading_of
from stickslip.foundation.netcdf_file import read
from tests.extensions.inference.laboratory import correlated, load_point
from tests.extensions.inference.velocity_steps import (
    CLOCK,
    GUESS,
    NEAR,
    RATES,
    STEPS,
    TIMES,
    TRUE,
    TRUTH,
    TWO,
    clean,
    inferred,
    plain,
    record,
)


@pytest.fixture(scope="module")
def found() -> Inference:
    return inferred(profiles=True, held_out=0.2)


def check_holds(study: Inference, truth: dict[str, float], widths: float = 1.5) -> None:
    """Check that true values are within so many half widths of the intervals of 95 %."""
    for name, value in truth.items():
        row = study.table.loc[name]
        half = 0.5 * (row.high - row.low)
        assert abs(row.value - value) < widths * half, (name, row.value, value, half)


def test_the_engine_and_the_integrator_of_the_record_agree() -> None:
    law = ss.friction.RateAndState(TRUE.reference, TRUE.a, TRUE.b, TRUE.distance)
    run = ss.simulate(ss.Problem(ss.SpringBlock(TRUE.mass, TRUE.stiffness, TRUE.normal), law, pull_rate=STEPS), 200.0)
    assert np.abs(run.traction(CLOCK) / TRUE.normal - clean()).max() < 1e-8


def test_velocity_steps_give_back_friction_and_stiffness_of_the_machine(found: Inference) -> None:
    check_holds(found, TRUTH)
    assert (found.table.uncertainty / found.table.value).max() < 0.02
    assert found.fit.noise["friction"] == pytest.approx(2e-4, rel=0.05)
    assert found.prediction == pytest.approx(1.0, abs=0.15)
    assert found.estimate.finished


def test_profiles_of_a_nearly_linear_fit_are_the_intervals_of_its_curvature(found: Inference) -> None:
    for profile, width, one, x in zip(found.profiles, found.certainty.widths, found.free, found.estimate.searched, strict=True):
        half = found.certainty.factor * width
        assert profile.low == pytest.approx(one.natural(x - half), rel=0.15 * half)
        assert profile.high == pytest.approx(one.natural(x + half), rel=0.15 * half)
        assert min(profile.rise) == 0.0


def test_the_scenario_written_runs_to_the_curve_shown(found: Inference, tmp_path: Path) -> None:
    run = ss.simulate(found.to_toml(tmp_path / "best.toml"))
    shown = found.curves
    assert run.traction(shown.time) / 5e4 == pytest.approx(shown.model.to_numpy(), rel=1e-9)


def test_the_file_holds_data_model_numbers_and_where_they_come_from(found: Inference, tmp_path: Path) -> None:
    stored = read(found.to_netcdf(tmp_path / "a.nc"))
    assert stored["residual"].values == pytest.approx(stored["data"].values - stored["model"].values, abs=1e-15)
    assert dict(zip(stored["number"].values, stored["value"].values, strict=True)) == pytest.approx(found.values)
    assert stored.attrs["scenario"] == found.scenario.to_toml()
    assert "stickslip" in stored.attrs["source"]
    assert (stored["fitted"].values == 0).sum() == 300


def test_the_figure_shows_record_residual_rate_and_pairs(found: Inference) -> None:
    figure = found.plot()
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    wanted = {"(a)  record and best run", "(b)  residual", "(c)  slip rate of the best run", "(d)  pairs, 95 %"}
    assert wanted <= set(titles)
    assert len(titles) == 3 + 6
    assert "samples" not in found.to_dataset()


@pytest.mark.slow
def test_correlated_noise_is_told_and_widens_the_intervals() -> None:
    white, memory = plain(), inferred(record(per_sample=10.0))
    assert memory.model.memory["friction"].time == pytest.approx(10.0 * CLOCK[1], rel=0.3)
    assert white.model.memory["friction"].time == 0.0
    assert any(note.startswith("residuals of friction remember themselves for 1.") for note in memory.notes)
    check_holds(memory, TRUTH)
    slow = ["friction.reference"]  # what changes slowly suffers most from slow noise
    assert (memory.table.uncertainty / white.table.uncertainty)[slow].min() > 2.5


@pytest.mark.slow
def test_words_say_what_the_record_does_not_determine() -> None:
    study = inferred(free=[*TRUTH, "friction.rate", "body.mass"])
    assert "body.mass has no influence on what is fitted: fix it" in study.notes
    assert "the record does not determine friction.reference and friction.rate separately: fix one of them" in study.notes
    assert not np.isfinite(study.table.uncertainty[["friction.rate", "friction.reference", "body.mass"]]).any()
    check_holds(study, {name: TRUTH[name] for name in ("friction.a", "friction.b", "body.stiffness")})


def test_a_number_on_a_bound_is_told_and_has_no_interval() -> None:
    study = inferred(free=["friction.b"], bounds={"b": (0.0128, 0.02)})
    assert study.table.source["friction.b"] == "bound"
    assert any(note.startswith("friction.b lies on the lower end of its bounds, 0.0128") for note in study.notes)


@pytest.mark.slow
def test_a_prior_pulls_as_much_as_it_is_sure() -> None:
    tight = inferred(free=TWO, priors={"a": "lognormal(0.012, 1e-5)"})
    assert tight.values["friction.a"] == pytest.approx(0.012, rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("start", "starts"),
    [
        ({"distance": "1 mm", "stiffness": 1e6}, 2),
        pytest.param({"a": 0.02, "b": 0.022, "distance": "60 um", "stiffness": 2.5e7}, 4),
    ],
    ids=["two numbers", "all numbers"],
)
def test_starts_far_off_lead_to_the_same_numbers(start: dict[str, Any], starts: int) -> None:
    """Least squares alone do not, and the search without derivatives takes over."""
    names = [name for name in TRUTH if name.partition(".")[2] in start] if starts == 2 else list(TRUTH)
    known = replace(GUESS, friction=replace(GUESS.friction, a=TRUE.a, b=TRUE.b, reference=TRUE.reference)) if starts == 2 else GUESS
    said: list[str] = []
    study = ss.studies.infer(known, record(), names, starts=starts, begin_at=start, progress=said.append)
    assert any("without derivatives" in one for one in said)
    check_holds(study, {name: TRUTH[name] for name in names})


@pytest.mark.slow
def test_outliers_are_borne_by_a_robust_loss() -> None:
    data = record()
    data.loc[::97, "mu"] += 0.02
    check_holds(inferred(data, TWO, loss="soft_l1"), {name: TRUTH[name] for name in TWO}, 2.0)


@pytest.mark.slow
def test_a_trend_and_the_clock_of_the_record_can_be_free() -> None:
    data = record()
    moved = load_point(CLOCK, TIMES, RATES)
    late = np.interp(CLOCK - 1.5, CLOCK, clean())
    data["mu"] = late + 5.0 * moved + 1e-4 * correlated(len(CLOCK), 0.0, 3)
    study = ss.studies.infer(NEAR, data, [*TWO, "record.trend", "record.delay"], starts=1)
    assert study.values["record.delay"] == pytest.approx(1.5, abs=0.05)
    assert study.values["record.trend"] == pytest.approx(5.0, rel=0.05)
    assert any(
        "belong to the record: the run of the best scenario, and the explorer, are without them" in one for one in study.notes
    )


@pytest.mark.slow
def test_two_records_share_the_numbers() -> None:
    alone, both = inferred(free=TWO), inferred([record(seed=1), record(seed=2)], TWO)
    check_holds(both, {name: TRUTH[name] for name in TWO})
    ratio = both.table.uncertainty / alone.table.uncertainty
    assert ratio.to_numpy() == pytest.approx(math.sqrt(0.5), rel=0.1)


@pytest.mark.slow
def test_slip_can_be_fitted_beside_friction() -> None:
    data = record()
    spring = clean() * TRUE.normal / TRUE.stiffness  # slip is what the spring has not taken
    slip = load_point(CLOCK, TIMES, RATES) - spring + spring[0]
    data["slip (um)"] = 1e6 * slip + 0.05 * correlated(len(CLOCK), 0.0, 5) + 300.0
    alone, both = inferred(data, TWO), inferred(data, TWO, observe=["friction", "slip"])
    check_holds(both, {name: TRUTH[name] for name in TWO})
    assert (both.table.uncertainty <= 1.02 * alone.table.uncertainty).all()
    assert both.fit.noise["slip"] == pytest.approx(5e-8, rel=0.1)


@pytest.mark.slow
def test_laws_are_ranked_by_what_they_predict(found: Inference) -> None:
    slip_law = replace(GUESS, friction=replace(GUESS.friction, evolution="slip"))
    other = ss.studies.infer(slip_law, record(), tuple(TRUTH), starts=1, held_out=0.2)
    table = ss.studies.ranking(other, found)
    assert table.law.tolist() == ["rate-and-state, ageing", "rate-and-state, slip"]
    assert table.prediction[0] == found.prediction < table.prediction[1]


def test_a_load_point_of_a_million_samples_with_noise_a_gap_and_a_jump_is_followed() -> None:
    time = np.linspace(0.0, 1000.0, 200_001)
    moved = load_point(time, [0.0, 300.0, 400.0], [1e-6, 1e-5, 1e-6]) + 5e-5 * (time > 700.0)
    noisy = moved + 1e-7 * correlated(len(time), 0.0, 0)
    keep = (time < 500.0) | (time > 560.0)
    read_in = ss.studies.Record.read({"time (s)": time[keep], "load point (m)": noisy[keep], "mu": 0.6 + 0.0 * time[keep]})
    loading: Any = loading_of(read_in)
    segments = np.array(loading.rate.segments)
    ends = np.append(segments[1:, 0], 1000.0)
    at = np.append(0.0, np.cumsum(segments[:, 1] * (ends - segments[:, 0])))
    assert np.abs(np.interp(time, np.append(segments[:, 0], 1000.0), at) - moved).max() < 6e-7 or len(segments) > 4
    assert at[-1] == pytest.approx(moved[-1] - moved[0], abs=2e-7)
    assert len(segments) < 20
    assert "1 gap" in loading.notes[1]


def test_ctrl_c_leaves_the_best_numbers_so_far(monkeypatch: pytest.MonkeyPatch) -> None:
    module, calls = import_module("stickslip.extensions.inference.fit.model"), []
    original = module.simulate

    def stops(*args: Any, **options: Any) -> Any:
        calls.append(1)
        if len(calls) > 25:
            raise KeyboardInterrupt
        return original(*args, **options)

    monkeypatch.setattr(module, "simulate", stops)
    model = import_module("stickslip.extensions.inference.infer")
    monkeypatch.setattr(model, "certainty_of", lambda found: calls.clear() or original_certainty(found))
    study = inferred()
    assert not study.estimate.finished
    assert study.notes[0] == "interrupted: these are the best numbers so far"
    assert study.values["friction.reference"] == pytest.approx(0.62, rel=0.05)


original_certainty = import_module("stickslip.extensions.inference.certainty.certainty").certainty_of


@pytest.mark.slow
def test_posterior_samples_have_the_intervals_of_the_curvature_and_more_of_them_go_on_where_the_walk_ended() -> None:
    pytest.importorskip("emcee")
    few = inferred(record().iloc[::3], free=("friction.a", "friction.reference"), samples=96)
    study = few.more(400)
    assert few.samples is not None
    assert study.samples is not None
    assert len(study.samples) == 400
    assert study.samples[:96].equals(few.samples)
    spread = study.samples.std().to_numpy()
    assert spread == pytest.approx(study.table.uncertainty.to_numpy(), rel=0.3)
    assert set(study.table.source) == set(few.table.source) == {"samples"}
    assert few.about_samples[0].startswith("96 samples")
    assert "400 samples" in study.about_samples[0]
    assert len(study.plot().axes) == 4
    with pytest.raises(ss.InputError, match="more: there are 96 samples already, got 96"):
        few.more(96)


@pytest.mark.slow
def test_samples_go_on_bit_for_bit_where_a_program_that_was_killed_has_left_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It ends in the middle of the walk; the second program takes no step anew."""
    pytest.importorskip("emcee")
    asked: dict[str, Any] = {"free": ("friction.a", "friction.reference"), "samples": 96}
    rows, path = record().iloc[::3], tmp_path / "walk.nc"
    whole = inferred(rows, **asked)
    monkeypatch.setattr("stickslip.extensions.inference.certainty.kept_walk.EVERY", 0.0)
    monkeypatch.setattr("stickslip.extensions.inference.certainty.kept_walk.SHARE_OF_WRITING", math.inf)

    def die(text: str) -> None:
        if "sampling: step 21 " in text:
            raise RuntimeError("killed")

    with pytest.raises(RuntimeError, match="killed"):
        inferred(rows, **asked, checkpoint=path, progress=die)
    assert read(path)["steps"].shape[0] == 20
    told: list[str] = []
    found = inferred(rows, **asked, checkpoint=path, progress=told.append)
    assert found.samples is not None
    assert whole.samples is not None
    assert found.samples.equals(whole.samples)
    assert "sampling: step 1 of" not in " ".join(told)
    assert inferred(rows, **asked, checkpoint=path).samples.equals(whole.samples)  # type: ignore[union-attr] # there are some
    with pytest.raises(ss.InputError, match=r"walk\.nc: is of another inference: choose another name, or remove it"):
        inferred(rows, **asked | {"samples": 112}, checkpoint=path)


def test_a_checkpoint_without_samples_or_with_a_name_of_something_else_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ss.InputError, match="infer: checkpoint is of the samples that are drawn: ask for some with samples="):
        inferred(checkpoint=tmp_path / "walk.nc")
    pytest.importorskip("emcee")
    (tmp_path / "mine.nc").write_text("mine")
    for name, said in (("walk.csv", "the name must end in .nc"), ("mine.nc", "exists, and stickslip did not write it")):
        with pytest.raises(ss.InputError, match=said):
            inferred(samples=100, checkpoint=tmp_path / name)


def test_more_samples_than_none_are_refused(found: Inference) -> None:
    with pytest.raises(ss.InputError, match="more: no samples were drawn: ask `infer` for some first, with samples="):
        found.more(100)


def drawn(residual: Any, fit: np.ndarray, slopes: np.ndarray, count: int, before: Any = None) -> Any:
    """Samples of a posterior given by its residuals, around a fit with some derivatives of them."""
    wide = np.full(len(fit), 9.0)
    model = SimpleNamespace(limits=(-wide, wide), residual=residual, rtol=1e-10)
    found: Any = SimpleNamespace(model=model, searched=fit, loss="linear")
    covariance = np.linalg.inv(slopes.T @ slopes)
    sure: Any = SimpleNamespace(widths=np.sqrt(np.diag(covariance)), covariance=covariance, excess=np.ones(len(fit)), slopes=slopes)
    return sample(found, sure, count, lambda _: None, seed=1, before=before)


SLOPES = np.random.default_rng(5).standard_normal((40, 5))


@pytest.mark.slow
@pytest.mark.parametrize(("shift", "narrower", "independent"), [(0.0, 1.0, 3500), (0.7, 1.3, 800)])
def test_samples_have_the_moments_of_a_normal_posterior_even_if_the_fit_is_wrong(
    shift: float, narrower: float, independent: int
) -> None:
    """Mean 1 to 5 and the inverse of J^T J; a wrong fit lies beside the best one, with intervals that are too narrow."""
    pytest.importorskip("emcee")
    mean, covariance = np.arange(1.0, 6.0), np.linalg.inv(SLOPES.T @ SLOPES)
    fit = mean + shift * np.sqrt(np.diag(covariance))
    walk = drawn(lambda x: SLOPES @ (x - mean), fit, narrower * SLOPES, 20_000 if shift else 10_000)
    scaled = np.linalg.solve(np.linalg.cholesky(covariance), (walk.drawn - mean).T)
    assert np.abs(scaled.mean(axis=1)).max() < 4.0 / math.sqrt(independent)
    assert np.abs(np.cov(scaled) - np.eye(5)).max() < 6.0 / math.sqrt(independent)
    assert int(walk.notes[0].split("about ")[1].split()[0]) > independent


@pytest.mark.slow
def test_samples_of_a_bent_posterior_have_its_moments() -> None:
    """x is normal, and y normal around x^2/2: E(y) is 1/2, and its variance 3/2. The fit sees a straight line."""
    pytest.importorskip("emcee")
    x, y = drawn(lambda x: np.array([x[0], x[1] - 0.5 * x[0] ** 2]), np.zeros(2), np.eye(2), 20_000).drawn.T
    assert (x.mean(), x.var(), y.mean(), y.var()) == pytest.approx((0.0, 1.0, 0.5, 1.5), abs=0.15)


def drawn_until(call: int, count: int, before: Any = None) -> Any:
    """Samples of one number with a normal distribution, where Ctrl-C comes in the call of the model with this number."""
    calls = iter(range(call))

    def residual(x: np.ndarray) -> np.ndarray:
        if next(calls, None) is None:
            raise KeyboardInterrupt
        return np.array([x[0]])

    return drawn(residual, np.zeros(1), np.eye(1), count, before)


@pytest.mark.slow
def test_samples_that_were_drawn_before_ctrl_c_are_kept(capfd: pytest.CaptureFixture[str]) -> None:
    """16 walkers take 375 steps, and 38 before these: 16 calls are a step."""
    pytest.importorskip("emcee")
    whole = drawn_until(100_000, 6000)
    assert whole.notes[0].startswith("6000 samples")
    assert whole.drawn.mean() == pytest.approx(0.0, abs=0.1)
    assert whole.drawn.std() == pytest.approx(1.0, rel=0.1)
    for call in (16 * 200, 16 * 200 + 11):
        some = drawn_until(call, 6000)
        count = len(some.drawn)
        assert some.notes[0] == f"sampling was stopped: {count} of 6000 samples were drawn; `more` goes on"
        assert abs(count - 16 * (200 - 38)) <= 32
        assert np.array_equal(some.drawn, whole.drawn[:count])
        assert np.array_equal(drawn_until(100_000, 6000, some).drawn, whole.drawn)
    with pytest.raises(KeyboardInterrupt):
        drawn_until(16 * 30, 6000)
    assert capfd.readouterr() == ("", "")


def test_samples_without_emcee_are_refused_with_the_way_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "emcee", None)
    monkeypatch.setattr("stickslip.extensions.inference.infer.parts_of", lambda *_: pytest.fail("the record was looked at"))
    with pytest.raises(ss.InputError, match=r"samples need emcee: pip install 'stickslip\[infer\]'"):
        inferred(samples=100)
