"""Axes of the figure of a sweep: varied keys in readable units, on a logarithmic axis if their values are spread that way."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import LogLocator, NullLocator, StrMethodFormatter
from numpy.typing import NDArray

from stickslip.figures.style import length_unit, readable, time_unit

Floats = NDArray[np.float64]

SPREAD = 3.0
"""Values that span less than this factor are drawn on a linear axis: the two spreads could not be told apart."""
LONG = 60
"""Number of characters in a line of the title of a key or a scale."""
NARROW = 500.0
"""Logarithmic axes that span less than this factor have ticks at 1, 2, 5, 10, ...: powers of ten alone would be too few."""
WIDE = 100.0
"""Positive numbers of a quantity that span more than this factor are drawn on a logarithmic axis or scale of colours."""
_TEXTS = {"m s-1": "m/s", "J m-2": "J/m²"}
"""Units as readers expect to see them."""


@dataclass(frozen=True)
class Scaled:
    """Numbers as they are drawn, in a unit of `size` SI units; words are placed at 0, 1, 2, ..."""

    values: Floats
    label: str
    size: float = 1.0
    log: bool = False
    words: tuple[str, ...] = ()

    @property
    def edges(self) -> Floats:
        """The edges of areas around ascending values: halfway between them, on a logarithmic axis in the logarithm."""
        place = np.log(self.values) if self.log else self.values
        if len(place) == 1:
            return np.asarray(self.values[0] + np.array([-0.5, 0.5]))
        between = 0.5 * (place[1:] + place[:-1])
        edges = np.concatenate([[2.0 * place[0] - between[0]], between, [2.0 * place[-1] - between[-1]]])
        return np.asarray(np.exp(edges) if self.log else edges)

    def show(self, axes: Axes, which: str) -> None:
        """Set label, scale and ticks of the axis named "x" or "y"."""
        axis = getattr(axes, f"{which}axis")
        axis.set_label_text(self.label)
        if self.log:
            getattr(axes, f"set_{which}scale")("log")
            if self.values.max() < NARROW * self.values.min():
                axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
                axis.set_major_formatter(StrMethodFormatter("{x:g}"))
                axis.set_minor_locator(NullLocator())
        if self.words:
            axis.set_ticks(np.unique(self.values), [self.words[int(k)] for k in np.unique(self.values)])


def scaled(variable: xr.DataArray, name: str = "") -> Scaled:
    """Return a varied key in a readable unit, under `name` if it is given; its values decide whether the axis is logarithmic."""
    name = name or str(variable.name)
    if not np.issubdtype(variable.dtype, np.number):
        words, places = np.unique(np.array(variable.values.tolist(), str), return_inverse=True)
        return Scaled(places.astype(float), name, words=tuple(words.tolist()))
    values = np.asarray(variable.values, float)
    known = np.abs(values[np.isfinite(values)])
    unit, size = unit_of(variable.attrs.get("units", "1"), float(known.max()) if known.size else 1.0)
    return Scaled(values / size, name + (f" ({unit})" if unit != "1" else ""), size, is_logarithmic(values))


def unit_of(units: str, largest: float) -> tuple[str, float]:
    """Return a unit in which a quantity whose largest value (in SI) is given can be read, and its size in SI units."""
    if units in ("m", "s") and largest > 0.0:
        return length_unit(largest) if units == "m" else time_unit(largest)
    if units in ("Pa", "N"):
        return readable(largest, units)
    return _TEXTS.get(units, units), 1.0


def is_logarithmic(values: Floats) -> bool:
    """Return True if values are positive and their median lies nearer to the middle in the logarithm than on a linear scale."""
    known = values[np.isfinite(values)]
    if known.size < 3 or known.min() <= 0.0 or known.max() < SPREAD * known.min():
        return False
    low, middle, high = (float(value) for value in (known.min(), np.median(known), known.max()))
    linear, log = (middle - low) / (high - low), np.log(middle / low) / np.log(high / low)
    return abs(float(log) - 0.5) < abs(linear - 0.5)


def value_text(variable: xr.DataArray) -> str:
    """Return one value of a varied key with its name and unit, for a legend or a title, as in "thickness 12.5 km"."""
    name = str(variable.name).rpartition(".")[2].replace("_", " ")
    if not np.issubdtype(variable.dtype, np.number):
        return f"{name} {variable.item()}"
    unit, size = unit_of(variable.attrs.get("units", "1"), abs(float(variable)))
    return f"{name} {float(variable) / size:.4g}" + (f" {unit}" if unit != "1" else "")


@dataclass(frozen=True)
class Shown:
    """A quantity as it is drawn: its numbers (NaN if there is none), the state of each member, and a title with the unit."""

    values: xr.DataArray
    state: xr.DataArray
    title: str
    is_flag: bool

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
        return known.size > 0 and known.min() > 0.0 and known.max() > WIDE * known.min()

    def has(self, state: int) -> bool:
        """Return True if some member is in this state."""
        return bool((self.state == state).any())


def shown(dataset: xr.Dataset) -> Shown:
    """Return the quantity of a figure's dataset in a readable unit."""
    values = dataset[dataset.attrs["quantity"]]
    known = np.abs(values.values[np.isfinite(values.values)])
    unit, size = unit_of(values.attrs.get("units", "1"), float(known.max(initial=0.0)))
    title = textwrap.fill(values.attrs.get("long_name", str(values.name)) + (f" ({unit})" if unit != "1" else ""), LONG)
    return Shown(values / size, dataset["state"], title, "flag_meanings" in values.attrs)
