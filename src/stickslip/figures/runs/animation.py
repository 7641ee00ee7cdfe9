"""Film of the slab: displacement and stress across it, beside slip, slip rate and traction of the contact against time."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from stickslip.figures.panels import add_legend, set_title, zero_line
from stickslip.figures.runs.inside import Scales, about, contact_variables, field_variables, places
from stickslip.figures.style import BLUE, GREEN, GREY, INK, VERMILLION, narrow, styled, unit_shown
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import readable_unit, si_unit
from stickslip.solution import choose_interval

if TYPE_CHECKING:
    from stickslip.solution import Readings

FRAMES, PER_SECOND, PLACES, DPI, SIZE = 150, 20, 401, 100, (8.0, 4.5)
"""Defaults of a film: number of frames, frames per second, points across the slab, dots per inch, and size in inches."""
CODECS = {".gif": "", ".mp4": "h264", ".webm": "libvpx-vp9"}
"""Video codec by file suffix; a GIF needs none."""
SUFFIXES = tuple(CODECS)
Told = Callable[[int, int], object]
"""A callback that receives the number of frames drawn so far and the number of all frames."""
Stage = Callable[[Figure], tuple[Callable[[int], None], list[Artist]]]
"""A function that draws a figure, and returns one that moves it to the n-th frame, and the artists that this changes."""


def check_animation(path: Path, where: str) -> None:
    """Raise InputError if a film could not be written under this name; `where` begins the message."""
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{where} {path}: the name must end in {' or '.join(SUFFIXES)}")
    if path.suffix.lower() != ".gif" and _ffmpeg() is None:
        raise InputError(f"{where} {path}: MP4 and WebM need ffmpeg (pip install 'stickslip[video]'); .gif does not")


def _ffmpeg() -> str | None:
    """Return the path of ffmpeg, from the system or from the package imageio-ffmpeg, or None if there is neither."""
    if FFMpegWriter.isAvailable():
        return str(mpl.rcParams["animation.ffmpeg_path"])
    if importlib.util.find_spec("imageio_ffmpeg") is None:
        return None
    from imageio_ffmpeg import get_ffmpeg_exe

    return str(get_ffmpeg_exe())


def animation_data(
    readings: Readings, start: float | None = None, end: float | None = None, frames: int | None = None
) -> xr.Dataset:
    """Return the field at the time of each frame (default 150 frames), and the contact, from `start` to `end` (s), in SI.

    The default interval is that of `choose_interval`. Raises InputError for a block, for times outside the run, and for fewer than
    two frames.
    """
    readings, start, end = choose_interval(readings, start, end)
    frames = FRAMES if frames is None else frames
    if frames < 2:
        raise InputError(f"animation: needs at least 2 frames, got {frames}")
    contents = field_variables(readings, np.linspace(start, end, frames), places(readings, PLACES))
    contents |= contact_variables(readings, start, end, (readings.curves[0], "slip_rate", "traction"))
    return xr.Dataset(contents, attrs=about(readings))


def write(dataset: xr.Dataset, path: str | Path, *, per_second: int = PER_SECOND, progress: Told | None = None) -> Path:
    """Draw every frame, write the file (.gif, .mp4 or .webm), either whole or not at all, and return its path.

    `per_second` is the number of frames per second. Raises InputError for any other suffix, and if the program that writes such
    files is missing.
    """
    return film(lambda figure: _draw_stage(figure, dataset), dataset.sizes["time"], Path(path), per_second, progress)


@styled
def film(stage: Stage, frames: int, path: Path, per_second: int = PER_SECOND, progress: Told | None = None) -> Path:
    """Write a film of any figure: `stage` draws it, and returns what `Stage` says. See `write` for the rest."""
    check_animation(path, "animation:")
    figure = _Film(figsize=SIZE, dpi=DPI, layout="constrained")
    move, moving = stage(figure)
    figure.keep_still(moving)
    codec = CODECS[path.suffix.lower()]
    ffmpeg: Any = {"animation.ffmpeg_path": _ffmpeg()} if codec else {}
    options: Any = {"codec": codec, "extra_args": ["-pix_fmt", "yuv420p"]}
    writer: AbstractMovieWriter = FFMpegWriter(fps=per_second, **options) if codec else PillowWriter(fps=per_second)

    def render(draft: Path) -> None:
        with mpl.rc_context(ffmpeg), writer.saving(figure, str(draft), DPI):
            for n in range(frames):
                move(n)
                writer.grab_frame()
                if progress is not None:
                    progress(n + 1, frames)

    return write_atomically(path, render)


class _Film(Figure):
    """A figure that a movie writer saves frame after frame, and that redraws only the artists that move."""

    def keep_still(self, moving: list[Artist]) -> None:
        """Draw everything but the moving artists, once, and keep the pixels."""
        self._moving = moving
        for artist in moving:
            artist.set_animated(True)
        agg: Any = FigureCanvasAgg(self)
        agg.draw()
        self._agg, self._still = agg, agg.copy_from_bbox(self.bbox)

    def savefig(self, fname: Any, **_: Any) -> None:
        """Write the pixels of the frame in the form that movie writers expect: RGBA, at the resolution of the figure."""
        self._agg.restore_region(self._still)
        for artist in self._moving:
            artist.draw(self._agg.get_renderer())
        fname.write(self._agg.buffer_rgba())


@styled
def frame(dataset: xr.Dataset, n: int) -> Figure:
    """Return the n-th frame as a figure, counted from 0."""
    figure = Figure(figsize=SIZE, layout="constrained")
    move, _ = _draw_stage(figure, dataset)
    move(n)
    return figure


def _draw_stage(figure: Figure, dataset: xr.Dataset) -> tuple[Callable[[int], None], list[Artist]]:
    """Draw the film's panels, as a `Stage`."""
    scales = Scales(dataset)
    axes = figure.subplot_mosaic("ABC;ABD;ABE", width_ratios=(1.0, 1.0, 1.7))
    unit, size = unit_shown(dataset.displacement)
    displacement, stress = dataset.displacement.values / size, scales.stresses(dataset.stress.values)
    lines = [_draw_profile(axes["A"], dataset, displacement, BLUE), _draw_profile(axes["B"], dataset, stress, VERMILLION)]
    axes["A"].set_xlabel(f"{scales.name('displacement')} ({unit})")
    axes["B"].set(xlabel=scales.name_stress(scales.name("stress")), ylabel="")
    axes["B"].tick_params(labelleft=False)
    marks = _draw_contact([axes[name] for name in "CDE"], dataset, scales)
    set_title(figure, dataset.attrs["title"])
    add_legend(axes["A"], [*axes["A"].get_legend_handles_labels()[0], marks[0]])
    clock = axes["A"].set_title(" ")

    def move(n: int) -> None:
        now = float(dataset.time.values[n]) / scales.time
        for line, values in zip(lines, (displacement, stress), strict=True):
            line.set_xdata(values[n])
        for mark in marks:
            mark.set_xdata([now, now])
        clock.set_text(f"{now:.3f} {scales.time_unit}")

    return move, [*lines, *marks, clock]


