"""Random problems by the thousand, each checked: admissible, on the law, in balance, finite, in time.

    python -m benchmarks.soak --problems 100000 --seed 1 --jobs 2
    python -m benchmarks.soak --seed 1 --one 4711           # one of them again, with its repr

Exit code 1 where something failed. Ctrl-C ends with the summary of what was done.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import Any

from benchmarks.soak_checks import Outcome, run
from benchmarks.soak_problems import draw
from stickslip.foundation.errors import InputError
from stickslip.friction import LAWS

LIMIT = 5.0
"""Seconds that the engine may take for a problem."""
COMPILING = 300.0
"""Seconds after which a silent worker has hung: it may compile a formula, the first one the engine, too."""
THOROUGH = 20
"""One problem in so many is read as a user reads it, and may have many pieces."""


def outcome_of(seed: int, index: int, only: str | None, limit: float) -> tuple[str, Outcome, str]:
    """Kind of law, outcome, and the repr of the problem where something was wrong."""
    try:
        drawn = draw(seed, index, only)
    except InputError as error:
        return only or "-", Outcome("not drawn: " + str(error)[:50]), ""
    thorough = index // len(LAWS) % THOROUGH == 0
    outcome = run(drawn, limit, thorough)
    if outcome.status == "too slow":
        outcome = run(drawn, limit, thorough)  # what was compiled the first time is there now
    return drawn.kind, outcome, repr(drawn) if outcome.wrong else ""


def _work(pipe: Connection, seed: int, only: str | None, limit: float) -> None:
    """Loop of a worker process: numbers of problems in, outcomes out."""
    import signal
    import warnings

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    warnings.simplefilter("ignore")
    while (index := pipe.recv()) is not None:
        pipe.send(outcome_of(seed, index, only, limit))


@dataclass
class Worker:
    """A process that runs problems, and since when it has been busy with one."""

    options: argparse.Namespace
    index: int = -1
    since: float = 0.0
    process: Any = None
    pipe: Any = None

    def start(self) -> None:
        """Begin a process."""
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        arguments = (theirs, self.options.seed, self.options.only, self.options.limit)
        self.process = context.Process(target=_work, args=arguments, daemon=True)
        self.process.start()
        theirs.close()

    def give(self, index: int) -> None:
        """Hand out a problem."""
        self.index, self.since = index, time.monotonic()
        self.pipe.send(index)

    def stop(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.join()


@dataclass
class Tally:
    """What has been seen."""

    began: float = field(default_factory=time.monotonic)
    done: int = 0
    by: Counter[tuple[str, str]] = field(default_factory=Counter)
    failures: list[tuple[int, str, Outcome, str]] = field(default_factory=list)

    def add(self, index: int, kind: str, outcome: Outcome, text: str, seed: int) -> None:
        """Count an outcome; print it where something was wrong."""
        self.done += 1
        self.by[kind, outcome.status.split(":")[0]] += 1
        if outcome.wrong:
            self.failures.append((index, kind, outcome, text))
            say(f"\nFAILED --seed {seed} --one {index} ({kind}, {outcome.status}): {'; '.join(outcome.wrong)}\n    {text}")

    def show(self, total: int) -> None:
        """One line of progress."""
        pace = self.done / max(time.monotonic() - self.began, 1e-9)
        line = f"\r{self.done} of {total}, {len(self.failures)} failed, {pace:.1f} a second"
        sys.stderr.write(line)
        sys.stderr.flush()

    def summary(self) -> None:
        """Tables by kind and status, and failures by what was wrong."""
        statuses = sorted({status for _, status in self.by})
        say("\n\n" + f"{'kind':28}" + "".join(f"{status[:16]:>18}" for status in statuses))
        for kind in sorted({kind for kind, _ in self.by}):
            say(f"{kind:28}" + "".join(f"{self.by[kind, status]:18}" for status in statuses))
        causes = Counter((kind, _short(one)) for _, kind, outcome, _ in self.failures for one in outcome.wrong)
        for (kind, cause), count in causes.most_common():
            say(f"{count:6} {kind}: {cause}")
        say(f"{self.done} problems, {len(self.failures)} failed")


def _short(wrong: str) -> str:
    """What was wrong without its number."""
    return wrong.rsplit(" by ", 1)[0].split(" at piece ")[0]


def say(text: str) -> None:
    """Print a line."""
    sys.stdout.write(text + "\n")
    sys.stdout.flush()


def soak(options: argparse.Namespace) -> Tally:
    """Run problems in worker processes until all are done or Ctrl-C."""
    tally, indices = Tally(), iter(range(options.first, options.first + options.problems))
    workers = [Worker(options) for _ in range(options.jobs)]
    busy: list[Worker] = []
    try:
        for worker in workers:
            worker.start()
            _next(worker, indices, busy)
        while busy:
            _collect(busy, indices, tally, options)
            tally.show(options.problems)
    except KeyboardInterrupt:
        say("\ninterrupted")
    finally:
        for worker in workers:
            if worker.process is not None:
                worker.stop()
    return tally


def _next(worker: Worker, indices: Any, busy: list[Worker]) -> None:
    index = next(indices, None)
    if index is not None:
        worker.give(index)
        busy.append(worker)


def _collect(busy: list[Worker], indices: Any, tally: Tally, options: argparse.Namespace) -> None:
    """Take what has come, and replace workers that hang or have died."""
    ready = wait([worker.pipe for worker in busy], timeout=1.0)
    for worker in list(busy):
        outcome: tuple[str, Outcome, str] | None = None
        if worker.pipe in ready:
            try:
                outcome = worker.pipe.recv()
            except (EOFError, ConnectionError):
                outcome = "-", Outcome("crashed", ("the process died",)), ""
        elif time.monotonic() - worker.since > COMPILING:
            outcome = "-", Outcome("hangs", (f"silent for {COMPILING:g} s",)), ""
        if outcome is None:
            continue
        busy.remove(worker)
        tally.add(worker.index, *outcome, options.seed)
        if outcome[1].status in ("crashed", "hangs"):
            worker.stop()
            worker.start()
        _next(worker, indices, busy)


def main() -> int:
    """Read the command line and run."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.soak", description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--problems", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--only", choices=tuple(LAWS))
    parser.add_argument("--first", type=int, default=0, help="number of the first problem")
    parser.add_argument("--one", type=int, help="run one problem in this process, and print it")
    parser.add_argument("--limit", type=float, default=LIMIT, help="seconds of engine for a problem")
    options = parser.parse_args()
    if options.one is not None:
        say(repr(draw(options.seed, options.one, options.only)))
        kind, outcome, _ = outcome_of(options.seed, options.one, options.only, options.limit)
        say(f"{kind}: {outcome.status}: {'; '.join(outcome.wrong) or 'nothing wrong'}")
        return int(bool(outcome.wrong))
    tally = soak(options)
    tally.summary()
    return int(bool(tally.failures))


if __name__ == "__main__":
    sys.exit(main())
