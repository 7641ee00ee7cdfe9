"""Figures 1 and 2 of the paper: a sketch of the two systems with the paper's symbols, and their friction laws."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle

from stickslip.figures.panels import letter_panels, panels
from stickslip.figures.style import (
    BLUE,
    GREY,
    INK,
    LINE_COLOURS,
    PALE,
    VERMILLION,
    curve_quantity,
    label,
    quantity,
    shown,
    styled,
)
from stickslip.foundation.place import Place
from stickslip.foundation.quantities import quantities_of
from stickslip.friction import FrictionLaw
from stickslip.problem import Problem
from stickslip.problem.bodies import as_slab

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Point = tuple[float, float]
ARROW: dict[str, Any] = {"arrowstyle": "-|>", "shrinkA": 0, "shrinkB": 0, "linewidth": 1.3, "mutation_scale": 11}
"""Look of all arrows: matplotlib's `arrowprops`, sizes in points."""
PANELS_OF_LAWS = {
    "slip": ("slip_law", "Slip law, eq. (14)", "lower left"),
    "slip_rate": ("rate_law", "Slip-rate law, eq. (15)", "upper right"),
}
"""Panels by their abscissa: the dimension of the laws, the title and the place of the legend."""


def systems_data(block: Problem, slab: Problem) -> xr.Dataset:
    """Return the constants of both systems, and the displacement (m) of the slab at t = 0 across its thickness, all in SI."""
    inside = as_slab(slab.body)
    x = np.linspace(0.0, inside.thickness, 21)
    sheared = slab.initial_slip + slab.load / inside.shear_modulus * x
    contents = {"initial_displacement": quantity("x", sheared, "displacement", "u", "m")}
    for prefix, body in (("block", block.body), ("slab", slab.body)):
        for name, declared in quantities_of(type(body)).items():
            value, about = getattr(body, name), {"long_name": declared.meaning, "units": declared.unit}
            if value is not None:
                contents[f"{prefix}_{name}"] = xr.Variable((), value, about)
    contents["pull_rate"] = quantity((), slab.pull_rate, "pull rate", "V", "m/s")
    where = {"x": quantity("x", x, "distance from the contact", "x", "m")}
    return xr.Dataset(contents, coords=where, attrs={"title": "The two systems"})


