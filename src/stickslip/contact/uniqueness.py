"""Whether the contact equation has one solution, what its folds are, and what the chosen rule does there.

Source: Campillo et al. 1996, section 3: the set K of Fig. 3, regular and irregular, and the jumps of Fig. 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stickslip.bodies import ElasticSlab
from stickslip.contact.branches import Branch, branches_of, rate_on, rates_at
from stickslip.contact.resistance import Resistance, resistance
from stickslip.contact.selection import RULES, SelectionTable
from stickslip.errors import InputError
from stickslip.problem import Problem


@dataclass(frozen=True)
class Fold:
    """A slip rate (m/s) at which g turns, and the load (Pa) there."""

    rate: float
    load: float


@dataclass(frozen=True)
class Jump:
    """What the selection rule does as the load (Pa) slowly passes a level: the slip rates (m/s) before and after."""

    rate_before: float
    rate_after: float
    load: float
    direction: Literal["up", "down"]


@dataclass(frozen=True)
class Uniqueness:
    """The answer of `uniqueness`. Loads in Pa, slip rates in m/s, all for slip forwards: backwards everything is mirrored."""

    regime: Literal["regular", "irregular"]
    rule: str
    summary: str
    critical_parameter: str | None = None
    """Which of the law's numbers has a critical value; it is irregular beyond it."""
    critical_value: float | None = None
    folds: tuple[Fold, ...] = ()
    jumps: tuple[Jump, ...] = ()
    window: tuple[float, float] | None = None
    """Loads between which more than one slip rate is admissible, as excess over the static strength (Pa)."""
    resistance: Resistance | None = None
    """The contact equation; None where inertia at the contact makes the slip rate a state."""
    branches: tuple[Branch, ...] = ()

    def admissible(self, load: float) -> NDArray[np.float64]:
        """Every slip rate (m/s) that solves the contact equation at a load (Pa), stick (0) and backward ones included, ascending.

        Raises InputError where the slip rate is a state: a block, or a contact with mass.
        """
        return self._solutions(load)[0]

    def stability(self, load: float) -> NDArray[np.bool_]:
        """Whether each of the `admissible` rates is stable: g rises there, or the contact sticks. A fold is not."""
        return self._solutions(load)[1]

    def _solutions(self, load: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
        if self.resistance is None:
            raise InputError("admissible slip rates: inertia makes the slip rate a state of its own, any value is possible")
        g = self.resistance
        forward, stable = rates_at(g, self.branches, load - g.strength)
        backward, mirrored = rates_at(g, self.branches, -load - g.strength)
        moving, kept = backward > 0.0, forward > (-1.0 if abs(load) <= g.strength else 0.0)
        rates = np.concatenate((-backward[moving][::-1], forward[kept]))
        return rates, np.concatenate((mirrored[moving][::-1], stable[kept]))


def uniqueness(problem: Problem, law_slip: float | None = None) -> Uniqueness:
    """Is the slip rate unique, at a law slip (m; default: the start)? Raises InputError as `contact.branches` does."""
    if not isinstance(problem.body, ElasticSlab):
        return Uniqueness("regular", problem.selection, _INERTIA.format(body="The block", rule=problem.selection))
    if problem.body.contact_mass > 0.0:
        return Uniqueness("regular", problem.selection, _INERTIA.format(body="The contact mass", rule=problem.selection))
    g = resistance(problem, law_slip)
    stable = branches_of(g)
    window = _window(stable)
    critical = problem.friction.critical_value(g.impedance, g.normal)
    jumps = _jumps(g, stable, RULES[problem.selection](g, stable)) if window else ()
    return Uniqueness(
        regime="irregular" if window else "regular",
        rule=problem.selection,
        summary=_summary(problem, critical, window, jumps),
        critical_parameter=critical[0] if critical else None,
        critical_value=critical[1] if critical else None,
        folds=_folds(g, stable),
        jumps=jumps,
        window=window,
        resistance=g,
        branches=stable,
    )


def _folds(g: Resistance, stable: tuple[Branch, ...]) -> tuple[Fold, ...]:
    ends = [end for b in stable for end in ((b.rate_from, b.excess_from), (b.rate_to, b.excess_to))]
    return tuple(Fold(rate, g.strength + excess) for rate, excess in ends if 0.0 < rate < np.inf)


def _window(stable: tuple[Branch, ...]) -> tuple[float, float] | None:
    """The loads with several solutions as excess (Pa): from the lowest fold to the highest, stick's end (0) counting as one."""
    lower = [b.excess_from for b in stable if b.rate_from > 0.0 or b.excess_from < 0.0]
    upper = [b.excess_to for b in stable if b.rate_to < np.inf]
    if stable[0].rate_from > 0.0 or stable[0].excess_from < 0.0:
        upper.append(0.0)
    return (min(lower), max(upper)) if lower else None


def _jumps(g: Resistance, stable: tuple[Branch, ...], table: SelectionTable) -> tuple[Jump, ...]:
    def rate(branch: int, excess: float) -> float:
        return 0.0 if branch < 0 else rate_on(g, stable[branch], excess)

    found: list[Jump] = []
    for i in range(-1, len(stable)):
        low, high = (-np.inf, table.stick_to) if i < 0 else (table.keep_from[i], table.keep_to[i])
        if low > high:
            continue
        if high < np.inf:
            beyond = float(np.nextafter(high, np.inf))
            found.append(Jump(rate(i, high), rate(table.climb(i, beyond), high), g.strength + high, "up"))
        if low > -np.inf:
            beyond = float(np.nextafter(low, -np.inf))
            found.append(Jump(rate(i, low), rate(table.descend(i, beyond), low), g.strength + low, "down"))
    return tuple(jump for jump in found if jump.rate_before != jump.rate_after)


_INERTIA = (
    "{body} has inertia: its slip rate is a state that changes continuously, and the motion is unique (regular) whatever the "
    "friction law. The selection rule ({rule}) has no effect."
)


def _summary(
    problem: Problem, critical: tuple[str, float] | None, window: tuple[float, float] | None, jumps: tuple[Jump, ...]
) -> str:
    """One paragraph for people."""
    law, rule = type(problem.friction).__name__, problem.selection
    bound = ""
    if critical:
        name, value = critical
        bound = f" The critical value is {name} = {value:.9g}; here {name} = {getattr(problem.friction, name):.9g}."
    if not problem.friction.depends_on_rate:
        reason = "friction does not depend on the slip rate and the impedance Z is positive"
        return f"{law}: regular. The slip rate is unique: {reason}. The selection rule ({rule}) has no effect.{bound}"
    if window is None:
        reason = "the resistance Z v + S mu(v) rises with the slip rate everywhere"
        return f"{law}: regular. The slip rate is unique: {reason}. The selection rule ({rule}) has no effect.{bound}"
    size = f"a window of {window[1] - window[0]:.6g} Pa that ends {_side(window[1])} the static strength"
    steps = "; ".join(
        f"{j.direction} from {j.rate_before:.6g} to {j.rate_after:.6g} m/s at a load of {j.load:.9g} Pa" for j in jumps
    )
    moves = f"jumps {steps}" if steps else "makes no jump"
    return f"{law}: irregular. Several slip rates solve the contact equation in {size}.{bound} The rule '{rule}' {moves}."


def _side(excess: float) -> str:
    return "at" if excess == 0.0 else f"{abs(excess):.6g} Pa {'above' if excess > 0.0 else 'below'}"
