"""Stick-slip fitted by features of its events: closed forms and characteristics make the records, not the engine."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.fit.by_features import by_features, means_of
from stickslip.extensions.inference.fit.memory import ResidualBlock, memory_of
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.inference import Inference
from stickslip.extensions.inference.record.features import Samples, features_in
from tests.extensions.inference.laboratory import CoulombBlock, CoulombSlab, correlated
from tests.messages import refused

BLOCK, SLAB = CoulombBlock(), CoulombSlab()
FREE = ("friction.dynamic", "body.stiffness", "body.mass")
TRUTH = {"friction.dynamic": BLOCK.dynamic, "body.stiffness": BLOCK.stiffness, "body.mass": BLOCK.mass}
GUESS = ss.Problem(
    ss.SpringBlock(1.8, 4.4e6, 1e3), ss.friction.Coulomb(BLOCK.static, 0.48), pull_rate=BLOCK.pull, initial_load=300.0
)


def sampled(time: Any, **values: Any) -> dict[str, list[float]]:
    def between(begin: float, end: float) -> Samples:
        inside = slice(*np.searchsorted(time, [begin, end]).tolist())
        return Samples(time[inside], {name: one[inside] for name, one in values.items()})

    return {name: one.tolist() for name, one in features_in(Samples(time, values), between, "shear_force").items()}


def block_record(seed: int = 0, duration: float = 1.2, noise: float = 1.0, scatter: float = 0.01) -> dict[str, Any]:
    time = np.arange(0.0, duration, 1e-4)
    force, _ = BLOCK.sampled(time, 300.0, scatter, seed)
    noisy = force + noise * correlated(len(time), 0.0, 1000 + seed)
    return {"time (s)": time, "shear force (N)": noisy, "load point (m)": BLOCK.pull * time}


def block_fit(data: Any, free: Any = FREE, **options: Any) -> Inference:
    return ss.studies.infer(GUESS, data, free, **({"sensor": "spring", "by": "features", "starts": 1} | options))


def slab_fit(seed: int) -> Inference:
    time, shear, slip = (one[::8] for one in SLAB.stick_slip(2e6, 0.6, 0.005, seed))  # ten samples a round trip
    guess = ss.Problem(
        ss.ElasticSlab(1300.0, SLAB.wave_speed, 0.11, SLAB.normal),
        ss.friction.Coulomb(SLAB.static, 0.48),
        **{"pull_rate": SLAB.pull, "initial_load": 2e6},
    )
    data = {"time (s)": time, "tau (Pa)": shear + 2e3 * correlated(len(time), 0.0, seed)}
    data |= {"slip (m)": slip + 1e-7 * correlated(len(time), 0.0, 50 + seed), "load rate (m/s)": np.full(len(time), SLAB.pull)}
    return ss.studies.infer(guess, data, ["dynamic", "thickness", "density"], by="features", starts=1)


@pytest.fixture(scope="module")
def slab() -> Inference:
    return slab_fit(1)


def check_holds(study: Inference, truth: dict[str, float]) -> None:
    for name, value in truth.items():
        row = study.table.loc[name]
        assert row.low <= value <= row.high, (name, row.low, value, row.high)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("step", [2e-4, 1e-5])
def test_features_do_not_depend_on_how_often_a_record_is_sampled(step: float) -> None:
    time = np.arange(0.0, 0.4, step)
    force, slip = BLOCK.sampled(time, 300.0)
    found = sampled(time, shear_force=force, slip=slip)
    fine = np.arange(0.0, 0.4, 1e-6)
    force, slip = BLOCK.sampled(fine, 300.0)
    exact = sampled(fine, shear_force=force, slip=slip)
    for name in ("shear_force_drop", "recurrence", "duration", "event_slip"):
        assert found[name] == pytest.approx(exact[name], rel=5e-4), name


def test_features_of_a_triangular_record_are_those_that_it_was_made_with() -> None:
    time = np.arange(0.0, 50.0, 0.01)
    phase = time % 10.0
    shear = np.where(phase < 9.0, 1.0 + phase, 10.0 - 9.0 * (phase - 9.0))
    found = sampled(time, shear_force=shear)
    assert found["recurrence"] == pytest.approx([10.0] * len(found["recurrence"]), rel=1e-9)
    # in the middle of the fall the line before it is at 1 + 9.5, the one after it at 0.5
    assert found["shear_force_drop"] == pytest.approx([10.0] * len(found["recurrence"]), rel=1e-9)
    assert found["duration"] == pytest.approx([1.0 / np.sqrt(3.0)] * len(found["recurrence"]), rel=2e-3)


def test_noise_does_not_shift_the_features() -> None:
    time = np.arange(0.0, 2.0, 1e-4)
    force, _ = BLOCK.sampled(time, 300.0)
    clean, noisy = (sampled(time, shear_force=force + size * correlated(len(time), 0.0, 3)) for size in (0.0, 5.0))
    for name in ("shear_force_drop", "recurrence", "duration"):
        error = np.std(noisy[name]) / np.sqrt(len(noisy[name]))
        assert abs(np.mean(noisy[name]) - np.mean(clean[name])) < 3.0 * error, name


@pytest.mark.slow
def test_mass_stiffness_and_friction_of_a_block_come_out_of_the_features_of_its_events() -> None:
    study = block_fit(block_record())
    check_holds(study, TRUTH)
    assert (study.table.uncertainty / study.table.value).max() < 0.2
    assert study.headline.startswith("3 numbers from 4 features of 14 slip events, scatter: shear_force_peak")
    names = ["shear_force_peak", "shear_force_rest", "recurrence", "duration"]
    assert any(f"14 slip events of record, each with its {', '.join(names)}" in one for one in study.notes)
    assert list(study.curves.quantity.unique()) == list(study.features.feature) == names
    assert study.curves.fitted.all()
    assert not study.features.missed.any()


@pytest.mark.slow
def test_chosen_features_must_be_as_many_as_the_numbers() -> None:
    data = block_record()
    assert set(block_fit(data, ["dynamic"], observe="drop,recurrence").model.sizes) == {"shear_force_drop", "recurrence"}
    with pytest.raises(ss.InputError, match="infer: shear_force_drop cannot determine 2 numbers: free fewer of them"):
        block_fit(data, ["dynamic", "stiffness"], observe="drop")
    with pytest.raises(ss.InputError, match="infer: observe: events have no 'dorp'; allowed: "):
        block_fit(data, observe="dorp")
    with pytest.raises(ss.InputError, match="shear_force_drop is the difference of peak and rest: choose two of the three"):
        block_fit(data, observe="drop,peak,rest")


@pytest.mark.parametrize(
    ("data", "options", "message"),
    [
        (
            block_record(duration=0.4),
            {},
            "record: 3 whole slip events are too few for the scatter of 4 features: an event is a fall of",
        ),
        (block_record(duration=0.1), {}, "record: no two drops of shear_force stand out of its noise"),
        (block_record(), {"parts": "rests"}, "infer: by='features' and parts='rests' are two ways to fit stick-slip: choose one"),
        (block_record(), {"by": "feature"}, "infer: by 'feature' is unknown; did you mean 'features'"),
    ],
)
def test_what_has_no_features_is_one_line(data: Any, options: Any, message: str) -> None:
    with refused(begins=message):
        block_fit(data, **options)


def test_slopes_that_are_all_alike_count_once_in_the_memory_of_noise() -> None:
    """Means of features change all events alike with each number; three such columns made white noise seem to last for ever."""
    noise = correlated(24, 0.0, 5)
    block = [ResidualBlock(slice(0, 24), np.arange(24.0))]
    one, three = (memory_of(noise, np.ones((24, count)) * np.arange(1.0, 1.0 + count), block) for count in (1, 3))
    assert tuple(one) == pytest.approx(tuple(three))
    assert three.time == 0.0


@pytest.mark.slow
def test_thickness_and_impedance_of_a_laboratory_slab_come_out_of_the_features_of_its_events(slab: Inference) -> None:
    """The return of the wave stops slip: its duration tells the thickness, and slip tells the impedance."""
    check_holds(slab, {"friction.dynamic": SLAB.dynamic, "body.thickness": SLAB.thickness, "body.density": SLAB.density})


LEVELS = CoulombBlock(mass=20.0, stiffness=2e7, normal=5e4, static=0.7, dynamic=0.6, pull=1e-5)
"""A block that slips each 50 s, in falls that are shorter than the time between two samples."""


def levels_fit(free: Any, stiffness: float, events: int = 200, seed: int = 0, **begin: float) -> Inference:
    """Fit to some events whose static friction scatters, with noise of 1e-4, on load-point data in steps of 0.1 um."""
    time = np.arange(0.0, 50.0 * events, 0.5)
    force, _ = LEVELS.sampled(time, 25e3, 0.006, seed)
    friction = force / LEVELS.normal + 1e-4 * correlated(len(time), 0.0, 500 + seed)
    data = {"time (s)": time, "friction": friction, "load point (um)": np.round(10.0 * time, 1)}
    law = ss.friction.Coulomb(begin.get("static", LEVELS.static), begin.get("dynamic", 0.58))
    guess = ss.Problem(ss.SpringBlock(LEVELS.mass, stiffness, LEVELS.normal), law, pull_rate=LEVELS.pull, initial_load=25e3)
    return ss.studies.infer(guess, data, free, sensor="spring", by="features", starts=1)


@pytest.mark.slow
def test_a_run_that_misses_the_recurrence_is_not_said_to_follow_the_record() -> None:
    """The stiffness is fixed to 30 MN/m in place of 20 MN/m: no dynamic friction gives drop and time between events together."""
    study = levels_fit(["dynamic"], 3e7)
    row = study.features.set_index("feature").loc["recurrence"]
    assert row.missed
    assert row["mean"] == pytest.approx(50.0, abs=3.0 * row.error)
    assert row.run < 35.0
    said = next(one for one in study.notes if one.startswith("the run misses recurrence: the mean of the record is "))
    assert said.endswith(f"s, {(row['mean'] - row.run) / row.error:.0f} standard errors away")
    half = 0.5 * float((study.table.high - study.table.low).iloc[0])
    assert half > 0.01  # and the interval is as wide as such a misfit makes it: half of what 50 % of stiffness change in the drop


@pytest.mark.slow
def test_static_and_dynamic_friction_and_stiffness_come_out_of_levels_alone() -> None:
    study = levels_fit(["static", "dynamic", "stiffness"], 2.3e7, static=0.72)
    check_holds(study, {"friction.static": 0.7, "friction.dynamic": 0.6, "body.stiffness": 2e7})
    assert not study.features.missed.any()
    assert not any("misses" in one for one in study.notes)
    assert (study.table.uncertainty / study.table.value).max() < 2e-3


@pytest.mark.slow
def test_the_figure_has_a_panel_for_each_feature_with_record_and_run_in_readable_units(slab: Inference) -> None:
    figure = slab.plot()
    titles = ["peak stress", "stress at rest", "recurrence", "duration", "slip in the event"]
    units = ["(MPa)", "(MPa)", "(ms)", "(µs)", "(µm)"]
    panels = [next(axes for axes in figure.axes if axes.get_title(loc="left").endswith(title)) for title in titles]
    for axes, name, unit in zip(panels, slab.features.feature, units, strict=True):
        assert axes.get_ylabel().endswith(unit)
        events, run = (line.get_ydata() for line in axes.lines)
        assert len(events) == (slab.curves.quantity == name).sum()
        assert run[0] == pytest.approx(np.mean(events), rel=0.02)
    figure.canvas.draw()
    assert not any(axis.get_offset_text().get_text() for axes in figure.axes for axis in (axes.xaxis, axes.yaxis))


@pytest.mark.parametrize("what", ["clean", "backwards", "drift", "gap", "glitch", "unloaded"])
def test_features_are_the_same_in_a_record_that_is_not_perfect(what: str) -> None:
    time = np.arange(0.0, 1.5, 1e-4)
    force, _ = BLOCK.sampled(time, 300.0)
    clean = sampled(time, shear_force=force)
    if what == "backwards":
        force = -force
    elif what == "drift":  # four times the drop of an event
        force = force + 800.0 * time
    elif what == "gap":
        time, force = time[(time < 0.6) | (time > 0.63)], force[(time < 0.6) | (time > 0.63)]
    elif what == "glitch":
        force[[777, 5555]] = 0.0
    elif what == "unloaded":
        force = np.where(time > 1.49, force * np.maximum(1.0 - (time - 1.49) / 0.005, 0.0), force)
    found = sampled(time, shear_force=force)
    for name in ("shear_force_drop", "duration", "recurrence"):
        allowed = 0.005 if what == "clean" else 0.02  # a drift of 800 N/s takes part in both
        assert np.nanmedian(found[name]) == pytest.approx(np.median(clean[name]), rel=allowed), name
    assert len(found["recurrence"]) >= len(clean["recurrence"]) - 4


def test_an_event_that_a_gap_may_hide_does_not_make_a_recurrence_longer() -> None:
    data = block_record(duration=2.0)
    for begin in np.arange(0.6, 0.7, 0.01):
        kept = (data["time (s)"] < begin) | (data["time (s)"] > begin + 0.1)  # one event, or two, are in there
        record = ss.studies.Record.read({name: values[kept] for name, values in data.items()})
        (part,), _ = by_features([Part(record, None, ("shear_force",))], None)
        assert max(part.record.measured["recurrence"]) < 0.09, begin
        assert len(part.record) > 18


def test_errors_of_means_allow_for_events_that_depend_on_their_neighbours() -> None:
    """Of a sum of two neighbouring random numbers the mean of n has the variance 4/n, twice that of independent numbers."""
    random = np.random.default_rng(2)
    squares = []
    for _ in range(300):
        draws = random.standard_normal((2, 101))
        squares.append(means_of(draws[:, 1:] + draws[:, :-1]).errors ** 2)
    assert np.mean(squares) == pytest.approx(4.0 / 100, rel=0.1)


@pytest.mark.slow
def test_intervals_from_features_hold_the_truth_at_least_as_often_as_they_say() -> None:
    held = dict.fromkeys(TRUTH, 0)
    for seed in range(60):
        table = block_fit(block_record(seed, 2.0)).table
        for name, value in TRUTH.items():
            held[name] += bool(table.low[name] <= value <= table.high[name])
    assert min(held.values()) >= 54, held  # of 60; three standard errors below 95 % are 52
