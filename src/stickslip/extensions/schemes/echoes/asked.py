"""Ask a kind of body for the places that send waves back, and move waves between them under a given slip rate."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, Problem

SMALLEST_SHARE = 1e-6
"""A place that sends back a smaller share of stress (1) is none."""
LARGEST_WORK = 20_000_000
"""Most cells times steps that waves are moved through."""


@dataclass(frozen=True)
class SideOfWaves:
    """One side of a contact: impedances of its cells from the contact outwards (Pa s/m), and shares of stress that come back.

    `reflections` has a number for the far end of each cell; the last one is that of the driver.
    """

    impedances: tuple[float, ...]
    reflections: tuple[float, ...]

    @classmethod
    def of(cls, impedances: tuple[float, ...], driver: float) -> SideOfWaves:
        """Return a side whose driver sends back a share of stress: 1 if it is rigid, -1 if the top is free."""
        return cls(impedances, (*((beyond - near) / (beyond + near) for near, beyond in pairwise(impedances)), driver))

    def refined(self, by: int) -> SideOfWaves:
        """Return the side with each cell cut into as many."""
        inner = [share for one in self.reflections for share in (*[0.0] * (by - 1), one)]
        return SideOfWaves(tuple(np.repeat(self.impedances, by).tolist()), tuple(inner))


@dataclass(frozen=True)
class Echoes:
    """The sides of a contact, whose cells are crossed in a time (s); `apart` if the sides slip on each other."""

    sides: tuple[SideOfWaves, ...]
    time: float
    apart: bool = False

    @property
    def impedance(self) -> float:
        """The impedance of the contact, Pa s/m."""
        near = [side.impedances[0] for side in self.sides]
        return 1.0 / sum(1.0 / z for z in near) if self.apart else sum(near)

    def places(self) -> Iterator[tuple[str, float, int, int]]:
        """Yield what sentences call each place that sends waves back, its share of stress, and the side and the cell before it."""
        for k, side in enumerate(self.sides):
            of = " of the other side" * k
            layer = 0
            for cell, share in enumerate(side.reflections[:-1]):
                if abs(share) > SMALLEST_SHARE:
                    layer += 1
                    yield f"where layer {layer} meets layer {layer + 1}{of}", share, k, cell
            yield f"the driver{of}", side.reflections[-1], k, len(side.reflections) - 1

    def changed(self, share: float, side: int, cell: int) -> Echoes:
        """Return the same with another share of stress at one place."""
        one = self.sides[side]
        other = replace(one, reflections=(*one.reflections[:cell], share, *one.reflections[cell + 1 :]))
        return replace(self, sides=(*self.sides[:side], other, *self.sides[side + 1 :]))

    def finer(self, by: int) -> Echoes:
        """Return the same in smaller cells."""
        return replace(self, sides=tuple(side.refined(by) for side in self.sides), time=self.time / by)

    def load(self, rates: Floats) -> Floats:
        """Return what mean slip rates (m/s) in steps of `time` bring back as load (Pa), in the mean of each step."""
        rows = [[np.zeros(len(side.impedances)), np.zeros(len(side.impedances))] for side in self.sides]
        loads = np.zeros(len(rates))
        for n, rate in enumerate(rates.tolist()):
            back = [float(row[1][0]) for row in rows]
            near = [side.impedances[0] for side in self.sides]
            if self.apart:
                loads[n] = 2.0 * self.impedance * sum(q / z for q, z in zip(back, near, strict=True))
                sent = [loads[n] - self.impedance * rate - q for q in back]
            else:
                loads[n] = 2.0 * sum(back)
                sent = [q - z * rate for q, z in zip(back, near, strict=True)]
            for row, side, first in zip(rows, self.sides, sent, strict=True):
                _move(row, np.array(side.reflections), first)
        return loads


def _move(row: list[Floats], shares: Floats, sent: float) -> None:
    """Move the waves of stress, away from the contact and back, by a step: `row` has what enters each cell, on either end."""
    away, back = (one.copy() for one in row)
    row[1][-1] = shares[-1] * away[-1]
    row[1][:-1] = shares[:-1] * away[:-1] + (1.0 - shares[:-1]) * back[1:]
    row[0][1:] = (1.0 + shares[:-1]) * away[:-1] - shares[:-1] * back[1:]
    row[0][0] = sent


class EchoesOfKind(ABC):
    """What the judgement of a series asks of a kind of body."""

    @abstractmethod
    def echoes(self, problem: Problem) -> Echoes | None:
        """Return the places that send waves back, or None if there are none, or if more happens to waves than that."""


ECHOES: ByKind[EchoesOfKind] = ByKind("stickslip.extensions.schemes.echoes", BODY_KINDS)
"""The answers of each kind of body."""


def echoes_of(problem: Problem) -> Echoes | None:
    """Return the places of a problem that send waves back; None also if the contact or a driver has a motion of its own."""
    body = problem.body
    moves = body.has_inertia or body.dashpot or body.has_machine or body.is_damped or problem.driver_changes
    return None if moves else ECHOES[body.structure].echoes(problem)
