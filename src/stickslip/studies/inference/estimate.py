"""Search for the free numbers that fit a record best: starts from a screened sample, least squares, and the noise that remains."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stickslip.foundation.errors import InputError
from stickslip.studies.inference.model import FAILED, Model
from stickslip.studies.inference.noise import GAUSSIAN, Block, memory_of

Floats = NDArray[np.float64]
Tell = Callable[[str], Any]

FEW = 1500
"""Number of samples of a part with which starts are compared and followed."""
SCREENED = 12
"""Number of draws of which one start is kept."""
FIRST = 8
"""Number of steps after which starts are compared again."""
FOLLOWED, HOPELESS = 3, 30.0
"""Number of starts that are followed to their end, and the factor by which the sum of squares of one may be above the least."""
FAR = 5.0
"""Size of residuals, in standard deviations, from which a search goes on without derivatives."""
AVERAGED = (0.1, 0.02, 0.005, 0.0)
"""Shares of the samples over which residuals are averaged in a search without derivatives, from coarse to fine."""
GENERATIONS = 60
"""Largest number of generations of such a search."""
LIGHT = 2000
"""Largest number of pieces of a run while starts are compared, unless the run of the first start needs more than a third of it."""
ROUNDS = 4
"""Largest number of times that noise and numbers are estimated in turn."""
SETTLED = 0.05
"""Change of a number, in standard uncertainties, that asks for no further turn."""
COMPETES = 20.0
"""Difference of twice the logarithm of the likelihood below which another minimum competes with the best one."""
APART = 5.0
"""Distance of two minima, in standard uncertainties, from which they are two."""
OUTLYING = 2.0
"""Residual, in standard deviations, from which a loss other than the linear one counts it less."""


@dataclass
class Best:
    """The best numbers so far, which are what Ctrl-C leaves."""

    cost: float = np.inf
    searched: Floats = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class Estimate:
    """The result of a search.

    Parameters
    ----------
    model
        The model, with the size and the memory of the noise as they were estimated.
    searched
        The searched numbers at the best fit.
    others
        Searched numbers of other minima that compete.
    finished
        False after Ctrl-C.
    loss
        The function of squared residuals that is summed.
    """

    model: Model
    searched: Floats
    others: tuple[Floats, ...] = ()
    finished: bool = True
    loss: str = "linear"

    def cost(self, searched: Floats) -> float:
        """Return the sum that the search minimises, twice the negative logarithm of the posterior but for a constant."""
        return cost_of(self.model.residual(searched), self.loss)


def estimate(model: Model, starts: int, loss: str, seed: int, tell: Tell) -> Estimate:
    """Return the best fit of a model. Raises InputError if no run succeeds, KeyboardInterrupt if Ctrl-C comes before any did."""
    best, found = Best(), Estimate(model, model.begin, loss=loss)
    try:
        thin = _light(model.thinned(FEW))
        minima = _search(thin, starts, loss, seed, tell=tell, best=best)
        searched = minima[0][1]
        best.cost, best.searched = np.inf, searched
        found = _with_noise(model, searched, loss, tell, best)
        return replace(found, others=_competing(found.model, found.searched, [x for _, x in minima[1:]], thin.every))
    except KeyboardInterrupt:
        if not len(best.searched):
            raise
        return Estimate(found.model.with_(every=model.every), best.searched, finished=False, loss=loss)


def _with_noise(model: Model, searched: Floats, loss: str, tell: Tell, best: Best) -> Estimate:
    """Return the best fit and the noise, estimated in turn until both stay."""
    for turn in range(ROUNDS):
        tell(f"fit {turn + 1} to all samples")
        best.cost = np.inf
        before = searched
        searched = solved(model, searched, loss, best, thorough=True)
        by = model.jacobian(searched, white=False)
        new = _noise(model, searched, by, loss)
        if turn == 0 and loss == "linear" and _keeps_minimum(model, new):
            return Estimate(new, searched, loss=loss)
        width = _widths(by[: model.samples])
        settled = turn > 0 and np.all(np.abs(searched - before) < SETTLED * width)
        same = all(abs(new.sizes[k] / model.sizes[k] - 1.0) < 0.1 for k in new.sizes) and new.memory.keys() == model.memory.keys()
        same = same and all(abs(new.memory[k] - model.memory[k]) <= 0.1 * model.memory[k] for k in new.memory)
        model = new
        if settled and same:
            break
    return Estimate(model, searched, loss=loss)


def _keeps_minimum(model: Model, new: Model) -> bool:
    """Return True if another size of the noise cannot move the best fit: one quantity, white noise, and nothing known before."""
    return len(model.sizes) == 1 and not any({**model.memory, **new.memory}.values()) and not len(model.priors(model.begin))


def solved(model: Model, start: Floats, loss: str, best: Best | None = None, *, thorough: bool = False, most: int = 40) -> Floats:
    """Return the searched numbers of least squares that a search from a start finds; a thorough one takes central differences."""
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
    inside = np.clip(start, low + 1e-9 * np.maximum(1.0, np.abs(low)), high - 1e-9 * np.maximum(1.0, np.abs(high)))
    sides = (1.0, -1.0) if thorough else (1.0,)
    found = least_squares(
        residual,
        np.where(np.isfinite(inside), inside, start),
        lambda x: model.jacobian(x, sides=sides),
        (low, high),
        **{"x_scale": "jac", "loss": loss, "f_scale": OUTLYING, "max_nfev": most},
        **{"ftol": tolerance, "xtol": 1e-2 * tolerance, "gtol": 1e-12},
    )
    return np.asarray(found.x)


def cost_of(residual: Floats, loss: str = "linear") -> float:
    """Return the sum that a search minimises; unless the loss is linear, residuals beyond `OUTLYING` count less than squares."""
    return OUTLYING**2 * float(np.sum(_LOSSES[loss][0]((residual / OUTLYING) ** 2)))


def weights(residual: Floats, loss: str) -> Floats:
    """Return the weight of each squared residual in the derivatives of the sum."""
    return np.asarray(_LOSSES[loss][1]((residual / OUTLYING) ** 2))


_LOSSES: dict[str, tuple[Callable[[Floats], Floats], Callable[[Floats], Floats]]] = {
    "linear": (lambda z: z, np.ones_like),
    "soft_l1": (lambda z: 2.0 * (np.sqrt(1.0 + z) - 1.0), lambda z: 1.0 / np.sqrt(1.0 + z)),
    "huber": (lambda z: np.where(z <= 1.0, z, 2.0 * np.sqrt(z) - 1.0), lambda z: 1.0 / np.sqrt(np.maximum(z, 1.0))),
    "cauchy": (np.log1p, lambda z: 1.0 / (1.0 + z)),
}
"""Functions of squared residuals, as in scipy's least_squares, and their derivatives."""
LOSSES = tuple(_LOSSES)
"""Names of the functions of squared residuals that may be summed."""


