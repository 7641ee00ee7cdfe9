"""The result of `identify`: numbers with standard errors and correlations, the law, and friction of the model beside the record."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from stickslip.extensions.given_motion.friction_model import FrictionModel
from stickslip.extensions.given_motion.law_numbers import with_numbers
from stickslip.foundation.arguments import CheckedArguments
from stickslip.foundation.arrays import Floats
from stickslip.foundation.atomic_write import write_atomically, write_table
from stickslip.foundation.show import brief, with_uncertainty
from stickslip.friction import FrictionLaw

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from stickslip.extensions.given_motion.moved import MovedContact
    from stickslip.foundation.place import Place

HALF_OF_95 = 1.959963984540054
"""An interval of 95 % reaches so many standard errors to each side."""
NEARLY_ONE = 0.98
"""A correlation beyond this is said."""
SHIFTED = 0.5
"""A shift by noise of the motion that exceeds this share of the standard error is said."""
REMEMBERED = 2.0
"""A factor of the variance, by the memory of residuals, that is said."""


@dataclass(frozen=True, eq=False, repr=False)
class Identification(CheckedArguments):
    """The numbers of a friction law that follow from friction along measured motion."""

    model: FrictionModel
    searched: Floats
    covariance: Floats
    shift: Floats
    sensor: float
    """The standard deviation of the noise of measured friction, in the unit of the record."""
    memory: float
    determined: bool
    on_bound: Floats
    rate_note: str

    @cached_property
    def values(self) -> dict[str, float]:
        """The numbers by name, in SI."""
        return self.model.values(self.searched)

    @property
    def law(self) -> FrictionLaw:
        """The law with the numbers that were found."""
        return with_numbers(self.model.law, {name: one for name, one in self.values.items() if name.startswith("friction.")})

    @property
    def moved(self) -> MovedContact:
        """The contact with that law along the measured motion, for `stickslip.simulate`."""
        return self.model.moved(self.values)

    @cached_property
    def deviations(self) -> dict[str, float]:
        """The standard errors by name, in SI; of a number that is searched by its logarithm to first order."""
        sizes = np.sqrt(np.diag(self.covariance))
        factors = [
            self.values[one.name] if self.model.by_log(one) else s
            for one, s in zip(self.model.free, self.model.scales, strict=True)
        ]
        return {one.name: float(abs(f) * size) for one, f, size in zip(self.model.free, factors, sizes, strict=True)}

    @cached_property
    def table(self) -> pd.DataFrame:
        """One row for each number: value, standard error, interval of 95 %, and unit."""
        import pandas as pd

        rows = {}
        for i, one in enumerate(self.model.free):
            value, error = self.values[one.name], self.deviations[one.name]
            half = HALF_OF_95 * float(np.sqrt(self.covariance[i, i]))
            if self.model.by_log(one) and half < 1.0:
                low, high = value * np.exp(-half), value * np.exp(half)
            else:
                low, high = value - HALF_OF_95 * error, value + HALF_OF_95 * error
            low = low if one.least is None else max(low, one.least)
            rows[one.name] = (value, error, float(low), float(high), one.unit or "1")
        return pd.DataFrame.from_dict(rows, orient="index", columns=["value", "deviation", "low", "high", "unit"]).rename_axis(
            "number"
        )

    @property
    def correlation(self) -> pd.DataFrame:
        """Correlations of the errors of the numbers, or of their logarithms where these are searched."""
        import pandas as pd

        size = np.sqrt(np.diag(self.covariance))
        names = [one.name for one in self.model.free]
        return pd.DataFrame(self.covariance / np.outer(size, size), names, names)

    @cached_property
    def friction(self) -> Floats:
        """Friction of the model at the samples, in the unit of the record; NaN at rest under a law that sticks."""
        return self.model.friction(self.searched)

    @property
    def notes(self) -> list[str]:
        """What to read before using the numbers, one sentence each."""
        found = [self.rate_note]
        if not self.determined:
            found.append("the record does not determine all of these numbers: leave one out, or measure more kinds of motion")
        size = np.sqrt(np.diag(self.covariance))
        for one, shift, error, at_end in zip(self.model.free, self.shift, size, self.on_bound, strict=True):
            if at_end:
                found.append(f"{one.name} is on a bound of the search: its error is not known")
            if abs(shift) > SHIFTED * error:
                found.append(
                    f"noise of the motion shifts {one.name} by {abs(shift) / error:.2g} standard errors, which are taken off"
                )
        table = self.correlation.to_numpy()
        for i in range(len(table)):
            for j in range(i):
                if abs(table[i, j]) > NEARLY_ONE:
                    names = f"{self.model.free[j].name} and {self.model.free[i].name}"
                    found.append(f"{names} are hardly told apart: their correlation is {table[i, j]:.3f}")
        if self.memory > REMEMBERED:
            found.append(
                f"residuals resemble their neighbours: standard errors are {np.sqrt(self.memory):.2g} times those of white noise,"
                " and the law may miss something"
            )
        rests = int(np.isnan(self.friction).sum())
        if rests:
            found.append(f"{rests} samples at rest, where this law leaves friction open, are left out")
        return found

    @property
    def headline(self) -> str:
        """One line: how many numbers from how many samples, and the noise that remains."""
        many, noise = len(self.model.free), brief(self.sensor, self.model.record.unit or "1", 3)
        what = f"{many} number{'s' * (many != 1)} of {type(self.model.law).__name__}"
        return f"{what} from {len(self.friction)} samples, noise of friction: {noise}"

    def __str__(self) -> str:
        width = max(len(one.name) for one in self.model.free)
        lines = [self.headline]
        for one in self.model.free:
            unit = "" if one.unit in ("", "1") else f" {one.unit}"
            row = self.table.loc[one.name]
            value = with_uncertainty(self.values[one.name], self.deviations[one.name])
            lines.append(f"{one.name:<{width}}  {value}{unit}  ({row.low:.6g} to {row.high:.6g})")
        return "\n".join([*lines, *self.notes])

    __repr__ = __str__

    def plot(self, **place: Unpack[Place]) -> Figure:
        """Draw friction of record and model against time and against the slip rate, and what is left."""
        from stickslip.extensions.given_motion.figures.identified import draw_identified

        return draw_identified(self, **place)

    def to_csv(self, path: str | Path) -> Path:
        """Write the table of numbers as CSV, after the notes as comment lines (#), and return the path."""
        return write_table(Path(path), self.table.reset_index(), [self.headline, *self.notes])

    def to_json(self, path: str | Path) -> Path:
        """Write numbers, correlations and notes as JSON, and return the path."""
        found: dict[str, Any] = {
            "headline": self.headline,
            "law": type(self.model.law).__name__,
            "record": self.model.record.name,
            "numbers": self.table.to_dict("index"),
            "correlation": self.correlation.to_dict(),
            "noise_of_friction": {"value": self.sensor, "unit": self.model.record.unit or "1"},
            "notes": self.notes,
        }
        text = json.dumps(found, indent=2) + "\n"
        return write_atomically(Path(path), lambda draft: draft.write_text(text, encoding="utf-8"))
