"""Solutions as netCDF: all that is needed to evaluate and resume them, curves and tables for other tools, and provenance."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

import stickslip
from stickslip.engine import (
    ARRAYS,
    NO_LEAPS,
    SHOCK_COLUMNS,
    TERMS,
    Checkpoint,
    History,
    HistoryPiece,
    SlipEvents,
    Store,
    check_history,
    history_table,
    rule_in_force,
    shock_columns,
)
from stickslip.foundation import netcdf_file
from stickslip.foundation.arguments import as_path
from stickslip.foundation.constants import PAPER
from stickslip.foundation.errors import InputError, printable
from stickslip.foundation.names import QUANTITIES, in_files, name_of, si_unit
from stickslip.foundation.netcdf_file import FullDiskError, Tables, Variable, write_variables
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem import ALL_HISTORIES, ENOUGH_EVENTS, MAY_VARY, STATUSES, LoadingHistory, Problem, Status, default_event_rate
from stickslip.problem import names as rule_names
from stickslip.problem.scenarios import read_scenario
from stickslip.solution.evaluation import Curve, Readings
from stickslip.solution.files.soundness import number
from stickslip.solution.observables.event_table import EVENT_COLUMNS, event_columns
from stickslip.solution.observables.predictability import attributes_of, is_followed, predictability
from stickslip.solution.solution import Solution
from stickslip.solution.window import Window

if TYPE_CHECKING:
    import xarray as xr


FILE_FORMAT = 1
"""Version of the file layout below; a file with another version is refused."""
CATALOGUE = "stickslip_catalogue"
"""Attribute that holds the version in the checkpoint of a catalogue."""
FILE_KINDS = {
    "stickslip_format": "a solution: continue it with stickslip.resume",
    CATALOGUE: "a catalogue's checkpoint: continue it with stickslip.resume",
}
"""Attributes that hold the version, each with a description of the files that have it, for messages."""

DRAWN_POINTS = 2000
"""Number of evenly spaced times of the stored curves, besides the breaking points: enough for a figure."""

AXES = (("numbers",), ("counts",), ("rows", "terms"), ("branches", "levels"), ("one",), ("wave_rows", "cells", "terms"))
"""Names of the dimensions of a checkpoint's arrays, in the order of `ARRAYS`."""


def about_curves(problem: Problem) -> dict[str, dict[str, str]]:
    """Return the attributes units and long_name of each curve of a run, and of its time."""
    found = {name: {"units": in_files(problem.unit_of(name)), "long_name": one.meaning} for name, one in QUANTITIES.items()}
    for name, state in zip(STATE_NAMES, problem.friction.states, strict=False):
        found[name]["units"] = state.unit
    return found


def provenance(solution: Solution) -> dict[str, Any]:
    """Return the attributes of every file and dataset: the program, the scenario, the selection rule, the tolerance, the status.

    They include what the selection rule decided and, for a slab whose echoes can amplify errors, the predictability of the run.
    """
    chosen = solution.rule_influence
    return origin(solution) | {
        "selection_note": chosen.note,
        "selection_regime": chosen.regime,
        "selection_decided_shocks": int(chosen.shocks.sum()),
        **attributes_of(predictability(solution) if is_followed(solution.problem) else None),
    }


def origin(solution: Solution) -> dict[str, Any]:
    """Return those attributes of `provenance` that take no computation."""
    return {
        "Conventions": "CF-1.11",
        "title": f"stickslip run: {type(solution.problem.body).__name__}, {type(solution.problem.friction).__name__}",
        "source": f"stickslip {stickslip.__version__}",
        "references": PAPER,
        "scenario": solution.scenario().to_toml(),
        "selection_rule": solution.problem.rule,
        "rtol": solution.rtol,
        "duration": solution.duration,
        "asked_duration": solution.asked_duration,
        "status": solution.status.name,
        "status_message": solution.status.message,
        "status_ok": int(solution.status.ok),
        "lumping": solution.lumping_note,
        "rounding": solution.rounding_note,
        "proven": solution.proven.text,
    }


