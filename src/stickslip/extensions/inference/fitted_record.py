"""The best fit to a record: numbers with intervals, the best runs, and the residuals."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stickslip.extensions.inference.certainty.certainty import Certainty, Profile
from stickslip.extensions.inference.certainty.sampling import PosteriorWalk
from stickslip.extensions.inference.fit.by_features import FeatureModel
from stickslip.extensions.inference.fit.estimate import Estimate
from stickslip.extensions.inference.fit.free import Free
from stickslip.extensions.inference.fit.looks import looks_of
from stickslip.extensions.inference.fit.memory import WHITE
from stickslip.extensions.inference.fit.model import OF_NO_ZERO, Model
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.fit.pieces import pieces_of
from stickslip.extensions.inference.fit.what_is_left import ResidualLook
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem
from stickslip.run import StudyWithDataset
from stickslip.solution import Solution


@dataclass(frozen=True, eq=False, repr=False)
class FittedRecord(StudyWithDataset):
    """The best fit to a record: the model, the numbers, and how well the record determines them.

    `parts` are the parts of the record, including those left out of the fit; `about` says what was done with the record, one
    sentence each. `profiles` of the likelihood, the `walk` through the posterior distribution and `windows` are there if the user
    asked for them. `windows` has one row for each shorter part of the record: begin, end (s since the first sample), samples, and
    each free number (SI). `asked` are the options that were given, by name.
    `unresolved` are sentences on steps and jumps of the loading that happen between two samples.
    """

    estimate: Estimate
    certainty: Certainty
    parts: tuple[Part, ...]
    about: tuple[str, ...]
    profiles: tuple[Profile, ...] = ()
    walk: PosteriorWalk | None = None
    windows: pd.DataFrame | None = None
    asked: Mapping[str, Any] = field(default_factory=dict)
    unresolved: tuple[str, ...] = ()

    @property
    def model(self) -> Model:
        """The model that was fitted."""
        return self.estimate.model

    @property
    def free(self) -> tuple[Free, ...]:
        """The free numbers that were asked for, those of single parts last."""
        return tuple(one for one in self.model.free if not one.aside)

    @property
    def values(self) -> dict[str, float]:
        """The best values of the free numbers (SI), by name."""
        return dict(zip([one.label for one in self.free], self.model.values(self.estimate.searched), strict=False))

    @cached_property
    def table(self) -> pd.DataFrame:
        """A table with one row for each free number, by its name.

        Columns: value, uncertainty (standard; infinite where the record does not determine it, NaN on a bound), low and high (95 %
        interval), all in SI; unit; start (starting value of the search); source of the interval: curvature, profile or samples.
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

    @property
    def determined(self) -> bool:
        """True if the record determines at least one of the numbers."""
        return bool(np.isfinite(self.certainty.widths).any()) or not self.estimate.finished

    @property
    def correlation(self) -> pd.DataFrame:
        """Correlations of the searched numbers, which are logarithms where numbers are positive; NaN if not determined."""
        labels = [one.label for one in self.free]
        return pd.DataFrame(self.certainty.correlation[: len(labels), : len(labels)], labels, labels)

    def best_of(self, part: int = 0) -> Problem:
        """Return the problem with the best numbers, under the loading of a part; 0 is the first."""
        return self._whole.at(self.estimate.searched, part)

    @property
    def best(self) -> Problem:
        """The problem with the best numbers, under the loading of the (first part of the) record."""
        return self.best_of(0)

    @cached_property
    def _whole(self) -> Model:
        """The model including the parts left out of the fit; the numbers of those parts are read off the record."""
        return self.model.with_(parts=self.parts)

    @cached_property
    def runs(self) -> tuple[Solution, ...]:
        """The best run of each part, including those left out. Raises InputError if one fails, as after a bad prediction."""
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
        fitted (False for samples left out).
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
        """Return the root mean square residual of the samples fitted, or left out, in units of the given noise by quantity (SI)."""
        table = self.curves[(self.curves.fitted == fitted) & self.curves.residual.notna()]
        if table.empty:
            return math.nan
        scaled = table.residual.to_numpy() / np.array([sizes[name] for name in table.quantity])
        return float(np.sqrt(np.mean(scaled**2)))

    @cached_property
    def prediction(self) -> float | None:
        """Root mean square error of the prediction of samples left out, in standard deviations of the noise; None without them."""
        error = self.errors(self.model.sizes, fitted=False)
        return None if math.isnan(error) else error

    @property
    def bic(self) -> float:
        """Schwarz's criterion: among inferences from one record, the smallest fits best for its number of free numbers."""
        n, total = self.model.samples, 0.0
        for name, size in self.model.sizes.items():
            count = sum(len(b.time) for i in range(len(self.model.parts)) for q, b in self.model.blocks(i) if q == name)
            total += 2.0 * count * math.log(size)
        return total + self.estimate.cost(self.estimate.searched) + len(self.free) * math.log(n)

    @cached_property
    def looks(self) -> dict[str, list[ResidualLook]]:
        """What is left of each fitted quantity looks like, by its name: kinds, shares and sizes, an empty list for noise.

        Beside a look the free numbers may still move, as it tells what the fit lacks.
        """
        if self.model.of_means:
            return {}
        found, slopes = {}, self.certainty.slopes
        residual = np.zeros(self.model.samples)
        for name, _, by, weight, _ in pieces_of(self.model, residual, slopes if len(slopes) else residual[:, None]):
            seen = by / weight[:, None] if len(slopes) else None
            found[name] = looks_of(self.model, self.estimate.searched, name, seen)
        return found

    @cached_property
    def features(self) -> pd.DataFrame | None:
        """Features of slip events of the best run beside their means in the record; None if samples were fitted.

        Columns: part, feature, mean and its standard error, run, unit, and missed (True where the run misses the mean).
        """
        return self.model.compared(self.estimate.searched) if isinstance(self.model, FeatureModel) else None

    @property
    def fit(self) -> pd.DataFrame:
        """The residuals of each fitted quantity: samples, noise (standard deviation, SI), memory (s), and rms of the residual."""
        table, rows = self.curves[self.curves.fitted], {}
        for name, size in self.model.sizes.items():
            rest = table.residual[table.quantity == name].dropna().to_numpy()
            unit = self.model.problem.unit_of(name)
            rows[name] = (len(rest), size, self.model.memory.get(name, WHITE).time, float(np.sqrt(np.mean(rest**2))), unit)
        return pd.DataFrame.from_dict(rows, orient="index", columns=["samples", "noise", "memory", "rms", "unit"])
