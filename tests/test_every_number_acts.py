"""Every number, word and history that a problem can be given changes its run, or is refused."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.foundation.quantities import Choice
from stickslip.friction import LAWS
from stickslip.problem.loading import PiecewiseLinear, Sinusoidal, Steps
from stickslip.problem.parameters import ProblemEntry, entries_of, put_many
from tests.core.engine.drawn import example_problem

STRESS = 1e6
COULOMB = ss.friction.Coulomb(0.6, 0.4)
RATE = ss.friction.HyperbolicRate(0.6, 0.4, 5.0)
FALLS = ss.friction.HyperbolicRate(0.6, 0.4, 200.0)
SLAB = ss.ElasticSlab(2800.0, 3500.0, 100.0, STRESS)
Z, R = SLAB.impedance, SLAB.two_way_time
SOFT = replace(SLAB, driver_impedance=0.4 * Z, contact_mass=0.05 * Z * R)
GAIN = replace(SLAB, driver_impedance=0.4 * Z, driver_integral_gain=0.3 * Z / R)
HEAVY = replace(GAIN, driver_inertia=0.2 * Z * R)
LISTS = [30.7, 70.0], [2000.0, 2800.0], [1500.0, 3500.0]
LAYERS = ss.LayeredSlab(*LISTS, STRESS, driver_impedance=0.4 * Z, drag=[1e4, 2e4])
GEARED = replace(LAYERS, driver_inertia=0.2 * Z * R, driver_integral_gain=0.3 * Z / R)
TWO = ss.TwoSlabs([30.0], [2000.0], [1500.0], *LISTS, STRESS, driver_impedance=2e6, drag=[1e4])
PIPES = ss.load_scenario("pipe-and-collar").problem
PIPES = replace(PIPES, body=replace(PIPES.body, length=[203.0, 1811.0]))  # no whole numbers of cells
STRING = ss.load_scenario("drill-string").problem
GEAR = {"driver_impedance": "1 kN m s", "driver_inertia": "300 kg m^2", "driver_integral_gain": "500 N m/rad"}
ROCK = ss.friction.RateAndState(0.6, 0.010, 0.014, "1 mm", normal_stress_coupling=0.2)
NEVER = Steps([0.0, 0.5 * R], [-1.0, -1.0])
FREED = Steps([0.0, 0.8 * R], [-1.0, 0.5])
SWING = Sinusoidal(0.1, 0.05, 3.0 * R, 0.3)
RISES = PiecewiseLinear([0.0, 1.0], [0.0, 0.9 * STRESS])
PRESSED = Steps([0.0, 0.7 * R], [STRESS, 0.8 * STRESS])


def loaded(body: Any, law: Any = COULOMB, **fields: Any) -> ss.Problem:
    """Return a problem that begins to slip at once."""
    return ss.Problem(body, law, **({"pull_rate": 0.05, "initial_load": 0.61 * body.normal_load} | fields))


def geared(problem: ss.Problem) -> ss.Problem:
    """Return a string that begins to slip at once, under a drive that is a machine."""
    body: Any = replace(problem.body, **GEAR)  # type: ignore[arg-type] # texts with units are numbers
    return replace(problem, body=body, initial_load=0.81 * problem.normal, far_stress=0.9 * problem.normal)


PROBLEMS: dict[str, ss.Problem] = {
    "block": loaded(ss.SpringBlock(3e5, 4e8, STRESS, 1e6)),
    "loop": loaded(ss.PositionLoop(3e5, 4e8, STRESS, 2e9, 1e7, 1e6, 0.01)),
    "disc": loaded(ss.RotatingBlock(300.0, 800.0, 15e3, 5.0), RATE),
    "block, pulled to and fro": loaded(ss.SpringBlock(3e5, 4e8, STRESS), pull_rate=SWING),
    "block without a spring": ss.Problem(ss.SpringBlock(3e5, 0.0, STRESS, 1e6), COULOMB, force=RISES, initial_load=1e4),
    "slab": loaded(SLAB),
    "slab, two branches": loaded(SLAB, FALLS, initial_load=0.58 * STRESS, selection="maximal"),
    "soft driver": loaded(SOFT, RATE),
    "soft driver, far stress": loaded(SOFT, far_stress=0.7 * STRESS, far_stress_rate=0.1 * STRESS),
    "gain": loaded(GAIN, far_stress=0.7 * STRESS),
    "machine": loaded(HEAVY, RATE, far_stress=0.7 * STRESS, far_stress_rate=0.1 * STRESS),
    "layers": loaded(LAYERS, far_stress=0.7 * STRESS),
    "layers, machine": loaded(GEARED, far_stress=0.7 * STRESS),
    "apart": loaded(TWO, far_stress=0.7 * STRESS),
    "joined": loaded(replace(TWO, sides="joined", contact_mass=1e4, other_driver_impedance=3e6), far_stress=0.7 * STRESS),
    "string": replace(STRING, initial_load=0.81 * STRING.normal),
    "sections": replace(PIPES, initial_load=0.81 * PIPES.normal),
    "string, machine": geared(STRING),
    "sections, machine": geared(PIPES),
    "ground": loaded(SLAB, ground_acceleration=PiecewiseLinear([0.0, 0.5 * R, R], [0.0, -3.0, 0.0])),
    "pressed": loaded(SLAB, normal_load=PRESSED),
    "rate and state, pressed": loaded(SLAB, ROCK, initial_state=1.0, normal_load=PRESSED),
    "freed": loaded(SLAB, far_stress=0.2 * STRESS, driver_reflection=FREED),
    "steady": loaded(SOFT, ROCK, initial_load=None, initial_rate="steady", pull_rate=Steps([0.0, 0.4 * R], [0.05, 0.08])),
}  # fmt: skip
LASTING = 4.0
"""Duration of the runs, in round trips through the whole body or periods."""


def quick(problem: ss.Problem) -> ss.Problem:
    """Return a problem pulled so fast that a law is met far along its slips and slip rates."""
    problem = replace(problem, pull_rate=0.5)
    return problem if problem.initial_excess is None else replace(problem, initial_excess=0.05 * problem.normal)


def pressed(problem: ss.Problem) -> ss.Problem:
    """Return a problem whose normal load falls soon after the start."""
    steps = Steps([0.0, 0.05 * problem.body.round_trip_time], [problem.normal, 0.8 * problem.normal])
    return replace(problem, normal_load=steps)


def dragged(problem: ss.Problem) -> ss.Problem:
    """Return a problem whose layers have drag."""
    body: Any = problem.body
    count = len(body.length if isinstance(body, ss.SectionedString) else body.thickness)
    return replace(problem, body=replace(body, drag=[5.0 * body.impedance / body.distance] * count))


def to_and_fro(problem: ss.Problem) -> ss.Problem:
    """Return a problem of the same law on a block that is pulled back and forth, and rests where it turns.

    The formula of a user is one of slip there.
    """
    if isinstance(problem.friction, ss.friction.FromExpression):
        law = ss.friction.FromExpression("0.5 + 0.1*sin(u/w)", {"w": "1 m"}, counts=problem.friction.counts)
        problem = replace(problem, friction=law)
    block = ss.SpringBlock(2.8e7, 3e10, 1e11, 5e8)
    history = Sinusoidal(0.0, 80.0, 3.0 * block.period, 0.5 * math.pi)
    return replace(problem, body=block, pull_rate=history, initial_load=None, initial_excess=0.0)


BESIDE: dict[str, Callable[[ss.Problem], ss.Problem]] = {
    "body.drag_step": dragged,
    "friction.direct_rate": lambda problem: put_many(problem, {"friction.direct": 0.01}),
    "friction.normal_stress_coupling": pressed,
    "friction.memory": to_and_fro,
    "friction.slip.memory": to_and_fro,
    "friction.counts": to_and_fro,
    "body.stop_behind": lambda problem: replace(problem, pull_rate=-80.0),
    "body.backlash": lambda problem: replace(problem, initial_load=0.0, initial_excess=None),
}
"""Entries that act only beside something else, which is added to the problem here."""
STRAIN_ONLY = "body.p_wave_speed"
"""The one number that no motion depends on: it gives the strain across the contact."""


def examples(entry: ProblemEntry, problem: ss.Problem) -> list[Any]:
    """Return other values to give to an entry, at least one of which must act, unless it is refused."""
    declared, value, name = entry.declared, entry.value, entry.name.rpartition(".")[2]
    if isinstance(declared, Choice):
        return [word for word in declared.allowed if word != value]
    if name in ("travel_time_error", "drag_step"):  # they round to whole cells
        return [0.5 * value, 0.1 * value, 50.0 * value, 10.0 * value]
    if isinstance(value, float) and math.isfinite(value) and value != 0.0:
        return [1.03 * value, 0.97 * value]
    body = problem.body
    own = {
        "driver_impedance": 0.5 * body.impedance,
        "driver_inertia": 0.1 * body.impedance * body.round_trip_time,
        "driver_integral_gain": 0.2 * body.stiffness,
        "damping": 0.2 * body.impedance,
        "driver_damping": 0.2 * body.impedance,
        "contact_damping": 0.2 * body.impedance,
        "contact_mass": 0.1 * body.impedance * body.round_trip_time,
        "pull_rate": 0.03,
        "far_stress": 0.5 * problem.normal,
        "force": 0.3 * problem.normal,
        "far_stress_rate": 0.1 * problem.normal,
        "load": 0.7 * problem.normal,
        "excess": 0.02 * problem.normal,
        "rate": 0.02,
    }.get(name, 0.01)
    return [own, 10.0 * own]


def histories(problem: ss.Problem) -> dict[str, Any]:
    """Return a history for each field of a problem that may be one."""
    soon, first = 0.05 * problem.body.round_trip_time, problem.body.reflection
    pull = problem.first_pull_rate
    return {
        "pull_rate": Steps([0.0, soon], [pull, pull + 0.3]),
        "far_stress": Steps([0.0, soon], [0.7 * problem.normal, 0.9 * problem.normal]),
        "force": Steps([0.0, soon], [0.0, 0.3 * problem.normal]),
        "normal_load": Steps([0.0, soon], [problem.normal, 0.8 * problem.normal]),
        "ground_velocity": PiecewiseLinear([0.0, soon, 2.0 * soon], [0.0, 0.2, 0.0]),
        "ground_acceleration": PiecewiseLinear([0.0, soon, 2.0 * soon], [0.0, -3.0, 0.0]),
        "driver_reflection": Steps([0.0, soon], [first, first + 0.7 if first < 0.0 else first - 0.7]),
    }


def motion(problem: ss.Problem) -> Floats:
    """Return slip, slip rate and load of a run."""
    body: Any = problem.body
    duration = LASTING * (body.two_way_time if body.has_waves else body.round_trip_time)
    run = ss.simulate(problem, duration, rtol=1e-9, max_pieces=200_000)
    time = np.linspace(0.0, 1.0, 201) * run.history.duration
    return np.array([run.slip(time), run.slip_rate(time), run.load(time)])


def acts(known: Floats, problem: ss.Problem) -> bool:
    """Return True if a problem moves otherwise than the one whose motion is known, by more than rounding."""
    size = np.abs(known).max(axis=1, keepdims=True)
    return bool((np.abs(motion(problem) - known) > 1e-9 * size).any())


def made(make: Callable[[], ss.Problem]) -> ss.Problem | None:
    """Return a problem, or None if it is refused."""
    try:
        return make()
    except ss.InputError:
        return None


def silent(problem: ss.Problem) -> Iterator[str]:
    """Yield the names of entries and of histories that are accepted and do not act."""
    bases = {"": (problem, motion(problem))}
    for entry in entries_of(problem):
        add = BESIDE.get(entry.name)
        if add is not None and entry.name not in bases:
            base = add(problem)
            bases[entry.name] = base, motion(base)
        base, known = bases[entry.name if add else ""]
        tried = [made(partial(put_many, base, {entry.name: value})) for value in examples(entry, base)]
        accepted = [one for one in tried if one is not None]
        if entry.name == STRAIN_ONLY:
            assert {one.body.normal_strain for one in accepted} <= {-base.normal / (2800.0 * 6e3**2)}  # type: ignore[attr-defined]
        elif accepted and not any(acts(known, one) for one in accepted):
            yield entry.name
    problem, known = bases[""]
    for name, history in histories(problem).items():
        one = made(lambda name=name, history=history: replace(problem, **{name: history}))
        if one is not None and not acts(known, one):
            yield name


@pytest.mark.sampled(every=24)
@pytest.mark.parametrize("name", PROBLEMS)
def test_every_number_of_a_problem_acts_or_is_refused(name: str) -> None:
    assert list(silent(PROBLEMS[name])) == []


@pytest.mark.sampled(every=26)
@pytest.mark.parametrize("body", ["block", "slab with mass"])
@pytest.mark.parametrize("kind", LAWS)
def test_every_number_of_a_law_acts_or_is_refused(kind: str, body: str) -> None:
    """Some act in slow slip only, some in quick slip."""
    slow = example_problem(kind, body)
    assert set(silent(slow)) & set(silent(quick(slow))) == set()


def test_one_way_and_the_selection_act_where_they_speak_of_something() -> None:
    free = loaded(replace(SLAB, driver_impedance=0.0), initial_load=0.62 * STRESS, far_stress=-0.9 * STRESS)
    assert acts(motion(free), replace(free, one_way=True))
    branches = PROBLEMS["slab, two branches"]
    assert acts(motion(branches), replace(branches, selection="perfect-delay"))
