"""The common look of all figures: colours, units, and labels that carry their units.

Most figure modules have two functions: `data(...)` returns an xarray.Dataset in SI units, and `draw(dataset)` draws exactly that
dataset. The data published beside a figure are therefore the data that were drawn. The figure that `draw` returns is not known to
pyplot, unless one of pyplot's figures was passed to it: save it with its `savefig`.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from stickslip import YEAR
from stickslip.problem.problem import Problem

if TYPE_CHECKING:
    from stickslip.solution.evaluation import Readings

P = ParamSpec("P")
T = TypeVar("T")
Floats = NDArray[np.float64]

# The palette of Okabe & Ito: readers with any colour vision can tell these colours apart, and in grey they differ in lightness.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
# Neutral colours for text and lines, for secondary marks, and for areas without a value.
INK, GREY, PALE = "#222222", "#7A7A7A", "#D9D9D9"
# Colours of lines, in the order in which they are taken.
LINE_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK)
# Colours of large areas.
LIGHT_BLUE, LIGHT_ORANGE = "#D6E6F4", "#F8D9C4"

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

SHOWN = {"Pa": ("MPa", 1e6), "N": ("TN", 1e12), "m^-1 s": ("s/m", 1.0)}
"""Some SI units are shown under another name, mostly a larger unit: its name, and its size in SI units."""
CURVES = {
    "time": ("time", "t", "s"),
    "slip": ("slip", "u", "m"),
    "event_slip": ("slip in the event", "", "m"),
    "slip_rate": ("slip rate", "v", "m/s"),
    "traction": ("traction", r"\tau", "Pa"),
    "load": ("load", r"\beta", "Pa"),
}
"""Name, symbol and unit of the curves of a run, as `Solution.curve` names them."""
FORCES = {"traction": "friction force", "load": "spring force"}
"""Names of curves that are forces (N), not stresses, on a block."""
FLAT = 0.02
"""Stresses whose range is less than this share of their largest magnitude are drawn as changes: else the line looks flat."""
WIDE = 100.0
"""Positive values that span more than this factor, and counts above this number, are drawn on a logarithmic axis."""


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a drawing function so that it runs under the package's style and leaves the user's settings unchanged."""

    @wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return inside


def image(figure: Figure, kind: str) -> bytes:
    """Return a figure as the bytes of a "png" or "svg" file, the same for the same input: without date and random names."""
    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        figure.savefig(stream, format=kind, metadata={"Date": None} if kind == "svg" else {"Software": None})
    return stream.getvalue()


def quantity(dims: str | Sequence[str], values: Any, name: str, symbol: str, units: str) -> xr.Variable:
    """Return a variable of a figure's dataset that carries its name, its symbol (mathtext without dollar signs) and its SI unit."""
    return xr.Variable(dims, values, {"long_name": name, "symbol": symbol, "units": units})


def curve_quantity(dims: str | Sequence[str], values: Any, curve: str, force_unit: str = "Pa") -> xr.Variable:
    """Return a variable for one of `CURVES`; traction and load are stresses, or forces if `force_unit` is "N"."""
    name, symbol, unit = CURVES[curve]
    if curve in FORCES and force_unit == "N":
        name, unit = FORCES[curve], "N"
    return quantity(dims, values, name, symbol, unit)


def unit_shown(variable: xr.DataArray) -> tuple[str, float]:
    """Return the unit (name, size in SI units) in which a variable is drawn."""
    units = variable.attrs["units"]
    return SHOWN.get(units, (units, 1.0))


def shown(variable: xr.DataArray) -> Floats:
    """Return the values in the unit in which they are drawn."""
    return np.asarray(variable.values, dtype=float) / unit_shown(variable)[1]


def axis_text(name: str, symbol: str, unit: str) -> str:
    """Return the text of an axis from a name, a symbol and a unit, as in "slip rate v (m/s)"."""
    text = f"{name} ${symbol}$" if symbol else name
    return text if unit == "1" else f"{text} ({unit})"


def label(variable: xr.DataArray) -> str:
    """Return the axis label of a variable, in the unit in which it is drawn."""
    return axis_text(variable.attrs["long_name"], variable.attrs.get("symbol", ""), unit_shown(variable)[0])


def curve_label(curve: str, unit: str = "") -> str:
    """Return the axis label of one of `CURVES`, in its own unit or in the one given."""
    name, symbol, own = CURVES[curve]
    return axis_text(name, symbol, unit or own)


def narrow(text: str) -> str:
    """Return a label in two lines, with the unit in the second, for narrow panels."""
    return text if "\n" in text else text.replace(" (", "\n(")


def name_system(body: str, law: str) -> str:
    """Return the title of a figure of one system, from the kinds of its body and its friction law."""
    return f"{body.replace('-', ' ').capitalize()}, {law} friction"


def system_title(problem: Problem) -> str:
    """Return the title of a figure of one problem: its body and its friction law."""
    return name_system(type(problem.body).kind, type(problem.friction).kind)


def clock(readings: Readings) -> str:
    """Return the name of the time axis of a run, or of a window around an event, without its unit."""
    return "time since the event began" if "event_slip" in readings.curves else "time $t$"


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


def nearly_flat(*stresses: Floats) -> bool:
    """Return True if stresses, taken together, vary so little that only their change can be seen in a figure."""
    together = np.concatenate(stresses)
    return bool(np.ptp(together) < FLAT * np.abs(together).max())


def spans_decades(values: Floats) -> bool:
    """Return True if values are positive and span so much that they need a logarithmic axis."""
    return bool(values.min() > 0.0 and values.max() > WIDE * values.min())
