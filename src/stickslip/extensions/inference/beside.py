"""Put a record beside a run: samples, what a run would have measured there, and how far the two are apart."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from stickslip.extensions.inference.fit.model import OF_NO_ZERO, measured
from stickslip.extensions.inference.fit.setup import SENSORS
from stickslip.extensions.inference.record.record import SHEAR, SHEAR_IN, Record, is_of
from stickslip.extensions.inference.record.resample import resampled
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError, nearest
from stickslip.problem import Problem
from stickslip.solution import Solution

MOST_SAMPLES = 20_000
"""Of more samples than this, means are compared."""
DRAWN_AS = dict.fromkeys(SHEAR, "traction") | {"slip": "slip", "slip_rate": "slip_rate"}
"""Each quantity that is measured at the contact is shown beside this curve of a motion."""


class BesideRun(NamedTuple):
    """Samples of a record (SI) against the time of a run (s).

    `curves` are slip, slip_rate and traction (Pa, N or N m) as far as they were measured; `residuals` what is measured minus the
    run, without the zero of a sensor. `misfits` has the root mean square of each measured quantity, with its unit.
    """

    time: Floats
    curves: Mapping[str, Floats]
    residuals: Mapping[str, Floats]
    misfits: Mapping[str, tuple[float, str]]
    name: str


@dataclass(frozen=True)
class RecordBeside:
    """A record that is put beside runs, and where its shear was measured: at the contact, or behind the spring of a block."""

    record: Record
    sensor: str = "contact"

    @classmethod
    def of(cls, record: Record, sensor: str, problem: Problem, who: str) -> RecordBeside:
        """Return the record for runs of a problem. Raises InputError, which begins with `who`, if nothing of it can be compared."""
        if sensor not in SENSORS:
            raise InputError(f"{who}: sensor {ascii(sensor)[:40]} is unknown; {nearest(sensor, SENSORS)}")
        found = cls(resampled(record, MOST_SAMPLES)[0], sensor)
        if not found._names(problem):
            shear = SHEAR_IN[problem.load_unit]
            raise InputError(
                f"{record.name}: nothing to draw behind a {problem.body.kind}; allowed: friction, {shear}, slip and slip_rate"
            )
        return found

    def _names(self, problem: Problem) -> list[str]:
        """Return the names of the quantities that are drawn, at most one of shear."""
        moves = self.record.slips_in in ("", problem.unit_of("slip"))
        here = [name for name in self.record.measured if name in DRAWN_AS]
        names = [name for name in here if is_of(name, problem) and (moves or name in SHEAR)]
        shear = [name for name in SHEAR if name in names]
        return [name for name in names if name not in shear[1:]]

    def beside(self, run: Solution) -> BesideRun:
        """Return the samples beside a run, as long as it lasts."""
        inside = self.record.clock <= run.history.span[1]
        time, misfits = self.record.clock[inside], dict[str, tuple[float, str]]()
        curves, residuals = dict[str, Floats](), dict[str, Floats]()
        for name in self._names(run.problem):
            data = self.record.measured[name][inside]
            model = measured(run, name, self.sensor, time)
            known = np.isfinite(data)
            zero = float(np.mean((data - model)[known])) if name in OF_NO_ZERO and known.any() else 0.0
            away = (data - zero - model)[known]
            size = float(np.sqrt(np.mean(away**2))) if known.any() else float("nan")
            misfits[name] = size, run.problem.unit_of(name)
            shift = run.problem.initial_slip - zero if name == "slip" else 0.0
            scale = run.problem.normal if name == "friction" else 1.0
            curves[DRAWN_AS[name]] = data * scale + shift
            residuals[DRAWN_AS[name]] = (data - zero - model) * scale
        return BesideRun(time, curves, residuals, misfits, self.record.name)
