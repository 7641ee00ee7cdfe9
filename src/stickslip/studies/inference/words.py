"""What to know before the numbers of an inference are used, in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.show import brief
from stickslip.studies.inference.features import arrests_in
from stickslip.studies.inference.fitted_record import FittedRecord
from stickslip.studies.inference.free import DELAY, TREND
from stickslip.studies.inference.memory import EVEN, LONGEST, WHITE
from stickslip.studies.inference.noise import rounding_of
from stickslip.studies.inference.part import first_sizes
from stickslip.studies.inference.record import SHEAR
from stickslip.studies.inference.windows import told

MISSED, MISSED_SHARE = 3.0, 0.2
"""Sizes of residuals, in the noise of neighbouring samples and in the scatter of the record, beyond which a run misses it."""
FALLING = 0.2
"""Share of the time in which shear falls below which it does so in slip events."""
MANY = 1.5
"""Size of residuals, in the standard deviations that were given, from which they are told to be larger."""


def notes_of(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on what is not determined, and on what else to know before the numbers are used."""
    yield from warnings_of(study)
    yield from study.certainty.notes
    yield from minima_of(study)
    yield from noise_of(study)
    if study.prediction is not None:
        yield f"what was left out is predicted with an error of {study.prediction:.3g} times the noise"
    if study.windows is not None:
        yield from told(study.windows, {one.label: one.declared.unit for one in study.free}, study.table)
    yield from record_of(study)
    yield from study.about_samples
    yield from study.about


def warnings_of(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on what speaks against the numbers as a whole."""
    if not study.estimate.finished:
        yield "interrupted: these are the best numbers so far"
    yield from _misfit(study)


def minima_of(study: FittedRecord) -> Iterator[str]:
    """Yield a sentence on each other minimum that competes with the best one."""
    for x in study.estimate.others:
        values = [f"{one.label} {brief(v, one.declared.unit, 3)}" for one, v in zip(study.free, study.model.values(x), strict=True)]
        yield f"another minimum fits almost as well: {', '.join(values[:8])}; bounds or priors choose between them"


def noise_of(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on the memory of the noise, and on standard deviations that were given too small."""
    if study.features is not None:
        yield from _features(study, missed=False)
        return
    for name, memory in study.model.memory.items():
        if memory.time > 0.0 and not _drifts(study, name):
            yield f"residuals of {name} remember themselves for {brief(memory.time, 's', 3)}; the intervals allow for it"
    for name, size in study.model.sizes.items():
        if size > MANY and any(name in part.record.deviations for part in study.parts):
            yield f"residuals of {name} are {size:.3g} times the standard deviations given; the intervals allow for it"


def record_of(study: FittedRecord) -> Iterator[str]:
    """Yield a sentence if numbers of the record itself were found, which no scenario holds."""
    own = [f"{name} = {study.values[name]:.4g}" for name in (TREND, DELAY) if name in study.values]
    if own:
        yield f"{' and '.join(own)} belong to the record: the run of the best scenario, and the explorer, are without them"


def _features(study: FittedRecord, *, missed: bool) -> Iterator[str]:
    """Yield a sentence on each feature whose mean the run misses, or does not miss."""
    if study.features is None:
        return
    rows: list[Any] = list(study.features[study.features.missed == missed].itertuples())
    for row in rows:
        of = f"{row.feature} of part {row.part}" if len(study.model.parts) > 1 else row.feature
        mean = f"{brief(row.mean, row.unit, 5)} ± {brief(row.error, row.unit, 2)}"
        ran = "has no slip events" if math.isnan(row.run) else f"has {brief(row.run, row.unit, 4)}"
        away = f", {abs(row.run - row.mean) / row.error:.0f} standard errors away" if missed and np.isfinite(row.run) else ""
        yield f"{'the run misses ' * missed}{of}: the mean of the record is {mean}, and the run {ran}{away}"


def _misfit(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on what is left if that is no noise: far too much of it, a drift, or most where the run changes."""
    if study.features is not None:
        yield from _features(study, missed=True)
        return
    for name, noise in first_sizes(study.model.parts).items():
        given = any(name in part.record.deviations for part in study.model.parts)
        size, scatter = study.model.sizes[name], _scatter(study, name)
        if not given and size > MISSED * noise and size > MISSED_SHARE * scatter:
            alone = len(study.parts) == 1 and name in SHEAR and _sticks_and_slips(study.parts[0].record.measured[name])
            cure = "; the record has several slip events: fit each from its own rest with parts='rests'" if alone else ""
            if not cure and _never_slips(study, name):
                cure = "; the record has a slip event, the run has none: begin, or give bounds, with numbers with which it slips"
            yield (
                f"the run misses features of {name}: what is left is {size / noise:.3g} times the noise of neighbouring samples "
                f"and {size / scatter:.0%} of the scatter of the record, and its numbers may mean little{cure}"
            )
        elif _drifts(study, name):
            yield (
                f"what is left of {name} is no noise but a drift or a misfit: it remembers itself for more than an eighth of the "
                "record; a trend can be free as record.trend, or another law may follow"
            )
        if (times := study.certainty.uneven.get(name, EVEN).misfit) > 1.0 and size > _rounding(study, name):
            yield (
                f"what is left of {name} is {times:.2g} times larger where the run depends most on its numbers than elsewhere: "
                "law, machine or loading do not follow there; intervals are wider for it, but another model may give other numbers"
            )


def _scatter(study: FittedRecord, name: str) -> float:
    """Return the standard deviation of what was measured (SI)."""
    values = [part.record.measured[name] for part in study.model.parts if name in part.observed]
    return max(float(np.nanstd(np.concatenate(values))), 1e-300)


def _rounding(study: FittedRecord, name: str) -> float:
    """Return half the step of the digitiser of a quantity (SI), 0 if it has none that shows."""
    return max(rounding_of(part.record.measured[name]) for part in study.model.parts if name in part.observed)


def _drifts(study: FittedRecord, name: str) -> bool:
    """Return True if what is left of a quantity remembers itself for as long as is looked for."""
    longest = max(part.record.clock[-1] for part in study.model.parts if name in part.observed)
    return study.model.memory.get(name, WHITE).time > 0.95 * LONGEST * float(longest)


def _sticks_and_slips(shear: Floats) -> bool:
    """Return True if shear falls more than once, and much faster than it rises: after a velocity step it falls slowly."""
    known = shear[np.isfinite(shear)]
    bottoms = [0, *arrests_in(known).tolist()]
    falling = sum(last - first - int(np.argmax(known[first : last + 1])) for first, last in pairwise(bottoms))
    return len(bottoms) > 2 and falling < FALLING * bottoms[-1]


def _never_slips(study: FittedRecord, name: str) -> bool:
    """Return True if shear drops in a record as in a slip event, and nothing of the kind happens in its run."""
    shown = study.curves[study.curves.quantity == name]
    drops = name in SHEAR and any(len(arrests_in(part.record.measured[name])) > 0 for part in study.parts)
    return drops and float(np.ptp(shown.model)) < 0.5 * float(np.nanmax(shown.data) - np.nanmin(shown.data))
