"""Search for the free numbers that fit a record best: starts from a screened sample, least squares, and the noise that remains."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import pandas as pd

from stickslip.extensions.inference.fit.loosened import loosened, settled
from stickslip.extensions.inference.fit.memory import Memory, memory_of
from stickslip.extensions.inference.fit.model import Model
from stickslip.extensions.inference.fit.part import Part
from stickslip.extensions.inference.fit.pieces import pieces_of
from stickslip.extensions.inference.fit.progress import OutOfTime, Tell
from stickslip.extensions.inference.fit.search import (
    COMPETES,
    Best,
    is_far,
    is_rough,
    light,
    polished,
    searched_minima,
    sharp_cost,
    solved,
    told_by,
)
from stickslip.extensions.inference.record.noise import GAUSSIAN, cost_of
from stickslip.foundation.arrays import Floats

SAMPLES_OF_STARTS = 1500
"""Starts are compared and followed on this many samples of a part."""

ROUGH = 1.2
"""If residuals exceed this multiple of the noise of neighbouring samples, the best fit is improved without derivatives."""
TURNS_OF_NOISE = 4
"""Largest number of times that noise and numbers are estimated in turn."""
SETTLED_NUMBERS = 0.05
"""No further turn is needed if no number changes by more than this many standard uncertainties."""
NARROWING = (64, 16, 4)
"""Jumps of a run are spread over these numbers of samples in turn, so that a fit finds the jumps of the record."""
APART_MINIMA = 5.0
"""Minima closer than this many standard uncertainties are one."""


@dataclass(frozen=True)
class Estimate:
    """The result of a search: the model with the estimated size and memory of the noise, and the best fit.

    `others` are the searched numbers at competing minima; `finished` is False after Ctrl-C, and after the end of the time, which
    `ended` then tells; `loss` is the function of squared residuals that is summed.
    """

    model: Model
    searched: Floats
    others: tuple[Floats, ...] = ()
    finished: bool = True
    loss: str = "linear"
    ended: str = ""

    def cost(self, searched: Floats) -> float:
        """Return the sum that the search minimises: minus twice the logarithm of the posterior, up to a constant."""
        return cost_of(self.model.residual(searched), self.loss)


def estimate(model: Model, starts: int, loss: str, seed: int, tell: Tell) -> Estimate:
    """Return the best fit of a model. Raises InputError if no run succeeds, KeyboardInterrupt if Ctrl-C comes before any did."""
    best, found = Best(), Estimate(model, model.begin, loss=loss)
    try:
        thin = light(model.thinned(SAMPLES_OF_STARTS)).with_(blur=NARROWING[0])
        minima = searched_minima(thin, starts, loss, seed, tell=tell, best=best)
        searched = _at_jumps(model, [x for _, x in minima], loss, tell)
        best.cost, best.searched = np.inf, searched
        loose = loosened(model, searched)
        found = Estimate(loose.model, loose.whole(searched), loss=loss)
        best.searched = found.searched
        found = _with_noise(found.model, found.searched, loss, tell, best)
        misses = any(size > ROUGH * model.sizes[name] for name, size in found.model.sizes.items())
        if starts > 1 and misses and is_rough(found.model, found.searched) and not told_by(thin, minima[0][1]):
            tell("polishing without derivatives")
            better = polished(found.model, found.searched, loss)
            if found.cost(better) < found.cost(found.searched) - COMPETES:
                found = _with_noise(found.model, better, loss, tell, best)
        return replace(found, others=_competing(found.model, found.searched, [loose.whole(x) for _, x in minima[1:]], thin.every))
    except KeyboardInterrupt as stop:
        if not len(best.searched):
            raise
        model = found.model.with_(every=model.every)
        if isinstance(stop, OutOfTime):  # a few runs more, so that intervals know what is left
            model = _noise(model, best.searched, model.jacobian(best.searched, sides=(1.0,)), loss)
        return Estimate(model, best.searched, finished=False, loss=loss, ended=str(stop))


def _at_jumps(model: Model, minima: list[Floats], loss: str, tell: Tell) -> Floats:
    """Return the best of some minima; if runs jump, fit each anew with its jumps spread over fewer and fewer samples."""
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
    """Return the best fit with the size and memory of the noise.

    Several quantities are weighted by the sizes of their noise. Fit and sizes are estimated in turn until both settle. The memory
    only sets the weight of the data against the priors.
    """
    for turn in range(TURNS_OF_NOISE):
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
        settled = turn > 0 and np.all(np.abs(searched - before) < SETTLED_NUMBERS * _widths(by[: model.samples]))
        keeps = turn == 0 and not model.unsure and loss == "linear" and len(model.sizes) == 1
        known = len(model.priors(searched)) > 0
        model = new
        if (keeps and not known) or (settled and same):
            break
    return Estimate(model, searched, loss=loss)


def _noise(model: Model, searched: Floats, by: Floats, loss: str) -> Model:
    """Return the model with sizes and memory of the noise of each quantity, from the residuals of a fit."""
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


def _widths(by: Floats) -> Floats:
    """Return rough standard uncertainties of the searched numbers, each as if the others were known."""
    sizes = np.linalg.norm(by, axis=0)
    return np.asarray(1.0 / np.maximum(sizes, 1e-12))


def _competing(model: Model, best: Floats, others: list[Floats], every: int) -> tuple[Floats, ...]:
    """Return other minima that fit almost as well as the best one."""
    thin = model.with_(every=every, unsure={})
    if not others:
        return ()
    lowest, width = cost_of(thin.residual(best)), _widths(thin.jacobian(best))
    found: list[Floats] = []
    for x in others:
        apart = all(np.any(np.abs(x - one) > np.maximum(APART_MINIMA * width, 0.05)) for one in [best, *found])
        if apart and cost_of(thin.residual(x)) - lowest < COMPETES:
            found.append(x)
    return tuple(found)


KEPT_BEFORE, KEPT_AFTER = (1.0, 0.5), (1.0, 0.75, 0.5, 0.35)
"""Shares to keep of the time before the first change of the pull rate, and after the last one."""
SAMPLES_FOR_EACH_NUMBER = 10
"""Smallest number of samples for each free number."""


def windows_of(found: Estimate, tell: Tell) -> pd.DataFrame:
    """Return the numbers fitted to shorter parts of a record, one row each, the whole record first."""
    model, searched = settled(found.model, found.searched)
    found = replace(found, model=model, searched=searched)
    labels = [one.label for one in found.model.free]
    rows = [(0.0, found.model.parts[0].duration, found.model.samples, *found.model.values(found.searched))]
    for shares in list(product(KEPT_BEFORE, KEPT_AFTER))[1:]:
        parts = [_cut(part, found, *shares) for part in found.model.parts]
        model = found.model.with_(parts=tuple(part for part in parts if part is not None), unsure={})
        if len(model.parts) < len(parts) or model.samples < SAMPLES_FOR_EACH_NUMBER * len(labels):
            continue
        begin = float(model.parts[0].record.time[0] - found.model.parts[0].record.time[0])
        tell(f"the record from {begin:.4g} s on, {model.parts[0].duration:.4g} s long")
        searched = solved(model.with_jumps(found.searched).fine(found.searched), found.searched, found.loss, thorough=True)
        rows.append((begin, begin + model.parts[0].duration, model.samples, *model.values(searched)))
    table = pd.DataFrame(rows, columns=["begin", "end", "samples", *labels])
    return table.drop_duplicates(["begin", "end"], ignore_index=True)


def _cut(part: Part, found: Estimate, before: float, after: float) -> Part | None:
    """Return a part shortened at its beginning and end; None if that is not possible.

    A record without a load point keeps its beginning, because the loading of the problem starts there.
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
    return part.from_time(record, float(record.time[0] - part.record.time[0]))
