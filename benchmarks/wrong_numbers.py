"""`python -m benchmarks.wrong_numbers [--few] ["machine" ...]`: who notices an engine that solves another problem?

Each number that a run is prepared with is made wrong by a factor 1 + e. The run is then sound in itself: only what takes the
problem's own numbers can notice it. A run counts as harmed if its slip differs from that of the right engine; every harmed run must
be noticed by a bound or a comparison of `Solution.proven`, or by the energy balance.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

import stickslip as ss
from benchmarks.given_kinds import cases
from stickslip.engine.input import prepare
from stickslip.engine.state.layout import FirstLoad, LadderCell, LawPiece, LoadingSegment, Params, Setup

SIZES = (1e-6, 1e-3)
"""Errors of a number, relative."""
HARM = 1e-9
"""A run is harmed if its slip differs from that of the right engine by more than this share (1) of the largest slip."""
NOTICED = 10.0
"""A measure notices an error if it is this many times what it is with the right engine (1)."""
NUMERICS = {
    *("tolerance", "first_disc", "smallest_jump", "relative_jump", "rate_floor", "shortest", "largest_drop", "state_scale"),
    *("can_be_negative", "counts_net", "healed_piece"),
}
"""Numbers that decide how a run is solved, or whether something applies, and not what."""
FLAGS = {"jump", "trip", "is_last", "shakes", "pulled"}
"""Whole numbers in tables."""


# ---- engines that are prepared with wrong numbers ------------------------------------------------------------------------------


class Place(NamedTuple):
    """Where a number of a prepared run stands: which table, its field, and its row and column in the table's numbers."""

    table: str
    field: str
    index: tuple[int, ...]

    @property
    def name(self) -> str:
        return f"{self.table}.{self.field}{list(self.index[:-1]) or ''}"


def places_in(setup: Setup) -> Iterator[Place]:
    """Yield the places of all numbers of a prepared run that are neither zero, nor infinite, nor decide only how it is solved."""
    for name, where in Params.places.items():
        yield from (Place("params", name, (n,)) for n in span(where) if name not in NUMERICS and counts(setup.params.numbers[n]))
    for table, kind in (("first_load", FirstLoad), ("loading", LoadingSegment), ("ladder", LadderCell), ("law", LawPiece)):
        rows = np.asarray(getattr(setup, table)).view(float)
        for name, where in kind.places.items():
            if name in FLAGS or name.endswith("_at"):
                continue
            for row in range(len(rows)):
                yield from (Place(table, name, (row, n)) for n in span(where) if counts(rows[row, n]))


def span(where: Any) -> range:
    """Return the columns of a field."""
    return range(where.first, where.first + where.size)


def counts(number: float) -> bool:
    """Return True for a number that can be made wrong by a factor."""
    return bool(np.isfinite(number)) and abs(number) > 1e-290


@contextmanager
def wrong_setup() -> Iterator[Callable[[Place | None, float], None]]:
    """Yield a function that makes one number of every run that is prepared from then on wrong by a factor 1 + e; None: none."""
    right, wrong = prepare._of_problem, []

    def prepared(problem: ss.Problem, rule: Any) -> Any:
        setup, state, count = right(problem, rule)
        for place, by in wrong:
            tables = {name: np.array(getattr(setup, name)) for name in setup._fields if name != "params"}
            params = Params(setup.params.numbers.copy())
            numbers = params.numbers if place.table == "params" else tables[place.table].view(float)
            numbers[place.index] *= 1.0 + by
            setup = Setup(params, **tables)
        return setup, state, count

    prepared.cache_clear = right.cache_clear  # type: ignore[attr-defined]

    def make_wrong(place: Place | None, by: float) -> None:
        wrong[:] = [(place, by)] if place else []
        prepare._prepared.cache_clear()

    prepare._of_problem = prepared  # type: ignore[assignment]
    try:
        yield make_wrong
    finally:
        prepare._of_problem = right
        prepare._prepared.cache_clear()


