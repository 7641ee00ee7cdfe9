"""Check that an existing store belongs to the sweep that is to be continued."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import zarr

from stickslip.foundation.errors import InputError
from stickslip.sweeps.design.series import TIME
from stickslip.sweeps.execution.plan import Plan
from stickslip.sweeps.results.layout import REASON, STATUS, array_of, attributes, results

# Attributes that must agree, and the end of the error message if they do not.
_SAME = {
    "stickslip_sweep": "by another version of stickslip",
    "source": "by another version of stickslip",
    "engine": "by another version of stickslip",
    "scenario": "from another scenario",
}


def as_begun(plan: Plan, path: Path) -> Plan:
    """Return the plan with the chunk shape of an existing store. Raises InputError if the store does not belong to this plan."""
    try:
        group = zarr.open_group(path, mode="r")
        if "stickslip_sweep" not in group.attrs:
            raise KeyError("stickslip_sweep")
    except (OSError, ValueError, KeyError):
        raise InputError(f"{path}: exists and is not the store of a sweep: choose another name") from None
    ours = attributes(plan)
    different = next((what for name, what in _SAME.items() if group.attrs.get(name) != ours[name]), None)
    different = different or _design_differs(plan, group)
    if different:
        raise InputError(f"{path}: was made {different}: use the same settings as before, or choose another name")
    return replace(plan, tile=tuple(json.loads(str(group.attrs["design"]))["chunk"]))


def _design_differs(plan: Plan, group: zarr.Group) -> str:
    """Return in words how the design or the quantities of the store differ from the plan; "" if they agree."""
    design, series = plan.design, plan.work.series
    theirs = json.loads(str(group.attrs["design"]))
    if theirs["keys"] != list(design.names) or theirs["design"] != design.kind:
        return f"over {', '.join(theirs['keys'])} (design {theirs['design']})"
    for name, column in zip(design.names, design.columns, strict=True):
        if not np.array_equal(array_of(group, name)[...], column):
            return f"with other values of {name}"
    others = {*design.names, TIME, STATUS, REASON}
    units = {name: array.attrs["units"] for name, array in group.arrays() if name not in others}
    if units != {name: about["units"] for name, about in results(plan).items()}:
        return f"for other quantities ({', '.join(sorted(units))})"
    if series is not None and not np.array_equal(array_of(group, TIME)[...], series.times):
        return "with other samples of time"
    return ""
