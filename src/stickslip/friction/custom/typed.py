"""Check what a user types: the evolution of states, such as "dz/dt = v - z*v/d", where a state is steady, and samples of a formula.

Where slip begins, at many slip rates, a formula must be finite, not negative, and have derivatives.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.friction.contract import MOST_STATES
from stickslip.friction.formula.expression import RATE, SLIP, Expression, Parameter, depends_on
from stickslip.friction.formula.functions import evaluate_nodes
from stickslip.friction.formula.text import RESERVED, quoted

EXAMPLE = '"dz/dt = (1 - z)/tau"'
_EQUATION = re.compile(r"\s*d\s*([A-Za-z_]\w{0,39})\s*/\s*dt\s*=(?!=)(.*)", re.DOTALL)
_NEXT = re.compile(r",\s*d\s*[A-Za-z_]\w*\s*/\s*dt\s*=")
"""The beginning of a second equation after a comma."""
MAGNITUDES_OF_STATE = np.geomspace(1e-18, 1e18, 145)
"""A steady state is sought between these magnitudes, in the unit of the state."""
STATES = np.concatenate((-MAGNITUDES_OF_STATE[::-1], [0.0], MAGNITUDES_OF_STATE))
ROUNDS, SETTLED = 200, 1e-14
"""Two states must settle within this many rounds; they have settled when neither changes by more than this (relative, 1)."""
HALVINGS_OF_FLOATS = 200
"""After this many halvings an interval between two floats cannot be smaller."""


def split(text: str) -> tuple[str, ...]:
    """Return the parts of a text, one for each state, separated by semicolons or line breaks."""
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


def steady(changes: Sequence[Callable[..., Floats]], many: int) -> Floats | None:
    """Return the steady values of one or two states in each of many cases, shape (states, cases); None if one has none.

    The rates of change are functions of the places of cases and of all states. Each state in turn takes its steady value while the
    other is held, until nothing changes any more in any case; a case that has settled is left as it is.
    """
    states, open_ = np.zeros((len(changes), many)), np.arange(many)
    for _ in range(ROUNDS):
        before = states[:, open_]
        for n, change in enumerate(changes):
            found = _steady(partial(_with_others, change, open_, states[:, open_], n), len(open_))
            if found is None:
                return None
            states[n, open_] = found
        if len(changes) == 1:
            return states
        settled = np.isclose(states[:, open_], before, rtol=SETTLED, atol=0.0).all(axis=0)
        open_ = open_[~settled]
        if not len(open_):
            return states
    return None


def _with_others(change: Callable[..., Floats], cases: NDArray[np.int64], states: Floats, n: int, one: Floats) -> Floats:
    """Return a rate of change for many values of state n, with the other state as it is."""
    return change(cases, *states[:n], one, *states[n + 1 :])


def _steady(change: Callable[[Floats], Floats], many: int) -> Floats | None:
    """Return in each case the stable steady state nearest 0: its rate of change falls through zero as the state grows.

    The state returns there after a disturbance. If the rate of change is zero at every state, the result is 0. The result is None
    if there is a case without any.
    """
    states = STATES[:, None]
    with np.errstate(all="ignore"):
        sign = np.sign(np.broadcast_to(change(states), (len(STATES), many)))
        at_zero = (sign == 0.0).all(axis=0) | (sign[len(MAGNITUDES_OF_STATE)] == 0.0)
        falls, exact = (sign[:-1] > 0.0) & (sign[1:] < 0.0), sign == 0.0
        if not (at_zero | falls.any(axis=0) | exact.any(axis=0)).all():
            return None
        k, other = (np.where(mask, abs(states[: len(mask)]), np.inf).argmin(axis=0) for mask in (falls, exact))
        low, high = STATES[k], STATES[k + 1]
        for _ in range(HALVINGS_OF_FLOATS):
            middle = 0.5 * (low + high)
            cuts = (low < middle) & (middle < high)
            if not cuts.any():
                break  # no float lies between them
            rises = np.broadcast_to(change(middle) > 0.0, (many,))
            low, high = np.where(cuts & rises, middle, low), np.where(cuts & ~rises, middle, high)
    return np.where(at_zero, 0.0, np.where(falls.any(axis=0), high, STATES[other]))


LARGEST_RATE = 10.0
"""Formulas are checked up to this slip rate (m/s): earthquakes and machines hardly exceed it."""
TOLERANCE = 1e-12
"""A friction coefficient below zero by no more than this (no unit) counts as rounding of zero."""


def check_samples(
    tree: Expression,
    numbers: Mapping[str, float],
    slip: float | None = None,
    *,
    states: Sequence[str] = (),
    negative: bool = False,
) -> None:
    """Raise InputError if the formula is negative, is not finite or has no derivative at a sample.

    The samples are slip rates from 0 to LARGEST_RATE at one `slip` (m), where a run begins: what friction is at other slips is left
    to the run, which ends where friction falls below zero. Without `slip` parts that contain it are left out, as are those with
    one of the states, parameters of those names. `negative` allows negative values.
    """
    v = samples(LARGEST_RATE) if depends_on(tree, RATE) else np.zeros(1)
    left_out = [*map(Parameter, states), *([SLIP] if slip is None else [])]
    u = 0.0 if slip is None else slip
    with np.errstate(all="ignore"):
        found = evaluate_nodes(tree, dict(numbers) | dict.fromkeys(states, 0.0), u, v)
        _check_constants({node: value for node, value in found.items() if not depends_on(node, SLIP)}, states)
        found = {node: value for node, value in found.items() if not any(depends_on(node, one) for one in left_out)}
        values = np.broadcast_to(found.get(tree, 0.0), v.shape)
        if negative:
            values = np.abs(values)
        finite = np.isfinite(values)
        worst = int(np.argmin(values)) if finite.all() else int(np.argmin(finite))
        if not values[worst] >= -TOLERANCE or not finite[worst]:
            what = f"is {values[worst]:.3g}" if finite[worst] else "is not a finite number"
            place = f"at u = {u:.4g} m, v = {v[worst]:.4g} m/s it {what}"
            cure = "; slip begins at v = 0, and friction there is the static strength" if v[worst] == 0.0 else ""
            if u < 0.0:
                cure = '; with counts="path" u is the length of the slip path, which is never negative'
            wanted = "the rate of change must be a finite number" if negative else "friction must be a number >= 0"
            raise InputError(f"{wanted}, but {place}{'' if negative else cure}")
    for node in found:
        if node.operation in ("sqrt", "log", "pow") and (depends_on(node, SLIP) or depends_on(node, RATE)):
            _check_argument(node, np.broadcast_to(found[node.arguments[0]], v.shape), u, v)


def samples(largest: float) -> NDArray[np.float64]:
    """Return 0 and sample points up to `largest`: evenly spaced ones, and a geometric progression from 1e-9 `largest`."""
    return np.unique(np.concatenate(([0.0], np.geomspace(1e-9 * largest, largest, 55), np.linspace(0.0, largest, 51))))


def _check_constants(found: Mapping[Expression, Any], states: Sequence[str]) -> None:
    """Raise InputError for a part without u and v that is not finite, such as 0/0, even if the formula's value is finite.

    Parts that depend on states have their values at state 0, because a law must be able to start there.
    """
    for node, value in found.items():
        if np.ndim(value) == 0 and not np.isfinite(value):
            at = " and ".join(f"{name} = 0" for name in states if depends_on(node, Parameter(name)))
            cure = f": write log(1 + {quoted(node.arguments[0])[1:-1]})" if node.operation == "log" else ""
            where = f" at {at}, the healed state, in which friction must be finite{cure}" if at else ""
            raise InputError(f"the part {quoted(node)} is not a finite number: it is {value:g}{where}")


def _check_argument(node: Expression, values: NDArray[np.float64], u: float, v: NDArray[np.float64]) -> None:
    bad = ~(values > 0.0)
    if bad.any():
        i = int(np.argmax(bad))
        where = f"at u = {u:.4g} m, v = {v[i]:.4g} m/s it is {values[i]:.3g}"
        what = "the base of a power" if node.operation == "pow" else f"the argument of {node.operation}"
        raise InputError(
            f"{what}, {quoted(node.arguments[0])}, must stay above 0 to have derivatives, but {where}; add a small number to it"
        )
