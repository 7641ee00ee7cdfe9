"""Starts with a slip rate of their own are swept, and run one by one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import stickslip as ss
from stickslip.extensions.sweeps.batch import why_not
from stickslip.foundation.quantities import quantity
from stickslip.friction import FrictionLaw
from stickslip.problem.scenarios import Scenario

NORMAL, SPEED = 1e8, 1e-4


SLAB = ss.ElasticSlab(2800, 3500, 3.0, NORMAL, contact_mass=2e3)


STICKING = ss.friction.HyperbolicRate(0.8, 0.3, 0.01)


SCENARIO = """
[body]
kind = "spring-block"
mass = 1000
stiffness = 1e10
normal_force = "100 MN"
[friction]
kind = "rate-and-state"
reference = 0.6
a = 0.01
b = 0.015
distance = "10 um"
[loading]
pull_rate = "0.1 mm/s"
[initial]
INITIAL
[run]
duration = "0.2 s"
"""


def test_the_initial_rate_can_be_swept(tmp_path: Path) -> None:
    path = tmp_path / "start.toml"
    path.write_text(SCENARIO.replace("INITIAL", 'load = "60 MN"\nstate = "0.2 s"'))
    scenario = ss.load_scenario(path)
    swept = ss.sweep(scenario, {"initial.rate": [-1e-3, 1e-2]}, quantities=["slip"])
    alone = [float(ss.simulate(scenario.with_values({"initial.rate": rate})).slip(0.2)) for rate in (-1e-3, 1e-2)]
    assert swept["slip"].to_numpy().tolist() == alone


@dataclass(frozen=True)
class Smooth(FrictionLaw):
    """mu = top v / (v + rate): without state and without rest."""

    kind = "smooth"
    sticks = False
    many = True

    top: float = quantity("1", "friction at high slip rate", above=0)
    rate: float = quantity("m/s", "slip rate of half of it", above=0)

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        return law.top * v / (v + law.rate)

    def range(self) -> tuple[float, float]:
        return 0.0, self.top


def test_a_law_that_starts_at_a_slip_rate_of_its_own_is_no_case_for_a_batch() -> None:
    block = ss.SpringBlock(1.0, 100.0, 10.0)
    steady = ss.Problem(block, Smooth(0.6, 1e-3), pull_rate=1e-2)
    assert "starts at a slip rate of its own" in why_not(Scenario(steady, 5.0), ["friction.top"], ["slip"])
    sticks = ss.Problem(block, STICKING, pull_rate=1e-2, initial_rate="steady")
    assert "a batch starts from rest" in why_not(Scenario(sticks, 5.0), [], ["slip"])
    light = Scenario(ss.Problem(replace(SLAB, contact_mass=0.0), Smooth(0.6, 1e-3), pull_rate=1e-2, initial_load=1e7), 5.0)
    assert "starts at a slip rate of its own" in why_not(light, ["body.contact_mass"], ["slip"])
    assert why_not(light, ["friction.top"], ["slip"]) == ""
