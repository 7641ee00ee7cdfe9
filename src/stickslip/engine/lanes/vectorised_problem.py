"""The problems of many members as one `Problem`, whose varied numbers are arrays with one element for each member.

The formulas of bodies, laws and setup accept arrays. Only conditions on a number ("if") cannot. Members are therefore first sorted
into groups with the same outcome of every such condition. Scenarios that cannot be treated so are refused (`why_not`).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.contact import OF_LEVELS
from stickslip.engine.input.branch_table import is_algebraic
from stickslip.engine.lanes.reduction import REDUCED_COLUMNS
from stickslip.engine.state.layout import Floats
from stickslip.foundation.arrays import shared
from stickslip.foundation.constants import RIGID
from stickslip.foundation.errors import nearest
from stickslip.foundation.kernels.uncompiled import UNCOMPILED
from stickslip.foundation.other_values import unchecked
from stickslip.foundation.quantities import Quantity, quantities_of
from stickslip.problem import (
    DURATION,
    LARGEST_RTOL,
    LARGEST_SHARE,
    MOST_ROUND_TRIPS,
    RUN_RTOL,
    Problem,
    check_round_trips,
    check_shortest_event,
    put_many,
)
from stickslip.problem.bodies import MACHINE, BodyOnCharacteristics, ElasticSlab, TorsionalString
from stickslip.problem.scenarios import Scenario

Values = Mapping[str, Floats]
"""Numbers in SI, one for each member, by key such as "friction.alpha"."""
Booleans = NDArray[np.bool_]
Places = NDArray[np.intp]

QUANTITIES = REDUCED_COLUMNS
"""Names of the quantities that a batch can compute from a run."""
ONE_AT_A_TIME = {
    "layered": "[body] a {}",
    "machine": f"[body] {MACHINE}",
    "damper": "[body] a column that is damped",
    "loop": "[body] a {}",
    "changing": "[loading] driver_reflection: a driver that changes",
}
"""What a batch does not follow, by kind of body or of driver: what its lanes know of waves is one echo at a constant share."""
MOVING = {"body.driver_inertia": "machine", "body.driver_integral_gain": "machine", "body.damping_ratio": "damper"}
"""The parameters that give a driver a motion of its own, with the kind that it then is."""
RUN = {"duration": DURATION, "rtol": RUN_RTOL}
"""The entries of [run] in a scenario that may be varied."""


def declared_at(scenario: Scenario, key: str) -> Quantity | None:
    """Return the quantity that a key names, or None unless it is a plain number of the scenario that may be varied."""
    table, _, name = key.partition(".")
    problem = scenario.problem
    if table == "run":
        return RUN.get(name)
    if table in ("body", "friction"):
        owner = quantities_of(type(problem.body if table == "body" else problem.friction))
        found = owner.get(name)
        return None if found is None or found.whole else found
    if table == "loading" and not name.startswith("initial_"):
        return quantities_of(Problem).get(name)
    return quantities_of(Problem).get(f"initial_{name}") if table == "initial" else None


def member(scenario: Scenario, values: Mapping[str, float]) -> Scenario:
    """Return the scenario of one member. Raises InputError if its numbers make no valid scenario."""
    problem = put_many(scenario.problem, _of_problem(values))
    run = {name: declared.check("run", name, values[f"run.{name}"]) for name, declared in RUN.items() if f"run.{name}" in values}
    check_shortest_event(problem, scenario.shortest_event, "run")
    check_round_trips(run.get("duration", scenario.duration), problem.round_trip_time, "run")
    return replace(scenario, problem=problem, **run)  # type: ignore[arg-type] # by name


def _members(scenario: Scenario, values: Mapping[str, Any]) -> Problem:
    """Return the problem with other numbers, which may be arrays; what follows from them is neither checked nor calculated."""
    return put_many(scenario.problem, _of_problem(values), unchecked)


def _of_problem(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in values.items() if not name.startswith("run.")}


def vectorised_problem(scenario: Scenario, values: Values) -> Problem:
    """Return the problem with arrays for the numbers that vary, and with `strength` and `excess` calculated from them."""
    problem = _members(scenario, values)
    law, home = problem.friction, int(pieces_at_start(problem).flat[0])
    static = shared(law.pieces[home](law, problem.law_slip, 0.0) + law.static_excess)
    strength = problem.normal * static
    return unchecked(problem, strength=strength, excess=excess_of(problem, strength))


def excess_of(problem: Problem, strength: Any) -> Any:
    """Return the initial load minus the static strength (Pa or N) of all members, as `Problem.excess` does for one problem."""
    if problem.initial_excess is not None:
        return problem.initial_excess
    load = np.asarray(problem.initial_load)
    near = 4 * np.spacing(strength)
    backwards = np.where(np.abs(load + strength) <= near, -strength - strength, load - strength)
    return np.where(np.abs(load - strength) <= near, 0.0, backwards)


def pieces_at_start(problem: Problem) -> Places:
    """Return the index of each member's first piece of the law; a single one if the members cannot differ in it."""
    law = problem.friction
    if not law.knots or law.knot_variable == "rate":
        return np.zeros(1, np.intp)
    knots = np.broadcast_arrays(*law.knots, problem.law_slip)[:-1]
    return np.asarray(np.sum([knot <= problem.law_slip for knot in knots], axis=0))


