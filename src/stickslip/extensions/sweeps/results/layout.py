"""The layout of the store of a sweep: coordinates, variables and attributes, all created before the first member is run.

A store that exists is checked: whether a sweep has written it, and whether it belongs to the sweep that is to be continued.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
import zarr
from zarr.storage import MemoryStore

import stickslip
from stickslip.engine import engine_key
from stickslip.extensions.sweeps.design.design import GRID, IN_WORDS
from stickslip.extensions.sweeps.execution.chunk import MEANINGS, NOT_RUN, PREFIX, SAMPLE_TIME
from stickslip.extensions.sweeps.execution.plan import Plan
from stickslip.foundation import zarr_folder
from stickslip.foundation.arguments import check_whole, shown
from stickslip.foundation.constants import PAPER
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import for_readers, in_files
from stickslip.foundation.show import clean
from stickslip.solution.files import FolderFormat, about_curves, check_layout

SWEEP_FORMAT = FolderFormat("stickslip_sweep", 2)
STATUS, REASON = "status", "reason"
"""Names of the variables that say how a member ended, and why it failed."""
NUMBERS, WORDS, CODES = "float64", "string", "int8"
"""The zarr data types of numbers, words and status codes."""
FILLS = {NUMBERS: np.nan, WORDS: "", CODES: NOT_RUN}
"""The value of an element that has not been written, by data type."""
_VERSION = ("source", "engine")
"""Attributes of a store that say which version of stickslip has made it, and must be those of this one."""


def lay_out(plan: Plan, place: Any) -> None:
    """Create a store in an empty place, with its attributes and coordinates, and with variables that are still empty."""
    group = zarr.create_group(place, attributes=attributes(plan))
    design, series = plan.design, plan.work.series
    for one, column in zip(design.parameters, design.columns, strict=True):
        about = {"long_name": one.declared.meaning, "log": int(one.name in design.logs)} | ({"units": one.unit} if one.unit else {})
        about |= {"shown_in": one.shown_in} if one.shown_in else {}
        _coordinate(group, one.name, column, (one.name,) if design.is_grid else design.dims, about)
    if series is not None:
        _coordinate(
            group, SAMPLE_TIME, series.times, (SAMPLE_TIME,), {"long_name": "time since the start of the run", "units": "s"}
        )
    for name, about in results(plan).items():
        _variable(group, plan, name, NUMBERS, about)
    _variable(group, plan, REASON, WORDS, {"long_name": "why a member failed"})
    flags = {"flag_values": list(MEANINGS), "flag_meanings": " ".join(MEANINGS.values())}
    _variable(group, plan, STATUS, CODES, {"long_name": "how a member ended"} | flags)


def _coordinate(group: zarr.Group, name: str, values: np.ndarray[Any, Any], dims: tuple[str, ...], about: dict[str, Any]) -> None:
    kind = WORDS if values.dtype.kind == "T" else NUMBERS
    _array(group, name, kind, about, shape=values.shape, chunks=values.shape, dimension_names=dims)[...] = values


def _variable(group: zarr.Group, plan: Plan, name: str, kind: str, about: dict[str, Any]) -> None:
    """Create an empty variable over the members; that of a curve has a further dimension of time."""
    design, series = plan.design, plan.work.series
    samples = {SAMPLE_TIME: len(series.times)} if series and name.startswith(PREFIX) else {}
    _array(
        group,
        name,
        kind,
        about | ({} if design.is_grid else {"coordinates": " ".join(design.names)}),
        shape=(*design.shape, *samples.values()),
        chunks=(*plan.tile, *samples.values()),
        dimension_names=(*design.dims, *samples),
        chunk_key_encoding=zarr_folder.IN_ONE_FOLDER,
    )


def _array(group: zarr.Group, name: str, kind: str, about: dict[str, Any], **layout: Any) -> zarr.Array[Any]:
    layout |= {"compressors": zarr_folder.COMPRESSED, "fill_value": FILLS[kind]}
    return group.create_array(name, dtype=kind, attributes=about, **layout)


def array_of(group: zarr.Group, name: str) -> zarr.Array[Any]:
    """Return a variable or coordinate of a store."""
    found = group[name]
    assert isinstance(found, zarr.Array)
    return found


def results(plan: Plan) -> dict[str, dict[str, Any]]:
    """Return the attributes (name in words, unit, flags) of each result, by the name of its variable."""
    problem, series = plan.scenario.problem, plan.work.series
    found: dict[str, dict[str, Any]] = {}
    for one in plan.work.quantities:
        flags = {"flag_values": [0.0, 1.0], "flag_meanings": "no yes"} if one.is_flag else {}
        ends = {"ends": list(one.ends)} if one.ends else {}
        line = {"line": one.line[0], "line_name": one.line[1]} if one.line else {}
        found[one.name] = {"long_name": one.meaning, "units": in_files(problem.unit_of(one.unit)), **flags, **ends, **line}
    if series is not None:
        known = about_curves(problem)
        found |= {name: dict(known[curve]) for curve, name in zip(series.curves, series.names, strict=True)}
    return found


def attributes(plan: Plan) -> dict[str, Any]:
    """Return the attributes of the store: everything that determines the results, and nothing else."""
    design, scenario = plan.design, plan.scenario
    about = {"design": design.kind, "keys": list(design.names), "chunk": list(plan.tile), "results": list(results(plan))}
    solved = scenario.problem.body if scenario.is_of_core else scenario.to_solve
    found = {
        "Conventions": "CF-1.11",
        "title": f"stickslip sweep: {type(solved).__name__}, {type(scenario.problem.friction).__name__}",
        "source": f"stickslip {stickslip.__version__}",
        "engine": engine_key(*plan.work.code),
        "references": PAPER,
        "scenario": plan.work.text,
        **({"selection_rule": scenario.problem.rule, "rtol": scenario.rtol} if scenario.is_of_core else {}),
        "design": json.dumps(about if design.seed is None else about | {"seed": design.seed}),
    }
    return SWEEP_FORMAT.attributes(found)


# ---- reading what somebody else may have written -----------------------------------------------------------------------------


def read_design(about: Mapping[str, Any]) -> tuple[str, list[str], tuple[int, ...]]:
    """Return the kind of design, the keys and the shape of a chunk from the attributes of a store.

    Raises InputError if they are missing or no sweep can have them.
    """
    try:
        found = json.loads(str(about.get("design")))
        kind, keys, chunk = found["design"], found["keys"], found.get("chunk", [])
        known = kind in (GRID, *IN_WORDS) and isinstance(keys, list) and isinstance(chunk, list)
        known = known and all(isinstance(key, str) and key.isprintable() for key in keys)
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError):
        known = False
    if not known:
        raise InputError(f"its design is {shown(about.get('design'))}")
    return kind, keys, tuple(check_whole("the length of a chunk", one) for one in chunk)


def table_of(found: xr.Dataset) -> pd.DataFrame:
    """Return a row for each member with its parameters, its results and how it ended; headings name units, as "slip (m)".

    Curves over time, which have more than one number for a member, are left out.
    """
    kept = found.drop_vars([name for name, one in found.variables.items() if SAMPLE_TIME in one.dims])
    table = kept.to_dataframe().reset_index()
    table[STATUS] = table[STATUS].map(lambda code: MEANINGS.get(code, str(code)))
    units = {name: for_readers(str(one.attrs.get("units", "1"))) for name, one in kept.variables.items()}
    return table.rename(columns={name: f"{name} ({unit})" for name, unit in units.items() if unit not in ("1", "")})


def in_order(found: xr.Dataset) -> xr.Dataset:
    """Return the dataset of a store with its results in the order of the sweep: zarr lists arrays in an order of its own."""
    named = json.loads(found.attrs["design"]).get("results", [])
    first = [name for name in (named if isinstance(named, list) else []) if isinstance(name, str) and name in found.data_vars]
    return found[list(dict.fromkeys([*first, *found.data_vars]))]


def check_contents(found: xr.Dataset) -> None:
    """Refuse a dataset that no sweep has written: variables, types, dimensions and texts are checked. Raises InputError."""
    _, keys, _ = read_design(found.attrs)
    missing = [name for name in (STATUS, REASON, *keys) if name not in found.variables]
    if missing:
        raise InputError(f"it has no variable {missing[0]!r}")
    own = {*keys, STATUS, REASON}
    for name, variable in found.variables.items():
        about = {key: variable.attrs.get(key, "") for key in ("long_name", "units", "shown_in")}
        texts = [name, *about.values()]
        if not all(isinstance(text, str) and text.isprintable() for text in texts):
            raise InputError(f"the variable {ascii(name)[:60]} has the texts {shown(about)}")
        if name in found.data_vars and name not in own and ("units" not in variable.attrs or variable.dtype.kind not in "if"):
            raise InputError(f"the variable {name!r} is no quantity with a unit")
        if len(set(variable.dims)) < variable.ndim:
            raise InputError(f"the variable {name!r} has a dimension twice")
    if found[STATUS].dtype.kind != "i":
        raise InputError(f"the variable {STATUS!r} has no whole numbers")


# ---- continuing a store -------------------------------------------------------------------------------------------------------


def as_begun(plan: Plan, path: Path, group: zarr.Group) -> Plan:
    """Return the plan with the chunk shape of an existing store. Raises InputError if the store does not belong to this plan."""
    ours = attributes(plan)
    for name in _VERSION:
        theirs = group.attrs.get(name)
        if theirs != ours[name]:
            raise InputError(
                f"{path}: was made by another version of stickslip ({str(theirs)[:60]!a}, this is {ours[name]!r}), which alone"
                " can continue it: choose another name to begin anew"
            )
    different = "from another scenario" if group.attrs.get("scenario") != ours["scenario"] else _design_differs(plan, group)
    if different:
        raise InputError(f"{path}: was made {different}: use the same settings as before, or choose another name")
    begun = replace(plan, tile=read_design(group.attrs)[2])
    if len(begun.tile) != len(plan.design.shape):
        raise InputError("the shape of its chunks is not that of its members")
    wanted = MemoryStore()
    lay_out(begun, wanted)
    check_layout(zarr.open_group(wanted), group)
    return begun


def _design_differs(plan: Plan, group: zarr.Group) -> str:
    """Return in words how the design or the quantities of the store differ from the plan; "" if they agree."""
    design, series = plan.design, plan.work.series
    kind, keys, _ = read_design(group.attrs)
    if keys != list(design.names) or kind != design.kind:
        return f"over {', '.join(keys)} (design {kind})"
    for name, column in zip(design.names, design.columns, strict=True):
        if array_of(group, name).shape != column.shape or not np.array_equal(array_of(group, name)[...], column):
            return f"with other values of {name}"
    others = {*design.names, SAMPLE_TIME, STATUS, REASON}
    units = {name: array.attrs.get("units") for name, array in group.arrays() if name not in others}
    if units != {name: about["units"] for name, about in results(plan).items()}:
        return f"for other quantities ({clean(', '.join(sorted(units)))})"
    if series is not None and not np.array_equal(array_of(group, SAMPLE_TIME)[...], series.times):
        return "with other samples of time"
    return ""
