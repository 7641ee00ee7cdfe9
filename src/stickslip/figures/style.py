"""One look for every figure: colours, sizes, and axis labels that carry their units.

Every figure module has `data(...)`, which returns an xarray.Dataset in SI, and `draw(dataset)`, which draws exactly that: what
is published beside a figure is what was drawn.
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

from stickslip import YEAR

P = ParamSpec("P")
T = TypeVar("T")

# Okabe & Ito: told apart with any colour vision, and in grey by lightness.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
INK, GREY, PALE = "#222222", "#7A7A7A", "#D9D9D9"

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
    # the same input gives the same bytes: no random identifiers
    "svg.hashsalt": "stickslip",
}

# SI units that are shown under a larger name: (name, how many SI units it holds)
SHOWN = {"Pa": ("MPa", 1e6), "N": ("TN", 1e12)}


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Run a drawing function under the package's style, and leave the user's settings alone."""

    @wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return inside


def panels(rows: int, columns: int, size: tuple[float, float], **options: Any) -> tuple[Figure, NDArray[Any]]:
    """A figure (size in inches) with a grid of axes; always a 2-D array of them."""
    figure = Figure(figsize=size, layout="constrained")
    axes: NDArray[Any] = figure.subplots(rows, columns, squeeze=False, **options)
    return figure, axes


def quantity(dims: str | Sequence[str], values: Any, name: str, symbol: str, units: str) -> xr.Variable:
    """A variable of a figure's dataset: name, symbol (mathtext, no dollars) and SI units travel with the numbers."""
    return xr.Variable(dims, values, {"long_name": name, "symbol": symbol, "units": units})


def shown(variable: xr.DataArray) -> NDArray[np.float64]:
    """The numbers in the unit in which they are drawn."""
    _, size = SHOWN.get(variable.attrs["units"], ("", 1.0))
    return np.asarray(variable.values, dtype=float) / size


def label(variable: xr.DataArray) -> str:
    """Axis label: name, symbol and unit, as in "slip rate v (m/s)"."""
    units = variable.attrs["units"]
    unit, _ = SHOWN.get(units, (units, 1.0))
    text = f"{variable.attrs['long_name']} ${variable.attrs['symbol']}$"
    return text if unit == "1" else f"{text} ({unit})"


def readable(largest: float, units: str) -> tuple[str, float]:
    """Unit and its size in which a stress or force of this size (in Pa or N) has one to three digits before the point."""
    prefixes = {1e12: "T", 1e9: "G", 1e6: "M", 1e3: "k"}
    size = next((size for size in prefixes if largest >= size), 1.0)
    return prefixes.get(size, "") + units, size


def time_unit(span: float) -> tuple[str, float]:
    """Unit and its size (s) in which times over a span (s) are readable."""
    units = {"year": YEAR, "day": 86_400.0, "s": 1.0, "ms": 1e-3}
    return next(((name, size) for name, size in units.items() if span > 0.5 * size), ("µs", 1e-6))


def letter(axes: Axes, text: str) -> None:
    """Title of a panel: its letter and what it shows."""
    axes.set_title(text, pad=6)


def zero_line(axes: Axes) -> None:
    """A faint line at zero where zero means something."""
    axes.axhline(0.0, color=PALE, linewidth=0.8, zorder=0)
