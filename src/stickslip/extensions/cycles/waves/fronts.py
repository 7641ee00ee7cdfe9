"""Fronts in a body of layers: how fast what lasts an instant fades, as it is passed on and sent back where cells meet.

Waves go from place to place as in `engine.waves.ladder`. A front keeps its phase within the round trip of a cell, so that each
phase moves by itself. The contact answers a front in the load with y times it in its slip rate, where 1 / y is how it resists at
once: y is 0 at rest, and with mass.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from stickslip.engine import History, LadderCell, crossed
from stickslip.engine.input import ladder_of
from stickslip.foundation.arrays import Floats
from stickslip.problem import Problem
from stickslip.problem.bodies import OfLayers

SEEN_PHASES, SEEN_PERIODS, MOST_STEPS = 8, 6, 20_000
"""Fronts at so many phases (1) are followed through so many periods, but no more round trips than the last number."""


@dataclass(frozen=True)
class FirstCells:
    """The cells next to the contact, one on each side; sides that slip on each other are a group that bears the same stress."""

    cells: NDArray[np.intp]
    groups: NDArray[np.intp]
    """The first side of each group, and the number of sides."""
    damping: Floats
    """What resists the slip of each group (Pa s/m)."""
    weights: Floats
    """The share (1) in the stress of its group of a wave that arrives on each side at a contact that rests."""

    @classmethod
    def of(cls, body: OfLayers) -> FirstCells:
        """Return those of a body."""
        impedances = np.array([one.impedances[0] for one in body.stacks])
        groups = body.sides_together.alike(np.arange(len(impedances) + 1))
        damping = 1.0 / np.add.reduceat(1.0 / impedances, groups[:-1])
        cells = np.cumsum([0, *(sum(one.counts) for one in body.stacks[:-1])])
        return cls(cells, groups, damping, np.repeat(damping, np.diff(groups)) / impedances)

    def as_one(self, rows: Floats) -> Floats:
        """Return the one wave with the load of a contact at rest that sends these out, of all cells (axis 1)."""
        return np.asarray(np.einsum("s,nsk->nk", self.weights, rows[:, self.cells]))

    def answered(self, arrived: Floats, answer: Floats) -> Floats:
        """Return what leaves the contact of fronts that arrive at it (axes sides, phases); `answer` is its y (m/(Pa s))."""
        stress = np.add.reduceat(self.weights[:, None] * arrived, self.groups[:-1])
        stress -= self.damping[:, None] * answer * stress.sum(axis=0)
        return np.asarray(arrived - 2.0 * np.repeat(stress, np.diff(self.groups), axis=0))


class Fronts:
    """The ladder of a problem, for fronts alone: nothing that drivers send is among them."""

    def __init__(self, problem: Problem, body: OfLayers) -> None:
        self.problem, self.body, self.cells = problem, body, LadderCell.of(ladder_of(problem))
        self.first = FirstCells.of(body)

    @cached_property
    def meetings(self) -> list[tuple[NDArray[np.intp], NDArray[np.intp]]]:
        """The cells nearer to the contact at odd and at even places, and those that meet their driver there."""
        ends = [*self.first.cells[1:], len(self.cells.impedance)]
        sides = [(int(low), int(end) - 1) for low, end in zip(self.first.cells, ends, strict=True)]
        near = [np.concatenate([np.arange(low + parity, high, 2) for low, high in sides]) for parity in (0, 1)]
        at_driver = [np.array([high for low, high in sides if (high - low) % 2 == parity], np.intp) for parity in (0, 1)]
        return list(zip(near, at_driver, strict=True))

    def stepped(self, wave: Floats, answer: Floats) -> Floats:
        """Return fronts (axis 1) in each cell (axis 0) a round trip later; `answer` is y (m/(Pa s)) of the contact for each."""
        cells, wave = self.cells, wave.copy()
        for near, at_driver in self.meetings:
            share, beyond = cells.reflection[near][:, None], cells.reflection_beyond[near][:, None]
            wave[near], wave[near + 1] = crossed(share, beyond, wave[near], wave[near + 1])
            wave[at_driver] *= cells.reflection[at_driver][:, None]
        wave[self.first.cells] = self.first.answered(wave[self.first.cells], answer)
        return wave

    def answers(self, history: History, times: Floats) -> Floats:
        """Return y (m/(Pa s)) at times (s) of a history."""
        if self.body.inertia > 0.0:
            return np.zeros(times.shape)
        at, law = history.find(times.ravel(), "right"), self.problem.friction
        by_rate = law.slopes(history.law_slip(at) if law.depends_on_slip else 0.0, np.abs(history.rate(at)), history.state(at))[1]
        resists = self.problem.body.total_damping + self.problem.normal * by_rate
        return np.where(history.mode(at) == 0, 0.0, 1.0 / resists).reshape(times.shape)

    def left_after(self, history: History, begin: float, end: float) -> float:
        """Return what a period from one time (s) of a history to another multiplies fronts by (1), in the mean over phases."""
        period, trip, cells = end - begin, history.round_trip_time, len(self.cells.impedance)
        steps = int(np.clip(SEEN_PERIODS * period / trip, 16 * cells, MOST_STEPS))
        phases = trip * (np.arange(SEEN_PHASES) + 0.5) / SEEN_PHASES
        answers = self.answers(history, begin + np.mod(phases + trip * np.arange(steps)[:, None], period))
        wave, grown = np.random.default_rng(1).standard_normal((cells, SEEN_PHASES)), np.zeros((steps, SEEN_PHASES))
        for n in range(steps):
            wave = self.stepped(wave, answers[n])
            size = np.sqrt(np.sum(wave**2, axis=0)) + 1e-300
            wave, grown[n] = wave / size, np.log(size)
        pace = float(np.mean(grown[steps // 2 :]))
        return float(np.exp(pace * period / trip))
