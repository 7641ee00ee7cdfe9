"""The echo: what comes back to the contact from the driver, wavenumber by wavenumber.

What leaves the contact, W = 2 Z v - 2 F - P, comes back as P = r exp(-2 q h) W with q = sqrt(s^2 + w^2)/c, in time

    P(t) = r [W(t - R) - integral over th > R of w R J1(w s)/s W(t - th) dth],   s = sqrt(th^2 - R^2).

W is taken as linear in time in each step, with a jump where a round trip ends, so that the echoes of shocks are exact. The integral
is then a sum over past steps with weights that are computed once, and sums of a whole round trip are made by Fourier transforms.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from numpy.typing import NDArray
from scipy.special import j1, roots_legendre

from stickslip.foundation.arrays import Floats

POINTS_OF_J1 = 1024
"""Largest number of Gauss points of one step of the integral, where J1 oscillates many times within the step."""
EVALUATIONS_TOGETHER = 100_000
"""Evaluations of J1 at a time."""


class Weights(NamedTuple):
    """Weights of W at the late and the early end of a step that lies a number of steps before t - R: (steps, wavenumbers)."""

    late: Floats
    early: Floats


def echo_weights(frequencies: Floats, steps_per_round_trip: int, two_way_time: float, steps: int) -> Weights:
    """Return the weights (no unit) of the integral for the last `steps` steps before t - R, for w = |k| c (rad/s) and R (s).

    Each has the shape (steps, len(frequencies)).
    """
    step = two_way_time / steps_per_round_trip
    passed = np.arange(steps + 1)
    edges = step * np.sqrt(passed * (2.0 * steps_per_round_trip + passed))  # s at the ends of the steps
    late, early = np.zeros((steps, frequencies.size)), np.zeros((steps, frequencies.size))
    phases = frequencies * np.diff(edges)[:, None]
    many = 2.0 ** np.ceil(np.log2(0.6 * phases + 6.5))
    wanted = np.select([phases < 0.4, phases < 1.9], [4, 6], np.minimum(many, POINTS_OF_J1)).astype(int)  # errors below 1e-11
    for points in np.unique(wanted).tolist():
        nodes, gauss = roots_legendre(points)
        rows, columns = np.nonzero((wanted == points) & (frequencies > 0.0))
        for part in np.array_split(np.arange(rows.size), max(1, -(-rows.size * points // EVALUATIONS_TOGETHER))):
            row, w = rows[part], frequencies[columns[part]][:, None]
            half = 0.5 * np.diff(edges)[row][:, None]
            s = edges[row][:, None] + half * (1.0 + nodes)
            age = np.sqrt(two_way_time**2 + s**2)
            share = s**2 / (age + two_way_time) / step - row[:, None]  # of the step that has passed
            kernel = half * gauss * w * two_way_time * j1(w * s) / age
            late[row, columns[part]] = np.sum(kernel * (1.0 - share), axis=1)
            early[row, columns[part]] = np.sum(kernel * share, axis=1)
    return Weights(late, early)


def kernel_spectra(weights: Weights, steps_per_round_trip: int, unique: NDArray[np.intp]) -> NDArray[np.complex128]:
    """Return Fourier transforms of the weights, in segments of two round trips of which each overlaps the next by one.

    The weights are those of a whole number of round trips. `unique` has for each wavenumber of the contact the column of the
    weights that belongs to it. The result has the shape (round trips, 2, steps_per_round_trip + 1, *unique.shape): late and early.
    """
    n = steps_per_round_trip
    both = np.stack(weights)
    padded = np.concatenate([np.zeros_like(both[:, :n]), both], axis=1)
    segments = [padded[:, i * n : (i + 2) * n] for i in range(both.shape[1] // n)]
    return np.stack([np.fft.rfft(segment, axis=1)[..., unique] for segment in segments])


class Echo(NamedTuple):
    """What has been sent so far. The last axes of all arrays are those of the amplitudes: 2 and the wavenumbers."""

    past: Any
    """Fourier transforms of W, for each round trip that has passed, over its steps + 1 moments: (round trips, steps + 1, ...)."""
    first: Any
    """W at the first moment of each of these round trips: (round trips, ...)."""
    last: Any
    """W at their last moments."""
    count: Any
    """The number of round trips that have passed."""
    integral: Any
    """The integral at the end of the present round trip."""


def silent(round_trips: int, steps: int, shape: tuple[int, ...]) -> Echo:
    """Return the echo of a contact that has not slipped, for a number of coming round trips."""
    ends = np.zeros((round_trips, *shape))
    return Echo(np.zeros((round_trips, steps + 1, *shape), complex), ends, ends, np.zeros((), int), np.zeros(shape))


def echo_of(sent: Any, echo: Echo, spectra: Any, reflection: float) -> tuple[Any, Echo]:
    """Return the echo P (Pa) of the coming round trip, with the shape of `sent`, and what has been sent until then.

    `sent` is W of the round trip that ends, at its steps + 1 moments (Pa): (steps + 1, 2, wavenumbers); `echo` is what was sent
    before, `reflection` is r.
    """
    put = jax.lax.dynamic_update_index_in_dim
    steps, count = sent.shape[0] - 1, echo.count
    found = jnp.fft.rfft(sent, n=2 * steps, axis=0)
    past, first, last = (
        put(array, one, count, 0) for array, one in ((echo.past, found), (echo.first, sent[0]), (echo.last, sent[-1]))
    )
    moments = np.arange(steps + 1).reshape(-1, *(1,) * (sent.ndim - 1))
    forward, end = np.exp(1j * np.pi * moments / steps), (-1.0) ** moments  # of one step, and of a round trip back

    def added(n: Any, total: Any) -> Any:
        """Add what was sent n round trips before the one that ends: at the late ends of its steps, and at the early ones."""
        one, kernel = past[count - n], spectra[n]
        return total + kernel[0][:, None] * forward * (one - first[count - n]) + kernel[1][:, None] * (one - end * last[count - n])

    total = jax.lax.fori_loop(0, count + 1, added, jnp.zeros_like(found))
    integral = jnp.concatenate([echo.integral[None], jnp.fft.irfft(total, n=2 * steps, axis=0)[steps:]])
    return reflection * (sent - integral), Echo(past, first, last, count + 1, integral[-1])
