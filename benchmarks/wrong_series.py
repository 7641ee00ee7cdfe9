"""`python -m benchmarks.wrong_series [--few] ["block, implicit" ...]`: does the proof of a run notice that the engine is wrong?

Each coefficient of each node's series, each value of a node in the law's compiled formula, and each coefficient of a finished step
is made wrong by a factor 1 + e. What the run then really misses of the contact equation, in 40 digits at 200 places of its steps,
is compared with what it says: `proven.residual`. Formulas are compiled once, with a number in place of each factor.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import stickslip as ss
from benchmarks.missed import missed, of_duration, worst_of
from stickslip.engine import compiled_formula
from stickslip.engine.formula_code.taylor_series import FormulaWriter
from stickslip.engine_input import prepare
from stickslip.observables.proof import proven
from stickslip.trajectory.history import History

SIZES = (1e-6, 1e-3, 0.1)
"""Errors of a coefficient, relative."""
SLAB, BLOCK = ss.ElasticSlab(2800.0, 3500.0, 1e4, 1e8), ss.SpringBlock(1.0, 20.0, 10.0)
LAW = "0.5 + 0.02*sin(4*u)*exp(-u*u/2) + 0.01*tanh(2*u-1) + 0.01*log(1+u*u) + 0.01/(1+u**4) + 0.01*(1+u*u)**0.3 + 0.01*arcsinh(u)"
RATE = "0.6 - 0.05*v/(v+2) + 0.01*exp(-v/3)*sin(v) + 0.01*log(1+v)"
LINE = re.compile(r"^([anqsvwxe]\w*?)(?:_(\d+))? = (.*)$")


def cases() -> dict[str, tuple[ss.Problem, float]]:
    """Problems by name, with durations: slab and block, explicit and implicit steps."""
    law, rate = ss.friction.FromExpression(LAW), ss.friction.FromExpression(RATE)
    ageing = ss.friction.RateAndState(0.6, 0.012, 0.014, 0.01)
    return {
        "slab": (ss.Problem(SLAB, law, pull_rate=0.3, initial_excess=1.5e7), 4.0),
        "slab of rate": (ss.Problem(SLAB, rate, pull_rate=3.0, initial_excess=1e7), 4.0),
        "slab with mass": (ss.Problem(replace(SLAB, contact_mass=1e7), law, pull_rate=0.3, initial_excess=1.5e7), 4.0),
        "block": (ss.Problem(BLOCK, law, pull_rate=0.1, initial_excess=4.0), 1.5),
        "block of rate": (ss.Problem(BLOCK, rate, pull_rate=0.1, initial_excess=4.0), 1.0),
        "slab, implicit": (ss.Problem(SLAB, ageing, pull_rate=1.0, initial_load=6.3e7, initial_state=1e-2), 4.0),
        "block, implicit": (ss.Problem(BLOCK, ageing, pull_rate=0.1, initial_load=6.2, initial_state=1.0), 0.1),
        "stiff, implicit": (ss.Problem(replace(SLAB, contact_mass=1e3), law, pull_rate=0.3, initial_excess=1.5e7), 4.0),
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
        """The functions whose lines have factors."""
        return ("state_value",) if self.states else ("rate_jet", "motion_jet", "value")

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
    law, body = problem.friction, problem.body
    writer = WrongWriter(law.trees()[0], law.parameters(), state_rates=law.state_trees())
    unused = "rate_jet" if body.has_inertia else "motion_jet"
    return [name for name in writer.slots if name[0] != unused]


@dataclass
class Tally:
    """What became of the wrong runs of one problem."""

    noticed: int = 0
    """The bound is more than ten times that of the right engine."""
    unharmed: int = 0
    """What is missed is no more than the bound of the right engine: the error has no effect there."""
    ended: int = 0
    hidden: int = 0
    """More is missed than said: this must not happen."""
    tightest: float = 0.0
    """Largest share of the bound that is really missed."""

    def count(self, run: ss.Solution, right: float) -> None:
        """Count a run, given the bound of the right engine."""
        real, said = worst_of(run), run.proven.residual
        allowed = said + of_duration(run.history)
        self.tightest = max(self.tightest, real / allowed)
        self.hidden += real > allowed
        self.noticed += said > 10.0 * right
        self.unharmed += real <= right
        self.ended += not run.status.ok


def bent(history: History, n: int, k: int, by: float) -> History:
    """A history whose piece n has a wrong coefficient k of the slip rate: by a share of the largest one."""
    store = history.store._replace(pieces=history.store.pieces.copy())
    store.rate[n, k] += by * np.abs(store.rate[n]).max()
    return replace(history, store=store)


def main() -> int:
    """Print the table."""
    few, only = "--few" in sys.argv, [name for name in sys.argv[1:] if name != "--few"]
    hidden = 0
    print("| problem | wrong | runs | noticed | no effect | ended | more missed than said | tightest |")  # noqa: T201
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")  # noqa: T201
    for name, (problem, duration) in cases().items():
        if only and name not in only:
            continue
        right = ss.simulate(problem, duration)
        bound = right.proven.residual
        with wrong_engine() as make_wrong:
            tallies: dict[str, Tally] = {}
            counted: Counter[str] = Counter()
            for line in names_of(problem)[:: 7 if few else 1]:
                for size in SIZES:
                    make_wrong(line, size)
                    try:
                        run = ss.simulate(problem, duration, max_pieces=20_000)
                    except ss.InputError:
                        counted[f"{line[0]}: refused"] += 1
                        continue
                    counted[line[0]] += 1
                    tallies.setdefault(line[0], Tally()).count(run, bound)
        steps = np.flatnonzero(right.history.store.mode != 0)
        for k in range(right.history.store.rate.shape[1]):
            for size in SIZES:
                wrong = bent(right.history, int(steps[len(steps) // 2]), k, size)
                tally = tallies.setdefault("a finished step", Tally())
                counted["a finished step"] += 1
                real = missed(wrong, int(steps[len(steps) // 2]))
                said = proven(wrong).residual
                allowed = said + of_duration(wrong)
                tally.hidden, tally.tightest = tally.hidden + (real > allowed), max(tally.tightest, real / allowed)
                tally.noticed, tally.unharmed = tally.noticed + (said > 10.0 * bound), tally.unharmed + (real <= bound)
        for what, tally in tallies.items():
            hidden += tally.hidden
            print(  # noqa: T201
                f"| {name} | {what} | {counted[what]} | {tally.noticed} | {tally.unharmed} | {tally.ended} | {tally.hidden} "
                f"| {tally.tightest:.2f} |",
                flush=True,
            )
    return 1 if hidden else 0


if __name__ == "__main__":
    sys.exit(main())
