"""The block that stands for a slab: the same problem for the slow limit of its body."""

from __future__ import annotations

from dataclasses import replace

from stickslip.foundation.errors import InputError
from stickslip.problem.problem import Problem


def block_for(problem: Problem) -> Problem:
    """Return the same problem for the slab's equivalent block, which represents 1 m^2 of contact.

    Raises InputError if the body is a block, or if the driver of the slab is not rigid, or not for ever.
    """
    if problem.driver_changes:
        raise InputError("analogy: a block has no driver that changes: leave driver_reflection out")
    return replace(problem, body=problem.body.equivalent_block())
