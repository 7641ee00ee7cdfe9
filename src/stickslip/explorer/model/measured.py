"""A laboratory record behind a run: its samples in the quantities that the panels draw, and how far the run is from them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from stickslip.explorer.model.answer import KeyNumber
from stickslip.explorer.model.words import short
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem.problem import Problem
from stickslip.solution.solution import Solution
from stickslip.studies.inference.model import OF_NO_ZERO, measured
from stickslip.studies.inference.record import SHEAR, UNITS, Record
from stickslip.studies.inference.resample import resampled
from stickslip.studies.inference.setup import SENSORS

MOST_SAMPLES = 20_000
"""Number of samples above which means of them are drawn and compared."""
DRAWN_AS = {"friction": "traction", "shear_stress": "traction", "shear_force": "traction", "slip": "slip", "slip_rate": "slip_rate"}
"""The curve of a motion behind which a measured quantity is drawn."""


@dataclass(frozen=True)
class Measured:
    """Samples of a record (SI) against the time of a run, and the misfit of each measured quantity.

    `curves` are slip, slip_rate and traction (Pa, for a block N) as far as they were measured.
    """

    time: Floats
    curves: Mapping[str, Floats]
    misfits: tuple[KeyNumber, ...]
    name: str

    @property
    def sentence(self) -> str:
        """How far the run is from the record."""
        texts = [f"{one.name.removeprefix('misfit of ')} {short(one.value, one.unit)}" for one in self.misfits]
        return f"It differs from {self.name} by {', '.join(texts)} (root mean square)."


@dataclass(frozen=True)
class Backdrop:
    """A record that is drawn behind all runs, and where its shear was measured: at the contact, or behind the spring of a block."""

    record: Record
    sensor: str = "contact"

    @classmethod
    def of(cls, record: Record, sensor: str, problem: Problem) -> Backdrop:
        """Return the backdrop of a problem. Raises InputError if nothing of the record can be drawn behind its runs."""
        if sensor not in SENSORS:
            raise InputError(f"explore: sensor {ascii(sensor)[:40]} is unknown; {nearest(sensor, SENSORS)}")
        found = cls(resampled(record, MOST_SAMPLES)[0], sensor)
        if not found._names(problem):
            shear = "shear_stress" if problem.body.has_waves else "shear_force"
            raise InputError(
                f"{record.name}: nothing to draw behind a {problem.body.kind}; allowed: friction, {shear}, slip and slip_rate"
            )
        return found

    def _names(self, problem: Problem) -> list[str]:
        """Return the names of the quantities that are drawn, at most one of shear."""
        other = "shear_force" if problem.body.has_waves else "shear_stress"
        names = [name for name in self.record.measured if name != other]
        shear = [name for name in SHEAR if name in names]
        return [name for name in names if name not in shear[1:]]

    def behind(self, run: Solution) -> Measured:
        """Return the samples behind a run, as long as it lasts."""
        inside = self.record.clock <= run.history.span[1]
        time, curves, misfits = self.record.clock[inside], dict[str, Floats](), list[KeyNumber]()
        for name in self._names(run.problem):
            data = self.record.measured[name][inside]
            model = measured(run, name, self.sensor, time)
            known = np.isfinite(data)
            zero = float(np.mean((data - model)[known])) if name in OF_NO_ZERO and known.any() else 0.0
            away = (data - zero - model)[known]
            size = float(np.sqrt(np.mean(away**2))) if known.any() else float("nan")
            misfits.append(KeyNumber(f"misfit of {name.replace('_', ' ')}", size, UNITS[name]))
            shift = run.problem.initial_slip - zero if name == "slip" else 0.0
            curves[DRAWN_AS[name]] = data * (run.problem.normal if name == "friction" else 1.0) + shift
        return Measured(time, curves, tuple(misfits), self.record.name)
