"""Prove where steady sliding gains or loses its stability under a law with one state, over a whole range of slip rates.

The range is cut into cells. In each, bounds of the slopes of f in w' = f(v, w) enclose the steady states w(v) of all its rates, and
then those of friction mu(v, w) and of f. They say whether all of the cell is stable, or none of it. A cell in which that is not
certain is halved, until only narrow ones are left: there stability changes. `wave_proof` decides cells of a slab. A disturbance
exp(s t) of a block solves a cubic equation

    m s^3 + a s^2 + b s - K f_w = 0,   a = D - m f_w + S mu_v,   b = K - D f_w + S (mu_w f_v - mu_v f_w)

so sliding is stable if and only if a > 0 and H = a b + m K f_w > 0 (Routh & Hurwitz, with f_w < 0).

Source: Rice & Ruina 1983, J. Appl. Mech. 50, 343; Rump 2010, Acta Numerica 19, for the arithmetic on discs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from stickslip.bodies import BodyOnCharacteristics
from stickslip.contact.wave_proof import SLOPES, of_slab
from stickslip.foundation.arrays import Floats
from stickslip.friction.formula.differences import value_and_slopes
from stickslip.friction.formula.discs import Disc, largest, on_discs
from stickslip.friction.formula.expression import RATE, SLIP, STATE, Expression, Parameter
from stickslip.friction.formula.slopes import slope_formula
from stickslip.friction.law import FrictionLaw

CELLS = 64
"""Number of cells in a decade of slip rates, before any is halved."""
NARROW = 1e-9
"""Relative width of a cell that is not halved any more."""
MOST_CELLS = 80_000
"""Largest number of cells that are examined at a time, a second of work; beyond it nothing is proven."""
NEWTON_STEPS = 3
"""Number of Newton's steps from the law's steady state to that of its formula."""
LEAST_CHANGE = 1e-3
"""Relative change of the state that is allowed for while the slip rate doubles, where it changes less."""
WIDER = 1.5
"""How much wider the disc of the state is than its change in a cell."""
_Variables = dict[Expression, Disc]


class ProvenChange(NamedTuple):
    """Slip rates (m/s) between which stability changes, and whether it is stable above them."""

    low: float
    high: float
    stable_above: bool


def proven_changes(
    body: BodyOnCharacteristics, normal: float, law: FrictionLaw, slip: float, rates: tuple[float, float]
) -> list[ProvenChange] | None:
    """Return where stability changes between two slip rates (m/s), slowest first; None if that cannot be proven.

    `normal` is the normal load (N or Pa), and `slip` (m) one on which friction and states do not depend.
    """
    if not (body.has_waves or body.stiffness > 0.0) or len(law.states) != 1 or len(law.pieces) != 1:
        return None
    contact = _Contact(body, normal, law, slip)
    edges = np.geomspace(*rates, 1 + int(CELLS * np.log10(rates[1] / rates[0])))
    low, high, done = edges[:-1], edges[1:], []
    while len(low):
        if len(low) > MOST_CELLS:
            return None
        verdict = contact.judge(low, high)
        over = (verdict != 0) | (high - low <= NARROW * high)
        done.append(np.array([low[over], high[over], verdict[over]]))
        low, high = low[~over], high[~over]
        middle = 0.5 * (low + high)
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    cells = np.concatenate(done, axis=1)
    return _changes(cells[:, np.argsort(cells[0])])


def _changes(cells: Floats) -> list[ProvenChange] | None:
    """Return the changes between cells in order, whose rows are low, high and verdict; None if something stays open."""
    found: list[ProvenChange] = []
    before, open_from = 0.0, None
    for low, _, verdict in cells.T.tolist():
        if verdict == 0.0:
            open_from = low if open_from is None else open_from
            continue
        if before == 0.0 and open_from is not None:
            return None
        if before not in (0.0, verdict):
            found.append(ProvenChange(low if open_from is None else open_from, low, verdict > 0.0))
        elif open_from is not None:  # the same on both sides: it may have changed twice
            return None
        before, open_from = verdict, None
    return found if open_from is None else None


def _equation() -> tuple[Expression, Expression]:
    """Return a and H of a block as formulas of the slopes and of the body's numbers."""
    mass, damping, stiffness, normal = (Parameter(name) for name in ("m", "D", "K", "S"))
    mu_v, mu_w, f_v, f_w = SLOPES
    a = damping - mass * f_w + normal * mu_v
    b = stiffness - damping * f_w + normal * (mu_w * f_v - mu_v * f_w)
    return a, a * b + mass * stiffness * f_w


