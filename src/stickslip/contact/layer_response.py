"""The response of layers to slip that grows or swings as exp(s t): the stress per slip rate W(s) that they resist with.

A cell of impedance Z is crossed in the time T. From behind it, where the stress per velocity is W, to its nearer side this becomes

    Z (W + Z tanh(s T)) / (Z + W tanh(s T))

and at the driver W is the driver's impedance, or M s + kp + ki/s of a machine. W is kept as a quotient of two functions of s
without poles, so that a rigid driver needs no exception and slow disturbances, which meet springs in series, lose no digits. Cells
of one layer are crossed at once; with drag two by two, between which it adds its stress over velocity to W.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import NDArray

from stickslip.contact.asked import SteadyDrive
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import BodyOnCharacteristics, OfLayers
from stickslip.problem.bodies.layered.layers import Layers

Complex = NDArray[np.complex128]
SAMPLES_OF_FREQUENCY = 32
"""Number of samples of a frequency for each cell, in half of the period with which layers repeat their response."""


class Quotient(NamedTuple):
    """Stress (Pa s/m times a common factor) over velocity (that factor): W = above / below."""

    above: Complex
    below: Complex


def response_of(body: OfLayers, s: NDArray[Any]) -> Quotient:
    """Return how all layers of a body resist disturbances with growth rates s (1/s), as one quotient."""
    return reduce(sides_of(body).together, [_of_side(one, np.asarray(s, complex)) for one in body.stacks])


class Crossing(NamedTuple):
    """What happens to a disturbance on its way from a driver to the contact: a change of layer, drag, or cells that it crosses."""

    ratio: float
    """Impedance of the layer behind over that of the layer in front (1)."""
    drag: float
    """Stress over velocity that drag takes first, over the impedance in front (1)."""
    time: float
    """Time (s) that it then takes to cross cells."""


def crossings_of(layers: Layers) -> list[Crossing]:
    """Return what a disturbance of layers meets from the driver inwards."""
    found, last = [], layers.impedances[-1]
    drags = np.cumsum((0, *layers.counts[:-1]))
    for z, count, dragged in zip(*map(reversed, (layers.impedances, layers.counts, layers.drags[drags].tolist())), strict=True):
        together = 1 if dragged else count
        for crossed in range(count // together):
            ratio = last / z if crossed == 0 else 1.0
            found.append(Crossing(ratio, dragged / z if crossed % 2 else 0.0, together * layers.time))
        last = z
    return found


def at_driver(layers: Layers, s: Complex) -> Quotient:
    """Return how the driver of layers resists, over the impedance of the last layer."""
    rigid, last = math.isinf(layers.driver_impedance), layers.impedances[-1]
    above = np.full(s.shape, 1.0 if rigid else layers.driver_impedance / last, complex)
    below = np.full(s.shape, 0.0 if rigid else 1.0, complex)
    if layers.driver_inertia > 0.0:
        above += layers.driver_inertia * s / last
    if layers.driver_gain > 0.0:
        above, below = above * s + layers.driver_gain / last, s.copy()
    return Quotient(above, below)


def met_by(meets: Crossing, s: Complex, behind: Quotient) -> Quotient:
    """Return how all that lies behind the near end of a crossing resists, over the impedance there."""
    above, below = behind
    if meets.ratio != 1.0:
        above = above * meets.ratio
    if meets.drag:
        above = above + meets.drag * below
    fades = np.expm1(-2.0 * s * meets.time)
    with_it, against = 1.0 + 0.5 * fades, -0.5 * fades  # cosh and sinh, times exp(-s T)
    above, below = above * with_it + below * against, below * with_it + above * against
    size = np.maximum(np.abs(above), np.abs(below))
    return Quotient(np.asarray(above / size), np.asarray(below / size))


def _of_side(layers: Layers, s: Complex) -> Quotient:
    found = at_driver(layers, s)
    for meets in crossings_of(layers):
        found = met_by(meets, s, found)
    return Quotient(found.above * layers.impedances[0], found.below)


class SidesJoined:
    """How the sides of a contact resist and drive it together: those that move as one, or one alone, side by side."""

    def together(self, one: Quotient, other: Quotient) -> Quotient:
        """Return how two sides resist a disturbance."""
        return Quotient(one.above * other.below + other.above * one.below, one.below * other.below)

    def factors(self, a: Complex, b: Complex, z: float, other: float) -> Complex:
        """Return the factors of below below', below above', above below' and above above' in a below + b above of two sides.

        Here `above` of each side is over its impedance at the contact, z and `other` (Pa s/m): 0 where there is no side.
        """
        return np.array([a, b * other, b * z, np.zeros_like(a)])

    def driven(self, drivers: Sequence[float], resists: Sequence[float]) -> SteadyDrive:
        """Return what drives the contact at a steady rate, from impedances (Pa s/m) of drivers, and of drivers with drag."""
        return SteadyDrive(sum(resists), sum(drivers), (1.0,) * len(drivers))


class SidesApart(SidesJoined):
    """Two sides that slip on each other, the first one pulled, the other one held: they resist in series."""

    def together(self, one: Quotient, other: Quotient) -> Quotient:
        """Return how both resist in series."""
        return Quotient(one.above * other.above, one.above * other.below + other.above * one.below)

    def factors(self, a: Complex, b: Complex, z: float, other: float) -> Complex:
        """Return the factors of two in series."""
        return np.array([np.zeros_like(a), a * other, a * z, b * (z * other)])

    def driven(self, drivers: Sequence[float], resists: Sequence[float]) -> SteadyDrive:
        """Return what both do in series: a side that nothing holds bears no stress."""
        if min(resists) == 0.0:
            free = [one == 0.0 for one in resists]
            return SteadyDrive(0.0, 0.0, tuple(one / sum(free) for one in free))
        if math.isinf(min(resists)):
            return SteadyDrive(math.inf, math.inf, (0.0, 0.0))
        whole = 1.0 / sum(1.0 / one for one in resists)
        held = 1.0 if math.isinf(drivers[0]) else drivers[0] / resists[0]
        return SteadyDrive(whole, whole * held, tuple(whole / one for one in resists))


SIDES_BY_WORDS = {"side by side": SidesJoined(), "in series": SidesApart()}
"""How sides act together, by the words for how they resist (`Sides.resist`)."""


def sides_of(body: OfLayers) -> SidesJoined:
    """Return how the sides of a body act together."""
    return SIDES_BY_WORDS[body.sides_together.resist]


def driven_steadily(body: OfLayers) -> SteadyDrive:
    """Return what drives a contact of layers at a steady rate, when all of a side moves alike."""
    drivers = [math.inf if one.driver_gain > 0.0 else one.driver_impedance for one in body.stacks]
    resists = [driver + float(one.drags.sum()) for driver, one in zip(drivers, body.stacks, strict=True)]
    return sides_of(body).driven(drivers, resists)


def taken_by_layers(body: OfLayers) -> float:
    """Return the steepest fall of friction with the slip rate (Pa s/m) that layers without a mass at the contact withstand.

    It is the smallest W = Z (1 - R) / (1 + R) at frequencies where it is real: there a disturbance keeps its size.
    """
    period, number = math.pi / body.cells.time, SAMPLES_OF_FREQUENCY * sum(body.cells.counts)

    def share(frequency: Floats) -> Complex:
        above, below = response_of(body, 1j * frequency)
        return np.asarray((body.impedance * below - above) / (body.impedance * below + above))

    at = np.linspace(0.0, 0.5 * period, number + 1)
    at[0] = 1e-12 * period
    back = share(at)
    crosses = np.flatnonzero(np.signbit(back.imag[:-1]) != np.signbit(back.imag[1:]))
    low, high, sign = at[crosses], at[crosses + 1], np.signbit(back.imag[crosses])
    for _ in range(60):
        middle = 0.5 * (low + high)
        same = np.signbit(share(middle).imag) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    real = np.concatenate([share(low).real, back.real[[0, -1]]])
    return float(max(body.impedance * (1.0 - real.max()) / (1.0 + real.max()), 0.0))


def growth_on_layers(body: OfLayers, weakening: float) -> float:
    """Return the growth rate (1/s) of a perturbation of layers that rest under friction falling with slip, by -S mu'(u) (Pa/m).

    It is the root of s (W(s) + D) + m_c s^2 = -S mu'(u), with the dashpot D, which grows with s from the stiffness on; 0 if the
    layers are stiffer.
    """
    from scipy.optimize import brentq  # here, because it takes a quarter of a second to import

    dashpot = cast(BodyOnCharacteristics, body).dashpot

    def miss(s: float) -> float:
        above, below = response_of(body, np.array([s], complex))
        return s * (float((above[0] / below[0]).real) + dashpot) + body.inertia * s * s - weakening

    slow, fast = 1e-9 / body.two_way_time, 2.0 * weakening / body.impedance
    while miss(fast) < 0.0:
        fast *= 2.0
    return 0.0 if miss(slow) >= 0.0 else float(brentq(miss, slow, fast, xtol=1e-300, rtol=1e-14))
