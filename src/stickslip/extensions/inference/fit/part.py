"""A part of a record with a run of its own: its loading, its start, other numbers in its problem, and an end that is left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.turns import changes_of
from stickslip.extensions.inference.record.corners import Corners
from stickslip.extensions.inference.record.loading import later, loading_of
from stickslip.extensions.inference.record.noise import first_value, noise_of
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.other_values import unchecked
from stickslip.foundation.quantities import Quantity
from stickslip.problem import LoadingHistory, PiecewiseLinear, Problem, Steps, pressed_body, put_many

SMALLEST_NOISE = 1e-9
"""Smallest noise, as a share of the range of a quantity: even a record without noise is rounded."""


@dataclass(frozen=True, eq=False)
class Part:
    """A part of a record with its own run.

    `loading` is the pull rate since the first sample, or None for the problem's own; `observed` are the fitted quantities.
    `sensor` is "contact" if shear is measured there, "spring" for a load cell behind the spring of a block, "drive" for one at the
    driver; `is_away` is True if waves are on their way from the contact to where shear is measured. `start` says how the
    run begins: in "steady" sliding, as the "record" does, or as the "problem" says. `pressing` is the normal load since the first
    sample (Pa or N), or None for the problem's own. `corners` say how well the steps of the loading are known, and `jumps` number
    the straight parts of the normal load in which it jumps between two samples; `asides` are what is not known of both.
    """

    record: Record
    loading: LoadingHistory | float | None
    observed: tuple[str, ...]
    sensor: str = "contact"
    start: str = "problem"
    pressing: PiecewiseLinear | None = None
    is_away: bool = False
    corners: Corners | None = None
    jumps: tuple[int, ...] = ()
    asides: tuple[Free, ...] = ()

    @property
    def duration(self) -> float:
        """The length of the run (s)."""
        return float(self.record.clock[-1])

    @property
    def begins(self) -> float:
        """The time (s) in the record where the run begins."""
        return float(self.record.time[0])

    @cached_property
    def first(self) -> dict[str, tuple[float, float]]:
        """The value of each measured quantity at the first sample, with its standard error (SI)."""
        found = {}
        for name, values in self.record.measured.items():
            found[name] = first_value(self.record.clock, values, noise_of(values))
        return found

    def changes(self, problem: Problem) -> Floats:
        """Return the times (s) when the pull rate of a run begins to change by a tenth of its range or more."""
        pull = problem.pull_rate if self.loading is None else self.loading
        if not isinstance(pull, LoadingHistory):
            return np.zeros(0)
        return changes_of(pull, self.duration)

    def weights(self, problem: Problem, exponent: float) -> Floats:
        """Return the weight of each sample: (n/j)**exponent for the j-th of n samples after each change of the pull rate.

        The mean squared weight is 1. Raises InputError if the pull rate does not change.
        """
        changes, clock = self.changes(problem), self.record.clock
        if not len(changes):
            raise InputError(f"{self.record.name}: the pull rate does not change: a weight of samples after a change needs one")
        first = np.searchsorted(clock, changes)
        since = np.arange(len(clock)) - first[np.maximum(np.searchsorted(changes, clock, side="right") - 1, 0)]
        weight = np.where(since < 0, 1.0, (len(clock) / (np.maximum(since, 0) + 1.0)) ** exponent)
        return np.asarray(weight * math.sqrt(len(weight) / float(weight @ weight)))

    def begun(self, problem: Problem) -> Problem:
        """Return a problem under the loading of this part, with the initial conditions from its data. Raises InputError."""
        problem = self.pressed(problem)
        rates: dict[str, Any] = {} if self.loading is None else {"pull_rate": self.loading}
        if self.start == "steady":
            return steady(problem, rates)
        if self.start == "problem":
            return replace(problem, **rates)
        load, _ = self.first_load(problem.normal)
        begun: dict[str, Any] = {"initial_load": load, "initial_excess": None}
        if problem.friction.states and not problem.friction.sticks and problem.initial_state is None:
            begun["initial_state"] = "steady"
        return replace(problem, **rates, **begun)

    def pressed(self, problem: Problem) -> Problem:
        """Return a problem under the normal load of this part."""
        if self.pressing is None:
            return problem
        return replace(problem, body=pressed_body(problem, self.pressing.first), normal_load=self.pressing)

    def from_time(self, record: Record, begin: float) -> Part:
        """Return the part that begins `begin` (s) later, with that piece of the record and its own motion of the load point."""
        loading = loading_of(record) if self.loading is not None else None
        pressing = None if self.pressing is None else later(self.pressing, begin)
        rate = None if loading is None else loading.rate
        return replace(self, record=record, loading=rate, pressing=pressing, corners=None, jumps=(), asides=())

    def first_load(self, normal: float) -> tuple[float, float]:
        """Return the load at the first sample and its standard error, for a normal load (all in Pa, N or N m)."""
        name = self.record.shear
        if name is None:
            raise InputError(
                f"{self.record.name}: no shear is measured, so that the load at the start is not known: start='problem'"
            )
        value, error = self.first[name]
        return (value * normal, error * normal) if name == "friction" else (value, error)


def steady(problem: Problem, rates: Mapping[str, Any]) -> Problem:
    """Return a problem that begins in steady sliding at its first pull rate. Raises InputError if it cannot."""
    law, body = problem.friction, problem.body
    none: dict[str, Any] = dict.fromkeys(
        ("initial_load", "initial_excess", "initial_state", "initial_second_state", "initial_rate")
    )
    if not law.sticks and body.has_inertia:
        return replace(problem, **rates, **none)
    pull = rates.get("pull_rate", problem.pull_rate)
    rate = pull.first if isinstance(pull, LoadingHistory) else pull
    if not law.states and not law.depends_on_slip and rate != 0.0:
        return replace(problem, **rates, **none | {"initial_rate": "steady"})
    if not law.states or law.sticks or rate == 0.0 or not hasattr(law, "steady_coefficient"):
        unit = problem.unit_of("slip_rate")
        raise InputError(f"infer: {law.kind} does not slide steadily at the first pull rate of {rate:g} {unit}: start='record'")
    load = problem.normal * float(law.steady_coefficient(abs(rate))) + body.total_damping * abs(rate)
    none |= {"initial_load": math.copysign(load, rate), "initial_state": "steady"}
    return replace(problem, **rates, **none)


SETTLED, POINTS = 1e-4, 32
"""An exponential approach to a new rate ends when this share of the change remains; number of points on the way."""


def approached(pull: LoadingHistory | float, time: float) -> LoadingHistory | float:
    """Return a pull rate that approaches each new value as exp(-t/time), as the servo of a machine does (time in s).

    The rate is linear between points, which are closest where it changes fastest. Raises InputError if it does not change in steps.
    """
    if not isinstance(pull, LoadingHistory):
        return pull
    if not isinstance(pull, Steps):
        raise InputError(f"infer: record.servo needs a pull rate that changes in steps, got a history of kind {pull.kind}")
    left = np.linspace(1.0, math.sqrt(SETTLED), POINTS) ** 2
    after = -np.log(left)
    left[-1] = 0.0
    after *= 1.0 / float(np.sum(0.5 * (left[1:] + left[:-1]) * np.diff(after)))  # the load point comes late by just that time
    times, rates, rate = [0.0], [pull.values[0]], pull.values[0]
    for at, wanted, end in zip(pull.times[1:], pull.values[1:], (*pull.times[2:], math.inf), strict=True):
        inside = at + time * after < end
        times += (at + time * after[inside]).tolist()
        rates += (wanted + (rate - wanted) * left[inside]).tolist()
        rate = wanted if math.isinf(end) else float(np.interp(end, at + time * after, wanted + (rate - wanted) * left))
    return PiecewiseLinear(times, rates)


def changed(problem: Problem, values: Mapping[str, float], make: Callable[..., Any] = replace) -> Problem:
    """Return a problem with other numbers, by their full names; numbers of the record are ignored. Raises InputError."""
    return put_many(problem, {name: value for name, value in values.items() if not name.startswith("record.")}, make)


def not_begun(owner: Any, **numbers: Any) -> Any:
    """Return a body, a law or a loading with other numbers, or a problem that is not checked because it is to begin elsewhere."""
    return (unchecked if isinstance(owner, Problem) else replace)(owner, **numbers)


def first_sizes(parts: Sequence[Part]) -> dict[str, float]:
    """Return the noise of each observed quantity from sample to sample; 1 if all parts have a column of standard deviations."""
    found: dict[str, float] = {}
    for name in dict.fromkeys(name for part in parts for name in part.observed):
        having = [part.record for part in parts if name in part.observed]
        if all(name in record.deviations for record in having):
            found[name] = 1.0
            continue
        widest = max(float(np.nanmax(r.measured[name]) - np.nanmin(r.measured[name])) for r in having)
        largest = max(float(np.nanmax(np.abs(r.measured[name]))) for r in having)
        least = SMALLEST_NOISE * max(widest, 1e-3 * largest, 1e-300)
        found[name] = max(*(noise_of(r.measured[name]) for r in having), least)
    return found


LEFT_OUT = Quantity("s", "time at the end of the record that is left out", above=0.0)
SAMPLES_OF_PART = 8
"""A part keeps at least this many samples."""


def share_of(held_out: Any, parts: Sequence[Part]) -> float:
    """Return the share to leave out at the end of a record, from a share or a time. Raises InputError."""
    if held_out is None:
        return 0.0
    if isinstance(held_out, int | float) and not isinstance(held_out, bool):
        if not 0.0 < held_out < 1.0:
            raise InputError(f"infer: held_out must be a share between 0 and 1, or a time with a unit, got {held_out:g}")
        return float(held_out)
    seconds, whole = LEFT_OUT.check("infer", "held_out", held_out), sum(part.duration for part in parts)
    if seconds >= whole:
        raise InputError(f"infer: held_out of {seconds:g} s leaves nothing of a record of {whole:g} s")
    return seconds / whole


def shortened(parts: Sequence[Part], share: float) -> list[Part]:
    """Return the parts to fit: a single part without its end, or the first ones of several parts, each as a whole.

    A part that is left out is left out as a whole; the first one always stays. Raises InputError if too little is left.
    """
    if share == 0.0:
        return list(parts)
    if len(parts) > 1:
        count = max(1, min(len(parts) - 1, round(len(parts) * (1.0 - share))))
        return list(parts[:count])
    (part,) = parts
    record = part.record.part(None, float(part.record.time[0] + (1.0 - share) * part.duration))
    if len(record) < SAMPLES_OF_PART:
        raise InputError(f"infer: held_out leaves {len(record)} samples to be fitted")
    return [replace(part, record=record)]


class StickSlip(NamedTuple):
    """Friction before and after slip events, the rise between them per displacement of the machine, and the duration of a fall.

    `rise` is in N/m (block) or Pa/m (slab), `duration` in s; each is NaN if the record does not show it.
    """

    peak: float
    rest: float
    rise: float
    duration: float
