"""Draw the free numbers from their posterior distribution, with emcee."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from stickslip.engine import engine_key
from stickslip.extensions.inference.certainty.certainty import Certainty
from stickslip.extensions.inference.certainty.kept_walk import NOT_KEPT, KeptWalk
from stickslip.extensions.inference.fit.estimate import Estimate
from stickslip.extensions.inference.fit.model import FAILED
from stickslip.extensions.inference.fit.progress import Tell
from stickslip.extensions.inference.record.noise import cost_of
from stickslip.foundation.arrays import Floats
from stickslip.foundation.errors import InputError

WALK_CODE = tuple(f"extensions/inference/{name}" for name in ("certainty", "fit", "record"))
"""Folders of the package whose code decides the steps of a walk, beside that of its runs."""
MOST_SAMPLES = 1_000_000
"""Largest number of posterior samples."""
WALKERS = 4
"""Number of walkers for each free number; at least 16 in all."""
FORGET = 0.1
"""Steps in which the walkers forget where they began, as a share of the steps that are kept: two correlation times of the shortest
walk that is long enough."""
JUMPS, FREEDOM = 0.7, 10.0
"""Share of steps in which walkers jump to places drawn from the fit, and degrees of freedom of the distribution of these places:
its tails are wider than those of a normal one. In the other steps walkers move by differences of others, whatever the fit is."""
FEW_TIMES = 20.0
"""Walks shorter than this many correlation times have too few samples."""


@dataclass(frozen=True, eq=False)
class PosteriorWalk:
    """The walk through the posterior distribution so far: its samples, and the state to go on from."""

    chain: Floats
    """Places of the walkers after each step, shape (steps, walkers, free numbers), without the first steps that are dropped."""
    state: Any
    """Places, probabilities and random state after the last step, as emcee has them."""
    asked: int
    """Number of samples that were asked for."""
    stopped: bool = False
    """True if Ctrl-C ended it."""

    @property
    def drawn(self) -> Floats:
        """The samples, shape (number of samples, free numbers)."""
        return self.chain.reshape(-1, self.chain.shape[2])[: self.asked]

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on how good the samples are."""
        from emcee.autocorr import function_1d

        worst = max(_memory(self.chain[:, :, i], function_1d) for i in range(self.chain.shape[2]))
        drawn = len(self.drawn)
        note = f"{drawn} samples, about {drawn / max(worst, 1.0):.0f} of them independent"
        if len(self.chain) < FEW_TIMES * worst:
            note += "; the walkers need longer to forget each other: ask for more samples"
        stop = f"sampling was stopped: {drawn} of {self.asked} samples were drawn; `more` goes on"
        return (stop, note) if self.stopped else (note,)


def emcee() -> Any:
    """Return the library that samples. Raises InputError if it is not installed."""
    try:
        import emcee as library
    except ImportError:
        raise InputError("infer: samples need emcee: pip install 'stickslip[infer]'") from None
    return library


