"""The result of `infer`: numbers with intervals, the best problem, and notes on what the record does not determine."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import pandas as pd

from stickslip.extensions.inference.certainty.sampling import MOST_SAMPLES, sample
from stickslip.extensions.inference.fit.free import DELAY, DRIFT, TREND
from stickslip.extensions.inference.fit.looks import cure_of
from stickslip.extensions.inference.fit.memory import EVEN, LONGEST_MEMORY, WHITE
from stickslip.extensions.inference.fit.part import first_sizes
from stickslip.extensions.inference.fit.progress import SearchProgress
from stickslip.extensions.inference.fit.starting import FALLS_IN_EVENTS
from stickslip.extensions.inference.fit.what_is_left import words
from stickslip.extensions.inference.fitted_record import FittedRecord
from stickslip.extensions.inference.record.features import arrests_in
from stickslip.extensions.inference.record.noise import rounding_of
from stickslip.extensions.inference.record.record import SHEAR
from stickslip.foundation.arguments import check_whole, for_users, shown
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import write_atomically, write_table
from stickslip.foundation.errors import InputError
from stickslip.foundation.given import PLACE, preferred
from stickslip.foundation.netcdf_file import write
from stickslip.foundation.quantities import Choice, fields_of
from stickslip.foundation.show import brief, with_uncertainty
from stickslip.friction import FrictionLaw
from stickslip.problem.scenarios import Scenario
from stickslip.run import TextProgress, telling
from stickslip.solution.files import origin

if TYPE_CHECKING:
    import xarray as xr

MISSED, MISSED_SHARE = 3.0, 0.2
"""A run misses a record if residuals exceed this multiple of the noise of neighbouring samples and this share of the scatter."""
INTERRUPTED = "interrupted: these are the best numbers so far"
MANY_DEVIATIONS = 1.5
"""Residuals above this many given standard deviations are reported as larger than the stated noise."""


def in_shown_unit(name: str, row: Any) -> Any:
    """Return the row of a searched number in the given unit of numbers of its kind, or as it is, in SI."""
    is_place = name.startswith("body.") and row.unit == "m"
    given = preferred(PLACE if is_place else row.unit, abs(row.value))
    if given is None:
        return row
    found = row.copy()
    found["unit"] = given[0]
    for column in ("value", "uncertainty", "low", "high", "start"):
        found[column] = row[column] / given[1]
    return found


def _near(value: float, uncertainty: float) -> str:
    size = abs(value) / uncertainty if 0.0 < uncertainty < math.inf else 1.0
    return f"{value:.{min(max(2 + math.ceil(math.log10(max(size, 1e-3))), 3), 12)}g}"


@dataclass(frozen=True, eq=False, repr=False)
class Inference(FittedRecord):
    """The result of `infer`: a `FittedRecord` that can be read as sentences, used as a scenario, and written to files."""

    def more(self, samples: int, *, progress: TextProgress | bool | None = None) -> Self:
        """Draw further samples of the posterior distribution, until there are `samples` in all, and return the result with them.

        The walk continues from its end, also after Ctrl-C. Raises InputError if no samples were drawn before, or if there are as
        many already.
        """
        count = check_whole("more: samples", samples, 1, MOST_SAMPLES)
        if self.walk is None:
            raise InputError("more: no samples were drawn: ask `infer` for some first, with samples=")
        if count <= len(self.walk.drawn):
            raise InputError(f"more: there are {len(self.walk.drawn)} samples already, got {count}")
        with telling(progress, "infer") as tell:
            told = SearchProgress(tell)
            found = replace(self.estimate, model=self.model.with_(ran=told.run))
            walk = sample(found, self.certainty, count, told, before=self.walk)
        return replace(self, walk=walk, estimate=replace(self.estimate, finished=not walk.stopped))

    @property
    def scenario(self) -> Scenario:
        """The scenario whose run is the best curve through the record, or through its first part."""
        name = Path(self.parts[0].record.name).name
        title = f"Fitted to {name}" + (f", part 1 of {len(self.parts)}" if len(self.parts) > 1 else "")
        about = "\n".join([self.headline, *(f"{name} = {text}" for name, text, _ in self.rows), *self.notes])
        return Scenario(self.best, self.parts[0].duration, self.model.rtol, title, about, name="fitted")

    @property
    def notes(self) -> list[str]:
        """Notes to read before using the numbers, one sentence each: what is not determined, and what raises doubts.

        Questions come first: a wrong unit or sign makes all else worthless.
        """
        return sorted(dict.fromkeys(notes_of(self)), key=lambda note: not note.endswith("?"))

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """Name, value with interval, and unit of each shared free number, as text."""
        found = []
        for name, row in self.table.iterrows():
            one = next(free for free in self.free if free.label == name)
            if one.part is not None:
                continue
            row = in_shown_unit(str(name), row)
            unit = "" if row.unit == "1" else row.unit
            how = (
                "on a bound"
                if row.source == "bound"
                else f"{_near(row.low, row.uncertainty)} to {_near(row.high, row.uncertainty)}"
            )
            sure = bool(np.isfinite(row.uncertainty))
            how = how if sure or row.source == "bound" else "not determined"
            found.append((str(name), with_uncertainty(row.value, row.uncertainty if sure else None), f"{unit}  ({how})".strip()))
        return found

    @property
    def headline(self) -> str:
        """One line: how many numbers were found from how many samples, and the noise."""
        shared = sum(one.part is None for one in self.free)
        sizes = ", ".join(f"{name} {brief(size, self.model.problem.unit_of(name), 3)}" for name, size in self.model.sizes.items())
        what = "scatter" if self.model.of_means else "noise"
        return f"{shared} number{'' if shared == 1 else 's'} from {self.model.counted}, {what}: {sizes}; intervals of 95 %"

    def to_toml(self, path: str | Path) -> Path:
        """Write the scenario of the best curve, with the loading as a list of steps, and return the path."""
        text = self.scenario.to_toml()
        return write_atomically(Path(path), lambda draft: draft.write_text(text, encoding="utf-8"))

    def to_netcdf(self, path: str | Path) -> Path:
        """Write data, model, residual, numbers, samples and provenance, and return the path. Raises InputError if that fails."""
        provenance: dict[str, Any] = {**origin(self.runs[0]), "title": "stickslip inference", "notes": "\n".join(self.notes)}
        return write(self.to_dataset().assign_attrs(provenance | {"scenario": self.scenario.to_toml()}), Path(path))

    def to_csv(self, path: str | Path) -> Path:
        """Write the table of numbers as CSV, after the notes as comment lines (#), and return the path."""
        return write_table(Path(path), self.table.reset_index(), [self.headline, *self.notes])

    def report(self, folder: str | Path, *others: Inference) -> Path:
        """Write a report into a folder and return the path of its page, `report.html`.

        The page needs no other file; figures, numbers, best scenario and data are written beside it. `others` are inferences from
        the same record with other laws; the page ranks them by their predictions, as `ranking` does. Raises InputError if the best
        numbers do not run to the end of the record, or if `others` are of another record, and OSError if the folder cannot be
        written.
        """
        from stickslip.extensions.inference.report import write

        return write(self, Path(folder), *others)

    def to_dataset(self) -> xr.Dataset:
        """Return what `plot` draws, in SI units."""
        from stickslip.extensions.inference.figures.inference import inference_data

        return inference_data(self)

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.inference.figures.inference import draw_inference

        return draw_inference

    def _sentences(self) -> Iterator[str]:
        yield self.headline
        width = max(len(name) for name, _, _ in self.rows)
        for name, value, unit in self.rows:
            yield f"{name:<{width}}  {value} {unit}"
        yield from self.notes


@for_users
def ranking(*found: Inference) -> pd.DataFrame:
    """Rank inferences from one record, each with `held_out`, by their prediction of the part left out, best first.

    There is one row for each. Columns: law, free (number of free numbers), fit and prediction (root mean square residual of the
    fitted part and of the part left out, in units of the smallest noise that any of the inferences found), and bic (Schwarz's
    criterion of the fitted part, smaller is better). Raises InputError without inferences, if no part was left out, or if the
    records differ.
    """
    if not found or not all(isinstance(one, Inference) for one in found):
        got = ", ".join(shown(one) for one in found) or "none"
        raise InputError(f"ranking: needs inferences, as in ranking(infer(..., held_out=0.3), infer(..., held_out=0.3)), got {got}")
    if len({(one.model.samples, tuple(len(part.record) for part in one.parts)) for one in found}) > 1:
        raise InputError("ranking: the inferences are of different records or leave out different parts")
    least = {name: min(one.model.sizes[name] for one in found) for name in found[0].model.sizes}
    rows = []
    for one in found:
        if one.prediction is None:
            raise InputError("ranking: nothing was left out to be predicted: give held_out=0.3 to infer")
        errors = [one.errors(least, fitted=fitted) for fitted in (True, False)]
        rows.append((_called(one.model.problem.friction), len(one.model.free), *errors, one.bic))
    table = pd.DataFrame(rows, columns=["law", "free", "fit", "prediction", "bic"])
    return table.sort_values("prediction", ignore_index=True)


def _called(law: FrictionLaw) -> str:
    """Return the kind of a law with its choices, such as "rate-and-state, ageing"."""
    chosen = (str(getattr(law, name)) for name, (declared, _) in fields_of(type(law)).items() if isinstance(declared, Choice))
    return ", ".join([law.kind, *chosen])


def notes_of(study: FittedRecord) -> Iterator[str]:
    """Yield the notes to read before using the numbers."""
    yield from warnings_of(study)
    yield from study.certainty.notes
    yield from minima_of(study)
    yield from noise_of(study)
    if study.prediction is not None:
        yield f"what was left out is predicted with an error of {study.prediction:.3g} times the noise"
    if study.windows is not None:
        yield from _windows(study.windows, {one.label: one.declared.unit for one in study.free}, study.table)
    yield from record_of(study)
    yield from study.about_samples
    yield from study.about


def warnings_of(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on doubts about the numbers as a whole."""
    if not study.estimate.finished:
        yield f"these are the best numbers so far: {study.estimate.ended}" if study.estimate.ended else INTERRUPTED
    yield from study.unresolved
    yield from _misfit(study)
    yield from looks_left(study)


def looks_left(study: FittedRecord) -> Iterator[str]:
    """Yield a sentence on each look of the residuals that is no noise, with its cure."""
    if study.features is not None:
        return
    free = {one.name for one in study.free}
    for name in study.model.sizes:
        looks = study.looks[name]
        for look in looks:
            cure = cure_of(look, name, free)
            yield f"what is left of {name} looks like {words([look], study.model.problem.unit_of(name))}: {cure}"


def minima_of(study: FittedRecord) -> Iterator[str]:
    """Yield a sentence on each other minimum that competes with the best one."""
    for x in study.estimate.others:
        values = [
            f"{one.label} {brief(v, one.declared.unit, 3)}" for one, v in zip(study.free, study.model.values(x), strict=False)
        ]
        yield f"another minimum fits almost as well: {', '.join(values[:8])}; bounds or priors choose between them"


def noise_of(study: FittedRecord) -> Iterator[str]:
    """Yield sentences on the memory of the noise, and on given standard deviations that are too small."""
    if study.features is not None:
        yield from _features(study, missed=False)
        return
    for name, memory in study.model.memory.items():
        if memory.time > 0.0 and not _drifts(study, name):
            yield f"residuals of {name} remember themselves for {brief(memory.time, 's', 3)}; the intervals allow for it"
    for name, size in study.model.sizes.items():
        if size > MANY_DEVIATIONS and any(name in part.record.deviations for part in study.parts):
            yield f"residuals of {name} are {size:.3g} times the standard deviations given; the intervals allow for it"


def record_of(study: FittedRecord) -> Iterator[str]:
    """Yield a sentence if some of the numbers belong to the record itself and so are in no scenario."""
    own = [f"{name} = {study.values[name]:.4g}" for name in (TREND, DRIFT, DELAY) if name in study.values]
    if own:
        yield f"{' and '.join(own)} belong to the record: the run of the best scenario, and the explorer, are without them"


def _features(study: FittedRecord, *, missed: bool) -> Iterator[str]:
    """Yield a sentence on each feature whose mean the run misses (or, with missed=False, meets)."""
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
    """Yield sentences on residuals that are no noise: far too large, a drift, or largest where the run changes."""
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
    """Return the standard deviation of the measured values (SI)."""
    values = [part.record.measured[name] for part in study.model.parts if name in part.observed]
    return max(float(np.nanstd(np.concatenate(values))), 1e-300)


def _rounding(study: FittedRecord, name: str) -> float:
    """Return half the step of the digitiser of a quantity (SI), 0 if no step shows."""
    return max(rounding_of(part.record.measured[name]) for part in study.model.parts if name in part.observed)


def _drifts(study: FittedRecord, name: str) -> bool:
    """Return True if the residuals of a quantity have the longest correlation time that the estimate allows."""
    longest = max(part.record.clock[-1] for part in study.model.parts if name in part.observed)
    return study.model.memory.get(name, WHITE).time > 0.95 * LONGEST_MEMORY * float(longest)


def _sticks_and_slips(shear: Floats) -> bool:
    """Return True if shear falls more than once, and much faster than it rises: after a velocity step it falls slowly."""
    known = shear[np.isfinite(shear)]
    bottoms = [0, *arrests_in(known).tolist()]
    falling = sum(last - first - int(np.argmax(known[first : last + 1])) for first, last in pairwise(bottoms))
    return len(bottoms) > 2 and falling < FALLS_IN_EVENTS * bottoms[-1]


def _never_slips(study: FittedRecord, name: str) -> bool:
    """Return True if shear drops in the record as in a slip event, but not in its run."""
    shown = study.curves[study.curves.quantity == name]
    drops = name in SHEAR and any(len(arrests_in(part.record.measured[name])) > 0 for part in study.parts)
    return drops and float(np.ptp(shown.model)) < 0.5 * float(np.nanmax(shown.data) - np.nanmin(shown.data))


def _windows(table: pd.DataFrame, units: Mapping[str, str], intervals: pd.DataFrame) -> Iterator[str]:
    """Yield sentences on the spread of numbers over windows, and on the numbers that vary more than their intervals allow."""
    spread = [f"{name} {brief(table[name].min(), unit, 4)} to {brief(table[name].max(), unit, 4)}" for name, unit in units.items()]
    lasts = table.end - table.begin
    yield f"over {len(table)} windows of {lasts.min():.3g} to {lasts.max():.3g} s: {', '.join(spread)}"
    wide = [n for n in units if np.ptp(table[n]) > intervals.high[n] - intervals.low[n]]
    if wide:
        yield f"{' and '.join(wide)} depend more on the window than the intervals say: give that spread beside the interval"
