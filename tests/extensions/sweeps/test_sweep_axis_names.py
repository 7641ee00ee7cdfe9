"""A map over a number of a formula names it on its axis."""

from __future__ import annotations

import numpy as np

import stickslip as ss
from stickslip.extensions.sweeps.figures import sweep


def test_a_map_over_a_number_of_a_formula_has_its_symbol_and_unit() -> None:
    body = ss.SpringBlock(mass="1 kg", stiffness="1 kN/m", normal_force="10 N")
    law = ss.friction.FromExpression("0.3 + 0.2/(1 + v/vw)", values={"vw": "1 mm/s"})
    problem = ss.Problem(body, law, pull_rate="1 mm/s", initial_excess=0.0)
    varied = {"friction.parameters.vw": np.linspace(0.5, 2.0, 9), "pull_rate": np.linspace(1e-3, 9e-3, 9)}
    found = ss.sweep(problem, varied, duration="2 s", quantities=["slip"])
    labels = {text for axes in sweep.draw_sweep(sweep.sweep_data(found)).axes for text in (axes.get_xlabel(), axes.get_ylabel())}
    assert {"$v_{w}$ (m/s)", "pull rate $V$ of the driver (mm/s)"} <= labels