def _light(model: Model) -> Model:
    """Return the model with runs that end early if they need many more pieces than those where the search begins."""
    needed = [len(run.history) for i in range(len(model.parts)) if (run := model.solve(model.begin, i)) is not None]
    return model.with_(max_pieces=min(model.max_pieces, max(LIGHT, 3 * max(needed, default=model.max_pieces))))


def _search(model: Model, starts: int, loss: str, seed: int, *, tell: Tell, best: Best) -> list[tuple[float, Floats]]:
    """Return the minima that searches from several starts reach, best first. Raises InputError if no run succeeds."""
    begin = model.begin
    first = _cost(model, begin, loss)
    candidates = [(first, begin)]
    if np.isfinite(first):
        best.cost, best.searched = first, begin
    if starts > 1 or not np.isfinite(first):
        drawn = _drawn(model, SCREENED * max(starts - 1, 2), seed)
        for i, x in enumerate(drawn):
            tell(f"start {i + 1} of {len(drawn)}")
            candidates.append((_cost(model, x, loss), x))
    usable = [one for one in candidates if np.isfinite(one[0])]
    if not usable:
        _refuse(model)
    screened = sorted(usable[1:] if np.isfinite(first) else usable, key=lambda one: one[0])
    chosen = ([(first, begin)] if np.isfinite(first) else []) + screened[: max(starts - 1, 0) or (0 if np.isfinite(first) else 1)]
    minima = []
    for i, (_, x) in enumerate(chosen):
        tell(f"search {i + 1} of {len(chosen)}")
        end = solved(model, x, loss, best, most=FIRST)
        minima.append((_cost(model, end, loss), end))
    if starts > 1 and min(minima, key=lambda one: one[0])[0] > FAR**2 * model.samples:
        end = solved(model, _by_evolution(model, seed, tell), loss, best, most=FIRST)
        minima.append((_cost(model, end, loss), end))
    minima.sort(key=lambda one: one[0])
    followed = [one for one in minima[:FOLLOWED] if one[0] < HOPELESS * minima[0][0] + COMPETES]
    ends = (solved(model, x, loss, best) for _, x in followed)
    return sorted(((_cost(model, end, loss), end) for end in ends), key=lambda one: one[0])


