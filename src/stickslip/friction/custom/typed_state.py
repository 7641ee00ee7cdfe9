"""Read the evolution of a state that a user types, such as "dz/dt = v - z*v/d", and find where the state is steady."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.friction.formula.parse import RESERVED

EXAMPLE = '"dz/dt = (1 - z)/tau"'
_EQUATION = re.compile(r"\s*d\s*([A-Za-z_]\w{0,39})\s*/\s*dt\s*=(?!=)(.*)", re.DOTALL)
SIZES = np.geomspace(1e-18, 1e18, 145)
"""Magnitudes between which a steady state is looked for, in the unit of the state."""
STATES = np.concatenate((-SIZES[::-1], [0.0], SIZES))
HALVINGS = 200
"""Number of halvings after which an interval between two floats cannot be smaller."""


def read_evolution(text: str, taken: tuple[str, ...]) -> tuple[str, str]:
    """Return the name of the state and the formula of its rate of change. Raise InputError if the text is no such equation."""
    found = _EQUATION.fullmatch(text)
    if found is None:
        raise InputError(f"evolution: {ascii(text)[:60]} must be an equation such as {EXAMPLE}")
    name = found[1]
    if name in RESERVED or name in taken:
        raise InputError(f"evolution: the state cannot be called {name}, which is taken; name it as in {EXAMPLE}")
    return name, found[2].strip()


def steady(change: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> float | None:
    """Return the state nearest 0 at which the rate of change of the state passes through zero as the state grows, or None.

    The state returns there after a disturbance. Where the rate of change is zero at every state, that is 0.
    """
    with np.errstate(all="ignore"):
        sign = np.sign(np.broadcast_to(change(STATES), STATES.shape))
        if (sign == 0.0).all() or sign[len(SIZES)] == 0.0:
            return 0.0
        falls = np.flatnonzero((sign[:-1] > 0.0) & (sign[1:] < 0.0))
        exact = np.flatnonzero(sign == 0.0)
        if not len(falls):
            return float(STATES[exact[np.argmin(abs(STATES[exact]))]]) if len(exact) else None
        k = falls[np.argmin(abs(STATES[falls]))]
        low, high = STATES[k], STATES[k + 1]
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            if float(change(np.array([middle]))[0]) > 0.0:
                low = middle
            else:
                high = middle
        return float(high)
