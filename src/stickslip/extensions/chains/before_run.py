"""What is known of a chain before it is run: frequencies, the speed of waves, the first event, steady sliding."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stickslip.extensions.chains.couplings import is_sparse
from stickslip.foundation.arrays import Floats

if TYPE_CHECKING:
    from stickslip.extensions.chains.chain import Chain

MOST_DENSE = 400
"""Number of blocks up to which whole matrices are decomposed."""


class Frequencies(NamedTuple):
    """The least and the largest angular frequency (rad/s), or bounds of them."""

    least: float
    largest: float
    are_bounds: bool


class FirstEvent(NamedTuple):
    """Where and when the first block reaches its strength: block, time (s), direction, and how many others do at that time."""

    block: int
    time: float
    direction: int
    at_once: int


class ChainBeforeRun:
    """A chain as matrices: masses, springs, and what resists slip at the start."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self.mass, self.pull = chain.values("mass"), chain.values("stiffness")
        self.slip, self.normal = chain.values("initial_slip"), chain.values("normal_force")

    @cached_property
    def springs(self) -> Any:
        """The stiffness matrix (N/m): the force on blocks that have moved is minus this matrix times their slip."""
        from scipy import sparse

        of, count = self.chain.couplings, self.chain.count
        between = sparse.csr_matrix((of.springs, of.neighbours, of.starts), shape=(count, count))
        held = np.asarray(between.sum(axis=1)).ravel() + self.pull + of.walls
        return (sparse.diags(held) - between).tocsr()

    @cached_property
    def _scaled(self) -> Any:
        """The stiffness matrix over masses, symmetric (1/s^2)."""
        from scipy import sparse

        root = sparse.diags(1.0 / np.sqrt(self.mass))
        return (root @ self.springs @ root).tocsc()

    @cached_property
    def frequencies(self) -> Frequencies:
        """The least and the largest angular frequency of the chain where all blocks move."""
        low, high = self._eigenvalues()
        rounding = 4.0 * self.chain.count * float(np.finfo(float).eps) * high
        return Frequencies(math.sqrt(low) if low > rounding else 0.0, math.sqrt(max(high, 0.0)), are_bounds=self._is_large)

    @property
    def _is_row(self) -> bool:
        """True if each block is tied to the one before and the one after it, and to no other."""
        return len(self.chain.shape) == 1 and self.chain.ends != "periodic" and not is_sparse(self.chain.coupling)

    @property
    def _is_large(self) -> bool:
        """True if its eigenvalues would take minutes."""
        return self.chain.count > MOST_DENSE and not self._is_row

    def _eigenvalues(self) -> tuple[float, float]:
        """Return the least and the largest eigenvalue (1/s^2) of the stiffness matrix over masses, or bounds by its rows."""
        if self.chain.count <= MOST_DENSE:
            found = np.linalg.eigvalsh(self._scaled.toarray())
            return float(found[0]), float(found[-1])
        if self._is_row:
            from scipy.linalg import eigvalsh_tridiagonal

            rows = self._scaled.diagonal(), self._scaled.diagonal(1)
            low, high = (eigvalsh_tridiagonal(*rows, select="i", select_range=(i, i))[0] for i in (0, self.chain.count - 1))
            return float(low), float(high)
        held = self.springs.diagonal()
        alone = self.pull + self.chain.couplings.walls
        return float((alone / self.mass).min()), float(((2.0 * held - alone) / self.mass).max())

    @property
    def wave_speed(self) -> float:
        """The speed (blocks/s) of long waves along a chain: sqrt(kc/m), with springs and masses averaged as long waves do.

        It is NaN for a lattice and for springs of a matrix, and 0 if a spring has no stiffness.
        """
        coupling = self.chain.coupling
        if len(self.chain.shape) > 1 or is_sparse(coupling) or self.chain.count == 1:
            return math.nan
        kc = np.atleast_1d(np.asarray(coupling, float))
        return 0.0 if (kc <= 0.0).any() else math.sqrt(1.0 / float(np.mean(1.0 / kc)) / float(self.mass.mean()))

    @property
    def load(self) -> Floats:
        """The force on each block from all springs at the start (N)."""
        return np.asarray(-(self.springs @ self.slip))

    @cached_property
    def strength(self) -> Floats:
        """The largest force with which friction holds each block at the start (N)."""
        laws, which = self.chain.laws
        found = np.empty(self.chain.count)
        for i, law in enumerate(laws):
            seen = np.zeros_like(self.slip) if law.memory == "since-arrest" else self.slip
            seen = np.abs(seen) if law.counts == "path" else seen
            found[which == i] = np.asarray(law.static_coefficient(seen[which == i]))
        return found * self.normal

    @property
    def first(self) -> FirstEvent | None:
        """The first event; None if no block ever reaches its strength."""
        pulled = self.pull * float(self.chain.pull_rate)
        with np.errstate(divide="ignore", invalid="ignore"):
            forward = np.where(pulled > 0.0, (self.strength - self.load) / pulled, np.inf)
            backward = np.where(pulled < 0.0, (-self.strength - self.load) / pulled, np.inf)
        over = np.abs(self.load) > self.strength
        if self.chain.direction == "forward":
            over, backward = self.load > self.strength, np.full_like(backward, np.inf)
        times = np.where(over, 0.0, np.maximum(np.minimum(forward, backward), 0.0))
        block = int(np.argmin(times))
        if not math.isfinite(time := float(times[block])):
            return None
        goes = -1 if over[block] and self.load[block] < 0.0 else 1 if over[block] or forward[block] <= backward[block] else -1
        return FirstEvent(block, time, goes, int((times == time).sum()))

    @cached_property
    def falls(self) -> Floats:
        """How fast friction and dashpot of each block rise with the slip rate at V, together (N s/m); negative where they fall."""
        laws, which = self.chain.laws
        slopes = np.array([float(law.slopes(0.0, abs(float(self.chain.pull_rate)))[1]) for law in laws])
        return np.asarray(slopes[which] * self.normal + self.chain.values("damping"))

    @property
    def has_steady_sliding(self) -> bool:
        """True if all blocks can slide at V for ever: the driver moves, and no friction depends on slip."""
        return float(self.chain.pull_rate) != 0.0 and not any(law.depends_on_slip for law in self.chain.laws[0])

    @cached_property
    def growth(self) -> float:
        """The largest growth rate (1/s) of disturbances of steady sliding; NaN for a long chain where its sign is not known."""
        falls = self.falls
        count = self.chain.count
        if count <= MOST_DENSE:
            root, none = np.sqrt(self.mass), np.zeros((count, count))
            top = np.hstack((none, np.eye(count)))
            matrix = np.vstack((top, np.hstack((-self._scaled.toarray(), -np.diag(falls / root**2)))))
            found = float(np.linalg.eigvals(matrix).real.max())
            return found if abs(found) > 1e-12 * self.frequencies.largest else 0.0
        return math.nan

    @property
    def is_stable(self) -> bool | None:
        """True if disturbances of steady sliding fade or stay small, False if one grows, None where that is not known."""
        if (self.falls >= 0.0).all():
            return True
        if (self.falls < 0.0).all():
            return False
        return None if math.isnan(self.growth) else self.growth <= 0.0
