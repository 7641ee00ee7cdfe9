"""Energy of the run of a planar slab, as differences from its start.

What is inside the slab is found from the slip of the contact, by methods that share no code with the solver: the mean motion by the
two waves of the slab in 1D, and the rest by the volume method of `stickslip.reference.planar`, whose contact is made to slip as in
the run. The heat is that of the law. So the balance tests the run: it closes if waves in a slab whose contact slips like this bring
the load under which the law lets it slip like this.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stickslip.planar.driving import locked_load
from stickslip.planar.slab import PlanarSlab
from stickslip.reference.planar import PlanarCase, Volume

Floats = NDArray[np.float64]


NAMES = ("work", "stored", "elastic", "kinetic", "heat", "radiated", "balance")
"""The energies of a planar slab, with the meaning that they have in `balance.LONG_NAMES`."""


def cost(slab: PlanarSlab, duration: float, steps: int) -> float:
    """Return how many numbers `energies` has to advance: wavenumbers times places across the slab times time steps."""
    large, _ = slab.alone_for(duration)
    return 0.25 * math.prod(large.shape) * steps**2 * duration / slab.body.two_way_time


def energies(slab: PlanarSlab, times: Floats, *, slip: Floats, slip_rate: Floats, heat: Floats, steps: int) -> dict[str, Floats]:
    """Return the energies of a run at equal steps of time (s), by "time" and NAMES: J, or J per metre of z for a line.

    Slip (m), slip rate (m/s) and work of friction (J/m^2) are those of the frames, time first. In an even number of `steps` in a
    two-way travel time waves inside the slab are followed.
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
    from scipy.integrate import cumulative_trapezoid  # takes a tenth of a second to load, which other runs do not need

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
    radiated = np.zeros(last + 1)
    if not body.is_driven_rigidly:
        radiated = area * body.driver_impedance * cumulative_trapezoid(behind**2, dx=step, initial=0.0)
    stored, kinetic = stored - stored[0], kinetic - kinetic[0]
    return {"work": work, "kinetic": kinetic, "elastic": stored - kinetic, "radiated": radiated}


def _uneven_motion(slab: PlanarSlab, slips: Iterator[Floats], here: tuple[slice, ...], steps: int) -> Floats:
    """Return kinetic and elastic energy in the slab, and the energy beyond the driver, of wavenumbers above 0, after each step."""
    body = slab.body
    zero = np.zeros(slab.shape)
    case = PlanarCase(
        body.density,
        body.wave_speed,
        body.thickness,
        slab.extent,
        slab.values.load,
        lambda slip, rate, nodes: (slip, slip, slip),  # the contact is not solved
        math.inf if body.is_driven_rigidly else body.driver_impedance,
    )
    moved, found = list(slips), []
    run = Volume(case, steps, len(moved) * body.two_way_time / steps)
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
