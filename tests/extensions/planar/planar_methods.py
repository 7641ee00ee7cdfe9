"""Method B for a planar slab with friction: the volume method, and the contact equation that both reference methods solve.

Friction acts at x = 0, where slip u is that of the slab itself. Stresses are counted from the initial load, in equilibrium. At
the contact the half cell of the volume method (`stickslip.extensions.planar.energy`) obeys

    Z [u_0(n+1) - u_0(n-1)] / (2 dt) + tau(n) = tau0 + Z [cos(w dt) u_1(n) - u_0(n-1)] / dt,

where tau(n), the mean traction of two steps, is replaced by the mean of the tractions at their middles. Then each step has a
contact equation of its own, Z v + tau(u + v dt/2, v) = load, whose load is twice the right side less the load of the step before.
At w = 0 this is the exact mean of the load over the step. Friction is so integrated implicitly: friction that grows with slip
or slip rate stays stable, which central differences do not achieve.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.extensions.planar.energy import PlanarMedium, Volume, Waves
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.formula.differences import value_and_slopes
from stickslip.friction.law import FrictionLaw

LeftSide = Callable[[Floats], tuple[Floats, Floats]]
"""The left side of the contact equation by the magnitude of the slip rate, with its slope."""
ROUNDING = 1e-15
"""Share of the load by which the contact equation may be missed."""
ITERATIONS = 100
"""Largest number of steps of Newton's method or bisection at a node."""


class Friction(Protocol):
    """Friction at the nodes of the contact."""

    def __call__(self, slip: Floats, rate: Floats, nodes: NDArray[np.intp]) -> tuple[Floats, Floats, Floats]:
        """Return the strength (Pa) at some nodes, and its derivatives by slip (Pa/m) and slip rate (Pa s/m).

        `slip` is the net slip since the start (m) and `rate` the magnitude of the slip rate (m/s; 0 means the limit 0+), one number
        for each of `nodes`, which are indices in the flattened contact.
        """


class SlipWeakeningAtNodes:
    """Strength that falls linearly with the magnitude of slip, from `static` to `dynamic` (Pa) over `distance` (m).

    They are numbers, or arrays of the shape of the contact.
    """

    def __init__(self, shape: tuple[int, ...], static: float | Floats, dynamic: float | Floats, distance: float | Floats) -> None:
        self.static, self.dynamic, self.distance = (np.broadcast_to(one, shape).ravel() for one in (static, dynamic, distance))

    def __call__(self, slip: Floats, rate: Floats, nodes: NDArray[np.intp]) -> tuple[Floats, Floats, Floats]:
        """Return strength and derivatives: see `Friction`."""
        drop, distance = self.static[nodes] - self.dynamic[nodes], self.distance[nodes]
        weakens = np.abs(slip) < distance
        strength = self.static[nodes] - drop * np.minimum(np.abs(slip) / distance, 1.0)
        return strength, np.where(weakens, -drop / distance * np.sign(slip), 0.0), np.zeros(len(slip))


class LawAtNodes:
    """A friction law without a state and without a static excess, on nodes with normal stresses and initial slips of their own.

    The law gets the net slip. `normal_stress` (Pa) has the shape of the contact; `initial_slip` (m), the slip as the law counts it
    at the start, is a number or an array of this shape.
    """

    def __init__(self, law: FrictionLaw, normal_stress: Floats, initial_slip: float | Floats = 0.0) -> None:
        if law.states or law.static_excess:
            raise InputError(f"LawAtNodes: {law.kind} has a state or a static excess; only laws mu(u, v) without jumps can be used")
        self.law, self.normal = law, np.asarray(normal_stress, float).ravel()
        self.initial_slip = np.broadcast_to(initial_slip, np.shape(normal_stress)).ravel()
        self._trees = law.trees()
        self._numbers = [law.numbers(i) for i in range(len(self._trees))]

    def __call__(self, slip: Floats, rate: Floats, nodes: NDArray[np.intp]) -> tuple[Floats, Floats, Floats]:
        """Return strength and derivatives: see `Friction`."""
        slip = slip + self.initial_slip[nodes]
        found, piece = np.empty((3, len(slip))), self.law.piece_at(slip, rate)
        for i in np.unique(piece).tolist():
            own = piece == i
            value, slopes = value_and_slopes(self._trees[i], self._numbers[i], slip[own], rate[own], np.zeros(own.sum()))
            found[:, own] = value, slopes[0], slopes[1]
        strength, by_slip, by_rate = self.normal[nodes] * found
        return strength, by_slip, by_rate


@dataclass(frozen=True)
class PlanarCase(PlanarMedium):
    """A slab with friction that varies along a periodic contact.

    `friction` is `SlipWeakeningAtNodes`, `LawAtNodes`, or a function of one's own. `locked` is True where the contact is a barrier,
    which never slips. A rigid driver moves at `pull_rate` (m/s), and the slab starts with the velocity pull_rate x / h.
    """

    friction: Friction
    locked: NDArray[np.bool_] | None = None
    pull_rate: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.pull_rate and self.driver_impedance != inf:
            raise InputError("PlanarCase: pull_rate needs a rigid driver")

    @property
    def shear_modulus(self) -> float:
        """G = rho c^2 (Pa)."""
        return self.density * self.wave_speed**2

    def nodes(self) -> tuple[Floats, ...]:
        """Return the coordinates y (and z) of the nodes (m), which begin at minus half the period."""
        return tuple(np.arange(n) * size / n - 0.5 * size for n, size in zip(self.shape, self.length, strict=True))

    def to_nodes(self, waves: Waves) -> Floats:
        """Return the inverse of `to_waves`."""
        return np.fft.irfftn(waves, self.shape, tuple(range(len(self.shape))))

    def load_at_rest(self, time: float) -> Floats:
        """Return the load (Pa) that arrives at time t if the contact never slips: tau0 + G V t / h."""
        return self.initial_load + self.shear_modulus * self.pull_rate * time / self.thickness

    @cached_property
    def contact(self) -> Contact:
        """The contact equation of this case."""
        return Contact(self)


