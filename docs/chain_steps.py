"""Draw docs/figures/chain-steps.png: how many events a chain has, and how large they are, by fixed steps and exactly.

python docs/chain_steps.py

The usual program for chains takes steps of one size by the classic Runge-Kutta method of order 4, and a block rests where its rate
falls below a small one. Blocks do not slip back. It is written here as such programs are, compiled by numba.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba
import numpy as np
from matplotlib import pyplot as plt

import stickslip as ss
from stickslip.extensions.chains.solver import solve_chain
from stickslip.figures.panels import add_legend, letter_panels
from stickslip.figures.style import BLUE, GREY, INK, VERMILLION, styled

FIGURE = Path(__file__).with_name("figures") / "chain-steps.png"
COUPLING, STATIC, DYNAMIC, PULL_RATE, UNTIL = 10.0, 1.0, 0.7, 1e-3, 1500.0
START = -np.random.default_rng(1).uniform(0.0, 0.5, 10)
MOST_EVENTS = 1000
SAME = 0.5
"""An event is the same if it begins within this time (s) of the exact one."""
STEPS = 0.5 ** np.arange(2, 14)
"""Sizes of the steps (s), from 0.25 to 0.12 ms."""
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
def by_fixed_steps(start: Any, step: float, small: float) -> Any:
    """Return the time (s) and the moment (m) of each event, by steps of one size (s)."""
    count = len(start)
    slip, rate, load = start.copy(), np.zeros(count), np.zeros(count)
    moves, slips, changes = np.zeros(count, np.bool_), np.zeros((4, count)), np.zeros((4, count))
    found, events, before, in_event = np.zeros((MOST_EVENTS, 2)), 0, 0.0, False
    for n in range(int(UNTIL / step)):
        t = n * step
        _loads(t, slip, load)
        any_moves = False
        for j in range(count):
            if not moves[j]:
                moves[j] = load[j] > STATIC
            elif load[j] <= DYNAMIC and rate[j] < small:
                moves[j], rate[j] = False, 0.0
            any_moves = any_moves or moves[j]
        if any_moves and not in_event:
            before = slip.sum()
            found[events, 0] = t
        if in_event and not any_moves:
            found[events, 1] = slip.sum() - before
            events += 1
        in_event = any_moves
        if not any_moves:
            continue
        for stage in range(4):
            ahead = 0.0 if stage == 0 else (step if stage == 3 else 0.5 * step)
            there = slip + ahead * slips[stage - 1] if stage else slip.copy()
            _loads(t + ahead, there, load)
            for j in range(count):
                v = rate[j] + ahead * changes[stage - 1, j] if stage else rate[j]
                slips[stage, j] = v if moves[j] else 0.0
                changes[stage, j] = load[j] - DYNAMIC if moves[j] else 0.0
        slip += step / 6.0 * (slips[0] + 2.0 * slips[1] + 2.0 * slips[2] + slips[3])
        rate += step / 6.0 * (changes[0] + 2.0 * changes[1] + 2.0 * changes[2] + changes[3])
    return found[:events]


def exact() -> Any:
    """Return the run of the chain with located events."""
    law = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)
    chain = ss.Chain(law, 10, 1.0, COUPLING, 1.0, 1.0, PULL_RATE, initial_slip=START, direction="forward")
    return solve_chain(chain, UNTIL)


def agree(times: Any, exact_times: Any) -> float:
    """Return the time (s) of the first event that is not that of the exact run."""
    count = min(len(times), len(exact_times))
    wrong = np.flatnonzero(np.abs(times[:count] - exact_times[:count]) > SAME)
    return float(exact_times[wrong[0]]) if len(wrong) else UNTIL


@styled
def draw() -> None:
    """Draw events, the largest moment, and how long events are the exact ones, against the step, for three small rates."""
    events = exact().events
    figure, panels = plt.subplots(1, 3, figsize=(9.6, 3.4), layout="constrained")
    for small, colour, size in zip(SMALL_RATES, (VERMILLION, BLUE, GREY), (6.0, 4.0, 2.5), strict=True):
        runs = [by_fixed_steps(START, step, small) for step in STEPS]
        found = [(len(run), run[1:, 1].max(), agree(run[:, 0], events["time"])) for run in runs]
        for step, (count, largest, until) in zip(STEPS, found, strict=True):
            said = f"{count} events, the largest {largest:.6g} m, exact up to {until:.6g} s"
            print(f"small rate {small:g} m/s, step {step:.3g} s: {said}")
        for panel, values in zip(panels, zip(*found, strict=True), strict=True):
            panel.plot(STEPS, values, "o-", color=colour, markersize=size, linewidth=0.8, label=f"rests below {small:g} m/s")
    print(f"exact: {len(events)} events, the largest {events['moment'][1:].max():.9g} m")
    for panel, value in zip(panels, (len(events), events["moment"][1:].max(), UNTIL), strict=True):
        panel.axhline(value, color=INK, linewidth=1.0, linestyle="--", label="exact")
        panel.set(xscale="log", xlabel="step (s)")
        panel.set_ylim(bottom=0.0)
    for panel, text in zip(panels, ("number of events", "largest moment (m)", "time (s)"), strict=True):
        panel.set_ylabel(text)
    letter_panels(panels, ["events in 1500 s", "largest after the first", "same events up to"])
    add_legend(panels[0], panels[0].get_legend_handles_labels()[0])
    figure.savefig(FIGURE, dpi=130, metadata={"Software": None})


if __name__ == "__main__":
    draw()
