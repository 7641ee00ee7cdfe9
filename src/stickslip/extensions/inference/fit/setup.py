"""Set up an inference: choose the quantities to fit, the parts of a record, and the start of each run."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip.extensions.inference.fit.asides import rounded, with_asides
from stickslip.extensions.inference.fit.asked import FITTED_KINDS
from stickslip.extensions.inference.fit.at_drive import is_level_at_first
from stickslip.extensions.inference.fit.free import DELAY, DRIFT, INITIAL_STATE, LOAD, SERVO, TREND, Free, Prior, known_numbers
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import SAMPLES_OF_PART, Part
from stickslip.extensions.inference.record.features import arrests_in
from stickslip.extensions.inference.record.loading import loading_of, normal_of
from stickslip.extensions.inference.record.record import HIGHEST, LOWEST, MEASURED, SHEAR, SHEAR_IN, Record, is_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.headings import KNOWN_COLUMNS
from stickslip.foundation.names import KINDS_OF_BODY, QUANTITIES, TURNS
from stickslip.foundation.show import brief
from stickslip.friction import FrictionLaw
from stickslip.problem import PiecewiseLinear, Problem, features

NOT_FITTED = (features.DRIVER_THAT_CHANGES, features.ONE_WAY, features.MOVING_GROUND)
"""What a problem may not have that is fitted to a record."""
STARTS = ("steady", "record", "problem")
"""How a run may begin: in steady sliding at the first rate, with the load of the first samples, or as the problem says."""
SENSORS = ("contact", "spring", "drive")
"""Where shear is measured: at the contact, behind the spring of a block, or at the driver, as the torque of a top drive."""
UNEVEN = 0.03
"""A measured normal load that changes by more than this share (1) is told if the run takes it as constant."""
LATER = 0.05
"""Share of the samples after a slip event that still belong to the part before it: noise decides which sample is the lowest."""


def parts_of(
    problem: Problem, records: Sequence[Record], observe: Any, start: str | None, sensor: str, *, pressed: bool = False
) -> tuple[list[Part], list[str]]:
    """Return a part for each record, and sentences on what was done. Raises InputError if options and records do not match.

    `pressed` says that the normal load is that of the record.
    """
    if sensor not in SENSORS:
        raise InputError(f"infer: sensor {ascii(sensor)[:40]} is unknown; {nearest(str(sensor), SENSORS)}")
    of_kind = FITTED_KINDS[problem.body.structure]
    of_kind.check_sensor(problem.body, sensor)
    features.refuse("infer", problem, dict.fromkeys(NOT_FITTED, "is not fitted"))
    if start is not None and start not in STARTS:
        raise InputError(f"infer: start {ascii(start)[:40]} is unknown; {nearest(str(start), STARTS)}")
    found, notes = list[Part](), []
    for given in records:
        record = given.of_motion(problem.unit_of("slip"), type(problem.body).__name__)
        record = record.driven_as_measured() if "drive_rate" in _split(observe) else record
        loading = loading_of(record)
        observed = _observed(record, observe, problem, sensor)
        away = of_kind.is_away(record, sensor)
        begins = start or ("steady" if problem.friction.states and not problem.friction.sticks else "record")
        if start is None and begins == "record" and (record.shear is None or away):
            begins = "steady" if away and is_level_at_first(record, problem) else "problem"
        if record.clock[-1] <= 0.0:
            raise InputError(f"{record.name}: the record has no duration")
        pressing, told = _pressing(problem, record) if pressed else (None, tuple(_uneven(problem, record)))
        pull = None if loading is None else loading.rate
        found.append(with_asides(Part(record, pull, observed, sensor, begins, pressing, away), len(found)))
        told = (*told, *rounded(found[-1]))
        before = f"{record.name}: " if len(records) > 1 else ""
        said = [*record.notes, *told, *(() if loading is None else loading.notes)]
        rate = found[-1].loading  # a servo that rounds the corners is none of its turns
        said += () if rate is None else of_kind.doubts_of_rate(problem, rate)
        said += of_kind.about_drive(problem, record, sensor, start, begins)
        if loading is None:
            said.append("the record has no load point: the loading is that of the problem")
        notes += [before + one for one in said]
    return found, list(dict.fromkeys(notes))


def _split(observe: Any) -> list[str]:
    """Return the names of the numbers to fit, as they are given."""
    return [one.strip() for one in observe.split(",")] if isinstance(observe, str) else list(observe or ())


def _pressing(problem: Problem, record: Record) -> tuple[PiecewiseLinear, tuple[str, ...]]:
    """Return the normal load of a record, and a note. Raises InputError if it is not in the unit of the problem's loads."""
    found, told = normal_of(record)
    if record.normal_name == "weight_on_bit" and (radius := getattr(problem.body, "bit_radius", None)) is not None:
        return PiecewiseLinear(found.times, [radius * weight for weight in found.values]), told
    if KNOWN_COLUMNS[record.normal_name].unit != problem.load_unit:
        wanted = f"{problem.body.normal_field} in {problem.load_unit}"
        raise InputError(
            f"{record.name}: normal='record' needs a column {wanted}, got {record.normal_name}: use the contact's area"
        )
    return found, told


