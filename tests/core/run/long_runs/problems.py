"""Runs that pass through every state of the engine: problem, duration (s), tolerance."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np

import stickslip as ss
from stickslip.run.options import CallOptions
from stickslip.run.resume import resume_run
from stickslip.solution.files.netcdf import save_checkpoint
from tests.core.engine.moving_folds import KINKED, MATCHED, hardening
from tests.core.engine.moving_folds import SLAB as THIN
from tests.problems import SLAB

WITH_MANY_CHECKPOINTS = """
import math, signal, time
import stickslip as ss
from stickslip.run import run_loop
signal.signal(signal.SIGINT, signal.default_int_handler)  # which background jobs of a shell ignore
run_loop.FIRST_BUDGET = run_loop.LARGEST_BUDGET = 200
run_loop.SHARE_OF_TASKS = math.inf  # a checkpoint after every call of the solver, however busy the machine is
"""
"""What code to be killed begins with."""


def killed(code: str, folder: Path, file: str, with_signal: signal.Signals, times: int = 1) -> subprocess.CompletedProcess[str]:
    """Run code in a process of its own, and send a signal once its checkpoint has been renewed so often."""
    process = subprocess.Popen(
        [sys.executable, "-c", WITH_MANY_CHECKPOINTS + code], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    seen: set[int] = set()
    for _ in range(6000):
        if (folder / file).exists():
            seen.add((folder / file).stat().st_mtime_ns)
        if len(seen) > times or process.poll() is not None:
            break
        time.sleep(0.01)
    assert process.poll() is None, process.communicate()[1]
    process.send_signal(with_signal)
    out, err = process.communicate(timeout=60)
    return subprocess.CompletedProcess([], process.returncode, out, err)


F = ss.friction


def bundled(name: str, times: float = 1.0) -> tuple[ss.Problem, float]:
    scenario = ss.load_scenario(name)
    return scenario.problem, scenario.duration * times


RUNS: dict[str, tuple[ss.Problem, float]] = {
    "slip law, slab": bundled("fig5-slab-reconstructed"),
    "rate law, leaps": bundled("second-event-perfect-delay"),
    "rate law, maximal": bundled("second-event-maximal"),
    "rate law, fragments": (ss.Problem(SLAB, F.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=0.1234, initial_excess=0.0), 2100.0),
    "folds": bundled("fig4-loop"),
    "folds, lossy": (
        ss.Problem(replace(SLAB, driver_impedance=2e6), F.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=0.0, far_stress=8.4e7),
        60.0,
    ),
    "moving folds": (ss.Problem(MATCHED, hardening(), initial_excess=1e5), 5.0),
    "moving folds, knots": (ss.Problem(THIN, KINKED, pull_rate=0.2, initial_excess=1e5), 5.0),
    "block that heals": bundled("cycles-block"),
    "slab that heals": bundled("cycles-slab", 0.4),
    "rate and state, block": bundled("rate-and-state-block", 0.1),
    "rate and state, slab": bundled("rate-and-state-slab"),
    "stiff contact mass": (
        ss.Problem(replace(SLAB, contact_mass=1e3), F.VelocityStrengthening(0.6, 0.01, 1e-6), initial_excess=1e6),
        20.0,
    ),
    "contact mass": (ss.Problem(replace(SLAB, contact_mass=1e6), F.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=1e5), 20.0),
    "steps, slab": (
        ss.Problem(
            SLAB,
            F.LinearSlipWeakening(0.6, 0.57, 0.5),
            pull_rate=ss.loading.Steps([0.0, 10.0, 20.0, 31.0], [0.0, 0.5, 0.02, -0.1]),
            initial_load=5.8e7,
        ),
        60.0,
    ),
    "tone, block": bundled("tides-block", 0.4),
    "far stress, slab": bundled("stress-pulse-slab"),
    "locked for ever": (
        ss.Problem(replace(SLAB, driver_impedance=2e6), F.LinearSlipWeakening(0.8, 0.6, 0.1), initial_excess=1e5, far_stress=7e7),
        5000.0,
    ),
}


def continued(path: Path, duration: float | None = None) -> ss.Solution:
    """Do what `ss.resume` does, but for the file that it would write in the end: that takes longer than the rest."""
    found = ss.open_solution(path)
    return resume_run(found, path, CallOptions.to_continue(found, duration))


def stopped_and_continued(first: ss.Solution, duration: float, folder: Path) -> ss.Solution:
    """Return the run that goes on, up to a duration (s), from the file of one that ended before."""
    save_checkpoint(first, folder / "run.nc")
    return continued(folder / "run.nc", duration)


def differences(one: ss.Solution, other: ss.Solution) -> list[str]:
    """What is not the same in two solutions, bit for bit."""
    stores = zip(one.history.store._fields, one.history.store, other.history.store, strict=True)
    found = [name for name, a, b in stores if a.shape != b.shape or a.tobytes() != b.tobytes()]
    assert one.checkpoint is not None
    assert other.checkpoint is not None
    for name in ("state", "count", "branch"):
        a, b = getattr(one.checkpoint, name), getattr(other.checkpoint, name)
        found += [] if np.array_equal(a, b, equal_nan=a.dtype.kind == "f") else [f"checkpoint {name}"]
    ends = [(run.status, run.duration, run.history.duration, run.problem) for run in (one, other)]
    return found + ([] if ends[0] == ends[1] else ["end"])


def differences_of_files(one: Path, other: Path) -> list[str]:
    """Return what is not the same in the files of two solutions, bit for bit, but for the memory in which the engine calculates."""
    with h5py.File(one) as a, h5py.File(other) as b:
        tables = [name for name in sorted({*a, *b}) if name != "engine_scratch"]
        found = [name for name in tables if name not in a or name not in b or _bits(a[name]) != _bits(b[name])]
        attributes = sorted({*a.attrs, *b.attrs})
        return found + [name for name in attributes if not np.array_equal(a.attrs.get(name), b.attrs.get(name))]


def _bits(table: h5py.Dataset) -> tuple[object, ...]:
    values = table[()]
    return table.shape, table.dtype, values.tolist() if table.dtype.hasobject else values.tobytes()
