"""What a user gets from a run of a planar slab: the motion of the contact at frames in time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.extensions.planar.pulses import pulses, rupture_speed, rupture_times
from stickslip.extensions.planar.slab import ENOUGH_NODES, PlanarSlab
from stickslip.foundation.arguments import NamesAttributes, as_path
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.foundation.names import ENERGY_NAMES, in_files, si_unit
from stickslip.foundation.show import brief
from stickslip.problem import STATUSES, Status, default_event_rate, in_given_units
from stickslip.solution import known_to_pyplot

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

    from stickslip.extensions.planar.solver import PlanarSolver
    from stickslip.extensions.planar.stations import Station
    from stickslip.extensions.planar.step import PlanarMotion
    from stickslip.foundation.place import Place

FIELDS = {name: in_files(si_unit(name, "Pa")) for name in ("slip", "slip_rate", "traction", "heat")}
"""Unit of each field of a frame."""
MOTION = {"slip": "slip", "slip_rate": "rate", "traction": "traction", "heat": "heat"}
"""Name in the solver's `PlanarMotion` of each field of a frame."""
LARGEST_MISS = 0.1
"""A run is not called resolved if its energy balance misses by more than this share of the heat."""
FEWEST_STEPS, QUICK = 100.0, 2e8
"""Steps in a round trip in which energies are followed, at least; and `cost` up to which a summary has them: about two seconds."""


