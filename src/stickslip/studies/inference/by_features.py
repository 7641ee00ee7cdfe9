"""Fit a record of many slip events by their features and the scatter of these, in place of sample by sample."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.solution.solution import Solution
from stickslip.studies.inference.features import DROPS, FEATURES, Samples, features_in
from stickslip.studies.inference.model import JUMPING, Model, measured
from stickslip.studies.inference.part import Part
from stickslip.studies.inference.record import Record

CYCLES = 6.0
"""Length of a run in times between events of the record; its first events are passed over."""
SETTLING = 2
"""Number of events of a run after which its features count."""
SPARE = 3
"""Number of events beyond the number of features, of which the scatter of features and their correlation are estimated."""
COARSE, FINE = 1000, 200
"""Numbers of times at which a run is looked at as a whole, and between two times, besides the ends of its pieces."""
COARSER = 1e-2
"""Step of differences, in searched numbers: waves on their way shift features of a slab by a share of 1e-4 or so."""
FEWEST = 4.0
"""Number of samples in a fall from which its duration and peak rate can be told."""


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
        recurrence = self.record.measured["recurrence"]
        begins = float(self.record.time[0] - self.samples.record.time[0])
        return min(self.samples.duration, max(begins, 0.0) + CYCLES * float(np.median(recurrence)))

    @property
    def begins(self) -> float:
        """The time of the record at which the run begins (s)."""
        return self.samples.begins

    def first_load(self, normal: float) -> tuple[float, float]:
        """Return the load at the first sample and its standard error, as the part itself does."""
        return self.samples.first_load(normal)


def by_features(parts: Sequence[Part], observe: Sequence[str] | str | None) -> tuple[list[Part], list[str]]:
    """Return the features of parts, and sentences on them. Raises InputError if there are too few events."""
    wanted = [one.strip() for one in observe.split(",")] if isinstance(observe, str) else observe
    found, notes = list[Part](), list[str]()
    for part in parts:
        record, said = _record_of(part)
        names = list(record.measured) if wanted is None else _chosen(wanted, record)
        if len(record) < len(names) + SPARE:
            raise InputError(
                f"{record.name}: {len(record)} whole slip events are too few for the scatter of {len(names)} features: "
                "fit event by event, with parts='rests'"
            )
        found.append(FeaturePart(record, part.loading, tuple(names), part.sensor, part.start, part))
        notes += [*said, f"{len(record)} slip events of {record.name}, each with its {', '.join(names)}"]
    return found, notes


def _chosen(wanted: Sequence[str], record: Record) -> list[str]:
    short = {"drop": next(name for name in record.measured if name in DROPS)}
    names = [short.get(name, name) for name in wanted]
    for name in names:
        if name not in record.measured:
            raise InputError(f"infer: observe: events have no {ascii(name)[:40]}; {nearest(str(name), record.measured)}")
    return names


def _record_of(part: Part) -> tuple[Record, list[str]]:
    """Return the features of the events of a record at the times of these, and sentences on what was left out."""
    record, shear = part.record, part.record.shear
    if shear is None:
        raise InputError(f"{record.name}: by='features' needs shear, whose drops are the slip events")
    known = np.isfinite(record.measured[shear])
    time = record.clock[known]
    values = {name: one[known] for name, one in record.measured.items() if name in (shear, "slip", "slip_rate")}
    values = {name: one for name, one in values.items() if np.isfinite(one).all()}

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
    samples = float(np.median(found["duration"])) / float(np.median(np.diff(time)))
    if not samples >= FEWEST:
        found = {name: one for name, one in found.items() if name not in ("duration", "peak_rate")}
        notes.append("a fall lasts too few samples for its duration and its peak rate: they are not used")
    whole = np.all([np.isfinite(one) for one in found.values()], axis=0)
    found = {name: found[name][whole] for name in FEATURES if name in found}
    return Record(record.time[0] + at[whole], found, name=record.name, notes=record.notes), notes


@dataclass
class FeatureModel(Model):
    """Residuals of the features of slip events: those of a run, which repeat, less those of each event of the record.

    Features of one event scatter together, as drop and time between events do, so that their correlation is taken away.
    """

    apart: dict[int, Floats] = field(default_factory=dict)

    def curves(self, run: Solution, searched: Floats, part: int, every: int = 1) -> dict[str, Floats]:
        """Return the mean features of a run at each event, NaN if it has no events."""
        this = self.parts[part]
        assert isinstance(this, FeaturePart)
        found = features_of_run(run, this)
        count = len(this.record.clock[::every])
        return {name: np.full(count, found.get(name, np.nan)) for name in this.observed}

    def white(self, residual: Floats, part: int) -> Floats:
        """Return residuals of a part, or their derivatives, without what neighbouring events, and features of one event, share."""
        if part not in self.apart:
            self.apart[part] = _inverse_root(np.array([self.data(part, name) for name in self.parts[part].observed]))
        alone, matrix = super().white(residual, part), self.apart[part]
        shaped = alone.reshape(len(matrix), -1, *alone.shape[1:])
        return np.asarray(np.einsum("ij,j...->i...", matrix, shaped).reshape(alone.shape))

    @property
    def independent(self) -> float:
        """The number of independent samples: the scatter of features is known from as many events as there are."""
        numbers = len(self.free)
        spare = [len(part.record) - 1 - max(len(part.observed) - numbers, 0) for part in self.parts]
        return float(sum(spare) + numbers)

    def fine(self, searched: Floats) -> Model:
        """Return the model with steps of differences in which waves on their way do not show."""
        return self.with_(step=COARSER)

    @property
    def counted(self) -> str:
        """What is fitted, as text."""
        each = dict.fromkeys(name for part in self.parts for name in part.observed)
        return f"{len(each)} features of {sum(len(part.record) for part in self.parts)} slip events"

    def thinned(self, most: int) -> Model:
        """Return the same model: events are few."""
        return self.with_(step=COARSER)


def _inverse_root(features: Floats) -> Floats:
    """Return the matrix that takes the correlation of features away, of shape (features, features), from all events."""
    away = features - features.mean(axis=1, keepdims=True)
    sizes = np.sqrt(np.mean(away**2, axis=1))
    away = away / np.where(sizes > 0.0, sizes, 1.0)[:, None]
    correlation = away @ away.T / away.shape[1]
    np.fill_diagonal(correlation, 1.0)
    least = 1.0 / away.shape[1]  # what is left of one feature is not known better than its mean
    return np.asarray(np.linalg.inv(np.linalg.cholesky((1.0 - least) * correlation + least * np.eye(len(away)))))


def features_of_run(run: Solution, part: FeaturePart) -> dict[str, float]:
    """Return the mean features of the events of a run, but the first ones if there are enough; empty if it has fewer than two."""
    shear = part.samples.record.shear
    assert shear is not None
    names = [shear, *(name for name, of in (("slip", "event_slip"), ("slip_rate", "peak_rate")) if of in part.observed)]

    def between(begin: float, end: float, points: int = FINE) -> Samples:
        breaks = run.breaks[(run.breaks > begin) & (run.breaks < end)]
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
    settled = min(SETTLING, len(found["time"]) - 1)
    return {name: float(np.mean(values[settled:])) for name, values in found.items() if name != "time"}
