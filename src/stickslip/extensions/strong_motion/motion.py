"""Ground motions for studies of sliding: samples of acceleration at even times, from files, histories and objects of others."""

from __future__ import annotations

import math
import os
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from stickslip.extensions.strong_motion.measures import StrongMotionMeasures, measures_of
from stickslip.extensions.strong_motion.obspy_traces import is_trace
from stickslip.extensions.strong_motion.record import record
from stickslip.foundation.arguments import shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.constants import GRAVITY
from stickslip.foundation.errors import InputError, nearest, warn
from stickslip.foundation.show import number
from stickslip.problem import Accelerogram, LoadingHistory, PiecewiseLinear

UNEVEN = 1e-6
"""Intervals of a history that differ by less than this share count as one."""
BASELINES = (None, "mean")
"""What may be taken off a record: nothing, or its mean."""
KINDS = "a file, a record of ss.loading or another history of acceleration with even times"
NO_ACCELERATION = ("give the file of the acceleration", "no column 'ground_acceleration'")
"""What is said of a file that may be sound, and holds a velocity, a displacement or something else."""
OURS = b"# stickslip "
"""The first bytes of tables of results."""


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """The acceleration (m/s^2) of the ground as it was recorded, at even intervals (s), and 0 after the last sample."""

    name: str
    acceleration: Floats
    interval: float

    @property
    def lasts(self) -> float:
        """The time (s) from the first sample to the last."""
        return (len(self.acceleration) - 1) * self.interval

    @cached_property
    def measures(self) -> StrongMotionMeasures:
        """What its numbers say, unscaled."""
        return measures_of(self.acceleration, self.interval)

    @property
    def text(self) -> str:
        """How many samples it has, how far apart, and its peak, in words."""
        peak = number(self.measures.pga / GRAVITY, 4)
        return f"{self.name}: {len(self.acceleration)} samples every {number(self.interval)} s, {peak} g at most"

    @cached_property
    def _history(self) -> Accelerogram:
        return Accelerogram(self.acceleration, self.interval)

    def history(self, factor: float) -> Accelerogram:
        """Return the acceleration times a factor as a history for a problem, which is 0 after the last sample."""
        return self._history.scaled(factor)


def motions_of(given: Any, who: str, component: str | None = None, baseline: str | None = None) -> list[GroundMotion]:
    """Return the ground motions of one record, of several, or of a mapping of records by name.

    A file of a folder that holds no acceleration is left out with a warning, unless all are such, and so are results of ours, in
    silence. Raises InputError, which begins with `who` and names the record, for the first other one that cannot be used.
    """
    if baseline not in BASELINES:
        raise InputError(f"{who}: baseline must be None or 'mean', got {shown(baseline)}; {nearest(str(baseline), ('mean',))}")
    found, left = list[GroundMotion](), list[InputError]()
    for name, one, is_inside in _named(given, who):
        try:
            found.append(_read(name, one, who, component))
        except InputError as error:
            if not is_inside or not any(words in str(error) for words in NO_ACCELERATION):
                raise  # a record with a fault is not left out in a statistic
            left.append(error)
    if left and not found:
        raise left[0]
    for fault in left:
        warn(f"{fault}: left out")
    if not found:
        raise InputError(f"{who}: needs at least one record: {KINDS}")
    twice = [name for name, count in Counter(one.name for one in found).items() if count > 1]
    found = [replace(one, name=f"{one.name} ({n})") if one.name in twice else one for n, one in enumerate(found, 1)]
    if baseline is None:
        return found
    return [replace(one, acceleration=one.acceleration - one.acceleration.mean()) for one in found]


def _named(given: Any, who: str) -> Iterator[tuple[str, Any, bool]]:
    """Yield records, each with its name, "" if it has none, and whether it lies in a folder that was given."""
    if isinstance(given, Mapping):
        yield from ((str(name), one, False) for name, one in given.items())
    elif isinstance(given, str | os.PathLike):
        yield from _files(Path(given), who)
    elif isinstance(given, LoadingHistory | GroundMotion) or is_trace(given):
        yield "", given, False
    elif isinstance(given, Iterable) and not isinstance(given, np.ndarray | bytes):
        for one in given:
            yield from _files(Path(one), who) if isinstance(one, str | os.PathLike) else [("", one, False)]
    else:
        raise InputError(f"{who}: records must be {KINDS}, or several, got {shown(given)}")


def _files(path: Path, who: str) -> Iterator[tuple[str, Any, bool]]:
    """Yield a file, or all files of a folder in the order of their names, but for tables that were written here."""
    if not path.is_dir():
        yield path.name, path, False
        return
    inside = sorted(one for one in path.iterdir() if one.is_file() and not one.name.startswith(".") and not _is_ours(one))
    if not inside:
        raise InputError(f"{who}: the folder {path} has no file")
    yield from ((one.name, one, True) for one in inside)


def _is_ours(path: Path) -> bool:
    """Return True for a table that `slide` has written."""
    try:
        with path.open("rb") as stream:
            return stream.read(len(OURS)) == OURS
    except OSError:
        return False


def _read(name: str, given: Any, who: str, component: str | None) -> GroundMotion:
    try:
        return as_motion(given, name, component)
    except InputError as error:
        message = str(error)
        raise InputError(f"{who}: {message}" if not name or name in message else f"{who}: {name}: {message}") from None


def as_motion(given: Any, name: str = "", component: str | None = None) -> GroundMotion:
    """Return a record as a ground motion. Raises InputError for what is none."""
    if isinstance(given, GroundMotion):
        return replace(given, name=name) if name else given
    if isinstance(given, str | os.PathLike):
        given = record(Path(given), component=component)
    if is_trace(given):
        raise InputError('a trace does not know its unit: give ss.loading.record(TRACE, unit="m/s^2")')
    if isinstance(given, np.ndarray | list | tuple):
        raise InputError("numbers alone have no interval: give ss.loading.Accelerogram(NUMBERS, interval=SECONDS)")
    if not isinstance(given, LoadingHistory):
        raise InputError(f"a record must be {KINDS}, got {shown(given)}")
    if isinstance(given, Accelerogram):
        return _checked(name or given.origin.partition(", sha256 ")[0] or "record", given.samples, given.interval)
    if not isinstance(given, PiecewiseLinear) or type(given) is not PiecewiseLinear:
        raise InputError(f"a record must have samples in straight lines, got {type(given).__name__}")
    times = np.asarray(given.times, float)
    interval = float(times[-1] - times[0]) / (len(times) - 1) if len(times) > 1 else math.nan
    if times[0] != 0.0 or not (np.abs(np.diff(times) - interval) <= UNEVEN * interval).all():
        raise InputError(
            "a record must have even times from 0 s on: resample it, or run it as the ground_acceleration of a problem"
        )
    return _checked(name or "record", np.asarray(given.values, float), interval)


def _checked(name: str, acceleration: Floats, interval: float) -> GroundMotion:
    if len(acceleration) < 2:
        raise InputError(f"a record needs at least 2 samples, got {len(acceleration)}")
    if not np.isfinite(acceleration).all():
        raise InputError("a record must have finite samples")
    return GroundMotion(name, acceleration, interval)
