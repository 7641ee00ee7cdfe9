"""Draw the free numbers from their posterior distribution, with emcee."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError
from stickslip.studies.inference.certainty import Certainty
from stickslip.studies.inference.estimate import Estimate
from stickslip.studies.inference.model import FAILED
from stickslip.studies.inference.noise import cost_of
from stickslip.studies.inference.search import Tell

WALKERS = 4
"""Number of walkers for each free number; there are 16 at least."""
FORGET = 0.3
"""Share of the steps, beyond those that are kept, that let the walkers forget where they began."""
FEW_TIMES = 20.0
"""Number of correlation times of the walkers below which samples are too few."""


def sample(found: Estimate, sure: Certainty, count: int, seed: int, tell: Tell) -> tuple[Floats, tuple[str, ...]]:
    """Return samples of the searched numbers, shape (count, number of free ones), and sentences on how good they are.

    Numbers on a bound may leave it, and those that are not determined are drawn within their limits. Ctrl-C ends the drawing with
    the samples of the steps that are done; there are fewer then. Raises InputError if emcee is not installed, and KeyboardInterrupt
    if Ctrl-C comes before the walkers have forgotten where they began.
    """
    try:
        import emcee
    except ImportError:
        raise InputError("infer: samples need emcee: pip install 'stickslip[infer]'") from None
    dimensions = len(found.searched)
    walkers = max(16, WALKERS * dimensions)
    walkers += walkers % 2
    steps = -(-count // walkers)
    forget = max(20, math.ceil(FORGET * steps))

    random = np.random.default_rng(seed)
    begin = _begun(found, sure, walkers, random)
    posterior = _Posterior(found, float(np.max(sure.excess**2)))
    sampler: Any = emcee.EnsembleSampler(walkers, dimensions, posterior)
    sampler.random_state = np.random.RandomState(seed).get_state()
    done = 0
    try:
        for _ in sampler.sample(begin, iterations=forget + steps):
            if posterior.stopped:  # in the middle of this step
                break
            if done % 10 == 0:
                tell(f"sampling: step {done + 1} of {forget + steps}, {walkers} runs each")
            done += 1
    except KeyboardInterrupt:  # between two runs
        posterior.stopped = True
    if posterior.stopped and done <= forget:
        raise KeyboardInterrupt
    chain = sampler.get_chain()[forget:done]
    worst = max(_memory(chain[:, :, i], emcee.autocorr.function_1d) for i in range(dimensions))
    drawn = chain.reshape(-1, dimensions)[:count]
    note = f"{len(drawn)} samples, about {len(drawn) / max(worst, 1.0):.0f} of them independent"
    if len(chain) < FEW_TIMES * worst:
        note += "; the walkers need longer to forget each other: ask for more samples"
    stop = f"sampling was stopped: {len(drawn)} of {count} samples were drawn"
    return np.asarray(drawn), ((stop,) if posterior.stopped else ()) + (note,)


class _Posterior:
    """The logarithm of the posterior density; after Ctrl-C it is `stopped` and runs nothing more.

    emcee would print an exception as a fault of this function. What is left of a record is not independent: its likelihood counts
    as much less as the variances of the numbers are larger for it, by `tempered`.
    """

    def __init__(self, found: Estimate, tempered: float) -> None:
        self._found, self._tempered, self.stopped = found, tempered, False

    def __call__(self, x: Floats) -> float:
        model, (low, high) = self._found.model, self._found.model.limits
        try:
            if self.stopped or np.any(x < low) or np.any(x > high):
                return -math.inf
            rest = model.residual(np.asarray(x, float))
            return -math.inf if np.all(np.abs(rest) >= FAILED) else -0.5 * cost_of(rest, self._found.loss) / self._tempered
        except KeyboardInterrupt:
            self.stopped = True
            return -math.inf


def _memory(chain: Floats, correlation: Callable[[Floats], Floats]) -> float:
    """Return the steps after which the walkers, shape (steps, walkers), are independent (Sokal's window, as in emcee)."""
    mean = np.mean([correlation(chain[:, k]) for k in range(chain.shape[1])], axis=0)
    times = 2.0 * np.cumsum(mean) - 1.0
    inside = np.arange(len(times)) >= 5.0 * times
    return max(1.0, float(times[int(np.argmax(inside))] if inside.any() else times[-1]))


def _begun(found: Estimate, sure: Certainty, walkers: int, random: np.random.Generator) -> Floats:
    """Return places of walkers, drawn from the normal distribution that the curvature gives, inside the limits."""
    low, high = found.model.limits
    width = np.where(np.isfinite(sure.widths), sure.widths, 0.1)
    covariance = np.where(np.isfinite(sure.covariance), sure.covariance, 0.0)
    known = np.sqrt(np.maximum(np.diag(covariance), 0.0)) > 0.0
    drawn = found.searched + np.zeros((walkers, len(width)))
    if known.any():
        factor = np.linalg.cholesky(covariance[np.ix_(known, known)] + np.diag(1e-12 * width[known] ** 2))
        drawn[:, known] += random.standard_normal((walkers, int(known.sum()))) @ factor.T
    loose = ~known
    drawn[:, loose] += np.maximum(width[loose], 1e-3) * np.abs(random.standard_normal((walkers, int(loose.sum()))))
    room = 1e-9 * np.maximum(1.0, np.abs(found.searched))
    return np.clip(drawn, low + room, high - room)