def sample(
    found: Estimate,
    sure: Certainty,
    count: int,
    tell: Tell,
    *,
    seed: int = 0,
    before: PosteriorWalk | None = None,
    keep: KeptWalk = NOT_KEPT,
) -> PosteriorWalk:
    """Draw `count` samples of the searched numbers, or go on with the walk `before` until there are so many in all.

    A walk that begins is kept in the file of `keep`, or taken up from there.

    Numbers on a bound may leave it; numbers that the record does not determine are drawn within their limits. Ctrl-C ends the walk
    early with the samples so far. Raises InputError if emcee is not installed, and KeyboardInterrupt if Ctrl-C comes before the
    walkers have forgotten where they began.
    """
    dimensions = len(found.searched)
    walkers = max(16, WALKERS * dimensions)
    walkers += walkers % 2
    steps = -(-count // walkers)
    forget = max(20, math.ceil(FORGET * steps)) if before is None else 0
    library, posterior = emcee(), _Posterior(found, float(np.max(sure.excess**2)))
    moves, jumps = [(library.moves.DEMove(), 1.0 - JUMPS)], FromFit.of(found, sure, posterior.tempered)
    if jumps is not None:
        moves.append((library.moves.MHMove(jumps), JUMPS))
    sampler: Any = library.EnsembleSampler(walkers, dimensions, posterior, moves=moves)
    if before is None:
        begin, kept = _begun(found, sure, walkers, np.random.default_rng(seed)), []
        sampler.random_state = np.random.RandomState(seed).get_state()
    else:
        begin, kept = before.state, [before.chain]
    left, done, state = forget + steps - sum(map(len, kept)), 0, begin
    new = np.empty((max(left, 0), walkers, dimensions))
    if before is None:
        factor = np.empty(0) if jumps is None else jumps.factor
        own = found.searched, begin, factor, posterior.tempered, *found.model.limits, found.model.rtol, found.loss
        keep = keep.of(*own, seed, count, engine_key(*WALK_CODE))
        if (taken := keep.read(new.shape, library.State)) is not None:
            done, state = len(taken[0]), taken[1]
            new[:done] = taken[0]
    try:
        for moved in sampler.sample(state, iterations=left - done, skip_initial_state_check=done > 0) if left > done else ():
            if posterior.stopped:  # in the middle of this step
                break
            state, new[done] = library.State(moved, copy=True), moved.coords
            if done % 10 == 0:
                tell(f"sampling: step {done + 1} of {left}, {walkers} runs each")
            done += 1
            if before is None:
                keep.save(new[:done], state)
    except KeyboardInterrupt:  # between two runs
        posterior.stopped = True
    if before is None:
        keep.save(new[:done], state, now=True)
    if posterior.stopped and before is None and done <= forget:
        raise KeyboardInterrupt
    return PosteriorWalk(np.concatenate([*kept, new[forget:done]]), state, count, posterior.stopped)


@dataclass(frozen=True)
class FromFit:
    """Proposals from Student's distribution around the best fit, with the covariance that the posterior has where runs are linear.

    They do not depend on where a walker is, so that a walker that takes one forgets where it was. The posterior itself decides
    which are taken (Metropolis and Hastings): samples are exact however wrong the fit is.
    """

    centre: Floats
    factor: Floats
    """The covariance is `factor @ factor.T`."""

    @classmethod
    def of(cls, found: Estimate, sure: Certainty, tempered: float) -> FromFit | None:
        """Return the proposals, or None if the record does not determine all numbers inside their bounds."""
        if not np.all(np.isfinite(sure.widths) & (sure.widths > 0.0)):
            return None
        return cls(found.searched, math.sqrt(tempered) * np.linalg.inv(np.linalg.qr(sure.slopes, mode="r")))

    def __call__(self, places: Floats, random: np.random.RandomState) -> tuple[Floats, Floats]:
        """Return a new place for each walker, and the logarithm of the density of its old place over that of the new one."""
        wide = np.sqrt(FREEDOM / random.chisquare(FREEDOM, len(places)))[:, None]
        new = self.centre + wide * random.standard_normal(places.shape) @ self.factor.T
        return new, self._log_density(places) - self._log_density(new)

    def _log_density(self, places: Floats) -> Floats:
        apart = np.linalg.solve(self.factor, (places - self.centre).T)
        return np.asarray(-0.5 * (FREEDOM + len(self.centre)) * np.log1p(np.sum(apart**2, axis=0) / FREEDOM))


class _Posterior:
    """The logarithm of the posterior density; after Ctrl-C it is `stopped` and runs nothing more.

    It raises nothing: emcee would print an exception as a fault of this function. Residuals of neighbouring samples depend on each
    other, which makes the variances of the numbers larger by some factor; the log-likelihood is divided by it (`tempered`).
    """

    def __init__(self, found: Estimate, tempered: float) -> None:
        self._found, self.tempered, self.stopped = found, tempered, False

    def __call__(self, x: Floats) -> float:
        model, (low, high) = self._found.model, self._found.model.limits
        try:
            if self.stopped or np.any(x < low) or np.any(x > high):
                return -math.inf
            rest = model.residual(np.asarray(x, float))
            return -math.inf if np.all(np.abs(rest) >= FAILED) else -0.5 * cost_of(rest, self._found.loss) / self.tempered
        except KeyboardInterrupt:
            self.stopped = True
            return -math.inf


def _memory(chain: Floats, correlation: Callable[[Floats], Floats]) -> float:
    """Return the correlation time, in steps, of walkers of shape (steps, walkers) (Sokal's window, as in emcee)."""
    mean = np.mean([correlation(chain[:, k]) for k in range(chain.shape[1])], axis=0)
    times = 2.0 * np.cumsum(mean) - 1.0
    inside = np.arange(len(times)) >= 5.0 * times
    return max(1.0, float(times[int(np.argmax(inside))] if inside.any() else times[-1]))


def _begun(found: Estimate, sure: Certainty, walkers: int, random: np.random.Generator) -> Floats:
    """Return places of walkers inside the limits, drawn from the normal distribution with the curvature of the best fit."""
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
