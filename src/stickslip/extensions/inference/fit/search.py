"""Search for the numbers that fit a record best: least squares from several starts, and a search without derivatives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from stickslip.extensions.inference.fit.looks import looks_of
from stickslip.extensions.inference.fit.model import FAILED, Model
from stickslip.extensions.inference.fit.pieces import pieces_of
from stickslip.extensions.inference.fit.progress import Tell
from stickslip.extensions.inference.fit.starting import slides
from stickslip.extensions.inference.fit.what_is_left import words
from stickslip.extensions.inference.record.noise import OUTLYING, cost_of
from stickslip.extensions.inference.record.resample import RAMP
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

COMPETES = 20.0
"""Another minimum competes with the best one if twice the log-likelihoods differ by less than this."""
SCREENED = 12
"""Number of draws for each start that is kept."""
STEPS_BEFORE_COMPARISON = 8
"""Starts are compared again after this many steps of least squares."""
FOLLOWED, HOPELESS = 3, 30.0
"""At most this many starts are followed to their end, those with a sum of squares below this multiple of the least."""
FAR, FAR_SHARE = 5.0, 0.3
"""A search goes on without derivatives if residuals exceed both FAR times the noise of neighbouring samples and FAR_SHARE times the
scatter of the record; correlated noise exceeds the first but stays far below the second."""
AVERAGED = (0.1, 0.02, 0.005, 0.0)
"""Widths of the averages over residuals in a search without derivatives, from coarse to fine, as shares of the samples."""
GENERATIONS = 60
"""Largest number of generations of such a search."""
LIGHT = 2000
"""Largest number of pieces of a run while starts are compared; three times the pieces of the first start's run, if that is more."""


@dataclass
class Best:
    """The best numbers so far: the result after Ctrl-C."""

    cost: float = np.inf
    searched: Floats = field(default_factory=lambda: np.zeros(0))


def solved(model: Model, start: Floats, loss: str, best: Best | None = None, *, thorough: bool = False, most: int = 40) -> Floats:
    """Return the least-squares solution from one start, as searched numbers; a thorough search takes central differences."""
    from scipy.optimize import least_squares

    low, high = model.limits
    low, high = np.minimum(low, high - 1e-9), np.maximum(high, low + 1e-9)

    def residual(x: Floats) -> Floats:
        rest = model.residual(x)
        cost = float(rest @ rest)
        if best is not None and cost < best.cost:
            best.cost, best.searched = cost, x.copy()
        return rest

    tolerance = 1e-9 if thorough else 1e-4
    room = 1e-9 * np.maximum(1.0, np.abs(start))
    inside = np.clip(start, np.minimum(low + room, high), np.maximum(high - room, low))
    sides = (1.0, -1.0) if thorough else (1.0,)
    found = least_squares(
        residual,
        inside,
        lambda x: model.jacobian(x, sides=sides),
        (low, high),
        **{"x_scale": "jac", "loss": loss, "f_scale": OUTLYING, "max_nfev": most},
        **{"ftol": tolerance, "xtol": 1e-2 * tolerance, "gtol": 1e-12},
    )
    return np.asarray(found.x)


def is_rough(model: Model, x: Floats) -> bool:
    """Return True if left and right derivatives of the residuals differ, as where a jump passes a sample."""
    right, left = model.jacobian(x, sides=(1.0,)), model.jacobian(x, sides=(-1.0,))
    size = np.linalg.norm(right + left, axis=0)
    return bool((np.linalg.norm(right - left, axis=0) > 0.2 * size).any())


def polished(model: Model, start: Floats, loss: str) -> Floats:
    """Return a better fit by simplexes of falling size; least squares stops too early where a jump passes a sample."""
    from scipy.optimize import minimize

    low, high = model.limits
    x = start
    for size in (3e-3, 1e-3, 3e-4):
        simplex = np.clip(x + np.vstack([np.zeros(len(x)), size * np.eye(len(x))]), low, high)
        options = {"maxfev": 150 * len(x), "initial_simplex": simplex, "adaptive": True}
        x = np.clip(minimize(lambda y: cost_of(model.residual(y), loss), x, method="Nelder-Mead", options=options).x, low, high)
    return np.asarray(x)


