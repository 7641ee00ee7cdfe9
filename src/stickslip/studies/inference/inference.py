"""The result of `infer`: numbers with intervals, the best problem, and what is and is not known."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from stickslip.foundation.arguments import check_whole
from stickslip.foundation.atomic_write import write_atomically, write_table
from stickslip.foundation.errors import InputError
from stickslip.foundation.netcdf_file import write
from stickslip.foundation.show import brief, with_uncertainty
from stickslip.io.netcdf import origin
from stickslip.scenarios.scenario import Scenario
from stickslip.solution.accessors import report_of_study
from stickslip.studies.inference.fitted_record import FittedRecord
from stickslip.studies.inference.model import unit_of
from stickslip.studies.inference.sampling import MOST_SAMPLES, sample
from stickslip.studies.inference.search import SearchProgress
from stickslip.studies.inference.words import notes_of
from stickslip.studies.study import TextProgress, telling


def _near(value: float, uncertainty: float) -> str:
    size = abs(value) / uncertainty if 0.0 < uncertainty < math.inf else 1.0
    return f"{value:.{min(max(2 + math.ceil(math.log10(max(size, 1e-3))), 3), 12)}g}"


@dataclass(frozen=True, eq=False, repr=False)
class Inference(FittedRecord):
    """The result of `infer`: a `FittedRecord`, told in sentences, as a scenario, and in files."""

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
            told = SearchProgress(tell)
            found = replace(self.estimate, model=self.model.with_(ran=told.run))
            walk = sample(found, self.certainty, count, told, before=self.walk)
        return replace(self, walk=walk, estimate=replace(self.estimate, finished=not walk.stopped))

    @property
    def scenario(self) -> Scenario:
        """The scenario that runs to the curve of the (first part of the) record."""
        name = Path(self.parts[0].record.name).name
        title = f"Fitted to {name}" + (f", part 1 of {len(self.parts)}" if len(self.parts) > 1 else "")
        about = "\n".join([self.headline, *(f"{name} = {text}" for name, text, _ in self.rows), *self.notes])
        return Scenario(self.best, self.parts[0].duration, self.model.rtol, title, about, name="fitted")

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

    def to_toml(self, path: str | Path) -> Path:
        """Write the scenario that runs to the curve shown, with the loading as a list of steps, and return the path."""
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
