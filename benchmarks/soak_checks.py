"""What every run must satisfy, whatever the problem."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import stickslip as ss
from benchmarks.soak_problems import Draw
from stickslip.engine.input.prepare import SLOWEST
from stickslip.foundation.errors import InputError
from stickslip.solution.observables.energy.balance import energies, epochs, heat
from stickslip.solution.observables.waves import Waves

TIMES = 101
ENERGIES = 4
"""Times at which the balance of energy is looked at."""
MOST_PIECES, MANY_PIECES, FEW_PIECES = 2000, 20_000, 500
"""Pieces that a run may have: most runs, some, and those whose every step may cost milliseconds (friction of slip and slip rate on
a massless slab)."""
EXPECTED = ("finished", "locked for ever", "event storm", "too many pieces", "negative friction")
"""What may end a run."""


@dataclass(frozen=True)
class Outcome:
    """What became of a problem: its status, and what was wrong (empty: nothing)."""

    status: str
    wrong: tuple[str, ...] = ()


class TooSlowError(Exception):
    """The engine took more than its time."""


def pieces_of(drawn: Draw, thorough: bool) -> int:
    """How many pieces the history of a problem may have."""
    if drawn.problem.folds_move:
        return FEW_PIECES
    return MANY_PIECES if thorough else MOST_PIECES


def run(drawn: Draw, limit: float, thorough: bool = True) -> Outcome:
    """Run a problem within `limit` seconds of processor time of the engine and check what comes out.

    A thorough check reads tables and energies as a user does; else they are looked at in the history, which costs a tenth.
    """
    started: list[float] = []

    def watch(report: Any) -> None:
        started.append(time.process_time())
        if started[-1] - started[0] > limit:
            raise TooSlowError(f"more than {limit:g} s at piece {report.pieces}, {report.time:.6g} of {report.duration:.6g} s")

    try:
        most = pieces_of(drawn, thorough)
        solution = ss.simulate(
            drawn.problem, drawn.duration, rtol=drawn.rtol, max_pieces=most, progress=watch if thorough else None
        )
    except InputError as error:
        return Outcome("refused: " + str(error)[:60])
    except TooSlowError as error:
        return Outcome("too slow", (str(error),))
    except Exception as error:
        return Outcome("error", (f"{type(error).__name__}: {str(error)[:100]}",))
    try:
        with np.errstate(all="ignore"):
            wrong = tuple(problems_of(solution, drawn.rtol, thorough))
    except Exception as error:
        wrong = (f"reading: {type(error).__name__}: {str(error)[:100]}",)
    return Outcome(solution.status.name, wrong)


def problems_of(run: ss.Solution, rtol: float, thorough: bool = True) -> list[str]:
    """Everything that is wrong with a run, a short text each."""
    wrong = [] if run.status.name in EXPECTED else [f"status {run.status.name}"]
    history = run.history
    if not history.duration > 0.0:
        return wrong
    if (np.diff(history.start) < -1e-12 * history.duration).any():
        wrong.append("times go back")
    times = np.linspace(0.0, history.duration, TIMES)[1:]
    found = {name: getattr(run, name)(times) for name in ("slip", "slip_rate", "traction", "load")}
    broken = [name for name, values in found.items() if not np.isfinite(values).all()]
    if broken:
        return [*wrong, f"not finite: {', '.join(broken)}"]
    wrong += _contact(run, times, found, rtol)
    if thorough:
        wrong += _tables(run)
    try:
        parts = _parts_read(run, times) if thorough else _parts_alone(run, times)
    except InputError as error:
        return wrong if "leap over creep" in str(error) else [*wrong, f"energy: {error}"]
    return wrong + _energy(run, parts, found["load"], rtol)


def _contact(run: ss.Solution, times: NDArray[np.float64], found: dict[str, NDArray[np.float64]], rtol: float) -> list[str]:
    problem, law, history, wrong = run.problem, run.problem.friction, run.history, []
    here, normal = history.find(times, "right"), run.problem.normal
    at = here.recorded()  # at rest that was leaped over the contact is as it was before
    rate, traction, mode = found["slip_rate"], found["traction"], np.where(here.at_rest, 0, history.store.mode[at.piece])
    walked = np.where(law.counts == "path", mode, 1) * history.grown(at)
    slip = problem.law_slip + history.store.law_slip[at.piece] + walked
    slips, size = mode != 0, max(normal, float(np.abs(found["load"]).max()))
    state, fastest = history.state(at), _fastest_near(history, at)
    if not law.sticks:
        fastest = np.maximum(fastest, SLOWEST * min(law.rate_scales))
    by_law = [mode * normal * law.coefficient(slip, np.abs(v), state) for v in _within(np.abs(rate), 100.0 * rtol * fastest)]
    over = np.maximum(traction - np.max(by_law, axis=0), np.min(by_law, axis=0) - traction)
    if isinstance(problem.body, ss.ElasticSlab):
        over -= problem.body.impedance * 100.0 * rtol * fastest
    off = over[slips].max(initial=0.0) / size
    if off > max(1e-8, 100.0 * rtol):
        wrong.append(f"traction off the law by {off:.1e}")
    held = normal * (law.coefficient(slip, 0.0, history.state(at)) + law.static_excess)
    over = (np.abs(traction) - held)[~slips].max(initial=0.0) / size
    if over > max(1e-11, 0.0):
        wrong.append(f"rest above the static strength by {over:.1e}")
    floor = 1e-12 * float(np.abs(rate).max())  # rounding where slip ends
    if (traction * rate < -max(1e-8, rtol) * size * np.maximum(_fastest_near(history, at), floor)).any():
        wrong.append("friction does work")
    body = problem.body
    if isinstance(body, ss.ElasticSlab) and body.contact_mass == 0.0:
        gap = np.abs(body.impedance * rate + traction - found["load"]).max() / size
        if gap > 1e-12:
            wrong.append(f"Z v + tau is not the load by {gap:.1e}")
    return wrong


def _fastest_near(history: Any, at: Any) -> NDArray[np.float64]:
    """Largest slip rate in the pieces that hold some times: rtol is a share of it."""
    inside = np.linspace(0.0, 1.0, 9)
    powers = inside[:, None] ** np.arange(history.store.rate.shape[1])
    return np.abs(history.store.rate[at.piece] @ powers.T).max(axis=1)


def _within(rate: NDArray[np.float64], error: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """Slip rates as far from the given ones as an error allows: it counts where friction goes with the logarithm of the rate."""
    return [np.maximum(rate - error, 0.0), rate, rate + error]


def _tables(run: ss.Solution) -> list[str]:
    wrong, events, shocks = [], run.events, run.shocks
    if not np.isfinite(events[["start", "slip", "peak_rate", "peak_time"]].to_numpy(float)).all():
        wrong.append("events not finite")
    if not np.isfinite(shocks.select_dtypes("number").to_numpy(float)).all():
        wrong.append("shocks not finite")
    if (
        len(events) > 1
        and (events.start.to_numpy()[1:] < events.end.to_numpy()[:-1] - 4.0 * np.spacing(run.history.duration)).any()
    ):
        wrong.append("events overlap")
    return wrong


def _parts_read(run: ss.Solution, times: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """Energies since the start as a user reads them, at a few times."""
    energy = run.energy(times[:: TIMES // 10])
    return {name: energy[name].to_numpy() for name in ("work", "stored", "heat", "balance")}


def _parts_alone(run: ss.Solution, times: NDArray[np.float64]) -> dict[str, NDArray[np.float64]]:
    """The same, of what enters the balance alone, at fewer times."""
    history, body = run.history, run.problem.body
    at = history.find(np.append(0.0, times[(TIMES - 2) :: -(TIMES // ENERGIES)][::-1]), "right")
    if isinstance(body, ss.ElasticSlab):
        waves, moments = Waves(history, body), epochs(history, at)
        moving = 0.5 * body.contact_mass * history.rate(at) ** 2
        parts = {"work": np.array([waves.work(now) for now in moments]), "damped": np.zeros(len(moments))}
        parts |= {"stored": np.array([waves.stored(now) for now in moments]) + moving, "heat": heat(history, at)}
    else:
        parts = {name: values for name, values in energies(history, at).items() if name in ("work", "stored", "heat", "damped")}
    since = {name: values[1:] - values[0] for name, values in parts.items()}
    return since | {"balance": since["work"] - since["stored"] - since["heat"] - since["damped"]}


def _exchanged(run: ss.Solution) -> float:
    """Size of the kinetic and radiated energy that goes to and fro in a run, of which the sums hold only the differences."""
    history, body = run.history, run.problem.body
    fastest = float(np.abs(run.slip_rate(np.linspace(0.0, history.duration, TIMES))).max())
    if isinstance(body, ss.ElasticSlab):
        return fastest**2 * (body.contact_mass + body.impedance * min(history.duration, body.two_way_time))
    return fastest**2 * body.mass


def _in_the_driver(problem: ss.Problem) -> float:
    """Kinetic energy of a slab that is sheared at the pull rate with which the run begins."""
    body = problem.body
    return body.density * body.thickness * problem.first_pull_rate**2 if isinstance(body, ss.ElasticSlab) else 0.0


def _energy(run: ss.Solution, parts: dict[str, NDArray[np.float64]], loads: NDArray[np.float64], rtol: float) -> list[str]:
    problem, body = run.problem, run.problem.body
    if not all(np.isfinite(values).all() for values in parts.values()):
        return ["energy not finite"]
    size = max(float(np.abs(values).max()) for name, values in parts.items() if name != "balance")
    load = max(problem.normal, float(np.abs(loads).max()))
    size = max(size, float(np.ptp(loads)) * load / body.stiffness, _exchanged(run))
    rows = run.history.duration / run.history.round_trip_time
    rounding = (1e-14 + 1e-16 * rows) * (load**2 / (2.0 * body.stiffness) + _in_the_driver(problem))
    off = float(np.abs(parts["balance"]).max())
    wrong = []
    if off > max(1e-8, 1000.0 * rtol) * size + rounding:
        wrong.append(f"energy off by {off / size:.1e}")
    if (np.diff(parts["heat"]) < -1e-12 * size - rounding).any():
        wrong.append("heat falls")
    return wrong
