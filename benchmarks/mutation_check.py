"""A fixed suite of problems whose results are hashed: says in seconds whether a change of the source changes anything at all.

python -m benchmarks.mutation_check             # one JSON object: hash by problem and by what is read
python -m benchmarks.mutation_check --compare   # what differs from the hashes that are kept in results/hashes.json
python -m benchmarks.mutation_check --keep      # keep the new ones there

The hashes are those of one processor: on another one, run `--keep` on the commit before, and then `--compare`.
"""

from __future__ import annotations

import hashlib
import json
import sys
import warnings
from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

import stickslip as ss
from stickslip.engine.state.layout import Store

KEPT = Path(__file__).parent / "results" / "hashes.json"
"""The hashes that are kept in the repository."""
F = ss.friction
SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
BLOCK = ss.SpringBlock(2.8e12, 3.43e13, 1e14, 1e11)
RATE = F.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
SLIP = F.SinusoidalSlip(1.0, 0.5, 50.0)
HARDENING = F.SlipPlusRate(F.PiecewiseLinearSlip(slips=(0.0, 100.0), coefficients=(0.0, 5.0)), RATE)


def problems() -> Iterator[tuple[str, ss.Problem, float]]:
    """Name, problem and duration (s) of each."""
    year = 31_557_600.0
    pull = 0.05 / year
    matched, heavy = replace(SLAB, driver_impedance=SLAB.impedance), replace(SLAB, contact_mass=1e6)
    for rule in ("perfect-delay", "maxwell", "minimal", "maximal"):
        yield f"rate law, {rule}", ss.Problem(SLAB, RATE, pull_rate=pull, initial_excess=0.0, selection=rule), 480 * year
        loop = ss.Problem(replace(SLAB, driver_impedance=0.0), RATE, pull_rate=2.6, initial_load=6e7, selection=rule)
        yield f"loop, {rule}", loop, 8.0
    yield "pulses", ss.Problem(SLAB, SLIP, initial_excess=3430.0), 12.0
    yield "pulses, loaded", ss.Problem(SLAB, SLIP, pull_rate=0.01, initial_excess=3430.0), 30.0
    yield "hardening, matched", ss.Problem(matched, HARDENING, initial_excess=1e5), 30.0
    yield "contact mass", ss.Problem(heavy, RATE, pull_rate=0.1, initial_excess=0.0), 14.0
    yield "backwards", ss.Problem(SLAB, F.Coulomb(0.6, 0.3), initial_load=-61e6), 12.0
    yield (
        "lossy",
        ss.Problem(replace(SLAB, driver_impedance=3e6), F.LinearSlipWeakening(0.6, 0.3, 2.0), pull_rate=0.1, initial_excess=1e6),
        25.0,
    )
    healing = F.LinearSlipWeakening(static=0.60, dynamic=0.57, distance=0.02, memory="since-arrest")
    yield (
        "cycles",
        ss.Problem(ss.SpringBlock(2.8e12, 3.43e13, 1e14), healing, pull_rate=0.035 / year, initial_excess=0.0),
        30 * year,
    )
    for name, law in _laws().items():
        yield f"block, {name}", ss.Problem(BLOCK, law, pull_rate=0.05, initial_excess=1e12), 6.0
        yield f"slab, {name}", ss.Problem(SLAB, law, pull_rate=0.05, initial_excess=1e6), 14.0
    fault = F.RateAndState(reference=0.6, a=0.010, b=0.015, distance=5e-3, rate=1e-6, evolution="ageing")
    yield "rate and state", ss.Problem(SLAB, fault, pull_rate=1e-3, initial_load=6.2e7, initial_state=1e3), 12.0
    tone = ss.loading.Sinusoidal(mean=0.01, amplitude=0.05, period=3.0)
    yield "tone", ss.Problem(BLOCK, F.Coulomb(0.6, 0.5), pull_rate=tone, initial_load=5e13), 20.0
    steps = ss.loading.Steps((0.0, 2.0, 9.0), (0.0, 0.3, -0.4))
    yield "steps", ss.Problem(SLAB, F.PowerStribeck(0.6, 0.4, 0.1, 2.0), pull_rate=steps, initial_load=5.9e7), 20.0


def _laws() -> dict[str, Any]:
    return {
        "bump": F.FromExpression("0.6 + a*exp(-((u - c)/w)**2)", {"a": 0.05, "c": 0.1, "w": 0.01}),
        "stribeck": F.ExponentialStribeck(0.6, 0.4, 0.05, 1.0, 0.01),
        "table": F.FromTable(friction=(0.6, 0.5, 0.52, 0.4), slip=(0.0, 0.05, 0.1, 0.4)),
        "lagged": F.LaggedFriction(RATE, 0.05),
        "rate knots": F.PiecewiseLinearRate(rates=(0.0, 0.1, 0.5), coefficients=(0.6, 0.45, 0.5)),
    }


