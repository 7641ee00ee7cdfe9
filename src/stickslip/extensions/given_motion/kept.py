"""Files of runs along given motions: the steps, what was solved, and which version did it; read with suspicion."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

import stickslip
from stickslip.engine import engine_key
from stickslip.extensions.given_motion.along import FrictionAlongMotion, in_intervals
from stickslip.extensions.given_motion.compiled import along_motion as at
from stickslip.extensions.given_motion.compiled.nodes import PLACES_IN_STEP
from stickslip.extensions.given_motion.moved import MARK, MovedContact
from stickslip.extensions.given_motion.solve import StepsOfStates
from stickslip.extensions.given_motion.table import MOTION, GivenMotion, MotionTable
from stickslip.foundation import netcdf_file
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import FullDiskError, Tables, Variable
from stickslip.problem import INTERRUPTED, STATUSES, UNDER_WAY, Stop

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.intervals import MotionInIntervals
    from stickslip.problem.scenarios import Scenario

VERSION = 1
"""Version of the format of these files."""
CODE = ("extensions/given_motion/compiled", "extensions/given_motion/solve.py", "extensions/given_motion/intervals.py")
"""What decides the digits of a run, beside the engine."""
STEPS = {
    "interval": (("step",), "1", "the interval of the motion that holds a step"),
    "since": (("step",), "s", "start of a step since the start of its interval"),
    "length": (("step",), "s", "length of a step"),
    "tried": (("step",), "s", "length with which the next step was begun"),
    "values": (("step", "state_variable", "point"), "", "states at Radau's points, as formulas use them"),
    "errors": (("step", "state_variable"), "", "bounds of the errors of the states at the ends of steps"),
}
"""Axes, unit and meaning of each field of the steps."""
SAME_STATE = 1e-9
"""A state behind a jump or a turn is what follows from that before it, to this share (1) of its size."""
MEANINGS = {
    "time": "time",
    "slip": "slip",
    "slip_rate": "slip rate",
    "normal_load": "normal load",
    "traction": "traction; no number at rest, where any between the bounds is possible",
    "lowest_traction": "lowest traction that is possible",
    "highest_traction": "highest traction that is possible",
    "coefficient": "friction coefficient",
    "error": "bound of the error of the traction",
    "state": "state of the law",
    "second_state": "second state of the law",
}
"""What the curves in a file are."""


def scenario_of_motion(moved: MovedContact, duration: float, rtol: float, title: str = "", description: str = "") -> Scenario:
    """Return the scenario of a run. Raises InputError for a law or a history that a scenario cannot name."""
    from stickslip.problem.scenarios import Source, scenario_of, to_table

    starts = dict(zip(("initial_state", "initial_second_state"), moved.given_states, strict=False))
    given = GivenMotion(moved.slip_rate, moved.normal_load, moved.load_unit, moved.initial_slip, **starts)
    document = {"title": title, "description": description, "friction": to_table(moved.friction)}
    document |= {MOTION: MotionTable().write(given), "run": {"duration": duration, "rtol": rtol}}
    return scenario_of(document, Source("save"))


def text_of(moved: MovedContact, run: Any) -> str:
    """Return the scenario of a run, or of its options, as TOML text. Raises InputError for what a file cannot say."""
    duration = getattr(run, "asked_duration", run.duration)
    return scenario_of_motion(moved, duration, run.rtol, run.title, run.description).to_toml()


def curves_of(run: FrictionAlongMotion) -> dict[str, Variable]:
    """Return the curves at the times that show a run, with their units."""
    table, units = run.at(run.times), run.units
    about = {name: {"units": units[name], "long_name": meaning} for name, meaning in MEANINGS.items() if name in table}
    return {name: Variable(("time",), table[name].to_numpy(), about[name]) for name in about}


def provenance(run: FrictionAlongMotion) -> dict[str, Any]:
    """Return what says where a file comes from: the program, the scenario, the tolerance, and what ended the run."""
    return {
        "Conventions": "CF-1.11",
        "title": f"stickslip run: {type(run.moved.friction).__name__} along a given motion",
        "source": f"stickslip {stickslip.__version__}",
        "scenario": text_of(run.moved, run),
        "rtol": run.rtol,
        "duration": run.duration,
        "asked_duration": run.asked_duration,
        "status": run.status.name,
        "status_message": run.status.message,
        "status_ok": int(run.status.ok),
    }


def write_motion(run: FrictionAlongMotion, path: Path) -> Path:
    """Write a run to a netCDF file, as a whole or not at all, and return the path. Raises InputError."""
    return netcdf_file.write_variables(_steps_of(run) | curves_of(run), provenance(run) | _mark(), path)


def write_curves(run: FrictionAlongMotion, path: Path) -> Path:
    """Write the curves of a run alone to a netCDF file, and return the path. Raises InputError."""
    return netcdf_file.write_variables(curves_of(run), provenance(run), path)


def save_checkpoint(run: FrictionAlongMotion, path: Path) -> None:
    """Write what a run under way needs to go on. A full disk does not end it: the file before stays, and a warning says so."""
    try:
        netcdf_file.write_variables(_steps_of(run), provenance(run) | _mark(), path)
    except FullDiskError as error:
        warnings.warn(f"{error}; the run continues, and the previous file is unchanged", RuntimeWarning, stacklevel=2)


def _mark() -> dict[str, Any]:
    return {MARK: VERSION, "engine": engine_key(*CODE)}


def _steps_of(run: FrictionAlongMotion) -> dict[str, Variable]:
    if run.steps is None:
        return {}
    about = {name: {"units": unit, "long_name": text} if unit else {"long_name": text} for name, (_, unit, text) in STEPS.items()}
    return {f"step_{name}": Variable(axes, getattr(run.steps, name), about[name]) for name, (axes, _, _) in STEPS.items()}


def check_same_code(path: Path) -> None:
    """Refuse to go on with a run that other code has made. Raises InputError."""
    made, here = netcdf_file.attributes(path).get("engine"), engine_key(*CODE)
    if made != here:
        raise InputError(
            f"{path}: cannot be resumed: another version of stickslip's code made it ({made}, this is {here}), which would go on"
            " in other digits; run it again from the start"
        )


def read_motion(path: Path) -> FrictionAlongMotion:
    """Read a run that `write_motion` wrote. Raises InputError for any other file, and for numbers that no run can have."""
    return motion_in(tables_in(path), path)


def tables_in(path: Path) -> Tables:
    """Return the tables of a file whose checksum is right. Raises InputError."""
    return netcdf_file.read_tables(path, "a run of a MovedContact")


def motion_in(tables: Tables, path: Path) -> FrictionAlongMotion:
    """Return the run in the tables of a file. Raises InputError as `read_motion` does."""
    if tables.attrs.get(MARK) != VERSION:
        found = f"format {VERSION} expected, found {tables.attrs.get(MARK, 'none')}"
        raise InputError(f"{path}: not a run of a MovedContact of this version of stickslip ({found})")
    try:
        return _run_in(tables, path)
    except InputError:
        raise
    except (KeyError, TypeError, AttributeError, ValueError, OverflowError, IndexError) as error:
        said = " ".join(str(error).split())[:200]
        raise InputError(f"{path}: not a file that stickslip has written: {said} is missing or wrong") from None


def _run_in(tables: Tables, path: Path) -> FrictionAlongMotion:
    from stickslip.problem.scenarios import read_scenario

    scenario = read_scenario(str(tables.attrs["scenario"]), str(path))
    moved = scenario.to_solve
    if not isinstance(moved, MovedContact):
        raise InputError(f"{path}: not a file that stickslip has written: its scenario has no [{MOTION}]")
    asked = float(scenario.duration)
    motion = in_intervals(moved, asked)
    steps, reached = None, asked
    if moved.friction.states:
        steps = StepsOfStates(*(tables.array(f"step_{name}") for name in STEPS))
        check_steps(steps, moved, motion, path)
        last = int(steps.interval[-1])
        end = float(steps.since[-1] + steps.length[-1])
        if last < len(motion.start) - 1 or end < motion.lasting[last] * (1.0 - at.SHORTEST_STEP):
            reached = float(motion.start[last] + end)
    codes = (Stop.FINISHED,) if reached == asked else (INTERRUPTED, UNDER_WAY)
    status = next((STATUSES[one] for one in codes if STATUSES[one].name == tables.attrs["status"]), None)
    if status is None:
        raise _no_run(
            path, f"it has reached {reached:.9g} of {asked:.9g} s, and its status is {str(tables.attrs['status'])[:60]!r}"
        )
    return FrictionAlongMotion(moved, reached, scenario.rtol, scenario.title, motion, steps, asked, status, scenario.description)


def check_steps(steps: StepsOfStates, moved: MovedContact, motion: MotionInIntervals, path: Path) -> None:
    """Refuse steps that no run along a motion can leave. Raises InputError."""
    many, count = len(moved.friction.states), steps.length.size
    shapes = {name: np.shape(getattr(steps, name)) for name in STEPS}
    wanted: dict[str, tuple[int, ...]] = dict.fromkeys(("interval", "since", "length", "tried"), (count,))
    wanted |= {"values": (count, many, PLACES_IN_STEP), "errors": (count, many)}
    for name, shape in shapes.items():
        array = getattr(steps, name)
        if shape != wanted[name] or array.dtype != (np.int64 if name == "interval" else np.float64) or not count:
            raise _no_run(path, f"step_{name} is an array of {array.dtype} of shape {shape}, and should be {wanted[name]}")
    if not (steps.errors >= 0.0).all():
        raise _no_run(path, "step_errors are bounds, and must be at least 0")
    for name in ("since", "length", "tried", "values"):
        if not np.isfinite(getattr(steps, name)).all():
            raise _no_run(path, f"step_{name} must be finite")
    if not ((steps.length > 0.0).all() and (steps.tried > 0.0).all()):
        raise _no_run(path, "lengths of steps must be above 0")
    _check_order(steps, motion, path)
    _check_joints(steps, moved, motion, path)


def _check_order(steps: StepsOfStates, motion: MotionInIntervals, path: Path) -> None:
    """Refuse steps that do not follow each other in time. Raises InputError."""
    enters = np.diff(steps.interval, prepend=-1)
    if steps.interval[-1] >= len(motion.start) or not np.isin(enters, (0, 1)).all() or enters[0] != 1:
        raise _no_run(path, "its steps are not in the intervals of its motion one after the other")
    ends = steps.since + steps.length
    begins = np.where(enters == 1, 0.0, np.append(0.0, ends[:-1]))
    lasting = motion.lasting[steps.interval]
    leaves = np.append(enters[1:] == 1, False)
    whole = ends >= lasting * (1.0 - at.SHORTEST_STEP)
    if (steps.since != begins).any() or (ends > lasting * (1.0 + at.SHORTEST_STEP)).any() or (leaves & ~whole).any():
        raise _no_run(path, "its steps leave gaps in time, or overlap")


def _check_joints(steps: StepsOfStates, moved: MovedContact, motion: MotionInIntervals, path: Path) -> None:
    """Refuse states that jump where they cannot. Raises InputError."""
    law, table = moved.friction, motion.table()
    start = np.array(law.inner_states(moved.given_states), float)[None]
    before, begins = np.concatenate((start, steps.values[:-1, :, -1])), steps.values[:, :, 0]
    enters = np.diff(steps.interval, prepend=-1) == 1
    if (before[~enters] != begins[~enters]).any():
        raise _no_run(path, "its states jump inside an interval")
    found, rows = before[enters], table[steps.interval[enters]]
    found[:, 0] -= law.normal_coupling * rows[:, at.LOAD_GROWTH]
    back = np.array([one.reverses for one in law.states]) & (rows[:, at.TURNS_BACK] != 0.0)[:, None]
    found = np.where(back, -found, found)
    if not np.allclose(found, begins[enters], rtol=SAME_STATE, atol=SAME_STATE * float(np.abs(steps.values).max())):
        raise _no_run(path, "its states jump where the motion does not")


def _no_run(path: Path, why: str) -> InputError:
    return InputError(f"{path}: not a file that stickslip has written: {why}")
