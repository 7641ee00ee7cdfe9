"""The scenarios, parameters and quantities that a batch can handle. All others need one single run after another."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from stickslip.batch.kernels.branch_search import RULES
from stickslip.batch.kernels.reduction import COLUMNS
from stickslip.batch.vectorised_problem import declared_at
from stickslip.engine.codegen.uncompiled import UNCOMPILED
from stickslip.engine_input.branch_table import folds_move, is_algebraic
from stickslip.foundation.errors import nearest
from stickslip.scenarios.scenario import Scenario

QUANTITIES = COLUMNS
"""Names of the quantities to which a batch can reduce a run."""


def why_not(scenario: Scenario, parameters: Sequence[str], quantities: Sequence[str]) -> str:
    """Return in one line why a batch cannot run a scenario; "" if it can.

    Parameters
    ----------
    scenario : Scenario
        The scenario to be run.
    parameters : sequence of str
        Names of the parameters that vary, such as "friction.alpha".
    quantities : sequence of str
        Names of the quantities to be kept.

    Returns
    -------
    str
        The first reason found, or "".
    """
    if UNCOMPILED:
        return "the engine runs uncompiled, and lanes are registers of a processor"
    for name in quantities:  # those that need a whole solution are unknown to a batch
        if name not in QUANTITIES:
            return f"quantity {ascii(name)[:60]} is not one that a batch can keep; {nearest(str(name), QUANTITIES)}"
    return next((reason for find in (_of_run, _of_law, _of_parameters) for reason in find(scenario, parameters)), "")


def _of_run(scenario: Scenario, parameters: Sequence[str]) -> Iterator[str]:
    """Yield a reason if the run has a limit of events, a varying load, or leaps over creep from its start."""
    if scenario.max_events is not None:
        yield "[run] events: a batch runs for a time, not until a number of events"
    if scenario.problem.varies:
        yield "[loading] a batch needs a loading that does not vary in time"
    if scenario.creep_rtol is not None and scenario.creep_rtol > 0.0:
        yield "[run] creep_rtol: a batch cannot leap over creep from the start of a run"


def _of_law(scenario: Scenario, parameters: Sequence[str]) -> Iterator[str]:
    """Yield a reason if the law, or its selection rule, cannot be set up by formulas of plain numbers."""
    problem = scenario.problem
    law, name = problem.friction, type(problem.friction).__name__
    if not law.many:
        yield f"{name} is not made of plain numbers alone"
    if law.memory != "all":
        yield f"{name}: memory '{law.memory}' is not followed by a batch"
    if not law.sticks and (problem.body.has_inertia or "body.contact_mass" in parameters):
        yield f"{name}: a contact with mass that never sticks starts at a slip rate of its own"
    if folds_move(problem):
        yield f"{name}: branches of the contact equation move with slip"
    chooses = is_algebraic(problem) or ("body.contact_mass" in parameters and law.depends_on_rate)
    if chooses and problem.rule not in RULES:
        yield f"selection rule '{problem.rule}' is calculated for one problem at a time; a batch supports {', '.join(RULES)}"
    if not law.variation < float("inf") or not law.range()[1] < float("inf"):
        yield f"{name}: friction grows without bound"


def _of_parameters(scenario: Scenario, parameters: Sequence[str]) -> Iterator[str]:
    """Yield a reason if one of the parameters cannot be varied in a batch."""
    for name in parameters:
        if declared_at(scenario, name) is None:
            yield f"{ascii(name)[:60]} is not a plain number of this scenario that a batch can vary"
    if "initial.load" in parameters and "initial.excess" in parameters:
        yield "initial.load and initial.excess exclude each other"
    if "friction.viscosity" in parameters:
        yield "friction.viscosity: with it friction grows without bound"
