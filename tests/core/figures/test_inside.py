"""Figures and animations of the slab's inside show what the field says, where they say, in units."""

from __future__ import annotations

import importlib.util
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.animation import FFMpegWriter
from matplotlib.figure import Figure
from PIL import Image

import stickslip as ss
from stickslip.figures.runs import animation, inside
from tests.core.figures.legible import BLOCK_PROBLEM, SIZES, SLAB, SLAB_PROBLEM, labels

ROUND = SLAB.two_way_time
PULSES = ss.load_scenario("fig5-slab-reconstructed")
LABORATORY = ss.load_scenario("cycles-slab")
NEEDS_FFMPEG = pytest.mark.skipif(
    importlib.util.find_spec("imageio_ffmpeg") is None and shutil.which("ffmpeg") is None, reason="needs ffmpeg"
)


@pytest.fixture(scope="module")
def run() -> ss.Solution:
    return ss.simulate(SLAB_PROBLEM, 12.0)


def without_unit(figure: Figure) -> list[str]:
    """Labels that do not say their unit."""
    return [text for text in labels(figure) if not any(f"({unit})" in text for unit in SIZES)]


# ---- space and time ------------------------------------------------------------------------------------------------------------


@pytest.mark.usefixtures("coarse")
def test_images_are_means_over_their_cells(run: ss.Solution) -> None:
    """Where no front passes, the field in the middle: relative 1e-9. In all, they sum to what the contact slipped: 1e-12."""
    dataset = inside.space_time_data(run)
    time, x = dataset.time.values, dataset.x.values
    field = run.field(x, time[:, None])
    near = np.abs((time[:, None] - x / SLAB.wave_speed) / ROUND % 1.0)
    coming = np.abs((time[:, None] + x / SLAB.wave_speed) / ROUND % 1.0)
    smooth = (np.minimum(near, 1.0 - near) > 0.01) & (np.minimum(coming, 1.0 - coming) > 0.01)
    assert smooth.mean() > 0.9
    assert np.abs(dataset.velocity.values - field.velocity)[smooth].max() < 1e-9 * np.abs(field.velocity).max()
    assert np.abs(dataset.stress.values - field.stress)[smooth].max() < 1e-9 * np.abs(field.stress).max()
    step = time[1] - time[0]
    passed = run.field(x, 12.0).displacement - run.field(x, 0.0).displacement
    assert dataset.velocity.values.sum(axis=0) * step == pytest.approx(passed, rel=1e-12, abs=1e-12)


@pytest.mark.slow
def test_no_pulse_falls_between_the_columns() -> None:
    """Pulses of 20 ms in columns of 13 ms: each column of the image has the slip of its time; samples do not (1e-2)."""
    run = ss.simulate(PULSES)
    dataset = inside.space_time_data(run)
    step, x = float(dataset.time[1] - dataset.time[0]), float(dataset.x[0])
    passed = np.diff(run.field(x, dataset.time.values[:-1] + 0.5 * step).displacement)
    columns = dataset.velocity.values[:, 0] * step
    assert columns[1:-1] == pytest.approx(passed, rel=0.0, abs=1e-12)
    whole = float(np.diff(run.field(x, [0.0, 12.0]).displacement)[0])
    assert columns.sum() == pytest.approx(whole, rel=1e-12, abs=0.0)
    sampled = float(run.field(x, dataset.time.values).velocity.sum()) * step
    assert abs(sampled / whole - 1.0) > 1e-2


@pytest.mark.usefixtures("coarse")
def test_characteristics_leave_with_shocks_and_bounce(run: ss.Solution) -> None:
    """One zigzag: the second shock is the echo of the first; h/c from side to side, relative 1e-12."""
    dataset = inside.space_time_data(run)
    assert dataset.front_time.shape == (1, 6)
    assert dataset.front_time.values[0] == pytest.approx(0.5 * ROUND * np.arange(6), rel=1e-12, abs=1e-12)
    assert dataset.front_x.values.tolist() == [0.0, 1e4] * 3


@pytest.mark.usefixtures("coarse")
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize(("driver", "corners"), [(1.0, 2), (0.98, 2), (0.0, 5)])
def test_characteristics_end_where_the_driver_lets_them_out(driver: float, corners: int) -> None:
    """A matched driver swallows a wave whole, a nearly matched one all but a hundredth, a dead load nothing."""
    slab = replace(SLAB, driver_impedance=driver * SLAB.impedance)
    run = ss.simulate(replace(SLAB_PROBLEM, body=slab), 1.9 * ROUND)
    dataset = inside.space_time_data(run)
    assert int(np.isfinite(dataset.front_time.values[0]).sum()) == corners


