"""Energy of the run of a planar slab, as differences from its start.

The field inside the slab is found from the slip of the contact, by methods that share no code with the solver: the mean motion by
the two waves of the slab in 1D, and the rest by the volume method (`Volume`), whose contact is made to slip as in the run. The heat
is that of the law. So the balance tests the run: it closes only if the waves made by this slip bring the load that makes the law
slip in this way. Tests add friction to the volume method, as a solver of their own (`tests/extensions/planar/planar_methods.py`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.planar.asked import PLANAR_DRIVERS
from stickslip.extensions.planar.driving import locked_load
from stickslip.extensions.planar.slab import PlanarSlab
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

NAMES = ("work", "stored", "elastic", "kinetic", "heat", "radiated", "balance")
"""The energies of a planar slab, with the meaning that they have in `foundation.names.ENERGY_NAMES`."""


def cost(slab: PlanarSlab, duration: float, steps: int) -> float:
    """Return how many numbers `energies` has to advance: wavenumbers times places across the slab times time steps."""
    large, _ = slab.alone_for(duration)
    return 0.25 * math.prod(large.shape) * steps**2 * duration / slab.body.two_way_time


def energies(slab: PlanarSlab, times: Floats, *, slip: Floats, slip_rate: Floats, heat: Floats, steps: int) -> dict[str, Floats]:
    """Return the energies of a run at equal steps of time (s), by "time" and NAMES: J, or J per metre of z for a line.

    Slip (m), slip rate (m/s) and work of friction (J/m^2) are those of the frames, time first. Waves inside the slab are followed
    in `steps` steps per two-way travel time, an even number.
    """
    large, here = slab.alone_for(float(times[-1]))
    mean = slip_rate.reshape(len(times), -1).sum(axis=1) * (slab.node_area / math.prod(large.extent))
    step = slab.body.two_way_time / steps
    at = step * np.arange(math.floor(times[-1] / step + 1e-9) + 1)
    found = {"time": at} | _mean_motion(large, np.interp(at, times, mean), at, steps)
    uneven = _uneven_motion(large, _slip_at(at[1:], times, slip, slip_rate), here, steps)
    kinetic, elastic, beyond = (np.append(0.0, part) for part in uneven)
    total = heat.reshape(len(times), -1).sum(axis=1) * slab.node_area
    found["kinetic"] += kinetic
    found["elastic"] += elastic
    found["work"] -= beyond
    found["radiated"] += beyond
    found["heat"] = np.interp(at, times, total)
    found["stored"] = found["elastic"] + found["kinetic"]
    found["balance"] = found["work"] - found["stored"] - found["heat"]
    return found


def _mean_motion(slab: PlanarSlab, rate: Floats, at: Floats, steps: int) -> dict[str, Floats]:
    """Return the energies of wavenumber 0: of a slab in 1D that slips at the mean rate (m/s) of the contact."""
    from scipy.integrate import cumulative_trapezoid  # takes a tenth of a second to load; other runs do not need it

    body, problem, half, last = slab.body, slab.problem, steps // 2, len(at) - 1
    impedance, step, area = body.impedance, body.two_way_time / steps, math.prod(slab.extent)
    load = float(slab.values.load.mean())
    arriving = load + locked_load(problem, steps, last // steps + 2)[:, :steps].ravel()[: last + half + 1]
    slope = impedance * problem.first_pull_rate / (0.5 * body.two_way_time)
    left = np.append(slope * step * np.arange(half, 0, -1) - load, np.zeros(last + 1))  # w from h/c before the start on
    locked = arriving.copy()
    for n in range(last + half + 1):
        if n >= steps:
            arriving[n] += body.reflection * (left[half + n - steps] + locked[n - steps])
        if n <= last:
            left[half + n] = 2.0 * impedance * rate[n] - arriving[n]
    inside = [cumulative_trapezoid(wave**2, dx=step, initial=0.0) for wave in (arriving, left)]
    stored = area / (4.0 * impedance) * sum(one[half:] - one[: last + 1] for one in inside)
    both = [arriving[n : n + half + 1] + left[n : n + half + 1][::-1] for n in range(last + 1)]
    kinetic = area / (8.0 * impedance) * np.array([np.trapezoid(one**2, dx=step) for one in both])
    comes, leaves = arriving[half:], left[: last + 1]  # at the driver
    work = area / (4.0 * impedance) * cumulative_trapezoid(comes**2 - leaves**2, dx=step, initial=0.0)
    behind = (comes + leaves) / (2.0 * impedance) - problem.pull_rate_at(at)
    damping = PLANAR_DRIVERS[problem.driver_kind].damping(problem)
    radiated = area * damping * cumulative_trapezoid(behind**2, dx=step, initial=0.0)
    stored, kinetic = stored - stored[0], kinetic - kinetic[0]
    return {"work": work, "kinetic": kinetic, "elastic": stored - kinetic, "radiated": radiated}


def _uneven_motion(slab: PlanarSlab, slips: Iterator[Floats], here: tuple[slice, ...], steps: int) -> Floats:
    """Return kinetic and elastic energy in the slab, and the energy beyond the driver, of wavenumbers above 0, after each step."""
    body = slab.body
    zero = np.zeros(slab.shape)
    driver = PLANAR_DRIVERS[slab.problem.driver_kind].impedance(slab.problem)
    medium = PlanarMedium(body.density, body.wave_speed, body.thickness, slab.extent, slab.values.load, driver_impedance=driver)
    moved, found = list(slips), []
    run = Volume(medium, steps, len(moved) * body.two_way_time / steps)
    for slip in moved:
        whole = zero.copy()
        whole[here] = slip
        run.move(whole - whole.mean())
        found.append(run.energies())  # half a step ago
    halves = np.array([*found, found[-1]])
    if len(found) > 1:
        halves[-1] += halves[-2] - halves[-3]
    return np.asarray(0.5 * (halves[1:] + halves[:-1]).T)


def _slip_at(at: Floats, times: Floats, slip: Floats, slip_rate: Floats) -> Iterator[Floats]:
    """Yield the slip since the start at given times (s): between frames the cubic with their slips and slip rates."""
    for n, time in zip(np.clip(np.searchsorted(times, at, "right") - 1, 0, len(times) - 2), at, strict=True):
        length = times[n + 1] - times[n]
        x = (time - times[n]) / length
        turned = slip_rate[n] * (1.0 - x) ** 2 * x - slip_rate[n + 1] * x**2 * (1.0 - x)
        yield slip[n] + (slip[n + 1] - slip[n]) * x**2 * (3.0 - 2.0 * x) + length * turned - slip[0]


Waves = NDArray[np.complex128]


@dataclass(frozen=True)
class PlanarMedium:
    """A slab 0 < x < h with scalar waves u_tt = c^2 (u_xx + u_yy + u_zz), periodic along the contact at x = 0.

    `length` is the period along each direction (m): one number in 2D, two in 3D; the shape of `initial_load` (Pa), which is in
    equilibrium, gives the numbers of nodes. `driver_impedance` (Pa s/m) is that of the half-space beyond x = h. Waves are equally
    fast there, and it reflects every wave by the factor (Z - Zd) / (Z + Zd); infinite for a rigid driver, 0 for a dead load.
    """

    density: float
    wave_speed: float
    thickness: float
    length: tuple[float, ...]
    initial_load: Floats
    driver_impedance: float = field(default=math.inf, kw_only=True)

    def __post_init__(self) -> None:
        if len(self.length) != np.ndim(self.initial_load):
            raise InputError("PlanarMedium: length must have a number for each axis of initial_load")

    @property
    def impedance(self) -> float:
        """Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def two_way_time(self) -> float:
        """R = 2 h / c (s)."""
        return 2.0 * self.thickness / self.wave_speed

    @property
    def shape(self) -> tuple[int, ...]:
        """The numbers of nodes along the contact."""
        return np.shape(self.initial_load)

    @property
    def node_area(self) -> float:
        """The length (2D, m) or area (3D, m^2) of the contact that belongs to a node."""
        return float(np.prod(np.divide(self.length, self.shape)))

    def frequencies(self) -> Floats:
        """Return w = |k| c (1/s) for each wave of the real Fourier transform along the contact."""
        steps = [size / n for n, size in zip(self.shape, self.length, strict=True)]
        axes = [np.fft.fftfreq(n, step) for n, step in zip(self.shape, steps, strict=True)]
        axes[-1] = np.fft.rfftfreq(self.shape[-1], steps[-1])
        squares = sum(one**2 for one in np.meshgrid(*axes, indexing="ij"))
        return np.asarray(2.0 * np.pi * self.wave_speed * np.sqrt(squares))

    def to_waves(self, values: Floats) -> Waves:
        """Return the Fourier transform along the contact."""
        return np.fft.rfftn(values)


