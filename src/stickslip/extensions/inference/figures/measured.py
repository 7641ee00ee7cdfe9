"""Figure of measured points of friction, the law through them, and how well they determine it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.figures.panels import letter_panels, set_title, zero_line
from stickslip.figures.sheet import sheet, shown_or_saved
from stickslip.figures.style import BLUE, GREY, INK, axis_text, curve_quantity, quantity, spans_decades, styled, unit_shown
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import QUANTITIES, name_of, si_unit
from stickslip.foundation.place import Place
from stickslip.friction import Fit, Smooth

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CURVE = 801
"""Evaluate the law at this many places."""
MANY_POINTS = 5000
"""Draw more points than this as an image, so that vector files stay small."""
SHADES = ("#F8D9C4", "#F0A879")
"""Colours of the band of two standard errors, and of the band of one above it."""


@for_users
def plot_fit(result: Fit | Smooth, path: str | Path | None = None, **place: Unpack[Place]) -> Figure:
    """Draw measured points, the law through them and its band, and save the figure if a file is named, whole or not at all.

    The result is that of `stickslip.friction.fit` or `smooth`; `figure`, `size` and `dpi` say where to draw, and how large, as for
    `solution.plot`. The figure shows points and law above, and below how far the points are from the law. A fit has bands of one
    and two standard errors. For a law of slip and slip rate the measured friction is drawn against that of the law. Raises
    InputError if the argument is no such result.
    """
    if not isinstance(result, Fit | Smooth):
        raise InputError(f"plot_fit: result must come from fit or smooth, got {type(result).__name__}")
    figure: Figure = shown_or_saved(draw_measured(measured_data(result), **place), path, place)
    return figure


def measured_data(result: Fit | Smooth) -> xr.Dataset:
    """Return the points, their differences from the law, the law along its variable with its standard error, and the residual.

    For a law of slip and slip rate the variable is the friction coefficient of the law.
    """
    points, law = result.points, result.law
    if isinstance(result, Fit) and points.backward is not None:
        return _both_ways(result)
    both = len(points.has) == 2
    calculated = law.coefficient(*points.variables)
    place = calculated if both else points.places
    along = _along(place)
    slip = points.has == ("slip",)
    at = (along, 0.0) if slip else (0.0, along)
    error = np.full(len(along), np.nan)
    mu = along if both else law.coefficient(*at)
    if isinstance(result, Fit) and not both:
        mu, error = result.band(*at)
    of, unit = "slip" if slip else "slip_rate", points.load_unit
    named = ("friction coefficient of the law", "", "1") if both else (name_of(of, unit), QUANTITIES[of].symbol, si_unit(of, unit))
    contents = {
        "place": quantity("point", place, *named),
        "friction": curve_quantity("point", points.friction, "friction"),
        "difference": quantity("point", points.friction - calculated, "measured minus law", "", "1"),
        "law": quantity("along", mu, "friction coefficient of the law", r"\mu", "1"),
        "standard_error": quantity("along", error, "standard error of the law", "", "1"),
        "residual": quantity((), result.residual, "standard deviation of the points about the law", "", "1"),
    }
    smoothed = isinstance(result, Smooth)
    what = "smoothed curve" if smoothed else "line of equality" if both else f"{law.kind} law"
    title = "Smoothed friction" if smoothed else f"{law.kind.capitalize()} law"
    attributes = {"title": f"{title}, {len(points)} points", "law": what}
    return xr.Dataset(contents, coords={"along": quantity("along", along, *named)}, attrs=attributes)


def _both_ways(result: Fit) -> xr.Dataset:
    """Return the same for points of both directions of slip: friction and slip rates have their signs."""
    ahead, behind = (measured_data(one) for one in result.ways)  # type: ignore[attr-defined] # of a `FitBothWays`
    turned = behind.assign({name: -behind[name] for name in ("place", "friction", "difference", "law")})
    turned = turned.assign_coords(along=-behind["along"]).isel(along=slice(None, None, -1))
    parts = {
        of: [one[[name for name in ahead if ahead[name].dims == (of,)]] for one in (turned, ahead)] for of in ("point", "along")
    }
    found = xr.merge([xr.concat(parts["point"], "point"), xr.concat(parts["along"], "along")], compat="no_conflicts")
    units = {name: found[name].assign_attrs(ahead[name].attrs) for name in found}
    contents = units | {"residual": ahead["residual"].copy(data=result.residual)}
    along = found["along"].assign_attrs(ahead["along"].attrs)
    title = f"{result.fitted.capitalize()}, {found.sizes['point']} points"
    return xr.Dataset(contents, coords={"along": along}, attrs={"title": title, "law": "one law for each direction"})


def _along(place: Floats) -> Floats:
    """Return the places where the law is drawn, from the smallest to the largest: evenly, or by factors over decades."""
    low, high, positive = float(place.min()), float(place.max()), place[place > 0.0]
    even = np.linspace(low, high, CURVE)
    if low < 0.0 or not len(positive) or not spans_decades(positive):
        return even
    return np.unique(np.concatenate(([low], even, np.geomspace(positive.min(), high, CURVE))).clip(low, high))


@styled
def draw_measured(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw points, law and the bands of a fit in the upper panel, and in the lower one how far the points are from the law."""
    figure = sheet((5.6, 5.0), **place)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.4, 1.0))
    unit, size = unit_shown(dataset["place"])
    places, along = dataset["place"].values / size, dataset["along"].values / size
    law, residual = dataset["law"].values, float(dataset["residual"])
    _draw_points(upper, places, dataset["friction"].values, f"measured, {len(places)} points")
    _draw_points(lower, places, dataset["difference"].values)
    upper.plot(along, law, color=BLUE, label=dataset.attrs["law"], zorder=4)
    _draw_band(upper, along, law, dataset["standard_error"].values)
    _draw_band(lower, along, np.zeros_like(law), dataset["standard_error"].values)
    zero_line(lower)
    for sign in (-1, 1):
        upper.plot([], [], color=INK, linewidth=0.9, linestyle="--", label=f"± residual, {residual:.2g}" if sign > 0 else None)
        lower.axhline(sign * residual, color=INK, linewidth=0.9, linestyle="--")
    _scale(lower, places)
    name, symbol = dataset["place"].attrs["long_name"], dataset["place"].attrs["symbol"]
    upper.set(ylabel=r"friction coefficient $\mu$")
    lower.set(xlabel=axis_text(name, symbol, unit), ylabel="measured\nminus law")
    upper.legend(loc="best")
    letter_panels([upper, lower])
    set_title(figure, dataset.attrs["title"])
    figure.align_ylabels([upper, lower])
    return figure


