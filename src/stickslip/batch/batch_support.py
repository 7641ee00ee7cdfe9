"""The scenarios, parameters and quantities that a batch can handle. All others need one single run after another."""

from __future__ import annotations

from collections.abc import Sequence

from stickslip.batch.kernels.branch_search import RULES
from stickslip.batch.kernels.reduction import COLUMNS
from stickslip.batch.vectorised_problem import declared_at
from stickslip.engine.codegen.uncompiled import UNCOMPILED
from stickslip.engine_input.branch_table import folds_move, is_algebraic
from stickslip.foundation.errors import nearest
from stickslip.scenarios.scenario import Scenario

QUANTITIES = COLUMNS
"""Names of the quantities to which a batch can reduce a run."""


def why_not(scenario: Scenario, keys: Sequence[str], quantities: Sequence[str]) -> str:
    """Return in one line why a batch cannot run a scenario; "" if it can.

    Parameters
    ----------
    scenario : Scenario
        The scenario to be run.
    keys : sequence of str
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
    return of_quantities(quantities) or of_scenario(scenario) or of_law(scenario, keys) or of_keys(scenario, keys)


def of_quantities(quantities: Sequence[str]) -> str:
    """Return the reason if a quantity is unknown to a batch, as those that need a whole solution are; otherwise ""."""
    unknown = next((name for name in quantities if name not in QUANTITIES), None)
    if unknown is None:
        return ""
    return f"quantity {ascii(unknown)[:60]} is not one that a batch can keep; {nearest(str(unknown), QUANTITIES)}"


def of_scenario(scenario: Scenario) -> str:
    """Return the reason if the run has a limit of events, a varying load or leaps over creep from its start; otherwise ""."""
    if scenario.max_events is not None:
        return "[run] events: a batch runs for a time, not until a number of events"
    if scenario.problem.varies:
        return "[loading] a batch needs a loading that does not vary in time"
    if scenario.creep_rtol is not None and scenario.creep_rtol > 0.0:
        return "[run] creep_rtol: a batch cannot leap over creep from the start of a run"
    return ""


def of_law(scenario: Scenario, keys: Sequence[str]) -> str:
    """Return the reason if the law, or its selection rule, cannot be set up by formulas of plain numbers; otherwise ""."""
    problem = scenario.problem
    law, name = problem.friction, type(problem.friction).__name__
    if not law.many:
        return f"{name} is not made of plain numbers alone"
    if law.memory != "all":
        return f"{name}: memory '{law.memory}' is not followed by a batch"
    if folds_move(problem):
        return f"{name}: branches of the contact equation move with slip"
    chooses = is_algebraic(problem) or ("body.contact_mass" in keys and law.depends_on_rate)
    if chooses and problem.rule not in RULES:
        return f"selection rule '{problem.rule}' is calculated for one problem at a time; a batch supports {', '.join(RULES)}"
    if not law.variation < float("inf") or not law.range()[1] < float("inf"):
        return f"{name}: friction grows without bound"
    return ""


def of_keys(scenario: Scenario, keys: Sequence[str]) -> str:
    """Return the reason if one of the keys cannot be varied in a batch; otherwise ""."""
    for key in keys:
        if declared_at(scenario, key) is None:
            return f"{ascii(key)[:60]} is not a plain number of this scenario that a batch can vary"
    if "initial.load" in keys and "initial.excess" in keys:
        return "initial.load and initial.excess exclude each other"
    if "friction.viscosity" in keys:
        return "friction.viscosity: with it friction grows without bound"
    return ""
