"""Are several pulses retained in 2D and 3D? The question on which the paper closes: what the middle of a finite fault sees.

In the paper's slab under the slip law (reconstructed) friction falls within 20 m of a front, so that no grid over a plane of 10 km
resolves it. `pulsing` is a family of slip laws whose pulses come in 1D at the times of the paper's, but whose friction falls within
longer distances, because the load exceeds the largest friction by a larger share of the amplitude.
"""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from stickslip.extension import is_there
from stickslip.extensions.paper.cases import Runs, problem, typed
from stickslip.figures.sheet import sheet
from stickslip.figures.style import BLUE, GREEN, GREY, INK, VERMILLION, quantity, styled
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.problem.bodies import as_slab

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from stickslip.extensions.planar import PlanarSolution

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
    from stickslip.extensions.planar import length_of_process_zone

    slab = as_slab(like.body)
    slip = like.law_slip + np.linspace(0.0, 20.0, 200_001)
    steepest = -float(np.min(np.diff(like.friction.coefficient(slip)))) / 1e-4 * slab.normal_stress
    return length_of_process_zone(slab.shear_modulus, steepest)


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


def middle_rate(run: PlanarSolution) -> Floats:
    """Return the slip rate of the node in the middle at all frames (m/s)."""
    return np.asarray(run.middle_line(run.slip_rate)[:, run.slab.shape[0] // 2])


def pulses_of(rate: Floats) -> Any:
    """Return the number of pulses in slip rates (m/s), time first, that are maxima above LEAST_RATE."""
    from stickslip.extensions.planar import count_pulses

    counted = count_pulses(rate.reshape(len(rate), -1), LEAST_RATE)
    return counted if rate.ndim > 1 else int(counted[0])


def peaks(times: Floats, rate: Floats) -> Floats:
    """Return the times (s) of the pulses in a slip rate (m/s): of maxima above LEAST_RATE between minima below half of them."""
    from scipy.signal import find_peaks, peak_prominences  # here, because it takes half a second to import

    size = np.pad(np.abs(rate), 1)
    found, _ = find_peaks(size, height=LEAST_RATE)
    deep = peak_prominences(size, found)[0] >= 0.5 * size[found]
    return np.asarray(times[found[deep] - 1], float)


# ---- the chapter of the report -------------------------------------------------------------------------------------------------

ANSWER = (
    "Yes, where slip begins at once on a fault that is long enough: before the echo of the driver returns at 2h/c, the middle"
    " of a fault of length L sees the pulses that the slab has in 1D until waves from the ends of the fault arrive, at L/(2c),"
    " and soon after it rests: in 2D and, on discs and squares, in 3D alike.",
    "Two pulses need a fault longer than 1.6 h, and three pulses one longer than 3.1 h: 16 and 31 km with the paper's numbers.",
    "The arrest at 2h/c is final only in 1D: after the echo the middle of every fault with L = 2 h or more slipped again, and"
    " that of some shorter ones, in one to four pulses until 4h/c, in 2D and in 3D.",
)
"""The answer to the paper's question in three sentences."""
BASIS = (
    "It rests on stored runs of faults that are loaded alike everywhere and locked beyond their ends, under slip laws of the"
    " paper's form. With the paper's own constants friction falls within 20 m of a front, which no grid of 10 km resolves in 3D;"
    " so the load exceeds the largest friction by 10 % of its amplitude (by 1 % in 2D, and by 30 % in both, too), and the"
    " wavenumber is such that the pulses of 1D come at the times of the paper's. Two grids agree in every number of pulses"
    " before the echo, and in their times to 0.03 s. The paper's own constants, in 2D on faults that repeat at 1.25 L, give the"
    " same numbers before the echo. Linear slip weakening, which has one pulse in 1D, has one before the echo on faults of every"
    " length, and further ones after it. The length that counts is that over which slip begins at once: where it travels out of"
    " a nucleus of 0.8 h along a fault of 4 h, in 2D, every node sees one pulse until 4h/c, and the middle of a nucleus of 2 h"
    " sees two before the echo. Friction that varies along the fault was not studied."
)
"""What the answer rests on."""


def stored() -> list[dict[str, str]]:
    """Return the rows of the stored study."""
    with STORED.open(newline="") as file:
        return list(csv.DictReader(file))


def curve_of(shape: str) -> Floats:
    """Return the stored times (s) and slip rates (m/s) in the middle of a fault with L = 2 h: "line" or "disc"."""
    return np.loadtxt(STORED.with_name(f"planar-middle-{shape}.csv"), delimiter=",", skiprows=1).T


def curve_in_2d() -> tuple[Floats, str]:
    """Return time and slip rate in the middle of a line with L = 2 h, and where they are from: computed now, if JAX is there."""
    if not is_there("planar"):
        return curve_of("line"), "stored: the extension 'planar', which computes it, is not installed"
    fault = Fault(pulsing(LARGE), 2.0)
    try:
        run = ss.simulate(fault.slab, 2.0 * fault.problem.round_trip_time, frames=500)
    except ss.InputError:
        return curve_of("line"), "stored: the library JAX is missing (pip install 'stickslip[planar]')"
    return np.stack([run.times, middle_rate(run)]), "computed with this report"


def table() -> list[dict[str, str]]:
    """Return the stored rows on faults that are alone, under the slip law, in words for readers.

    Of each fault this is the run with the most nodes among those that go on for the longest.
    """
    kinds = {"line": "2D", "disc": "3D, disc", "square": "3D, square"}
    best: dict[tuple[int, float], dict[str, str]] = {}
    for row in sorted(stored(), key=lambda row: (min(float(row["round trips"]), 2.0), float(row["nodes per process zone"]))):
        if (row["law"], float(row["excess"]), row["replicas"]) == ("slip", LARGE, "alone"):
            best[list(kinds).index(row["shape"]), float(row["L/h"])] = row
    trip = problem("fig5-slab-reconstructed").round_trip_time
    found = []
    for (_, ratio), row in sorted(best.items()):
        times = np.array(row["peaks [s]"].split(), float)
        times = times[times < 2.0 * trip]
        long_enough = float(row["round trips"]) >= 2.0
        found.append(
            {
                "fault": kinds[row["shape"]],
                "L/h": f"{ratio:g}",
                "L/(2c)": f"{float(row['ends arrive [s]']):.2f} s",
                "pulses in 1D until L/(2c)": row["pulses in 1D until ends arrive"],
                "in the middle until 2h/c": row["pulses before echo"],
                "from 2h/c to 4h/c": str(int(np.sum(times >= trip))) if long_enough else "not run",
                "times of the pulses": ", ".join(f"{time:.2f}" for time in times) + " s",
                "nodes": row["nodes"].replace("x", " × "),
                "commit": row["commit"],
            }
        )
    return found


def planes_data(runs: Runs) -> xr.Dataset:
    """Return what the figure shows: pulses against L/h, and slip rates in the middle for L = 2 h."""
    import xarray as xr

    like = pulsing(LARGE)
    trip = like.round_trip_time
    one, (two, origin) = runs(like, 2.0 * trip), curve_in_2d()
    grid = np.linspace(0.0, 2.0 * trip, 4001)
    curves = {"1D": np.stack([grid, one.slip_rate(grid)]), "2D": two, "3D": curve_of("disc")}
    contents: dict[str, Any] = {}
    for name, (times, rate) in curves.items():
        contents[f"time_{name}"] = quantity(f"time_{name}", times, "time", "t", "s")
        contents[f"rate_{name}"] = quantity(f"time_{name}", rate, f"slip rate in the middle, {name}", "v", "m s-1")
    for shape, rows in groupby(table(), key=lambda row: row["fault"]):
        key, chosen = shape.replace(", ", "_"), list(rows)
        before = np.array([row["in the middle until 2h/c"] for row in chosen], float)
        after = np.array([row["from 2h/c to 4h/c"].replace("not run", "nan") for row in chosen], float)
        length = np.array([row["L/h"] for row in chosen], float)
        contents[f"length_{key}"] = quantity(f"length_{key}", length, "length of the fault", "L/h", "1")
        contents[f"before_{key}"] = quantity(f"length_{key}", before, f"pulses before 2h/c, {shape}", "n", "1")
        contents[f"all_{key}"] = quantity(f"length_{key}", before + after, f"pulses before 4h/c, {shape}", "n", "1")
    limits = 2.0 * peaks(grid, one.slip_rate(grid)) / trip * 2.0
    contents["needed"] = quantity("pulse", limits, "length of a fault from which on the ends leave time for a pulse", "L/h", "1")
    return xr.Dataset(contents, attrs={"round_trip": trip, "curve_2D": origin})


@styled
def draw_planes(dataset: xr.Dataset) -> Figure:
    """Draw pulses against the length of the fault, and slip rates in the middle against time in 1D, 2D and 3D."""
    figure = sheet((7.2, 4.2))
    axes: Any = figure.subplot_mosaic("ABB;ACC;ADD", width_ratios=(1.0, 0.6, 0.6))
    left, needed, trip = axes["A"], dataset.needed.values, dataset.attrs["round_trip"]
    left.step([0.1, *needed, 5.0], [0, *range(1, len(needed) + 1), len(needed)], where="post", color=GREY, label="1D until L/(2c)")
    marks = (("2D", "o", BLUE, 0.97), ("3D_disc", "s", VERMILLION, 1.03), ("3D_square", "D", GREEN, 1.07))
    for name, mark, colour, moved in marks:
        if f"length_{name}" in dataset:
            length, text = dataset[f"length_{name}"] * moved, name.replace("_", ", ")
            left.plot(length, dataset[f"before_{name}"], mark, color=colour, markersize=5, label=f"{text}, until 2h/c")
            left.plot(
                length, dataset[f"all_{name}"], mark, color=colour, markersize=5, fillstyle="none", label=f"{text}, until 4h/c"
            )
    left.set(xscale="log", xlabel="length of the fault $L/h$", ylabel="pulses in the middle", xlim=(0.2, 5.0))
    left.set_xticks([0.25, 0.5, 1.0, 2.0, 4.0], ["1/4", "1/2", "1", "2", "4"], minor=False)
    left.minorticks_off()
    left.set_ylim(0.0, None)
    left.legend(fontsize=7)
    for panel, name, colour in zip((axes[key] for key in "BCD"), ("1D", "2D", "3D"), (INK, BLUE, VERMILLION), strict=True):
        panel.plot(dataset[f"time_{name}"], dataset[f"rate_{name}"], color=colour)
        panel.set(ylabel=f"{name}\n(m/s)", xlim=(0.0, 2.0 * trip))
        panel.tick_params(labelbottom=name == "3D")
        panel.axvline(trip, color=GREY, linewidth=0.8, linestyle="--")
        if name != "1D":
            panel.axvline(0.5 * trip, color=GREY, linewidth=0.8, linestyle=":")
    axes["B"].text(trip, 0.9, " $2h/c$", transform=axes["B"].get_xaxis_transform(), va="top")
    axes["C"].text(0.5 * trip, 0.9, " $L/(2c)$", transform=axes["C"].get_xaxis_transform(), va="top")
    axes["B"].set_title("slip rate in the middle, $L = 2h$")
    axes["D"].set_xlabel("time $t$ (s)")
    return figure