def _uneven(problem: Problem, record: Record) -> Iterator[str]:
    """Yield a sentence on a measured normal load that changes while the problem's does not."""
    if record.normal is None or problem.normal_varies or not np.isfinite(record.normal).any():
        return
    low, usual, high = np.nanpercentile(record.normal, [5.0, 50.0, 95.0]).tolist()
    if high - low > UNEVEN * abs(usual):
        change = f"{record.normal_name} changes by {(high - low) / abs(usual):.0%} but is taken as constant in the run"
        yield f"{change}: normal='record' takes it as it was measured"


def _check_force(record: Record, name: str, problem: Problem) -> None:
    """Raise InputError if the shear force or torque is implausible as friction under the normal load of the problem."""
    size, unit = float(np.nanmedian(np.abs(record.measured[name]))) / problem.normal, problem.load_unit
    if not LOWEST < size < HIGHEST:
        normal = f"{KINDS_OF_BODY[unit].normal.replace('_', ' ')} of {brief(problem.normal, unit, 3)}"
        raise InputError(
            f"{record.name}: {name} is {size:.3g} times the problem's {normal}, in the median: "
            f"is its unit in the heading, as {name} (k{unit})?"
        )


def _observed(record: Record, observe: Any, problem: Problem, sensor: str) -> tuple[str, ...]:
    """Return the names of the quantities to fit. Raises InputError."""
    names = _split(observe) or ([record.shear] if record.shear else [one for one in MEASURED if one in record.measured])
    names = ["shear_stress" if one in ("traction", "tau") else one for one in names]
    for name in names:
        if name not in record.measured:
            raise InputError(f"infer: observe: the record has no {ascii(name)[:40]}; {nearest(str(name), record.measured)}")
    for name in names:
        if name in SHEAR and np.nanmin(record.measured[name]) == np.nanmax(record.measured[name]):
            raise InputError(
                f"{record.name}: {name} is the same number in all rows: its sensor was off, or another column is meant"
            )
    for name in names:
        if not is_of(name, problem):
            unit, given = problem.load_unit, QUANTITIES[name].unit
            loads = f"the loads of a {problem.body.noun} are in {unit}, and {name} in {given}"
            cure = f"give {KINDS_OF_BODY[given].normal} beside it, so that it becomes friction, or {SHEAR_IN[unit]}"
            raise InputError(f"{record.name}: {loads}: {cure}")
        if name in SHEAR and QUANTITIES[name].unit in ("N", TURNS):
            _check_force(record, name, problem)
    if sum(name in SHEAR and not (name == "surface_torque" and sensor != "drive") for name in names) > 1:
        raise InputError(f"infer: observe: {' and '.join(one for one in names if one in SHEAR)} are one measurement: choose one")
    return tuple(names)


def hints_of(problem: Problem, part: Part) -> dict[str, float]:
    """Return the load and the state at the start of a part's run, as far as the problem has them."""
    try:
        begun = part.begun(problem)
    except InputError:
        return {}
    found = {LOAD: begun.load}
    law, rate = begun.friction, begun.first_pull_rate
    if law.states:
        given = begun.given_states or np.ravel(_steady_state(law, rate)).tolist()
        found |= {INITIAL_STATE: float(given[0])} if given else {}
    return found


def _steady_state(law: FrictionLaw, rate: float) -> Floats:
    """Return the states of steady sliding at a rate (m/s); none if the law does not give them."""
    found = law.steady_state(abs(rate)) if rate else None
    return np.zeros(0) if found is None else found


