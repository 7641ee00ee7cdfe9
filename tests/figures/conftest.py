"""Figures of tests open no windows, and every test begins and ends with all figures of pyplot closed."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib as mpl
import pytest
from matplotlib import pyplot

mpl.use("Agg")


@pytest.fixture
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw a ninth of the cells of an image, and a quarter of the times of a figure of energies, in as much less time."""
    monkeypatch.setattr("stickslip.figures.runs.inside.TIMES", 300)
    monkeypatch.setattr("stickslip.figures.runs.inside.CELLS", 100)
    monkeypatch.setattr("stickslip.figures.runs.energy.TIMES", 200)


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    pyplot.close("all")  # tests of other folders may have left some
    yield
    pyplot.close("all")
