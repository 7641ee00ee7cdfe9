"""Critical values of a parameter: there the contact equation changes from one solution to several.

Source: Campillo et al. 1996, section 3: g'(0) = Z + S mu'(0) vanishes at alpha_c. In general the smallest g' over all slip rates
vanishes at a critical value. A law names the parameter whose critical value `uniqueness` reports (`critical`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from stickslip.contact.branches import resistance
from stickslip.contact.folds import Verdict, certificate
from stickslip.contact.lowest_slope import lowest_slope, lowest_slopes
from stickslip.contact.roots import sign_change, sign_changes
from stickslip.foundation.arguments import NamesAttributes, for_users
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief_repr
from stickslip.problem import Parameter, Problem, Resistance, check_problem

Regime = Literal["regular", "irregular"]

_DECADES, _PER_DECADE = 9, 4
"""Decades that the search covers on either side of the present value, and its steps in each decade."""
_STEPS = tuple(2.0**-k for k in range(50, 25, -4))
"""Relative distances from a critical value for a proof of the regimes on both sides, the smallest first."""
_NEAR, _STRAIGHT = 1e-6, 1e-9
"""A margin may be a straight line if it differs from one by no more than this: at the zero of a line drawn from far away, where
rounding moves the zero, and at the zero of a line drawn from nearby."""
_ROUGH = 1e-2
"""Tolerance of a quick search for the smallest g': it finds the right minimum, unless another one is nearly as low."""


@dataclass(frozen=True)
class Critical(NamesAttributes):
    """Critical values of one parameter of a problem, where the regime changes, with everything else fixed; SI units, ascending.

    `regimes` has one more entry than `values`: the regime below the first value, between neighbours, and above the last.
    """

    parameter: str
    unit: str
    present: float
    values: tuple[float, ...]
    regimes: tuple[Regime, ...]
    searched: tuple[float, float]
    """Smallest and largest value that the search has covered; nothing is known outside."""
    certificate: Verdict = "not decided"
    """"proven": interval arithmetic shows that the regime differs between the two ends of each of `enclosures`, and that it is the
    stated one at the present value. "not decided": interval arithmetic fails to show one of these. It is never proven that there
    are no further changes between the values that were examined."""
    enclosures: tuple[tuple[float, float] | None, ...] = ()
    """For each of `values`, a number below and one above it with provably different regimes; None if the proof fails."""

    __repr__ = brief_repr

    @property
    def value(self) -> float | None:
        """The critical value nearest to the present value, or None if none was found."""
        return min(self.values, key=lambda one: abs(one - self.present), default=None)


def steepest_fall(g: Resistance) -> tuple[float, float]:
    """Return the slip rate (m/s) with the smallest g', and this g' (Pa s/m), to the rounding of g'."""
    lowest = lowest_slope(g)
    return lowest.rate, lowest.slope


def margin(problem: Problem, law_slip: float | None = None) -> float:
    """Return the smallest g'/Z over all slip rates at a law slip (m; default: the initial one).

    It is negative in the irregular regime, and -inf if friction steps down as slip begins. Raises InputError for a block.
    """
    return margins([resistance(problem, law_slip)])[0]


def margins(contacts: Sequence[Resistance], **tolerance: float) -> list[float]:
    """Return the `margin` of each contact, under laws of one kind; the `tolerance` is that of `lowest_slopes`."""
    found = [-math.inf if g.law.static_excess > 0.0 else 1.0 for g in contacts]
    searched = [k for k, g in enumerate(contacts) if g.law.depends_on_rate and found[k] > 0.0]
    for k, lowest in zip(searched, lowest_slopes([contacts[k] for k in searched], **tolerance), strict=True):
        found[k] = lowest.slope / contacts[k].damping
    return found


def check_no_contact_mass(problem: Problem, where: str) -> None:
    """Raise InputError, which begins with `where`, for a slab with a contact mass; a block is refused by `resistance`."""
    resistance(problem)
    if problem.body.has_inertia:
        raise InputError(f"{where}: the contact mass makes the slip rate a state, the motion is unique whatever the law")


def critical_normal_stress(g: Resistance) -> float | None:
    """Return the critical normal stress (Pa), Z / max(-dmu/dv), or None: above it the contact is irregular.

    There is none if friction never falls with the slip rate, or if it steps down as slip begins: the contact is then irregular
    under every normal stress.
    """
    if g.law.static_excess > 0.0 or not g.law.depends_on_rate:
        return None
    weakening = (g.damping - steepest_fall(g)[1]) / g.normal
    return g.damping / weakening if weakening > 1e-12 * g.damping / g.normal else None


@for_users
def critical_value(problem: Problem, name: str, law_slip: float | None = None) -> Critical:
    """Find the critical values of one parameter to rounding: there the contact equation changes between one solution and several.

    The problem's body is a slab without contact mass. The name is such as "alpha", "rate.alpha", "body.normal_stress" or
    "initial.slip"; `law_slip` (m) is the slip as the law counts it, the initial one by default. The search goes from the present
    value by factors up to 1e9 both ways (from 1e-9 to 1e9 if it is 0), as far as the problem accepts them. Two changes within one
    step, a factor of 10^(1/4), can hide each other.

    Raises InputError if the name is no parameter, if the parameter is a whole number, or if the body is a block or has a contact
    mass: inertia then makes the slip rate a state, and the motion is unique whatever the parameters are.
    """
    check_problem("critical_value", problem)
    found = problem.parameters[name]
    check_no_contact_mass(problem, "critical value")
    if found.declared.whole:
        raise InputError(f"critical value: {found.name} is whole and cannot be varied continuously")

    def margins_at(values: Iterable[float]) -> list[float]:
        return margins([resistance(found.put(value), law_slip) for value in values])

    points = sorted([*_walk(found, -1), found.value, *_walk(found, 1)])
    falls = [one < 0.0 for one in margins_at(points)]
    pairs = [ends for ends, (one, other) in zip(pairwise(points), pairwise(falls), strict=True) if one != other]
    values = sign_changes(lambda wanted: margins_at(value for _, value in wanted), pairs)
    changes = [falls[0], *(after for before, after in pairwise(falls) if before != after)]
    regimes: tuple[Regime, ...] = tuple("irregular" if falls else "regular" for falls in changes)
    enclosures = tuple(_proven_change(found, value, law_slip) for value in values)
    verdict: Verdict = "proven" if None not in enclosures else "not decided"
    if _proven(found, found.value, law_slip) != ("irregular" if falls[points.index(found.value)] else "regular"):
        verdict = "not decided"
    return Critical(found.name, found.unit, found.value, tuple(values), regimes, (points[0], points[-1]), verdict, enclosures)