def readings(run: ss.Solution) -> dict[str, Callable[[], Any]]:
    """What is read from a run, by name."""
    end = run.history.duration
    times = np.linspace(0.0, min(end, 30.0), 24)
    store = run.history.store
    found: dict[str, Callable[[], Any]] = {
        "history": lambda: [np.asarray(part).tobytes() for part in without_bounds(store) if isinstance(part, np.ndarray)],
        "bounds": lambda: np.asarray(store.residual),
        "values": lambda: [run.slip(times), run.slip_rate(times, "left"), run.traction(times), run.load(times, "left")],
        "events": lambda: run.catalogue(0.0, energy=True).to_numpy(float),
        "shocks": lambda: run.shocks.select_dtypes("number").to_numpy(float),
        "energy": lambda: run.energy(times[::4]).to_array().to_numpy(),
        "energetics": lambda: run.energetics().to_numpy(float),
        "pulses": lambda: run.pulses().to_numpy(float),
        "notes": lambda: [run.selection_note.encode(), run.horizon_note.encode(), run.trapped_note.encode()],
    }
    if isinstance(run.problem.body, ss.ElasticSlab):
        depths = np.linspace(0.0, run.problem.body.thickness, 4)
        found["field"] = lambda: [np.asarray(part) for part in run.field(depths, times[1::4, None])]
        found["uniqueness"] = lambda: numbers_of(ss.uniqueness(run.problem)).encode()
        found["admissible"] = lambda: [ss.uniqueness(run.problem).admissible(load * 1e6) for load in (20, 45, 62, 66, 70, 79, 90)]
        found["stability"] = lambda: [ss.uniqueness(run.problem).stability(load * 1e6) for load in (20, 45, 62, 66, 70, 79, 90)]
    return found


def numbers_of(answer: Any) -> str:
    """Return all numbers of an answer about uniqueness, to the last digit, whatever words it is told in."""
    if isinstance(answer, tuple):
        return f"({', '.join(map(numbers_of, answer))})"
    if not is_dataclass(answer):
        return repr(answer)
    without = ("resistance", "problem", "summary")
    return numbers_of(tuple(getattr(answer, one.name) for one in fields(answer) if one.name not in without))


def without_bounds(store: Store) -> Store:
    """A copy of a history without the bounds of its steps, which are hashed apart: they change no motion."""
    bare = store._replace(pieces=store.pieces.copy())
    bare.residual[:] = 0.0
    return bare


def digest(made: Callable[[], Any]) -> str:
    """Hash of a reading; the kind and text of the error where there is one."""
    try:
        return hashlib.sha256(_bytes(made())).hexdigest()[:16]
    except Exception as error:
        return f"{type(error).__name__}: {str(error)[:60]}"


def _bytes(value: Any) -> bytes:
    if isinstance(value, bytes):
        return value
    if isinstance(value, list | tuple):
        return b"|".join(_bytes(one) for one in value)
    return np.ascontiguousarray(value).tobytes()


def runs() -> dict[str, ss.Solution | str]:
    """The solution of each problem, or the error."""
    found: dict[str, ss.Solution | str] = {}
    for name, problem, duration in problems():
        try:
            found[name] = ss.simulate(problem, duration, max_pieces=50_000)
        except Exception as error:
            found[name] = f"{type(error).__name__}: {str(error)[:60]}"
    return found


def measured(solutions: dict[str, ss.Solution | str]) -> dict[str, str]:
    """Hashes by problem and by what is read."""
    found: dict[str, str] = {"year": digest(lambda: np.array(ss.YEAR))}
    for name, run in solutions.items():
        if isinstance(run, str):
            found[name] = run
        else:
            found |= {f"{name}: {what}": digest(made) for what, made in readings(run).items()}
    return found


def main(arguments: list[str]) -> int:
    """Print the hashes, compare them with those that are kept, or keep them. Return 1 if any differs."""
    warnings.simplefilter("ignore")
    found = measured(runs())
    if arguments == ["--keep"]:
        KEPT.write_text(json.dumps(found, indent=0, sort_keys=True) + "\n")
    elif arguments == ["--compare"]:
        kept = json.loads(KEPT.read_text())
        differ = sorted(name for name in {*kept, *found} if kept.get(name) != found.get(name))
        sys.stdout.write("".join(f"{name}\n" for name in differ) + f"{len(differ)} of {len(kept)} differ\n")
        return int(bool(differ))
    else:
        sys.stdout.write(json.dumps(found) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