def to_dataset(run: Readings, t: ArrayLike, x: ArrayLike | None = None) -> xr.Dataset:
    """Return the curves of a solution, or of a window on it, at times t (s), right limits, with units and provenance.

    The curves are slip, slip rate, traction, load and, if the law has one, the state. With x (m from the contact) the dataset also
    holds the field inside the slab.

    In a window t is local time, s since the start of the event. The event begins `epoch_trip` whole round trips, of
    `round_trip_time` seconds each, and `epoch_offset` seconds after the start of the run: these three are attributes.
    """
    dataset, solution = _readings(run, t, x), run.solution if isinstance(run, Window) else run
    assert isinstance(solution, Solution)
    if isinstance(run, Window):
        dataset.time.attrs["long_name"] = "time since the start of the event"
        about = {"epoch_trip": run.epoch.trip, "epoch_offset": run.epoch.offset, "round_trip_time": run.history.round_trip_time}
        return dataset.assign_attrs(provenance(solution) | about)
    return dataset.assign_attrs(provenance(solution))


def _readings(readings: Readings, t: ArrayLike, x: ArrayLike | None) -> xr.Dataset:
    import xarray as xr

    time = np.atleast_1d(np.asarray(t, float))
    found = _curves(readings, time, {name: getattr(readings, name)(time) for name in readings.curves})
    coords = {"time": found.pop("time")}
    if x is not None:
        where = np.atleast_1d(np.asarray(x, float))
        found |= _field(readings, time, where)
        coords["x"] = Variable(("x",), where, {"units": "m", "long_name": "distance from the contact"})
    return xr.Dataset(found, coords=coords)


def _field(readings: Readings, t: NDArray[np.float64], x: NDArray[np.float64]) -> dict[str, Variable]:
    """Return displacement (m), velocity (m/s) and shear stress (Pa) over times t (s) and distances x (m) from the contact."""
    found = readings.field(x, t[:, None])._asdict()
    since = "since the event began, from where the contact stood then" if "event_slip" in readings.curves else "u"
    load_unit, symbols = readings.problem.load_unit, {"displacement": since, "velocity": "v", "stress": "sigma"}
    about = {
        name: (in_files(si_unit(name, load_unit)), f"{name_of(name, load_unit)}, {symbol}") for name, symbol in symbols.items()
    }
    return {name: Variable(("time", "x"), found[name], {"units": unit, "long_name": text}) for name, (unit, text) in about.items()}


def _curves(solution: Readings, t: NDArray[np.float64], values: Mapping[Curve, NDArray[np.float64]]) -> dict[str, Variable]:
    about = about_curves(solution.problem)
    found = {name: Variable(("time",), value, about[name]) for name, value in values.items()}
    return found | {"time": Variable(("time",), t, about["time"])}


def write_solution(solution: Solution, path: str | Path) -> Path:
    """Write a solution to a netCDF file, as a whole or not at all; `open_solution` gives it back bit for bit. Return the path.

    Besides the history, the file holds curves for drawing (with both limits at shocks), the tables of events and shocks, and as
    attributes the version, the full scenario, the selection rule and the tolerance. Raises InputError if the file cannot be
    written. If the disk is full, it is a FullDiskError, whose attribute `solution` is the solution, to be saved elsewhere; if a
    loading history is not registered, the file could not be read back.
    """
    file = as_path("to_netcdf: path", path)
    names = [name for name in solution.curves if name not in solution.at_drive]
    time, values = solution.curves_together(names, 0.0, float(solution.breaks[-1]), DRAWN_POINTS)
    curves = _curves(solution, time, dict(zip(names, values, strict=True)))
    variables = history_variables(solution) | curves | _at_drive(solution) | _tables(solution)
    try:
        return write_variables(variables, _engine(solution) | provenance(solution) | {"stickslip_format": FILE_FORMAT}, file)
    except FullDiskError as error:
        error.solution = solution
        raise


def _at_drive(solution: Solution) -> dict[str, Variable]:
    """Return what the drive of a string measures at evenly spaced times, which are its own: other curves have those of shocks."""
    if not solution.at_drive:
        return {}
    time, about = np.linspace(*solution.shown, DRAWN_POINTS), about_curves(solution.problem)
    found = {name: Variable(("drive_time",), getattr(solution, name)(time), about[name]) for name in solution.at_drive}
    return found | {"drive_time": Variable(("drive_time",), time, about["time"])}


