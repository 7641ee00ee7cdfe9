"""Figure 2 of the paper: friction coefficients as functions of slip or of slip rate."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from stickslip.figures.style import BLUE, GREEN, PURPLE, VERMILLION, label, letter, panels, quantity, shown, styled
from stickslip.friction import FrictionLaw

COLOURS = (BLUE, VERMILLION, GREEN, PURPLE)


def data(
    slip_laws: dict[str, FrictionLaw], rate_laws: dict[str, FrictionLaw], largest_slip: float, largest_rate: float
) -> xr.Dataset:
    """Return mu of slip laws along slip, up to `largest_slip` (m), and of rate laws along slip rate, up to `largest_rate` (m/s).

    The keys of both groups are the labels of the curves.
    """
    slip = np.linspace(0.0, largest_slip, 801)
    rate = np.linspace(0.0, largest_rate, 801)
    along_slip = [law.coefficient(slip) for law in slip_laws.values()]
    along_rate = [law.coefficient(0.0, rate) for law in rate_laws.values()]
    mu = ("friction coefficient", r"\mu", "1")
    return xr.Dataset(
        {
            "coefficient_along_slip": quantity(("slip_law", "slip"), along_slip, *mu),
            "coefficient_along_rate": quantity(("rate_law", "slip_rate"), along_rate, *mu),
        },
        coords={
            "slip": quantity("slip", slip, "slip", "u", "m"),
            "slip_rate": quantity("slip_rate", rate, "slip rate", "v", "m/s"),
            "slip_law": list(slip_laws),
            "rate_law": list(rate_laws),
        },
        attrs={"title": "The friction laws"},
    )


@styled
def draw(dataset: xr.Dataset) -> Figure:
    """Draw two panels: the laws that depend on slip on the left, those that depend on slip rate on the right."""
    figure, axes = panels(1, 2, (7.2, 2.8))
    pairs = (("slip", "slip_law", "coefficient_along_slip"), ("slip_rate", "rate_law", "coefficient_along_rate"))
    titles = ("a   Slip law, eq. (14)", "b   Slip-rate law, eq. (15)")
    for panel, (abscissa, group, name), title in zip(axes[0], pairs, titles, strict=True):
        for i, law in enumerate(dataset[group].values):
            width = 1.5 if i == 0 else 1.0
            panel.plot(shown(dataset[abscissa]), shown(dataset[name])[i], color=COLOURS[i % 4], label=str(law), linewidth=width)
        panel.set(xlabel=label(dataset[abscissa]), ylabel=label(dataset[name]), ylim=(0, None))
        panel.set_xlim(0, float(dataset[abscissa][-1]))
        panel.legend(loc="lower left" if abscissa == "slip" else "upper right")
        letter(panel, title)
    return figure
