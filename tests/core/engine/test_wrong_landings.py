"""A leap of any kind that lands wrongly is undone: the exact round trips behind it do not go on as predicted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.engine.creep import creep_landing, slow
from stickslip.engine.creep.leaping_run import LeapingRun
from stickslip.engine.creep.steady_landing import SteadyLanding
from tests.core.engine.creep_truth import ROUND, printed

FAULT = ss.ElasticSlab(2700.0, 3000.0, 1e4, 50e6)
SLOW = ss.Problem(FAULT, ss.friction.RateAndState(0.6, 0.01, 0.015, 0.02), pull_rate=-1e-5, initial_load=-29e6, initial_state=1e4)
STEADY = ss.Problem(ss.ElasticSlab(2800.0, 3500.0, 1.0, 1e6), "0.6 + 0.05*log(1 + v/1e-4)", pull_rate=1e-3, initial_excess=10.0)


def wrong_creep(monkeypatch: pytest.MonkeyPatch) -> None:
    """Slip, where a leap over creep lands, that is too large."""
    last = creep_landing.last_pieces
    wrong = lambda averaged, creep: last(averaged, replace(creep, slip=1.3 * creep.slip))  # noqa: E731
    monkeypatch.setattr(creep_landing, "last_pieces", wrong)


def wrong_slow_sliding(monkeypatch: pytest.MonkeyPatch) -> None:
    """A motion, behind a leap over slow sliding, that is off."""
    later = slow.SlowMotion.later
    monkeypatch.setattr(slow.SlowMotion, "later", lambda self, y, trips: later(self, y, trips) + 1e-3 * (trips > 0))


def wrong_steady_sliding(monkeypatch: pytest.MonkeyPatch) -> None:
    """A load, behind a leap over steady sliding, that is too large."""
    write = SteadyLanding.write

    def shifted(self: SteadyLanding, run: LeapingRun) -> None:
        off = replace(self.deviation, load_there=self.deviation.load_there + 5000.0)
        write(replace(self, deviation=off), run)

    monkeypatch.setattr(SteadyLanding, "write", shifted)


WRONG: dict[str, tuple[Callable[[pytest.MonkeyPatch], None], ss.Problem, float, dict[str, float]]] = {
    "creep": (wrong_creep, printed(300), 70 * ROUND, {"creep_rtol": 1e-3}),
    "slow sliding": (wrong_slow_sliding, SLOW, 7e3 * FAULT.two_way_time, {}),
    "steady sliding": (wrong_steady_sliding, STEADY, 3.0, {}),
}


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("name", WRONG)
def test_a_leap_that_lands_wrongly_is_undone(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Slip is, to the last bit, that of the run without leaps."""
    spoil, problem, end, options = WRONG[name]
    assert len(ss.simulate(problem, end, **options).creep) > 0
    spoil(monkeypatch)
    solution, exact = ss.simulate(problem, end, **options), ss.simulate(problem, end, creep_rtol=0.0)
    assert len(solution.creep) == 0
    time = np.linspace(0.0, end, 1000)
    np.testing.assert_array_equal(solution.slip(time), exact.slip(time))
