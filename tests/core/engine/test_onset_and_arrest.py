"""Slip events begin at the onset of slip and end at its arrest, whatever slip rate defines them: closed forms, near rounding."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from stickslip.engine.history import turning_points
from stickslip.engine.history.turning_points import TURNS, Spare
from stickslip.run import catalogue as module
from tests.core.engine.compiled import compiled
from tests.problems import IMPEDANCE, NORMAL, ROUND, SLAB

F = ss.friction
BLOCK = ss.SpringBlock(2.0, 50.0, 10.0)
RATES = {"every slip": 0.0, "default": None, "fast": 0.03}
CLOSE = {"rel": 0.0, "abs": 1e-12}
"""s, m, N, or MPa: rounding of a run of a minute at rtol 1e-13."""


@dataclass(frozen=True)
class Known:
    """A problem, and its first events in closed form, in s, m and Pa (block: N)."""

    problem: ss.Problem
    start: np.ndarray
    end: np.ndarray
    slip: float
    before: float
    after: float

    def mirrored(self) -> Known:
        """The same in the other direction."""
        problem, far = self.problem, self.problem.far_stress
        opposite = None if far is None else replace(far, values=tuple(-value for value in far.values))
        turned = replace(problem, pull_rate=-problem.pull_rate, initial_load=-problem.initial_load, far_stress=opposite)
        return replace(self, problem=turned, slip=-self.slip, before=-self.before, after=-self.after)


def known_block(static: float = 0.6, dynamic: float = 0.5, wait: float = 0.5, pull: float = 0.01, count: int = 4) -> Known:
    """Coulomb friction on a block pulled at V: v = (A w / K) sin(w t) + V (1 - cos(w t)), with A its drop, until v = 0."""
    mass, stiffness, normal = BLOCK.mass, BLOCK.stiffness, BLOCK.normal_force
    w, drop = math.sqrt(stiffness / mass), (static - dynamic) * normal
    angle = 2.0 * (math.pi - math.atan(drop * w / (stiffness * pull)))
    lasts = angle / w
    slip = drop / stiffness * (1.0 - math.cos(angle)) + pull * (lasts - math.sin(angle) / w)
    strength = static * normal
    problem = ss.Problem(BLOCK, F.Coulomb(static, dynamic), pull_rate=pull, initial_load=strength - stiffness * pull * wait)
    start = wait + slip / pull * np.arange(count)
    return Known(problem, start, start + lasts, slip, strength, strength + stiffness * (pull * lasts - slip))


def known_slab(static: float = 0.6, wait: float = 0.5, rises: float = 0.8) -> Known:
    """A slab without echoes that weakens with slip, under a far stress that rises by g and then falls by 3 g a second.

    From rest v' = v / s + g / Z for `rises` s, then v' = v / s - 3 g / Z. So v = G (exp(t) - 1) up to a peak, then falls to
    zero in log(3 G / (3 G - peak)), with G = g s / Z and times in s. The stress takes a travel time to the contact.
    """
    travel, gain = 0.5 * ROUND, 5e5
    since = math.log(3.0 / (3.0 - math.expm1(rises)))
    strength = static * NORMAL
    after = strength + gain * (rises - 3.0 * since)
    peak = wait + rises
    stress = (strength - gain * wait, strength + gain * rises, strength + gain * (rises - 30.0))
    far = ss.loading.PiecewiseLinear((0.0, peak, peak + 10.0), stress)
    law = F.LinearSlipWeakening(static, static - 0.3, 0.3 * NORMAL / IMPEDANCE)
    matched = replace(SLAB, driver_impedance=IMPEDANCE)
    problem = ss.Problem(matched, law, initial_load=stress[0], far_stress=far)
    start = np.array([travel + wait])
    return Known(problem, start, start + rises + since, (strength - after) / IMPEDANCE, strength, after)


def known_echo(excess: float = 4e5, growth: float = 1.2) -> Known:
    """A slab that begins with a shock under a load beyond its strength: v = v0 exp(k t), and growth = k R.

    Behind a rigid driver the load falls by 2 Z v of a round trip ago: v = exp(x) v0 (exp(k R) - 2 - 2 x), with x = k (t - R).
    """
    x = 0.5 * (math.exp(growth) - 2.0)
    after = 0.6 * NORMAL + excess - 2.0 * excess * math.exp(x)
    weakening = growth / ROUND * IMPEDANCE
    problem = ss.Problem(SLAB, F.LinearSlipWeakening(0.6, 0.3, 0.3 * NORMAL / weakening), initial_load=0.6 * NORMAL + excess)
    slip, start = (0.6 * NORMAL - after) / weakening, np.zeros(1)
    return Known(problem, start, start + ROUND * (1.0 + x / growth), slip, problem.initial_load, after)


KNOWN = {"block": known_block(), "slab": known_slab(), "slab that begins with a shock": known_echo()}


def matches(table: pd.DataFrame, known: Known) -> None:
    first = table.iloc[: len(known.start)]
    unit = 1e6 if isinstance(known.problem.body, ss.ElasticSlab) else 1.0
    assert first.start.to_numpy() == pytest.approx(known.start, **CLOSE)
    assert first.end.to_numpy() == pytest.approx(known.end, **CLOSE)
    assert first.duration.to_numpy() == pytest.approx(known.end - known.start, **CLOSE)
    assert first.slip.to_numpy() == pytest.approx(known.slip, **CLOSE)
    assert first.traction_before.to_numpy() / unit == pytest.approx(known.before / unit, **CLOSE)
    assert first.traction_after.to_numpy() / unit == pytest.approx(known.after / unit, **CLOSE)
    assert first.traction_drop.to_numpy() / unit == pytest.approx((known.before - known.after) / unit, **CLOSE)


def duration_of(known: Known) -> float:
    return float(known.end[-1]) + 0.4


@pytest.mark.sampled(every=18)
@pytest.mark.parametrize("rate", RATES.values(), ids=RATES)
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("name", KNOWN)
def test_events_begin_at_the_onset_and_end_at_the_arrest(name: str, backwards: bool, rate: float | None, tmp_path: Path) -> None:
    known = KNOWN[name].mirrored() if backwards else KNOWN[name]
    duration = duration_of(known)
    run = ss.simulate(known.problem, duration, 1e-13)
    matches(run.catalogue(rate), known)
    ss.catalogue(known.problem, 0.9 * duration, tmp_path / "events.csv", rtol=1e-13, event_rate=rate)
    resumed = ss.resume(tmp_path / "events.checkpoint.nc", duration)
    matches(resumed, known)
    pd.testing.assert_frame_equal(resumed, run.catalogue(rate), check_exact=True)


def test_a_thousand_events_keep_their_onsets_while_their_history_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the rest before an event is all that is left of the time before it."""
    monkeypatch.setattr(module, "CAPACITY", 64)
    known = known_block(count=1000)
    table = ss.catalogue(known.problem, duration_of(known), rtol=1e-13)
    assert table.start[:1000].to_numpy() == pytest.approx(known.start, rel=1e-14, abs=0.0)
    assert table.end[:1000].to_numpy() == pytest.approx(known.end, rel=1e-14, abs=0.0)
    assert table.traction_drop[:1000].to_numpy() == pytest.approx(known.before - known.after, **CLOSE)


