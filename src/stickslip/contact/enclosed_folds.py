"""Folds with proven bounds, and a sentence that says what is proven of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from stickslip.contact.branches import within
from stickslip.contact.equation import Resistance
from stickslip.contact.folds.certified import Certificate, Interval, sign_of
from stickslip.contact.folds.slope_bounds import FASTEST, Cells, SlopeBounds
from stickslip.foundation.brief_repr import brief_repr

_HALVINGS = np.exp2(np.arange(-52.0, 0.0))
"""Relative distances from a fold at which a proof of the sign of g' is tried, the smallest first."""
_MOST_SHOWN = 6
"""Largest number of folds that a sentence names; more would make it unreadable."""


@dataclass(frozen=True)
class Fold:
    """A slip rate (m/s) at which g changes between rising and falling, and the load (Pa) there."""

    rate: float
    load: float
    enclosure: Interval | None = None
    """Slip rates (m/s) between which g is proven to turn exactly once; None if that is not decided."""

    units: ClassVar = {"rate": "m/s", "load": "Pa", "enclosure": "m/s"}
    __repr__ = brief_repr


def enclosure(g: Resistance, proof: Certificate, rate: float) -> Interval | None:
    """Return the narrowest interval found around a fold in which g is proven to turn exactly once; None if there is none."""
    turn = next((one for one in proof.turns if within(rate, one)), None)
    return None if turn is None else _sharpened(g, turn, rate)


def _sharpened(g: Resistance, turn: Interval, rate: float) -> Interval:
    """Move both ends of an interval towards the fold as far as the signs of g' at the ends are proven to stay the same."""
    low, high = turn
    if low == high:
        return turn
    bounds = SlopeBounds(g)
    places = np.clip(rate * np.stack((1.0 - _HALVINGS, 1.0 + _HALVINGS)), low, high)
    places = np.column_stack(((low, high), places))
    piece = np.repeat(bounds.piece_from(np.array([low])), places.size)
    signs = sign_of(bounds(Cells(places.ravel(), places.ravel(), piece))[0]).reshape(places.shape)
    same = signs == signs[:, :1]
    return float(places[0][same[0]].max()), float(places[1][same[1]].min())


def sentence(g: Resistance, proof: Certificate, folds: tuple[Fold, ...]) -> str:
    """Return a sentence on what is proven of the folds, with a leading space; "" if friction does not depend on the slip rate."""
    if not g.law.depends_on_rate:
        return ""
    if proof.verdict == "searched":
        return " The slope of g = Z v + S mu(v) was searched on a grid of slip rates, without proof: it may miss narrow features."
    if proof.verdict == "not decided":
        places = _listed([f"between {low:.6g} and {high:.6g} m/s" for low, high in proof.undecided])
        return f" Interval arithmetic does not decide whether g = Z v + S mu(v) turns {places}; elsewhere its turns are proven."
    reach = f"up to {FASTEST:g} m/s"
    if not proof.turns:
        way = "rises" if proof.rises_at_rest else "falls"
        return f" Proven by interval arithmetic: g = Z v + S mu(v) {way} at every slip rate above 0, {reach}."
    places = _listed([_place(fold) for fold in folds])
    return f" Proven by interval arithmetic: g = Z v + S mu(v) turns only at {places}, of all slip rates {reach}."


def _place(fold: Fold) -> str:
    low, high = fold.enclosure or (fold.rate, fold.rate)
    return f"{fold.rate:.9g} m/s" + (f" (to within {high - low:.1g})" if high > low else "")


def _listed(places: list[str]) -> str:
    shown = places[:_MOST_SHOWN] + ([f"{len(places) - _MOST_SHOWN} more places"] if len(places) > _MOST_SHOWN else [])
    return " and ".join(filter(None, (", ".join(shown[:-1]), shown[-1])))
