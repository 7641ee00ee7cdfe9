"""Every registered law as its own example has it, and a problem with it under each body."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import tomli_w

import stickslip as ss
from stickslip.friction import LAWS, FrictionLaw
from stickslip.friction.contract import STATE_NAMES
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
        "initial": {"excess": 0.0} if LAWS[kind].sticks else {"load": 0.0} | states_at_start(LAWS[kind]),
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
    load, given = law.start["coefficient"] * normal, states_at_start(type(law))
    states = {f"initial_{name}": given[name] if state.unit == "1" else 1.0 for name, state in zip(given, law.states, strict=True)}
    return ss.Problem(BODIES[body], law, pull_rate=1e-3, initial_load=load, **states)


def states_at_start(law: type[FrictionLaw]) -> dict[str, Any]:
    """The states with which the law's own example starts, by name."""
    return {name: law.start[name] for name in STATE_NAMES if name in law.start}
