"""The common look of all figures: colours, units, and labels that carry their units.

Most figure modules have two functions: `energy_data(...)`, say, returns an xarray.Dataset in SI units, and
`draw_energy(dataset, **place)` draws just that dataset. The data published beside a figure are therefore the data that were drawn.

Rules that all figures follow:

1. **Place.** Every function that draws takes the keywords of `Place` (ax, figure, size, dpi) and begins with
   `sheet(usual size, **place)`, or with `one_panel(usual size, **place)` for a figure of one panel, which ends with
   `return panels.finish(axes, title, **place)`. It returns the figure, or the axes if `ax` was given. It never calls pyplot
   itself; a method for users returns `known_to_pyplot(draw_energy(dataset, **place), place)`.
2. **Titles.** `panels.set_title(figure, title)` with the title of the scenario; problems from Python have none, and neither have
   axes of the user. No names of classes or of laws.
3. **Letters.** Several panels have letters, `panels.letter_panels(axes, texts)`: "(a) text" above the panel, at its left end. A
   figure of one panel has no letter.
4. **Units.** `readable_unit(unit, *values)` alone chooses a readable unit, from all values that share an axis; the values are
   divided by its size. Panels that show the same quantity share the unit too. `label` and `curve_label` name quantity, symbol and
   unit, as `foundation.names` has them.
5. **Parameters** have the words and the symbol of their declared meaning (`names.parameter_name`) and their unit.
6. **Legends.** Every line, band, marker and colour is explained in the figure, in a key (`panels.add_legend`) or by a text beside
   it. A panel without data is left out.
"""

from __future__ import annotations

import io
import textwrap
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import wraps
from typing import TYPE_CHECKING, Any, NamedTuple, ParamSpec, TypeVar

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import display_name
from stickslip.foundation.names import QUANTITIES, for_readers, name_of, readable_unit, si_unit
from stickslip.foundation.units import si_factor

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.solution import Readings

P = ParamSpec("P")
T = TypeVar("T")

# The palette of Okabe & Ito: readers with any colour vision can tell these colours apart, and in grey they differ in lightness.
BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"
# Neutral colours for text and lines, for secondary marks, and for areas without a value.
INK, GREY, PALE = "#222222", "#7A7A7A", "#D9D9D9"
# Colours of lines, in the order in which they are taken.
LINE_COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, INK)
# Colour of large areas.
LIGHT_BLUE = "#D6E6F4"
# Colours of areas of two kinds: no and yes, regular and irregular.
TWO = (LIGHT_BLUE, ORANGE)

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

FLAT = 0.02
"""Stresses whose range is less than this share of their largest magnitude are drawn as changes: else the line looks flat."""
SPAN_OF_LOGARITHM = 100.0
"""Positive values that span more than this factor, and counts above this number, are drawn on a logarithmic axis."""


ROOM = 42
"""Number of letters in a line of the name of an axis, a key or a scale."""


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a drawing function so that it runs under the package's style and leaves the user's settings unchanged."""

    @wraps(function)
    def inside(*args: P.args, **kwargs: P.kwargs) -> T:
        with mpl.rc_context(STYLE):
            return function(*args, **kwargs)

    return inside


def image(figure: Figure, kind: str, dpi: float | None = None) -> bytes:
    """Return a figure as the bytes of a "png" or "svg" file, the same for the same input: without date and random names."""
    stream = io.BytesIO()
    with mpl.rc_context(STYLE):
        about = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(stream, format=kind, metadata=about, dpi=mpl.rcParams["savefig.dpi"] if dpi is None else dpi)
    return stream.getvalue()


class Numbers(NamedTuple):
    """Numbers with their attributes, to be drawn like a variable of xarray, but without its import."""

    values: Floats
    attrs: dict[str, Any]


def quantity(dims: str | Sequence[str], values: Any, name: str, symbol: str, units: str) -> xr.Variable:
    """Return a variable of a figure's dataset that carries its name, its symbol (mathtext without dollar signs) and its SI unit."""
    import xarray as xr  # takes as long as drawing: figures that have `Numbers` do without it

    return xr.Variable(dims, values, {"long_name": name, "symbol": symbol, "units": units})


