"""What a history really misses of its equations, in 40 digits at many places of its steps, and what it is allowed to miss.

The normal load is that of the problem, whatever the engine wrote.
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import mpmath
import numpy as np

import stickslip as ss
from stickslip.engine.history.history import History, Positions
from stickslip.friction.contract import one_argument
from stickslip.friction.formula import expression as e
from stickslip.friction.formula.operations import FUNCTIONS, OPERATIONS
from stickslip.solution.observables.given_on_discs import segment_of
from stickslip.solution.observables.proof import MotionOnDiscs, _unsure_duration
from stickslip.solution.observables.proof_of_states import sizes

DIGITS, PLACES = 40, 200
MPMATH = SimpleNamespace(
    **{name: getattr(mpmath, name) for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "expm1", "log1p")}, arcsinh=mpmath.asinh
)


def exact(tree: e.Expression, numbers: dict[str, float], variables: dict[e.Expression, Any]) -> Any:
    """A formula in the digits of mpmath."""
    found = dict(variables)
    for node in e.nodes_of(tree):
        arguments = [found[argument] for argument in node.arguments]
        if node.operation in FUNCTIONS:
            found[node] = getattr(MPMATH, node.operation)(*arguments)
        elif arguments:
            found[node] = OPERATIONS[node.operation](*arguments)
        elif node not in found:
            found[node] = mpmath.mpf(numbers[node.name] if node.operation == "parameter" else node.value)
    return found[tree]


def value_of(coefficients: list[Any], x: Any) -> Any:
    """A polynomial, ascending coefficients, at x."""
    total = mpmath.mpf(0)
    for c in reversed(coefficients):
        total = total * x + c
    return total


def slope_of(coefficients: list[Any], x: Any) -> Any:
    """Its derivative."""
    return value_of([k * c for k, c in enumerate(coefficients)][1:], x)


def pressed(history: History, n: int, x: Any) -> list[Any]:
    """The growth p of the normal load, and its rate of change, at a place in piece n; nothing if it is constant."""
    load, row, normal = history.problem.normal_load, history.store, mpmath.mpf(history.problem.normal)
    if load is None:
        return []
    part, (amplitude, frequency, phase) = load.segments[int(segment_of(load, history, np.array([n]))[0])], load.tone
    begins = int(row.trip[n]) * mpmath.mpf(history.round_trip_time) + mpmath.mpf(float(row.phase_from[n]))
    time = begins + x * (mpmath.mpf(float(row.speed[n])) + x * mpmath.mpf(float(row.bend[n])))
    angle = mpmath.mpf(frequency) * time + mpmath.mpf(phase)
    stress = mpmath.mpf(part.value) + mpmath.mpf(part.slope) * (time - mpmath.mpf(part.start)) + amplitude * mpmath.sin(angle)
    return [stress / normal - 1, (mpmath.mpf(part.slope) + amplitude * frequency * mpmath.cos(angle)) / normal]


def missed(history: History, n: int, places: int = PLACES) -> float:
    """The most (Pa or N) that piece n of a history misses of the contact equation at places on it, in DIGITS digits."""
    return _missed(history, n, places)[0]


def missed_by_states(history: History, n: int, places: int = PLACES) -> list[float]:
    """The most that each state misses of its equation at such places: what the step would add, in the unit of the state."""
    return _missed(history, n, places)[1]


def _missed(history: History, n: int, places: int) -> tuple[float, list[float]]:
    problem, row = history.problem, history.store
    law, way, own = problem.contact_law, int(row.mode[n]), len(problem.friction.states)
    with mpmath.workdps(DIGITS):
        rate, load = ([way * mpmath.mpf(float(x)) for x in table[n]] for table in (row.rate, row.load))
        speed, bend = mpmath.mpf(float(row.speed[n])), mpmath.mpf(float(row.bend[n]))
        start, piece = mpmath.mpf(problem.law_slip) + mpmath.mpf(float(row.law_slip[n])), int(row.law_piece[n])
        signs = [way if i in law.reverses else 1 for i in range(own)]
        states = [[sign * mpmath.mpf(float(x)) for x in row.state[n, i]] for i, sign in enumerate(signs)]
        worst, of_states = mpmath.mpf(0), [mpmath.mpf(0)] * own
        for x in (mpmath.mpf(k) / (places - 1) for k in range(places)):
            v, at = value_of(rate, x), {}
            grown = sum(c * x ** (k + 1) * (speed / (k + 1) + 2 * bend * x / (k + 2)) for k, c in enumerate(rate))
            at[e.SLIP], at[e.RATE] = start + (way if law.counts == "net" else 1) * grown, v
            seen = [*(value_of(c, x) for c in states), *pressed(history, n, x)]
            at |= dict(zip(e.STATES, seen, strict=False))
            mu = exact(law.trees()[piece], law.numbers(piece), at)
            g = problem.body.damping * v + problem.normal * mu - value_of(load, x) - way * mpmath.mpf(problem.strength)
            if problem.body.has_inertia:
                g += problem.body.inertia * slope_of(rate, x) / (speed + 2 * bend * x)
            worst = max(worst, abs(g))
            for i, tree in enumerate(law.state_trees()[:own]):
                off = slope_of(states[i], x) - (speed + 2 * bend * x) * exact(tree, law.numbers(piece), at)
                of_states[i] = max(of_states[i], abs(off))
        return float(worst), [float(one) for one in of_states]


def resistance(history: History, at: Positions) -> Any:
    """The traction of the law against slip under the normal load of the problem (Pa or N), in double precision."""
    problem, states = history.problem, history.states(at)
    own = states[: len(problem.friction.states)]
    for n in problem.friction.reverses:
        own[n] = np.where(history.mode(at) < 0, -own[n], own[n])
    mu = problem.friction.coefficient(history.law_slip(at), np.abs(history.rate(at)), one_argument(own))
    trip, offset = history.placed(at)
    time = trip * history.round_trip_time + offset
    if problem.normal_load is None:
        return problem.normal * mu
    start, value, slope = np.array(problem.normal_load.segments).T
    pieces, which = np.unique(at.piece, return_inverse=True)
    part = segment_of(problem.normal_load, history, pieces)[which]
    amplitude, frequency, phase = problem.normal_load.tone
    return (value[part] + slope[part] * (time - start[part]) + amplitude * np.sin(frequency * time + phase)) * mu


def missed_in_doubles(history: History) -> Any:
    """The same for all pieces of slip, in double precision and by the law's function of arrays; zero for all other pieces."""
    problem, store = history.problem, history.store
    moving = np.flatnonzero(store.mode != 0)
    x = np.tile(np.linspace(0.0, 1.0, PLACES), len(moving))
    at = Positions.inside(np.repeat(moving, PLACES), x)
    way, rate = store.mode[at.piece], history.rate(at)
    g = problem.body.damping * way * rate + resistance(history, at) - way * (history.excess(at) + problem.strength)
    if problem.body.has_inertia:
        order = np.arange(1, store.rate.shape[1])
        slope = (order * store.rate[at.piece, 1:] * x[:, None] ** (order - 1)).sum(axis=1)
        g += problem.body.inertia * way * slope / store.speed[at.piece]
    found = np.zeros(len(history))
    found[moving] = np.abs(g).reshape(-1, PLACES).max(axis=1)
    return found


