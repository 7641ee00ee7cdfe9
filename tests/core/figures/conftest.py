"""Figures of tests open no windows, and every test begins and ends with all figures of pyplot closed."""

from __future__ import annotations

from collections.abc import Iterator

import matplotlib as mpl
import pytest
from matplotlib import pyplot

mpl.use("Agg")


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    pyplot.close("all")  # tests of other folders may have left some
    yield
    pyplot.close("all")
