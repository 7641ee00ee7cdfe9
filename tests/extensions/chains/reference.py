"""An independent solver of chains: scipy's DOP853 at 1e-12 with events, a matrix of springs, and laws as Python calls them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

import stickslip as ss

LEAST_TIME = 1e-11


class Reference(NamedTuple):
    """Changes as rows of time (s), block, and new mode; and the slip (m) of all blocks at the end."""

    changes: np.ndarray
    slip: np.ndarray


def matrix_of(chain: ss.Chain) -> np.ndarray:
    """Return the stiffness between blocks, with walls, as a matrix K of force = -K u."""
    rows, count = chain.couplings, chain.count
    found = np.diag(rows.walls).astype(float)
    for j in range(count):
        for place in range(rows.starts[j], rows.starts[j + 1]):
            found[j, rows.neighbours[place]] -= rows.springs[place]
            found[j, j] += rows.springs[place]
    return found


class _Blocks:
    """Blocks with their modes, for one integration after the other."""

    def __init__(self, chain: ss.Chain) -> None:
        self.chain, self.matrix, self.n = chain, matrix_of(chain), chain.count
        self.mass, self.pull, self.normal, self.damping = (
            chain.values(name) for name in ("mass", "stiffness", "normal_force", "damping")
        )
        laws, which = chain.laws
        self.laws = [laws[i] for i in which]
        self.quick = [_straight(law) for law in self.laws]
        self.mode = np.zeros(self.n, int)
        self.correction = np.zeros(self.n)

    def load(self, t: float, u: np.ndarray) -> np.ndarray:
        return -self.matrix @ u + self.pull * (self.chain.pull_rate * t - u)

    def strength(self, counted: np.ndarray) -> np.ndarray:
        return self.sliding(counted, np.zeros(self.n)) + self.normal * np.array([law.static_excess for law in self.laws])

    def sliding(self, counted: np.ndarray, v: np.ndarray) -> np.ndarray:
        found = [quick(float(c), abs(float(s))) for quick, c, s in zip(self.quick, counted, v, strict=True)]
        return self.normal * np.array(found)

    def slope(self, t: float, y: np.ndarray) -> np.ndarray:
        u, v, counted = y.reshape(3, self.n)
        force = self.load(t, u) - self.damping * v - self.mode * (self.sliding(counted, v) + self.correction)
        moves = self.mode != 0
        counts = np.array([1.0 if law.counts == "net" else mode for law, mode in zip(self.laws, self.mode, strict=True)])
        return np.concatenate((np.where(moves, v, 0.0), np.where(moves, force / self.mass, 0.0), np.where(moves, counts * v, 0.0)))

    def margin(self, j: int, way: int) -> Any:
        """Return the event that block j, at rest, reaches its strength."""
        strength = self.held[j]

        def event(t: float, y: np.ndarray) -> float:
            return float(strength - way * self.load(t, y[: self.n])[j])

        event.terminal, event.direction = True, -1
        return event

    def stop(self, j: int) -> Any:
        """Return the event that block j comes to rest."""
        mode = self.mode[j]

        def event(t: float, y: np.ndarray) -> float:
            return float(mode * y[self.n + j])

        event.terminal, event.direction = True, -1
        return event

    def knot(self, j: int, place: float) -> Any:
        """Return the event that the slip of block j passes a knot of its law, only so that no step goes over it."""

        def event(t: float, y: np.ndarray) -> float:
            return float(y[2 * self.n + j] - place)

        event.terminal, event.direction = True, 0
        return event


def solve(chain: ss.Chain, duration: float, rtol: float = 1e-12, step: float = 0.2) -> Reference:
    """Solve a chain by DOP853 with events; while blocks move, steps are at most `step` long (s), so that few events hide in one."""
    blocks, n = _Blocks(chain), chain.count
    u = chain.values("initial_slip")
    counted = np.array([_counted(law, one) for law, one in zip(blocks.laws, u, strict=True)])
    forward = chain.direction == "forward"
    y, t, rows = np.concatenate((u, np.zeros(n), counted)), 0.0, []
    blocks.held = blocks.strength(counted)
    load = blocks.load(0.0, u)
    blocks.mode = np.where(load > blocks.held, 1, np.where((load < -blocks.held) & (not forward), -1, 0))
    rows += [(0.0, j, blocks.mode[j]) for j in range(n) if blocks.mode[j]]
    while t < duration:
        events, what = [], []
        longest = step if blocks.mode.any() else np.inf
        for j in range(n):
            if blocks.mode[j]:
                events.append(blocks.stop(j))
                what.append((j, 0))
                for place in blocks.laws[j].knots:
                    if abs(y[2 * n + j] - place) > 1e-12:
                        events.append(blocks.knot(j, place))
                        what.append((j, 9))
            else:
                for way in (1,) if forward else (1, -1):
                    events.append(blocks.margin(j, way))
                    what.append((j, way))
        found = solve_ivp(blocks.slope, (t, duration), y, "DOP853", events=events, rtol=rtol, atol=1e-14, max_step=longest)
        y, t = found.y[:, -1].copy(), float(found.t[-1])
        if found.status != 1:
            break
        for (j, kind), times in zip(what, found.t_events, strict=True):
            if not len(times) or times[0] > t + LEAST_TIME:
                continue
            _change(blocks, y, t, j, kind, forward)
            if kind != 9:
                rows.append((t, j, blocks.mode[j]))
    return Reference(np.array(rows, float).reshape(-1, 3), y[:n])


def _straight(law: Any) -> Any:
    """Return friction as a function of slip and slip rate: for laws that are straight between knots a quick one."""
    if isinstance(law, ss.friction.LinearSlipWeakening | ss.friction.PiecewiseLinearSlip):
        levels = law.coefficient(np.array(law.knots))
        return lambda c, v: float(np.interp(c, (0.0, *law.knots), (float(law.coefficient(0.0)), *levels)))
    if isinstance(law, ss.friction.Coulomb):
        return lambda c, v: law.dynamic
    return lambda c, v: float(law.coefficient(c, v))


def _heals(law: Any) -> bool:
    return getattr(law, "memory", "all") == "since-arrest"


def _counted(law: Any, slip: float) -> float:
    """Return the slip that a law counts at the start, which is an arrest."""
    return 0.0 if _heals(law) else slip if law.counts == "net" else abs(slip)


def _change(blocks: _Blocks, y: np.ndarray, t: float, j: int, kind: int, forward: bool) -> None:
    """Carry out one change."""
    n = blocks.n
    load = blocks.load(t, y[:n])[j]
    if kind in (1, -1):
        blocks.mode[j], y[n + j] = kind, 0.0
        net = kind * load - blocks.strength(y[2 * n :])[j]
        blocks.correction[j] = net  # at its strength there is no net force but the step of friction
    elif kind == 0:
        old, blocks.mode[j], y[n + j], blocks.correction[j] = blocks.mode[j], 0, 0.0, 0.0
        if not forward and -old * load > blocks.strength(y[2 * n :])[j]:
            blocks.mode[j] = -old
            return
        if _heals(blocks.laws[j]):
            y[2 * n + j] = 0.0
        blocks.held[j] = blocks.strength(y[2 * n :])[j]
        if _heals(blocks.laws[j]) and old * load >= blocks.held[j]:
            blocks.mode[j] = old  # it heals to less than its load
