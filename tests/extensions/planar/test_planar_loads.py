"""A planar run loads what it runs, and neither the exact engine nor its compiler."""

from __future__ import annotations

import pytest
from benchmarks.loaded import THINGS, lines_of, loaded

MOST = 17_200
"""Largest number of lines of the package that may be loaded; measured are 16 836."""


@pytest.mark.slow
def test_a_planar_run_loads_neither_the_engine_nor_the_compiler() -> None:
    modules = loaded(THINGS["planar"])
    assert {"stickslip.extensions.planar.step", "jax"} <= set(modules)
    assert [name for name in modules if name == "numba" or name.startswith("stickslip.engine")] == []
    assert sum(lines_of(modules).values()) <= MOST
