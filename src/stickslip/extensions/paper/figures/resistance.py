"""Figures 3 and 4 of the paper: the admissible set K, all pairs of slip rate and load that solve the contact equation, and a loop.

The loop is the rule of perfect delay, as followed by an actual run whose load rises and then falls.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from stickslip.contact import branches_of, rate_on, resistance
from stickslip.figures.contact.admissible import draw_branches
from stickslip.figures.panels import letter_panels, panels, zero_line
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, curve_quantity, label, quantity, shown, styled, unit_shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.place import Place
from stickslip.problem import Problem

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from stickslip.solution import Solution

OFFSETS = {"O": (5, 5), "A": (6, 4), "B": (5, -11), "C": (2, -13), "D": (5, -12), "E": (-12, 2)}
"""Offset of each point's name from the point, in points (1/72 inch), chosen so that it does not cover the curve."""
LOOP = "loop"
"""Prefix of the variables of the set K in the dataset of the loop."""


def resistance_data(problems: Mapping[str, Problem], largest_rate: float, titles: Mapping[str, str] | None = None) -> xr.Dataset:
    """Return the set K of each problem for slip rates from 0 to `largest_rate` (m/s), with loads in Pa.

    It consists of slip, g(s), and of stick up to the static strength; the points O to E of Fig. 4 are added. The keys of `problems`
    are prefixes of the variables, `titles` names the panels.
    """
    rates = np.linspace(0.0, largest_rate, 1201)
    contents: dict[str, xr.Variable] = {}
    for name, problem in problems.items():
        g, loads = resistance(problem), problem.load_unit
        slope = {"long_name": "slope of the resistance", "units": problem.unit_of("impedance")}
        contents[f"{name}_resistance"] = curve_quantity("slip_rate", g.strength + g.excess(rates), "load", loads)
        contents[f"{name}_slope"] = xr.Variable("slip_rate", g.slope(rates), slope)
        contents[f"{name}_strength"] = quantity((), g.strength, "static strength", r"\mu_S S", loads)
        for point, place in corners(problem, largest_rate).items():
            rate = problem.unit_of("slip_rate")
            where = {"long_name": f"point {point}: slip rate ({rate}), load ({loads})", "units": f"{rate}, {loads}"}
            contents[f"{name}_point_{point}"] = xr.Variable("coordinate", list(place), where)
    shown_as = [(titles or {}).get(name, name) for name in problems]
    attributes = {"title": "The set K", "cases": list(problems), "case_titles": shown_as}
    coordinates = {"slip_rate": curve_quantity("slip_rate", rates, "slip_rate", loads), "coordinate": ["slip_rate", "load"]}
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
def draw_resistance(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
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
    """Return the unit (name, size in Pa) of the drawn loads of all cases."""
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


# ---- the loop of Figure 4 --------------------------------------------------------------------------------------------------------


def loop_data(solution: Solution) -> xr.Dataset:
    """Return slip rate (m/s) and load (Pa) of a run, whose load must rise and then fall, and the set K that it follows."""
    time, (rate, load) = solution.curves_together(("slip_rate", "load"))
    turn = int(np.argmax(load))
    background = resistance_data({LOOP: solution.problem}, float(rate.max()))
    run = {
        "run_time": curve_quantity("run_time", time, "time"),
        "run_slip_rate": curve_quantity("run_time", rate, "slip_rate"),
        "run_load": curve_quantity("run_time", load, "load"),
        "run_turn": xr.Variable((), turn, {"long_name": "index at which the load turns from rising to falling"}),
    }
    return background.assign(run).assign_attrs(title="The rule of perfect delay")


@styled
def draw_hysteresis(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw the loop in the plane of slip rate and load on the left, and the same run against time on the right."""
    figure = sheet((7.2, 3.8), **place)
    axes: Any = figure.subplot_mosaic([["loop", "load"], ["loop", "rate"]], width_ratios=(1.25, 1))
    _draw_loop(axes["loop"], dataset)
    _draw_time(axes["load"], axes["rate"], dataset)
    figure.align_ylabels([axes["load"], axes["rate"]])
    letter_panels((axes["loop"], axes["load"], axes["rate"]), ("Set K and the path of a run", "Load", "Slip rate"))
    return figure


def _ways(dataset: xr.Dataset) -> tuple[tuple[slice, str, str], ...]:
    turn = int(dataset["run_turn"])
    return (slice(None, turn + 1), VERMILLION, "load rises: ODABE"), (slice(turn, None), BLUE, "load falls: EBCDO")


def _draw_loop(axes: Axes, dataset: xr.Dataset) -> None:
    draw_set(axes, dataset, LOOP, quiet=True)
    rate = shown(dataset["run_slip_rate"], unit_shown(dataset["slip_rate"]))
    load = shown(dataset["run_load"], load_unit(dataset))
    shift = 0.012 * rate.max()  # both paths follow the same branches: draw them side by side, not on top of each other
    for (part, colour, text), side in zip(_ways(dataset), (-1, 1), strict=True):
        x, y = rate[part] + side * shift, load[part] - side * 0.35
        axes.plot(x, y, color=colour, linewidth=1.8, label=text)
        _draw_arrows(axes, x, y, colour)
    axes.set(ylim=(50, 90), xlim=(-0.04 * rate.max(), 1.04 * rate.max()))
    draw_points(axes, dataset, LOOP, D=(8, 3))
    axes.annotate("to O", (0, 50), (6, 4), textcoords="offset points", fontsize=9, fontweight="bold")
    axes.set_ylabel(label(dataset["run_load"], load_unit(dataset)))
    axes.legend(loc="lower right")


def _draw_arrows(axes: Axes, x: Floats, y: Floats, colour: str) -> None:
    """Draw arrow heads in the middle of the jump, and halfway along the slipping and the sticking part of the path."""
    jump = int(np.argmax(np.abs(np.diff(x))))
    halves = [(low, high) for low, high in ((0, jump), (jump + 1, x.size - 1)) if high - low > 10]
    middles = [(low + 2 * (high - low) // 5, low + 3 * (high - low) // 5) for low, high in halves]
    for first, last in ((jump, jump + 1), *middles):
        tail, head = ((x[first] + share * (x[last] - x[first]), y[first] + share * (y[last] - y[first])) for share in (0.4, 0.6))
        axes.annotate("", head, tail, arrowprops={"arrowstyle": "-|>", "color": colour})


def _draw_time(top: Axes, bottom: Axes, dataset: xr.Dataset) -> None:
    time = shown(dataset["run_time"])
    for axes, name, unit in ((top, "run_load", load_unit(dataset)), (bottom, "run_slip_rate", unit_shown(dataset["slip_rate"]))):
        for part, colour, _ in _ways(dataset):
            axes.plot(time[part], shown(dataset[name], unit)[part], color=colour)
        axes.set(ylabel=label(dataset[name], unit), xlim=(0, time[-1]))
    for point, left in (("A", 0.0), ("C", 0.25 * time[-1])):
        stress, size = load_unit(dataset)
        level = dataset[f"{LOOP}_point_{point}"].values[1] / size
        top.axhline(level, color=GREY, linewidth=0.8, linestyle=":", zorder=0)
        text = f"fold {point}, {level:.2f} {stress}"
        top.annotate(text, (left, level), (3, 2), textcoords="offset points", fontsize=7.5, color=INK)
    zero_line(bottom)
    top.tick_params(labelbottom=False)
    bottom.set_xlabel(label(dataset["run_time"]))
    bottom.sharex(top)
