"""Figure 2 of the paper: friction coefficients as functions of slip or of slip rate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Unpack

import numpy as np
import xarray as xr

from stickslip.figures.panels import letter_panels, panels
from stickslip.figures.style import LINE_COLOURS, curve_quantity, label, quantity, shown, styled
from stickslip.friction import FrictionLaw
from stickslip.solution.place import Place

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PANELS = {
    "slip": ("slip_law", "Slip law, eq. (14)", "lower left"),
    "slip_rate": ("rate_law", "Slip-rate law, eq. (15)", "upper right"),
}
"""Panels by their abscissa: the dimension of the laws, the title and the place of the legend."""


def data(
    slip_laws: Mapping[str, FrictionLaw], rate_laws: Mapping[str, FrictionLaw], largest_slip: float, largest_rate: float
) -> xr.Dataset:
    """Return mu of slip laws along slip, up to `largest_slip` (m), and of rate laws along slip rate, up to `largest_rate` (m/s).

    The keys of both groups are the labels of the curves.
    """
    slip, rate = np.linspace(0.0, largest_slip, 801), np.linspace(0.0, largest_rate, 801)
    along_slip = [law.coefficient(slip) for law in slip_laws.values()]
    along_rate = [law.coefficient(0.0, rate) for law in rate_laws.values()]
    contents = {
        "coefficient_along_slip": quantity(("slip_law", "slip"), along_slip, "friction coefficient", r"\mu", "1"),
        "coefficient_along_rate": quantity(("rate_law", "slip_rate"), along_rate, "friction coefficient", r"\mu", "1"),
    }
    along = {"slip": curve_quantity("slip", slip, "slip"), "slip_rate": curve_quantity("slip_rate", rate, "slip_rate")}
    laws = {"slip_law": list(slip_laws), "rate_law": list(rate_laws)}
    return xr.Dataset(contents, coords=along | laws, attrs={"title": "The friction laws"})


@styled
def draw(dataset: xr.Dataset, **place: Unpack[Place]) -> Figure:
    """Draw two panels: the laws that depend on slip on the left, those that depend on slip rate on the right."""
    figure, axes = panels(1, 2, (7.2, 2.8), place)
    for panel, (along, (laws, _, legend)) in zip(axes[0], PANELS.items(), strict=True):
        coefficient = dataset[f"coefficient_along_{along.removeprefix('slip_')}"]
        for i, law in enumerate(dataset[laws].values):
            look = {"color": LINE_COLOURS[i % 4], "linewidth": 1.5 if i == 0 else 1.0}
            panel.plot(shown(dataset[along]), shown(coefficient)[i], label=str(law), **look)
        panel.set(xlabel=label(dataset[along]), ylabel=label(coefficient), ylim=(0, None), xlim=(0, shown(dataset[along])[-1]))
        panel.legend(loc=legend)
    letter_panels(axes[0], [title for _, title, _ in PANELS.values()])
    return figure