def save_checkpoint(solution: Solution, path: Path, about: dict[str, Any] | None = None) -> None:
    """Write only what `open_solution` and `resume` need of a run under way, without curves and tables, to save time.

    `about` holds the attributes of a checkpoint that is not a solution. A full disk does not end the run: the previous checkpoint
    stays in the file, and a warning says so.
    """
    attributes = _engine(solution) | origin(solution) | (about or {"stickslip_format": FILE_FORMAT})
    try:
        write_variables(history_variables(solution), attributes, path)
    except FullDiskError as error:
        warnings.warn(f"{error}; the run continues, and the previous file is unchanged", RuntimeWarning, stacklevel=2)


HISTORY_AXES = {name: ("piece", "term") if place.inside else ("piece",) for name, place in HistoryPiece.places.items()}
"""Dimensions of the variable of each field of the history's pieces."""
HISTORY_UNITS = {
    **dict.fromkeys(("phase_from", "phase_to", "speed", "bend"), "s"),
    **{"slip": "slip", "law_slip": "slip", "rate": "slip_rate", "load": "load", "residual": "load"},
}
"""Units of these variables, unless they are pure numbers, as `names.si_unit` understands them."""


def history_variables(solution: Solution) -> dict[str, Variable]:
    """Return the history, and the state of the engine at its end if it is known.

    Raises InputError for a loading history that is not registered, because the file could not be read back.
    """
    for loading in (getattr(solution.problem, name) for name in MAY_VARY):
        if isinstance(loading, LoadingHistory) and ALL_HISTORIES.get(loading.kind) is not type(loading):
            name, place = type(loading).__name__, f'stickslip.loading.HISTORIES["{loading.kind}"]'
            raise InputError(f"save: files do not know {name}: set {place} = {name}")
    variables = _history(solution)
    if solution.checkpoint is not None:
        axes = {name: tuple(f"engine_{axis}" for axis in of) for name, of in zip(ARRAYS, AXES, strict=True)}
        arrays = {name: getattr(solution.checkpoint, name) for name in ARRAYS}
        variables |= {f"engine_{name}": Variable(axes[name], array) for name, array in arrays.items() if array.size}
    return variables


def _history(solution: Solution) -> dict[str, Variable]:
    store, history, load = solution.history.store, solution.history, solution.problem.load_unit
    known = {"load": "load minus reference", "rate": "slip rate"}
    variables = {}
    for name, axes in HISTORY_AXES.items():
        meaning = f"{known[name]}, Taylor coefficients" if name in known else f"{name} of a piece of the history"
        unit = in_files(si_unit(HISTORY_UNITS.get(name, "1"), load))
        variables[f"history_{name}"] = Variable(axes, getattr(store, name), {"units": unit, "long_name": meaning})
    end = "end of the run, less than the duration asked for if it ended early"
    variables |= {
        "reached": Variable((), history.duration, {"units": "s", "long_name": end}),
        "round_trip_time": Variable((), history.round_trip_time, {"units": "s", "long_name": "length of a row of the history"}),
        "ramp": Variable((), history.ramp, {"units": load, "long_name": "load gained in a row at rest"}),
    }
    if len(history.creep):
        about = {
            "columns": "start_row round_trips error time_error",
            "units": f"1 1 {si_unit('slip', load)} s",
            "long_name": "leaps over creep",
        }
        variables["history_creep"] = Variable(("creep_leap", "creep_column"), history.creep, about)
    if solution.problem.kept_series:
        about = {"long_name": "states as the law's formulas see them, and rate of a machine behind layers: Taylor coefficients"}
        variables["history_state"] = Variable(("piece", "state_variable", "term"), store.state, about)
    if history.begun_with is not None:
        about = {"long_name": "waves with which the body began, minus the reference: Taylor coefficients"}
        variables["history_begun_with"] = Variable(("first_piece", "layer_cell", "term"), history.begun_with, about)
    return variables


def _engine(solution: Solution) -> dict[str, Any]:
    """Return the attribute with the hash of the engine's code, if the state of the engine is known."""
    return {} if solution.checkpoint is None else {"engine": solution.checkpoint.engine}


