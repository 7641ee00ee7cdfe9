"""`python -m benchmarks.cycle`: cycles with their multipliers beside plain runs of a period, and beside other programs.

Processor times, medians of interleaved rounds. A cycle is found in two ways: from a start 1 % of its extent away from it, with a
run of two periods, and as users ask for it, from the problem's own start.
"""

from __future__ import annotations

import ctypes
import importlib.util
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

import stickslip as ss

SOURCE = Path(__file__).parent / "c_kernel" / "shooting.c"
FLAGS = ("-O3", "-march=native", "-shared", "-fPIC")
ROUNDS = 15
"""Rounds of which medians are taken."""
PULL, SCALE, LEVEL = 1.0, 0.4, 5.0
"""Van der Pol's oscillator as a block: x = (v - PULL) / SCALE under a load of about LEVEL, N."""
PERIOD, MULTIPLIER = 6.663286859323130, 8.5968e-4
"""Of van der Pol's oscillator: the period in 16 digits, and the multiplier (1) as the integration by DOP853 has it."""
STEPS = 1600
"""Steps of RK4 in a period with which C finds the period to 1e-9."""
CRITICAL = 802.799465
"""Stiffness (N/m) below which steady sliding under the two states is unstable."""


def van_der_pol() -> ss.Problem:
    """Return van der Pol's oscillator with mu = 1, PathSim's own example, as a block under a cubic law."""
    law = ss.friction.FromExpression("0.5 + 0.04*(x**3/3 - x)".replace("x", "((v - V)/d)"), {"V": "1 m/s", "d": "0.4 m/s"})
    return ss.Problem(ss.SpringBlock(1.0, 1.0, 10.0), law, pull_rate=PULL, initial_rate=PULL, initial_load=LEVEL + 0.5)


def brake(pull: float, **start: float) -> ss.Problem:
    """Return the brake of docs/cycles.md."""
    law = ss.friction.ExponentialStribeck(static=0.5, dynamic=0.3, rate="50 mm/s")
    return ss.Problem(ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0), law, pull_rate=pull, **start)


def problems() -> dict[str, tuple[ss.Problem, float | None]]:
    """Return problems by name, with the duration (s) of the first run where the default finds another cycle."""
    page = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance="10 um")
    two = ss.friction.TwoStateRateAndState(
        reference=0.6, a=0.01, b=0.01, distance="10 um", second_b=0.0084, second_distance=1e-5 / 0.048, evolution="slip"
    )
    lagged = ss.friction.LaggedFriction(rate=ss.friction.HyperbolicRate(0.8, 0.3, 10.0), time=0.05)
    damped = ss.SpringBlock(1.0, 1e3, 10.0, damping=2.0)
    return {
        "brake that rests": (brake(0.1, initial_load=0.0), None),
        "brake, unstable cycle": (brake(0.2, initial_rate=0.2, initial_load=8.5), 0.7),
        "van der Pol, mu = 1": (van_der_pol(), None),
        "lagged friction, with rest": (ss.Problem(damped, lagged, pull_rate=0.1, initial_load=0.0, initial_state=0.0), None),
        "rate and state": (ss.Problem(ss.SpringBlock(3e6, 18e3, 10.0), page, pull_rate=1e-6), None),
        "two states": (ss.Problem(ss.SpringBlock(100.0, 0.9 * CRITICAL, 10.0), two, pull_rate=1e-6), None),
    }


def multipliers_of(problem: ss.Problem, near: float | None) -> Any:
    """Return the cycle, after its multipliers have been asked for."""
    found = ss.studies.cycle(problem, near=near)
    _ = found.multipliers
    return found


def beside(found: Any) -> ss.Problem:
    """Return the problem that starts 1 % of the extent of a cycle away from it."""
    orbit = found.orbit
    return orbit.section.start_at(orbit.place + 0.01 * orbit.extent) if len(orbit.place) else found.problem


def medians(methods: dict[str, Callable[[], Any]], rounds: int = ROUNDS) -> dict[str, float]:
    """Return the median processor time (s) of each method, round after round."""
    times: dict[str, list[float]] = {name: [] for name in methods}
    for n in range(rounds + 1):
        for name, method in methods.items():
            begun = time.process_time()
            method()
            if n:  # the first round compiles and fills caches
                times[name].append(time.process_time() - begun)
    return {name: statistics.median(each) for name, each in times.items()}


def own_table() -> Table:
    """Return our cycles over our plain runs of one period."""
    table = Table("problem", "run of a period", "cycle from beside it", "cycle from the start", "runs of Newton")
    for name, (problem, near) in problems().items():
        found = multipliers_of(problem, near)
        start = beside(found)
        took = medians({
            "run": lambda found=found: ss.simulate(found.problem, found.period, 1e-12),
            "near": lambda start=start, found=found: multipliers_of(start, 2.2 * found.period),
            "all": lambda problem=problem, near=near: multipliers_of(problem, near),
        })  # fmt: skip
        ratios = [f"{1e3 * took[one]:.2f} ms, x {took[one] / took['run']:.1f}" for one in ("near", "all")]
        table.add_row(name, f"{1e3 * took['run']:.2f} ms", *ratios, str(found.orbit.iterations))
    return table


def paces(_: float, y: Any) -> Any:
    """Return the change of load, slip rate and their disturbances in van der Pol's oscillator."""
    x = (y[1] - PULL) / SCALE
    slope = 1.0 - x * x
    found = [PULL - y[1], y[0] - LEVEL - SCALE * (x**3 / 3.0 - x)]
    for k in (2, 4):
        found += [-y[k + 1], y[k] + slope * y[k + 1]]
    return np.array(found)