# ---- what notices them -----------------------------------------------------------------------------------------------------

TIMES = 61
"""Number of times at which slips, and energies, of two runs are compared."""


def measures(run: ss.Solution) -> dict[str, float]:
    """Return what the proof and the energy balance say of a run: shares (1) of its normal load, slip, slip rate, state and heat."""
    proof, normal = run.proven, run.problem.normal
    times = np.linspace(0.0, run.duration, TIMES)[1:]
    energy = run.energy(times)
    slip, rate = (float(np.max(np.abs(one), initial=1e-300)) for one in (run.slip(times) - run.slip(0.0), run.slip_rate(times)))
    turned = float(np.abs(energy.heat).max() + np.abs(energy.work).max() + 1e-300)
    return {
        "contact": proof.residual / normal,
        "states": proof.states,
        "load": proof.load / normal,
        "rest": proof.rest / normal,
        "slip": proof.slip / slip,
        "rate": proof.rate / rate,
        "energy": float(np.abs(energy.balance).max()) / turned,
    }


FLOOR = 1e-13
"""Measures below this are rounding (1)."""


@dataclass
class Noticed:
    """What became of the runs of one problem that were prepared with wrong numbers."""

    runs: int = 0
    ended: int = 0
    """Number of runs that end with a fault: they give no wrong answer."""
    harmed: int = 0
    by: dict[str, int] = field(default_factory=dict)
    """Number of harmed runs that each measure notices."""
    unnoticed: list[str] = field(default_factory=list)
    """Harmed runs that none notices: this must not happen."""


def judge(name: str, problem: ss.Problem, duration: float, each: int = 1) -> Noticed:
    """Make every `each`-th number of a problem wrong in turn, and count what notices that; `name` is for what nothing does."""
    found = Noticed()
    times = np.linspace(0.0, duration, TIMES)
    with wrong_setup() as make_wrong:
        make_wrong(None, 0.0)
        right = ss.simulate(problem, duration)
        before, slip = measures(right), right.slip(times)
        setup, _ = prepare.prepare(problem, right.rtol)
        for place in list(places_in(setup))[::each]:
            for size in SIZES:
                make_wrong(place, size)
                found.runs += 1
                try:
                    run = ss.simulate(problem, duration, max_pieces=20_000)
                except ss.InputError:
                    continue
                if not run.status.ok:
                    found.ended += 1
                    continue
                if np.abs(run.slip(times) - slip).max() <= HARM * np.ptp(slip):
                    continue
                found.harmed += 1
                now = measures(run)
                noticing = [key for key, one in now.items() if one > NOTICED * max(before[key], FLOOR)]
                for key in noticing:
                    found.by[key] = found.by.get(key, 0) + 1
                if not noticing:
                    found.unnoticed.append(f"{name}: {place.name} {size:g}")
    return found


COLUMNS = ("contact", "states", "load", "rest", "slip", "rate", "energy")


def main() -> int:
    """Print the table."""
    few, only = "--few" in sys.argv, [name for name in sys.argv[1:] if name != "--few"]
    unnoticed: list[str] = []
    heads = ("problem", "runs", "ended", "harmed", *(f"noticed by {one}" for one in COLUMNS), "unnoticed")
    print("| " + " | ".join(heads) + " |", "| --- " * len(heads) + "|", sep="\n")  # noqa: T201
    for name, (problem, duration) in cases().items():
        if only and name not in only:
            continue
        one = judge(name, problem, duration, 7 if few else 1)
        unnoticed += one.unnoticed
        numbers = (one.runs, one.ended, one.harmed, *(one.by.get(column, 0) for column in COLUMNS), len(one.unnoticed))
        print(f"| {name} | " + " | ".join(map(str, numbers)) + " |", flush=True)  # noqa: T201
    print(*unnoticed, sep="\n")  # noqa: T201
    return 1 if unnoticed else 0


if __name__ == "__main__":
    sys.exit(main())