def _tables(solution: Solution) -> dict[str, Variable]:
    history, load = solution.history, solution.problem.load_unit
    shock = {name: (unit, "") for name, unit in SHOCK_COLUMNS.items()}
    shock["rule"] = ("", "selection rule, where several slip rates are possible")
    event = {name: one.about for name, one in EVENT_COLUMNS.items()}
    events = event_columns(history, SlipEvents.of(history, default_event_rate(solution.problem)))
    shocks = shock_columns(history)
    shocks["rule"] = [rule_in_force(solution.problem)] * len(shocks["cause"]) if shocks["cause"] else []
    variables = {}
    for prefix, table, columns in (("event", events, event), ("shock", shocks, shock)):
        for name, values in table.items():
            unit, meaning = columns[name]
            about = {"units": in_files(si_unit(unit, load))} | ({"long_name": meaning} if meaning else {})
            found = np.asarray(values, str) if name in ("cause", "rule") else np.asarray(values)
            variables[f"{prefix}_{name}"] = Variable((prefix,), found, about)
    return variables


def read_solution(path: Path) -> Solution:
    """Read a solution from a netCDF file, and raise InputError, as `open_solution` does."""
    return to_solution(read(path), path)


def read(path: Path, kind: str = "stickslip_format") -> Tables:
    """Read a file of stickslip whose version is stored in the attribute `kind`. Raises InputError for any other file."""
    what = FILE_KINDS[kind].partition(":")[0]
    tables = netcdf_file.read_tables(path, what)
    if tables.attrs.get(kind) != FILE_FORMAT:
        other = next((FILE_KINDS[attribute] for attribute in FILE_KINDS if attribute != kind and attribute in tables.attrs), None)
        found = f"it is {other}" if other else f"format {FILE_FORMAT} expected, found {tables.attrs.get(kind, 'none')}"
        raise InputError(f"{path}: not {what} of this version of stickslip ({found})")
    return tables


def is_catalogue(path: Path) -> bool:
    """Return True if a file is the checkpoint of a catalogue."""
    return CATALOGUE in netcdf_file.attributes(path)


def to_solution(tables: Tables, path: Path) -> Solution:
    """Return the solution in tables that were read from `path`.

    Raises InputError if a part is missing, a number is out of range, or the selection rule is not registered.
    """
    if "time" in tables.sizes and "scenario" in tables.attrs and "history_rate" not in tables.variables:
        whole = "`stickslip run --out` keeps a whole run"
        raise InputError(f"{path}: holds curves of a run, not the run: xarray.open_dataset reads them; {whole}")
    try:
        found = _solution(tables, path)
    except InputError:
        raise
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError) as error:
        raise InputError(
            f"{path}: not a file that stickslip has written: {' '.join(str(error).split())} is missing or wrong"
        ) from None
    check_history(found.history, path)
    return found


def _solution(tables: Tables, path: Path) -> Solution:
    attributes, has = tables.attrs, tables.variables
    if attributes["selection_rule"] not in rule_names():
        rule = attributes["selection_rule"]
        raise InputError(f"{path}: made under the selection rule '{rule}', unknown here: stickslip.selection.register it first")
    scenario = read_scenario(attributes["scenario"], str(path))
    columns = {name: tables.array(f"history_{name}") for name in HISTORY_AXES}
    state = tables.array("history_state") if "history_state" in has else np.empty((0, 0, TERMS))
    if state.ndim == 2:  # a file from before laws of two states
        state = state[:, None]
    asked = number(attributes, "asked_duration" if "asked_duration" in attributes else "duration", path)  # older files: asked alone
    rtol = number(attributes, "rtol", path)
    store = Store(history_table(columns, path), state)
    creep = tables.array("history_creep") if "history_creep" in has else NO_LEAPS
    round_trip_time, ramp, reached = (float(tables.array(name).item()) for name in ("round_trip_time", "ramp", "reached"))
    ended, why = (printable(str(attributes[name])) for name in ("status", "status_message"))
    status = Status(ended, why, bool(attributes["status_ok"]))
    counted = scenario.max_events if status.name == STATUSES[ENOUGH_EVENTS].name else None
    given = tables.array("history_begun_with") if "history_begun_with" in has else None
    history = History(store, scenario.problem, round_trip_time, ramp, reached, creep=creep, max_events=counted, begun_with=given)
    checkpoint = None
    if "engine" in attributes:
        arrays = {name: tables.array(f"engine_{name}") for name in ARRAYS if name != "waves" or "engine_waves" in has}
        checkpoint = Checkpoint(**arrays, engine=str(attributes["engine"]))
    lumping, rounding = (printable(str(attributes.get(name, ""))) for name in ("lumping", "rounding"))
    options = replace(scenario.options, duration=asked, rtol=rtol)
    return Solution(scenario.problem, options, status, history, checkpoint, lumping, rounding)
