"""Every registered law under every body, against scipy and by the balance of energy."""

from __future__ import annotations

from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
import tomli_w

import stickslip as ss
from stickslip.friction import LAWS, FrictionLaw
from stickslip.reference.method_of_steps import method_of_steps
from stickslip.scenarios import read_scenario

SLAB = ss.ElasticSlab(2800, 3500, 1e3, 1e8)
BODIES: dict[str, Any] = {
    "block": ss.SpringBlock(2.8e9, 3e10, 1e11),
    "slab": SLAB,
    "slab with mass": replace(SLAB, contact_mass=3e5),
}


def example_law(kind: str) -> FrictionLaw:
    """The law as its own example has it, read the way a scenario is."""
    tables = {
        "body": {"kind": "spring-block", "mass": 1.0, "stiffness": 1.0, "normal_force": 1.0},
        "friction": {"kind": kind} | {k.replace("values", "parameters"): v for k, v in LAWS[kind].example.items()},
        "initial": {"excess": 0.0} if LAWS[kind].sticks else {"load": 0.0, "state": LAWS[kind].start["state"]},
        "run": {"duration": 1.0},
    }
    return read_scenario(tomli_w.dumps(tables), "example").problem.friction


def example_problem(kind: str, body: str) -> ss.Problem:
    """The law under a load a little above its strength; for one that never sticks, above that of steady sliding.

    Bristles begin bent by a metre, so that they throw the contact backwards.
    """
    law, normal = example_law(kind), 1e11 if body == "block" else 1e8
    if law.sticks:
        return ss.Problem(BODIES[body], law, pull_rate=1e-3, initial_excess=1e-4 * normal)
    assert law.state is not None
    load, state = law.start["coefficient"] * normal, law.start["state"] if law.state.unit == "1" else 1.0
    return ss.Problem(BODIES[body], law, pull_rate=1e-3, initial_load=load, initial_state=state)


@pytest.mark.parametrize("kind", LAWS)
@pytest.mark.parametrize("body", BODIES)
def test_every_law_under_every_body_balances_energy_and_agrees_with_scipy(kind: str, body: str) -> None:
    problem = example_problem(kind, body)
    law = problem.friction
    duration = 2.2 * (problem.body.period if isinstance(problem.body, ss.SpringBlock) else SLAB.two_way_time)
    run = ss.simulate(problem, duration, rtol=1e-11)
    assert run.status.ok
    energy = run.energy(np.linspace(0, duration, 23))
    assert float(np.abs(energy.balance).max() / np.abs(energy.heat[-1])) < 1e-8
    massless = body == "slab" and law.depends_on_rate and kind not in ("coulomb", "hyperbolic-rate")
    if massless or law.state or kind == "velocity-strengthening" or (law.knots and law.knot_variable == "rate"):
        return  # beyond the slow method; the balance has spoken, and other tests look at each of these
    times = np.linspace(0.0, duration, 101)
    theirs = method_of_steps(problem, duration, rtol=1e-10).slip(times)
    assert np.ptp(theirs) > 0
    assert run.slip(times) == pytest.approx(theirs, rel=0.0, abs=1e-6 * np.ptp(theirs))


def test_laws_have_fields_to_read() -> None:
    assert all(fields(law) for law in LAWS.values())
    assert all(issubclass(law, FrictionLaw) for law in LAWS.values())