@pytest.mark.usefixtures("coarse")
def test_too_many_characteristics_are_not_drawn() -> None:
    critical = ss.load_scenario("fig7-slab-critical").problem
    run = ss.simulate(critical, 94_300.0)
    assert run.shocks.time.between(93_900.0, 94_300.0).sum() > 60
    assert inside.space_time_data(run, 93_900.0, 94_300.0).sizes["front"] == 0


@pytest.mark.usefixtures("coarse")
def test_a_long_run_is_shown_around_an_event() -> None:
    """In local time, from a quarter of a round trip before it to a round trip behind it; what is asked for wins."""
    run = ss.simulate(SLAB_PROBLEM, 480 * ss.YEAR)
    dataset = inside.space_time_data(run)
    step = float(dataset.time[1] - dataset.time[0])
    assert float(dataset.time[0]) - 0.5 * step == pytest.approx(-0.25 * ROUND, rel=1e-12, abs=0.0)
    assert float(dataset.time[-1]) + 0.5 * step == pytest.approx(2.1 * ROUND, rel=1e-12, abs=0.0)
    assert dataset.attrs["clock"] == "time since the event began"
    assert dataset.front_time.values[0, :2] == pytest.approx([0.0, 0.5 * ROUND], rel=1e-12, abs=1e-12)
    asked = inside.space_time_data(run, 0.0, 3.0)
    assert asked.attrs["clock"] == "time $t$"
    assert float(asked.contact_time[-1]) == 3.0


@pytest.mark.usefixtures("coarse")
@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", ["rate law", "pulses", "laboratory"])
def test_space_time_has_units_and_all_of_the_slab(name: str, run: ss.Solution) -> None:
    shown = {"rate law": run, "pulses": ss.simulate(PULSES), "laboratory": ss.simulate(LABORATORY)}[name]
    figure = shown.plot.field()
    assert len(figure.axes) == 6  # with two colour bars
    assert without_unit(figure) == []
    height = "(mm)" if name == "laboratory" else "(km)"
    assert all(axes.get_ylabel().endswith(f"$x$ {height}") for axes in figure.axes[:2])
    assert [axes.get_ylim()[0] for axes in figure.axes[:2]] == [0.0, 0.0]  # the contact is below
    assert figure.axes[0].get_ylim()[1] == pytest.approx(100.0 if name == "laboratory" else 10.0, rel=1e-12)


# ---- snapshots -----------------------------------------------------------------------------------------------------------------


def test_snapshots_are_the_field(run: ss.Solution) -> None:
    dataset = inside.snapshots_data(run, [1.0, 4.0])
    x = dataset.x.values
    at, start = run.field(x, 4.0), run.field(x, 0.0)
    assert np.array_equal(dataset.velocity[1], at.velocity)
    assert np.array_equal(dataset.stress[1], at.stress)
    assert np.array_equal(dataset.displacement[1], at.displacement - start.displacement)
    figure = run.plot.snapshots([1.0, 4.0])
    assert without_unit(figure) == []
    line = figure.axes[1].lines[1].get_xydata()
    assert np.array_equal(line, np.stack([at.velocity, x / 1e3], axis=1))
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["1", "4"]


def test_snapshots_of_an_event_show_displacement_since_it_began(run: ss.Solution) -> None:
    dataset = inside.snapshots_data(run.window(0))
    assert dataset.displacement.attrs["long_name"] == "displacement since the event began"
    assert 0.0 < float(dataset.time[0]) < float(dataset.time[-1]) < ROUND
    figure = inside.draw_snapshots(dataset)
    assert figure.axes[0].get_xlabel() == "displacement $u$ (m)\nsince the event began"


# ---- animations ----------------------------------------------------------------------------------------------------------------


def test_a_frame_shows_its_moment(run: ss.Solution) -> None:
    dataset = animation.animation_data(run, 0.0, 8.0, frames=9)
    figure = animation.frame(dataset, 3)
    x = dataset.x.values
    profile, stress = (axes.lines[-1].get_xydata() for axes in figure.axes[:2])
    at = run.field(x, 3.0)
    assert profile[:, 0] == pytest.approx(at.displacement - run.field(x, 0.0).displacement, rel=0.0, abs=1e-12)
    assert stress[:, 0] == pytest.approx(at.stress / 1e6, rel=0.0, abs=1e-12)
    assert [float(axes.lines[1].get_xdata()[0]) for axes in figure.axes[3:4]] == [3.0]
    assert figure.axes[0].get_title(loc="left") == "3.000 s"
    assert without_unit(figure) == []