class Volume:
    """The displacement of the whole slab, step by step, for a `duration` (s) at most, by one line of nodes for each wave along it.

    A wave exp(i k y) obeys the Klein-Gordon equation u_tt = c^2 u_xx - w^2 u, w = |k| c. With dx = c dt the scheme

        u_i(n+1) + u_i(n-1) = cos(w dt) [u_{i+1}(n) + u_{i-1}(n)]

    is stable for every w, of order 2, and exact for w = 0. The lines end at a rigid driver. Otherwise they go on through the
    half-space of impedance Zd beyond x = h, so far that nothing comes back to the slab from their end in time. At x = h, where half
    cells meet,

        (Z + Zd) [u_i(n+1) + u_i(n-1)] = 2 cos(w dt) [Z u_{i-1}(n) + Zd u_{i+1}(n)].

    The number of steps in R = 2 h / c is even, because half as many cells fill the thickness. `slip` (m) is that now.
    """

    def __init__(self, case: PlanarMedium, steps_per_two_way_time: int, duration: float) -> None:
        if steps_per_two_way_time < 2 or steps_per_two_way_time % 2:
            raise InputError(f"volume: steps_per_two_way_time is {steps_per_two_way_time}, but must be even and at least 2")
        self.case, self.step_of_time, self.steps = case, case.two_way_time / steps_per_two_way_time, 0
        inside, beyond = steps_per_two_way_time // 2, 0
        if case.driver_impedance == 0.0:
            beyond = 1  # without mass; its far end stays at rest
        elif case.driver_impedance < math.inf:
            beyond = max(1, math.ceil(0.5 * (duration / self.step_of_time - inside)) + 1)
        self._impedance = np.repeat((case.impedance, case.driver_impedance if beyond else 0.0), (inside, beyond))
        """Impedance of each cell."""
        near = 2.0 * self._impedance[:-1] / (self._impedance[:-1] + self._impedance[1:])
        self._near = near.reshape(-1, *(1,) * len(case.shape))
        self._cosine = np.cos(case.frequencies() * self.step_of_time)
        self._now: Waves = np.zeros((inside + beyond + 1, *self._cosine.shape), complex)
        self._before = self._now.copy()
        self.slip = np.zeros(case.shape)
        self._slip_before = self.slip

    def move(self, slip: Floats) -> None:
        """Take one step of time; the contact then has the given slip (m)."""
        now, after = self._now, self._before  # the memory of the latter is used again
        self._slip_before, self.slip = self.slip, slip
        after[1:-1] = self._cosine * (self._near * now[:-2] + (2.0 - self._near) * now[2:]) - after[1:-1]
        after[0] = self.case.to_waves(slip)
        self._before, self._now = now, after
        self.steps += 1

    def energies(self) -> tuple[float, float, float]:
        """Return the kinetic and elastic energy of the slab, and that of the driver, half a step ago, minus those at the start.

        They are in J per m of strike in 2D, in J in 3D. The initial stress does work at the contact, -initial load times slip; it
        is part of the elastic energy. A rigid driver must be at rest.
        """
        case, dt, inside = self.case, self.step_of_time, round(0.5 * self.case.two_way_time / self.step_of_time)
        now, before, along = self._now, self._before, 2.0 * (1.0 - self._cosine) / dt**2  # w^2 as the scheme has it
        velocity, stretch, stretch_before = (now - before) / dt, np.diff(now, axis=0) / dt, np.diff(before, axis=0) / dt
        moving, shifted = self._product(velocity, velocity), self._product(along * now, before)
        stretched = self._product(self._cosine * stretch, stretch_before)
        work = case.node_area * float(np.sum(case.initial_load * (0.5 * (self.slip + self._slip_before))))
        parts = []
        for cells in (self._impedance * (np.arange(len(self._impedance)) < inside), self._impedance.copy()):
            masses = 0.25 * dt * (np.append(cells, 0.0) + np.append(0.0, cells))
            parts.append((float(masses @ moving), float(masses @ shifted + 0.5 * dt * (cells @ stretched))))
        (kinetic, elastic), whole = parts[0], sum(parts[1])
        return kinetic, elastic - work, whole - kinetic - elastic if len(self._impedance) > inside else 0.0

    def _product(self, one: Waves, other: Waves) -> Floats:
        """Return the integral over the contact of the product of two quantities, for each layer parallel to it."""
        count, last = int(np.prod(self.case.shape)), self.case.shape[-1]
        twice = np.full(one.shape[-1], 2.0)  # the real transform keeps one of each pair k, -k
        twice[0] = 1.0
        if last % 2 == 0:
            twice[-1] = 1.0
        # a complex number as its two parts: the real part of one * conj(other) is the sum of their products
        parts = (values.reshape(len(values), -1).view(float) for values in (one, other))
        weights = np.broadcast_to(np.repeat(twice, 2), (*one.shape[1:-1], 2 * len(twice))).ravel()
        return np.asarray(np.einsum("ij,ij,j->i", *parts, weights) * self.case.node_area / count)
