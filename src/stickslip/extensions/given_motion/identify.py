"""Identify a friction law along measured motion: least squares of friction, with the noise of the motion in the covariance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.extensions.given_motion.friction_model import FrictionModel
from stickslip.extensions.given_motion.law_numbers import LawNumber, free_numbers
from stickslip.extensions.given_motion.measured import MeasuredMotion
from stickslip.extensions.given_motion.measured_rate import MeasuredRate, rate_of_record
from stickslip.extensions.given_motion.moved import MovedContact
from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.conversion import to_number
from stickslip.foundation.errors import InputError
from stickslip.friction import FrictionLaw
from stickslip.problem import PiecewiseLinear
from stickslip.problem.scenarios import Scenario, load_scenario

if TYPE_CHECKING:
    from stickslip.extensions.given_motion.identification import Identification


@for_users
def identify(
    law: Any,
    record: Any,
    free: Sequence[str] | str,
    *,
    normal_load: Any = None,
    begin_at: Mapping[str, Any] | None = None,
    bounds: Mapping[str, tuple[Any, Any]] | None = None,
    initial_state: Any = None,
    initial_second_state: Any = None,
    motion_deviation: float | str | None = None,
    smooth: bool = False,
    starts: int = 1,
    seed: int = 0,
    columns: Mapping[str, str | int] | None = None,
) -> Identification:
    """Find the numbers of a friction law, so that it follows friction that was measured along measured motion.

    Only friction's states are solved along the measured slip rate: nothing has to be known of mass, springs or a controller, if
    friction itself was measured (inertia taken off a motor's torque beforehand).

    Parameters
    ----------
    law : FrictionLaw, Scenario, str or Path
        The law with starting values, or a scenario or its file, whose [friction] it is; a [motion] then gives the normal load.
    record : str, Path, DataFrame or mapping
        Columns with headings and units: time; slip_rate (or velocity), or slip (a position; its rate is that of a
        smooth curve); shear_force, shear_stress, torque, or friction (a coefficient); normal_force, normal_stress or normal_torque
        if it was measured. Slip may go in both directions, with friction of its sign.
    free : str or list of str
        The numbers to find: those of the law by name, "record.offset" (a constant of the sensor), and "record.viscous" (friction
        per slip rate that is no part of the law).
    normal_load : float or str, optional
        The normal load where the record has none.
    begin_at, bounds : dict, optional
        Where the search for a number begins, and its lower and upper limit, by name.
    initial_state, initial_second_state : float, str or "steady", optional
        States at the start, as for `MovedContact`.
    motion_deviation : float or str, optional
        Standard deviation of the noise of slip_rate (m/s), or of slip (m); by default that of a column slip_rate_deviation or
        slip_deviation, or else it is estimated.
    smooth : bool, default False
        True also takes a measured slip rate from a smooth curve through it. Slip always is.
    starts : int, default 1
        Starts of the search: the given one, and draws within a factor of three around it.
    seed : int, default 0
        Seed of the starts, and of the draws of the noise of the motion.
    columns : dict, optional
        What headings of the source mean, as {"shear_force": "Fz (N)"}.

    Returns
    -------
    Identification
        Numbers with standard errors and correlations, the law, and friction of the model beside that of the record.

    Raises
    ------
    InputError
        If the record or the numbers cannot be used, in one line.

    Notes
    -----
    A sample whose friction depends steeply on the slip rate knows less where the rate is noisy: its variance is that of the sensor
    plus that of friction under draws of the noise of the motion, to first order sigma_F^2 + (dF/dv)^2 sigma_v^2. The same draws
    enter the covariance as whole curves, because errors of the rate are remembered by states, and errors of a smooth curve resemble
    their neighbours. They also say by how much noise of the motion shifts the numbers; the shift is taken off.
    """
    from stickslip.extensions.given_motion.identification import Identification
    from stickslip.extensions.given_motion.least_squares import searched

    chosen, load = _law_and_load(law, normal_load)
    measured = MeasuredMotion.read(record, columns)
    deviation = None if motion_deviation is None else to_number(motion_deviation, _motion_unit(measured))
    rate = rate_of_record(measured, deviation, smooth=smooth)
    start = {"initial_state": initial_state, "initial_second_state": initial_second_state}
    model = _model(chosen, measured, rate, load, (free, begin_at or {}, start))
    low, high = _limits(model, bounds or {})
    found = searched(model, rate, (low, high), (starts, seed))
    return Identification(model=model, rate_note=rate.note, **found)


def _motion_unit(record: MeasuredMotion) -> str:
    return ("rad" if record.turns else "m") + ("" if record.rate is None else "/s")


def _law_and_load(source: Any, load: Any) -> tuple[FrictionLaw, Any]:
    """Return the law, and the normal load that is given beside it, None if there is none. Raises InputError."""
    if isinstance(source, FrictionLaw):
        return source, load
    if isinstance(source, str | Path):
        source = load_scenario(source)
    if not isinstance(source, Scenario):
        raise InputError(f"identify: law must be a friction law, a scenario or its file, got {shown(source)}")
    what = source.to_solve
    if isinstance(what, MovedContact):
        return what.friction, load if load is not None else what.normal_load
    return source.problem.friction, load if load is not None else f"{source.problem.normal!r} {source.problem.load_unit}"


def _model(
    law: FrictionLaw, record: MeasuredMotion, rate: MeasuredRate, load: Any, asked: tuple[Any, Mapping[str, Any], Mapping[str, Any]]
) -> FrictionModel:
    """Return the model of a record. Raises InputError."""
    free, begin_at, start = asked
    names = free.split(",") if isinstance(free, str) else list(free)
    numbers = free_numbers(law, names, {"record.offset": 0.0, "record.viscous": 0.0})
    begun = {
        next(iter(free_numbers(law, [name], {"record.offset": 0.0, "record.viscous": 0.0}))).name: one
        for name, one in begin_at.items()
    }
    numbers = [replace(one, value=to_number(begun[one.name], one.unit or "1")) if one.name in begun else one for one in numbers]
    normal = _normal(record, load)
    fastest, scatter = float(np.abs(rate.values).max()) or 1.0, float(np.std(record.friction)) or 1.0
    unit = record.unit or "1"
    units = {"record.offset": unit, "record.viscous": "s/m" if unit == "1" else f"{unit} s/{'rad' if record.turns else 'm'}"}
    numbers = [replace(one, unit=units.get(one.name, one.unit)) for one in numbers]
    scales = [_scale(one, fastest, scatter) for one in numbers]
    model = FrictionModel(law, record, rate.values, normal, numbers, start, np.array(scales))
    model.friction(model.begin())  # whatever is wrong with law, load or start is said now
    return model


def _normal(record: MeasuredMotion, load: Any) -> Any:
    """Return the normal load: that of the record, or the one that is given. Raises InputError."""
    if record.normal is not None:
        if not (record.normal > 0.0).all():
            raise InputError(
                f"{record.name}: the normal load must stay above 0 {record.normal_unit}, but falls to {record.normal.min():g}"
            )
        values = [f"{record.normal[0]!r} {record.normal_unit}", *record.normal[1:].tolist()]
        return PiecewiseLinear(record.time.tolist(), values)
    if load is None and record.unit == "":
        return f"1.0 {'N m' if record.turns else 'N'}"  # a coefficient needs none
    if load is None:
        raise InputError(f"{record.name}: no column of the normal load ({', '.join(_NORMALS[record.unit])}): give normal_load")
    return f"{load!r} {record.unit}" if isinstance(load, float | int) and record.unit else load


_NORMALS = {"N": ("normal_force",), "Pa": ("normal_stress",), "N m": ("normal_torque",)}


def _scale(one: LawNumber, fastest: float, scatter: float) -> float:
    """Return a change of a number that changes friction noticeably."""
    if one.name == "record.offset":
        return scatter
    if one.name == "record.viscous":
        return scatter / fastest
    if one.value != 0.0:
        return 1.0 if one.positive else abs(one.value)
    return {"s/m": 0.1 / fastest, "m/s": fastest}.get(one.unit, 0.1)


def _limits(model: FrictionModel, bounds: Mapping[str, tuple[Any, Any]]) -> tuple[Floats, Floats]:
    """Return the lower and the upper limits of the search. Raises InputError."""
    low, high = [], []
    known = {
        free_numbers(model.law, [name], {"record.offset": 0.0, "record.viscous": 0.0})[0].name: pair
        for name, pair in bounds.items()
    }
    for one, size, begin in zip(model.free, model.scales, model.begin(), strict=True):
        by_log = model.by_log(one)
        least = -np.inf if one.least is None else one.least / size
        pair = (begin - np.log(1e3), begin + np.log(1e3)) if by_log else (least, np.inf)
        if one.name in known:
            ends = [to_number(end, one.unit or "1") for end in known[one.name]]
            if not ends[0] < one.value < ends[1]:
                raise InputError(
                    f"identify: bounds of {one.name} must lie around its start {one.value:g}, got {ends[0]:g} to {ends[1]:g}"
                )
            pair = tuple(np.log(max(end, 1e-300)) if by_log else end / size for end in ends)
        low.append(pair[0])
        high.append(pair[1])
    return np.array(low), np.array(high)