# ---- valid members and their groups -----------------------------------------------------------------------------------------


def are_fine(scenario: Scenario, values: Values) -> Booleans:
    """Return True for the members whose parameters are valid: bodies, laws, problems and scenarios check the same for one."""
    fine = np.ones(len(next(iter(values.values()))), bool)
    for key, value in values.items():
        declared = declared_at(scenario, key)
        assert declared is not None
        fine &= declared.allows(value)
    problem = _members(scenario, values)
    body, law = problem.body, problem.friction
    fine &= (law.range()[0] >= 0.0) & (np.asarray(law.static_excess) >= 0.0)
    fine &= np.asarray(values.get("run.rtol", scenario.rtol)) <= LARGEST_RTOL
    with np.errstate(all="ignore"):  # members that are refused already may overflow or divide by zero
        longest = MOST_ROUND_TRIPS * np.asarray(problem.round_trip_time)
        fine &= np.asarray(values.get("run.duration", scenario.duration)) <= longest
    if isinstance(body, ElasticSlab) and body.p_wave_speed is not None:
        fine &= np.asarray(body.p_wave_speed > body.wave_speed * math.sqrt(4 / 3))
    if isinstance(body, TorsionalString) and body.outer_diameter is not None:
        fine &= np.asarray(body.inner_diameter < body.outer_diameter)
    if scenario.shortest_event is not None and scenario.shortest_event > 0.0:
        fine &= driven_rigidly(body) & (scenario.shortest_event <= LARGEST_SHARE * np.asarray(body.longest_way))
    pushed = (problem.far_stress is not None) | (np.asarray(problem.far_stress_rate) != 0.0)
    return fine & ~(pushed & np.isinf(body.driver_impedance))


def driven_rigidly(body: BodyOnCharacteristics) -> Booleans:
    """Return True for the bodies whose driver does not give way, or sends back whole waves with the opposite sign (r = -1)."""
    driver = np.asarray(body.driver_impedance)
    with np.errstate(invalid="ignore"):  # inf / inf
        return np.isinf(driver) | ((body.impedance - driver) / (body.impedance + driver) == RIGID)


def groups(scenario: Scenario, values: Values) -> Iterator[tuple[int, Places, dict[str, Floats]]]:
    """Yield the groups of members that differ in numbers only: the kind of a group, and the indices and values of its members.

    The kind encodes what the members of a group have in common: whether their drivers are rigid, whether their contacts have mass,
    and the piece of the law where they start.
    """
    problem, count = _members(scenario, values), len(next(iter(values.values())))
    body, rigid = problem.body, driven_rigidly(problem.body)
    kind = np.broadcast_to(4 * pieces_at_start(problem) + 2 * rigid + (np.asarray(body.inertia) > 0.0), (count,))
    if "body.driver_impedance" in values:  # a driver with r = -1 to rounding is rigid, whatever its finite impedance
        values = {**values, "body.driver_impedance": np.where(rigid, math.inf, body.driver_impedance)}
    for one in np.unique(kind):
        chosen = np.flatnonzero(kind == one)
        yield int(one), chosen, {key: value[chosen] for key, value in values.items()}


