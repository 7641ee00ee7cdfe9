"""The secant method for many roots of a function at once, from places near them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from stickslip.contact.layer_response import Complex

STEPS_TO_ROOT = 60
"""Largest number of steps to a root."""
SETTLED_ROOT = 1e-11
"""A root is found if the last step is no more than this share of it (1)."""

BESIDE, ROOT = 1e-6, 1e-3
"""At a root a function is smaller by the factor ROOT than it is in the relative distance BESIDE (1)."""


def polished(of: Callable[[Complex], Complex], begin: Complex) -> list[complex]:
    """Return the roots of a function that the secant method reaches from places; those from which it reaches none are left out."""
    s: Complex = np.asarray(begin, complex)
    if not s.size:
        return []
    with np.errstate(all="ignore"):
        before: Complex = np.asarray(s * (1.0 + 1e-6) + 1e-30)
        here, there, step = of(s), of(before), s
        for _ in range(STEPS_TO_ROOT):
            step = here * (s - before) / (here - there)
            moves = np.abs(step) > 4e-16 * np.abs(s)
            if not moves.any():
                break
            before, there = np.where(moves, s, before), np.where(moves, here, there)
            s = np.where(moves, s - step, s)
            here = of(s)
        beside = s + BESIDE * np.abs(s)
        settled = np.isfinite(s) & (np.abs(step) <= SETTLED_ROOT * np.abs(s)) & (np.abs(here) <= ROOT * np.abs(of(beside)))
    return [complex(one) for one in s[settled].tolist()]
