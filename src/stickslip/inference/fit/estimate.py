"""Search for the free numbers that fit a record best: starts from a screened sample, least squares, and the noise that remains."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from typing import NamedTuple

import numpy as np
import pandas as pd

from stickslip.foundation.arrays import Floats
from stickslip.inference.fit.memory import Memory, ResidualBlock, memory_of
from stickslip.inference.fit.model import Model
from stickslip.inference.fit.part import Part
from stickslip.inference.fit.search import (
    COMPETES,
    Best,
    Tell,
    is_far,
    is_rough,
    light,
    polished,
    searched_minima,
    sharp_cost,
    solved,
)
from stickslip.inference.record.loading import loading_of
from stickslip.inference.record.noise import GAUSSIAN, cost_of

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
        near = not is_far(model, sharp_cost(model, x, loss))
        for width in NARROWING[-1:] if near else NARROWING:
            tell(f"fit to jumps that are spread over {width} samples")
            x = solved(model.with_(blur=width).fine(x), x, loss, thorough=True)
        ends.append((cost_of(model.with_(blur=NARROWING[-1]).residual(x), loss), x))
    return min(ends, key=lambda one: one[0])[1]


def _with_noise(model: Model, searched: Floats, loss: str, tell: Tell, best: Best) -> Estimate:
    """Return the best fit, with the sizes of the noise and then its memory, which moves the fit only against what was known before.

    Several quantities are weighed by the sizes of their noise, which are estimated in turn with the fit until both stay.
    """
    for turn in range(ROUNDS):
        tell(f"fit {turn + 1} to all samples")
        best.cost = np.inf
        before = searched
        model = model.with_jumps(searched).fine(searched)
        searched = solved(model, searched, loss, best, thorough=True)
        if model.of_means:
            return Estimate(model, searched, loss=loss)
        by = model.jacobian(searched)
        new = _noise(model, searched, by, loss)
        same = all(abs(new.sizes[k] / model.sizes[k] - 1.0) < 0.1 for k in new.sizes)
        settled = turn > 0 and np.all(np.abs(searched - before) < SETTLED * _widths(by[: model.samples]))
        keeps = turn == 0 and not model.unsure and loss == "linear" and len(model.sizes) == 1
        known = len(model.priors(searched)) > 0
        model = new
        if (keeps and not known) or (settled and same):
            break
    return Estimate(model, searched, loss=loss)


def _noise(model: Model, searched: Floats, by: Floats, loss: str) -> Model:
    """Return the model with sizes and memory of the noise of each quantity, from what a fit leaves."""
    sizes, memory = dict(model.sizes), {}
    residual = np.concatenate([model.part_residual(searched, i) for i in range(len(model.parts))])
    for name, rest, slopes, weight, blocks in pieces_of(model, residual, by):
        rest, slopes = rest / weight, slopes / weight[:, None]
        found = memory_of(rest, slopes, blocks)
        size = max(found.total if loss == "linear" else float(np.median(np.abs(rest))) / GAUSSIAN, 1e-12)
        given = any(name in part.record.deviations for part in model.parts)
        size = size if not given else max(size, 1.0 / model.sizes[name])
        sizes[name] = model.sizes[name] * size
        memory[name] = Memory(found.time, found.size / size, found.white / size)
    return model.with_(sizes=sizes, memory=memory)


class QuantityPiece(NamedTuple):
    """What belongs to a quantity in all parts: residuals, rows of a matrix, weights of the samples, and blocks of neighbours."""

    name: str
    residual: Floats
    rows: Floats
    weight: Floats
    blocks: list[ResidualBlock]


def pieces_of(model: Model, residual: Floats, matrix: Floats) -> Iterator[QuantityPiece]:
    """Yield the residuals of each quantity with the rows of a matrix that belong to them."""
    blocks_of = [model.blocks(i) for i in range(len(model.parts))]
    begins = np.append(0, np.cumsum([blocks[-1][1].rows.stop for blocks in blocks_of]))
    for name in model.sizes:
        blocks, places, weights, count = list[ResidualBlock](), list[Floats](), list[Floats](), 0
        for i, part in enumerate(model.parts):
            for quantity, block in blocks_of[i]:
                if quantity == name:
                    length = block.rows.stop - block.rows.start
                    places.append(begins[i] + np.arange(block.rows.start, block.rows.stop))
                    weights.append(model.weights(i)[np.isfinite(part.record.measured[name][:: model.every])])
                    blocks.append(ResidualBlock(slice(count, count + length), block.time))
                    count += length
        rows = np.concatenate(places)
        yield QuantityPiece(name, residual[rows], matrix[rows], np.concatenate(weights), blocks)


def _widths(by: Floats) -> Floats:
    """Return rough standard uncertainties of the searched numbers, each as if the others were known."""
    sizes = np.linalg.norm(by, axis=0)
    return np.asarray(1.0 / np.maximum(sizes, 1e-12))


def _competing(model: Model, best: Floats, others: list[Floats], every: int) -> tuple[Floats, ...]:
    """Return minima that fit almost as well as the best one, and are elsewhere."""
    thin = model.with_(every=every, unsure={})
    if not others:
        return ()
    lowest, width = cost_of(thin.residual(best)), _widths(thin.jacobian(best))
    found: list[Floats] = []
    for x in others:
        apart = all(np.any(np.abs(x - one) > np.maximum(APART * width, 0.05)) for one in [best, *found])
        if apart and cost_of(thin.residual(x)) - lowest < COMPETES:
            found.append(x)
    return tuple(found)


KEPT_BEFORE, KEPT_AFTER = (1.0, 0.5), (1.0, 0.75, 0.5, 0.35)
"""Shares that are kept of the time before the first change of the pull rate, and after the last one."""
LEAST = 10
"""Smallest number of samples for each free number."""


def windows_of(found: Estimate, tell: Tell) -> pd.DataFrame:
    """Return the numbers that are found from shorter parts of a record, one row each, the whole record first."""
    labels = [one.label for one in found.model.free]
    rows = [(0.0, found.model.parts[0].duration, found.model.samples, *found.model.values(found.searched))]
    for shares in list(product(KEPT_BEFORE, KEPT_AFTER))[1:]:
        parts = [_cut(part, found, *shares) for part in found.model.parts]
        model = found.model.with_(parts=tuple(part for part in parts if part is not None), unsure={})
        if len(model.parts) < len(parts) or model.samples < LEAST * len(labels):
            continue
        begin = float(model.parts[0].record.time[0] - found.model.parts[0].record.time[0])
        tell(f"the record from {begin:.4g} s on, {model.parts[0].duration:.4g} s long")
        searched = solved(model.with_jumps(found.searched).fine(found.searched), found.searched, found.loss, thorough=True)
        rows.append((begin, begin + model.parts[0].duration, model.samples, *model.values(searched)))
    table = pd.DataFrame(rows, columns=["begin", "end", "samples", *labels])
    return table.drop_duplicates(["begin", "end"], ignore_index=True)


def _cut(part: Part, found: Estimate, before: float, after: float) -> Part | None:
    """Return a part without some of its begin and of its end; None if that is not possible.

    A record without a load point keeps its begin, where the loading of the problem begins.
    """
    clock, changes = part.record.clock, part.changes(found.model.problem)
    first, last = (float(changes[0]), float(changes[-1])) if len(changes) else (clock[-1], 0.0)
    begin = 0.0 if part.loading is None else (1.0 - before) * first
    end = last + after * (clock[-1] - last)
    if not 0.0 <= begin < end or (before < 1.0 and begin == 0.0):
        return None
    record = part.record.part(float(part.record.time[0]) + begin, float(part.record.time[0]) + end)
    if begin == 0.0:
        return replace(part, record=record)
    loading = loading_of(record)
    return replace(part, record=record, loading=None if loading is None else loading.rate)
