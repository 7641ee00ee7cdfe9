"""The classical spectral method: for each wave number along the contact, convolutions over the whole history.

The load is beta = tau0 + F + P for each wave, with w = |k| c and R = 2 h / c. A half-space answers to the slip U of the past with

    F(t) = -Z integral from 0 to t of w J1(w a) / a U(t - a) da.

W = 2 Z v - 2 F - P leaves the contact (v is the slip rate). It crosses the slab twice and arrives as

    X(t) = W(t - R) - integral from R to t of w R J1(w sqrt(a^2 - R^2)) / sqrt(a^2 - R^2) W(t - a) da.

The driver reflects P = -X if it is rigid, and P = (Z - Zd) / (Z + Zd) X if it is a half-space of impedance Zd.

All quantities but the slip are means over a step of time. Each kernel is integrated over the steps by Gauss points, so that it
may vary fast; the order is 2, and 1 where loads jump. At w = 0 the method is the exact recursion of the slab in 1D.
Source of F: Geubelle & Rice 1995, J. Mech. Phys. Solids 43, 1791; Perrin, Rice & Zheng 1995, same journal, 43, 1461.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from math import ceil, inf

import numpy as np
from scipy.special import j1

from stickslip.extensions.planar.energy import Waves
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from tests.extensions.planar.planar_methods import PlanarCase, PlanarSeries

POINTS, WEIGHTS = np.polynomial.legendre.leggauss(32)
"""Points and weights on the interval from -1 to 1, for one step of time."""


class _Waves:
    """The history of all waves, as means over each step of time, which is the first axis."""

    def __init__(self, case: PlanarCase, steps: int, delay: int) -> None:
        self.case, self.delay, self.step_of_time = case, delay, case.two_way_time / delay
        w = case.frequencies()
        self._memory, self._echo = _kernel_of_half_space(w, self.step_of_time, steps), _kernel_of_echo(w, case, steps, delay)
        Z, Zd = case.impedance, case.driver_impedance
        self._reflection = -1.0 if Zd == inf else (Z - Zd) / (Z + Zd)
        self._slip, self._outgoing = np.zeros((2, steps, *w.shape), complex)
        self._half_space, self._reflected = np.zeros((2, *w.shape), complex)

    def arrive(self, n: int, slip: Waves) -> Waves:
        """Return F + P in step n, for which the slip at the middle is predicted."""
        self._slip[n] = slip
        self._half_space = -self.case.impedance * _convolve(self._memory, self._slip, n)
        self._reflected = self._reflection * self._crossed_twice(n - self.delay)
        return np.asarray(self._half_space + self._reflected)

    def leave(self, n: int, slip: Waves, rate: Waves) -> None:
        """Note the slip at the middle of step n, and the slip rate of the step."""
        self._slip[n] = slip
        self._outgoing[n] = 2.0 * self.case.impedance * rate - 2.0 * self._half_space - self._reflected

    def _crossed_twice(self, n: int) -> Waves:
        """Return X, which left the contact in step n and before."""
        if n < 0:
            return np.zeros_like(self._reflected)
        return np.asarray(self._outgoing[n] - _convolve(self._echo, self._outgoing, n))


def _convolve(kernel: Floats, history: Waves, n: int) -> Waves:
    """Return the sum of kernel[m] history[n - m]."""
    return np.asarray(np.einsum("m...,m...->...", kernel[: n + 1], history[n::-1]))


def _kernel_of_half_space(w: Floats, step: float, steps: int) -> Floats:
    """Return the integral of w J1(w a) / a over each step: from -1/2 to 1/2 step without what is before 0, and so on."""
    edges = step * np.maximum(np.arange(steps + 1) - 0.5, 0.0)
    return np.array([_integral(lambda a: w * j1(w * a) / a, low, high) for low, high in pairwise(edges)])


def _kernel_of_echo(w: Floats, case: PlanarCase, steps: int, delay: int) -> Floats:
    """Return the integral of w R J1(w sqrt(a^2 - R^2)) / sqrt(a^2 - R^2) over each step that begins half a step before R + n step.

    With b = sqrt(a^2 - R^2) the integrand is w R J1(w b) / sqrt(R^2 + b^2), which is smooth in b at the arrival of the echo.
    """
    R = case.two_way_time
    edges = R / delay * (delay + np.maximum(np.arange(max(steps - delay, 0) + 1) - 0.5, 0.0))
    since = np.sqrt(np.maximum(edges**2 - R**2, 0.0))
    return np.array([_integral(lambda b: w * R * j1(w * b) / np.hypot(R, b), low, high) for low, high in pairwise(since)])


def _integral(kernel: Callable[[float], Floats], low: float, high: float) -> Floats:
    """Return the integral from `low` to `high` by Gauss points."""
    half = 0.5 * (high - low)
    return np.asarray(sum(half * weight * kernel(low + half * (1.0 + at)) for at, weight in zip(POINTS, WEIGHTS, strict=True)))


def convolution(case: PlanarCase, duration: float, steps_per_two_way_time: int) -> PlanarSeries:
    """Solve a case by convolution over the whole history; its time grows with the square of the number of steps.

    The arguments are those of `volume`, but any number of steps will do. Raises InputError if several slip rates may solve the
    contact equation at a node, or if the steps are longer than 2 / w for the largest w: the method becomes unstable soon above
    this.
    """
    enough = ceil(0.5 * case.frequencies().max() * case.two_way_time)
    if steps_per_two_way_time < enough:
        raise InputError(
            f"convolution: steps_per_two_way_time is {steps_per_two_way_time}, but must be at least {enough} for this case"
        )
    steps, dt = round(duration / case.two_way_time * steps_per_two_way_time), case.two_way_time / steps_per_two_way_time
    waves = _Waves(case, steps, steps_per_two_way_time)
    slip, loads, rate = np.zeros((steps + 1, *case.shape)), np.empty((steps, *case.shape)), np.zeros(case.shape)
    for n in range(steps):
        arrived = waves.arrive(n, case.to_waves(slip[n] + 0.5 * dt * rate))
        loads[n] = case.load_at_rest((n + 0.5) * dt) + case.to_nodes(arrived)
        rate, _ = case.contact.solve(loads[n], slip[n], 0.5 * dt)
        slip[n + 1] = slip[n] + dt * rate
        waves.leave(n, case.to_waves(slip[n] + 0.5 * dt * rate), case.to_waves(rate))
    rates, tractions = np.zeros((2, *slip.shape))
    for n in range(steps + 1):
        load = case.load_at_rest(0.0) if n == 0 else loads[-1] if n == steps else 0.5 * (loads[n - 1] + loads[n])
        rates[n], tractions[n] = case.contact.solve(load, slip[n], 0.0)
    return PlanarSeries(dt * np.arange(steps + 1.0), slip, rates, tractions)