def light(model: Model) -> Model:
    """Return the model with a limit on pieces: runs end early if they need many more than the run at the start of the search."""
    needed = [len(run.history) for i in range(len(model.parts)) if (run := model.solve(model.begin, i)) is not None]
    return model.with_(max_pieces=min(model.max_pieces, max(LIGHT, 3 * max(needed, default=model.max_pieces))))


def searched_minima(model: Model, starts: int, loss: str, seed: int, *, tell: Tell, best: Best) -> list[tuple[float, Floats]]:
    """Return the minima that searches from several starts reach, best first. Raises InputError if no run succeeds."""
    first = [model.begin] if np.array_equal(model.begin, model.given) else [model.begin, model.given]
    known, screened = list[tuple[float, Floats]](), []
    for x in first:
        cost = _cost(model, x, loss)
        if np.isfinite(cost):
            known = sorted([*known, (cost, x)], key=lambda one: one[0])
            best.cost, best.searched = known[0]
    if starts > 1 or not known:
        drawn = _drawn(model, SCREENED * max(starts - 1, 2), seed)
        for i, x in enumerate(drawn):
            tell(f"start {i + 1} of {len(drawn)}")
            screened.append((_cost(model, x, loss), x))
    screened = sorted((one for one in screened if np.isfinite(one[0])), key=lambda one: one[0])
    chosen = [*known, *screened][:starts] if starts == 1 else [*known, *screened[: max(starts - len(known), 1)]]
    if not chosen:
        _refuse(model)
    minima = []
    for i, (_, x) in enumerate(chosen):
        tell(f"search {i + 1} of {len(chosen)}")
        minima.append(_followed(model, x, loss, best, STEPS_BEFORE_COMPARISON))
    minima.sort(key=lambda one: one[0])
    if starts > 1 and is_far(model, minima[0][0]) and (why := told_by(model, minima[0][1])):
        tell(f"no run can follow the record, of which {why} is left: the search ends soon")
    elif starts > 1 and is_far(model, minima[0][0]):
        minima.append(_followed(model, _by_evolution(model, seed, tell), loss, best, STEPS_BEFORE_COMPARISON))
        minima.sort(key=lambda one: one[0])
    followed = [one for one in minima[:FOLLOWED] if one[0] < HOPELESS * minima[0][0] + COMPETES]
    ends = []
    for i, (_, x) in enumerate(followed):
        tell(f"search {i + 1} of {len(followed)}, to its end")
        ends.append(_followed(model, x, loss, best))
    return sorted(ends, key=lambda one: one[0])


def _followed(model: Model, x: Floats, loss: str, best: Best, most: int = 40) -> tuple[float, Floats]:
    """Return the cost and numbers at the end of a search, or at its start if the spread jumps have led it away."""
    end = solved(model, x, loss, best, most=most)
    return min(((sharp_cost(model, one, loss), one) for one in (end, x)), key=lambda one: one[0])


def sharp_cost(model: Model, x: Floats, loss: str) -> float:
    """Return the cost with sharp jumps of the run, each beside the nearest jump of the record within some samples."""
    return _cost(model.with_(blur=RAMP).with_jumps(x), x, loss)


def is_far(model: Model, cost: float) -> bool:
    """Return True if the cost is so large that the run does not come near the record."""
    return cost > max(FAR**2 * model.samples, FAR_SHARE**2 * model.scatter)


TOLD = 0.5
"""If a drift or an offset makes up this share of what is left, no search for events goes on."""


def told_by(model: Model, searched: Floats) -> str:
    """Return what is left of a record that slides all the time if it is mostly a drift or an offset; otherwise an empty text.

    No event is then at a wrong time, which a search without derivatives would mend: the runs lack something, and words say what.
    """
    if model.of_means or not all(slides(model.problem, part) for part in model.parts):
        return ""
    name = next(iter(model.sizes))
    pieces = {one.name: one for one in pieces_of(model, model.residual(searched), model.jacobian(searched, sides=(1.0,)))}
    looks = looks_of(model, searched, name, pieces[name].rows)
    plain = sum(one.share for one in looks if one.kind.startswith(("drift", "offset")))
    return words(looks, model.problem.unit_of(name)) if plain > TOLD else ""


