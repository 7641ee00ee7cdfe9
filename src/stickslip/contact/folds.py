"""Folds of the resistance g(v) = Z v + S mu(v), with a proof by bounds of g' and g''.

The proofs are those of `contact.turns`; here they meet a contact.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import ClassVar, Literal

from stickslip.contact.slopes import FASTEST_BOUNDED, MOST_EVALUATIONS, pieces_of
from stickslip.contact.turn_search import PROVEN
from stickslip.contact.turns import find_turns, folds_of
from stickslip.foundation.errors import InputError
from stickslip.foundation.show import brief_repr
from stickslip.problem import Resistance

Verdict = Literal["proven", "not decided"]
"""proven: by interval arithmetic. not decided: proven except on some intervals of slip rates."""
Interval = tuple[float, float]

MOST_FOLDS = 1024
"""Largest number of folds that a contact may have. Friction that rises and falls with the slip rate for ever has any number."""
_MOST_SHOWN = 6
"""Largest number of folds that a sentence names; more would make it unreadable."""


@dataclass(frozen=True)
class Fold:
    """A slip rate (m/s) at which g changes between rising and falling, and the load (Pa) there."""

    rate: float
    load: float
    enclosure: Interval | None = None
    """Interval of slip rates (m/s) where g is proven to turn exactly once; None if that is not decided."""

    load_unit: str = field(default="Pa", repr=False)
    """Unit of loads of the body, which decides the other units."""

    units: ClassVar = {"rate": "slip_rate", "load": "load", "enclosure": "slip_rate"}
    __repr__ = brief_repr


@dataclass(frozen=True)
class Certificate:
    """A proof of the turns of g at slip rates from 0 to `reach`, ascending; intervals are of slip rates (m/s)."""

    verdict: Verdict
    rates: tuple[float, ...] = ()
    """Slip rates where g turns: proven turns, and changes of sign of g' within an undecided interval."""
    turns: tuple[Interval, ...] = ()
    """Intervals that hold exactly one change of sign of g' each; outside them and `undecided` there is none."""
    undecided: tuple[Interval, ...] = ()
    """Intervals without a proof of a turn or of its absence."""
    rises_at_rest: bool | None = None
    """True if g rises at 0+, None if that is not decided."""
    evaluations: int = 0
    """Number of bounds of g', on cells and at single rates."""
    reach: float = FASTEST_BOUNDED
    """Largest slip rate (m/s) of the search: 1e30, or less if g turns more than MOST_FOLDS times."""

    @property
    def regime(self) -> Literal["regular", "irregular"] | None:
        """The regime: regular if g is proven to rise at every slip rate, irregular if to fall at one; None if undecided."""
        if self.turns or self.rises_at_rest is False:
            return "irregular"
        return "regular" if self.verdict == "proven" else None

    def enclosure(self, rate: float) -> Interval | None:
        """Return the interval around a fold with a proof that g turns exactly once in it; None if there is none."""
        return next((one for one in self.turns if one[0] <= rate <= one[1]), None)


@lru_cache(maxsize=64)
def certificate(g: Resistance, budget: int = MOST_EVALUATIONS) -> Certificate:
    """Prove where g' changes its sign, with at most `budget` evaluations.

    Raises InputError if the law has a state, because the slip rate is then no root of the contact equation, or if friction falls at
    least as fast as Z v rises even at the fastest rate of the search, unless Z is 0.
    """
    reach = FASTEST_BOUNDED
    pieces = pieces_of([g])
    found = find_turns(pieces, budget, MOST_FOLDS)
    if len(found.known) > MOST_FOLDS:
        reach = g.reach if g.damping else FASTEST_BOUNDED
        pieces = pieces_of([g], reach)
        found = find_turns(pieces, budget, MOST_FOLDS)
    if len(found.known) > MOST_FOLDS:
        raise InputError(
            f"{type(g.law).__name__}: g = Z v + S mu(v) turns more than {MOST_FOLDS} times up to {reach:.3g} {g.rate_unit}: "
            "friction that rises and falls so often with the slip rate cannot be followed; make its features wider, or their "
            "height smaller"
        )
    if found.at_end[-1] < 0 and reach == FASTEST_BOUNDED and g.damping:
        fastest = f"{FASTEST_BOUNDED:.3g} {g.rate_unit}"
        raise InputError(f"{type(g.law).__name__}: friction still falls at least as fast as Z v rises at {fastest}")
    ends = list(zip(found.cells.low.tolist(), found.cells.high.tolist(), strict=True))
    sure = [end for end, known in zip(ends, found.known.tolist(), strict=True) if known == PROVEN]
    open_ = [end for end, known in zip(ends, found.known.tolist(), strict=True) if known != PROVEN]
    at_rest = None if found.at_rest[0] == 0 else bool(found.at_rest[0] > 0)
    rates = tuple(folds_of(pieces, found)[0].tolist())
    if reach < FASTEST_BOUNDED and rates and g.slope(reach) <= 0.0:
        rates, sure = rates[:-1], sure[:-1]  # the last branch counts as endless, and its end is at a load that is never reached
    return Certificate("not decided" if open_ else "proven", rates, tuple(sure), tuple(open_), at_rest, found.evaluations, reach)


def sentence(g: Resistance, proof: Certificate, folds: tuple[Fold, ...]) -> str:
    """Return a sentence on the proof of the folds, with a leading space; "" if friction does not depend on the slip rate."""
    if not g.law.depends_on_rate:
        return ""
    if proof.verdict == "not decided":
        places = _listed([f"between {low:.6g} and {high:.6g} {g.rate_unit}" for low, high in proof.undecided])
        return f" Interval arithmetic does not decide whether g = Z v + S mu(v) turns {places}; elsewhere its turns are proven."
    reach = f"up to {proof.reach:.3g} {g.rate_unit}"
    if proof.reach < FASTEST_BOUNDED:
        reach += f", which loads up to {g.largest_load:.3g} {g.load_unit} do not exceed; at faster ones it goes on turning"
    if not proof.turns:
        return f" Proven by interval arithmetic: g = Z v + S mu(v) rises at every slip rate above 0, {reach}."
    places = _listed([_place(fold, g.rate_unit) for fold in folds])
    return f" Proven by interval arithmetic: g = Z v + S mu(v) turns only at {places}, of all slip rates {reach}."


def _place(fold: Fold, unit: str) -> str:
    low, high = fold.enclosure or (fold.rate, fold.rate)
    return f"{fold.rate:.9g} {unit}" + (f" (to within {high - low:.1g})" if high > low else "")


def _listed(places: list[str]) -> str:
    shown = places[:_MOST_SHOWN] + ([f"{len(places) - _MOST_SHOWN} more places"] if len(places) > _MOST_SHOWN else [])
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
