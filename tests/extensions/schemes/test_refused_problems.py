"""What the schemes do not follow is refused by name."""

from __future__ import annotations

from dataclasses import replace

import pytest

import stickslip as ss
from stickslip.extensions.schemes.run import SCHEMES
from tests.core.problem.bodies.dashpot import PROBLEM

SLAB = ss.ElasticSlab(2800.0, 3500.0, 1e3, 1e8)
LAW = ss.friction.Coulomb(0.6, 0.5)
STILL = ss.Problem(SLAB, LAW, pull_rate=0.03, initial_load=5e7)
MACHINE = replace(SLAB, driver_impedance=5e6, driver_inertia=1e6, driver_integral_gain=1e6)
PRESSED = replace(STILL, normal_load=ss.loading.Steps([0.0, 1.0], [1e8, 9e7]))
SHAKEN = replace(STILL, ground_velocity=ss.loading.Sinusoidal(mean=0.0, amplitude=0.1, period=1.0))
VARIES = "schemes: a pull rate, far stress or normal load that varies in time is not in the schemes: give constant ones"


@pytest.mark.parametrize(
    ("problem", "message"),
    [
        (replace(STILL, body=MACHINE), r".*mass or an integral gain is not in the schemes"),
        (ss.load_scenario("drill-string").problem, r"schemes: TorsionalString has no grid: they are of an ElasticSlab$"),
        (SHAKEN, f"{VARIES}, and ground at rest$"),
        (PRESSED, f"{VARIES}$"),
        *(
            (problem, f"schemes: {type(problem.body).__name__} has no grid: they are of an ElasticSlab$")
            for problem in (ss.load_scenario(name).problem for name in ("low-velocity-zone", "steel-on-granite", "pipe-and-collar"))
        ),
    ],
)
def test_a_problem_that_has_no_grid_is_refused_in_one_line(problem: ss.Problem, message: str) -> None:
    with pytest.raises(ss.InputError, match=f"^{message}") as refused:
        ss.studies.schemes(problem, 1.0)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_body_whose_damping_is_not_its_impedance_is_refused_by_name(scheme: str) -> None:
    with pytest.raises(ss.InputError, match=r"schemes: a dashpot at the contact is not in the schemes: set contact_damping to 0$"):
        ss.studies.schemes(PROBLEM, 4.0, scheme=scheme, cells=20)
