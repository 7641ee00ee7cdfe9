"""Every wave in every cell of layers, at many phases, in absolute stresses: a program of its own.

It shares nothing with the package: no polynomials, no reference strength, a wave in each direction in each cell, one step for each
crossing of a cell. Between two phases that it knows, the contact keeps to slip or to rest as long as friction allows that (perfect
delay). What it computes is exact at its phases, but for which of two of them an onset or an arrest lies between.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.foundation.arrays import Floats

PHASES = 48
"""Phases in the crossing of one cell."""


@dataclass
class Chain:
    """The cells of one side: their impedances, the driver's impedance and rate, the share of the load, the drags, and the waves.

    A drag is that between two cells, stress over velocity.
    """

    impedances: np.ndarray
    driver: float
    rate: float
    share: float
    drags: np.ndarray | None = None
    follows: Callable[[Floats], tuple[Floats, Floats, Floats]] | None = None
    """The driver's impedance (Pa s/m), its rate (m/s) and the stress behind it (Pa) at times (s), if they change."""
    moves: Callable[[Floats], Floats] | None = None
    """The rate (m/s) of a driver that is a machine, from the waves that meet it at one phase after another, each asked for once."""

    def begin(self, before: np.ndarray, time: float, contact: float, end: float, stress: float) -> None:
        """Set the waves that entered the cells at times `before` (s, negative), of a velocity that is straight in compliance."""
        zs = self.impedances
        passed = np.append(0.0, np.cumsum(1.0 / zs)) / np.sum(1.0 / zs)
        rates = contact + (end - contact) * passed
        growth = (end - contact) / (time * np.sum(1.0 / zs))
        self.lost = np.zeros(len(zs) - 1) if self.drags is None else self.drags
        levels = self.share * stress + np.append(0.0, np.cumsum(self.lost * rates[1:-1]))
        self.stress = levels[-1]
        self.away = np.array([z * v - s - growth * before for z, v, s in zip(zs, rates[:-1], levels, strict=True)])
        self.back = np.array([z * v + s + growth * before for z, v, s in zip(zs, rates[1:], levels, strict=True)])

    def cross(self, time: Floats | None = None) -> np.ndarray:
        """Let all waves cross their cells and meet at times (s), which only a driver that changes needs to know.

        Return what arrives at the contact. The first wave away is then missing.
        """
        away, back, zs = self.away.copy(), self.back.copy(), self.impedances
        for j in range(1, len(zs)):
            near, far = zs[j - 1], zs[j]
            velocity = (away[j - 1] + back[j]) / (near + far + self.lost[j - 1])
            self.back[j - 1] = 2.0 * near * velocity - away[j - 1]
            self.away[j] = 2.0 * far * velocity - back[j]
        last = zs[-1]
        if self.follows is not None:
            driver, rate, far = self.follows(time)
            rigid = np.isinf(driver)
            soft = np.where(rigid, 0.0, driver)
            inside = np.where(rigid, rate, (away[-1] + soft * rate + far) / (last + soft))
            self.back[-1] = 2.0 * last * inside - away[-1]
        elif self.moves is not None:
            self.back[-1] = 2.0 * last * self.moves(away[-1]) - away[-1]
        elif math.isinf(self.driver):
            self.back[-1] = 2.0 * last * self.rate - away[-1]
        else:
            inside = (away[-1] + self.driver * self.rate + self.stress) / (last + self.driver)  # velocity of the driver
            self.back[-1] = 2.0 * last * inside - away[-1]
        return back[0]


def answer(law: Any, normal: float, impedance: float, load: float, before: float) -> float:
    """Return the slip rate under a load, by perfect delay, after the rate `before`, from the law's own closed form."""
    way = math.copysign(1.0, load)
    level, held = abs(load), law.static * normal
    slips = before * way > 0.0
    if isinstance(law, ss.friction.Coulomb):
        rate = (level - law.dynamic * normal) / impedance
        return way * rate if (rate > 0.0 and slips) or level > held else 0.0
    drop, alpha = (law.static - law.dynamic) * normal, law.alpha
    # Z v + S d + drop / (1 + alpha v) = level, times 1 + alpha v: the larger root is the stable one
    rest = level - law.dynamic * normal
    b, c = impedance - alpha * rest, drop - rest
    root = b * b - 4.0 * impedance * alpha * c
    rate = (-b + math.sqrt(root)) / (2.0 * impedance * alpha) if root >= 0.0 else -1.0
    return way * rate if (rate > 0.0 and slips) or (level > held and rate > 0.0) else 0.0


def march(chains: list[Chain], joined: bool, law: Any, normal: float, time: float, steps: int, start: dict[str, Any]) -> np.ndarray:
    """Return the slip rates (m/s) at the phases (columns) of `steps` crossings (rows).

    `start` holds the velocities at contact and driver of each side, the stress, and perhaps the velocity of the ground over time.
    """
    phases = (np.arange(PHASES) + 0.5) / PHASES * time
    for chain, (contact, end) in zip(chains, start["rates"], strict=True):
        chain.begin(phases - time, time, contact, end, start["stress"])
    firsts = [chain.impedances[0] for chain in chains]
    impedance = sum(firsts) if joined else 1.0 / sum(1.0 / z for z in firsts)
    found, before = np.zeros((steps, PHASES)), 0.0
    for k in range(steps):
        now = k * time + phases
        arriving = [chain.cross(now) for chain in chains]
        shares = [1.0 if joined else impedance / z for z in firsts]
        moved = start["ground"](now) if "ground" in start else np.zeros(PHASES)
        load = sum(share * one for share, one in zip(shares, arriving, strict=True)) - impedance * moved
        for m in range(PHASES):
            before = found[k, m] = answer(law, normal, impedance, float(load[m]), before)
        for chain, one in zip(chains, arriving, strict=True):
            slid = joined or len(chains) == 1
            chain.away[0] = (
                2.0 * chain.impedances[0] * (found[k] + moved) - one if slid else one - 2.0 * (load - impedance * found[k])
            )
    return found
