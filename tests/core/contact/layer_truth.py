"""The characteristic function of layers with many digits, by tanh, and roots that are sought without any count."""

from __future__ import annotations

import math
from typing import Any

import mpmath
import numpy as np

from stickslip.contact.disturbance import Response
from stickslip.contact.wave_modes import Growth
from stickslip.problem.bodies import OfLayers
from stickslip.problem.bodies.layered.layers import Layers

DIGITS = 40


def resistance(body: OfLayers, s: Any, tanh: Any) -> Any:
    """Return stress over velocity of the contact, from the driver inwards: Z (W + Z tanh sT) / (Z + W tanh sT)."""
    sides = [_of_side(one, s, tanh) for one in body.stacks]
    if len(sides) == 1:
        return sides[0]
    return sides[0] + sides[1] if body.is_joined else 1 / (1 / sides[0] + 1 / sides[1])


def _of_side(layers: Layers, s: Any, tanh: Any) -> Any:
    met = None if math.isinf(layers.driver_impedance) else layers.driver_impedance + 0 * s
    drags, cells, at = layers.drags, layers.cell_impedances, len(layers.drags)
    while at:
        first = at - 1
        while layers.drag is None and first and cells[first - 1] == cells[at - 1]:
            first -= 1
        z, turned = cells[at - 1], tanh(s * (layers.time * (at - first)))
        met = z / turned if met is None else z * (met + drags[at - 1] + z * turned) / (z + (met + drags[at - 1]) * turned)
        at = first
    return met


def miss(body: OfLayers, normal: float, felt: Response, s: Any, tanh: Any = np.tanh) -> Any:
    """Return m_c s + W(s) + S Phi(s), which is 0 at the modes."""
    above, below = (sum(float(one) * s**k for k, one in enumerate(p)) for p in felt)
    return body.inertia * s + resistance(body, s, tanh) + normal * above / below


def exact_root(body: OfLayers, normal: float, felt: Response, near: complex) -> complex:
    """Return the root next to a place with DIGITS digits, by mpmath."""
    with mpmath.workdps(DIGITS):
        begin = mpmath.mpc(near)
        start = (begin, begin * (1 + mpmath.mpf("1e-9")))
        return complex(mpmath.findroot(lambda s: miss(body, normal, felt, s, mpmath.tanh), start, tol=1e-20, maxsteps=50))


def sought_roots(body: OfLayers, normal: float, felt: Response, said: Growth, seed: int, number: int = 3000) -> Any:
    """Return the roots that the secant method finds from places drawn over all scales, without those on the axis to rounding."""
    draw, period = np.random.default_rng(seed), math.pi / body.cells.time
    scales = [1.0 / body.two_way_time, period, *np.abs(np.roots(felt.denominator[::-1]))]
    scales += [abs(complex(*said))] if math.isfinite(said.rate) and said.rate else []
    low, high = math.log10(min(scales)) - 3.0, math.log10(max(scales)) + 1.0
    swings = np.concatenate([10 ** draw.uniform(low, high, number // 2), draw.uniform(0.0, 4.0 * period, number - number // 2)])
    grows = draw.choice([1.0, -1.0], number) * 10 ** draw.uniform(low - 3.0, high, number)
    s = grows + 1j * swings * (draw.uniform(size=number) < 0.9)
    with np.errstate(all="ignore"):
        before = s * (1.0 + 1e-7)
        here, there = (miss(body, normal, felt, one) for one in (s, before))
        for _ in range(80):
            step = here * (s - before) / (here - there)
            moves = np.abs(step) > 3e-16 * np.abs(s)
            before, there = np.where(moves, s, before), np.where(moves, here, there)
            s = np.where(moves, s - step, s)
            here = miss(body, normal, felt, s)
        beside = np.abs(miss(body, normal, felt, s + 1e-6 * np.abs(s)))
        settled = np.isfinite(s) & (np.abs(step) < 1e-12 * np.abs(s)) & (np.abs(here) < 1e-4 * beside)
    return s[settled & (np.abs(s.real) > 1e-12 * np.abs(s))]
