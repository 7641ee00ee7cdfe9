"""Converged series at stations of a fault in 2D, and the judgement of another program's series of them.

The fault is the bundled `planar-patch`: a nucleus, whose edges and whose barriers lie on nodes of every mesh, so that errors shrink
regularly, with order 1. Three meshes, each twice as fine as the one before, give two extrapolations to no distance between nodes.
Their difference is what the second may still be off; the band of a sample is the largest of its neighbourhood. Before that the
series are shifted in time so that their fronts arrive together, because otherwise a sample has a front before it in one mesh and
behind it in the other.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import stickslip
from stickslip.extension import is_there
from stickslip.extensions.schemes.benchmark_kinds import ConvergedBenchmark
from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.converged import SeriesWithinBand
from stickslip.extensions.schemes.judging import check_tolerance
from stickslip.foundation.arrays import Floats
from stickslip.problem.scenarios import Scenario, load_scenario
from stickslip.run import TextProgress
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

FAULT = "planar-patch"
"""The bundled scenario."""
STATIONS = {"0km": 0.0, "8km": 8e3, "16km": 16e3}
"""Stations along y (m): in the middle of the nucleus, off it, and close to a barrier."""
MESHES = (320, 640, 1280)
"""Nodes of the meshes: edges of the nucleus at 4 km and barriers at 18 km are nodes of all."""
FRAMES_OF_RUN = 640
"""Frames of each mesh in a two-way travel time, if it has so many steps."""
SAMPLES_OF_SERIES = 801
"""Samples of a series."""
NEIGHBOURS = 2
"""A band is the largest of a sample and of so many on both sides."""
ARRIVED = 0.01
"""A front has arrived after so much slip, and slip has come to rest when less than so much is left, m."""
UNITS = {"slip": "m", "slip_rate": "m s-1", "traction": "Pa"}
"""Units of the fields, in the order of their rows."""
KEY_TIMES = {"arrival": ("front arrival", "s"), "peak_rate": ("peak slip rate", "m s-1"), "arrest": ("arrest", "s")}
"""What is told of a station beside its series, with words and unit."""


class Station(NamedTuple):
    """Motion of a station under one mesh: times (s), and slip since the start (m), slip rate (m/s) and traction (Pa) in rows."""

    time: Floats
    fields: Floats

    @property
    def key(self) -> Floats:
        """What `KEY_TIMES` names; no number is there if slip stays below `ARRIVED`."""
        slip, rate = self.fields[0], self.fields[1]
        if not slip[-1] > 2.0 * ARRIVED:
            return np.array([math.nan, np.abs(rate).max(), math.nan])
        first, left = int(np.argmax(slip >= ARRIVED)), slip[-1] - slip
        last = len(slip) - 1 - int(np.argmax(left[::-1] >= ARRIVED))
        return np.array(
            [
                np.interp(ARRIVED, slip[max(first - 1, 0) : first + 1], self.time[max(first - 1, 0) : first + 1]),
                np.abs(rate).max(),
                np.interp(-ARRIVED, -left[last : last + 2], self.time[last : last + 2]),
            ]
        )

    def at(self, time: Floats, later: float) -> Floats:
        """Return the fields at times (s) after the motion has been put off by some time (s)."""
        moved = np.clip(time - later, 0.0, self.time[-1])
        return np.stack([np.interp(moved, self.time, one) for one in self.fields])


@cache
def on_mesh(nodes: int) -> tuple[Station, ...]:
    """Return the motion of the stations with a number of nodes."""
    run: Any = simulate(load_scenario(FAULT).with_values({"contact.nodes": nodes, "contact.frames": FRAMES_OF_RUN}))
    fields = np.stack([run.slip - run.slip[0], run.slip_rate, run.traction])
    return tuple(Station(run.times, fields[:, :, int(np.abs(run.slab.y - place).argmin())]) for place in STATIONS.values())


def converged(meshes: Sequence[Station]) -> xr.Dataset:
    """Return the series, and its band, to which three meshes of a station converge with order 1, each twice as fine as the last."""
    import xarray

    keys = [one.key for one in meshes]
    rough, right = 2.0 * keys[1] - keys[0], 2.0 * keys[2] - keys[1]
    time = np.linspace(0.0, float(meshes[-1].time[-1]), SAMPLES_OF_SERIES)
    coarse, middle, fine = (one.at(time, right[0] - key[0]) for one, key in zip(meshes, keys, strict=True))
    fields = 2.0 * fine - middle
    fields[1] = np.where(fine[1] == 0.0, 0.0, fields[1])
    off = np.abs(fields - (2.0 * middle - coarse)) + np.abs(np.gradient(fields, time, axis=1)) * abs(right[0] - rough[0])
    around = np.pad(off, ((0, 0), (NEIGHBOURS, NEIGHBOURS)), mode="edge")
    band = np.lib.stride_tricks.sliding_window_view(around, 2 * NEIGHBOURS + 1, axis=1).max(axis=-1)
    found: dict[str, Any] = {"time": ("sample", time, {"units": "s"})}
    for row, (name, unit) in enumerate(UNITS.items()):
        found[name] = ("sample", fields[row], {"units": unit})
        found[f"{name}_band"] = ("sample", band[row], {"units": unit})
    own = np.where(np.isnan(right), right, Station(time, fields).key)  # of the series itself, whose samples may miss a peak
    for n, (name, (words, unit)) in enumerate(KEY_TIMES.items()):
        found[name] = ((), own[n], {"units": unit, "long_name": words})
        found[f"{name}_band"] = ((), abs(right[n] - rough[n]) + abs(own[n] - right[n]), {"units": unit})
    order = np.log2(np.abs(middle[0] - coarse[0]).mean() / np.abs(fine[0] - middle[0]).mean())
    return xarray.Dataset(found, attrs={"order_of_slip": float(order)})


@dataclass(frozen=True)
class StationBenchmark(ConvergedBenchmark):
    """A station of the fault."""

    def judge(self, several: Sequence[Series], tolerance: float, progress: TextProgress | bool | None = None) -> StationSeries:
        """Compare series of another program with that of this station."""
        check_tolerance(tolerance)
        return StationSeries(self.series(), tuple(several), tolerance)


@dataclass(frozen=True, eq=False, repr=False)
class StationSeries(SeriesWithinBand):
    """Series of another program at a station of a fault, and when their fronts arrive, their peaks, and when they rest."""

    def _rows(self, one: Series) -> Iterator[dict[str, Any]]:
        yield from super()._rows(one)
        own = Station(one.time, np.stack([one.slip, one.rate, one.traction])).key
        for (name, (words, _)), value in zip(KEY_TIMES.items(), own.tolist(), strict=True):
            right, band = float(self.right[name]), float(self.right[f"{name}_band"])
            gap = abs(value - right) if math.isfinite(value) else math.inf
            beyond = max(gap - band, 0.0)
            yield {"series": one.name, "quantity": words, "distance": gap, "beyond": beyond, "share": beyond / abs(right)}

    def _sentences(self) -> Iterator[str]:
        yield from super()._sentences()
        order = f"slip converges with order {self.right.order_of_slip:.2g}"
        yield f"the converged series comes from meshes of {self.right.meshes} nodes; {order}"


def station_series(station: str, scenario: Scenario) -> xr.Dataset:
    """Return the converged series of one of `STATIONS`. Raises InputError if the library of these runs is missing."""
    n = list(STATIONS).index(station)
    about = {
        "title": scenario.title,
        "asks": scenario.description,
        "version": stickslip.__version__,
        "scenario": scenario.to_toml(),
    }
    found = converged([on_mesh(nodes)[n] for nodes in MESHES])
    return found.assign_attrs(about, station=f"y = {STATIONS[station]:g} m", meshes=", ".join(map(str, MESHES)))


ASKS = {
    "0km": "a fault in 2D: slip in its nucleus, and its arrest",
    "8km": "a fault in 2D: when a front comes, its peak, and the arrest",
    "16km": "a fault in 2D, close to a barrier: a fast front",
}
"""What each station asks of a program."""


def of_faults() -> tuple[StationBenchmark, ...]:
    """Return the problems at stations of a fault; none where the extension that solves them is missing."""
    if not is_there("planar"):
        return ()
    return tuple(
        StationBenchmark(f"{FAULT}-{name}", ASKS[name], partial(load_scenario, FAULT), partial(station_series, name))
        for name in STATIONS
    )
