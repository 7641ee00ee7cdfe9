"""Figures of studies: several runs side by side, analogies, ensembles and schemes."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def figure_of(study: object) -> Any:
    """Return the module with the functions `data` and `draw` of a study; it has the same name as the study's own module."""
    return import_module(f"{__name__}.{type(study).__module__.rpartition('.')[2]}")
