"""Every test begins and ends with all figures of pyplot closed."""

import pytest


@pytest.fixture(autouse=True)
def _close_figures(closed_figures: None) -> None:
    """Close them."""
