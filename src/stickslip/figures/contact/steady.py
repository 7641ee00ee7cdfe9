"""Figure of steady sliding: friction against the slip rate, where it is stable, the steady motion, and what happens from rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.contact import SteadySlidings, slip_rate_at, steady_traction
from stickslip.figures.panels import add_legend, finish, set_log_ticks
from stickslip.figures.sheet import one_panel
from stickslip.figures.style import BLUE, GREY, INK, PALE, PURPLE, VERMILLION, curve_quantity, label, shown, styled, unit_shown
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

RATES_DRAWN = 801
"""Number of slip rates at which friction is drawn."""
AROUND, FAST = 10.0, 10.0
"""Factor by which the drawn slip rates go beyond those that are named; and the rate (m/s) they reach if no rate is critical."""


def steady_data(found: SteadySlidings, title: str = "") -> xr.Dataset:
    """Return the friction of steady sliding along the slip rate and whether it is stable there, with the rates that are named."""
    assert found.problem is not None
    slidings = [abs(one.rate) for one in found.slidings]
    critical = np.array([one.rate for one in found.changes])
    edge = _edge_from_rest(found)
    rests = [] if edge is None else [edge]
    named = np.array([*slidings, *critical, *rests, *([] if critical.size else [FAST / AROUND])])
    rates = np.unique(np.concatenate((np.geomspace(named.min() / AROUND, named.max() * AROUND, RATES_DRAWN), critical)))
    below = not found.changes[0].stable_above if found.changes else bool(found.slidings and found.slidings[0].stable)
    stable = (np.searchsorted(critical, rates, side="right") % 2 == 0) == below
    contents = {
        "traction": curve_quantity("slip_rate", steady_traction(found.problem, rates), "traction", found.unit),
        "stable": xr.Variable("slip_rate", stable.astype(int), {"long_name": "1 where steady sliding is stable", "units": "1"}),
        "sliding_rate": curve_quantity("sliding", slidings, "slip_rate", found.unit),
        "sliding_traction": curve_quantity("sliding", [abs(one.traction) for one in found.slidings], "traction", found.unit),
        "critical_rate": curve_quantity("change", critical, "slip_rate", found.unit),
        "sticks_to": curve_quantity("rest", rests, "slip_rate", found.unit),
    }
    along = curve_quantity("slip_rate", rates, "slip_rate", found.unit)
    return xr.Dataset(contents, coords={"slip_rate": along}, attrs={"force": found.unit, "title": title})


def _edge_from_rest(found: SteadySlidings) -> float | None:
    """Return the slip rate (m/s) of steady sliding at the highest pull rate that still sticks from rest; None if none is known."""
    if found.from_rest is None or found.from_rest.sticks_at is None or found.problem is None:
        return None
    return slip_rate_at(found.problem, math.copysign(found.from_rest.sticks_at, found.pull_rate))


@styled
def draw_steady(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure | Axes:
    """Draw friction of steady sliding, solid where it is stable, with the steady motion, critical rates and hysteresis."""
    axes = one_panel((5.6, 3.8), **place)
    metres, stress = unit_shown(dataset["slip_rate"]), unit_shown(dataset["traction"])
    rate, traction, stable = shown(dataset["slip_rate"], metres), shown(dataset["traction"], stress), dataset["stable"].values > 0
    for chosen, colour, style, text in ((stable, BLUE, "-", "stable"), (~stable, VERMILLION, "--", "unstable")):
        if chosen.any():
            axes.plot(rate, np.where(chosen, traction, np.nan), color=colour, linestyle=style, label=f"steady sliding, {text}")
    for critical in shown(dataset["critical_rate"], metres):
        axes.axvline(critical, color=GREY, linewidth=0.9, linestyle=":", zorder=0)
    if dataset["critical_rate"].size:
        one = f", {shown(dataset['critical_rate'], metres)[0]:.3g} {metres[0]}" if dataset["critical_rate"].size == 1 else "s"
        name = label(dataset["critical_rate"], metres).partition(" $")[0]
        axes.plot([], [], color=GREY, linewidth=0.9, linestyle=":", label=f"critical {name}{one}")
    if dataset["sticks_to"].size:
        ends = float(shown(dataset["critical_rate"], metres)[-1]), float(shown(dataset["sticks_to"], metres)[0])
        axes.axvspan(*ends, color=PALE, linewidth=0, zorder=0, label="stable, but sticks from rest")
        text = f"edge of sticking from rest, {ends[1]:.3g} {metres[0]}"
        axes.axvline(ends[1], color=INK, linewidth=1.1, linestyle="-.", zorder=1, label=text)
    places = shown(dataset["sliding_rate"], metres), shown(dataset["sliding_traction"], stress)
    axes.plot(*places, "o", color=PURPLE, markeredgecolor=INK, label="steady sliding under this drive", zorder=4)
    axes.set(xscale="log", xlabel=label(dataset["slip_rate"], metres), ylabel=label(dataset["traction"], stress))
    axes.set(xlim=(rate[0], rate[-1]))
    set_log_ticks(axes, "x")
    add_legend(axes, axes.get_legend_handles_labels()[0], own=place.get("ax") is not None)
    return finish(axes, dataset.attrs["title"], **place)
