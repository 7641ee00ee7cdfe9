"""Figure 3 of the paper: the admissible set K, all pairs of slip rate and load that solve the contact equation."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.contact.branches import branches_of, rate_on
from stickslip.contact.equation import resistance
from stickslip.figures.panels import letter_panels, panels
from stickslip.figures.style import (
    BLUE,
    GREY,
    INK,
    PURPLE,
    VERMILLION,
    Floats,
    curve_quantity,
    label,
    quantity,
    shown,
    styled,
    unit_shown,
)
from stickslip.problem.problem import Problem
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

OFFSETS = {"O": (5, 5), "A": (6, 4), "B": (5, -11), "C": (2, -13), "D": (5, -12), "E": (-12, 2)}
"""Offset of each point's name from the point, in points (1/72 inch), chosen so that it does not cover the curve."""

BRANCHES = {1: ("slip, stable", BLUE, "-"), -1: ("slip, unstable", VERMILLION, "--"), 0: ("slip, continuum", PURPLE, "-")}
"""Legend, colour and line style of the parts of the curve: 1 stable, -1 unstable, 0 a continuum of solutions."""


def data(problems: Mapping[str, Problem], largest_rate: float, titles: Mapping[str, str] | None = None) -> xr.Dataset:
    """Return the set K of each problem for slip rates from 0 to `largest_rate` (m/s), with loads in Pa.

    It consists of slip, g(s), and of stick up to the static strength; the points O to E of Fig. 4 are added. The keys of `problems`
    are prefixes of the variables, `titles` names the panels.
    """
    rates = np.linspace(0.0, largest_rate, 1201)
    contents: dict[str, xr.Variable] = {}
    for name, problem in problems.items():
        g = resistance(problem)
        slope = {"long_name": "slope of the resistance", "units": "Pa s/m"}
        contents[f"{name}_resistance"] = curve_quantity("slip_rate", g.strength + g.excess(rates), "load")
        contents[f"{name}_slope"] = xr.Variable("slip_rate", g.slope(rates), slope)
        contents[f"{name}_strength"] = quantity((), g.strength, "static strength", r"\mu_S S", "Pa")
        for point, place in corners(problem, largest_rate).items():
            where = {"long_name": f"point {point}: slip rate (m/s), load (Pa)", "units": "m/s, Pa"}
            contents[f"{name}_point_{point}"] = xr.Variable("coordinate", list(place), where)
    shown_as = [(titles or {}).get(name, name) for name in problems]
    attributes = {"title": "The set K", "cases": list(problems), "case_titles": shown_as}
    coordinates = {"slip_rate": curve_quantity("slip_rate", rates, "slip_rate"), "coordinate": ["slip_rate", "load"]}
    return xr.Dataset(contents, coords=coordinates, attrs=attributes)


def corners(problem: Problem, largest_rate: float) -> dict[str, tuple[float, float]]:
    """Return the points of the paper's Fig. 4 as (slip rate in m/s, load in Pa), or nothing for a regular contact.

    O is the origin, A the end of stick, B the point that the jump up reaches, C the lower fold, D the point that the jump down
    reaches, and E a point further up the slipping branch, here at `largest_rate` (m/s).
    """
    g = resistance(problem)
    slipping = branches_of(g)[-1]
    if not slipping.excess_from < 0.0 < slipping.rate_from:
        return {}
    fold = g.strength + slipping.excess_from
    return {
        "O": (0.0, 0.0),
        "A": (0.0, g.strength),
        "B": (rate_on(g, slipping, 0.0), g.strength),
        "C": (slipping.rate_from, fold),
        "D": (0.0, fold),
        "E": (largest_rate, g.strength + float(g.excess(largest_rate))),
    }


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw a panel for each case, with stable branches solid and unstable ones dashed."""
    cases, titles = ([str(name) for name in np.atleast_1d(dataset.attrs[key])] for key in ("cases", "case_titles"))
    figure, axes = panels(1, len(cases), (3.6 * len(cases), 3.5), place, sharey=True)
    for i, case in enumerate(cases):
        draw_set(axes[0, i], dataset, case)
        draw_points(axes[0, i], dataset, case)
    letter_panels(axes[0], titles)
    axes[0, 0].set_ylabel(label(dataset[f"{cases[0]}_resistance"], load_unit(dataset)))
    axes[0, -1].legend(loc="lower right")
    return figure


def load_unit(dataset: xr.Dataset) -> tuple[str, float]:
    """Return the unit (name, size in Pa) in which the loads of all cases are drawn."""
    return unit_shown(*(values for name, values in dataset.data_vars.items() if str(name).endswith("_resistance")))


def draw_set(axes: Axes, dataset: xr.Dataset, case: str, *, quiet: bool = False) -> None:
    """Draw the branches of K: stick (vertical), stable slip and unstable slip; `quiet` draws them in grey, as a background."""
    rate, load = shown(dataset["slip_rate"]), shown(dataset[f"{case}_resistance"], load_unit(dataset))
    kind = np.where(dataset[f"{case}_slope"].values > 0, 1, -1)
    look: dict[str, Any] = {"color": GREY, "linewidth": 1.0, "label": None} if quiet else {"linewidth": 1.8}
    stick = {"color": INK, "label": "stick"} | look | ({"label": "set K (dashed: unstable)"} if quiet else {})
    axes.plot([0, 0], [0, float(dataset[f"{case}_strength"]) / load_unit(dataset)[1]], **stick)
    draw_branches(axes, rate, load, kind, **look)
    axes.set(xlabel=label(dataset["slip_rate"]), xlim=(-0.04 * rate[-1], rate[-1]), ylim=(0, None))


def draw_branches(axes: Axes, rate: Floats, load: Floats, kind: Any, **look: Any) -> None:
    """Draw the stable, unstable and flat parts of a curve, told apart by `kind`; `look` replaces colours, widths and labels."""
    for which, (name, colour, style) in BRANCHES.items():
        chosen = kind == which
        if not chosen.any():
            continue
        if which != 1:  # extend each part to the first point of its neighbours: the curve then has no gap
            chosen = chosen | np.append(chosen[1:], False) | np.append(False, chosen[:-1])
        axes.plot(rate, np.where(chosen, load, np.nan), **{"color": colour, "linestyle": style, "label": name} | look)


def draw_points(axes: Axes, dataset: xr.Dataset, case: str, **moved: tuple[int, int]) -> None:
    """Draw the points O to E of an irregular case and the levels of its folds; `moved` replaces offsets of names (in points)."""
    offsets = OFFSETS | moved
    points = {p: dataset[f"{case}_point_{p}"].values for p in OFFSETS if f"{case}_point_{p}" in dataset}
    metres, size = unit_shown(dataset["slip_rate"])[1], load_unit(dataset)[1]
    found = {point: (rate / metres, load / size) for point, (rate, load) in points.items()}
    low, high = axes.get_ylim()
    for point, (rate, load) in found.items():
        if low <= load <= high:
            axes.plot(rate, load, "o", markersize=3.5, color=INK, zorder=5, clip_on=False)
            axes.annotate(point, (rate, load), offsets[point], textcoords="offset points", fontsize=9, fontweight="bold")
    for start, end in (("A", "B"), ("D", "C")) if found else ():
        (left, level), (right, _) = found[start], found[end]
        name = "jump of perfect delay" if start == "A" else None
        axes.plot([left, right], [level, level], color=GREY, linewidth=0.8, linestyle=":", zorder=0, label=name)