def scales_of(part: Part, problem: Problem) -> dict[str, float]:
    """Return the step sizes (SI) for free numbers that start at 0."""
    record = part.record
    moved = record.measured.get("slip", record.load_point)
    reach = float(np.nanmax(moved) - np.nanmin(moved)) if moved is not None else 0.0
    if not reach > 0.0:
        reach = abs(problem.first_pull_rate) * part.duration or 1.0
    times = dict.fromkeys((DELAY, SERVO), 0.01 * part.duration)
    dampings = {"body.damping": 1.0, "body.driver_damping": 1.0, "body.contact_damping": 0.1 * problem.body.impedance}
    return {
        **times,
        "body.backlash": 0.01 * reach,
        TREND: 0.1 / reach,
        DRIFT: 0.1 / part.duration,
        "initial.slip": 0.1 * reach,
        **dampings,
    }


def at_rests(part: Part) -> list[Part]:
    """Return the parts of a record between its rests: each begins soon after a slip event. Raises InputError without events."""
    record, name = part.record, part.record.shear
    if name is None:
        raise InputError(f"{record.name}: parts='rests' needs shear, whose drops are the slip events")
    if part.is_away:
        why = "begins each run with the load at the contact, which a sensor at the drive does not measure"
        raise InputError(f"{record.name}: parts='rests' {why}: fit the samples as one part")
    arrests = arrests_in(record.measured[name])
    if not len(arrests):
        raise InputError(f"{record.name}: no drop of {name} stands out of its noise: leave parts='rests' out")
    later = (LATER * np.diff(np.append(arrests, len(record)))).astype(int)
    ends = [0, *(arrests + 1 + later).tolist(), len(record)]
    cuts = [(first, last) for first, last in pairwise(ends) if last - first >= SAMPLES_OF_PART]
    found = []
    for first, last in cuts:
        piece = record.part(float(record.time[first]), float(record.time[last - 1]))
        found.append(replace(part.from_time(piece, float(piece.time[0] - record.time[0])), start="record"))
    return found


def evenly(parts: Sequence[Part], most: int) -> list[Part]:
    """Return at most `most` parts, evenly spread over all."""
    return [parts[i] for i in _spread(len(parts), most)]


def _spread(count: int, most: int) -> list[int]:
    return [int(i) for i in np.unique(np.linspace(0, count - 1, min(count, most)).round())]


def with_parts(model: Model, most: int) -> Model:
    """Return the model with some of its parts, evenly spread, and with the shared free numbers and those of these parts."""
    kept = {part: i for i, part in enumerate(_spread(len(model.parts), most))}
    free = [one if one.part is None else replace(one, part=kept[one.part]) for one in model.free if one.part in (None, *kept)]
    return model.with_(parts=tuple(model.parts[part] for part in kept), free=tuple(free))


def own_of(problem: Problem, parts: Sequence[Part], wanted: Iterable[str] | None) -> list[Free]:
    """Return the free numbers of single parts: the initial load, known to within its noise, and a state if the law has one."""
    names = (
        list(wanted)
        if wanted is not None
        else [LOAD, *([INITIAL_STATE] if problem.friction.states and not problem.friction.sticks else [])]
    )
    found = []
    for i, part in enumerate(parts):
        declared = known_numbers(problem, hints_of(problem, part))
        for name in names:
            if name not in (LOAD, INITIAL_STATE) or name not in declared:
                raise InputError(
                    f"infer: each: {ascii(name)[:40]} cannot differ from part to part; allowed: {LOAD}, {INITIAL_STATE}"
                )
            quantity, value = declared[name]
            if name == LOAD:
                load, error = part.first_load(part.pressed(problem).normal)
                error = max(error, 1e-6 * abs(load), 1e-300)
                wide = 50.0 * error
                found.append(Free(LOAD, quantity, load, load - wide, load + wide, False, Prior("normal", load, error), i, error))
            elif np.isfinite(value) and value > 0.0:
                found.append(Free(INITIAL_STATE, quantity, value, value / 1e12, value * 1e12, True, None, i))
            else:
                raise InputError(
                    "infer: parts='rests': the problem needs an initial_state, where the search for that of each part begins"
                )
    return found
