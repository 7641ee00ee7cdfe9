"""The common look of all figures: colours, sizes, and axis labels that carry their units.

Most figure modules have two functions: `data(...)` returns an xarray.Dataset in SI units, and `draw(dataset)` draws exactly that
dataset. The data published beside a figure are therefore the data that were drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip.foundation.constants import YEAR

P = ParamSpec("P")
T = TypeVar("T")

# The palette of Okabe & Ito: readers with any colour vision can tell these colours apart, and in grey they differ in lightness.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
# Neutral colours for text and lines, for secondary marks, and for areas without a value.
INK, GREY, PALE = "#222222", "#7A7A7A", "#D9D9D9"

# Settings of matplotlib under which `styled` functions draw.
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 9.0,
    "mathtext.fontset": "dejavusans",
    "axes.titlesize": 9.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.labelsize": 9.0,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "lines.linewidth": 1.5,
    "lines.solid_capstyle": "round",
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "figure.facecolor": "white",
    "savefig.dpi": 200,
    # A fixed salt replaces random identifiers, so that the same input gives the same bytes.
    "svg.hashsalt": "stickslip",
}

# Some SI units are shown as a larger unit: its name, and its size in SI units.
SHOWN = {"Pa": ("MPa", 1e6), "N": ("TN", 1e12)}


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a drawing function so that it runs under the package's style and leaves the user's settings unchanged."""

    @wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return inside


def panels(rows: int, columns: int, size: tuple[float, float], **options: Any) -> tuple[Figure, NDArray[Any]]:
    """Return a new figure (size in inches) and its grid of axes, always as a 2-D array."""
    figure = Figure(figsize=size, layout="constrained")
    axes: NDArray[Any] = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, axes


def quantity(dims: str | Sequence[str], values: Any, name: str, symbol: str, units: str) -> xr.Variable:
    """Return a variable of a figure's dataset that carries its name, its symbol (mathtext without dollar signs) and its SI unit."""
    return xr.Variable(dims, values, {"long_name": name, "symbol": symbol, "units": units})


def shown(variable: xr.DataArray) -> NDArray[np.float64]:
    """Return the values in the unit in which they are drawn."""
    _, size = SHOWN.get(variable.attrs["units"], ("", 1.0))
    return np.asarray(variable.values, dtype=float) / size


def label(variable: xr.DataArray) -> str:
    """Return the axis label with name, symbol and unit, as in "slip rate v (m/s)"."""
    units = variable.attrs["units"]
    unit, _ = SHOWN.get(units, (units, 1.0))
    text = f"{variable.attrs['long_name']} ${variable.attrs['symbol']}$"
    return text if unit == "1" else f"{text} ({unit})"


def readable(largest: float, units: str) -> tuple[str, float]:
    """Return a readable unit (name, size in SI units) for a stress or force whose largest value, in Pa or N, is given.

    The unit is the largest of tera, giga, mega, kilo and the plain unit that does not exceed the value, or the plain one.
    """
    prefixes = {1e12: "T", 1e9: "G", 1e6: "M", 1e3: "k"}
    size = next((size for size in prefixes if largest >= size), 1.0)
    return prefixes.get(size, "") + units, size


def time_unit(span: float) -> tuple[str, float]:
    """Return the unit (name, size in s) in which times over the given span (s) are readable."""
    units = {"year": YEAR, "day": 86_400.0, "s": 1.0, "ms": 1e-3}
    return next(((name, size) for name, size in units.items() if span > 0.5 * size), ("µs", 1e-6))


def length_unit(length: float) -> tuple[str, float]:
    """Return the unit (name, size in m) in which lengths up to the given one (m) are readable."""
    units = {"km": 1e3, "m": 1.0, "mm": 1e-3, "µm": 1e-6}
    return next(((name, size) for name, size in units.items() if length > 0.5 * size), ("nm", 1e-9))


def letter(axes: Axes, text: str) -> None:
    """Set the title of a panel: its letter and what it shows."""
    axes.set_title(text, pad=6)


def zero_line(axes: Axes) -> None:
    """Draw a faint horizontal line at zero, for quantities whose zero has a meaning."""
    axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)
