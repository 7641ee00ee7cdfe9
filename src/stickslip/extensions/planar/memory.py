"""The memory of a half-space: what slip in the past does to the load now, wavenumber by wavenumber.

Slip of wavenumber k on the face of a half-space loads the face by F = -Z w^2 integral of J(w th) U(t - th) dth over the past, with
U the Fourier amplitude of slip, w = |k| c and J(x) = J1(x)/x. Written as a sum of exponentials, J needs no past: each term is a
number that is advanced from step to step.

Source: the integral of J1 over the branch cut between its branch points, J1(x)/x = -(2/pi) Re integral over a from 0 to pi/2 of
sqrt(1 - exp(2 i a)) z exp(z x) with z = i exp(i a). The real part of z is never positive, so that every term is stable.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi, roots_legendre

from stickslip.foundation.arrays import Floats

Complex = NDArray[np.complex128]

POINTS_OF_GAUSS = 5
"""Gauss points of each panel of the integral: J is right to 2e-9 of its largest value, 1/2."""


class Exponentials(NamedTuple):
    """J1(x)/x = Re sum of weights exp(poles x), for x from 0 to what `exponentials` was asked for."""

    poles: Complex
    weights: Complex


def exponentials(longest: float, points: int = POINTS_OF_GAUSS) -> Exponentials:
    """Return J1(x)/x as a sum of exponentials for 0 <= x <= longest (no unit).

    The panels of the integral are halved towards a = 0, where the slowest exponentials are; the last one has the weight sqrt(a) of
    the integrand there (Gauss and Jacobi).
    """
    halvings = max(1, math.ceil(math.log2(max(1.0, 0.5 * math.pi * longest))))
    nodes, gauss = roots_legendre(points)
    edges = 0.5 * math.pi * 0.5 ** np.arange(halvings + 1)
    middle, half = 0.5 * (edges[:-1] + edges[1:]), 0.5 * (edges[:-1] - edges[1:])
    angles = (middle[:, None] + half[:, None] * nodes).ravel()
    weights = (half[:, None] * gauss).ravel()
    nodes, jacobi = roots_jacobi(points, 0.0, 0.5)
    last = 0.5 * edges[-1] * (1.0 + nodes)
    last_weights = jacobi * (0.5 * edges[-1]) ** 1.5 / np.sqrt(last)
    angles, weights = np.append(angles, last), np.append(weights, last_weights)
    poles = 1j * np.exp(1j * angles)
    root = np.sqrt(-np.expm1(2j * angles))
    return Exponentials(poles, -2.0 / math.pi * weights * root * poles)


def horizon(round_trips: int) -> int:
    """Return the number of round trips that a run's exponentials cover: it can be prolonged up to there."""
    return 1 << (round_trips - 1).bit_length()


class MemoryRecurrence(NamedTuple):
    """How the memory of each wavenumber is advanced by one step: a row for each exponential, then the axes of wavenumbers.

    With M the memory at the end of a step without the slip at that end, F = Re sum of M + now U there, and then
    M becomes decay M + gain U.
    """

    decay: Complex
    gain: Complex
    now: Floats


def recurrence(frequencies: Floats, impedance: float, step: float, duration: float) -> MemoryRecurrence:
    """Return the recurrence of the memory for slip that is linear in time in each `step` (s), for w = |k| c (rad/s) of any shape.

    The memory is used for a `duration` (s).
    """
    poles, weights = exponentials(float(frequencies.max(initial=0.0)) * duration)
    rates = poles[(slice(None),) + (None,) * frequencies.ndim] * (frequencies * step)
    phi1, phi2 = _phi(rates)
    strength = -impedance * frequencies**2 * step * weights[(slice(None),) + (None,) * frequencies.ndim]
    begin, end = strength * (phi1 - phi2), strength * phi2  # what slip at the beginning and at the end of a step adds
    decay = np.exp(rates)
    return MemoryRecurrence(decay, decay * end + begin, end.real.sum(axis=0))


def advanced(memory: Any, decay: Any, gain: Any, slip: Any) -> tuple[Any, Any]:
    """Return the memory after a step (see `MemoryRecurrence`), and the sum of its real parts, for arrays of numpy or JAX.

    As complex numbers the product is compiled into one loop in place; apart, real and imaginary parts need two loops and a copy.
    The sum is written as one of slices, because JAX's reduction over the first axis is ten times as slow on a processor.
    """
    memory = decay * memory + gain * slip
    return memory, sum(term.real for term in memory)


def _phi(z: Complex) -> tuple[Complex, Complex]:
    """Return (exp z - 1)/z and (exp z - 1 - z)/z^2 without loss of digits near 0."""
    small = np.abs(z) < 0.3
    near, far = np.where(small, z, 0.0), np.where(small, 1.0, z)
    phi2, term = np.zeros_like(z), np.full_like(z, 0.5)
    for n in range(3, 18):
        phi2, term = phi2 + term, term * near / n
    far2 = (np.exp(far) - 1.0 - far) / far**2
    phi2 = np.where(small, phi2, far2)
    return 1.0 + z * phi2, phi2
