"""Solutions as netCDF: everything needed to evaluate them again, a drawing of them for other tools, and where they come from."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

import stickslip
from stickslip.errors import InputError
from stickslip.evolution.history import NO_LEAPS, History
from stickslip.evolution.layout import Store
from stickslip.evolution.solution import Curve, Solution
from stickslip.evolution.status import Status
from stickslip.files import write_atomically
from stickslip.observables.choices import choices
from stickslip.scenarios import Scenario, read_scenario
from stickslip.selection import names as rule_names

FORMAT = 1
"""Version of the layout below; a file with another one is refused."""

DRAWN_POINTS = 2000

LONG_NAMES = {
    "slip": "slip of the contact, u",
    "slip_rate": "slip rate of the contact, v",
    "traction": "friction on the contact, tau",
    "load": "load on the contact, beta",
    "state": "state of the friction law",
}

PAPER = "Campillo, Ionescu, Paumier, Renard 1996, Phys. Earth Planet. Inter. 96, 15-23"


def units(solution: Solution) -> dict[str, str]:
    """Unit of each curve of a solution."""
    load, state = solution.problem.load_unit, solution.problem.friction.state
    return {"slip": "m", "slip_rate": "m s-1", "traction": load, "load": load} | ({"state": state.unit} if state else {})


def provenance(solution: Solution) -> dict[str, Any]:
    """Who made this, from what, under which rule and tolerance: attributes of every file and dataset."""
    scenario = Scenario(solution.problem, solution.duration, solution.rtol)
    chosen = choices(solution)
    return {
        "Conventions": "CF-1.11",
        "title": f"stickslip run: {type(solution.problem.body).__name__}, {type(solution.problem.friction).__name__}",
        "source": f"stickslip {stickslip.__version__}",
        "references": PAPER,
        "scenario": scenario.to_toml(),
        "selection_rule": chosen.rule,
        "selection_note": solution.selection_note,
        "selection_regime": chosen.regime,
        "selection_decided_shocks": int(chosen.shocks.sum()),
        "rtol": solution.rtol,
        "duration": solution.duration,
        "status": solution.status.name,
        "status_message": solution.status.message,
        "status_ok": int(solution.status.ok),
    }


def solution_dataset(solution: Solution, t: NDArray[np.float64]) -> xr.Dataset:
    """Slip, slip rate, traction and load at times t (s), right limits, with units and provenance."""
    values = {name: getattr(solution, name)(t) for name in solution.curves}
    return _curves(solution, t, values).assign_attrs(provenance(solution))


def _curves(solution: Solution, t: NDArray[np.float64], values: Mapping[Curve, NDArray[np.float64]]) -> xr.Dataset:
    unit = units(solution)
    variables = {name: ("time", value, {"units": unit[name], "long_name": LONG_NAMES[name]}) for name, value in values.items()}
    time = ("time", t, {"units": "s", "long_name": "time since the start of the run"})
    return xr.Dataset(variables, coords={"time": time})


def save(solution: Solution, path: str | Path) -> Path:
    """Write a solution to a netCDF file (atomically); `load` gives it back bit for bit.

    Besides the history, the file holds curves for drawing (both limits at shocks), the tables of events and shocks, and as
    attributes the version, the full scenario, the selection rule and the tolerance. Raises InputError where the folder cannot
    be written.
    """
    path = Path(path)
    dataset = _history(solution).merge(_drawing(solution)).merge(_tables(solution))
    dataset.attrs = provenance(solution) | {"stickslip_format": FORMAT}
    encoding = {name: {"_FillValue": None} for name, variable in dataset.variables.items() if variable.dtype.kind == "f"}
    try:
        write_atomically(path, lambda draft: dataset.to_netcdf(draft, engine="h5netcdf", encoding=encoding))
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None
    return path


def _history(solution: Solution) -> xr.Dataset:
    store, history = solution.history.store, solution.history
    dataset = xr.Dataset(
        {
            "history_whole": (("piece", "whole_column"), store.whole),
            "history_real": (("piece", "real_column"), store.real),
            "history_load": (("piece", "term"), store.load),
            "history_rate": (("piece", "term"), store.rate),
            "reached": ((), history.duration, {"units": "s", "long_name": "end of the run, less than its duration if it failed"}),
            "row_time": ((), history.row_time, {"units": "s", "long_name": "length of a row of the history"}),
            "ramp": ((), history.ramp, {"units": solution.problem.load_unit, "long_name": "load gained in a row at rest"}),
        }
    )
    if len(history.creep):
        about = {"columns": "start end round_trips error", "units": "s s 1 m", "long_name": "leaps over creep"}
        dataset["history_creep"] = (("creep_leap", "creep_column"), history.creep, about)
    if solution.problem.friction.state is not None:
        about = {"long_name": "state as the law's formulas see it, Taylor coefficients"}
        dataset["history_state"] = (("piece", "term"), store.state, about)
    dataset.history_whole.attrs = {"columns": "row mode law_piece jump cause", "long_name": "pieces of the history, whole numbers"}
    dataset.history_real.attrs = {"columns": "theta_from theta_to speed bend slip law_slip", "units": "s s s s m m"}
    dataset.history_load.attrs = {"long_name": "load minus reference, Taylor coefficients", "units": solution.problem.load_unit}
    dataset.history_rate.attrs = {"long_name": "slip rate, Taylor coefficients", "units": "m s-1"}
    return dataset


def _drawing(solution: Solution) -> xr.Dataset:
    end = float(solution.breaks[-1])
    time, _ = solution.curve("slip_rate", 0.0, end, DRAWN_POINTS)
    return _curves(solution, time, {name: solution.curve(name, 0.0, end, DRAWN_POINTS)[1] for name in solution.curves})


def _tables(solution: Solution) -> xr.Dataset:
    load = solution.problem.load_unit
    unit = {"start": "s", "end": "s", "peak_time": "s", "time": "s", "slip": "m", "pulses": "1", "cause": ""}
    variables = {}
    for prefix, table in (("event", solution.events), ("shock", solution.shocks)):
        for name in table.columns:
            values = table[name].to_numpy(dtype=object if name == "cause" else None)
            known = unit.get(name, "m s-1" if "rate" in name else load)
            variables[f"{prefix}_{name}"] = (prefix, values.astype(str) if name == "cause" else values, {"units": known})
    return xr.Dataset(variables)


def load(path: str | Path) -> Solution:
    """Read a solution that `save` wrote. Raises InputError for a file that is not one."""
    path = Path(path)
    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            dataset = opened.load()
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: not a netCDF file that can be read: {' '.join(str(error).split())}") from None
    if dataset.attrs.get("stickslip_format") != FORMAT:
        found = dataset.attrs.get("stickslip_format", "none")
        raise InputError(f"{path}: not a solution of this version of stickslip (format {FORMAT} expected, found {found})")
    attributes = dataset.attrs
    if attributes["selection_rule"] not in rule_names():
        rule = attributes["selection_rule"]
        raise InputError(f"{path}: made under the selection rule '{rule}', unknown here: stickslip.selection.register it first")
    problem = read_scenario(attributes["scenario"], str(path)).problem
    names = ("history_whole", "history_real", "history_load", "history_rate")
    whole, real, load, rate = (np.ascontiguousarray(dataset[name].to_numpy()) for name in names)
    state = dataset["history_state"].to_numpy() if "history_state" in dataset else np.empty((0, load.shape[1]))
    store = Store(whole, real, load, rate, np.ascontiguousarray(state))
    duration, rtol = float(attributes["duration"]), float(attributes["rtol"])
    creep = dataset["history_creep"].to_numpy() if "history_creep" in dataset else NO_LEAPS
    history = History(store, problem, float(dataset.row_time), float(dataset.ramp), float(dataset.reached), creep)
    status = Status(attributes["status"], attributes["status_message"], bool(attributes["status_ok"]))
    return Solution(problem, duration, rtol, status, history)
