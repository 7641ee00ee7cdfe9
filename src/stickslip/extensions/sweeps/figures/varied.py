"""Axes of the figure of a sweep: varied keys in readable units, on a logarithmic axis if their values are spread that way."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.figures.names import parameter_name, plain_name, symbol
from stickslip.figures.panels import cell_edges, set_log_ticks
from stickslip.figures.style import ROOM, axis_text, folded, readable, spans_decades
from stickslip.foundation.arrays import Floats
from stickslip.foundation.names import readable_unit

SPREAD = 3.0
"""Values that span less than this factor are drawn on a linear axis: the two spreads could not be told apart."""
LITTLE = 26
"""The same for one of several panels side by side."""
CROWDED = 34
"""If the words along a horizontal axis have more letters than this together, they are slanted."""


@dataclass(frozen=True)
class ScaledNumbers:
    """Numbers as they are drawn, in a unit of `size` SI units; words are placed at 0, 1, 2, ...

    `room` is the number of letters in a line of the label.
    """

    values: Floats
    label: str
    size: float = 1.0
    log: bool = False
    words: tuple[str, ...] = ()
    room: int = ROOM

    @property
    def edges(self) -> Floats:
        """The edges of areas around ascending values, which end at the first and the last of them; words have whole areas."""
        if self.words or len(self.values) == 1:
            return np.append(self.values - 0.5, self.values[-1] + 0.5)
        return cell_edges(self.values, log=self.log)

    def show(self, axes: Axes, which: str) -> None:
        """Set label, scale and ticks of the axis named "x" or "y"."""
        axis = getattr(axes, f"{which}axis")
        axis.set_label_text(folded(self.label, self.room))
        if self.log:
            getattr(axes, f"set_{which}scale")("log")
            set_log_ticks(axes, which)
        if self.words:
            axis.set_ticks(range(len(self.words)), self.words)
            getattr(axes, f"set_{which}lim")(-0.5, len(self.words) - 0.5)
            if which == "x" and sum(len(word) for word in self.words) * ROOM > CROWDED * self.room:
                axis.set_ticks(axis.get_ticklocs(), self.words, rotation=30, ha="right", rotation_mode="anchor")


def scaled(variable: xr.DataArray) -> ScaledNumbers:
    """Return a varied key in a readable unit, on a logarithmic axis if ":log" asked for it or its values are so spread."""
    name = parameter_name(str(variable.name), variable.attrs.get("long_name", ""))
    if not np.issubdtype(variable.dtype, np.number):
        given = [str(word) for word in variable.values.tolist()]
        words = tuple(dict.fromkeys(given if variable.name in variable.dims else sorted(given)))  # samples are in no order
        return ScaledNumbers(np.array([words.index(word) for word in given], float), name, words=words)
    values = np.asarray(variable.values, float)
    log = bool(variable.attrs.get("log")) or is_logarithmic(values)
    unit, size = readable(variable, values, log=log)
    return ScaledNumbers(values / size, axis_text(name, "", unit), size, log)


def is_logarithmic(values: Floats) -> bool:
    """Return True if values are positive and their median lies nearer to the middle in the logarithm than on a linear scale."""
    known = values[np.isfinite(values)]
    if known.size < 3 or known.min() <= 0.0 or known.max() < SPREAD * known.min():
        return False
    low, middle, high = (float(value) for value in (known.min(), np.median(known), known.max()))
    linear, log = (middle - low) / (high - low), np.log(middle / low) / np.log(high / low)
    return abs(float(log) - 0.5) < abs(linear - 0.5)


@dataclass(frozen=True)
class Names:
    """The names of a varied key that has one value in each panel or for each curve."""

    full: str
    plain: str
    symbol: str
    values: tuple[str, ...]

    @property
    def equations(self) -> tuple[str, ...]:
        """The values, each as an equation if the key has a symbol, as in "$h$ = 12.5 km"."""
        return tuple(f"{self.symbol} = {value}" if self.symbol else value for value in self.values)


def names_of(variable: xr.DataArray) -> Names:
    """Return the names of a varied key, and its values as texts in one unit."""
    about = str(variable.name), str(variable.attrs.get("long_name", ""))
    if not np.issubdtype(variable.dtype, np.number):
        values = [str(value) for value in variable.values.tolist()]
    else:
        unit, size = readable(variable, variable.values)
        values = [f"{value:.4g}" + ("" if unit == "1" else f" {unit}") for value in variable.values / size]
    return Names(parameter_name(*about), plain_name(*about), symbol(*about), tuple(values))


@dataclass(frozen=True)
class ShownQuantity:
    """A quantity as it is drawn: its numbers (NaN if there is none), the state of each member, and a title with the unit."""

    values: xr.DataArray
    state: xr.DataArray
    title: str
    is_flag: bool
    ends: tuple[str, ...] = ()
    """Words for 0 and 1, of a share; none of any other quantity."""
    line: tuple[float, str] | None = None
    """A number at which a line is drawn, as the values are scaled, and what lies there."""

    @property
    def known(self) -> Floats:
        """The finite numbers, in one dimension."""
        return np.asarray(self.values.values[np.isfinite(self.values.values)], float)

    @property
    def is_whole(self) -> bool:
        """True if all numbers are whole, as counts are."""
        return bool((self.known == np.rint(self.known)).all())

    @property
    def is_wide(self) -> bool:
        """True if the numbers are to be drawn on a logarithmic scale."""
        known = self.known
        return known.size > 0 and spans_decades(known)

    def has(self, state: int) -> bool:
        """Return True if some member is in this state."""
        return bool((self.state == state).any())

    def at(self, **places: int) -> ShownQuantity:
        """Return the quantity at these places of some of its keys."""
        return replace(self, values=self.values.isel(places), state=self.state.isel(places))


def shown(dataset: xr.Dataset) -> ShownQuantity:
    """Return the quantity of a figure's dataset in a readable unit."""
    values = dataset[dataset.attrs["quantity"]]
    known = values.values[np.isfinite(values.values)]
    wide = known.size > 0 and spans_decades(known)
    unit, size = readable_unit(values.attrs.get("units", "1"), known, log=wide)
    title = axis_text(values.attrs.get("long_name", str(values.name)), "", unit)
    about = values.attrs
    line = (float(about["line"]) / size, str(about.get("line_name", ""))) if "line" in about else None
    return ShownQuantity(values / size, dataset["state"], title, "flag_meanings" in about, tuple(about.get("ends", ())), line)