def curve_quantity(dims: str | Sequence[str], values: Any, curve: str, load_unit: str = "Pa") -> xr.Variable:
    """Return a variable for one of `foundation.names.QUANTITIES`, of a body whose loads have the unit given."""
    return quantity(dims, values, name_of(curve, load_unit), QUANTITIES[curve].symbol, si_unit(curve, load_unit))


def readable(variable: Any, *values: Any, log: bool = False) -> tuple[str, float]:
    """Return the unit (name, size in SI units) in which a variable is readable: that in which it was given, if any."""
    si, given = str(variable.attrs.get("units", "1")), str(variable.attrs.get("shown_in", ""))
    if given:
        with suppress(InputError):  # from a file of anybody
            return display_name(given, si), float(si_factor(given, si))
    return readable_unit(si, *values, log=log)


def unit_shown(*variables: xr.DataArray | Numbers) -> tuple[str, float]:
    """Return the unit (name, size in SI units) in which variables that share an axis are drawn."""
    return readable(variables[0], *(variable.values for variable in variables))


def shown(variable: xr.DataArray | Numbers, unit: tuple[str, float] | None = None) -> Floats:
    """Return the values in the unit (name, size) given, or in the one that suits them."""
    return np.asarray(variable.values, dtype=float) / (unit or unit_shown(variable))[1]


def axis_text(name: str, symbol: str, unit: str) -> str:
    """Return the text of an axis from a name, a symbol and a unit, as in "slip rate v (m/s)"."""
    text = f"{name} ${symbol}$" if symbol else name
    return text if unit == "1" else f"{text} ({for_readers(unit)})"


def label(variable: xr.DataArray | Numbers, unit: tuple[str, float] | None = None) -> str:
    """Return the axis label of a variable, in the unit (name, size) given, or in the one that suits its values."""
    return axis_text(variable.attrs["long_name"], variable.attrs.get("symbol", ""), (unit or unit_shown(variable))[0])


def curve_label(curve: str, unit: str = "", load_unit: str = "Pa") -> str:
    """Return the axis label of one of `foundation.names.QUANTITIES`, in its SI unit or in the unit given."""
    return axis_text(name_of(curve, load_unit), QUANTITIES[curve].symbol, unit or si_unit(curve, load_unit))


def folded(text: str, room: int = ROOM) -> str:
    """Return a text in lines of up to `room` letters; a symbol and the unit stay with the last word."""
    whole = text.replace(" $", "\0$").replace(" (", "\0(")
    return textwrap.fill(whole, room, break_long_words=False, break_on_hyphens=False).replace("\0", " ")


def narrow(text: str) -> str:
    """Return a label in two lines, with the unit in the second, for narrow panels."""
    return text if "\n" in text else text.replace(" (", "\n(")


def title_of(readings: Readings) -> str:
    """Return the title of a figure of one run: its scenario's title, or "" for a problem from Python."""
    return readings.title


def clock(readings: Readings) -> str:
    """Return the name of the time axis of a run, or of a window around an event, without its unit."""
    return "time since the event began" if "event_slip" in readings.curves else "time $t$"


def time_unit(span: float) -> tuple[str, float]:
    """Return the unit (name, size in s) in which times over the given span (s) are readable."""
    return readable_unit("s", span)


def nearly_flat(*stresses: Floats) -> bool:
    """Return True if stresses, taken together, vary so little that only their change can be seen in a figure."""
    together = np.concatenate(stresses)
    return bool(np.ptp(together) < FLAT * np.abs(together).max())


def spans_decades(values: Floats) -> bool:
    """Return True if values are positive and span so much that they need a logarithmic axis."""
    return bool(values.min() > 0.0 and values.max() > SPAN_OF_LOGARITHM * values.min())
