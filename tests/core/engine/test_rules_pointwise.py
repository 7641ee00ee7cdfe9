"""Selection rules on a rigidly driven slab under the rate law, against a recursion at single phases of the round trip.

At each phase beta(t) = beta(t - R) - 2 Z v(t - R) + 2 Z V, and v is the root that the rule picks: from the load alone, but for
perfect delay, which asks what the contact did an instant before. Nothing but the closed form of the root is used: no pieces, no
folds, no events. An echo multiplies errors, so that phases next to a jump may be on its other side after some round trips.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

import stickslip as ss
from stickslip.problem.selection_rule import SELECTION_RULES

Floats = NDArray[np.float64]

NEAR_A_JUMP = 1e-3
"""Share of the phases of a round trip that may be on the other side of a jump."""
AGREE = 1e-6
"""Of S (muS - muD) / Z: how far slip rates may be apart elsewhere. Echoes multiply errors by some tens in each round trip."""


@dataclass(frozen=True)
class Pointwise:
    """A problem at single phases. Loads in Pa, rates in m/s."""

    problem: ss.Problem

    @property
    def _numbers(self) -> tuple[float, float, float, float, float]:
        body, law = self.problem.body, self.problem.friction
        drop = body.normal_stress * (law.static - law.dynamic)
        return body.impedance, body.normal_stress * law.static, body.normal_stress * law.dynamic, drop, law.alpha

    def fast(self, load: Floats) -> Floats:
        """The larger root of Z s + S muD + drop / (1 + alpha s) = load."""
        impedance, _, dynamic, drop, alpha = self._numbers
        rest = (load - dynamic) / impedance
        half, product = 0.5 * (rest - 1.0 / alpha), (drop / impedance - rest) / alpha
        return half + np.sqrt(np.maximum(half * half - product, 0.0))

    def level(self) -> float:
        """The load above which the rule lets a contact slip whatever it did before."""
        impedance, static, dynamic, drop, alpha = self._numbers
        fold = dynamic + impedance / alpha * (2.0 * math.sqrt(alpha * drop / impedance) - 1.0)

        def area(load: float) -> float:
            s = float(self.fast(np.array(load)))
            return 0.5 * impedance * s * s + dynamic * s + drop / alpha * math.log1p(alpha * s) - load * s

        rule = self.problem.rule
        return {"maximal": fold, "minimal": static}[rule] if rule != "maxwell" else brentq(area, fold, static, rtol=1e-15)

    def directions(self, load: Floats, before: int) -> NDArray[np.int64]:
        """0 for stick, else the sense of slip, at phases in order of time; `before`: an instant before the first one."""
        if self.problem.rule != "perfect-delay":
            return np.where(np.abs(load) > self.level(), np.sign(load), 0.0).astype(np.int64)
        impedance, static, dynamic, drop, alpha = self._numbers
        fold = dynamic + impedance / alpha * (2.0 * math.sqrt(alpha * drop / impedance) - 1.0)
        found, mode = np.empty(len(load), np.int64), before
        for i, beta in enumerate(load.tolist()):
            if mode * beta < fold:
                mode = 0
            if mode == 0 and abs(beta) > static:
                mode = 1 if beta > 0.0 else -1
            found[i] = mode
        return found

    def rates(self, phases: Floats, rows: int) -> Floats:
        """Slip rates at phases (shares of a round trip), one line a round trip."""
        impedance, *_ = self._numbers
        driven = 2.0 * impedance * self.problem.pull_rate
        load, mode, found = self.problem.load + driven * phases, 0, []
        for _ in range(rows):
            directions = self.directions(load, mode)
            rate = np.where(directions == 0, 0.0, directions * self.fast(np.abs(load)))
            load, mode = load - 2.0 * impedance * rate + driven, int(directions[-1])
            found.append(rate)
        return np.array(found)


def drawn(seed: int, selection: str) -> ss.Problem:
    """An irregular problem at random: up to six times the critical alpha, loads next to the strength, pulled slowly or fast."""
    rng = np.random.default_rng(seed)
    slab = ss.ElasticSlab(rng.uniform(1500, 3500), rng.uniform(500, 4000), 10 ** rng.uniform(1, 4), 10 ** rng.uniform(6.5, 8.5))
    static = rng.uniform(0.5, 0.9)
    dynamic = static * rng.uniform(0.3, 0.8)
    drop = slab.normal_stress * (static - dynamic)
    law = ss.friction.HyperbolicRate(static, dynamic, slab.impedance / drop * (1.0 + 10 ** rng.uniform(-2, 0.7)))
    pull, excess = drop / slab.impedance * 10 ** rng.uniform(-2, 0), drop * rng.uniform(-0.3, 0.3)
    load = slab.normal_stress * static + excess
    return ss.Problem(slab, law, pull_rate=pull, initial_load=load, selection=selection)


def apart(problem: ss.Problem, rows: int, phases: int = 4001) -> float:
    """The largest share, of all round trips, of phases at which run and recursion disagree."""
    run = ss.simulate(problem, rows * problem.body.two_way_time, rtol=1e-12, shortest_event=0.0)  # nothing is lumped
    assert run.status.ok, run.status
    assert not run.shocks.isna().any(axis=None)
    law, slab = problem.friction, problem.body
    scale = slab.normal_stress * (law.static - law.dynamic) / slab.impedance
    phase = (np.arange(phases) + 0.3719) / phases
    found = run.slip_rate((np.arange(rows)[:, None] + phase) * slab.two_way_time)
    return float(np.mean(np.abs(found - Pointwise(problem).rates(phase, rows)) > AGREE * scale, axis=1).max())


@pytest.mark.sampled(every=8)
@pytest.mark.parametrize("selection", SELECTION_RULES)
@pytest.mark.parametrize("seed", range(8))
def test_rule_picks_the_root_of_the_recursion(seed: int, selection: str) -> None:
    assert apart(drawn(seed, selection), 10) <= NEAR_A_JUMP


def test_slip_may_begin_at_a_fold_in_the_echo_of_another_fold() -> None:
    """Under the maximal rule slip begins with infinite acceleration, and ends with it: the echoes of both are not smooth."""
    slab = ss.ElasticSlab(1960.2889244225976, 1119.5145653043528, 167.64557809979274, 8921865.884169012)
    law = ss.friction.HyperbolicRate(0.6089220209563222, 0.43635273133773644, 4.145397793290335)
    load, pull = 5432720.604889459, 0.23779181913221842
    assert apart(ss.Problem(slab, law, pull_rate=pull, initial_load=load, selection="maximal"), 14) <= NEAR_A_JUMP


def test_slip_leaves_a_fold_however_slowly_the_load_rises_there() -> None:
    """In round trip 16 a slip begins 5e-20 s before the end of a piece: a ten-billionth of that changes no digit of the load."""
    slab = ss.ElasticSlab(2762.8853959025905, 3156.3184842157657, 2310.653797874799, 51369519.71593251)
    law = ss.friction.HyperbolicRate(0.7353774625497741, 0.39611894237993317, 0.812474254319943)
    load, pull = 33125762.083326515, 0.8456491254756452
    case = ss.Problem(slab, law, pull_rate=pull, initial_load=load, selection="maximal")
    assert ss.simulate(case, 16.5 * slab.two_way_time, rtol=1e-12).status.ok


def test_a_slip_that_time_does_not_resolve_leaves_no_nan() -> None:
    """After 1960 shocks a slip lasts 1e-17 of a round trip; the step after it once had no length."""
    slab = ss.ElasticSlab(2349.811952496922, 885.3007476053658, 34.11172680378936, 125745793.85344447)
    law = ss.friction.HyperbolicRate(0.8301161209914887, 0.3605589354140135, 0.03565301817660317)
    problem = ss.Problem(slab, law, pull_rate=1.3748255345075426, initial_load=87469570.13189352)
    run = ss.simulate(problem, 14.5 * slab.two_way_time, rtol=1e-12)
    assert run.status.ok
    assert len(run.shocks) > 1963
    assert not run.shocks.isna().any(axis=None)
    assert np.isfinite(run.history.store.load).all()
    assert np.isfinite(run.history.store.rate).all()