def _draw_profile(panel: Any, dataset: xr.Dataset, values: np.ndarray, colour: str) -> Any:
    """Set up axes whose limits hold every frame, and return the line that moves; the first frame stays, dotted."""
    scales = Scales(dataset)
    places = dataset.x.values / scales.place
    low, high = float(values.min()), float(values.max())
    margin = 0.05 * (high - low) or 1.0
    panel.set_xlim(low - margin, high + margin)
    scales.set_places(panel)
    panel.axhline(0.0, color=INK, linewidth=3.0, clip_on=False, label="contact")
    panel.plot(values[0], places, color=GREY, linewidth=0.8, linestyle=":", label="first frame")
    (line,) = panel.plot(values[0], places, color=colour)
    return line


def _draw_contact(panels: list[Any], dataset: xr.Dataset, scales: Scales) -> list[Any]:
    """Draw the curves of the contact, and return the vertical lines that mark the present moment in each panel."""
    time, slip = dataset.contact_time.values / scales.time, dataset.contact_slip.values - dataset.contact_slip.values[0]
    unit, size = readable_unit(si_unit("slip", scales.load_unit), slip)
    rate_unit, rate_size = unit_shown(dataset.contact_slip_rate)
    curves = (
        (slip / size, f"{scales.name('slip')} ({unit})", BLUE),
        (dataset.contact_slip_rate.values / rate_size, f"{scales.name('slip_rate')}\n({rate_unit})", GREEN),
        (scales.stresses(dataset.contact_traction.values), narrow(scales.name_stress(scales.name("traction"))), VERMILLION),
    )
    for panel, (values, text, colour) in zip(panels, curves, strict=True):
        panel.plot(time, values, color=colour)
        panel.set(ylabel=text, xlim=time[[0, -1]])
        panel.tick_params(labelbottom=panel is panels[-1])
    marks = [panel.axvline(time[0], color=INK, linewidth=0.8, label="time of the frame") for panel in panels]
    zero_line(panels[1])
    panels[-1].set_xlabel(scales.clock)
    return marks
