"""What is said of the run of a chain: its events, the largest of them, and where the energy went."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from stickslip.foundation.show import about_time, brief, number

if TYPE_CHECKING:
    from stickslip.extensions.chains.run import ChainEnergy, ChainRun

ENOUGH_STEPS = 100_000
"""From so many steps of blocks on the time of a step is told: in fewer it is that of the start."""

ROUNDING = 1e-10
"""Energies that do not balance to this share of the largest are not those of an exact motion that was rounded."""


def lines_of(run: ChainRun, took: float | None = None, steps_before: int = 0) -> Iterator[str]:
    """Yield the summary of a run, line by line.

    `took` is the wall-clock time (s) since it had so many steps of blocks; None if that is not known.
    """
    chain = run.chain
    blocks = " by ".join(map(str, chain.shape))
    yield f"{blocks} block{'s' if chain.count > 1 else ''}, up to {number(run.duration, 9)} s"
    many, changes = run.count_of_events, run.count_of_changes
    yield f"{many} event{'s' if many != 1 else ''}, {changes} change{'s' if changes != 1 else ''} of single blocks"
    if many:
        events = run.events
        largest, alone = events[int(np.argmax(events["moment"]))], int((events["size"] == 1).sum())
        first, size = int(largest["first_block"]), int(largest["size"])
        lasts, slips = brief(float(largest["duration"]), "s"), brief(float(largest["moment"]), "m")
        time = number(float(largest["time"]), 9)
        yield f"largest: {slips} of slip in all, at {time} s, first block {first}, {_blocks(size)}, {lasts} long"
        yield f"fastest: {brief(float(events['largest_rate'].max()), 'm/s')}; {alone} events of one block alone"
    if moving := int(np.count_nonzero(run.slip_rate)):
        yield f"at the end {_blocks(moving)} in motion"
    energy = run.energy()
    shares = {"heat": energy.heat, "dashpots": energy.dashpots, "springs": energy.springs, "motion": energy.kinetic}
    told = ", ".join(f"{name} {brief(one, 'J')}" for name, one in shares.items() if one)
    given = f"driver {brief(energy.driver, 'J')} + springs at the start {brief(energy.springs_at_start, 'J')}"
    yield f"energy: {given} = {told or 'nothing'}"
    yield f"        {_balance(energy)}"
    if took is not None and took > 0.0:
        steps = run.moving_steps - steps_before
        each = f", {number(1e6 * took / steps, 3)} us a step of a block" if steps > ENOUGH_STEPS else ""
        yield f"took {about_time(took)}{each}"


def proof_of(run: ChainRun) -> str:
    """Return what is proven of a run."""
    return run.proof()


def _balance(energy: ChainEnergy) -> str:
    """Return by how much energies do not balance."""
    if abs(energy.error) <= ROUNDING * max(map(abs, energy)):
        return f"but for {energy.error:.1e} J of rounding"
    return f"the balance lacks {energy.error:.1e} J, which is more than rounding"


def _blocks(count: int) -> str:
    return f"{count} blocks" if count != 1 else "1 block"
