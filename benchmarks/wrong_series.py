"""`python -m benchmarks.wrong_series [--few] ["block, implicit" ...]`: does the proof of a run notice that the engine is wrong?

Each coefficient of each node's series, each value of a node in the law's compiled formula, and each coefficient of a finished step
is made wrong by a factor 1 + e. What the run then really misses of the contact equation, in 40 digits at 200 places of its steps,
is compared with what it says: `proven.residual`. Formulas are compiled once, with a number in place of each factor.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import stickslip as ss
from benchmarks.missed import missed, missed_by_states, of_duration, worst_of, worst_of_states
from stickslip.engine import compiled_formula
from stickslip.engine.formula_code.taylor_series import FormulaWriter
from stickslip.engine.history.history import History
from stickslip.engine.input import prepare
from stickslip.problem.loading import PiecewiseLinear, Sinusoidal, Steps
from stickslip.solution.observables.proof import proven
from stickslip.solution.observables.proof_of_states import sizes, states_proven

SIZES = (1e-6, 1e-3, 0.1)
"""Errors of a coefficient, relative."""
SLAB, BLOCK = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), ss.SpringBlock(1.0, 20.0, 10.0)
LAW = "0.5 + 0.02*sin(4*u)*exp(-u*u/2) + 0.01*tanh(2*u-1) + 0.01*log(1+u*u) + 0.01/(1+u**4) + 0.01*(1+u*u)**0.3 + 0.01*arcsinh(u)"
RATE = "0.6 - 0.05*v/(v+2) + 0.01*exp(-v/3)*sin(v) + 0.01*log(1+v)"
LINE = re.compile(r"^([anqsvwxe]\w*?)(?:_(\d+))? = (.*)$")


def cases() -> dict[str, tuple[ss.Problem, float]]:
    """Problems by name, with durations (s): explicit and implicit steps, under all kinds of laws and loads."""
    friction, slips = ss.friction, {"pull_rate": 0.3, "initial_excess": 1.5e7}
    law, rate = friction.FromExpression(LAW), friction.FromExpression(RATE)
    ageing, coupled = (friction.RateAndState(0.6, 0.012, 0.014, 0.01, normal_stress_coupling=alpha) for alpha in (0.0, 0.005))
    slow = {"pull_rate": 1.0, "initial_load": 6.3e7, "initial_state": 1e-2}
    light = {"pull_rate": 0.1, "initial_load": 6.2, "initial_state": 1.0}
    machine = replace(SLAB, driver_impedance=3e6, driver_inertia=2e6, driver_integral_gain=4e5)
    layers = ss.LayeredSlab([4e3, 6e3], [2600.0, 2800.0], [3000.0, 3500.0], 1e8)
    swings, climbs = Sinusoidal(1e8, 1e6, 3.0), PiecewiseLinear([0.0, 1.0, 2.5], [1e8, 1.02e8, 0.99e8])
    shakes = PiecewiseLinear([0.0, 1.0, 2.0, 3.0], [0.0, 0.2, -0.1, 0.0])
    freed = Steps([0.0, 1.0], [SLAB.reflection, 0.5])
    disc = ss.RotatingBlock(1.0, 20.0, 10.0, damping=0.1)
    return {
        "slab": (ss.Problem(SLAB, law, **slips), 4.0),
        "slab of rate": (ss.Problem(SLAB, rate, pull_rate=3.0, initial_excess=1e7), 4.0),
        "slab with mass": (ss.Problem(replace(SLAB, contact_mass=1e7), law, **slips), 4.0),
        "block": (ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0), 1.5),
        "block of rate": (ss.Problem(BLOCK, rate, pull_rate=0.1, initial_excess=4.0), 1.0),
        "slab, implicit": (ss.Problem(SLAB, ageing, **slow), 4.0),
        "block, implicit": (ss.Problem(BLOCK, ageing, **light), 0.1),
        "stiff, implicit": (ss.Problem(replace(SLAB, contact_mass=1e3), law, **slips), 4.0),
        "slab, normal load swings": (ss.Problem(SLAB, law, **slips, normal_load=swings), 4.0),
        "slab of rate, normal load climbs": (ss.Problem(SLAB, rate, pull_rate=3.0, initial_excess=1e7, normal_load=climbs), 4.0),
        "block, normal load swings": (
            ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0, normal_load=Sinusoidal(10.0, 0.5, 0.7)),
            1.5,
        ),
        "ageing, normal load steps": (ss.Problem(SLAB, coupled, **slow, normal_load=Steps([0.0, 1.0], [1e8, 1.02e8])), 2.0),
        "ageing block, normal load swings": (ss.Problem(BLOCK, coupled, **light, normal_load=Sinusoidal(10.0, 0.5, 0.7)), 0.3),
        "two states": (
            ss.Problem(
                SLAB,
                friction.TwoStateRateAndState(0.6, 0.012, 0.01, 0.01, second_b=0.004, second_distance=0.1),
                **slow,
                initial_second_state=1e-1,
            ),
            4.0,
        ),
        "lagged": (ss.Problem(SLAB, friction.LaggedFriction(friction.HyperbolicRate(0.8, 0.3, 0.1), 0.5), **slips), 4.0),
        "bristles": (ss.Problem(BLOCK, friction.LuGre(0.7, 0.5, 0.1, 1e3, 5.0, 0.02), pull_rate=0.1, initial_load=0.0), 2.0),
        "layers": (ss.Problem(layers, law, **slips), 8.0),
        "machine": (ss.Problem(machine, law, **slips), 8.0),
        "driver changes": (ss.Problem(SLAB, law, **slips, far_stress=7.5e7, driver_reflection=freed), 8.0),
        "shaken slab": (ss.Problem(SLAB, law, **slips, ground_velocity=shakes), 8.0),
        "rotating block": (ss.Problem(disc, law, pull_rate=0.1, initial_excess=4.0), 1.5),
    }


# ---- engines that are wrong ------------------------------------------------------------------------------------------------


class WrongWriter(FormulaWriter):
    """Writes formulas in which each value and each coefficient has a factor of its own, behind the constants of the formula."""

    slots: dict[tuple[str, str], int]
    first = 0

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.first, self.slots = self.size, {}
        self.size += 4000
        for part in self.parts_with_factors():
            self.statements(part)

    def parts_with_factors(self) -> tuple[str, ...]:
        """The functions whose lines have factors; a law whose states all follow from time alone takes explicit steps, too."""
        explicit, own = ("rate_jet", "motion_jet"), [tree for tree in self.state_rates if tree.arguments]
        return ("state_value",) if own else (*explicit, "state_value") if self.states else (*explicit, "value")

    def statements(self, part: str) -> list[str]:
        """Return the lines of a function, with a factor in each line that sets a value or a coefficient."""
        lines = super().statements(part)
        if part == "prepare":
            return [*lines, *(f"c[{n}] = 1.0" for n in range(self.first, self.size))]
        if part not in self.parts_with_factors():
            return lines
        return [self._with_factor(part, line) for line in lines]

    def _with_factor(self, part: str, line: str) -> str:
        found = LINE.match(line)
        if found is None or (found[1] in ("s", "x", "q", "a") and found[2] in (None, "0")):
            return line
        slot = self.slots.setdefault((part, found[1] + (f"_{found[2]}" if found[2] else "")), self.first + len(self.slots))
        return f"{line[: line.index('=')]}= c[{slot}] * ({found[3]})"


@contextmanager
def wrong_engine() -> Iterator[Callable[[tuple[str, str], float], None]]:
    """Let formulas be compiled with factors; yields a function that makes one of them 1 + e in the runs that follow."""
    wrong: list[tuple[tuple[str, str], float]] = []
    writer, fill = compiled_formula.FormulaWriter, compiled_formula.CompiledFormula.fill

    def filled(self: Any, values: Any, reference: float, constants: Any) -> None:
        fill(self, values, reference, constants)
        for name, by in wrong:
            constants[self._writer.slots[name]] = 1.0 + by

    def forget() -> None:
        for cached in (prepare._of_problem, prepare._prepared):
            cached.cache_clear()

    def make_wrong(name: tuple[str, str], by: float) -> None:
        wrong[:] = [(name, by)]
        forget()

    compiled_formula.FormulaWriter, compiled_formula.CompiledFormula.fill = WrongWriter, filled  # type: ignore[misc, method-assign, assignment]
    compiled_formula.compile_formula.cache_clear()
    try:
        yield make_wrong
    finally:
        compiled_formula.FormulaWriter, compiled_formula.CompiledFormula.fill = writer, fill  # type: ignore[misc, method-assign]
        compiled_formula.compile_formula.cache_clear()
        forget()


def names_of(problem: ss.Problem) -> list[tuple[str, str]]:
    """The functions and lines of the law's first piece that may be made wrong."""
    law, body = problem.contact_law, problem.body
    writer = WrongWriter(law.trees()[0], law.parameters(), state_rates=law.state_trees())
    unused = "rate_jet" if body.has_inertia else "motion_jet"
    return [name for name in writer.slots if name[0] != unused]


