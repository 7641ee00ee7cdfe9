"""Proofs for many contacts at once are those for each alone."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact.folds import certificate
from stickslip.contact.lowest_slope import lowest_slope, lowest_slopes
from stickslip.contact.slopes import pieces_of
from stickslip.contact.turn_search import PROVEN
from stickslip.contact.turns import find_turns
from stickslip.problem.resistance import Resistance

from .laws import S, Z

F = ss.friction


def contacts(kind: str) -> list[Resistance]:
    """Thirty contacts under laws of one kind: a law of one formula with folds or none, and points joined by lines."""
    rng = np.random.default_rng(3)
    if kind == "formula":
        text = "0.3 + d/(1 + (v/a)**2) + 0.02*exp(-((v - b)/w)**2)"
        scales = 10.0 ** rng.uniform(-3.0, 0.5, (30, 4))
        laws = [F.FromExpression(text, dict(zip("dabw", row, strict=True))) for row in scales.tolist()]
    else:
        rates = [np.cumsum(rng.uniform(0.1, 1.0, rng.integers(2, 9))) for _ in range(30)]
        laws = [
            F.PiecewiseLinearRate((0.0, *one.tolist()), tuple((0.6 - 0.05 * np.tanh(np.arange(len(one) + 1))).tolist()))
            for one in rates
        ]
    return [Resistance(law, Z, S * float(rng.uniform(0.1, 2.0)), 0.0) for law in laws]


@pytest.mark.parametrize("kind", ["formula", "points"])
def test_many_contacts_have_the_turns_of_each_alone(kind: str) -> None:
    many = contacts(kind)
    pieces = pieces_of(many)
    found = find_turns(pieces)
    for n, g in enumerate(many):
        alone, own = certificate(g), pieces.contact[found.cells.piece] == n
        ends = np.array([found.cells.low, found.cells.high]).T[own & (found.known == PROVEN)]
        assert len(ends) == len(alone.turns)
        assert all(low <= one[1] and one[0] <= high for (low, high), one in zip(ends.tolist(), alone.turns, strict=True))
        assert (found.known[own] != PROVEN).sum() == len(alone.undecided)
    assert (found.known == PROVEN).sum() > 10


@pytest.mark.parametrize("kind", ["formula", "points"])
def test_many_contacts_have_the_smallest_slope_of_each_alone(kind: str) -> None:
    many = contacts(kind)
    for g, found in zip(many, lowest_slopes(many), strict=True):
        alone = lowest_slope(g)
        assert found.verdict == alone.verdict == "proven"
        assert found.at_least <= alone.at_most
        assert alone.at_least <= found.at_most
        assert found.slope == pytest.approx(alone.slope, rel=1e-14, abs=1e-14 * Z)
