"""The figure of schemes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import stickslip as ss
from stickslip.extensions.schemes import figure
from stickslip.figures.runs import energy
from tests.core.figures.legible import BLOCK_PROBLEM, SLAB_PROBLEM, has_unit, illegible, labels
from tests.core.solution.observables.runs import RUNS
from tests.problems import Floats

pytestmark = pytest.mark.usefixtures("closed_figures")


def line(figure: Figure, panel: int, text: str) -> Floats:
    """Return the points of a line, shape (2, n), by the beginning of its name in the legend."""
    (found,) = (one for one in figure.axes[panel].lines if str(one.get_label()).startswith(text))
    return np.array(found.get_data())


DRAWN = {
    "slab": (SLAB_PROBLEM, 12.0, ["elastic", "kinetic", "heat"]),
    "slab, pulses": (*RUNS["slab, slip law"], ["elastic", "kinetic", "heat"]),
    "slab, lossy": (*RUNS["slab, lossy"], ["elastic", "kinetic", "radiated", "heat"]),
    "block": (BLOCK_PROBLEM, 5.0, ["elastic", "kinetic", "heat"]),
    "block, damped": (RUNS["block, damped"][0], 3.0, ["elastic", "kinetic", "damped", "heat"]),
}


@cache
def drawn(name: str) -> tuple[ss.Solution, xr.Dataset]:
    """Return a run and the numbers that its figure shows."""
    problem, duration, _ = DRAWN[name]
    run = ss.simulate(problem, duration, rtol=1e-12)
    return run, energy.energy_data(run)


NAMES = ["characteristics", "theta", "backward-euler", "newmark", "hht"]


def test_the_figure_has_errors_of_all_schemes_and_curves_of_four() -> None:
    study = ss.studies.schemes("fig4-loop", scheme=NAMES, cells=[20, 40])
    drawn = study.plot()
    errors, slip, rate = drawn.axes
    assert [len(line.get_xdata()) for line in errors.lines] == [2] * 5
    texts = [one.text for one in figure.curves(study)]
    assert texts[:4] == [f"{name}, 40 cells" for name in NAMES[:4]]
    assert len(texts) - 4 == len(study.paths.groups()) == 4
    assert texts[-1].startswith(f"exact, {study.problem.rule}")
    assert [len(panel.lines) for panel in (slip, rate)] == [9, 9]  # four schemes, four rules, zero
    factor = study.table.slip_error[0] / errors.lines[0].get_ydata()[0]
    assert (factor * errors.lines[0].get_ydata()).tolist() == pytest.approx(study.table.slip_error[:2].tolist(), rel=1e-12, abs=0.0)


@cache
def run() -> ss.Solution:
    return ss.simulate(SLAB_PROBLEM, 7.0)


def test_it_is_legible_and_names_its_units() -> None:
    figure = ss.studies.schemes("fig4-loop", scheme=["contact-mass", "lag"], cells=[100, 400]).plot()
    assert len(labels(figure)) == 6
    assert all(has_unit(text) for text in labels(figure))
    assert illegible(figure) == []
