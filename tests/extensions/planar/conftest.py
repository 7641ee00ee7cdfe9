"""Functions of the planar solver that a test puts in place of others stay in that test."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from stickslip.extensions.planar.solver import functions_of


@pytest.fixture
def compiled_anew() -> Iterator[None]:
    """Let what a test puts in place of a function of the solver come into its compiled code, and stay in no other test's."""
    functions_of.cache_clear()
    yield
    functions_of.cache_clear()
