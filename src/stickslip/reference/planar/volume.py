"""Method B: for each wave number along the contact one line of nodes through the slab, one step of time from node to node.

A wave exp(i k y) obeys the Klein-Gordon equation u_tt = c^2 u_xx - w^2 u, w = |k| c. With dx = c dt the scheme

    u_i(n+1) + u_i(n-1) = cos(w dt) [u_{i+1}(n) + u_{i-1}(n)]

is stable for every w, of order 2, and exact for w = 0. At the contact the half cell obeys

    Z [u_0(n+1) - u_0(n-1)] / (2 dt) + tau(n) = tau0 + Z [cos(w dt) u_1(n) - u_0(n-1)] / dt,

where tau(n), the mean traction of two steps, is replaced by the mean of the tractions at their middles. Then each step has a
contact equation of its own, Z v + tau(u + v dt/2, v) = load, whose load is twice the right side less the load of the step before.
At w = 0 this is the exact mean of the load over the step. Friction is so integrated implicitly: friction that grows with slip
or slip rate stays stable, which central differences do not achieve.

The lines end at a rigid driver. Otherwise they go on through the half-space of impedance Zd beyond x = h, so far that nothing
comes back to the slab from their end in time. At x = h, where two half cells meet,

    (Z + Zd) [u_i(n+1) + u_i(n-1)] = 2 cos(w dt) [Z u_{i-1}(n) + Zd u_{i+1}(n)].
"""

from __future__ import annotations

from math import ceil, inf

import numpy as np

from stickslip.foundation.errors import InputError
from stickslip.reference.planar.setting import Array, PlanarCase, PlanarSeries, Waves


class Volume:
    """The state of the whole slab, step by step, for a `duration` (s) at most.

    The number of steps in R = 2 h / c is even, because half as many cells fill the thickness. `slip` (m) is that now; `slip_rate`
    (m/s) and `traction` (Pa) are those of the last step. `heat` is the work of friction from the start until half a step ago (J per
    m of strike in 2D, J in 3D), of tau(n) as defined above.
    """

    def __init__(self, case: PlanarCase, steps_per_two_way_time: int, duration: float) -> None:
        if steps_per_two_way_time < 2 or steps_per_two_way_time % 2:
            raise InputError(f"volume: steps_per_two_way_time is {steps_per_two_way_time}, but must be even and at least 2")
        self.case, self.step_of_time, self.steps = case, case.two_way_time / steps_per_two_way_time, 0
        inside, beyond = steps_per_two_way_time // 2, 0
        if case.driver_impedance == 0.0:
            beyond = 1  # without mass; its far end stays at rest
        elif case.driver_impedance < inf:
            beyond = max(1, ceil(0.5 * (duration / self.step_of_time - inside)) + 1)
        self._impedance = np.repeat((case.impedance, case.driver_impedance if beyond else 0.0), (inside, beyond))
        """Impedance of each cell."""
        near = 2.0 * self._impedance[:-1] / (self._impedance[:-1] + self._impedance[1:])
        self._near = near.reshape(-1, *(1,) * len(case.shape))
        self._cosine = np.cos(case.frequencies() * self.step_of_time)
        self._now: Waves = np.zeros((inside + beyond + 1, *self._cosine.shape), complex)
        self._before = self._now.copy()
        self.slip = np.zeros(case.shape)
        self.slip_rate, self.traction = np.zeros(case.shape), case.initial_load.copy()
        self._load, self._slip_before, self.heat = np.array(case.initial_load, float), self.slip, 0.0

    @property
    def time(self) -> float:
        """Time (s) since the start."""
        return self.steps * self.step_of_time

    def advance(self) -> None:
        """Take one step of time."""
        case, dt, Z = self.case, self.step_of_time, self.case.impedance
        if self.steps:
            arrived = Z / dt * (case.to_nodes(self._cosine * self._now[1]) - self._slip_before)
            load = 2.0 * (case.load_at_rest(self.time) + arrived) - self._load
        else:
            load = case.load_at_rest(0.5 * dt)
        traction = self.traction
        self.slip_rate, self.traction = case.contact.solve(load, self.slip, 0.5 * dt)
        traction = 0.5 * (traction + self.traction) if self.steps else self.traction
        slip = self.slip + dt * self.slip_rate
        self.heat += 0.5 * case.node_area * float(np.sum(traction * (slip - self._slip_before)))
        self._load = load
        self.move(slip)

    def move(self, slip: Array) -> None:
        """Take one step of time, after which the contact has a given slip (m), whatever friction may say."""
        now, after = self._now, self._before  # the memory of the latter is used again
        self._slip_before, self.slip = self.slip, slip
        after[1:-1] = self._cosine * (self._near * now[:-2] + (2.0 - self._near) * now[2:]) - after[1:-1]
        after[0] = self.case.to_waves(slip)
        self._before, self._now = now, after
        self.steps += 1

    def load_now(self) -> Array:
        """Return the load (Pa) at this moment: the mean of those of the steps before and after, or the initial one."""
        if not self.steps:
            return self.case.load_at_rest(0.0)
        arrived = self.case.to_nodes(self._cosine * self._now[1]) - self._slip_before
        return self.case.load_at_rest(self.time) + self.case.impedance / self.step_of_time * arrived

    def energy(self) -> float:
        """Return the energy of slab and driver half a step ago, less that at the start (J per m of strike in 2D, J in 3D).

        It is the kinetic and elastic energy of what has been added to the initial state, and the work of the initial stress, which
        acts at the contact: -initial load times slip. A rigid driver must be at rest. This is the energy that the scheme itself
        conserves: from the first step on, energy and heat add up to a constant but for rounding. That constant is 0 if nothing
        slips in the first step, and otherwise of order 1 in the step of time.
        """
        return sum(self.energies())

    def energies(self) -> tuple[float, float, float]:
        """Return the parts of `energy`: kinetic and elastic energy of the slab, and the energy of the driver.

        The work of the initial stress is part of the elastic energy.
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

    def _product(self, one: Waves, other: Waves) -> Array:
        """Return the integral over the contact of the product of two quantities, for each layer parallel to it."""
        count, last = int(np.prod(self.case.shape)), self.case.shape[-1]
        twice = np.full(one.shape[-1], 2.0)  # the real transform keeps one of each pair k, -k
        twice[0] = 1.0
        if last % 2 == 0:
            twice[-1] = 1.0
        products = twice * (one * other.conj()).real
        return np.asarray(products.sum(axis=tuple(range(1, one.ndim))) * self.case.node_area / count)


def volume(case: PlanarCase, duration: float, steps_per_two_way_time: int) -> PlanarSeries:
    """Solve a case by the volume method at every step of a duration (s), which is rounded to whole steps.

    The number of steps in R = 2 h / c is even. Raises InputError if several slip rates may solve the contact equation at a node.
    """
    run = Volume(case, steps_per_two_way_time, duration)
    count = round(duration / run.step_of_time)
    found = np.empty((3, count + 1, *case.shape))
    for n in range(count + 1):
        found[0, n] = run.slip
        found[1:, n] = case.contact.solve(run.load_now(), run.slip, 0.0)
        if n < count:
            run.advance()
    return PlanarSeries(run.step_of_time * np.arange(count + 1.0), *found)