# ---- what a batch cannot run ------------------------------------------------------------------------------------------------


def why_not(scenario: Scenario, parameters: Sequence[str], quantities: Sequence[str]) -> str:
    """Return in one line why a batch cannot run a scenario with these parameters and quantities; "" if it can."""
    if UNCOMPILED:
        return "the engine runs uncompiled, and lanes are registers of a processor"
    for name in quantities:  # those that need a whole solution are unknown to a batch
        if name not in QUANTITIES:
            return f"quantity {ascii(name)[:60]} is not one that a batch can keep; {nearest(str(name), QUANTITIES)}"
    if "sticking" in quantities and not scenario.problem.friction.sticks:
        return f"sticking: {type(scenario.problem.friction).__name__} never rests, so that it is a matter of the slip rate"
    return next((reason for find in (_of_run, _of_law, _of_parameters) for reason in find(scenario, parameters)), "")


def _of_run(scenario: Scenario, parameters: Sequence[str]) -> Iterator[str]:
    """Yield a reason if the run has a limit of events, a machine as driver, a varying load, or leaps over creep from its start."""
    problem = scenario.problem
    if scenario.max_events is not None:
        yield "[run] events: a batch runs for a time, not until a number of events"
    if problem.body.has_play or "body.backlash" in parameters:
        yield "[body] backlash is followed one run at a time"
    driver = next((kind for name, kind in MOVING.items() if name in parameters), problem.driver_kind)
    alone = [ONE_AT_A_TIME[kind].format(problem.body.kind) for kind in (problem.body.structure, driver) if kind in ONE_AT_A_TIME]
    yield from (f"{reason} is followed one run at a time" for reason in alone)
    if not alone and (problem.varies or "loading.force" in parameters):
        yield "[loading] a batch needs a pull, far stress and normal load that do not vary in time"
    if problem.one_way or "loading.one_way" in parameters:
        yield "[loading] one_way: a batch slips both ways"
    if problem.body.has_stops or any(name.startswith("body.stop_") for name in parameters):
        yield "[body] a hard stop is followed one run at a time"
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
    if problem.initial_rate is not None or "initial.rate" in parameters:
        yield "[initial] rate: a batch starts from rest"
    if not law.sticks and (problem.body.has_inertia or _varies_mass(problem.body, parameters)):
        yield f"{name}: a contact with mass that never sticks starts at a slip rate of its own"
    if problem.folds_move:
        yield f"{name}: branches of the contact equation move with slip"
    chooses = is_algebraic(problem) or (_varies_mass(problem.body, parameters) and law.depends_on_rate)
    if chooses and problem.rule not in OF_LEVELS:
        yield f"selection rule '{problem.rule}' is calculated for one problem at a time; a batch supports {', '.join(OF_LEVELS)}"
    if not law.variation < float("inf") or not law.range()[1] < float("inf"):
        yield f"{name}: friction grows without bound"


def _varies_mass(body: BodyOnCharacteristics, parameters: Sequence[str]) -> bool:
    """Return True if a parameter is the mass of a contact that may have none."""
    return f"body.{body.mass_field}" in parameters and bool(quantities_of(type(body))[body.mass_field].allows(np.zeros(1))[0])


def _of_parameters(scenario: Scenario, parameters: Sequence[str]) -> Iterator[str]:
    """Yield a reason if one of the parameters cannot be varied in a batch."""
    for name in parameters:
        if declared_at(scenario, name) is None:
            yield f"{ascii(name)[:60]} is not a plain number of this scenario that a batch can vary"
    if "initial.load" in parameters and "initial.excess" in parameters:
        yield "initial.load and initial.excess exclude each other"
    if "friction.viscosity" in parameters:
        yield "friction.viscosity: with it friction grows without bound"
