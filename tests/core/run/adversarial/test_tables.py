"""Laws that hide a barrier or a needle in a composition: slip ends where friction first equals the load, alone and in batches.

Truth comes from a search of the law itself on a grid that is dense at its features, and brentq. Steps by the last terms of a
series, with guards at single nodes, went through each of these barriers.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np
import pytest
from scipy.optimize import brentq
from typing_extensions import override

import stickslip as ss
from stickslip.extensions.sweeps.batch import run_members
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.functions import evaluate
from stickslip.friction.formula.text import parse
from stickslip.friction.law import RemembersSlip
from stickslip.problem.scenarios.scenario import Scenario
from tests.core.run.adversarial.walk import Place, walk

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8)
NORMAL, EXCESS, DURATION = 1e8, 1.2e7, 3.0
CLAIM = 1e-7
FUNCTIONS: dict[str, Any] = {name: getattr(np, name) for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "arcsinh")}


class Barrier(NamedTuple):
    """A formula of the slip, where its narrow features are (m), and the slip at which it holds the load (m), known beforehand."""

    formula: str
    features: tuple[float, ...]
    stops: float


BARRIERS = {
    "power of a square": Barrier("0.6 + 0.3*(sin(pi*u)**2)**10", (), 0.404381),
    "power of a power": Barrier("0.6+0.3*(cos(pi*(u+0.55))**16)**16", (), 0.4231),
    "difference of logarithms": Barrier("0.6+0.3*(log((u-.8)**2+4*1e-7**2)-log((u-.8)**2+1e-7**2))/log(4)", (0.8,), 0.7999999),
    "denominator beside an exponential": Barrier("0.6+0.3/((1+((u-.8)/1e-7)**2)*(1+exp(-u)))", (0.8,), 0.7999999),
    "top hat of arcsinh": Barrier(
        "0.6+0.3*(arcsinh((u-.8)/1e-7)-arcsinh((u-.8)/2e-7)-arcsinh((u-.9)/1e-7)+arcsinh((u-.9)/2e-7))/log(4)", (0.8, 0.9), 0.8
    ),
}
STEEP = {
    f"tanh over {width:g} m": Barrier(f"0.6+0.15*(1+tanh((u-0.8)/{width}))", (0.8,), 0.8)
    for width in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7)
}


def value(formula: str, u: Any, v: Any = 0.0) -> Any:
    """The formula by numpy. An exponential inside another may overflow on the way to a finite value."""
    with np.errstate(over="ignore"):
        return eval(formula, {"u": u, "v": v, "pi": math.pi, **FUNCTIONS})


def first_balance(barrier: Barrier, excess: float) -> float:
    """The first slip at which friction equals the load, m."""
    near = np.concatenate([[0.0], np.geomspace(1e-11, 1.0, 20_001)])
    parts = [np.linspace(0.0, 2.0, 200_001), *(c + side * near for c in barrier.features for side in (-1.0, 1.0))]
    slips = np.unique(np.concatenate(parts))
    slips = slips[slips >= 0.0]

    def missing(u: Any) -> Any:
        return NORMAL * (value(barrier.formula, u) - value(barrier.formula, 0.0)) - excess

    first = int(np.argmax(missing(slips) >= 0.0))
    return float(brentq(missing, slips[first - 1], slips[first], xtol=1e-15))


def problem(barrier: Barrier, excess: float = EXCESS) -> ss.Problem:
    return ss.Problem(SLAB, ss.friction.FromExpression(barrier.formula), initial_excess=excess)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("name", BARRIERS)
def test_slip_stops_at_a_hidden_barrier(name: str) -> None:
    barrier = BARRIERS[name]
    stops = first_balance(barrier, EXCESS)
    assert stops == pytest.approx(barrier.stops, rel=0.0, abs=6e-5 if name == "power of a power" else 6e-7)
    run = ss.simulate(problem(barrier), DURATION)
    assert run.status.name == "finished"
    assert float(run.slip(DURATION)) == pytest.approx(stops, rel=CLAIM, abs=0.0)


@pytest.mark.parametrize("name", STEEP)
def test_a_contact_settles_against_a_steep_barrier_in_few_steps(name: str) -> None:
    """Slip to 1e-9; explicit steps would be as short as the contact settles: 1e9 pieces for the steepest barrier."""
    barrier = STEEP[name]
    run = ss.simulate(problem(barrier), DURATION)
    assert run.status.name == "finished"
    assert len(run.history) < 300
    assert float(run.slip(DURATION)) == pytest.approx(first_balance(barrier, EXCESS), rel=1e-9, abs=0.0)


def law_of_plain_numbers(formula: str) -> ss.friction.FrictionLaw:
    """The same law as a class with a number of its own, as batches demand."""
    tree = parse(formula, ())

    @dataclass(frozen=True)
    class Hidden(RemembersSlip):
        """The formula, shifted."""

        kind = "hidden"
        source = "an adversarial test"
        many = True
        example: ClassVar = {"shift": 0.0}

        shift: float = quantity("1", "added to friction")

        @staticmethod
        @override
        def formula(law: Any, u: Any, v: Any) -> Any:
            return law.shift + evaluate(tree, {}, u, v)

        @override
        def range(self) -> tuple[float, float]:
            return 0.5, 1.0

    return Hidden(0.0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("name", list(BARRIERS | STEEP))
def test_members_of_a_batch_stop_where_single_runs_do(name: str) -> None:
    """Eight loads side by side; slip to 1e-7 of truth and to 1e-12 of the single run, with the same status."""
    barrier = (BARRIERS | STEEP)[name]
    law, loads = law_of_plain_numbers(barrier.formula), np.linspace(1.1e7, 1.25e7, 8)
    scenario = Scenario(ss.Problem(SLAB, law, initial_excess=EXCESS), DURATION)
    members = run_members(scenario, {"initial.excess": loads}, ("slip", "end_time"))
    assert members.reason == {}
    for n, load in enumerate(loads.tolist()):
        single = ss.simulate(ss.Problem(SLAB, law, initial_excess=load), DURATION)
        assert single.status.ok
        assert members.results["end_time"][n] == DURATION
        assert float(members.results["slip"][n]) == pytest.approx(float(single.slip(DURATION)), rel=1e-12, abs=0.0)
        assert float(members.results["slip"][n]) == pytest.approx(first_balance(barrier, load), rel=CLAIM, abs=0.0)


NEEDLES = "0.3+0.3*(sin(3*pi*v)**16)**4"


def test_a_block_meets_needles_of_the_slip_rate() -> None:
    """m = 1, K = 20, N = 10: peak slip 0.769388 m, where the slip rate first returns to zero. To 1e-7."""
    block = ss.SpringBlock(1.0, 20.0, 10.0)

    def right(t: float, y: Any) -> list[float]:
        return [y[1], 8.0 - 20.0 * y[0] - 10.0 * (float(value(NEEDLES, 0.0, y[1])) - 0.3)]

    places = [Place(lambda t, y: float(y[1]), centre, 0.02) for centre in np.arange(1, 30, 2) / 6.0]
    path = walk(right, 0.0, [0.0, 0.0], 2.0, places, [1.0, 1.0], lambda t, y: float(y[1]))
    peak = float(path(path.end)[0])
    assert path.stopped
    assert peak == pytest.approx(0.769388, rel=0.0, abs=1e-6)
    run = ss.simulate(ss.Problem(block, ss.friction.FromExpression(NEEDLES), initial_excess=8.0), 2.0)
    assert float(run.catalogue(0.0).end[0]) == pytest.approx(path.end, rel=CLAIM, abs=0.0)
    assert float(run.slip(path.end)) == pytest.approx(peak, rel=CLAIM, abs=0.0)
