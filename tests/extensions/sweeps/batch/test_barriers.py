"""Members of a batch stop at hidden barriers of a law, as single runs do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest
from typing_extensions import override

import stickslip as ss
from stickslip.extensions.sweeps.batch import run_members
from stickslip.foundation.quantities import quantity
from stickslip.friction.formula.functions import evaluate
from stickslip.friction.formula.text import parse
from stickslip.friction.law import RemembersSlip
from stickslip.problem.scenarios.scenario import Scenario
from tests.core.run.adversarial.barriers import BARRIERS, CLAIM, DURATION, EXCESS, SLAB, STEEP, first_balance


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


@pytest.mark.sampled(every=11)
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
