"""Fit a record of many slip events by the means of their features, instead of sample by sample."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.extensions.inference.fit.event_part import CYCLES, EventPart
from stickslip.extensions.inference.fit.memory import ResidualBlock
from stickslip.extensions.inference.fit.model import FAILED, JUMPING, LARGEST_RESIDUAL, Model, breaks_of, is_at_driver, measured
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.record.features import FEATURES, LEVELS_OF_SHEAR, Samples, about_falls, features_in, levels_in
from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.solution import Solution

SETTLING = 2
"""This many first events of a run do not count."""
SPARE = 2
"""At least this many more events than features are needed to estimate the scatter of the features and their correlation."""
COARSE, FINE = 1000, 200
"""Numbers of times to sample a whole run, and a part of it between two times, besides the ends of its pieces."""
COARSER = 1e-2
"""Step of differences, in searched numbers; it is large because waves in a slab shift its features by some 1e-4 of their size."""
SAMPLES_OF_FALL = 4.0
"""Falls shorter than this many samples have no measurable duration and peak rate."""
MISSED, ALLOWED = 4.0, 0.1
"""A run misses the mean of a feature if it is farther away than MISSED times the root of the sum of squares of the standard error
and of ALLOWED times the scatter. After a thousand events the mean is known better than any law holds, hence the second term."""
GAP = 0.1
"""A gap in a record longer than this share of the usual time between events may hide one."""
MEASURED = 3e-5
"""Features of a run and of a record without noise agree to this share of their size."""


class Means(NamedTuple):
    """Means of features of a part (SI), the Cholesky factor of their covariance, and its number of degrees of freedom."""

    values: Floats
    root: Floats
    degrees: int

    @property
    def errors(self) -> Floats:
        """The standard errors of the means (SI)."""
        return np.asarray(np.linalg.norm(self.root, axis=1))


@dataclass(frozen=True, eq=False)
class FeaturePart(Part):
    """Features of the events of a part, at the times of the events; `whole` is the part itself, with all samples."""

    whole: Part | None = None

    @property
    def samples(self) -> Part:
        """The part itself."""
        assert self.whole is not None
        return self.whole

    @cached_property
    def duration(self) -> float:
        """The length of a run (s): enough for several events."""
        if isinstance(self.samples, EventPart):
            return self.samples.duration
        recurrence = self.record.measured["recurrence"]
        begins = float(self.record.time[0] - self.samples.record.time[0])
        return min(self.samples.duration, max(begins, 0.0) + CYCLES * float(np.median(recurrence)))

    @property
    def begins(self) -> float:
        """The time (s) in the record where the run begins."""
        return self.samples.begins

    def first_load(self, normal: float) -> tuple[float, float]:
        """Return the load at the first sample and its standard error, as the part itself does."""
        return self.samples.first_load(normal)

    @cached_property
    def means(self) -> Means:
        """The means of the features that are fitted."""
        return means_of(np.array([self.record.measured[name] for name in self.observed]))


def means_of(features: Floats) -> Means:
    """Return the means of features, shape (features, events), and the covariance of these means.

    Events that lack a number (NaN) are left out, unless these are more than half: then the errors are those of independent features
    of the events that have them. Else the covariance also holds if neighbouring events depend on each other: a high static
    friction, for example, lengthens the time before its event and the time after it. It is the power of the features at low
    frequencies, in the first terms of a cosine transform over all events (Lazarus, Lewis, Stock & Watson 2018, J. Bus. Econ. Stat.
    36, 541). The number of terms is the number of events to the power 2/3, so that more events allow for longer correlations.
    """
    from scipy.fft import dct

    count, events = features.shape
    whole = np.isfinite(features).all(axis=0)
    if whole.sum() >= max(count + SPARE, 0.5 * events):
        features = features[:, whole]
        events = features.shape[1]
    else:
        known = np.isfinite(features).sum(axis=1)
        errors = np.nanstd(features, axis=1, ddof=1) / np.sqrt(known)
        means = np.nanmean(features, axis=1)
        return Means(means, np.diag(np.sqrt(errors**2 + (MEASURED * means) ** 2 + 1e-300)), int(known.min()) - 1)
    means = features.mean(axis=1)
    used = min(events - 1, max(count + 1, math.ceil(events ** (2.0 / 3.0))))
    waves = dct(features - means[:, None], norm="ortho", axis=1)[:, 1 : used + 1]
    covariance = waves @ waves.T / (used * events)
    sizes = np.sqrt(np.diag(covariance) + (MEASURED * means) ** 2 + 1e-300)
    correlation = covariance / np.outer(sizes, sizes)
    least = 1.0 / used  # the variance of one feature, once the others are known, is not known better than this
    correlation *= 1.0 - least
    np.fill_diagonal(correlation, 1.0)
    return Means(means, sizes[:, None] * np.linalg.cholesky(correlation), used)


def by_features(parts: Sequence[Part], observe: Sequence[str] | str | None) -> tuple[list[Part], list[str]]:
    """Return the features of parts, and sentences on them. Raises InputError if there are too few events."""
    wanted = [one.strip() for one in observe.split(",")] if isinstance(observe, str) else observe
    found, notes = list[Part](), list[str]()
    for part in parts:
        if part.is_away:
            why = "are those of slip events, and waves from many of them are in the torque at a drive at once"
            raise InputError(f"{part.record.name}: features {why}: fit the samples")
        record, said = events_of(part)
        names = _chosen(wanted, record)
        if len(record) < len(names) + SPARE:
            raise InputError(f"{record.name}: {_too_few(part, record, names)}")
        found.append(FeaturePart(record, part.loading, tuple(names), part.sensor, part.start, whole=part))
        notes += [*said, f"{len(record)} slip events of {record.name}, each with its {', '.join(names)}"]
    return found, notes


def _too_few(part: Part, events: Record, names: Sequence[str]) -> str:
    """Return why events are too few, and how they were found."""
    few = f"{len(events)} whole slip events are too few for the scatter of {len(names)} features"
    if isinstance(part, EventPart):
        return f"{few}: observe fewer, or add events, {len(names) + SPARE} in all"
    assert part.record.shear is not None
    shear = part.record.measured[part.record.shear]
    return f"{few}: {about_falls(shear, part.record.unit_of(part.record.shear))}; fit event by event, with parts='rests'"


def _chosen(wanted: Sequence[str] | None, record: Record) -> list[str]:
    """Return the full names of features; by default all but the drop, the difference of two of them. Raises InputError."""
    levels = {level: f"{record.shear_of_events}_{level}" for level in LEVELS_OF_SHEAR}
    if wanted is None:
        both = levels["peak"] in record.measured and levels["rest"] in record.measured
        return [name for name in record.measured if not (both and name == levels["drop"])]
    names = list(dict.fromkeys(levels.get(name, name) for name in wanted))
    for name in names:
        if name not in record.measured:
            raise InputError(f"infer: observe: events have no {ascii(name)[:40]}; {nearest(str(name), record.measured)}")
    if set(levels.values()) <= set(names):
        raise InputError(f"infer: observe: {levels['drop']} is the difference of peak and rest: choose two of the three")
    return names


def events_of(part: Part) -> tuple[Record, list[str]]:
    """Return the features of the events of a record as a record at the times of the events, and sentences on what was left out."""
    if isinstance(part, EventPart):
        return part.record, []
    record, shear = part.record, part.record.shear
    if shear is None:
        raise InputError(f"{record.name}: by='features' needs shear, whose drops are the slip events")
    known = np.isfinite(record.measured[shear])
    time = record.clock[known]
    values = {name: one[known] for name, one in record.measured.items() if name in (shear, "slip", "slip_rate")}

    def between(begin: float, end: float) -> Samples:
        inside = slice(*np.searchsorted(time, [begin, end]).tolist())
        return Samples(time[inside], {name: one[inside] for name, one in values.items()})

    found = features_in(Samples(time, values), between, shear)
    at = found.pop("time", np.zeros(0))
    if not len(at):
        raise InputError(
            f"{record.name}: no two drops of {shear} stand out of its noise: there are no events with features; fit samples"
        )
    notes = []
    lasting = found["duration"][np.isfinite(found["duration"])]
    if not len(lasting) or float(np.median(lasting)) < SAMPLES_OF_FALL * float(np.median(np.diff(time))):
        found = {name: one for name, one in found.items() if name not in ("duration", "peak_rate")}
        notes.append("a fall lasts too few samples for its duration and its peak rate: they are not used")
    whole = np.all([np.isfinite(one) for one in found.values()], axis=0)
    hidden = _with_gap(time, at, found["recurrence"])
    if hidden.any():
        notes.append(f"slip events with a gap in the record before them are left out: {int(hidden.sum())}")
    whole &= ~hidden
    names = (*(f"{shear}_{level}" for level in LEVELS_OF_SHEAR), *FEATURES)
    found = {name: found[name][whole] for name in names if name in found}
    return Record(record.time[0] + at[whole], found, name=record.name, notes=record.notes), notes


def _with_gap(time: Floats, at: Floats, recurrence: Floats) -> NDArray[np.bool_]:
    """Return True for events after a gap that may hide another event."""
    steps = np.append(np.diff(time), 0.0)
    before, this = np.searchsorted(time, at - recurrence), np.searchsorted(time, at)
    longest = [float(np.max(steps[max(first, 0) : last + 1], initial=0.0)) for first, last in zip(before - 1, this, strict=True)]
    return np.array(longest) > max(GAP * float(np.median(recurrence)), 2.0 * float(np.median(steps)))


@dataclass
class FeatureModel(Model):
    """Distances of the mean features of a run from those of the record.

    There is one residual for each feature of a part, in standard errors of the means and decorrelated: the correlation of the
    features is removed by the Cholesky factor of their covariance.
    """

    of_means: ClassVar[bool] = True

    def curves(self, run: Solution, searched: Floats, part: int, every: int = 1) -> dict[str, Floats]:
        """Return the mean features of a run at each event, NaN if it has no events."""
        found, count = self._found(run, part), len(self.parts[part].record.clock[::every])
        return {name: np.full(count, value) for name, value in found.items()}

    def _found(self, run: Solution, part: int) -> dict[str, float]:
        this = self.part_of(part)
        found = features_of_run(run, this)
        return {name: found.get(name, math.nan) for name in this.observed}

    def part_of(self, part: int) -> FeaturePart:
        """Return a part, with its features."""
        this = self.parts[part]
        assert isinstance(this, FeaturePart)
        return this

    def _new_residual(self, searched: Floats, part: int) -> Floats:
        run, means = self.solve(searched, part), self.part_of(part).means
        found = np.full(len(means.values), math.nan) if run is None else np.array(list(self._found(run, part).values()))
        if not np.isfinite(found).all():
            return np.full(len(found), FAILED)
        return np.asarray(np.clip(np.linalg.solve(means.root, found - means.values), -LARGEST_RESIDUAL, LARGEST_RESIDUAL))

    def blocks(self, part: int) -> list[tuple[str, ResidualBlock]]:
        """Return the residual of each feature."""
        return [(name, ResidualBlock(slice(i, i + 1), np.zeros(1))) for i, name in enumerate(self.parts[part].observed)]

    @property
    def samples(self) -> int:
        """The number of features of all events."""
        return sum(len(part.observed) * len(part.record) for part in self.parts)

    @property
    def counted(self) -> str:
        """What is fitted, as text."""
        each = dict.fromkeys(name for part in self.parts for name in part.observed)
        return f"{len(each)} features of {sum(len(part.record) for part in self.parts)} slip events"

    @property
    def independent(self) -> float:
        """The number of independent samples behind the scatter of the features."""
        spare = max(self._spare, 0)
        return float(sum(self.part_of(i).means.degrees for i in range(len(self.parts))) - spare + len(self.free))

    @property
    def _spare(self) -> int:
        """The number of features minus the number of free numbers."""
        return sum(len(part.observed) for part in self.parts) - len(self.free)

    def variance(self, searched: Floats) -> float:
        """Return the factor on the covariance: 1, or the mean squared residual if above 1 and features outnumber the numbers."""
        if self._spare < 1:
            return 1.0
        rest = np.concatenate([self.part_residual(searched, i) for i in range(len(self.parts))])
        return max(1.0, float(rest @ rest) / self._spare)

    def fine(self, searched: Floats) -> Model:
        """Return the model with steps of differences that are long enough to hide the effect of waves."""
        return self.with_(step=COARSER)

    def thinned(self, most: int) -> Model:
        """Return the same model: events are few."""
        return self.with_(step=COARSER)

    def compared(self, searched: Floats) -> pd.DataFrame:
        """Return the features of a run beside their means in the record, one row for each feature of a part.

        Columns: part, feature, mean and its standard error, run (NaN without events), unit, and missed: True if run and mean are
        farther apart than the error of the mean and a share of the scatter explain.
        """
        rows = []
        for i, part in enumerate(self.parts):
            run, means = self.solve(searched, i), self.part_of(i).means
            found = {} if run is None else self._found(run, i)
            for name, mean, error in zip(part.observed, means.values.tolist(), means.errors.tolist(), strict=True):
                value, scatter = found.get(name, math.nan), float(np.nanstd(part.record.measured[name]))
                missed = not abs(value - mean) <= MISSED * math.hypot(error, ALLOWED * scatter)
                rows.append((i, name, mean, error, value, self.problem.unit_of(name), missed))
        return pd.DataFrame(rows, columns=["part", "feature", "mean", "error", "run", "unit", "missed"])


def scatter_of(parts: Sequence[Part]) -> dict[str, float]:
    """Return the standard deviation of each feature from event to event (SI)."""
    found = {}
    for name in dict.fromkeys(name for part in parts for name in part.observed):
        of = [part.record.measured[name] for part in parts if name in part.observed]
        least = MEASURED * max(float(np.nanmax(np.abs(values))) for values in of)
        found[name] = max(math.sqrt(float(np.mean([np.nanvar(values, ddof=1) for values in of]))), least)
    return found


def features_of_run(run: Solution, part: FeaturePart) -> dict[str, float]:
    """Return the mean features of the events of a run, without the first ones if there are enough; empty for fewer than two."""
    shear = part.record.shear_of_events
    assert shear is not None
    names = [shear, *(name for name, of in (("slip", "event_slip"), ("slip_rate", "peak_rate")) if of in part.observed)]

    def between(begin: float, end: float, points: int = FINE) -> Samples:
        edges = breaks_of(run, is_at_driver(shear, part.sensor))
        breaks = edges[(edges > begin) & (edges < end)]
        time = np.concatenate([np.linspace(max(begin, 0.0), min(end, run.history.span[1]), points), breaks, breaks])
        left = np.arange(len(time)) >= points + len(breaks)
        values = {}
        for name in names:
            value = measured(run, name, part.sensor, time)
            if name in JUMPING and len(breaks):
                value[left] = measured(run, name, part.sensor, breaks, "left")
            values[name] = value
        order = np.lexsort((~left, time))
        return Samples(time[order], {name: value[order] for name, value in values.items()})

    found = features_in(between(0.0, run.history.span[1], COARSE), between, shear)
    if not found:
        return {}
    if isinstance(part.samples, EventPart):
        found |= levels_in(found, between, shear)
    settled = min(SETTLING, len(found["time"]) - 1)
    return {name: float(np.mean(values[settled:])) for name, values in found.items() if name != "time"}
