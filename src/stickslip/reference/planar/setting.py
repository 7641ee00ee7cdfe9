"""The case that both reference methods solve, and what they have in common: the contact equation node by node.

A slab 0 < x < h carries scalar waves u_tt = c^2 (u_xx + u_yy + u_zz). Friction acts at x = 0, where slip u is that of the slab
itself. At x = h is a rigid driver, or a half-space of impedance Zd and of the same wave speed c, which reflects every wave by the
factor (Z - Zd) / (Z + Zd). Zd = 0 is a dead load. Along the contact everything is periodic. Stresses are counted from the initial
load, which is in equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from math import inf
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.differences import value_and_slopes
from stickslip.friction.law import FrictionLaw

Array = NDArray[np.float64]
Waves = NDArray[np.complex128]

ROUNDING = 1e-15
"""Share of the load by which the contact equation may be missed."""
ITERATIONS = 100
"""Largest number of steps of Newton's method or bisection at a node."""


class Friction(Protocol):
    """Friction at the nodes of the contact."""

    def __call__(self, slip: Array, rate: Array, nodes: NDArray[np.intp]) -> tuple[Array, Array, Array]:
        """Return the strength (Pa) at some nodes, and its derivatives by slip (Pa/m) and slip rate (Pa s/m).

        `slip` is the net slip since the start (m) and `rate` the magnitude of the slip rate (m/s; 0 means the limit 0+), one number
        for each of `nodes`, which are indices in the flattened contact.
        """


class SlipWeakeningAtNodes:
    """Strength that falls linearly with the magnitude of slip, from `static` to `dynamic` (Pa) over `distance` (m).

    They are numbers, or arrays of the shape of the contact.
    """

    def __init__(self, shape: tuple[int, ...], static: float | Array, dynamic: float | Array, distance: float | Array) -> None:
        self.static, self.dynamic, self.distance = (np.broadcast_to(one, shape).ravel() for one in (static, dynamic, distance))

    def __call__(self, slip: Array, rate: Array, nodes: NDArray[np.intp]) -> tuple[Array, Array, Array]:
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

    def __init__(self, law: FrictionLaw, normal_stress: Array, initial_slip: float | Array = 0.0) -> None:
        if law.states or law.static_excess:
            raise InputError(f"LawAtNodes: {law.kind} has a state or a static excess; only laws mu(u, v) without jumps can be used")
        self.law, self.normal = law, np.asarray(normal_stress, float).ravel()
        self.initial_slip = np.broadcast_to(initial_slip, np.shape(normal_stress)).ravel()
        self._trees = law.trees()
        self._numbers = [law.numbers(i) for i in range(len(self._trees))]

    def __call__(self, slip: Array, rate: Array, nodes: NDArray[np.intp]) -> tuple[Array, Array, Array]:
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
class PlanarCase:
    """A slab with friction that varies along a periodic contact.

    `length` is the period along each direction (m): one number in 2D, two in 3D; the shape of `initial_load` (Pa) gives the numbers
    of nodes. `friction` is `SlipWeakeningAtNodes`, `LawAtNodes`, or a function of one's own. `driver_impedance` (Pa s/m) is that of
    the half-space beyond x = h; infinite for a rigid driver, 0 for a dead load. `locked` is True where the contact is a barrier,
    which never slips. A rigid driver moves at `pull_rate` (m/s), and the slab starts with the velocity pull_rate x / h.
    """

    density: float
    wave_speed: float
    thickness: float
    length: tuple[float, ...]
    initial_load: Array
    friction: Friction
    driver_impedance: float = inf
    locked: NDArray[np.bool_] | None = None
    pull_rate: float = 0.0

    def __post_init__(self) -> None:
        if len(self.length) != np.ndim(self.initial_load):
            raise InputError("PlanarCase: length must have a number for each axis of initial_load")
        if self.pull_rate and self.driver_impedance != inf:
            raise InputError("PlanarCase: pull_rate needs a rigid driver")

    @property
    def impedance(self) -> float:
        """Z = rho c (Pa s/m)."""
        return self.density * self.wave_speed

    @property
    def shear_modulus(self) -> float:
        """G = rho c^2 (Pa)."""
        return self.density * self.wave_speed**2

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

    def nodes(self) -> tuple[Array, ...]:
        """Return the coordinates y (and z) of the nodes (m), which begin at minus half the period."""
        return tuple(np.arange(n) * size / n - 0.5 * size for n, size in zip(self.shape, self.length, strict=True))

    def frequencies(self) -> Array:
        """Return w = |k| c (1/s) for each wave of the real Fourier transform along the contact."""
        steps = [size / n for n, size in zip(self.shape, self.length, strict=True)]
        axes = [np.fft.fftfreq(n, step) for n, step in zip(self.shape, steps, strict=True)]
        axes[-1] = np.fft.rfftfreq(self.shape[-1], steps[-1])
        squares = sum(one**2 for one in np.meshgrid(*axes, indexing="ij"))
        return np.asarray(2.0 * np.pi * self.wave_speed * np.sqrt(squares))

    def to_waves(self, values: Array) -> Waves:
        """Return the Fourier transform along the contact."""
        return np.fft.rfftn(values)

    def to_nodes(self, waves: Waves) -> Array:
        """Return the inverse of `to_waves`."""
        return np.fft.irfftn(waves, self.shape, tuple(range(len(self.shape))))

    def load_at_rest(self, time: float) -> Array:
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

    times: Array
    """s"""
    slip: Array
    """m, since the start"""
    slip_rate: Array
    """m/s"""
    traction: Array
    """Pa"""


class Contact:
    """Solve Z v + tau = load at each node, where friction may be that after a part of a step of time."""

    def __init__(self, case: PlanarCase) -> None:
        self.case = case
        self.free = np.arange(int(np.prod(case.shape)))
        if case.locked is not None:
            self.free = np.flatnonzero(~np.asarray(case.locked).ravel())

    def solve(self, load: Array, slip: Array, ahead: float) -> tuple[Array, Array]:
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

    def _resistance(self, slip: Array, way: Array, ahead: float, nodes: NDArray[np.intp]) -> Callable[[Array], tuple[Array, Array]]:
        """Return the left side of the contact equation as a function of the magnitude of the slip rate, with its slope."""
        friction, Z = self.case.friction, self.case.impedance

        def left_side(rate: Array) -> tuple[Array, Array]:
            strength, by_slip, by_rate = friction(slip + ahead * way * rate, rate, nodes)
            return Z * rate + strength, Z + by_rate + ahead * way * by_slip

        return left_side

    def _root(self, load: Array, strength: Array, left_side: Callable[[Array], tuple[Array, Array]]) -> Array:
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