def by_scipy(load: float) -> tuple[float, float, float]:
    """Find load, period and multiplier by Newton's iteration on DOP853 at 1e-10, with the equation of disturbances."""
    period = PERIOD
    for _ in range(20):
        y = solve_ivp(paces, (0.0, period), [load, PULL, 1.0, 0.0, 0.0, 1.0], "DOP853", rtol=1e-10, atol=1e-11).y[:, -1]
        pace = paces(0.0, y)
        missed = np.array([y[0] - load, y[1] - PULL])
        if np.abs(missed).max() < 1e-9:
            break
        step = np.linalg.solve([[y[2] - 1.0, pace[0]], [y[3], pace[1]]], -missed)
        load, period = load + step[0], period + step[1]
    return load, period, float(y[2] - pace[0] / pace[1] * y[3])


def by_c() -> Callable[[float], tuple[float, float, float]] | None:
    """Return shooting in C, compiled; None without a compiler."""
    compiler = shutil.which("cc")
    if compiler is None:
        return None
    library = Path(tempfile.mkdtemp()) / "shooting.so"
    subprocess.run([compiler, *FLAGS, str(SOURCE), "-o", str(library), "-lm"], check=True)
    call = ctypes.CDLL(str(library)).shoot

    def shoot(load: float) -> tuple[float, float, float]:
        found = (ctypes.c_double * 3)(load, PERIOD, 0.0)
        call(found, STEPS, 20)
        return found[0], found[1], found[2]

    return shoot


def by_pathsim(load: float) -> tuple[bool, int, float]:
    """Find the cycle by PathSim's shooting with 40 steps of order 8; it is told the period, and finds no multiplier."""
    from pathsim import Simulation
    from pathsim.blocks import ODE
    from pathsim.solvers import RKDP87

    block = ODE(lambda y, u, t: paces(t, np.append(y, np.zeros(4)))[:2], np.array([load, PULL]))
    found: tuple[bool, int, float] = Simulation([block], [], dt=PERIOD / 40, Solver=RKDP87, log=False).pss(PERIOD, tolerance=1e-9)
    return found


def peers_table() -> Table:
    """Return van der Pol's oscillator by all methods, from 1 % beside the cycle."""
    found = multipliers_of(van_der_pol(), None)
    start = beside(found)
    load = float(start.initial_load)  # type: ignore[arg-type] # a number on the section
    methods: dict[str, Callable[[], Any]] = {
        "stickslip": lambda: multipliers_of(start, 2.2 * found.period),
        "stickslip, a run of a period": lambda: ss.simulate(found.problem, found.period, 1e-12),
        "scipy DOP853, shooting": lambda: by_scipy(load),
    }
    in_c = by_c()
    if in_c is not None:
        methods[f"C, RK4 of {STEPS} steps, shooting"] = lambda: in_c(load)
    if importlib.util.find_spec("pathsim") is not None:
        methods["PathSim, told the period"] = lambda: by_pathsim(load)
    took = medians(methods, 7)
    ours = found.period, found.multipliers[0].real
    known = {"stickslip": ours, "scipy DOP853, shooting": by_scipy(load)[1:]}
    if in_c is not None:
        known[f"C, RK4 of {STEPS} steps, shooting"] = in_c(load)[1:]
    table = Table("van der Pol, mu = 1", "time", "over stickslip", "error of the period", "multiplier")
    for name, each in took.items():
        period, multiplier = known.get(name, (None, None))
        told = ("", "") if period is None else (f"{abs(period / PERIOD - 1.0):.1e}", f"{multiplier:.6e}")
        table.add_row(name, f"{1e3 * each:.3f} ms", f"x {each / took['stickslip']:.3g}", *told)
    return table


def soft_drill_string() -> ss.Problem:
    """Return the bundled drill string behind a drive of 2000 N m s, which lets waves out."""
    softer = ss.load_scenario("drill-string").problem.parameters["body.driver_impedance"].put(2000.0)
    problem: ss.Problem = softer.parameters["loading.pull_rate"].put(8.95)
    return problem


def branches() -> list[str]:
    """Return a line on each branch: of the brake, of rate and state, and of the drill string behind a softer drive."""
    lines = []
    page, _ = problems()["rate and state"]
    for name, problem, along, to, near in (
        ("brake", brake(0.1, initial_load=0.0), "pull_rate", 0.5, None),
        ("rate and state", page, "body.stiffness", 15e3, None),
        ("drill string", soft_drill_string(), "pull_rate", 8.8, 70.0),
    ):
        try:
            begin = ss.studies.cycle(problem, near=near)
            begun = time.process_time()
            branch = ss.studies.follow(begin, along, to=to, steps=100)
        except ss.InputError as error:
            lines.append(f"{name}: refused: {error}")
            continue
        took, count = time.process_time() - begun, len(branch.points)
        lines.append(
            f"{name}: {count} points in {took:.2f} s, {1e3 * took / count:.1f} ms a point: 200 in {200 * took / count:.1f} s"
        )
    return lines


def main() -> None:
    """Print two tables, and lines on branches."""
    console = Console(width=140)
    console.print(own_table())
    console.print(peers_table())
    for line in branches():
        sys.stdout.write(line + "\n")


if __name__ == "__main__":
    main()