_exactly: dict[bytes, float] = {}


def worst_of(run: ss.Solution) -> float:
    """The largest miss of a run (Pa or N): in DIGITS digits where double precision does not decide whether it exceeds the bound.

    Pieces that the run says are not proven, those next to a slip rate of zero, are left out.
    """
    history = run.history
    found = np.where(np.isnan(history.store.residual), 0.0, missed_in_doubles(history))
    n = int(np.argmax(found))
    if found[n] < 0.9 * run.proven.residual:
        return float(found[n])
    key = history.store.pieces[n].tobytes() + history.store.state[n : n + 1].tobytes() + repr(history.problem).encode()
    if key not in _exactly:
        _exactly[key] = missed(history, n)
    return _exactly[key]


def of_duration(history: History) -> float:
    """What inertia may miss (Pa or N) because the duration of a step is the difference of two times, which are rounded.

    The bound holds for a duration within this rounding, `missed` for the one that the history has.
    """
    moving = np.flatnonzero(history.store.mode != 0)
    thrust = np.abs(MotionOnDiscs.of(history, moving).thrust).sum(axis=1)
    return float(np.max(_unsure_duration(history, moving)[:, 0] * thrust, initial=0.0))


def worst_of_states(run: ss.Solution) -> float:
    """The largest share (1) of itself that a state really misses of its equation in one of some pieces, in DIGITS digits.

    The pieces are those with the largest change of a state in which it misses the most, seen in double precision.
    """
    history, worst = run.history, 0.0
    for i in range(len(run.problem.friction.states)):
        every = np.arange(len(history))
        size = sizes(history, every, i)
        seen = _missed_by_state(history, i) / size
        for n in np.argsort(np.nan_to_num(seen))[-2:]:
            worst = max(worst, missed_by_states(history, int(n), PLACES // 4)[i] / float(size[n]))
    return worst


def _missed_by_state(history: History, i: int) -> Any:
    """What state i misses of its equation in each piece (its unit), at 33 places, in double precision."""
    law, store = history.problem.friction, history.store
    x = np.tile(np.linspace(0.0, 1.0, 33), len(history))
    at = Positions.inside(np.repeat(np.arange(len(history)), 33), x)
    way = np.where((history.mode(at) < 0) & np.isin(i, law.reverses), -1.0, 1.0)
    states = history.states(at)[: len(law.states)]
    for n in law.reverses:
        states[n] = np.where(history.mode(at) < 0, -states[n], states[n])
    formulas = law.state_rate if isinstance(law.state_rate, tuple) else (law.state_rate,)
    with np.errstate(all="ignore"):
        change = formulas[i](SimpleNamespace(**law.numbers(0)), history.law_slip(at), np.abs(history.rate(at)), *states)
    order = np.arange(1, store.state.shape[2])
    slope = way * (order * store.state[at.piece, i, 1:] * x[:, None] ** (order - 1)).sum(axis=1)
    off = slope - (store.speed[at.piece] + 2.0 * store.bend[at.piece] * x) * change
    return np.abs(off).reshape(-1, 33).max(axis=1)
