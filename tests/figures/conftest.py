"""Every test of a figure begins and ends with all figures of pyplot closed."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from matplotlib import pyplot


@pytest.fixture(autouse=True)
def _close_figures() -> Iterator[None]:
    pyplot.close("all")  # tests of other folders may have left some
    yield
    pyplot.close("all")
