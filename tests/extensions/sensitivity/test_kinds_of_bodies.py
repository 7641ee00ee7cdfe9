"""Sensitivities of every kind of body, driver and law: scaled derivatives by all numbers with the unit of a force cancel out."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem import Problem

SHORT = {
    "bowed-string-slab": 0.01,
    "steel-on-granite": 2e-3,
    "bowed-string-tenth": 0.01,
    "cycles-slab": 0.01,
    "direct-shear-block": 4.0,
    "drill-string": 3.0,
    "fig4-loop": 3.0,
    "fig5-block-reconstructed-omega": 3.0,
    "kolsky-slab": 1e-4,
    "low-velocity-zone": 20.0,
    "rate-and-state-slab": 1.0,
    "reversing-axis": 0.2,
    "sliding-block-shaken": 2.0,
    "sliding-slab-shaken": 1.8,
    "velocity-steps-block": 300.0,
}
"""Bundled scenarios of all kinds, and how long (s) each is run."""


def forces(problem: Problem) -> list[str]:
    """Return the names of the numbers that would double if all forces, stresses, masses and densities did."""
    found = []
    for name, one in problem.parameters.items():
        above, _, below = one.unit.partition("/")
        if (
            {"N", "Pa", "kg", "J"} & set(above.split())
            and not {"N", "Pa", "kg"} & set(below.split())
            and one.value
            and np.isfinite(one.value)
        ):
            found.append(name)
    return found


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.sampled(every=4)
def test_slip_does_not_change_if_all_forces_and_masses_grow_together(name: str) -> None:
    scenario, lasts = ss.load_scenario(name), SHORT[name]
    names = forces(scenario.problem)
    found = ss.studies.sensitivity(scenario, names, "slip", at=[0.37 * lasts, 0.93 * lasts], duration=lasts)
    parts, values = found.scaled, np.array([[scenario.problem.parameters[one].value] for one in names])
    assert len(names) > 1
    assert np.isfinite(parts).all(), found.notes
    assert np.abs(parts).max() > 0.0
    errors = np.abs(found.errors * values).sum(axis=0)
    assert np.all(np.abs(parts.sum(axis=0)) <= errors + 1e-12 * np.abs(found.values))
    assert np.all(errors <= 1e-7 * np.abs(parts).max())


def test_a_number_that_changes_how_layers_fit_their_cells_has_no_derivative() -> None:
    names = ["density[0]", "shear_modulus[1]", "weight_on_bit"]
    found = ss.studies.sensitivity("pipe-and-collar", names, "slip", at=5.5, duration=5.5)
    assert np.isnan(found.derivatives[:2]).all()
    assert np.isfinite(found.derivatives[2]).all()
    (note,) = found.notes
    assert note.startswith("no derivative with respect to body.density[0], body.shear_modulus[1]: the body is cut into whole cells")
    slab = ss.load_scenario("low-velocity-zone")
    assert np.isnan(ss.studies.sensitivity(slab, "thickness[0]", "slip", at=20.0, duration=20.0).derivatives).all()
    assert np.isfinite(ss.studies.sensitivity(slab, "density[0]", "slip", at=20.0, duration=20.0).derivatives).all()


@pytest.mark.parametrize(
    ("body", "name"),
    [
        (ss.PositionLoop(1.0, 100.0, 10.0, 200.0, 8.0, reference_step=0.05, stop_ahead=0.06, restitution=0.5), "restitution"),
        (ss.PositionLoop(1.0, 100.0, 10.0, 200.0, 8.0, reference_step=0.05, stop_ahead=0.06, restitution=0.5), "integral_gain"),
        (ss.SpringBlock(1.0, 1e3, 10.0, backlash=4e-3), "backlash"),
    ],
    ids=["bounce", "integral", "play"],
)
def test_sensitivities_behind_impacts_and_in_a_play_are_differences_of_runs(body: Any, name: str) -> None:
    """Slip behind an impact of a hunting axis, or behind a passage of the play: to 1e-6 of the derivative."""
    loop = isinstance(body, ss.PositionLoop)
    law, pull, time = ss.friction.Coulomb(0.6, 0.4 if loop else 0.05), 0.0 if loop else 0.1, 9.0 if loop else 0.6
    problem = Problem(body, law, pull_rate=pull, initial_load=0.0)
    found = ss.studies.sensitivity(problem, f"body.{name}", "slip", at=[time], duration=time)
    one = problem.parameters[f"body.{name}"]
    step = 1e-4 * one.value
    ends = [ss.simulate(one.put(one.value + n * step), time, 1e-12).slip(time) for n in (-2.0, -1.0, 1.0, 2.0)]
    assert found.derivatives[0, 0] != 0.0
    assert found.derivatives[0, 0] == pytest.approx((ends[0] - 8.0 * ends[1] + 8.0 * ends[2] - ends[3]) / (12.0 * step), rel=1e-6)
