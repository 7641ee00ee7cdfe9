"""`python -m benchmarks.wrong_code`: is a run noticed whose engine has one wrong line of code, where it writes what is given?

The engine runs as plain Python (`engine.compile.uncompiled`), and a function of it is replaced by one whose result has a wrong
coefficient: of the series of the normal load, of that of a machine's rate, and of that of the tone of a loading. Implicit steps
take too long as plain Python.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

SIZES = (1e-6, 1e-3)
"""Errors of a coefficient, relative."""
COEFFICIENTS = (0, 1, 2, 4)
"""Coefficients of a series that are made wrong."""


@contextmanager
def replaced(module: Any, name: str, wrong: Callable[..., Any]) -> Iterator[None]:
    """Let a module have another function under a name."""
    right = getattr(module, name)
    setattr(module, name, wrong)
    try:
        yield
    finally:
        setattr(module, name, right)


def wrong_lines() -> Iterator[tuple[str, Any, str, Callable[[int, float], Callable[..., Any]]]]:
    """Yield the problem that shows it, the module and the function, and what makes its k-th coefficient wrong by a share."""
    from stickslip.engine.contact import pressing
    from stickslip.engine.waves import driver

    def of_series(right: Callable[..., None]) -> Callable[[int, float], Callable[..., Any]]:
        def made(k: int, by: float) -> Callable[..., Any]:
            def wrong(amplitude: float, angle: Any, sine: Any, cosine: Any) -> None:
                right(amplitude, angle, sine, cosine)
                sine[k] *= 1.0 + by

            return wrong

        return made

    def of_machine(k: int, by: float) -> Callable[..., Any]:
        def wrong(run: Any, pace: float, right: Callable[..., Any] = driver.move_machine) -> Any:
            found = right(run, pace)
            run.machine_rate[k] *= 1.0 + by
            return found

        return wrong

    yield "slab, normal load swings", pressing, "tone_along", of_series(pressing.tone_along)
    yield "machine", driver, "move_machine", of_machine
    yield "slab under a swinging pull", pressing, "tone_along", of_series(pressing.tone_along)


def main() -> int:
    """Print what the proof and the energy balance say of each wrong engine, beside how much its slip is off."""
    import numpy as np

    import stickslip as ss
    from benchmarks.wrong_numbers import FLOOR, HARM, NOTICED, TIMES, cases, measures

    unnoticed = 0
    print("| problem | wrong | share of slip | noticed by |", "| --- | --- | --- | --- |", sep="\n")  # noqa: T201
    for kind, module, name, make in wrong_lines():
        problem, duration = cases()[kind]
        duration = min(duration, 4.0)
        times, right = np.linspace(0.0, duration, TIMES), ss.simulate(problem, duration)
        slip, before = right.slip(times), measures(right)
        for k in COEFFICIENTS:
            for by in SIZES:
                with replaced(module, name, make(k, by)):
                    run = ss.simulate(problem, duration, max_pieces=2000)
                if not run.status.ok:
                    print(f"| {kind} | {name}[{k}] {by:g} | ended | |", flush=True)  # noqa: T201
                    continue
                off = float(np.abs(run.slip(times) - slip).max() / np.ptp(slip))
                seen = [key for key, one in measures(run).items() if one > NOTICED * max(before[key], FLOOR)]
                unnoticed += off > HARM and not seen
                print(f"| {kind} | {name}[{k}] {by:g} | {off:.1g} | {', '.join(seen)} |", flush=True)  # noqa: T201
    return 1 if unnoticed else 0


if __name__ == "__main__":
    if os.environ.get("STICKSLIP_UNCOMPILED") == "1":
        sys.exit(main())
    command = [sys.executable, "-m", "benchmarks.wrong_code"]
    sys.exit(subprocess.run(command, env=os.environ | {"STICKSLIP_UNCOMPILED": "1"}, check=False).returncode)
