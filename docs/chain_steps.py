"""Draw docs/figures/chain-steps.png: how many events a chain has, and how large they are, by fixed steps and exactly.

python docs/chain_steps.py

The usual program for chains takes steps of one size by the classic Runge-Kutta method of order 4, and a block rests where its rate is
below a small one, falls, and its load is below its strength. It is written here as such programs are, compiled by numba.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numba
import numpy as np
from matplotlib import pyplot as plt

import stickslip as ss
from stickslip.figures.panels import add_legend, letter_panels
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, styled

FIGURE = Path(__file__).with_name("figures") / "chain-steps.png"
COUPLING, STATIC, DYNAMIC, PULL_RATE, UNTIL = 10.0, 1.0, 0.7, 1e-3, 1500.0
START = -np.random.default_rng(1).uniform(0.0, 0.5, 10)
STEPS = 0.5 ** np.arange(2, 15)
"""Sizes of the steps (s), from 0.25 to 0.06 ms."""
SMALL_RATES = (1e-2, 1e-3, 1e-4)
"""Rates (m/s) below which a block may rest."""


@numba.njit(cache=False)
def _loads(t: float, slip: Any, load: Any) -> None:
    """Put the force of the springs on each block (mass 1 kg, spring to the driver 1 N/m)."""
    last = len(slip) - 1
    for j in range(last + 1):
        load[j] = PULL_RATE * t - slip[j]
        if j > 0:
            load[j] += COUPLING * (slip[j - 1] - slip[j])
        if j < last:
            load[j] += COUPLING * (slip[j + 1] - slip[j])


@numba.njit(cache=False)
def by_fixed_steps(start: Any, step: float, small: float) -> tuple[int, float]:
    """Return the number of events, and the largest moment (m) of one, by steps of one size (s)."""
    count = len(start)
    slip, rate, load = start.copy(), np.zeros(count), np.zeros(count)
    moves, slips, changes = np.zeros(count, np.bool_), np.zeros((4, count)), np.zeros((4, count))
    before, in_event, events, largest = 0.0, False, 0, 0.0
    for n in range(int(UNTIL / step)):
        t = n * step
        _loads(t, slip, load)
        any_moves = False
        for j in range(count):
            if not moves[j]:
                moves[j] = abs(load[j]) > STATIC
            elif abs(load[j]) <= STATIC and rate[j] * (load[j] - math.copysign(DYNAMIC, rate[j])) <= 0.0 and abs(rate[j]) < small:
                moves[j], rate[j] = False, 0.0
            any_moves = any_moves or moves[j]
        if any_moves and not in_event:
            events, before = events + 1, slip.sum()
        if in_event and not any_moves:
            largest = max(largest, slip.sum() - before)
        in_event = any_moves
        if not any_moves:
            continue
        for stage in range(4):
            ahead = 0.0 if stage == 0 else (step if stage == 3 else 0.5 * step)
            there = slip + ahead * slips[stage - 1] if stage else slip.copy()
            _loads(t + ahead, there, load)
            for j in range(count):
                v = rate[j] + ahead * changes[stage - 1, j] if stage else rate[j]
                forwards = v > 0.0 or (v == 0.0 and load[j] > 0.0)
                slips[stage, j] = v if moves[j] else 0.0
                changes[stage, j] = load[j] - (DYNAMIC if forwards else -DYNAMIC) if moves[j] else 0.0
        slip += step / 6.0 * (slips[0] + 2.0 * slips[1] + 2.0 * slips[2] + slips[3])
        rate += step / 6.0 * (changes[0] + 2.0 * changes[1] + 2.0 * changes[2] + changes[3])
    return events, largest


def exact() -> Any:
    """Return the run of the chain with located events."""
    law = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)
    chain = ss.Chain(law, 10, 1.0, COUPLING, 1.0, 1.0, PULL_RATE, initial_slip=START)
    return ss.simulate(chain, UNTIL)


@styled
def draw() -> None:
    """Draw events and the largest moment against the step, for three small rates, beside the exact numbers."""
    events = exact().events
    figure, (counted, sizes) = plt.subplots(1, 2, figsize=(7.6, 3.6), layout="constrained")
    for small, colour in zip(SMALL_RATES, (VERMILLION, BLUE, GREY), strict=True):
        found = np.array([by_fixed_steps(START, step, small) for step in STEPS])
        for n, step in enumerate(STEPS):
            print(f"small rate {small:g} m/s, step {step:.3g} s: {found[n, 0]:.0f} events, the largest {found[n, 1]:.6g} m")
        for panel, column in ((counted, 0), (sizes, 1)):
            panel.plot(STEPS, found[:, column], "o-", color=colour, markersize=3.0, linewidth=1.0, label=f"rests below {small:g} m/s")
    print(f"exact: {len(events)} events, the largest {events['moment'].max():.9g} m")
    counted.axhline(len(events), color=INK, linewidth=1.0, linestyle="--", label="exact")
    sizes.axhline(events["moment"].max(), color=INK, linewidth=1.0, linestyle="--")
    counted.set(xscale="log", yscale="log", xlabel="step (s)", ylabel="number of events")
    sizes.set(xscale="log", xlabel="step (s)", ylabel="largest moment (m)")
    letter_panels([counted, sizes], ["events in 1500 s", "the largest event"])
    add_legend(counted, counted.get_legend_handles_labels()[0])
    figure.savefig(FIGURE, dpi=150, metadata={"Software": None})


if __name__ == "__main__":
    draw()
