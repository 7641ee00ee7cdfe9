"""Check that an existing store belongs to the sweep that is to be continued."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import zarr
from zarr.storage import MemoryStore

from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import clean
from stickslip.sweeps.execution.chunk import TIME
from stickslip.sweeps.execution.plan import Plan
from stickslip.sweeps.results.layout import REASON, STATUS, array_of, attributes, lay_out, read_design, reading, results

# Attributes that must agree, and the end of the error message if they do not.
_SAME = {
    "stickslip_sweep": "by another version of stickslip",
    "source": "by another version of stickslip",
    "engine": "by another version of stickslip",
    "scenario": "from another scenario",
}


def as_begun(plan: Plan, path: Path) -> Plan:
    """Return the plan with the chunk shape of an existing store. Raises InputError if the store does not belong to this plan."""
    with reading(path):
        group = zarr.open_group(path, mode="r")
        if "stickslip_sweep" not in group.attrs:
            raise InputError(f"{path}: exists and is not the store of a sweep: choose another name")
        ours = attributes(plan)
        different = next((what for name, what in _SAME.items() if group.attrs.get(name) != ours[name]), None)
        different = different or _design_differs(plan, group)
        if different:
            raise InputError(f"{path}: was made {different}: use the same settings as before, or choose another name")
        begun = replace(plan, tile=read_design(group.attrs)[2])
        _check_arrays(begun, group)
        return begun


def _check_arrays(plan: Plan, group: zarr.Group) -> None:
    """Raise InputError unless the arrays of a store are those that the plan lays out, with all that is known of them."""
    if len(plan.tile) != len(plan.design.shape):
        raise InputError("the shape of its chunks is not that of its members")
    wanted = MemoryStore()
    lay_out(plan, wanted)
    ours, theirs = ({name: array.metadata.to_dict() for name, array in one.arrays()} for one in (zarr.open_group(wanted), group))
    odd = next((name for name in ours if theirs.get(name) != ours[name]), None)
    if odd is not None:
        raise InputError(f"its variable {odd!r} is missing or has another form")


def _design_differs(plan: Plan, group: zarr.Group) -> str:
    """Return in words how the design or the quantities of the store differ from the plan; "" if they agree."""
    design, series = plan.design, plan.work.series
    kind, keys, _ = read_design(group.attrs)
    if keys != list(design.names) or kind != design.kind:
        return f"over {', '.join(keys)} (design {kind})"
    for name, column in zip(design.names, design.columns, strict=True):
        if array_of(group, name).shape != column.shape or not np.array_equal(array_of(group, name)[...], column):
            return f"with other values of {name}"
    others = {*design.names, TIME, STATUS, REASON}
    units = {name: array.attrs.get("units") for name, array in group.arrays() if name not in others}
    if units != {name: about["units"] for name, about in results(plan).items()}:
        return f"for other quantities ({clean(', '.join(sorted(units)))})"
    if series is not None and not np.array_equal(array_of(group, TIME)[...], series.times):
        return "with other samples of time"
    return ""