class PlanarPlots(NamesAttributes):
    """Figures of the run of a planar slab: `run.plot()` draws the default one, `run.plot.animation(path)` writes a film."""

    def __init__(self, run: PlanarSolution) -> None:
        self._run = run

    @in_given_units
    def __call__(self, **place: Unpack[Place]) -> Figure:
        """Draw the slip rate over y and time, and the motion in the middle against time; keywords as those of `Solution.plot`."""
        from stickslip.extensions.planar import figure as planar

        return known_to_pyplot(planar.draw_planar(self._run, **place), place)

    @in_given_units
    def animation(
        self,
        path: str | Path,
        start: float | None = None,
        end: float | None = None,
        *,
        frames: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Path:
        """Write an animation of slip rate and slip on the contact to a .gif, .mp4 or .webm, and return the path.

        The last two need ffmpeg. The animation shows profiles along a line, or maps of a plane, from `start` to `end` (s; by
        default those of the run) in 150 `frames`, unless another number is given, 20 per second and at most those that the run has
        kept. `progress` is called with the number of finished frames and the number of all frames. Raises InputError for fewer than
        two frames, and if the software that writes such a file is missing.
        """
        from stickslip.extensions.planar import figure as planar

        return planar.animate(self._run, path, start, end, frames=frames, progress=progress)


@dataclass(frozen=True, eq=False)
class PlanarSolution(NamesAttributes):
    """The motion of the contact of a planar slab. Arrays have time first, then the axes of the contact.

    `times` are those of the frames (s), `fields` the arrays by the names in `FIELDS`, each read when it is first used. `status`
    says what ended the run, and `residual` how well the contact equation is solved: the largest |Z v + tau - load| at any node and
    time step, as a share of the load. `title` is that of its scenario, for figures.
    """

    slab: PlanarSlab
    times: Floats
    fields: Mapping[str, Floats]
    steps_per_round_trip: int
    status: Status
    residual: float
    title: str = ""

    @in_given_units
    def __repr__(self) -> str:
        nodes = " x ".join(str(count) for count in self.slab.shape)
        return f"PlanarSolution({nodes} nodes, {len(self.times)} frames up to {self.times[-1]:.6g} s, {self.status.name})"

    def __str__(self) -> str:
        return "\n".join(([] if self.status.ok else [f"{self.status}."]) + self.sentences)

    @cached_property
    def slip(self) -> Floats:
        """Slip (m)."""
        return self.fields["slip"]

    @cached_property
    def slip_rate(self) -> Floats:
        """Slip rate (m/s), after a jump where there is one."""
        return self.fields["slip_rate"]

    @cached_property
    def traction(self) -> Floats:
        """Friction while a node slips, and the load that it bears while it rests (Pa)."""
        return self.fields["traction"]

    @cached_property
    def heat(self) -> Floats:
        """Work of friction since the start (J/m^2)."""
        return self.fields["heat"]

    @property
    @in_given_units
    def sentences(self) -> list[str]:
        """What happened on the contact, and how far it is resolved, in sentences."""
        if not self.has_slipped.any():
            found = f"No node slips faster than {brief(self.threshold, 'm/s')} up to {brief(self.times[-1], 's')}."
            return [found, *self._how_close]
        counts, share = self.pulses, float(self.has_slipped.mean())
        first, middle = float(np.nanmin(self.rupture_times)), int(self.middle(counts))
        lines = [
            f"{share:.0%} of the contact slips, from {brief(first, 's')} on; the largest slip is"
            f" {brief(np.ptp(self.slip, 0).max(), 'm')}, the largest slip rate {brief(np.abs(self.slip_rate).max(), 'm/s')}.",
            f"The middle has slipped {brief(self.middle(self.slip[-1] - self.slip[0]), 'm')} at the end, in {middle}"
            f" pulse{'' if middle == 1 else 's'}; other nodes see up to {counts.max()}.",
            "All nodes rest at the end." if not self.slip_rate[-1].any() else "Some nodes still slip at the end.",
        ]
        lines += [self._energy_sentence] if self._energy_sentence else []
        if np.isfinite(self.nodes_per_process_zone):
            enough = "resolved" if self.nodes_per_process_zone >= ENOUGH_NODES else f"NOT resolved, {ENOUGH_NODES:g} are wanted"
            lines.append(
                f"The process zone of a slow front has {self.nodes_per_process_zone:.3g} nodes: {enough}; it contracts as fronts"
                " come close to the wave speed."
            )
        return lines

    @property
    def _how_close(self) -> list[str]:
        """How close a contact without slip has come to it, as far as its strength at rest is that at the start."""
        values, free = self.slab.values, ~self.slab.locked
        if values.law.states or not values.law.sticks or not free.any():
            return []
        share = np.abs(self.traction).max(axis=0)[free] / (values.load - values.excess)[free]
        return [f"The node that is closest to slip bears up to {share.max():.3%} of its strength."]

    @property
    def threshold(self) -> float:
        """A node slips in a pulse above this slip rate (m/s): the event rate of the problem in 1D."""
        return default_event_rate(self.slab.problem)

    @property
    def has_slipped(self) -> NDArray[np.bool_]:
        """True at each node that has slipped faster than `threshold`."""
        return np.isfinite(self.rupture_times)

    @cached_property
    def rupture_times(self) -> Floats:
        """The time (s) when each node first slips faster than `threshold`; NaN where it never does."""
        return rupture_times(self.times, self.slip_rate, self.threshold)

    @property
    def rupture_speed(self) -> Floats:
        """The speed (m/s) of the front at each node along y: through the middle of a plane."""
        return rupture_speed(self.slab.spacing[0], self.middle_line(self.rupture_times))

    @cached_property
    def pulses(self) -> NDArray[np.int64]:
        """The number of pulses that have passed each node: see `stickslip.extensions.planar.pulses.pulses`."""
        return pulses(self.slip_rate, self.threshold)

    @property
    def moment_rate(self) -> Floats:
        """G times the slip rate summed over the contact, at each frame: N m/s, or N/s (per metre of z) for a line."""
        sums = self.slip_rate.reshape(len(self.times), -1).sum(axis=1)
        return np.asarray(self.slab.body.shear_modulus * self.slab.node_area * sums, float)

    @property
    def stress_drop(self) -> Floats:
        """Initial load minus traction at the last frame, at each node (Pa)."""
        return np.asarray(self.slab.values.load - self.traction[-1], float)

    @property
    def _steps_of_energies(self) -> int:
        frames = self.slab.body.two_way_time / float(np.diff(self.times).max())
        return 2 * math.ceil(0.5 * max(frames, FEWEST_STEPS))

    @cached_property
    def _energies(self) -> dict[str, Floats]:
        from stickslip.extensions.planar.energy import energies  # with scipy, which no other run needs

        fields = {"slip": self.slip, "slip_rate": self.slip_rate, "heat": self.heat}
        return energies(self.slab, self.times, **fields, steps=self._steps_of_energies)

    def energy(self, t: ArrayLike | None = None) -> xr.Dataset:
        """Return the energies of the run as differences from its start: in J, or in J per metre of z for a line.

        Waves inside the slab are followed from the slip of the frames, independently of the solver, so that the balance tests the
        run. It closes the better, the more nodes and frames there are.

        Parameters
        ----------
        t
            Times (s); by default those of the frames.

        Returns
        -------
        xarray.Dataset
            work of the driver, stored (elastic + kinetic), elastic, kinetic, heat of friction, radiated, and
            balance = work - stored - heat, as in `Solution.energy`.
        """
        import xarray

        from stickslip.extensions.planar.energy import NAMES

        times = self.times if t is None else np.atleast_1d(np.asarray(t, float))
        if len(self.times) < 2:
            raise InputError("energy: the run ended at its first frame")
        if times.min() < self.times[0] or times.max() > self.times[-1]:
            raise InputError(f"energy: times must be from {self.times[0]:g} to {self.times[-1]:g} s")
        unit, found = "J" if self.slab.is_plane else "J m-1", self._energies
        about = {name: {"units": unit, "long_name": ENERGY_NAMES[name].replace(" - damped", "")} for name in NAMES}
        fields = {name: ("time", np.interp(times, found["time"], found[name]), about[name]) for name in NAMES}
        return xarray.Dataset(fields, coords={"time": ("time", times, {"units": "s"})})

    @property
    def knows_energy(self) -> bool:
        """True if the energies of the run are known within about two seconds."""
        from stickslip.extensions.planar.energy import cost

        return len(self.times) > 2 and cost(self.slab, self.times[-1], self._steps_of_energies) <= QUICK

    @property
    def _energy_sentence(self) -> str:
        """How well energy is balanced, or nothing if it would take long to know."""
        if not self.knows_energy:
            return ""
        found = self._energies
        heat, missed = float(found["heat"][-1]), float(np.abs(found["balance"]).max())
        unit, lost = "J" if self.slab.is_plane else "J per metre of z", ": NOT resolved" if missed > LARGEST_MISS * heat else ""
        return f"Friction takes {brief(heat, unit)}; the energy balance misses up to {missed / heat:.1%} of that{lost}."

    @property
    def nodes_per_process_zone(self) -> float:
        """The nodes within the process zone of a slow front: `PlanarSlab.nodes_per_process_zone` for the slip of the run."""
        return self.slab.nodes_per_process_zone(float(np.ptp(self.slip, axis=0).max()) or 1e-6)

    def middle(self, values: NDArray[np.generic]) -> float:
        """Return the value of a field at the node in the middle."""
        return float(values[tuple(count // 2 for count in self.slab.shape)])

    def middle_line(self, values: Floats) -> Floats:
        """Return a field along y; for a plane, along the line at z = 0. Axes in front, such as time, stay."""
        return values[..., self.slab.shape[1] // 2] if self.slab.is_plane else values

    @property
    def plot(self) -> PlanarPlots:
        """The figures: `plot()` draws slip rate over the contact and time, `plot.animation(path)` writes a film."""
        return PlanarPlots(self)

    def to_csv(self, path: str | Path, *, station: Station | None = None) -> Path:
        """Write time, slip, slip rate, traction and heat of a node at the frames as CSV, and return the path.

        The node is the one in the middle, or the closest to a `station`: y in m or a text, as in "8 km"; of a plane y and z, as in
        "8 km, 0 km". The headings name the units (SI). A path that ends in .nc makes a netCDF file of `dataset`, with all nodes.
        """
        from stickslip.extensions.planar.curves import write_contact

        return write_contact(self, as_path("to_csv: path", path), station)

    def to_scec(self, path: str | Path, *, station: Station | None = None) -> Path:
        """Write the motion of a node at the frames as text, in the layout of the SCEC benchmarks, and return the path.

        The columns are time (s), slip since the start (m), slip rate (m/s) and shear stress (MPa). The `station` is as for
        `to_csv`. Raises InputError for a station that lies on no node.
        """
        from stickslip.extensions.planar.stations import write_station

        return write_station(self, as_path("to_scec: path", path), station)

    def dataset(self) -> xr.Dataset:
        """Return slip, slip rate, traction and heat as an xarray dataset over time, y and, for a plane, z (SI units)."""
        import xarray

        axes = ("time", "y", "z")[: self.slip.ndim]
        fields = {name: (axes, getattr(self, name), {"units": unit}) for name, unit in FIELDS.items()}
        places = {"time": self.times, "y": self.slab.y} | ({"z": self.slab.z} if self.slab.is_plane else {})
        made = xarray.Dataset(fields, coords=places)
        for axis in axes:
            made[axis].attrs["units"] = "s" if axis == "time" else "m"
        return made


@dataclass(eq=False)
class Frames:
    """The frames of a run, in memory."""

    slab: PlanarSlab
    steps_per_round_trip: int
    times: list[float] = field(default_factory=list)
    waiting: dict[str, list[Floats]] = field(default_factory=lambda: {name: [] for name in FIELDS})
    """Frames that are in memory, by field."""
    largest_slip: float = 0.0
    """Largest slip since the start, at any node and frame, m."""
    fastest: float = 0.0
    """Largest slip rate at any node and frame, m/s."""
    residual: float = 0.0
    """See `PlanarSolution`."""
    title: str = field(default="", kw_only=True)
    """See `PlanarSolution`."""

    def add(self, time: float, motion: PlanarMotion) -> float:
        """Keep the motion at a time (s), and return the largest slip rate in it (m/s)."""
        self.times.append(time)
        for name, own in MOTION.items():
            self.waiting[name].append(np.array(getattr(motion, own)))
        self.largest_slip = max(self.largest_slip, float(np.abs(motion.slip - self.slab.values.slip).max()))
        fastest = float(np.abs(motion.rate).max())
        self.fastest = max(self.fastest, fastest)
        self.residual = float(motion.residual.max())
        return fastest

    def end_round_trip(self, run: PlanarSolver) -> None:
        """Take what the solver is about to forget."""

    def save(self, run: PlanarSolver) -> None:
        """Make what is there so far outlast the process."""

    def end(self, run: PlanarSolver, code: int) -> None:
        """Make the end of a run outlast the process, with the status that belongs to its code."""

    def solution(self, code: int) -> PlanarSolution:
        """Return the run, with the status that belongs to a code."""
        fields = {name: np.stack(frames) for name, frames in self.waiting.items()}
        status = STATUSES[code]
        return PlanarSolution(self.slab, np.array(self.times), fields, self.steps_per_round_trip, status, self.residual, self.title)
