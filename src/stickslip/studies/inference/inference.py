"""The result of `infer`: numbers with intervals, the best problem, and what is and is not known."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import write_atomically, write_table
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import brief, with_uncertainty
from stickslip.foundation.netcdf_file import write
from stickslip.io.netcdf import origin
from stickslip.problem.problem import Problem
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.accessors import report_of_study
from stickslip.solution.solution import Solution
from stickslip.studies.inference.by_features import FeatureModel
from stickslip.studies.inference.certainty import Certainty, Profile
from stickslip.studies.inference.estimate import Estimate
from stickslip.studies.inference.free import Free
from stickslip.studies.inference.memory import WHITE
from stickslip.studies.inference.model import OF_NO_ZERO, Model, unit_of
from stickslip.studies.inference.part import Part
from stickslip.studies.inference.sampling import MOST_SAMPLES, Walk, sample
from stickslip.studies.inference.search import Told
from stickslip.studies.inference.words import notes_of
from stickslip.studies.study import Study, TextProgress, telling


def _near(value: float, uncertainty: float) -> str:
    size = abs(value) / uncertainty if 0.0 < uncertainty < math.inf else 1.0
    return f"{value:.{min(max(2 + math.ceil(math.log10(max(size, 1e-3))), 3), 12)}g}"


@dataclass(frozen=True, eq=False, repr=False)
class Inference(Study):
    """The result of `infer`: the best fit with its model, and what the record determines.

    `parts` are the parts of the record, with what was left out of the fit; `about` says what was done with it, one sentence each.
    `profiles` of the likelihood and the `walk` through the posterior distribution are there if they were asked for. `windows`, if
    they were asked for, has the numbers of shorter parts of the record, one row each: begin, end (s since the first sample),
    samples, and each free number (SI). `asked` are the options that were given, by name.
    """

    estimate: Estimate
    certainty: Certainty
    parts: tuple[Part, ...]
    about: tuple[str, ...]
    profiles: tuple[Profile, ...] = ()
    walk: Walk | None = None
    windows: pd.DataFrame | None = None
    asked: Mapping[str, Any] = field(default_factory=dict)

    @property
    def model(self) -> Model:
        """The model that was fitted."""
        return self.estimate.model

    @property
    def free(self) -> tuple[Free, ...]:
        """The free numbers, those of single parts last."""
        return self.model.free

    @property
    def values(self) -> dict[str, float]:
        """The best values of the free numbers (SI), by name."""
        return dict(zip([one.label for one in self.free], self.model.values(self.estimate.searched), strict=True))

    @cached_property
    def table(self) -> pd.DataFrame:
        """A table with one row for each free number, by its name.

        Columns: value, uncertainty (standard, infinite where the record does not determine it, NaN on a bound), low and high
        (interval of 95 %), all in SI; unit; start, where the search began; source of the interval: curvature, profile or samples.
        """
        rows = [self._row(i, one) for i, one in enumerate(self.free)]
        columns = ["value", "uncertainty", "low", "high", "unit", "start", "source"]
        return pd.DataFrame(rows, index=pd.Index([one.label for one in self.free], name="number"), columns=columns)

    def _row(self, i: int, one: Free) -> tuple[float, float, float, float, str, float, str]:
        value, width = self.values[one.label], float(self.certainty.widths[i])
        uncertainty = one.width(value, width)
        if self.certainty.on_bound[i]:
            return value, math.nan, value, value, one.declared.unit, one.start, "bound"
        searched, half = float(self.estimate.searched[i]), self.certainty.factor * width
        low, high = (max(one.low, one.natural(searched - half)), min(one.high, one.natural(searched + half)))
        source = "curvature"
        profile = next((found for found in self.profiles if found.name == one.label), None)
        if profile is not None and np.isfinite([profile.low, profile.high]).all():
            low, high, source = profile.low, profile.high, "profile"
            uncertainty = (high - low) / (2.0 * self.certainty.factor)
        if self.samples is not None and np.isfinite(width):  # samples of a number without influence only show its limits
            low, high = np.quantile(self.samples[one.label], [0.025, 0.975]).tolist()
            source = "samples"
            uncertainty = float(self.samples[one.label].std())
        return value, uncertainty, low, high, one.declared.unit, one.start, source

    @cached_property
    def samples(self) -> pd.DataFrame | None:
        """Samples of the posterior distribution (SI), a column for each free number; None if none were asked for."""
        if self.walk is None:
            return None
        drawn = self.walk.drawn
        return pd.DataFrame({one.label: [one.natural(x) for x in drawn[:, i].tolist()] for i, one in enumerate(self.free)})

    @property
    def about_samples(self) -> tuple[str, ...]:
        """Sentences on how good the samples are; empty if none were asked for."""
        return () if self.walk is None else self.walk.notes

    def more(self, samples: int, *, progress: TextProgress | bool | None = None) -> Self:
        """Draw further samples of the posterior distribution, until there are `samples` in all, and return the result with them.

        The walk goes on where it ended, also where Ctrl-C ended it. Raises InputError if no samples were drawn before, or if there
        are as many already.
        """
        count = check_whole("more: samples", samples, 1, MOST_SAMPLES)
        if self.walk is None:
            raise InputError("more: no samples were drawn: ask `infer` for some first, with samples=")
        if count <= len(self.walk.drawn):
            raise InputError(f"more: there are {len(self.walk.drawn)} samples already, got {count}")
        with telling(progress, "infer") as tell:
            told = Told(tell)
            found = replace(self.estimate, model=self.model.with_(ran=told.run))
            walk = sample(found, self.certainty, count, told, before=self.walk)
        return replace(self, walk=walk, estimate=replace(self.estimate, finished=not walk.stopped))

    @property
    def determined(self) -> bool:
        """True if the record determines at least one of the numbers."""
        return bool(np.isfinite(self.certainty.widths).any()) or not self.estimate.finished

    @property
    def correlation(self) -> pd.DataFrame:
        """Correlations of the searched numbers, which are logarithms where numbers are positive; NaN if not determined."""
        labels = [one.label for one in self.free]
        return pd.DataFrame(self.certainty.correlation, labels, labels)

    def best_of(self, part: int = 0) -> Problem:
        """Return the problem with the best numbers, under the loading of a part; 0 is the first."""
        return self._whole.at(self.estimate.searched, part)

    @property
    def best(self) -> Problem:
        """The problem with the best numbers, under the loading of the (first part of the) record."""
        return self.best_of(0)

    @property
    def scenario(self) -> Scenario:
        """The scenario that runs to the curve of the (first part of the) record."""
        name = Path(self.parts[0].record.name).name
        title = f"Fitted to {name}" + (f", part 1 of {len(self.parts)}" if len(self.parts) > 1 else "")
        about = "\n".join([self.headline, *(f"{name} = {text}" for name, text, _ in self.rows), *self.notes])
        return Scenario(self.best, self.parts[0].duration, self.model.rtol, title, about, name="fitted")

    def to_toml(self, path: str | Path) -> Path:
        """Write the scenario that runs to the curve shown, with the loading as a list of steps, and return the path."""
        text = self.scenario.to_toml()
        return write_atomically(Path(path), lambda draft: draft.write_text(text, encoding="utf-8"))

    @cached_property
    def _whole(self) -> Model:
        """The model with what was left out of the fit; numbers of parts that were not fitted are those of the record."""
        return self.model.with_(parts=self.parts)

    @cached_property
    def runs(self) -> tuple[Solution, ...]:
        """The best run of each part, those that were left out too. Raises InputError if one fails, as after a bad prediction."""
        found = [self._whole.solve(self.estimate.searched, i) for i in range(len(self.parts))]
        if any(run is None for run in found):
            raise InputError("infer: the best numbers do not run to the end of the record")
        return tuple(run for run in found if run is not None)

    def _fitted_until(self, part: int) -> float:
        return float(self.model.parts[part].record.clock[-1]) if part < len(self.model.parts) else -1.0

    @cached_property
    def curves(self) -> pd.DataFrame:
        """Data, model and residual at each sample.

        Columns: part; time (s since the first sample of the part); quantity; data, model and residual (data minus model, SI);
        fitted, False for what was left out.
        """
        pieces = []
        for i, run in enumerate(self.runs):
            clock = self.parts[i].record.clock
            for name, model in self._whole.curves(run, self.estimate.searched, i).items():
                data = self._whole.data(i, name)
                data = data + self._zero(model - data, clock <= self._fitted_until(i)) if name in OF_NO_ZERO else data
                columns = {"part": i, "time": clock, "quantity": name, "data": data, "model": model, "residual": data - model}
                pieces.append(pd.DataFrame(columns | {"fitted": clock <= self._fitted_until(i)}))
        return pd.concat(pieces, ignore_index=True)

    @staticmethod
    def _zero(apart: Floats, fitted: NDArray[np.bool_]) -> float:
        """Return the zero of a sensor: the mean difference of the run from the samples fitted, or from all if none were."""
        known = np.isfinite(apart)
        return float(np.mean(apart[known & fitted if (known & fitted).any() else known]))

    def errors(self, sizes: Mapping[str, float], *, fitted: bool) -> float:
        """Return the root mean square residual of what was fitted, or left out, in given sizes of noise by quantity (SI)."""
        table = self.curves[(self.curves.fitted == fitted) & self.curves.residual.notna()]
        if table.empty:
            return math.nan
        scaled = table.residual.to_numpy() / np.array([sizes[name] for name in table.quantity])
        return float(np.sqrt(np.mean(scaled**2)))

    @cached_property
    def prediction(self) -> float | None:
        """Root mean square error of what was left out, in standard deviations of the noise; None if nothing was."""
        error = self.errors(self.model.sizes, fitted=False)
        return None if math.isnan(error) else error

    @property
    def bic(self) -> float:
        """Schwarz's criterion: of inferences from one record the smallest fits best for its number of free numbers."""
        n, total = self.model.samples, 0.0
        for name, size in self.model.sizes.items():
            count = sum(len(b.time) for i in range(len(self.model.parts)) for q, b in self.model.blocks(i) if q == name)
            total += 2.0 * count * math.log(size)
        return total + self.estimate.cost(self.estimate.searched) + len(self.free) * math.log(n)

    @cached_property
    def features(self) -> pd.DataFrame | None:
        """Features of slip events of the best run beside their means in the record; None if samples were fitted.

        Columns: part, feature, mean and its standard error, run, unit, and missed (True where the run misses the mean).
        """
        return self.model.compared(self.estimate.searched) if isinstance(self.model, FeatureModel) else None

    @property
    def fit(self) -> pd.DataFrame:
        """What is left of each fitted quantity: samples, noise (standard deviation, SI), memory (s), and rms of the residual."""
        table, rows = self.curves[self.curves.fitted], {}
        for name, size in self.model.sizes.items():
            rest = table.residual[table.quantity == name].dropna().to_numpy()
            rows[name] = (len(rest), size, self.model.memory.get(name, WHITE).time, float(np.sqrt(np.mean(rest**2))), unit_of(name))
        return pd.DataFrame.from_dict(rows, orient="index", columns=["samples", "noise", "memory", "rms", "unit"])

    @property
    def notes(self) -> list[str]:
        """What is not determined, and what else to know before the numbers are used, one sentence each."""
        return list(dict.fromkeys(notes_of(self)))

    @property
    def rows(self) -> list[tuple[str, str, str]]:
        """Name, value with interval, and unit of each free number that all parts share, as text."""
        found = []
        for name, row in self.table.iterrows():
            one = next(free for free in self.free if free.label == name)
            if one.part is not None:
                continue
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
        """What was found from what, in one line."""
        shared = sum(one.part is None for one in self.free)
        sizes = ", ".join(f"{name} {brief(size, unit_of(name), 3)}" for name, size in self.model.sizes.items())
        what = "scatter" if self.model.of_means else "noise"
        return f"{shared} number{'' if shared == 1 else 's'} from {self.model.counted}, {what}: {sizes}; intervals of 95 %"

    def to_netcdf(self, path: str | Path) -> Path:
        """Write data, model, residual, numbers, samples and provenance, and return the path. Raises InputError if that fails."""
        provenance: dict[str, Any] = {**origin(self.runs[0]), "title": "stickslip inference", "notes": "\n".join(self.notes)}
        return write(self.to_dataset().assign_attrs(provenance | {"scenario": self.scenario.to_toml()}), Path(path))

    def to_csv(self, path: str | Path) -> Path:
        """Write the table of numbers as CSV, after the notes as comment lines (#), and return the path."""
        return write_table(Path(path), self.table.reset_index(), [self.headline, *self.notes])

    def report(self, folder: str | Path, *others: Inference) -> Path:
        """Write a report into a folder: a page that needs no other file, with figures, numbers, best scenario and data beside it.

        It returns the path of the page, `report.html`, which ranks `others`, inferences from the same record with other laws, by
        what they predict, as `ranking` does. Raises InputError if the best numbers do not run to the end of the record, or if
        `others` are of another record, and OSError if the folder cannot be written.
        """
        return report_of_study(self, Path(folder), *others)

    def _lines(self) -> Iterator[str]:
        yield self.headline
        width = max(len(name) for name, _, _ in self.rows)
        for name, value, unit in self.rows:
            yield f"{name:<{width}}  {value} {unit}"
        yield from self.notes
