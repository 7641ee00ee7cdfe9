"""Correct, doubt or refuse faults of sensors and headings: signs, units, saturation, and columns that contradict each other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.inference.record.noise import noise_of, saturated, spikes
from stickslip.extensions.inference.record.record import HIGHEST, LOADING, LOWEST, SHEAR, Record
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief

BACKWARD = 0.9
"""The sign of shear is turned if more than this share of it is negative."""
FALLING = 0.7
"""A load point is taken for slip if shear drops in more than this share of its fast samples."""
CONTRARY = {"slip": 3.0, "slip_rate": 10.0}
"""Slip and load point contradict each other if they differ by more than this factor; a rate may miss motion between samples."""
SAMPLES_OF_MOTION = 30
"""Motions are compared only in records with at least this many samples."""
LATEST = 0.1
"""Motions are compared only after this first share of the record."""


@np.errstate(over="ignore", invalid="ignore")  # marks of missing numbers may be huge
def checked(record: Record) -> Record:
    """Return the record with forward shear positive and without samples of a saturated sensor. Raises InputError."""
    notes, measured = list(record.notes), dict(record.measured)
    driven = {name: values for name in LOADING if (values := getattr(record, name)) is not None}
    for name, values in {**measured, **driven}.items():
        if not np.isfinite(values).any():
            raise InputError(f"{record.name}: {name} has no number in any row")
    _check_signs(measured, record.load_point, notes)
    for name in SHEAR:
        if name in measured and (lone := spikes(measured[name])).any():
            worst = brief(float(measured[name][lone][0]), record.unit_of(name))
            measured[name] = np.where(lone, np.nan, measured[name])
            notes.append(f"{name} is far beyond the rest in {_samples(lone, 'lone ')}, as at {worst}: left out")
    if "friction" in measured:
        _check_friction(float(np.nanmedian(np.abs(measured["friction"]))), record.name, notes)
    for name, values in measured.items():
        flat = saturated(values)
        if flat.any():
            measured[name] = np.where(flat, np.nan, values)
            at = f"{_samples(flat)} at {brief(float(values[flat][0]), record.unit_of(name))}"
            notes.append(f"{name} is constant at the end of its range in {at}: the sensor was saturated there; they are left out")
    made = replace(record, measured=measured)
    _check_load_point(made)
    return replace(made, notes=(*notes, *_contradictions(made)))


def _samples(which: NDArray[np.bool_], kind: str = "") -> str:
    count = int(which.sum())
    return f"{count} {kind}sample{'s' if count != 1 else ''}"


def _check_signs(measured: dict[str, Floats], moved: Floats | None, notes: list[str]) -> None:
    """Turn the sign of shear if it is negative while the machine moves forwards; doubt a machine that moves against shear."""
    ends = None if moved is None else moved[np.isfinite(moved)][[0, -1]]
    for name in (name for name in SHEAR if name in measured):
        negative = float(np.nanmean(measured[name] < 0.0))
        if negative > BACKWARD and (ends is None or ends[1] >= ends[0]):
            measured[name] = -measured[name]
            notes.append(f"{name} is negative while the machine moves forwards: its sign was turned")
        elif negative < 1.0 - BACKWARD and ends is not None and ends[1] < ends[0]:
            notes.append(
                f"load_point falls while {name} is positive: does its sensor count backwards, so that its sign must be turned?"
            )


def _check_friction(size: float, name: str, notes: list[str]) -> None:
    if size > HIGHEST:
        raise InputError(
            f"{name}: friction is {size:.3g} in the median: is a stress in N, or friction in percent? Friction is 0.1 to 1"
        )
    if size < LOWEST:
        notes.append(f"friction is {size:.3g} in the median: are the units of shear and normal stress in the headings right?")


def _check_load_point(record: Record) -> None:
    """Raise InputError if the column of the load point is slip, which jumps where the shear stress drops."""
    shear, moved = record.shear, record.load_point
    if moved is None:
        return
    if "slip" in record.measured and np.array_equal(moved, record.measured["slip"], equal_nan=True):
        raise InputError(f"{record.name}: load_point and slip are the same numbers: leave the column out that is wrong")
    if shear is None or len(record) < SAMPLES_OF_MOTION:
        return
    change, step = np.diff(record.measured[shear]), np.diff(moved)
    known = np.isfinite(change) & np.isfinite(step)
    change, step, lasting = change[known], step[known], np.diff(record.time)[known]
    if not len(change):
        return
    noise = max(noise_of(record.measured[shear]), 1e-9 * float(np.nanmax(np.abs(record.measured[shear]))))
    falls = change < -10.0 * noise
    rate = step / lasting
    fast = rate > 10.0 * max(float(np.median(rate)), 0.0)
    if 2 <= fast.sum() < 0.2 * len(rate) and float(np.mean(falls[fast])) > FALLING:
        why = "it jumps where the shear stress drops, as slip does and a driven load point does not"
        raise InputError(f"{record.name}: load_point looks like slip: {why}; call the column slip, and give the load rate")


def _contradictions(record: Record) -> Iterator[str]:
    """Yield sentences on slip that contradicts the load point or another column of slip.

    When shear is back at its first value, so is the length of the spring: the contact has then slipped as far as the load point has
    moved. It has slipped less if shear is larger, and more if shear is smaller.
    """
    moved: dict[str, Floats] = {name: _reached(record, name) for name in ("slip", "slip_rate") if name in record.measured}
    driven = next((_reached(record, name) for name in LOADING if getattr(record, name) is not None), None)
    if driven is None and len(moved) == 2:  # slip and its rate can still be compared
        yield from _contrary(record, {"slip_rate": moved["slip_rate"]}, moved["slip"], ("slip", -1, -1))
    shear = record.measured.get(record.shear or "")
    if driven is None or shear is None or not moved or len(record) < SAMPLES_OF_MOTION:
        return
    known = np.flatnonzero(np.isfinite(shear))
    if not len(known):
        return
    first = float(np.median(shear[known[: max(1, len(known) // 100)]]))
    sides = (shear[known] >= first, shear[known] <= first)
    above, below = (int(known[np.flatnonzero(side)[-1]]) if side.any() else 0 for side in sides)
    yield from _contrary(record, moved, driven, ("the load point", above, below))


def _contrary(record: Record, moved: Mapping[str, Floats], driven: Floats, where: tuple[str, int, int]) -> Iterator[str]:
    """Yield a sentence for each motion that is far larger than another at sample `above`, or far smaller at sample `below`."""
    other, above, below = where
    least, slip = 10.0 * noise_of(driven), record.unit_of("slip")
    unit = "um" if slip == "m" else slip
    for name, reached in moved.items():
        for at, too_far in ((above, True), (below, False)):
            if 0 <= at < LATEST * len(reached):
                continue
            far, near = (reached[at], driven[at]) if too_far else (driven[at], reached[at])
            if far > CONTRARY[name] * max(float(near), 0.0) and far > least:
                gone = "moves" if other == "the load point" else "grows by"
                sizes = f"{brief(float(reached[at]), slip, 3)} of slip, where {other} {gone} {brief(float(driven[at]), slip, 3)}"
                ends = f"by {record.time[at]:.6g} s {name} makes {sizes}"
                yield f"{ends}: are its sign and its unit, as {name} ({unit if name == 'slip' else f'{unit}/s'}), right?"
                break


def _reached(record: Record, name: str) -> Floats:
    """Return the displacement since the first sample (m) of a column, or of a rate's integral."""
    values = record.measured[name] if name in record.measured else getattr(record, name)
    known = np.isfinite(values)
    filled = np.interp(record.time, record.time[known], values[known])
    if not name.endswith("rate"):
        return np.asarray(filled - filled[0])
    return np.append(0.0, np.cumsum(0.5 * (filled[1:] + filled[:-1]) * np.diff(record.time)))