def _draw_band(axes: Axes, along: Floats, law: Floats, error: Floats) -> None:
    """Draw the bands of one and of two standard errors around the law, if it has any."""
    if np.isfinite(error).all():
        for times, shade in zip((2, 1), SHADES, strict=True):
            text = f"± {times} standard error{'s' * (times > 1)} of the law"
            axes.fill_between(along, law - times * error, law + times * error, color=shade, linewidth=0, label=text, zorder=1)


def _draw_points(axes: Axes, place: Floats, values: Floats, text: str = "") -> None:
    few = len(place) <= 200
    look: dict[str, Any] = {"color": GREY, "markersize": 3.5 if few else 2.0, "alpha": 0.9 if few else 0.5, "markeredgewidth": 0}
    axes.plot(place, values, "o", label=text or None, rasterized=len(place) > MANY_POINTS, zorder=2, **look)


def _scale(axes: Axes, place: Floats) -> None:
    """Make the horizontal axis logarithmic if the points span decades, with 0 at its left end if there are points at 0."""
    positive = place[place > 0.0]
    if place.min() < 0.0 or not len(positive) or not spans_decades(positive) or np.median(positive) > 0.1 * positive.max():
        return
    if place.min() == 0.0:
        axes.set_xscale("symlog", linthresh=float(positive.min()))
        axes.set_xlim(-0.3 * float(positive.min()), 1.5 * float(positive.max()))
    else:
        axes.set_xscale("log")