def _by_evolution(model: Model, seed: int, tell: Tell) -> Floats:
    """Return where a search without derivatives ends: differential evolution (Storn & Price 1997), then simplexes.

    A slip event at another time than in the record tells derivatives nothing. Here residuals are averaged over some time, and count
    by their logarithm, so that what follows well outweighs what does not follow at all.
    """
    from scipy.optimize import differential_evolution, minimize

    def robust(smoothed: Model) -> Callable[[Floats], float]:
        return lambda x: float(np.log(cost_of(smoothed.residual(np.asarray(x, float)), "cauchy")))

    low, high = model.limits
    box = [(max(one.near[0], low[i]), min(one.near[1], high[i])) for i, one in enumerate(model.free)]
    box = [(x - 1.0, x + 1.0) if end - begin <= 0.0 else (begin, end) for (begin, end), x in zip(box, model.begin, strict=True)]
    count = iter(range(10**9))
    found = differential_evolution(
        robust(model.with_(smooth=AVERAGED[0])),
        box,
        callback=lambda *_, **__: tell(f"search without derivatives: generation {next(count) + 1} of {GENERATIONS} at most"),
        **{"maxiter": GENERATIONS, "popsize": 8, "rng": seed, "polish": False, "tol": 1e-3},
    )
    x = np.clip(found.x, low, high)
    for smooth in AVERAGED[1:]:
        tell(f"search without derivatives: residuals averaged over {smooth:.1%} of the record")
        simplex = np.clip(x + np.vstack([np.zeros(len(x)), 0.01 * np.eye(len(x))]), low, high)
        options = {"maxfev": 100 * len(x), "initial_simplex": simplex}
        x = np.clip(minimize(robust(model.with_(smooth=smooth)), x, method="Nelder-Mead", options=options).x, low, high)
    return x


def _cost(model: Model, searched: Floats, loss: str) -> float:
    """Return what is minimised, inf if a run fails."""
    rest = model.residual(searched)
    return np.inf if (np.abs(rest) >= FAILED).all() or np.all(np.abs(rest[: len(rest) or 1]) >= FAILED) else cost_of(rest, loss)


def _drawn(model: Model, count: int, seed: int) -> list[Floats]:
    """Return a Latin hypercube of searched numbers around where the search begins; numbers of single parts stay."""
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
            raise InputError(f"infer: the problem cannot begin: {str(error).removeprefix('Problem: ')}") from None
        run = simulate(problem, model.parts[i].duration, model.rtol, max_pieces=model.max_pieces)
        if not run.status.ok:
            raise InputError(f"infer: no run reaches the end of the record: {run.status.message}; give other values or bounds")
    raise InputError("infer: no run gives numbers that can be compared with the record: give other values or bounds")


def _noise(model: Model, searched: Floats, by: Floats, loss: str) -> Model:
    """Return the model with the noise that its residuals show."""
    rests = [model.part_residual(searched, i) for i in range(len(model.parts))]
    begins = np.append(0, np.cumsum([len(one) for one in rests]))
    sizes, memory = dict(model.sizes), {}
    for name in model.sizes:
        blocks: list[Block] = []
        pieces, rows, count = [], [], 0
        for i in range(len(model.parts)):
            for quantity, block in model.blocks(i):
                if quantity == name:
                    length = block.rows.stop - block.rows.start
                    pieces.append(rests[i][block.rows])
                    rows.append(by[begins[i] + block.rows.start : begins[i] + block.rows.stop])
                    blocks.append(Block(slice(count, count + length), block.time))
                    count += length
        rest, slopes = np.concatenate(pieces), np.concatenate(rows)
        found = memory_of(rest, slopes, blocks)
        size = found.size if loss == "linear" else float(np.median(np.abs(rest))) / GAUSSIAN
        given = any(name in part.record.deviations for part in model.parts)
        sizes[name] = model.sizes[name] * max(size, 1e-12) if not given else max(model.sizes[name] * size, 1.0)
        memory[name] = found.time
    return model.with_(sizes=sizes, memory=memory)


def _widths(by: Floats) -> Floats:
    """Return rough standard uncertainties of the searched numbers, each as if the others were known."""
    sizes = np.linalg.norm(by, axis=0)
    return np.asarray(1.0 / np.maximum(sizes, 1e-12))


def _competing(model: Model, best: Floats, others: list[Floats], every: int) -> tuple[Floats, ...]:
    """Return minima that fit almost as well as the best one, and are elsewhere."""
    thin = model.with_(every=every)
    if not others:
        return ()
    lowest, width = cost_of(thin.residual(best)), _widths(thin.jacobian(best))
    found: list[Floats] = []
    for x in others:
        apart = all(np.any(np.abs(x - one) > np.maximum(APART * width, 0.05)) for one in [best, *found])
        if apart and cost_of(thin.residual(x)) - lowest < COMPETES:
            found.append(x)
    return tuple(found)
