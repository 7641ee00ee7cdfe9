"""`python -m benchmarks.stiff`: nearly massless contacts through both jumps of the loop of Fig. 4, against scipy's Radau.

A contact mass, or a lag, settles within a millionth of the round trip. Both methods are implicit Runge-Kutta at Radau's points;
scipy's right-hand side is Python, with the exact Jacobian, and it is told when slip begins: its run starts there.
"""

from __future__ import annotations

import statistics
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

import stickslip as ss
from benchmarks import ours
from benchmarks.problems import ROUND, SLAB, Case, Floats
from benchmarks.runner import Method, Runner, UnavailableError
from benchmarks.speed import LADDER, interleaved, show
from stickslip.extensions.schemes.regularisations import with_contact_mass, with_lag
from stickslip.run.simulate import simulate

LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
PULL, LOAD, DURATION, SETTLES = 2.6, 60e6, 5.7, 1e-6
TARGETS = (1e-7, 1e-9)
Motion = Callable[[float, Floats], list[float]]
Jacobian = Callable[[float, Floats], Floats]


class StiffCase(Case):
    """Like any case; the reference is stickslip at its tightest tolerance, which Radau confirms."""

    @cached_property
    def reference(self) -> Floats:
        return np.array(simulate(self.problem, self.duration, 1e-13).slip(self.times) - self.problem.initial_slip)


BARE = ss.Problem(replace(SLAB, driver_impedance=0.0), LAW, pull_rate=PULL, initial_load=LOAD)
CASES = (
    StiffCase("contact-mass", "loop of Fig. 4, contact mass of 1e-6 Z R", with_contact_mass(BARE, SETTLES * ROUND), DURATION),
    StiffCase("lag", "loop of Fig. 4, lag of 1e-6 R", with_lag(BARE, SETTLES * ROUND), DURATION),
)
Z, S, DROP = SLAB.impedance, SLAB.normal_stress, LAW.static - LAW.dynamic
RISE = Z * PULL / (ROUND / 2)
ONSET = (S * LAW.static - LOAD) / RISE


def _load(t: float) -> float:
    """It rises up to h/c and falls back from there."""
    return LOAD + RISE * min(t, ROUND - t)


def _friction(rate: float) -> tuple[float, float]:
    """S mu and its slope."""
    fall = 1.0 / (1.0 + rate)
    return S * (LAW.dynamic + DROP * fall), -S * DROP * fall * fall


def _contact_mass(case: Case) -> tuple[Motion, Jacobian]:
    """u' = v, m v' = load - Z v - S mu(v)."""
    mass = case.problem.body.contact_mass  # type: ignore[union-attr]

    def motion(t: float, y: Floats) -> list[float]:
        return [y[1], (_load(t) - Z * y[1] - _friction(y[1])[0]) / mass]

    def jacobian(t: float, y: Floats) -> Floats:
        return np.array([[0.0, 1.0], [0.0, -(Z + _friction(y[1])[1]) / mass]])

    return motion, jacobian


def _lag(case: Case) -> tuple[Motion, Jacobian]:
    """u' = v = (load - S mu(w)) / Z, time w' = v - w."""
    time = case.problem.friction.time  # type: ignore[attr-defined]

    def motion(t: float, y: Floats) -> list[float]:
        rate = (_load(t) - _friction(y[1])[0]) / Z
        return [rate, (rate - y[1]) / time]

    def jacobian(t: float, y: Floats) -> Floats:
        slope = -_friction(y[1])[1] / Z
        return np.array([[0.0, slope], [0.0, (slope - 1.0) / time]])

    return motion, jacobian


def radau(case: Case, tolerance: float) -> Runner:
    """scipy's Radau with dense output, from the onset of slip to the turn of the load and on to the arrest."""
    motion, jacobian = (_lag if case.name == "lag" else _contact_mass)(case)
    done = []

    def arrest(t: float, y: Floats) -> float:
        return motion(t, y)[0]

    arrest.terminal, arrest.direction = True, -1.0  # type: ignore[attr-defined]

    def run() -> None:
        settings = {"rtol": max(tolerance, 1e-13), "atol": 1e-3 * tolerance, "dense_output": True, "jac": jacobian}
        rising = solve_ivp(motion, (ONSET, ROUND / 2), [0.0, 0.0], "Radau", **settings)
        falling = solve_ivp(motion, (ROUND / 2, case.duration), rising.y[:, -1], "Radau", events=arrest, **settings)
        done[:] = [rising, falling]

    def slip(times: Floats) -> Floats:
        rising, falling = done
        first = rising.sol(np.clip(times, ONSET, ROUND / 2))[0]
        return np.where(times < ROUND / 2, first, falling.sol(np.clip(times, ROUND / 2, falling.t[-1]))[0])

    return Runner(case, tolerance, run, slip, lambda: sum(len(part.t) - 1 for part in done))


METHODS: dict[str, Method] = {"stickslip": ours.runner, "scipy Radau": radau}


def loosest(method: Method, case: Case, target: float) -> tuple[Runner, float]:
    """The runner at the loosest tolerance whose measured error meets the target, and that error."""
    for tolerance in LADDER[4:]:
        runner = method(case, tolerance)
        error = runner.error()
        if error <= target:
            return runner, error
    raise UnavailableError(f"no tolerance reaches {target:g}")


def main() -> None:
    table = Table(title="Stiff contacts, warm, one core: time to reach a measured error", title_justify="left")
    for name in ("problem", "method", "median time", "times ours", "steps", "measured error", "its tolerance"):
        table.add_column(name, justify="left" if name in ("problem", "method") else "right")
    for case in CASES:
        for target in TARGETS:
            chosen = {name: loosest(method, case, target) for name, method in METHODS.items()}
            times = interleaved({name: runner for name, (runner, _) in chosen.items()})
            base = statistics.median(times["stickslip"])
            for name, (runner, error) in chosen.items():
                spent = statistics.median(times[name])
                row = (show(spent), f"{spent / base:,.1f}", str(runner.steps()), f"{error:.1e}", f"{runner.tolerance:.0e}")
                table.add_row(f"{case.title}, to {target:g}" if name == "stickslip" else "", name, *row)
            table.add_section()
    Console(width=150 if not sys.stdout.isatty() else None).print(table)


if __name__ == "__main__":
    main()
