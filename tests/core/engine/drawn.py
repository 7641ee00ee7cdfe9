"""Problems for every law under every body: those of the examples, and drawn ones with any driver, load and selection rule."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import tomli_w
from hypothesis import HealthCheck, Phase, assume, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.friction import LAWS, FrictionLaw
from stickslip.friction.contract import STATE_NAMES
from stickslip.problem.fields import INITIAL_STATES
from stickslip.problem.scenarios import read_scenario
from stickslip.problem.selection_rule import SELECTION_RULES
from tests.core.friction.drawn import laws

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


NORMAL = 1e8
few = settings(
    max_examples=5,
    derandomize=True,
    suppress_health_check=list(HealthCheck),
    phases=[Phase.explicit, Phase.generate],
)


@st.composite
def bodies(draw: st.DrawFn) -> Any:
    if draw(st.booleans()):
        damping = draw(st.sampled_from([0.0, 1e6]))
        return ss.SpringBlock(10 ** draw(st.floats(4.0, 7.0)), 10 ** draw(st.floats(6.5, 8.5)), NORMAL, damping)
    slab = ss.ElasticSlab(2800, 3500, 10 ** draw(st.floats(1.0, 4.0)), NORMAL)
    driver = draw(st.sampled_from([math.inf, 0.0, slab.impedance, 3e6]))
    return ss.ElasticSlab(2800, 3500, slab.thickness, NORMAL, driver, draw(st.sampled_from([0.0, 0.0, 1e2, 1e5])))


def states(law: ss.friction.FrictionLaw) -> st.SearchStrategy[dict[str, float]]:
    """Draw the initial states: times (s), coefficients of friction, or bendings (m) in either direction."""
    sizes = {"s": st.floats(1e-3, 1e6), "1": st.floats(0.2, 1.2), "m": st.floats(-1e-3, 1e-3)}
    return st.fixed_dictionaries({name: sizes[state.unit] for name, state in zip(INITIAL_STATES, law.states, strict=False)})


@st.composite
def problems(draw: st.DrawFn, kind: str) -> ss.Problem:
    law, body = draw(laws(kind)), draw(bodies())
    share, pull = draw(st.floats(-1.3, 1.3)), draw(st.sampled_from([0.0, 1e-9, 1e-3, -1e-3, 0.3]))
    strength = NORMAL * (float(law.static_coefficient(0.0)) if law.sticks else 0.7)
    start: dict[str, Any] = {} if law.sticks else draw(states(law))
    rule = draw(st.sampled_from(SELECTION_RULES))
    return ss.Problem(body, law, pull_rate=pull, initial_load=share * strength, selection=rule, **start)


def ran(problem: ss.Problem) -> ss.Solution:
    """Return the run over a few round trips or periods, as far as it gets."""
    body: Any = problem.body
    duration = 3.3 * (body.two_way_time if isinstance(body, ss.ElasticSlab) else min(body.period, 5.0))
    run = ss.simulate(problem, duration, rtol=1e-9, max_pieces=20_000)
    assume(run.history.duration > 0.0)
    return run