@styled
def draw_systems(_: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw a sketch, not to scale, that shows what the symbols mean; it is the same whatever numbers the dataset holds."""
    figure, ((left, right),) = panels(1, 2, (7.2, 2.7), place)
    for axes in (left, right):
        axes.set(xlim=(0, 10), ylim=(0.2, 6.8), aspect="equal")
        axes.axis("off")
        _draw_rough_floor(axes)
    _draw_block(left)
    _draw_slab(right)
    letter_panels((left, right), ("Spring-block", "Elastic slab"))
    return figure


def _draw_rough_floor(axes: Axes) -> None:
    left, right, height = 0.2, 9.8, 1.4
    look: dict[str, Any] = {"facecolor": PALE, "edgecolor": "none", "hatch": "//////", "alpha": 0.8}
    axes.add_patch(Rectangle((left, height - 0.14), right - left, 0.14, **look))
    axes.plot([left, right], [height, height], color=INK, linewidth=0.9)


def _draw_block(axes: Axes) -> None:
    axes.add_patch(Rectangle((1.0, 1.4), 2.6, 2.2, facecolor="#CFE3F1", edgecolor=BLUE, linewidth=1.3))
    axes.text(2.3, 2.5, "$m$", ha="center", va="center", fontsize=13)
    axes.plot(*_spring(3.6, 8.2, 2.5), color=INK, linewidth=1.2)
    axes.text(5.9, 3.15, "$K$", ha="center", fontsize=11)
    axes.plot([8.2, 8.2], [1.8, 3.2], color=INK, linewidth=2.5)
    _arrow(axes, (8.2, 2.5), (9.7, 2.5), ("$V$", 9.0, 2.75))
    _arrow(axes, (2.3, 4.9), (2.3, 3.6), ("$S$", 2.6, 4.3))
    _arrow(axes, (2.3, 1.12), (0.7, 1.12), (r"$\tau$", 1.45, 0.45), colour=VERMILLION)
    _arrow(axes, (1.0, 4.1), (1.9, 4.1))
    axes.text(0.95, 4.1, "$u(t)$", ha="right", va="center")
    axes.plot([1.0, 1.0], [3.6, 4.6], color=GREY, linewidth=0.7, linestyle=":")
    axes.text(8.2, 3.5, "$D_0+Vt$", ha="center")


def _draw_slab(axes: Axes) -> None:
    shear, inside = 1.6, "#FBE3D4"
    corners = [(0.6, 1.4), (6.6, 1.4), (6.6 + shear, 5.2), (0.6 + shear, 5.2)]
    axes.add_patch(Polygon(corners, facecolor=inside, edgecolor="none"))
    for start in np.linspace(0.6, 6.6, 6):
        axes.plot([start, start + shear], [1.4, 5.2], color=VERMILLION, linewidth=1.0)
    axes.plot([0.6, 6.6], [1.4, 1.4], color=INK, linewidth=1.6)
    axes.add_patch(Rectangle((0.6 + shear, 5.2), 6.0, 0.3, facecolor=INK, edgecolor="none"))
    behind = {"facecolor": inside, "pad": 1.5, "linewidth": 0}
    axes.text(4.4, 3.3, r"$\rho,\ c,\ G=\rho c^2$", ha="center", va="center", fontsize=10.5, bbox=behind)
    axes.text(6.1, 5.9, "$u(h,t)=D_0+Vt$", ha="center", va="center")
    _arrow(axes, (8.2, 5.35), (9.7, 5.35), ("$V$", 9.0, 5.6))
    axes.text(7.0, 1.62, "$u(0,t)$")
    _arrow(axes, (2.6, 1.12), (1.0, 1.12), (r"$\tau$", 1.8, 0.45), colour=VERMILLION)
    _arrow(axes, (3.4, 6.6), (3.4, 5.5), ("$S$", 3.7, 6.0))
    axes.annotate("", (9.1, 5.2), (9.1, 1.4), arrowprops={"arrowstyle": "<->", "linewidth": 0.9, "color": GREY})
    axes.text(9.25, 3.3, "$h$", va="center")
    axes.text(9.3, 1.62, "$x=0$", fontsize=8.0, color=GREY)
    axes.text(9.3, 4.8, "$x=h$", fontsize=8.0, color=GREY)


def _spring(left: float, right: float, height: float) -> tuple[list[float], list[float]]:
    """Return the corners of a zigzag line, x and y, between two ends at one height."""
    coils = np.linspace(left + 0.6, right - 0.6, 17)
    offsets = [0.0, *(0.32 if i % 2 else -0.32 for i in range(1, 16)), 0.0]
    return [left, *coils, right], [height, *(height + o for o in offsets), height]


def _arrow(axes: Axes, start: Point, end: Point, name: tuple[str, float, float] | None = None, *, colour: str = INK) -> None:
    """Draw an arrow between two places, and its name, given with the place of its middle."""
    axes.annotate("", end, start, arrowprops={**ARROW, "color": colour})
    if name is not None:
        text, x, y = name
        axes.text(x, y, text, color=colour, ha="center", fontsize=11)


def laws_data(
    slip_laws: Mapping[str, FrictionLaw], rate_laws: Mapping[str, FrictionLaw], largest_slip: float, largest_rate: float
) -> xr.Dataset:
    """Return mu of slip laws along slip, up to `largest_slip` (m), and of rate laws along slip rate, up to `largest_rate` (m/s).

    The keys of both groups are the labels of the curves.
    """
    slip, rate = np.linspace(0.0, largest_slip, 801), np.linspace(0.0, largest_rate, 801)
    along_slip = [law.coefficient(slip) for law in slip_laws.values()]
    along_rate = [law.coefficient(0.0, rate) for law in rate_laws.values()]
    contents = {
        "coefficient_along_slip": curve_quantity(("slip_law", "slip"), along_slip, "friction"),
        "coefficient_along_rate": curve_quantity(("rate_law", "slip_rate"), along_rate, "friction"),
    }
    along = {"slip": curve_quantity("slip", slip, "slip"), "slip_rate": curve_quantity("slip_rate", rate, "slip_rate")}
    laws = {"slip_law": list(slip_laws), "rate_law": list(rate_laws)}
    return xr.Dataset(contents, coords=along | laws, attrs={"title": "The friction laws"})


@styled
def draw_laws(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw two panels: the laws that depend on slip on the left, those that depend on slip rate on the right."""
    figure, axes = panels(1, 2, (7.2, 2.8), place)
    for panel, (along, (laws, _, legend)) in zip(axes[0], PANELS_OF_LAWS.items(), strict=True):
        coefficient = dataset[f"coefficient_along_{along.removeprefix('slip_')}"]
        for i, law in enumerate(dataset[laws].values):
            look = {"color": LINE_COLOURS[i % 4], "linewidth": 1.5 if i == 0 else 1.0}
            panel.plot(shown(dataset[along]), shown(coefficient)[i], label=str(law), **look)
        panel.set(xlabel=label(dataset[along]), ylabel=label(coefficient), ylim=(0, None), xlim=(0, shown(dataset[along])[-1]))
        panel.legend(loc=legend)
    letter_panels(axes[0], [title for _, title, _ in PANELS_OF_LAWS.values()])
    return figure