@dataclass
class Tally:
    """What became of the wrong runs of one problem."""

    runs: int = 0
    noticed: int = 0
    """A bound is more than ten times that of the right engine."""
    unharmed: int = 0
    """What is missed is no more than the bound of the right engine: the error has no effect there."""
    ended: int = 0
    hidden: int = 0
    """More is missed than said, of the contact equation or of that of a state: this must not happen."""
    tightest: float = 0.0
    """Largest share of a bound that is really missed."""

    def count(self, real: tuple[float, float], said: tuple[float, float], right: tuple[float, float], ok: bool = True) -> None:
        """Count a run by what it misses of the contact equation (Pa or N) and of those of states (1), beside what is said."""
        self.runs += 1
        self.tightest = max(self.tightest, *(a / b for a, b in zip(real, said, strict=True) if b > 0.0))
        self.hidden += any(a > b for a, b in zip(real, said, strict=True))
        self.noticed += any(a > 10.0 * b for a, b in zip(said, right, strict=True))
        self.unharmed += all(a <= b for a, b in zip(real, right, strict=True))
        self.ended += not ok


def bent(history: History, n: int, k: int, by: float, table: str = "rate") -> History:
    """A history whose piece n has a wrong coefficient k of the slip rate, load or first state: by a share of the largest one."""
    store = history.store._replace(pieces=history.store.pieces.copy(), state=history.store.state.copy())
    row = store.state[n, 0] if table == "state" else getattr(store, table)[n]
    row[k] += by * np.abs(row).max()
    return replace(history, store=store)


