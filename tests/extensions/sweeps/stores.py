"""A small sweep, of which half of the members fail, and the files of its store."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

import stickslip as ss

VARY = {"loading.far_stress_rate": [0.0, 1.0], "body.thickness": np.linspace(5e3, 20e3, 6)}
"""The second half fails: a rigid driver has no far stress."""
SAVED = {"quantities": ["slip", "pulses", "arrested"], "series": ["slip"], "samples": 5, "chunk": 2}
MEMBERS, FINE = 12, 6


def sweep(out: Path | None, **asked: Any) -> xr.Dataset:
    """Return the results of the sweep, or of one that differs from it by what is `asked`."""
    return ss.sweep("fig6-slab", asked.pop("vary", VARY), out=out, **(SAVED | asked))


def files(store: Path) -> dict[str, bytes]:
    """Return the bytes of every file of a store."""
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}
