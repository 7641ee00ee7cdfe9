"""Every number, word and history that a problem can be given changes its run, or is refused in one line."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.arrays import Floats
from stickslip.foundation.quantities import Choice
from stickslip.friction import LAWS
from stickslip.loading import PiecewiseLinear, Sinusoidal, Steps
from stickslip.problem.parameters import ProblemEntry, entries_of, put_many
from tests.engine.drawn import example_problem

STRESS = 1e6
COULOMB = ss.friction.Coulomb(0.6, 0.4)
RATE = ss.friction.HyperbolicRate(0.6, 0.4, 5.0)
SLAB = ss.ElasticSlab(2800.0, 3500.0, 100.0, STRESS)
Z, R = SLAB.impedance, SLAB.two_way_time
SOFT = replace(SLAB, driver_impedance=0.4 * Z, contact_mass=0.05 * Z * R)
GAIN = replace(SLAB, driver_impedance=0.4 * Z, driver_integral_gain=0.3 * Z / R)
HEAVY = replace(GAIN, driver_inertia=0.2 * Z * R)
LISTS = [30.0, 70.0], [2000.0, 2800.0], [1500.0, 3500.0]
LAYERS = ss.LayeredSlab(*LISTS, STRESS, driver_impedance=0.4 * Z, drag=[1e4, 2e4])
TWO = ss.TwoSlabs([30.0], [2000.0], [1500.0], *LISTS, STRESS, driver_impedance=2e6, drag=[1e4])
PIPES = ss.load_scenario("pipe-and-collar").problem
STRING = ss.load_scenario("drill-string").problem
ROCK = ss.friction.RateAndState(0.6, 0.010, 0.014, "1 mm", normal_stress_coupling=0.2)
NEVER = Steps([0.0, 0.5 * R], [-1.0, -1.0])
FREED = Steps([0.0, 0.8 * R], [-1.0, 0.5])
SWING = Sinusoidal(0.1, 0.05, 3.0 * R, 0.3)
PRESSED = Steps([0.0, 0.7 * R], [STRESS, 0.8 * STRESS])


def loaded(body: Any, law: Any = COULOMB, **fields: Any) -> ss.Problem:
    """Return a problem that begins to slip at once."""
    return ss.Problem(body, law, **({"pull_rate": 0.05, "initial_load": 0.61 * body.normal_load} | fields))


PROBLEMS: dict[str, ss.Problem] = {
    "block": loaded(ss.SpringBlock(3e5, 4e8, STRESS, 1e6), one_way=False),
    "disc": loaded(ss.RotatingBlock(300.0, 800.0, 15e3, 5.0), RATE),
    "block, pulled to and fro": loaded(ss.SpringBlock(3e5, 4e8, STRESS), pull_rate=SWING),
    "slab": loaded(SLAB, p_wave_speed=None) if False else loaded(SLAB),
    "slab, two branches": loaded(SLAB, ss.friction.HyperbolicRate(0.6, 0.4, 200.0), initial_load=0.58 * STRESS, selection="maximal"),
    "soft driver": loaded(SOFT, RATE),
    "soft driver, far stress": loaded(SOFT, far_stress=0.7 * STRESS, far_stress_rate=0.1 * STRESS),
    "gain": loaded(GAIN, far_stress=0.7 * STRESS),
    "machine": loaded(HEAVY, RATE, far_stress=0.7 * STRESS, far_stress_rate=0.1 * STRESS),
    "layers": loaded(LAYERS, far_stress=0.7 * STRESS),
    "layers, machine": loaded(replace(LAYERS, driver_inertia=0.2 * Z * R, driver_integral_gain=0.3 * Z / R), far_stress=0.7 * STRESS),
    "apart": loaded(TWO, far_stress=0.7 * STRESS),
    "joined": loaded(replace(TWO, sides="joined", contact_mass=1e4, other_driver_impedance=3e6), far_stress=0.7 * STRESS),
    "string": replace(STRING, initial_load=0.81 * STRING.normal),
    "sections": replace(PIPES, initial_load=0.81 * PIPES.normal),
    "ground": loaded(SLAB, ground_acceleration=PiecewiseLinear([0.0, 0.5 * R, R], [0.0, -3.0, 0.0])),
    "pressed": loaded(SLAB, normal_load=PRESSED),
    "rate and state, pressed": loaded(SLAB, ROCK, initial_state=1.0, normal_load=PRESSED),
    "freed": loaded(SLAB, far_stress=0.2 * STRESS, driver_reflection=FREED),
    "steady": loaded(SOFT, ROCK, initial_load=None, initial_rate="steady", far_stress=0.6 * STRESS),
}  # fmt: skip
LASTING = 4.0
"""Duration of the runs, in round trips through the whole body or periods."""


def examples(entry: ProblemEntry, problem: ss.Problem) -> list[Any]:
    """Return other values to give to an entry; at least one must act, or all must be refused."""
    declared, value = entry.declared, entry.value
    if isinstance(declared, Choice):
        return [word for word in declared.allowed if word != value]
    if isinstance(value, float) and math.isfinite(value) and value != 0.0:
        return [1.03 * value, 0.97 * value]
    body, name = problem.body, entry.name.rpartition(".")[2]
    own = {
        "driver_impedance": 0.5 * body.impedance,
        "driver_inertia": 0.1 * body.impedance * body.round_trip_time,
        "driver_integral_gain": 0.2 * body.stiffness,
        "p_wave_speed": 6000.0,
        "pull_rate": 0.03,
        "far_stress": 0.5 * problem.normal,
        "far_stress_rate": 0.1 * problem.normal,
        "load": 0.7 * problem.normal,
        "excess": 0.02 * problem.normal,
        "rate": 0.02,
    }
    return [own.get(name, 0.01), -0.01] if value != 0.0 else [own.get(name, 0.01), own.get(name, 0.01) * 10.0]


HISTORIES: dict[str, list[Any]] = {
    "normal_load": [0.8],
    "ground_velocity": [PiecewiseLinear([0.0, 0.1, 0.2], [0.0, 0.05, 0.0])],
    "ground_acceleration": [PiecewiseLinear([0.0, 0.1, 0.2], [0.0, -3.0, 0.0])],
    "driver_reflection": [0.7],
    "pull_rate": [Steps([0.0, 0.05], [0.05, 0.2])],
    "far_stress": [1.1],
}


def histories(problem: ss.Problem) -> Iterator[tuple[str, Any]]:
    """Yield the fields of a problem that may vary, with a history for each."""
    soon, first = 0.3 * problem.body.round_trip_time, problem.body.reflection
    for name, (one,) in HISTORIES.items():
        if name == "driver_reflection":
            one = Steps([0.0, soon], [first, first + 0.7 if first < 0.0 else first - 0.7])
        elif isinstance(one, float):
            one = Steps([0.0, soon], [problem.normal, one * problem.normal])
        yield name, one


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


if __name__ == "__main__":
    import sys, time
    every = PROBLEMS | {f"{kind} on {body}": example_problem(kind, body) for kind in LAWS for body in ("block", "slab")}
    for name, problem in every.items():
        if len(sys.argv) > 1 and sys.argv[1] not in name: continue
        t = time.time()
        try: known = motion(problem)
        except ss.InputError as e: print("BASE", name, e); continue
        for entry in entries_of(problem):
            out = []
            for value in examples(entry, problem):
                try: other = put_many(problem, {entry.name: value})
                except (ss.InputError) as e: out.append("refused"); continue
                try: out.append(acts(known, other))
                except ss.InputError as e: out.append("run refused")
                if out[-1] is True: break
            if not any(o is True for o in out) and any(o is False for o in out): print("FAIL", name, "|", entry.name, entry.value, out)
        for field, one in histories(problem):
            try: other = replace(problem, **{field: one})
            except ss.InputError as e: continue
            if getattr(problem, field)==one: continue
            try:
                if not acts(known, other): print("FAIL", name, "| history", field)
            except ss.InputError: pass
        print(name, round(time.time()-t,1), flush=True)
