"""Closed-form solutions for the elastic slab: endless pulses, a Coulomb pulse, the load while stuck, and growth from rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.problem import features
from stickslip.problem.bodies import BodyWithWaves, ElasticSlab


@dataclass(frozen=True)
class PulseTrain:
    """Slip in pulses under a constant load beta (Pa) and the sinusoidal slip law, with Z (Pa s/m), S (Pa) and omega (1/m).

    The load of a slab is constant for ever where the driver absorbs all waves, and under another driver, if it does not move, until
    the first echo of the slip returns. Raises InputError if beta does not exceed (mean + amplitude) S: slip would end at a strength
    that it cannot overcome.

    Source: Campillo et al. 1996, eqs (12) and (14): Z u' = (beta - mu0 S) - a S sin(omega u), whose solution is elementary in
    tan(omega u / 2).
    """

    impedance: float
    load: float
    normal_stress: float
    mean: float
    amplitude: float
    wavenumber: float
    initial_slip: float = 0.0

    def __post_init__(self) -> None:
        if self.surplus <= self.wave:
            raise InputError(
                f"PulseTrain: load must exceed the largest strength, {self.normal_stress * (self.mean + self.amplitude):g} Pa"
            )

    @property
    def surplus(self) -> float:
        """The mean driving stress beta - mu0 S (Pa)."""
        return self.load - self.mean * self.normal_stress

    @property
    def wave(self) -> float:
        """The amplitude a S of the strength (Pa)."""
        return self.amplitude * self.normal_stress

    @property
    def _root(self) -> float:
        return math.sqrt((self.surplus - self.wave) * (self.surplus + self.wave))

    @property
    def period(self) -> float:
        """The time between pulses (s), 2 pi Z / (omega sqrt((beta - mu0 S)^2 - (a S)^2))."""
        return 2.0 * math.pi * self.impedance / (self.wavenumber * self._root)

    @property
    def peak_rate(self) -> float:
        """The largest slip rate (m/s)."""
        return (self.surplus + self.wave) / self.impedance

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip u(t) (m) at times t (s), of the shape of t.

        It satisfies B tan(omega u / 2) = A + W tan(phi) with phi linear in t, A = a S, B = beta - mu0 S and W^2 = B^2 - A^2.
        """
        turn, start = np.divmod(0.5 * self.wavenumber * self.initial_slip + 0.5 * math.pi, math.pi)
        begin = math.atan((self.surplus * math.tan(start - 0.5 * math.pi) - self.wave) / self._root)
        phase = begin + math.pi * np.asarray(t, float) / self.period
        turns, rest = np.divmod(phase + 0.5 * math.pi, math.pi)
        half = np.arctan((self.wave + self._root * np.tan(rest - 0.5 * math.pi)) / self.surplus)
        return np.asarray((half + math.pi * (turns + turn)) * 2.0 / self.wavenumber)

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s), of the shape of t, from the governing equation at the exact slip."""
        return (self.surplus - self.wave * np.sin(self.wavenumber * self.slip(t))) / self.impedance


@dataclass(frozen=True)
class CoulombSlab:
    """One slip event of an elastic slab under Coulomb friction, a rigid driver and no contact mass: one pulse of one round trip.

    Slip starts at the static strength. Until the first echo Z v = (static - dynamic) S + G V t / h; the echo of the start then
    arrests the contact.

    The pull rate V is in m/s; 0 means the limit 0+. The echo arrests the contact as long as the pull rate is at most half the slip
    rate at the start and the load stays within the static strength. Nothing checks these two conditions: outside them the slab
    slips on after the echo, and these formulas do not hold.

    Source: Campillo et al. 1996, eqs (12)-(13), with the limit alpha -> infinity of the rate law (15).
    """

    body: ElasticSlab
    static: float
    dynamic: float
    pull_rate: float = 0.0

    def __post_init__(self) -> None:
        features.refuse(type(self).__name__, self, {features.DASHPOT: "is not in it"})

    @property
    def duration(self) -> float:
        """The time from onset to arrest (s), which is the two-way travel time R = 2 h / c."""
        return self.body.two_way_time

    @property
    def drop(self) -> float:
        """The static minus the dynamic strength (Pa)."""
        return (self.static - self.dynamic) * self.body.normal_stress

    @property
    def loading_rate(self) -> float:
        """The loading rate G V / h (Pa/s)."""
        return self.body.stiffness * self.pull_rate

    def slip_rate(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip rate v(t) (m/s) at times t (s) after onset, of the shape of t; right limits at jumps."""
        t = np.asarray(t, float)
        moving = (t >= 0.0) & (t < self.duration)
        return np.where(moving, (self.drop + self.loading_rate * t) / self.body.impedance, 0.0)

    def slip(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the slip since onset (m) at times t (s) after onset, of the shape of t."""
        t = np.clip(t, 0.0, self.duration)
        return (self.drop * t + 0.5 * self.loading_rate * t**2) / self.body.impedance

    @property
    def total_slip(self) -> float:
        """The slip of the event (m); it is 2 (static - dynamic) S h / G for pull_rate 0."""
        return float(self.slip(self.duration))

    @property
    def end_load(self) -> float:
        """The load right after arrest (Pa), S (2 dynamic - static) + 2 Z V."""
        return (2.0 * self.dynamic - self.static) * self.body.normal_stress + 2.0 * self.body.impedance * self.pull_rate


@dataclass(frozen=True)
class StuckSlab:
    """A slab whose contact stays stuck, from an initial load tau0 (Pa), under a pull rate V (m/s) or a far stress (Pa, and Pa/s).

    With v = 0 the recursion of the slab, which is paper eq. (13) extended to a driver of finite impedance Zd, is

        beta(t) = -r beta(t - R) + 2 Z [Zd V + s(t - h/c)] / (Z + Zd),    r = (Z - Zd) / (Z + Zd),    s(t) = far_stress + rate t

    and sums to a geometric series. The load is linear in time for a rigid driver (r = -1); otherwise it tends to far_stress + Zd V,
    and follows the drift of the far stress.

    Nothing checks that the load stays within the static strength, beyond which the contact would slip. The far stress has no effect
    under a rigid driver.

    Source: Campillo et al. 1996, eq. (13), extended to a driver of finite impedance.
    """

    body: ElasticSlab
    initial_load: float
    pull_rate: float
    far_stress: float = 0.0
    far_stress_rate: float = 0.0

    def __post_init__(self) -> None:
        features.refuse(type(self).__name__, self, {features.DRIVEN_BY_MACHINE: "is not in it"})

    @property
    def loading_rate(self) -> float:
        """The loading rate G V / h (Pa/s)."""
        return self.body.stiffness * self.pull_rate

    def load(self, t: ArrayLike) -> NDArray[np.float64]:
        """Return the load beta(t) (Pa) at times t >= 0 (s), of the shape of t; right limits at jumps."""
        t = np.asarray(t, float)
        if self.body.is_driven_rigidly:
            return self.initial_load + self.loading_rate * t
        trips = np.floor(t / self.body.two_way_time)
        factor = -self.body.reflection
        power = factor**trips
        # `ones` and `indices` are the sums over k < trips of factor^k and of k factor^k; factor < 1
        ones = (1.0 - power) / (1.0 - factor)
        indices = (factor - trips * power + (trips - 1.0) * power * factor) / (1.0 - factor) ** 2
        forcing = self._forcing(t) * ones - self._forcing_rate * self.body.two_way_time * indices
        return power * self._first_trip(t - trips * self.body.two_way_time) + forcing

    @property
    def _passed(self) -> float:
        """The share 2 Z / (Z + Zd) of a stress beyond the driver that reaches the contact as load."""
        return 2.0 * self.body.impedance / (self.body.impedance + self.body.driver_impedance)

    @property
    def _forcing_rate(self) -> float:
        return self._passed * self.far_stress_rate

    def _forcing(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        far = self.body.driver_impedance * self.pull_rate + self.far_stress
        return self._passed * far + self._forcing_rate * (t - 0.5 * self.body.two_way_time)

    def _first_trip(self, t: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return beta for 0 <= t < R: the uniform ramp until h/c, then the reflection of the start w(-y) = G V y / h - tau0."""
        trip = self.body.two_way_time
        early = self.initial_load + self.loading_rate * t
        late = self.body.reflection * (self.loading_rate * (trip - t) - self.initial_load) + self._forcing(t)
        return np.where(t < 0.5 * trip, early, late)


def growth_rate(slab: BodyWithWaves, weakening: float) -> float:
    """Return the growth rate (1/s) of a perturbation of a slab that weakens with slip by -mu'(u) (1/m); 0 if the slab is stable.

    A perturbation u = exp(lambda t) sinh(lambda (h - x) / c) satisfies the friction law at x = 0 if lambda coth(lambda h / c) =
    c alpha_w with alpha_w = S weakening / G. It grows if and only if alpha_w h > 1. This is for a slab under a rigid driver and
    without contact mass. A dashpot D at the contact adds lambda D h / G to the left side.

    Source: Campillo et al. 1996, section 2, from eqs (7)-(13).
    """
    from scipy.optimize import brentq  # here, because it takes a quarter of a second to import

    target = slab.normal_load * weakening / slab.modulus * slab.distance
    if target <= 1.0:
        return 0.0
    share = slab.dashpot / slab.impedance
    x: float = brentq(lambda x: _excess(x) + share * x - (target - 1.0), 0.0, target + 1.0, xtol=1e-300)
    return x * slab.wave_speed / slab.distance


def _excess(x: float) -> float:
    """Return x coth x - 1, from its series if the difference would lose digits."""
    if x < 0.05:
        return x**2 / 3 - x**4 / 45 + 2 * x**6 / 945 - x**8 / 4725
    return x / math.tanh(x) - 1.0
