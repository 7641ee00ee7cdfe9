"""Do several pulses survive in 2D and 3D? Faults of finite length in the paper's slab, and what their middle sees.

The paper closes on this question. In its slab under the slip law (reconstructed) the friction falls within 20 m of a front, so
that no grid over a plane of 10 km resolves it. `pulsing` is a family of slip laws whose pulses come in 1D at the times of the
paper's, but fall within longer distances: the load exceeds the largest friction by a larger share of the amplitude.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.bodies import as_slab
from stickslip.observables.planar import pulses
from stickslip.paper.cases import problem, typed
from stickslip.planar.slab import PROCESS_ZONE
from stickslip.problem.problem import Problem
from stickslip.solution.planar import PlanarSolution

PAPERS_EXCESS = 3430.0 / 0.5e8
"""The excess of the paper's slab (reconstructed) as a share of the amplitude of its friction: u0 = u_c + 1 mm."""
LARGE = 0.1
"""An excess under which a plane is resolved: the friction falls within a tenth of the thickness."""
LEAST_RATE = 0.1
"""Slip rate (m/s) below which a maximum counts as no pulse; the pulses in 1D reach 10 m/s."""
STORED = Path(__file__).with_name("planar-pulses.csv")
"""The study of faults of different length, made by docs/planar_pulses.py."""
FIRST_PULSE = 0.1539862
"""Time of the first pulse in 1D, s."""


def pulsing(excess: float = PAPERS_EXCESS) -> Problem:
    """Return the paper's slab under a slip law whose pulses in 1D come as those of the reconstructed slab, without pull.

    Parameters
    ----------
    excess
        Load minus the largest friction, as a share of the amplitude of friction.

    Notes
    -----
    Under a constant load, the phase p = omega u - pi/2 obeys Z dp/dt = omega a S (excess + 1 - cos p), so that
    tan(p/2) = sqrt(excess / (2 + excess)) tan(pi t / P) with the period P = 2 pi Z / (omega a S sqrt(excess (2 + excess))).
    """
    paper = problem("fig5-slab-reconstructed")
    slab, law = as_slab(paper.body), typed(paper.friction, ss.friction.SinusoidalSlip)
    amplitude, root = law.amplitude * slab.normal_stress, math.sqrt(excess * (2.0 + excess))
    period = 2.0 * math.pi * slab.impedance / (law.wavenumber * amplitude * math.sqrt(PAPERS_EXCESS * (2.0 + PAPERS_EXCESS)))
    wavenumber = 2.0 * math.pi * slab.impedance / (amplitude * root * period)
    phase = 2.0 * math.atan(math.sqrt(excess / (2.0 + excess)) * math.tan(math.pi * (0.5 - FIRST_PULSE / period)))
    return ss.Problem(
        slab,
        ss.friction.SinusoidalSlip(mean=law.mean, amplitude=law.amplitude, wavenumber=wavenumber),
        initial_slip=(0.5 * math.pi + phase) / wavenumber,
        initial_load=law.mean * slab.normal_stress + (1.0 + excess) * amplitude,
    )


def weakening(excess: float) -> Problem:
    """Return the same slab under linear slip weakening, with the range and the steepest fall of friction of `pulsing(excess)`."""
    like = pulsing(excess)
    law = typed(like.friction, ss.friction.SinusoidalSlip)
    static, dynamic = law.mean + law.amplitude, law.mean - law.amplitude
    same = ss.friction.LinearSlipWeakening(static=static, dynamic=dynamic, distance=2.0 / law.wavenumber)
    return ss.Problem(like.body, same, initial_load=like.load)


def problem_of(law: str, excess: float) -> Problem:
    """Return the problem for a law, "slip" or "weakening"; an excess of 0 stands for that of the paper's slab."""
    return {"slip": pulsing, "weakening": weakening}[law](excess or PAPERS_EXCESS)


def process_zone(like: Problem) -> float:
    """Return the length of the process zone of a slow front (m) for a problem of `pulsing` or `weakening`."""
    slab = as_slab(like.body)
    slip = like.law_slip + np.linspace(0.0, 20.0, 200_001)
    steepest = -float(np.min(np.diff(like.friction.coefficient(slip)))) / 1e-4 * slab.normal_stress
    return PROCESS_ZONE * slab.shear_modulus / steepest


@dataclass(frozen=True)
class Fault:
    """A fault of finite length, locked outside, on which everything is loaded alike: a "line" (2D), "disc" or "square" (3D).

    `ratio` is its length, or its diameter or side, over the thickness of the slab. It is alone, or with `replicas` repeated at 1.25
    of its length, and has `per_zone` nodes in a process zone.
    """

    problem: Problem
    ratio: float
    shape: str = "line"
    per_zone: float = 8.0
    replicas: bool = False

    @property
    def length(self) -> float:
        """Its length, diameter or side, m."""
        return self.ratio * as_slab(self.problem.body).thickness

    @property
    def slab(self) -> ss.PlanarSlab:
        """The contact on a grid."""
        length = self.length
        count = 2 * math.ceil(max(0.5 * 1.25 * length * self.per_zone / process_zone(self.problem), 4.0))

        def outside(y: NDArray[np.float64], z: NDArray[np.float64] | float = 0.0) -> NDArray[np.bool_]:
            away = np.hypot(y, z) if self.shape == "disc" else np.maximum(np.abs(y), np.abs(z))
            return np.asarray(away > 0.5 * length)

        extent: dict[str, Any] = {"width": 1.25 * length, "width_nodes": count} if self.shape != "line" else {}
        return ss.PlanarSlab(self.problem, count, 1.25 * length, barrier=outside, replicas=self.replicas, **extent)


def middle_rate(run: PlanarSolution) -> NDArray[np.float64]:
    """Return the slip rate of the node in the middle at all frames (m/s)."""
    return np.asarray(run.middle_line(run.slip_rate)[:, run.slab.shape[0] // 2])


def pulses_of(rate: NDArray[np.float64]) -> Any:
    """Return the number of pulses in slip rates (m/s), time first, that are maxima above LEAST_RATE."""
    counted = pulses(rate.reshape(len(rate), -1), LEAST_RATE)
    return counted if rate.ndim > 1 else int(counted[0])


def peaks(times: NDArray[np.float64], rate: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the times (s) of the pulses in a slip rate (m/s): of maxima above LEAST_RATE between minima below half of them."""
    from scipy.signal import find_peaks, peak_prominences  # here, because it takes half a second to import

    size = np.pad(np.abs(rate), 1)
    found, _ = find_peaks(size, height=LEAST_RATE)
    deep = peak_prominences(size, found)[0] >= 0.5 * size[found]
    return np.asarray(times[found[deep] - 1], float)
