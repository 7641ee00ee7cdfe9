"""Figures, files and reports: where a run, or a study, uses the packages above it.

`solution.plot()` draws the default figure and `solution.plot.energy()`, `.field()` ... draw others; `to_dataset`, `to_netcdf`,
`to_scec` hands a run to other tools. Each imports what it needs when it is called.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, Literal, TypeVar, Unpack, cast

import numpy as np
from numpy.typing import ArrayLike

from stickslip.foundation.arguments import NamesAttributes, as_path
from stickslip.foundation.errors import InputError
from stickslip.problem import in_given_units
from stickslip.solution.evaluation import Curve, Readings

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from stickslip.foundation.place import Place

MOST_VALUES = 20_000_000
"""Largest number of times multiplied by places in one dataset; each value takes up to 0.5 kB of memory while it is computed."""

Run = TypeVar("Run", bound=Readings)
T = TypeVar("T")


class Plots(NamesAttributes, Generic[Run]):
    """Figures of a run, or of a window on it: `solution.plot()` draws the default one, `solution.plot.energy()` the energies.

    Methods with `start` and `end` draw between these times (s); the default is the whole run, or what the window shows. All but
    `animation` take these keywords, too:

    - `ax`: axes to draw in, for figures of one panel; `figure`: an empty figure to draw in, for all.
    - `size`: width and height in inches, a text such as "16 x 10 cm", "single column" or "double column".
    - `dpi`: dots per inch.

    They return a `matplotlib.figure.Figure`, or the axes if `ax` was given. A new figure belongs to pyplot: a notebook shows it
    once, `pyplot.show()` shows it in a window, and `figure.savefig(...)` saves it.
    """

    def __init__(self, run: Run) -> None:
        self._run = run

    if not TYPE_CHECKING:  # with it, type checkers would accept any figure

        def __getattr__(self, name: str) -> Any:
            """Return the figure of this name that an extension adds to results of this class."""
            from stickslip.extension import figures_of

            if name.startswith("_") or name not in (added := figures_of(type(self._run))):
                return super().__getattr__(name)
            return partial(in_given_units(_drawn), self, added[name])

    def __dir__(self) -> list[str]:
        """Return the figures with those that extensions add."""
        from stickslip.extension import figures_of

        return [*super().__dir__(), *figures_of(type(self._run))]

    @in_given_units
    def __call__(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure:
        """Draw slip, slip rate, traction and load against time.

        If the friction law never sticks, friction is drawn as a coefficient, against time and against slip.
        """
        from stickslip.figures.runs import run

        return known_to_pyplot(run.draw_run(self._run, start, end, **place), place)

    def slip(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the slip against time; in a window, the slip since the event began."""
        return self._curve(self._run.curves[0], start, end, place)

    def slip_rate(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the slip rate against time."""
        return self._curve("slip_rate", start, end, place)

    def traction(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the friction on the contact against time."""
        return self._curve("traction", start, end, place)

    def load(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the load on the contact against time."""
        return self._curve("load", start, end, place)

    def state(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the state variable of the friction law against time. Raises InputError if the law has none."""
        return self._curve("state", start, end, place)

    def second_state(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw the second state variable of a law with two, as `state` draws the first."""
        return self._curve("second_state", start, end, place)

    @in_given_units
    def _curve(self, name: Curve, start: float | None, end: float | None, place: Place) -> Figure | Axes:
        from stickslip.figures.runs import curves

        return known_to_pyplot(curves.draw_alone(self._run, name, start, end, **place), place)

    @in_given_units
    def friction(
        self,
        start: float | None = None,
        end: float | None = None,
        against: Literal["slip", "slip_rate"] = "slip",
        **place: Unpack[Place],
    ) -> Figure | Axes:
        """Draw the friction coefficient against slip, as papers on laboratory friction do, or against slip rate."""
        from stickslip.figures.runs import curves

        return known_to_pyplot(curves.draw_friction_alone(self._run, start, end, against, **place), place)

    @in_given_units
    def field(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure:
        """Draw velocity and stress in the slab over time, with characteristics, above the curves of the contact.

        The default for a long run is the last of its largest slip events. Raises InputError for a block.
        """
        from stickslip.figures.runs import inside

        return known_to_pyplot(inside.draw_space_time(inside.space_time_data(self._run, start, end), **place), place)

    @in_given_units
    def snapshots(self, t: ArrayLike | None = None, **place: Unpack[Place]) -> Figure:
        """Draw displacement, velocity and stress across the slab at times (s), by default six over one round trip of the waves.

        Raises InputError for a block.
        """
        from stickslip.figures.runs import inside

        return known_to_pyplot(inside.draw_snapshots(inside.snapshots_data(self._run, t), **place), place)

    @in_given_units
    def energy(self, start: float | None = None, end: float | None = None, **place: Unpack[Place]) -> Figure | Axes:
        """Draw elastic and kinetic energy, friction heat, radiated and damped energy, stacked over time, and their total.

        The default for a long run is the last of its largest slip events.
        """
        from stickslip.figures.runs import energy

        return known_to_pyplot(energy.draw_energy(energy.energy_data(self._run, start, end), **place), place)

    @in_given_units
    def animation(
        self,
        path: str | Path,
        start: float | None = None,
        end: float | None = None,
        *,
        frames: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Path:
        """Write an animation of the slab, beside the curves of the contact, to a .gif, .mp4 or .webm, and return the path.

        The last two need ffmpeg. The animation shows the times from `start` to `end` (s; by default those of `field`) in 150
        `frames`, unless another number is given, 20 per second. `progress` is called with the number of finished frames and the
        number of all frames. Raises InputError for a block, for fewer than two frames, and if the software that writes such a file
        is missing.
        """
        from stickslip.figures.runs import animation

        animation.check_animation(Path(path), "animation:")
        return animation.write(animation.animation_data(self._run, start, end, frames), path, progress=progress)


def _drawn(plots: Plots[Any], draw: Callable[..., T], *given: Any, **place: Any) -> T:
    """Draw a figure that an extension adds, as the methods of `Plots` draw theirs."""
    return known_to_pyplot(draw(plots._run, *given, **place), cast("Place", place))


class Exports(Readings):
    """A run, or a window on it, that draws itself and hands itself to other tools."""

    @property
    def plot(self) -> Plots[Any]:
        """The figures: `plot()` draws the default one, `plot.energy()`, `plot.field()` ... draw others."""
        return Plots(self)

    def to_dataset(self, t: ArrayLike, x: ArrayLike | None = None) -> xr.Dataset:
        """Return slip, slip rate, traction and load at given times (s), with units and provenance.

        With distances `x` from the contact (m) the dataset also holds displacement, velocity and stress inside the slab, over time
        and x. In a window the slip counts from the start of the event, and attributes hold the epoch. Raises InputError for more
        than 2e7 values of a quantity.
        """
        from stickslip.solution.files.netcdf import to_dataset

        check_size(t, x)
        return to_dataset(self, t, x)

    def to_csv(self, path: str | Path, **evenly: Any) -> Path:
        """Write time, slip, slip rate, load, traction and states at evenly spaced times as CSV, and return the path.

        The headings name the units (SI). There are 1001 times from `start` to `end` (s; by default those of a figure), unless
        `points` or `sampling_rate` (Hz) says otherwise; with `antialias` the curves are low-passed to half that rate. A path that
        ends in .nc makes a netCDF file. See `stickslip.solution.files.curves.write_curves`.
        """
        from stickslip.solution.files.curves import write_curves

        return write_curves(self, as_path("to_csv: path", path), **evenly)

    def to_scec(self, path: str | Path, sampling_rate: float, **options: Any) -> Path:
        """Write time, slip, slip rate and shear stress at a sampling rate (Hz) as SCEC's on-fault time series, and return the path.

        The options are those of `stickslip.solution.files.scec.write_scec`.
        """
        from stickslip.solution.files.scec import write_scec

        return write_scec(self, path, sampling_rate, **options)


def known_to_pyplot(drawn: T, place: Place) -> T:
    """Return what was drawn; if it is a figure of its own, pyplot knows and shows it from now on."""
    from stickslip.figures import sheet

    return sheet.known_to_pyplot(drawn, place)


def check_size(t: ArrayLike, x: ArrayLike | None) -> None:
    """Raise InputError if a dataset is larger than the memory of most machines."""
    wanted = np.size(t) * (1 if x is None else np.size(x))
    if wanted > MOST_VALUES:
        raise InputError(f"to_dataset: {wanted:.3g} values are too many: take fewer times or places (at most {MOST_VALUES:.0e})")
