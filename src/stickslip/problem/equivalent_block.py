"""The block that stands for a slab: the same problem for the slow limit of its body."""

from __future__ import annotations

from dataclasses import replace

from stickslip.problem.features import DRIVER_THAT_CHANGES, refuse
from stickslip.problem.problem import Problem


def block_for(problem: Problem) -> Problem:
    """Return the same problem for the slab's equivalent block, which represents 1 m^2 of contact.

    Raises InputError if the body is a block, or if the driver of the slab is not rigid, or not for ever.
    """
    refuse("analogy", problem, {DRIVER_THAT_CHANGES: "has no counterpart beside a block"})
    return replace(problem, body=problem.body.equivalent_block())