def said_of(run: ss.Solution) -> tuple[float, float]:
    """The bounds of a run on what is missed of the contact equation (Pa or N) and by states (1)."""
    return run.proven.residual + of_duration(run.history), run.proven.states


def wrong_formulas(problem: ss.Problem, duration: float, right: ss.Solution, few: bool) -> dict[str, Tally]:
    """Count what becomes of runs with wrong coefficients and values in the compiled law, by function."""
    tallies: dict[str, Tally] = {}
    with wrong_engine() as make_wrong:
        for line in names_of(problem)[:: 7 if few else 1]:
            for size in SIZES:
                make_wrong(line, size)
                try:
                    run = ss.simulate(problem, duration, max_pieces=20_000)
                except ss.InputError:
                    tallies.setdefault(f"{line[0]}: refused", Tally()).runs += 1
                    continue
                tally = tallies.setdefault(line[0], Tally())
                tally.count((worst_of(run), worst_of_states(run)), said_of(run), said_of(right), run.status.ok)
    return tallies


def wrong_steps(right: ss.Solution) -> dict[str, Tally]:
    """Count what becomes of a run whose middle step gets a wrong coefficient after it was finished, by what is wrong."""
    tallies: dict[str, Tally] = {}
    history = right.history
    steps = np.flatnonzero(history.store.mode != 0)
    n, own = int(steps[len(steps) // 2]), bool(history.problem.friction.states)
    for table in ("rate", "load", *["state"] * own):
        for k in range(history.store.rate.shape[1]):
            for size in SIZES:
                wrong = bent(history, n, k, size, table)
                found = states_proven(wrong)
                said = proven(wrong).residual + of_duration(wrong), found.missed
                share = missed_by_states(wrong, n)[0] / float(sizes(wrong, np.array([n]), 0)[0]) if own else 0.0
                tallies.setdefault(f"{table} of a step", Tally()).count((missed(wrong, n), share), said, said_of(right))
    return tallies


def main() -> int:
    """Print the tables."""
    few, only = "--few" in sys.argv, [name for name in sys.argv[1:] if name != "--few"]
    hidden = 0
    print("| problem | wrong | runs | noticed | no effect | ended | more missed than said | tightest |")  # noqa: T201
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")  # noqa: T201
    for name, (problem, duration) in cases().items():
        if only and name not in only:
            continue
        right = ss.simulate(problem, duration)
        for what, one in (wrong_formulas(problem, duration, right, few) | wrong_steps(right)).items():
            hidden += one.hidden
            numbers = f"{one.runs} | {one.noticed} | {one.unharmed} | {one.ended} | {one.hidden} | {one.tightest:.2f}"
            print(f"| {name} | {what} | {numbers} |", flush=True)  # noqa: T201
    return 1 if hidden else 0


if __name__ == "__main__":
    sys.exit(main())
