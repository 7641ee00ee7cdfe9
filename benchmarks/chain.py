"""`python -m benchmarks.chain`: chains of blocks under Coulomb friction, beside scipy with events, RK4, and series in plain C.

The peers take forward slip only; the first two are numpy. RK4 is as usual: after each step a block whose rate is not above a small
one, and whose load is within its strength, is held; how many events it counts depends on the step. The last is what one would write
for this problem alone (c_kernel/chain.c): from event to event as ours, without proofs.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
import sys
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from rich.console import Console
from rich.table import Table
from scipy.integrate import solve_ivp

import stickslip as ss
from benchmarks.problems import Floats
from stickslip.extensions.chains.solver import solve_chain

STATIC, DYNAMIC, PULL_RATE, COUPLING = 1.0, 0.7, 1e-3, 10.0
SLOW = 1e-5
"""RK4 holds a block at this slip rate (m/s)."""
SIZES = ((10, 1500.0), (40, 300.0))
"""Numbers of blocks, and durations (s)."""
STEPS = (0.1, 0.03, 0.01)
"""Time steps of RK4 (s)."""
SAMPLES = (8, 64)
"""Samples of a step in which the C kernel looks for events: of 200 blocks it misses an onset with 8 of them."""
BIG = ((200, 1000.0), (1000, 4000.0))
"""Chains for ours and C. A step ends at each change of any block, so that a rupture of n blocks costs some n^2 steps of blocks."""


class Outcome(NamedTuple):
    """What a method finds: time it takes (s), onsets, and the sum of slip (m)."""

    wall: float
    onsets: int
    slip: float


def initial(count: int) -> Floats:
    """Return the slip at the start (m)."""
    return -np.random.default_rng(1).uniform(0.0, 0.5, count)


def forces(t: float, u: Floats) -> Floats:
    """Return the force of all springs (N)."""
    load = PULL_RATE * t - u
    load[1:] += COUPLING * (u[:-1] - u[1:])
    load[:-1] += COUPLING * (u[1:] - u[:-1])
    return load


def ours(count: int, duration: float) -> Outcome:
    """Solve a chain exactly."""
    law = ss.friction.Coulomb(STATIC, DYNAMIC)
    chain = ss.Chain(
        law, count, 1.0, COUPLING, 1.0, 1.0, PULL_RATE, initial_slip=initial(count), direction="forward"
    )  # fmt: skip
    begun = time.perf_counter()
    run = solve_chain(chain, duration, keep="changes")
    wall = time.perf_counter() - begun
    sys.stdout.write(
        f"{count} blocks to {duration:g} s: {run.count_of_changes} changes in {wall:.3g} s, "
        f"{1e6 * wall / max(run.moving_steps, 1):.2f} us a change and moving block\n"
    )
    return Outcome(wall, int((run.changes["kind"] == 0).sum()), float(run.slip.sum()))


def with_events(count: int, duration: float) -> Outcome:
    """Solve it by DOP853 at 1e-10 with an event for each block."""
    begun, t, onsets = time.perf_counter(), 0.0, 0
    y = np.concatenate((initial(count), np.zeros(count)))
    moves = forces(0.0, y[:count]) > STATIC
    onsets += int(moves.sum())

    def slope(t: float, y: Floats) -> Floats:
        u, v = y[:count], y[count:]
        return np.concatenate((np.where(moves, v, 0.0), np.where(moves, forces(t, u) - DYNAMIC, 0.0)))

    while t < duration:
        events = []
        for j in range(count):

            def event(t: float, y: Floats, j: int = j) -> float:
                return float(y[count + j] if moves[j] else STATIC - forces(t, y[:count])[j])

            event.terminal, event.direction = True, -1  # type: ignore[attr-defined]
            events.append(event)
        longest = 0.3 if moves.any() else np.inf
        found = solve_ivp(slope, (t, duration), y, "DOP853", events=events, rtol=1e-10, atol=1e-12, max_step=longest)
        t, y = float(found.t[-1]), found.y[:, -1].copy()
        if found.status != 1:
            break
        for j, times in enumerate(found.t_events):
            if len(times):
                onsets += not moves[j]
                moves[j], y[count + j] = not moves[j], 0.0
    return Outcome(time.perf_counter() - begun, onsets, float(y[:count].sum()))


def fixed_step(count: int, duration: float, step: float) -> Outcome:
    """Solve it by RK4 with a fixed step (s)."""
    begun, u, v, onsets = time.perf_counter(), initial(count), np.zeros(count), 0
    moves = forces(0.0, u) > STATIC
    onsets += int(moves.sum())

    def slope(t: float, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        return np.where(moves, v, 0.0), np.where(moves, forces(t, u) - DYNAMIC, 0.0)

    for n in range(round(duration / step)):
        t = n * step
        a = slope(t, u, v)
        b = slope(t + 0.5 * step, u + 0.5 * step * a[0], v + 0.5 * step * a[1])
        c = slope(t + 0.5 * step, u + 0.5 * step * b[0], v + 0.5 * step * b[1])
        d = slope(t + step, u + step * c[0], v + step * c[1])
        u = u + step / 6.0 * (a[0] + 2.0 * (b[0] + c[0]) + d[0])
        v = v + step / 6.0 * (a[1] + 2.0 * (b[1] + c[1]) + d[1])
        load = forces(t + step, u)
        held = moves & (v <= SLOW) & (load <= STATIC)
        begins = ~moves & (load > STATIC)
        onsets += int(begins.sum())
        moves = (moves & ~held) | begins
        v[~moves] = 0.0
    return Outcome(time.perf_counter() - begun, onsets, float(u.sum()))


@cache
def library() -> ctypes.CDLL | None:
    """Compile the C kernel; None without a compiler."""
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        return None
    target = Path(tempfile.mkdtemp(prefix="stickslip-c-")) / "chain.so"
    source = Path(__file__).parent / "c_kernel" / "chain.c"
    subprocess.run([compiler, "-O3", "-march=native", "-shared", "-fPIC", str(source), "-o", str(target), "-lm"], check=True)
    loaded = ctypes.CDLL(str(target))
    loaded.solve.argtypes = (*[ctypes.c_int64] * 2, *[ctypes.c_double] * 5, ctypes.c_void_p)
    loaded.solve.restype = ctypes.c_int64
    return loaded


def in_c(count: int, duration: float, samples: int) -> Outcome:
    """Solve it from event to event by series in plain C, with samples of each step; nothing is found without a compiler."""
    if (loaded := library()) is None:
        return Outcome(np.nan, 0, np.nan)
    begun, u = time.perf_counter(), initial(count)
    onsets = loaded.solve(count, samples, PULL_RATE, COUPLING, STATIC, DYNAMIC, duration, u.ctypes.data)
    return Outcome(time.perf_counter() - begun, onsets, float(u.sum()))


def plain_c(count: int, duration: float) -> list[tuple[str, Outcome]]:
    """Return what the C kernel finds, by its name in the table."""
    return [(f"series in C, {samples} samples a step", in_c(count, duration, samples)) for samples in SAMPLES]


def main() -> None:
    """Print a table."""
    ours(2, 1.0)  # machine code is made or loaded
    library()
    table = Table("blocks", "method", "seconds", "onsets", "sum of slip (m)")
    for count, duration in SIZES:
        solved = ours(count, duration)
        rows = [("ours", solved), *plain_c(count, duration), ("DOP853 with events", with_events(count, duration))]
        rows += [(f"RK4, step {step:g} s", fixed_step(count, duration, step)) for step in STEPS]
        for name, one in rows:
            table.add_row(str(count), name, f"{one.wall:.3g}", str(one.onsets), f"{one.slip:.9f}")
    for count, duration in BIG:
        for name, one in (("ours", ours(count, duration)), *plain_c(count, duration)):
            table.add_row(str(count), name, f"{one.wall:.3g}", str(one.onsets), f"{one.slip:.9f}")
    Console().print(table)


if __name__ == "__main__":
    main()