@pytest.mark.slow
def test_a_gif_has_every_frame_and_they_differ(run: ss.Solution, tmp_path: Path) -> None:
    told: list[tuple[int, int]] = []
    path = run.plot.animation(tmp_path / "slab.gif", 0.0, 8.0, frames=5, progress=lambda *news: told.append(news))
    assert told == [(n, 5) for n in range(1, 6)]
    assert [file.name for file in tmp_path.iterdir()] == ["slab.gif"]
    with Image.open(path) as film:
        assert film.n_frames == 5
        assert film.size == (800, 450)
        frames = []
        for n in range(5):
            film.seek(n)
            frames.append(np.asarray(film.convert("L"), float))
    whole = animation.frame(animation.animation_data(run, 0.0, 8.0, frames=5), 2)
    whole.savefig(tmp_path / "frame.png", dpi=100)
    drawn = np.asarray(Image.open(tmp_path / "frame.png").convert("L"), float)
    differences = [float(np.abs(frame - drawn).mean()) for frame in frames]
    assert int(np.argmin(differences)) == 2
    assert differences[2] < 1.0  # of 255, in the mean: the colours of a GIF
    assert differences[3] > 2.0 * differences[2]


@NEEDS_FFMPEG
@pytest.mark.parametrize(("suffix", "begins"), [(".mp4", b"ftyp"), (".webm", b"\x1aE\xdf\xa3")])
def test_videos_have_the_format_of_their_suffix(suffix: str, begins: bytes, run: ss.Solution, tmp_path: Path) -> None:
    path = run.window(0).plot.animation(tmp_path / f"slab{suffix}", frames=4)
    assert begins in path.read_bytes()[:12]
    assert [file.name for file in tmp_path.iterdir()] == [path.name]


def test_a_failure_leaves_no_file(run: ss.Solution, tmp_path: Path) -> None:
    def fail(done: int, frames: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run.plot.animation(tmp_path / "slab.gif", frames=3, progress=fail)
    assert list(tmp_path.iterdir()) == []


def test_impossible_animations_are_refused(run: ss.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(FFMpegWriter, "isAvailable", lambda: False)
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    missing = r"slab\.mp4: MP4 and WebM need ffmpeg \(pip install 'stickslip\[video\]'\); \.gif does not"
    with pytest.raises(ss.InputError, match=missing):
        run.plot.animation(tmp_path / "slab.mp4")
    with pytest.raises(ss.InputError, match=r"slab\.avi: the name must end in \.gif or \.mp4 or \.webm"):
        run.plot.animation(tmp_path / "slab.avi")
    with pytest.raises(ss.InputError, match="at least 2 frames, got 1"):
        run.plot.animation(tmp_path / "slab.gif", frames=1)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("draw", ["field", "snapshots"])
def test_a_block_has_no_inside_to_draw(draw: str) -> None:
    run = ss.simulate(BLOCK_PROBLEM, 2.0)
    with pytest.raises(ss.InputError, match="a block is rigid"):
        getattr(run.plot, draw)()


@pytest.mark.parametrize(
    ("start", "end", "text"),
    [
        (3.0, 3.0, "must end after it starts, at 3 s; got 3 s"),
        (None, -1.0, "must end after it starts, at 0 s; got -1 s"),
        (0.0, 13.0, "times must lie between 0 and the end of the run, 12 s"),
        (-1.0, 3.0, "times must lie between 0"),
    ],
)
def test_times_outside_the_run_are_refused(run: ss.Solution, start: float | None, end: float | None, text: str) -> None:
    for draw in (inside.space_time_data, animation.animation_data):
        with pytest.raises(ss.InputError, match=text):
            draw(run, start, end)


@pytest.mark.slow
def test_characteristics_that_would_cover_the_image_are_left_out(run: ss.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    dataset = inside.space_time_data(run)
    crossings = int(np.isfinite(dataset.front_time.values[:, 1:]).sum())
    for most, shown in ((crossings, True), (crossings - 1, False)):
        monkeypatch.setattr(inside, "MOST_CROSSINGS", most)
        figure = inside.draw_space_time(dataset)
        assert (bool(figure.axes[0].lines), bool(figure.legends)) == (shown, shown)
