"""Read the evolution of states that a user types, such as "dz/dt = v - z*v/d", and find where a state is steady."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from functools import partial

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import MOST_STATES
from stickslip.friction.formula.parse import RESERVED

EXAMPLE = '"dz/dt = (1 - z)/tau"'
_EQUATION = re.compile(r"\s*d\s*([A-Za-z_]\w{0,39})\s*/\s*dt\s*=(?!=)(.*)", re.DOTALL)
_NEXT = re.compile(r",\s*d\s*[A-Za-z_]\w*\s*/\s*dt\s*=")
"""The beginning of a second equation after a comma."""
SIZES = np.geomspace(1e-18, 1e18, 145)
"""Magnitudes between which a steady state is looked for, in the unit of the state."""
STATES = np.concatenate((-SIZES[::-1], [0.0], SIZES))
ROUNDS, SETTLED = 200, 1e-14
"""Largest number of rounds in which two states settle, and the relative change of both (1) with which they have."""
HALVINGS = 200
"""Number of halvings after which an interval between two floats cannot be smaller."""


def split(text: str) -> tuple[str, ...]:
    """Return the parts of a text, one for each state, between which there are semicolons or line breaks."""
    return tuple(part.strip() for part in re.split(r"[;\n]", text) if part.strip())


def read_evolution(text: str, taken: tuple[str, ...]) -> dict[str, str]:
    """Return the formulas of the rates of change of the states by name. Raise InputError if the text is not made of equations."""
    equations: dict[str, str] = {}
    for part in split(text) or ("",):
        found = _EQUATION.fullmatch(part)
        if found is None:
            raise InputError(f"evolution: {ascii(part)[:60]} must be an equation such as {EXAMPLE}")
        if _NEXT.search(found[2]):
            raise InputError('evolution: two equations are separated by a semicolon, as in "dz/dt = -z*v/d; dy/dt = -y*v/e"')
        name = found[1]
        if name in RESERVED or name in taken or name in equations:
            raise InputError(f"evolution: the state cannot be called {name}, which is taken; name it as in {EXAMPLE}")
        equations[name] = found[2].strip()
    if len(equations) > MOST_STATES:
        raise InputError(f"evolution: a law has at most {MOST_STATES} states, this one has {len(equations)}")
    return equations


def steady(changes: Sequence[Callable[..., Floats]]) -> tuple[float, ...] | None:
    """Return the steady values of one or two states, whose rates of change are functions of all states, or None.

    Each state in turn takes the value at which it is steady while the other is held, until nothing changes any more.
    """
    states = [0.0] * len(changes)
    for _ in range(ROUNDS):
        before = tuple(states)
        for n, change in enumerate(changes):
            found = _steady(partial(_with_others, change, states, n))
            if found is None:
                return None
            states[n] = found
        if np.allclose(states, before, rtol=SETTLED, atol=0.0) or len(states) == 1:
            return tuple(states)
    return None


def _with_others(change: Callable[..., Floats], states: list[float], n: int, one: Floats) -> Floats:
    """Return a rate of change for many values of state n, with the other state as it is."""
    return change(*states[:n], one, *states[n + 1 :])


def _steady(change: Callable[[Floats], Floats]) -> float | None:
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
