"""Proofs as plain Python against the same proofs in compiled code, for every law of the slip rate and for laws drawn at random."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.contact import folds, proofs
from stickslip.contact.branches import branches_of
from stickslip.contact.equation import Resistance, resistance
from stickslip.contact.folds import certificate, lowest_slope, panels
from stickslip.friction import LAWS, FrictionLaw
from tests.engine.drawn import example_law

SLAB = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
EXAMPLES = [law for law in map(example_law, LAWS) if law.depends_on_rate and not law.states]


def random_law(seed: int) -> FrictionLaw:
    """A falling law with bumps and waves, some of them narrow."""
    rng = np.random.default_rng(seed)
    text = f"0.3 + {rng.uniform(0.1, 0.4)}/(1 + {10 ** rng.uniform(-1, 1)}*v**{rng.integers(1, 4)})"
    if rng.random() < 0.6:
        text += f" + {rng.uniform(-0.05, 0.05)}*exp(-((v - {10 ** rng.uniform(-2, 1)})/{10 ** rng.uniform(-3, 0)})**2)"
    if rng.random() < 0.3:
        text += f" + {rng.uniform(0.0, 0.02)}*sin({rng.uniform(1, 20)}*v)*exp(-v)"
    return ss.friction.FromExpression(text)


def by(patience: float, prove: Callable[[], Any], monkeypatch: pytest.MonkeyPatch) -> Any:
    """What a proof gives with so many bounds in plain Python, worked out anew."""
    monkeypatch.setattr(proofs._Patience, "left", patience)
    certificate.cache_clear()
    lowest_slope.cache_clear()
    folds._way_of.cache_clear()
    return prove()


def both(g: Resistance, prove: Callable[[Resistance], Any], monkeypatch: pytest.MonkeyPatch) -> tuple[Any, Any]:
    return by(10**6, lambda: prove(g), monkeypatch), by(0, lambda: prove(g), monkeypatch)


@pytest.mark.parametrize("law", [*EXAMPLES, *map(random_law, range(30))], ids=lambda law: law.kind)
def test_proofs_in_python_and_in_compiled_code_are_the_same(law: FrictionLaw, monkeypatch: pytest.MonkeyPatch) -> None:
    """Same verdict, same number of bounds, intervals that overlap, and the same folds to the last digit."""
    g = resistance(ss.Problem(SLAB, law, initial_excess=0.0))
    ours, theirs = both(g, certificate, monkeypatch)
    assert (ours.verdict, ours.rises_at_rest, ours.evaluations) == (theirs.verdict, theirs.rises_at_rest, theirs.evaluations)
    assert len(ours.turns) == len(theirs.turns)
    assert all(a[0] <= b[1] and b[0] <= a[1] for a, b in zip(ours.turns, theirs.turns, strict=True))
    assert branches_of(g, ours) == branches_of(g, theirs)
    one, other = both(g, lowest_slope, monkeypatch)
    assert one.verdict == other.verdict
    assert one.at_least <= other.at_most
    assert other.at_least <= one.at_most
    assert one.slope == pytest.approx(other.slope, rel=1e-14, abs=1e-14 * g.damping)


def test_panels_in_python_and_in_compiled_code_are_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    g = resistance(ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=0.0))
    ours, theirs = both(g, lambda g: panels(g, 0.0, 4.0), monkeypatch)
    np.testing.assert_allclose(ours, theirs, rtol=1e-15, atol=0.0)
    assert len(ours) > 2


def test_a_process_that_asks_for_many_proofs_compiles_them(monkeypatch: pytest.MonkeyPatch) -> None:
    g = resistance(ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=0.0))
    whole = by(10**6, lambda: certificate(g), monkeypatch)
    left = proofs._Patience.left
    assert left == 10**6 - whole.evaluations
    assert by(10, lambda: certificate(g), monkeypatch).evaluations == whole.evaluations
    assert proofs._Patience.left <= 0
    assert math.isfinite(lowest_slope(g).slope)


def test_panels_of_a_law_of_many_pieces_fit_in_both_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    """A law of 1200 pieces has a panel for each of them, more than are worked out in plain Python."""
    rates = np.linspace(0.0, 3.0, 1200)
    law = ss.friction.FromTable(friction=(0.6 - 0.1 * np.tanh(rates)).tolist(), rate=rates.tolist())
    g = resistance(ss.Problem(SLAB, law, initial_excess=0.0))
    ours, theirs = both(g, lambda g: panels(g, 0.0, 2.9), monkeypatch)
    np.testing.assert_array_equal(ours, theirs)
    assert len(ours) > 1000
    assert (np.diff(ours) > 0.0).all()