@dataclass(frozen=True)
class PlanarSeries:
    """A solution at the nodes and at equal steps of time; the first axis is time.

    Slip rates and tractions solve the contact equation at `times`. At a jump of the load they are those of the mean of both sides.
    """

    times: Floats
    """s"""
    slip: Floats
    """m, since the start"""
    slip_rate: Floats
    """m/s"""
    traction: Floats
    """Pa"""


class Contact:
    """Solve Z v + tau = load at each node, where friction may be that after a part of a step of time."""

    def __init__(self, case: PlanarCase) -> None:
        self.case = case
        self.free = np.arange(int(np.prod(case.shape)))
        if case.locked is not None:
            self.free = np.flatnonzero(~np.asarray(case.locked).ravel())

    def solve(self, load: Floats, slip: Floats, ahead: float) -> tuple[Floats, Floats]:
        """Return slip rate (m/s) and traction (Pa), where friction is that at slip + ahead times the slip rate.

        `load` is in Pa, `slip` in m, `ahead` in s. Raises InputError if the left side does not rise with the slip rate at a
        solution: then several slip rates may solve the equation, or the step of time is too long.
        """
        rate, shape, load, slip = np.zeros(load.size), load.shape, load.ravel(), slip.ravel()
        strength, _, _ = self.case.friction(slip[self.free], np.zeros(len(self.free)), self.free)
        slips = np.abs(load[self.free]) > strength
        nodes = self.free[slips]
        if len(nodes):
            way = np.sign(load[nodes])
            rate[nodes] = way * self._root(np.abs(load[nodes]), strength[slips], self._resistance(slip[nodes], way, ahead, nodes))
        return rate.reshape(shape), (load - self.case.impedance * rate).reshape(shape)

    def _resistance(
        self, slip: Floats, way: Floats, ahead: float, nodes: NDArray[np.intp]
    ) -> Callable[[Floats], tuple[Floats, Floats]]:
        """Return the left side of the contact equation as a function of the magnitude of the slip rate, with its slope."""
        friction, Z = self.case.friction, self.case.impedance

        def left_side(rate: Floats) -> tuple[Floats, Floats]:
            strength, by_slip, by_rate = friction(slip + ahead * way * rate, rate, nodes)
            return Z * rate + strength, Z + by_rate + ahead * way * by_slip

        return left_side

    def _root(self, load: Floats, strength: Floats, left_side: LeftSide) -> Floats:
        """Return the root of each node by Newton's method, which bisects where it would leave the bracket."""
        low, high = np.zeros(len(load)), (load - strength) / self.case.impedance
        for _ in range(ITERATIONS):  # friction that falls with slip or slip rate lets the contact slip faster than this
            too_slow = left_side(high)[0] < load
            if not too_slow.any():
                break
            low, high = np.where(too_slow, high, low), np.where(too_slow, 2.0 * high, high)
        rate = high
        for _ in range(ITERATIONS):
            value, slope = left_side(rate)
            low, high = np.where(value <= load, rate, low), np.where(value >= load, rate, high)
            step = rate - (value - load) / np.where(slope > 0.0, slope, inf)
            inside = (low <= step) & (step <= high) & (slope > 0.0)
            following = np.where(inside, step, 0.5 * (low + high))
            done = (np.abs(value - load) <= ROUNDING * load) | (following == rate)
            rate = np.where(done, rate, following)
            if done.all():
                break
        if (slope <= 0.0).any() or any((left_side(share * rate)[1] <= 0.0).any() for share in (0.0, 0.5)):
            raise InputError("PlanarCase: several slip rates may solve the contact equation; take shorter steps or milder friction")
        return rate


class FrictionalVolume(Volume):
    """A `Volume` whose contact obeys friction.

    `slip_rate` (m/s) and `traction` (Pa) are those of the last step. `heat` is the work of friction from the start until half a
    step ago (J per m of strike in 2D, J in 3D), of tau(n) as defined above.
    """

    case: PlanarCase

    def __init__(self, case: PlanarCase, steps_per_two_way_time: int, duration: float) -> None:
        super().__init__(case, steps_per_two_way_time, duration)
        self.slip_rate, self.traction = np.zeros(case.shape), case.initial_load.copy()
        self._load, self.heat = np.array(case.initial_load, float), 0.0

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

    def load_now(self) -> Floats:
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


def volume(case: PlanarCase, duration: float, steps_per_two_way_time: int) -> PlanarSeries:
    """Solve a case by the volume method at every step of a duration (s), which is rounded to whole steps.

    The number of steps in R = 2 h / c is even. Raises InputError if several slip rates may solve the contact equation at a node.
    """
    run = FrictionalVolume(case, steps_per_two_way_time, duration)
    count = round(duration / run.step_of_time)
    found = np.empty((3, count + 1, *case.shape))
    for n in range(count + 1):
        found[0, n] = run.slip
        found[1:, n] = case.contact.solve(run.load_now(), run.slip, 0.0)
        if n < count:
            run.advance()
    return PlanarSeries(run.step_of_time * np.arange(count + 1.0), *found)