def nearest_critical(problem: Problem, name: str, law_slip: float | None = None) -> float | None:
    """Return the critical value of a parameter that is nearest to the present value, to 15 digits, or None if there is none.

    `critical_value` finds all of them, and proves them. Here the search goes both ways at once, and ends at the first change.
    """
    try:
        found = problem.parameters[name]
    except InputError as error:
        raise InputError(f"{type(problem.friction).__name__}: critical: {error}") from None

    def margins_at(values: Iterable[float], **tolerance: float) -> list[float]:
        return margins([resistance(found.put(value), law_slip) for value in values], **tolerance)

    def roughly(value: float) -> float:
        try:
            return margins_at([value], tolerance=_ROUGH)[0]
        except InputError:
            return math.nan

    here = margins_at([found.value])[0]
    zeros = _zeros_if_straight((found.value, here), roughly)
    if zeros is not None:
        return next((float(f"{zero:.15g}") for zero in zeros), None)
    sides = [[found.value, *_walk(found, way)] for way in (-1, 1)]
    falls = [[one < 0.0 for one in margins_at(side)] for side in sides]
    steps = [(k, n) for n, side in enumerate(falls) for k in range(1, len(side)) if side[k] != side[0]]
    if not steps:
        return None
    k, n = min(steps)
    return float(f"{sign_change(lambda value: margins_at([value])[0], *sorted(sides[n][k - 1 : k + 1])):.15g}")


def _zeros_if_straight(here: tuple[float, float], margin_at: Callable[[float], float]) -> list[float] | None:
    """Return the zeros of a margin that is straight in a parameter or in its inverse, at most one; None if it is neither.

    `here` is the present value and the margin there. A margin is straight if a third one lies on the line through two others. If
    the problem refuses a value, its margin is not a number.
    """
    if not (1e-100 < abs(here[0]) < 1e100 and math.isfinite(here[1])):
        return None
    for power in (-1, 1):
        value, level = here
        for _ in range(3):
            step = value**power
            slope = (margin_at((2.0 * step) ** power) - level) / step
            zero = step - level / slope if slope else math.inf
            missed = margin_at(zero**power) if zero else math.nan
            if math.isnan(missed):  # the line has no zero among the values that are allowed
                third = margin_at((4.0 * step) ** power) - level
                if abs(third - 3.0 * step * slope) <= _NEAR * abs(third):
                    return []
                break
            if abs(missed) <= _STRAIGHT:
                return [float((zero - missed / slope) ** power)]
            if abs(missed) > _NEAR * max(1.0, abs(level)):
                break
            value, level = zero**power, missed
    return None


def _proven(found: Parameter[Problem], value: float, law_slip: float | None) -> Regime | None:
    """Return the proven regime at a value of a parameter, or None if it is not decided."""
    try:
        g = resistance(found.put(value), law_slip)
    except InputError:
        return None
    if not g.law.depends_on_rate:
        return "regular"
    return "irregular" if g.law.static_excess > 0.0 else certificate(g).regime


def _proven_change(found: Parameter[Problem], value: float, law_slip: float | None) -> tuple[float, float] | None:
    """Return the narrowest tried interval around a critical value whose ends have provably different regimes, or None."""
    for step in _STEPS:
        low, high = sorted((value * (1.0 - step), value * (1.0 + step)))
        regimes = _proven(found, low, law_slip), _proven(found, high, law_slip)
        if None not in regimes and regimes[0] != regimes[1]:
            return low, high
    return None


def _walk(found: Parameter[Problem], way: int) -> list[float]:
    """Return values on one side of the present value, away from it, up to the last one that the problem accepts.

    That one counts, because the regime may change there.
    """
    walked = [found.value]

    def taken(value: float) -> bool:
        try:
            found.put(value)
        except InputError:
            return False
        return True

    for value in _values(found.value, way):
        if not taken(value):
            edge = sign_change(lambda x: 1.0 if taken(x) else -1.0, walked[-1], value) if value else walked[-1]
            walked += [one for one in (float(f"{edge:.15g}"), edge) if one != walked[-1] and taken(one)][:1]
            break
        walked.append(value)
    return walked[1:]


def _values(present: float, way: int) -> list[float]:
    """Return the values to examine on one side: a geometric progression away from the present value.

    A progression towards zero ends with 0 itself. A present value of 0 has progressions of both signs.
    """
    count = _DECADES * _PER_DECADE
    if present == 0.0:
        return [way * 10.0 ** (k / _PER_DECADE) for k in range(-count, count + 1)]
    towards_zero = way * present < 0.0
    sign = -1 if towards_zero else 1
    return [present * 10.0 ** (sign * k / _PER_DECADE) for k in range(1, count + 1)] + ([0.0] if towards_zero else [])
