"""Search for the free numbers that fit a record best: starts from a screened sample, least squares, and the noise that remains."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.studies.inference.model import Model
from stickslip.studies.inference.noise import GAUSSIAN, Block, cost_of, memory_of
from stickslip.studies.inference.search import COMPETES, Best, Tell, is_rough, light, polished, searched_minima, solved

FEW = 1500
"""Number of samples of a part with which starts are compared and followed."""

ROUGH = 1.2
"""Size of residuals, in the noise of neighbouring samples, from which a best fit is searched once more without derivatives."""
ROUNDS = 4
"""Largest number of times that noise and numbers are estimated in turn."""
SETTLED = 0.05
"""Change of a number, in standard uncertainties, that asks for no further turn."""
NARROWING = (64, 16, 4)
"""Numbers of samples over which jumps of a run are spread one after the other, so that a fit finds those of the record."""
APART = 5.0
"""Distance of two minima, in standard uncertainties, from which they are two."""


@dataclass(frozen=True)
class Estimate:
    """The result of a search: the model, with the size and the memory of the noise as they were estimated, and the best fit.

    `others` are searched numbers of other minima that compete; `finished` is False after Ctrl-C; `loss` is the function of squared
    residuals that is summed.
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
        thin = light(model.thinned(FEW)).with_(blur=NARROWING[0])
        minima = searched_minima(thin, starts, loss, seed, tell=tell, best=best)
        searched = _at_jumps(model, [x for _, x in minima], loss, tell)
        best.cost, best.searched = np.inf, searched
        found = _with_noise(model, searched, loss, tell, best)
        misses = any(size > ROUGH * model.sizes[name] for name, size in found.model.sizes.items())
        if starts > 1 and misses and is_rough(found.model, found.searched):
            tell("polishing without derivatives")
            better = polished(found.model, found.searched, loss)
            if found.cost(better) < found.cost(found.searched) - COMPETES:
                found = _with_noise(model, better, loss, tell, best)
        return replace(found, others=_competing(found.model, found.searched, [x for _, x in minima[1:]], thin.every))
    except KeyboardInterrupt:
        if not len(best.searched):
            raise
        return Estimate(found.model.with_(every=model.every), best.searched, finished=False, loss=loss)


def _at_jumps(model: Model, minima: list[Floats], loss: str, tell: Tell) -> Floats:
    """Return the best of some minima; where runs jump, each follows its jumps, spread less and less, to those of the record."""
    ends = []
    if not any(model.with_jumps(x).unsure for x in minima):
        return minima[0]
    for x in minima:
        for width in NARROWING:
            tell(f"fit to jumps that are spread over {width} samples")
            x = solved(model.with_(blur=width).fine(x), x, loss, thorough=True)
        ends.append((cost_of(model.with_(blur=NARROWING[-1]).residual(x), loss), x))
    return min(ends, key=lambda one: one[0])[1]


def _with_noise(model: Model, searched: Floats, loss: str, tell: Tell, best: Best) -> Estimate:
    """Return the best fit and the noise, estimated in turn until both stay."""
    for turn in range(ROUNDS):
        tell(f"fit {turn + 1} to all samples")
        best.cost = np.inf
        before = searched
        model = model.with_jumps(searched).fine(searched)
        searched = solved(model, searched, loss, best, thorough=True)
        if model.of_means:
            return Estimate(model, searched, loss=loss)
        by = model.jacobian(searched, white=False)
        new = _noise(model, searched, by, loss)
        if turn == 0 and not model.unsure and loss == "linear" and _keeps_minimum(model, new):
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


def _noise(model: Model, searched: Floats, by: Floats, loss: str) -> Model:
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