EQUATION = _equation()


def _of_block(body: BodyOnCharacteristics, normal: float, slopes: _Variables) -> tuple[Floats, Floats]:
    """Return for each cell whether sliding is proven to be stable, and whether it is proven to be unstable."""
    numbers = {"m": body.inertia, "D": body.damping, "K": body.stiffness, "S": normal}
    a, h = (on_discs(one, numbers, slopes) for one in EQUATION)
    return (a.centre > a.radius) & (h.centre > h.radius), (a.centre < -a.radius) | (h.centre < -h.radius)


@dataclass(frozen=True)
class _Contact:
    """A body on a contact under a law with one state."""

    body: BodyOnCharacteristics
    normal: float
    law: FrictionLaw
    slip: float

    @property
    def numbers(self) -> Mapping[str, Any]:
        return self.law.numbers(0)

    def judge(self, low: Floats, high: Floats) -> Floats:
        """Return for each cell of slip rates (m/s) 1 if all of it is stable, -1 if none is, and 0 if that is open."""
        with np.errstate(all="ignore"):
            cells, encloses = self._cells(low, high)
            slopes = (*self._slopes(self.law.trees()[0], cells), *self._slopes(self._tree, cells))
            of_body = of_slab if self.body.has_waves else _of_block
            stable, unstable = of_body(self.body, self.normal, dict(zip(SLOPES, slopes, strict=True)))
        return np.where(encloses, 1.0 * stable - 1.0 * unstable, 0.0)

    @property
    def _tree(self) -> Expression:
        return self.law.state_trees()[0]

    def _cells(self, low: Floats, high: Floats) -> tuple[_Variables, Any]:
        """Return the discs of cells, and for which of them it is proven that all their steady states lie in the disc of the state.

        With |f| <= miss at the centre, f_w <= -least < 0 and |f_v| <= most on the discs of radii r and q, they do if
        least q > miss + most r.
        """
        rate = 0.5 * (low + high)
        radius = np.maximum(high - rate, rate - low) * (1.0 + 1e-15)
        state = self._steady(rate)
        _, (_, by_rate, by_state) = value_and_slopes(self._tree, self.numbers, self.slip, rate, state)
        miss = largest(on_discs(self._tree, self.numbers, self._variables(Disc.of(rate), Disc.of(state))))
        reach = np.maximum(np.abs(by_rate) * radius, LEAST_CHANGE * np.abs(by_state * state) * radius / rate)
        state_radius = WIDER * (reach + miss) / np.abs(by_state)
        cells = self._variables(Disc.of(rate, radius), Disc.of(state, state_radius))
        f_v, f_w = self._slopes(self._tree, cells)
        least = -(f_w.centre + f_w.radius)
        return cells, least * state_radius > miss + radius * largest(f_v)

    def _variables(self, rate: Disc, state: Disc) -> _Variables:
        return {SLIP: Disc.of(self.slip), RATE: rate, STATE: state}

    def _slopes(self, tree: Expression, cells: _Variables) -> tuple[Disc, Disc]:
        """Return a formula's slopes by slip rate and by state in all of each cell."""
        by_rate, by_state = (on_discs(slope_formula(tree, one), self.numbers, cells) for one in (RATE, STATE))
        return by_rate, by_state

    def _steady(self, rate: Floats) -> Floats:
        """Return the states, as formulas use them, in which the formula of the state's rate is zero."""
        seen = np.broadcast_to(np.asarray(self.law.steady_state(rate), float).reshape(-1, len(rate))[0], rate.shape)
        state = np.array([self.law.inner_states((one,))[0] for one in seen.tolist()])
        for _ in range(NEWTON_STEPS):
            value, slopes = value_and_slopes(self._tree, self.numbers, self.slip, rate, state)
            state = np.where(np.isfinite(step := value / slopes[2]), state - step, state)
        return state