def _by_evolution(model: Model, seed: int, tell: Tell) -> Floats:
    """Return where a search without derivatives ends: differential evolution (Storn & Price 1997), then simplexes.

    Derivatives do not show how to move a slip event to its time in the record. Here residuals are averaged over some time and count
    by their logarithm, so that stretches that fit well outweigh stretches that do not fit at all.
    """
    from scipy.optimize import differential_evolution, minimize

    low, high = model.limits
    shared = [i for i, one in enumerate(model.free) if one.part is None] or list(range(len(model.free)))  # others are nearly known
    begin = model.begin

    def whole(x: Floats) -> Floats:
        y = begin.copy()
        y[shared] = x
        return np.asarray(np.clip(y, low, high))

    def robust(smoothed: Model) -> Callable[[Floats], float]:
        return lambda x: float(np.log(cost_of(smoothed.residual(whole(np.asarray(x, float))), "cauchy")))

    box = [(max(model.free[i].near[0], low[i]), min(model.free[i].near[1], high[i])) for i in shared]
    box = [
        (x - 1.0, x + 1.0) if last - first <= 0.0 else (first, last) for (first, last), x in zip(box, begin[shared], strict=True)
    ]
    count = iter(range(10**9))
    found = differential_evolution(
        robust(model.with_(smooth=AVERAGED[0])),
        box,
        callback=lambda *_, **__: tell(f"search without derivatives: generation {next(count) + 1} of {GENERATIONS} at most"),
        **{"maxiter": GENERATIONS, "popsize": 8, "rng": seed, "polish": False, "tol": 1e-3},
    )
    x = whole(found.x)[shared]
    for smooth in AVERAGED[1:]:
        tell(f"search without derivatives: residuals averaged over {smooth:.1%} of the record")
        simplex = np.clip(x + np.vstack([np.zeros(len(x)), 0.01 * np.eye(len(x))]), low[shared], high[shared])
        options = {"maxfev": 100 * len(x), "initial_simplex": simplex}
        x = np.asarray(minimize(robust(model.with_(smooth=smooth)), x, method="Nelder-Mead", options=options).x)
    return whole(x)


def _cost(model: Model, searched: Floats, loss: str) -> float:
    """Return the cost to minimise, inf if a run fails."""
    rest = model.residual(searched)
    return np.inf if (np.abs(rest) >= FAILED).all() or np.all(np.abs(rest[: len(rest) or 1]) >= FAILED) else cost_of(rest, loss)


def _drawn(model: Model, count: int, seed: int) -> list[Floats]:
    """Return a Latin hypercube of searched numbers around the start of the search; numbers of single parts stay."""
    from scipy.stats import qmc

    begin, shared = model.begin, [i for i, one in enumerate(model.free) if one.part is None]
    places = qmc.LatinHypercube(max(len(shared), 1), seed=seed).random(count)
    drawn = []
    for row in places:
        x = begin.copy()
        for place, i in zip(row, shared, strict=False):
            low, high = model.free[i].near
            x[i] = low + place * (high - low)
        drawn.append(x)
    return drawn


def _refuse(model: Model) -> None:
    """Raise InputError with the reason why the problem cannot be run at all."""
    from stickslip.run.simulate import simulate

    for i in range(len(model.parts)):
        try:
            problem = model.at(model.begin, i)
        except InputError as error:
            why = str(error).removeprefix("Problem: ").removeprefix("infer: ")
            raise InputError(f"infer: the problem cannot begin: {why}") from None
        run = simulate(problem, model.parts[i].duration, model.rtol, max_pieces=model.max_pieces)
        if not run.status.ok:
            raise InputError(f"infer: no run reaches the end of the record: {run.status.message}; give other values or bounds")
    raise InputError("infer: no run gives numbers that can be compared with the record: give other values or bounds")
