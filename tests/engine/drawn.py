"""Draw problems of every law, body, driver, load and selection rule."""

from __future__ import annotations

import math
from typing import Any

from hypothesis import HealthCheck, Phase, assume, settings
from hypothesis import strategies as st

import stickslip as ss
from stickslip.problem.selection_rule import SELECTION_RULES
from stickslip.problem.start import INITIAL_STATES
from tests.friction.drawn import laws

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
