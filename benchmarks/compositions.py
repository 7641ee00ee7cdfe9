"""Random compositions of depth 4 against answers whose steps cannot jump, to 1e-7 at the default tolerance.

    python -m benchmarks.compositions                              # a few hundred, in minutes
    python -m benchmarks.compositions --laws 10000 --jobs 2
    python -m benchmarks.compositions --seed 1 --one 17 3          # one of them again: structure 17, numbers 3

Slip laws on a slab; laws of the slip rate, and of both, on a block. Each structure is drawn with several sets of numbers, which
share its machine code. Every wrong one is printed with its formula. Exit code 1 if one is wrong, or never ends.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
import warnings
from collections import Counter
from multiprocessing.connection import Connection, wait
from typing import Any, NamedTuple

import numpy as np

import stickslip as ss
from benchmarks.composed_laws import Composed, draw
from benchmarks.composed_truth import Answer, UndecidedError, truth_of

CLAIM = 1e-7
PER_STRUCTURE = 100
"""Number of sets of numbers for each structure, which share its machine code."""
LIMIT = 120.0
"""Seconds after which a worker has hung: it compiles a formula, the first one the engine, too."""
MOST_PIECES = 200_000
OUTCOMES = ("right", "refused", "undecided", "wrong", "hung")


def say(text: str) -> None:
    """Write a line at once."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


class Outcome(NamedTuple):
    """What became of a law: one of OUTCOMES, and why."""

    name: str
    why: str = ""


def compared(one: Composed) -> Outcome:
    """Run a problem and compare it with the truth."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            truth = truth_of(one)
        except UndecidedError as error:
            return Outcome("undecided", str(error))
        try:
            run = ss.simulate(one.problem, one.duration, max_pieces=MOST_PIECES)
        except ss.InputError as error:
            return Outcome("refused", str(error)[:60])
        if not run.status.ok:
            return Outcome("refused", run.status.name)
        off = error_of(run, truth, one.duration)
        if off <= CLAIM:
            return Outcome("right")
        return Outcome("refused", "rounding noted") if run.rounding_note else Outcome("wrong", f"off by {off:.2g}, truth {truth}")


def error_of(run: ss.Solution, truth: Answer, duration: float) -> float:
    """The larger relative error of slip and of the time of the first arrest."""
    if truth.arrest is None:
        return abs(float(run.slip(duration)) / truth.slip - 1.0)
    ends = run.catalogue(0.0).end
    late = abs(float(ends.iloc[0]) / truth.arrest - 1.0) if len(ends) and np.isfinite(ends.iloc[0]) else np.inf
    return max(late, abs(float(run.slip(truth.arrest)) / truth.slip - 1.0))


# ---- in several processes ---------------------------------------------------------------------------------------------------


def _work(pipe: Connection, seed: int) -> None:
    """Loop of a worker process: structure and variant in, outcome out."""
    while (task := pipe.recv()) is not None:
        pipe.send(compared(draw(seed, *task)))


class Worker:
    """A process that compares laws, and since when it has been busy with one."""

    def __init__(self, seed: int) -> None:
        self.seed, self.task, self.since = seed, (0, 0), 0.0
        self.start()

    def start(self) -> None:
        """Begin a process."""
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process: Any = context.Process(target=_work, args=(theirs, self.seed), daemon=True)
        self.process.start()
        theirs.close()

    def give(self, task: tuple[int, int]) -> None:
        """Hand out a law."""
        self.task, self.since = task, time.monotonic()
        self.pipe.send(task)

    def stop(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.join()

    def outcome(self) -> Outcome | None:
        """The outcome if there is one; a process that has hung or died is replaced."""
        if self.pipe.poll():
            try:
                return self.pipe.recv()  # type: ignore[no-any-return] # what _work has sent
            except EOFError:
                self.stop()
                self.start()
                return Outcome("hung", "the process died")
        if time.monotonic() - self.since < LIMIT:
            return None
        self.stop()
        self.start()
        return Outcome("hung", f"no answer in {LIMIT:g} s")


class Tally:
    """Counts of outcomes by kind of problem."""

    def __init__(self, seed: int) -> None:
        self.seed, self.done, self.began = seed, 0, time.monotonic()
        self.by: Counter[tuple[str, str]] = Counter()
        self.why: Counter[tuple[str, str]] = Counter()

    def add(self, task: tuple[int, int], outcome: Outcome) -> None:
        """Count an outcome; print it where something was wrong."""
        one = draw(self.seed, *task)
        self.done += 1
        self.by[one.kind, outcome.name] += 1
        if outcome.name in ("wrong", "hung"):
            say(f"\n{outcome.name}: --seed {self.seed} --one {task[0]} {task[1]}: {one.kind}: {outcome.why}\n    {one.text}")
        elif outcome.why:
            self.why[outcome.name, outcome.why] += 1

    def show(self) -> None:
        """The table."""
        say("\n" + f"{'':16}" + "".join(f"{name:>12}" for name in OUTCOMES))
        for kind in sorted({kind for kind, _ in self.by}):
            say(f"{kind:16}" + "".join(f"{self.by[kind, name]:12}" for name in OUTCOMES))
        for (name, why), count in self.why.most_common():
            say(f"{count:6} {name}: {why}")
        say(f"{self.done} laws, seed {self.seed}, {time.monotonic() - self.began:.0f} s")

    @property
    def failed(self) -> bool:
        """True if something was wrong or hung."""
        return any(name in ("wrong", "hung") and count for (_, name), count in self.by.items())


def campaign(seed: int, laws: int, jobs: int, first: int = 0, seconds: float = float("inf")) -> Tally:
    """Compare so many laws, or as many as there is time for."""
    tally = Tally(seed)
    tasks = ((first + n // PER_STRUCTURE, n % PER_STRUCTURE) for n in range(laws))
    idle, busy = [Worker(seed) for _ in range(jobs)], []
    try:
        while True:
            while idle and time.monotonic() - tally.began < seconds and (task := next(tasks, None)) is not None:
                busy.append(idle.pop())
                busy[-1].give(task)
            if not busy:
                return tally
            wait([worker.pipe for worker in busy], timeout=1.0)
            for worker in list(busy):
                outcome = worker.outcome()
                if outcome is not None:
                    tally.add(worker.task, outcome)
                    busy.remove(worker)
                    idle.append(worker)
    except KeyboardInterrupt:
        return tally
    finally:
        for worker in (*idle, *busy):
            worker.stop()


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--laws", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--first", type=int, default=0, help="number of the first structure")
    parser.add_argument("--seconds", type=float, default=float("inf"), help="hand out no more laws after this time")
    parser.add_argument("--one", type=int, nargs=2, metavar=("STRUCTURE", "NUMBERS"))
    options = parser.parse_args()
    if options.one:
        one = draw(options.seed, *options.one)
        say(f"{one}\n{compared(one)}")
        return 0
    tally = campaign(options.seed, options.laws, options.jobs, options.first, options.seconds)
    tally.show()
    return int(tally.failed)


if __name__ == "__main__":
    sys.exit(main())
