"""What is read from frames of a planar slab: against closed forms, and against the events of the slab in 1D."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

import stickslip as ss
from stickslip.extensions.planar.figure import stage
from stickslip.extensions.planar.pulses import pulses, rupture_speed, rupture_times
from tests.extensions.planar.patches import SLAB, patch

TIMES = np.linspace(0.0, 10.0, 4001)


def bell(centre: float, width: float = 0.3) -> np.ndarray:
    return np.exp(-(((TIMES - centre) / width) ** 2))


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(
    ("rate", "count"),
    [
        (bell(2.0) + bell(5.0) + bell(8.0), 3),
        (-bell(2.0) - bell(5.0), 2),
        (bell(5.0, 3.0) * (1.0 + 0.3 * np.sin(3.0 * TIMES)), 1),  # minima above half of the lower maximum separate nothing
        (bell(2.0) + 0.3 * bell(5.0), 2),
        (TIMES / 10.0, 1),  # it still rises
        (1.0 - TIMES / 10.0, 1),
        (np.ones_like(TIMES), 1),
        (np.zeros_like(TIMES), 0),
        (1e-4 * bell(5.0), 0),
    ],
)
def test_pulses_are_maxima_with_deep_minima_between(rate: np.ndarray, count: int) -> None:
    assert pulses(rate[:, None], 1e-3).tolist() == [count]


def test_a_front_is_timed_and_its_speed_found() -> None:
    y, speed = np.linspace(-5e3, 5e3, 101), 2500.0
    rate = np.maximum(TIMES[:, None] - np.abs(y) / speed, 0.0)
    found = rupture_times(TIMES, rate, 1e-3)
    assert np.abs(found - np.abs(y) / speed - 1e-3).max() < 1e-12 + 2.5e-3  # a frame
    assert np.abs(rupture_speed(100.0, np.abs(y) / speed)[[10, 30, 70, 90]] / speed - 1.0).max() < 1e-12
    assert np.isnan(rupture_times(TIMES, 0.0 * rate, 1e-3)).all()


@pytest.mark.slow
def test_a_uniform_contact_has_the_pulses_of_the_slab_in_1d() -> None:
    problem = ss.scenarios["fig5-slab-reconstructed"].problem
    contact = ss.PlanarSlab(problem, nodes=8, length=1.4e4)
    run = ss.simulate(contact, 7.0, frames=1000)
    exact = ss.simulate(problem, 7.0)
    assert run.pulses.tolist() == [int(exact.events.pulses.iloc[0])] * 8 == [3] * 8
    drop = exact.traction(0.0, side="left") - exact.traction(7.0)
    assert run.stress_drop == pytest.approx(np.full(8, drop), rel=2e-2, abs=0.0)


def test_moment_rate_is_the_modulus_times_area_and_rate() -> None:
    run = ss.simulate(patch(nodes=32, length=2e4), 3.0, frames=10)
    total = np.trapezoid(run.slip_rate[-1], dx=2e4 / 32) + run.slip_rate[-1, 0] * 2e4 / 64 + run.slip_rate[-1, -1] * 2e4 / 64
    assert run.moment_rate[-1] == pytest.approx(SLAB.shear_modulus * total, rel=1e-12, abs=0.0)


def test_the_process_zone_of_linear_weakening_is_that_of_the_closed_form() -> None:
    """9 pi/16 G Dc/(tau_s - tau_d), between nodes 625 m apart."""
    run = ss.simulate(patch(nodes=32, length=2e4), 3.0, frames=10)
    zone = 9.0 * math.pi / 16.0 * SLAB.shear_modulus * 0.4 / 20e6
    assert run.nodes_per_process_zone == pytest.approx(zone / 625.0, rel=1e-6, abs=0.0)
    assert "NOT resolved" in str(run)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("plane", [False, True])
def test_a_run_draws_itself_with_units(plane: bool) -> None:
    grid = {"width": 2e4, "width_nodes": 16} if plane else {}
    figure = ss.simulate(patch(nodes=32, length=2e4, **grid), 3.0, frames=10).plot(figure=Figure())
    labels = " ".join(axis.get_ylabel() + axis.get_xlabel() for axis in figure.axes)
    assert all(unit in labels for unit in ("(km)", "(m/s)", "(s)"))


def test_the_figure_has_the_title_of_the_scenario_also_from_a_folder(tmp_path: Path) -> None:
    scenario = ss.load_scenario("planar-patch")
    scenario = replace(scenario, duration=0.5).with_table("contact", replace(scenario.table("contact"), nodes=64, frames=10))
    run = ss.simulate(scenario, checkpoint=tmp_path / "fault.zarr")
    for one in (run, ss.open_solution(tmp_path / "fault.zarr"), ss.simulate(scenario)):
        assert one.title == scenario.title
        assert one.plot(figure=Figure()).get_suptitle() == scenario.title
    plain = ss.simulate(patch(nodes=32, length=2e4), 1.0, frames=10, checkpoint=tmp_path / "plain.zarr")
    assert [one.plot(figure=Figure()).get_suptitle() for one in (plain, ss.open_solution(tmp_path / "plain.zarr"))] == ["", ""]


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("plane", [False, True])
def test_a_film_shows_the_contact_frame_by_frame(plane: bool, tmp_path: Path) -> None:
    """What moves from frame 3 to frame 4: the fields, and the clock."""
    grid = {"width": 2e4, "width_nodes": 16} if plane else {}
    run = ss.simulate(patch(nodes=32, length=2e4, **grid), 3.0, frames=10)
    told: list[tuple[int, int]] = []
    path = run.plot.animation(tmp_path / "fault.gif", 0.5, 2.6, frames=4, progress=lambda *news: told.append(news))
    assert told == [(n, 4) for n in range(1, 5)]
    with Image.open(path) as film:
        frames = [np.asarray(film.convert("L"), float) for _ in ImageSequence.Iterator(film)]
    assert len(frames) == 4
    assert all(np.abs(late - early).mean() > 0.05 for early, late in pairwise(frames))
    figure = Figure()
    move, moving = stage(run, np.array([2, 5]))(figure)
    move(1)
    shown = moving[0].get_array() if plane else moving[0].get_ydata()
    assert np.ma.filled(shown, 0.0) == pytest.approx(run.slip_rate[5].T, rel=1e-12, abs=0.0)
    assert figure.axes[0].get_title(loc="left") == f"{run.times[5]:.3f} s"
    assert all(unit in " ".join(a.get_xlabel() + a.get_ylabel() for a in figure.axes) for unit in ("(km)", "(m/s)", "(m)"))


def test_films_of_too_little_are_refused(tmp_path: Path) -> None:
    run = ss.simulate(patch(nodes=32, length=2e4), 3.0, frames=10)
    for between in ((5.0, 6.0), (1.0, 1.01)):
        with pytest.raises(ss.InputError, match="at least 2 frames, of a run from 0 to 3"):
            run.plot.animation(tmp_path / "fault.gif", *between)
    with pytest.raises(ss.InputError, match=r"fault\.avi: the name must end in \.gif"):
        run.plot.animation(tmp_path / "fault.avi")
    assert list(tmp_path.iterdir()) == []
