"""`python -m benchmarks.wrong_code`: is a run noticed whose engine has one wrong line of code, where it writes what is given?

The engine runs as plain Python (`engine.compile.uncompiled`), and a function of it is replaced by one whose result has a wrong
coefficient: of the series of the normal load, its values in the stages of an implicit step, the jump of a state with it, the
series of a machine's rate, and that of the tone of a loading.
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
LASTING = {"ageing, normal load swings": 0.1, "ageing, normal load steps": 1.05}
"""Durations (s) of runs that take many steps as plain Python; those of the others are 4 s."""
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
    from stickslip.engine.radau import stages
    from stickslip.engine.state.layout import TERMS
    from stickslip.engine.waves import driver, tone, varying_forcing

    def of_series(right: Callable[..., None]) -> Callable[[int, float], Callable[..., Any]]:
        def made(k: int, by: float) -> Callable[..., Any]:
            def wrong(amplitude: float, angle: Any, sine: Any, cosine: Any) -> None:
                right(amplitude, angle, sine, cosine)
                sine[k] *= 1.0 + by

            return wrong

        return made

    def of_stages(k: int, by: float) -> Callable[..., Any]:
        def wrong(run: Any, h: float, right: Callable[..., None] = pressing.press_stages) -> None:
            right(run, h)
            run.stage_state[TERMS * pressing.own_states(run) + k + 1] *= 1.0 + by

        return wrong

    def of_jump(_: int, by: float) -> Callable[..., Any]:
        return lambda run, before, after, right=pressing.couple: right(run, before, before + (after - before) * (1.0 + by))

    def of_machine(k: int, by: float) -> Callable[..., Any]:
        def wrong(run: Any, pace: float, right: Callable[..., Any] = driver.move_machine) -> Any:
            found = right(run, pace)
            run.machine_rate[k] *= 1.0 + by
            return found

        return wrong

    yield "slab, normal load swings", pressing, "tone_along", of_series(pressing.tone_along)
    yield "ageing, normal load swings", stages, "press_stages", of_stages
    yield "ageing, normal load steps", varying_forcing, "couple", of_jump
    yield "machine", driver, "move_machine", of_machine
    yield "slab under a swinging pull", tone, "tone_along", of_series(pressing.tone_along)


def main() -> int:
    """Print what the proof and the energy balance say of each wrong engine, beside how much its slip is off."""
    import numpy as np

    import stickslip as ss
    from benchmarks.wrong_numbers import FLOOR, HARM, NOTICED, TIMES, cases, measures

    unnoticed = 0
    print("| problem | wrong | share of slip | noticed by |", "| --- | --- | --- | --- |", sep="\n")  # noqa: T201
    for kind, module, name, make in wrong_lines():
        problem, duration = cases()[kind]
        duration = min(duration, LASTING.get(kind, 4.0))
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