def test_slips_that_touch_are_events_of_their_own_at_every_rate() -> None:
    """The rounding of the slip rate where it touches zero no longer decides whether two slips are one."""
    law = ss.friction.ParabolicSlipWeakening(0.6, 0.4, 0.4)
    run = ss.simulate(ss.Problem(SLAB, law, pull_rate=0.01, initial_excess=0.0), 60.0)
    every, fast = run.catalogue(0.0), run.events
    touching = int(
        ((run.history.store.rate[1:, 0] == 0.0) & (np.diff(run.history.store.mode) == 0))[run.history.store.mode[1:] != 0].sum()
    )
    assert touching > 10
    assert len(every) == len(fast)
    assert every.start.to_numpy().tolist() == fast.start.to_numpy().tolist()


def test_a_rate_that_turns_is_noticed_and_rounding_is_not() -> None:
    """v = 1 + 3 x - 2 x^2 rises to x = 3/4 and falls to 2 at x = 1."""
    memory, descend = Spare.table(1), compiled(turning_points.descend)
    Spare.of(memory).rate[0, :3] = 1.0, 3.0, -2.0
    assert descend(memory, (0.7, -1), 3.0, 1e-6) == 1.0
    assert descend(memory, (1.0, -1), 2.0, 1e-6) == TURNS
    assert descend(memory, (1.0, -1), 2.2, 0.0) == 1.0  # not above what the rate was before
    assert descend(memory, (0.8, 1), 2.2, 1e-6) == pytest.approx(2.0, rel=1e-15)
    assert descend(memory, (0.8, 1), 1.9, 0.2) == 1.9
    assert descend(memory, (0.8, 1), 1.9, 0.05) == TURNS
