"""The axes of a sweep's figure: what was varied, in a unit that can be read, logarithmic where it was spread so."""

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
"""Values that do not span this factor are drawn on a linear axis however they are spread."""
LONG = 60
"""Letters in a line of a key's title."""
NARROW = 500.0
"""Logarithmic axes that span less than this factor have numbers at 1, 2, 5, 10, ..."""
WIDE = 100.0
"""Positive numbers of a quantity that span more than this factor are drawn on a logarithmic axis."""
_TEXTS = {"m s-1": "m/s", "J m-2": "J/m²"}


@dataclass(frozen=True)
class Scaled:
    """Numbers as they are drawn, in a unit of so many SI units (`size`); words stand at 0, 1, 2, ..."""

    values: Floats
    label: str
    size: float = 1.0
    log: bool = False
    words: tuple[str, ...] = ()

    @property
    def edges(self) -> Floats:
        """Where areas around ascending values meet: half way, on a logarithmic axis in the logarithm."""
        place = np.log(self.values) if self.log else self.values
        if len(place) == 1:
            return np.asarray(self.values[0] + np.array([-0.5, 0.5]))
        between = 0.5 * (place[1:] + place[:-1])
        edges = np.concatenate([[2.0 * place[0] - between[0]], between, [2.0 * place[-1] - between[-1]]])
        return np.asarray(np.exp(edges) if self.log else edges)

    def show(self, axes: Axes, which: str) -> None:
        """Label, scale and ticks of the axis "x" or "y"."""
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
    """A varied key, or a quantity under another name, in a readable unit; spread by its values."""
    name = name or str(variable.name)
    if not np.issubdtype(variable.dtype, np.number):
        words, places = np.unique(variable.values.astype(str), return_inverse=True)
        return Scaled(places.astype(float), name, words=tuple(words.tolist()))
    values = np.asarray(variable.values, float)
    known = np.abs(values[np.isfinite(values)])
    unit, size = unit_of(variable.attrs.get("units", "1"), float(known.max()) if known.size else 1.0)
    return Scaled(values / size, name + (f" ({unit})" if unit != "1" else ""), size, is_logarithmic(values))


def unit_of(units: str, largest: float) -> tuple[str, float]:
    """A unit in which a quantity of that size can be read, and how many SI units it holds."""
    if units in ("m", "s") and largest > 0.0:
        return length_unit(largest) if units == "m" else time_unit(largest)
    if units in ("Pa", "N"):
        return readable(largest, units)
    return _TEXTS.get(units, units), 1.0


def is_logarithmic(values: Floats) -> bool:
    """Whether positive values are spread more evenly in their logarithm than in themselves."""
    known = values[np.isfinite(values)]
    if known.size < 3 or known.min() <= 0.0 or known.max() < SPREAD * known.min():
        return False
    low, middle, high = (float(value) for value in (known.min(), np.median(known), known.max()))
    linear, log = (middle - low) / (high - low), np.log(middle / low) / np.log(high / low)
    return abs(float(log) - 0.5) < abs(linear - 0.5)


def value_text(variable: xr.DataArray) -> str:
    """One value of a varied key, with its unit, as it is said in a key or a title: thickness 12.5 km."""
    name = str(variable.name).rpartition(".")[2].replace("_", " ")
    if not np.issubdtype(variable.dtype, np.number):
        return f"{name} {variable.item()}"
    unit, size = unit_of(variable.attrs.get("units", "1"), abs(float(variable)))
    return f"{name} {float(variable) / size:.4g}" + (f" {unit}" if unit != "1" else "")


@dataclass(frozen=True)
class Shown:
    """A quantity as it is drawn: its numbers (NaN where there is none), what it is, and what kind of numbers it has."""

    values: xr.DataArray
    state: xr.DataArray
    title: str
    is_flag: bool

    @property
    def known(self) -> Floats:
        """Its numbers."""
        return np.asarray(self.values.values[np.isfinite(self.values.values)], float)

    @property
    def is_whole(self) -> bool:
        """Whether it counts something."""
        return bool((self.known == np.rint(self.known)).all())

    @property
    def is_wide(self) -> bool:
        """Whether it is to be seen on a logarithmic scale."""
        known = self.known
        return known.size > 0 and known.min() > 0.0 and known.max() > WIDE * known.min()

    def has(self, state: int) -> bool:
        """Whether some member is in this state."""
        return bool((self.state == state).any())


def shown(dataset: xr.Dataset) -> Shown:
    """The quantity of a figure's dataset, in a readable unit."""
    values = dataset[dataset.attrs["quantity"]]
    known = np.abs(values.values[np.isfinite(values.values)])
    unit, size = unit_of(values.attrs.get("units", "1"), float(known.max(initial=0.0)))
    title = textwrap.fill(values.attrs.get("long_name", str(values.name)) + (f" ({unit})" if unit != "1" else ""), LONG)
    return Shown(values / size, dataset["state"], title, "flag_meanings" in values.attrs)
