"""What a fit asks of uniform bodies with waves: a slab shows its thickness, wave speed and density."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from stickslip.extensions.inference.fit.part import Part, StickSlip
from stickslip.extensions.inference.fit.with_waves import FittedWaves
from stickslip.problem import Problem
from stickslip.problem.bodies import ElasticSlab


class _FittedUniform(FittedWaves):
    def shown(self, problem: Problem, part: Part, cycles: StickSlip, names: set[str]) -> Iterator[tuple[str, float]]:
        """Yield thickness, wave speed or density of a slab: slip lasts for a round trip, and G/h is the rise between events."""
        body: Any = problem.body
        if not isinstance(body, ElasticSlab):
            return
        thickness, speed = float(np.sum(body.thickness)), float(np.mean(body.wave_speed))
        if np.ndim(body.thickness) or np.ndim(body.wave_speed):
            return
        lasts = math.isfinite(cycles.duration)
        if "body.thickness" in names:
            thickness = 0.5 * speed * cycles.duration if lasts else body.density * speed**2 / cycles.rise
            yield "body.thickness", thickness
        elif "body.wave_speed" in names:
            speed = 2.0 * thickness / cycles.duration if lasts else math.sqrt(cycles.rise * thickness / body.density)
            yield "body.wave_speed", speed
        if "body.density" in names and (lasts or not {"body.thickness", "body.wave_speed"} & names):
            yield "body.density", cycles.rise * thickness / speed**2


ANSWERS = _FittedUniform()
