"""Friction under a normal load that varies in time: a law times S(t) / S(0), with the normal load as states given by time.

`problem.contact_law` makes it of the law of a problem; users never do.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.friction.contract import Formula, StateVariable, one_argument
from stickslip.friction.formula.expression import STATES, Expression, as_expression
from stickslip.friction.law import FrictionLaw

PRESSING = (
    StateVariable("p", "1", "growth of the normal load since the start, as a share of it", scale=1.0, signed=True),
    StateVariable("dp/dt", "1/s", "how fast it grows", signed=True),
)
"""The states that follow from time alone: p = S(t) / S(0) - 1 and its rate of change."""


@dataclass(frozen=True)
class LawOnLaw(FrictionLaw):
    """A law that has the pieces and the statements of another one, unless a subclass says otherwise; users never make one."""

    law: FrictionLaw

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return self.law.pieces

    @override
    def parameters(self) -> tuple[str, ...]:
        return self.law.parameters()

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return self.law.piece_values(i)

    @property
    @override
    def can_be_negative(self) -> bool:
        return self.law.can_be_negative

    @property
    @override
    def counts(self) -> Literal["net", "path"]:  # type: ignore[override] # follows the law, as all below
        return self.law.counts

    @property
    @override
    def memory(self) -> Literal["all", "since-arrest"]:  # type: ignore[override]
        return self.law.memory

    @property
    @override
    def sticks(self) -> bool:  # type: ignore[override]
        return self.law.sticks

    @property
    @override
    def knot_variable(self) -> Literal["slip", "rate"]:  # type: ignore[override]
        return self.law.knot_variable

    @property
    @override
    def knots(self) -> tuple[float, ...]:
        return self.law.knots

    @property
    @override
    def static_excess(self) -> float:
        return self.law.static_excess

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        return self.law.rate_scales


@dataclass(frozen=True)
class Pressed(LawOnLaw):
    """(1 + p) law(u, v, w), whose last two states are p and dp/dt; `least` and `most` are bounds of 1 + p.

    The first state of the law follows the normal load: dw/dt gains -`normal_coupling` dp/dt / (1 + p) (Linker & Dieterich 1992).
    """

    kind = "pressed"
    source = "Linker & Dieterich 1992, J. Geophys. Res. 97, 4923 (the coupling)"
    given = len(PRESSING)

    least: float = 1.0
    most: float = 1.0

    @property
    @override
    def states(self) -> tuple[StateVariable, ...]:
        return (*self.law.states, *PRESSING)

    @override
    def trees(self) -> tuple[Expression, ...]:
        p, _ = self._pressing
        made = {tree: (1.0 + p) * tree for tree in dict.fromkeys(self.law.trees())}
        return tuple(made[tree] for tree in self.law.trees())

    @override
    def state_trees(self) -> tuple[Expression, ...]:
        p, rate = self._pressing
        coupling, own = self.law.normal_coupling, list(self.law.state_trees())
        if coupling:
            own[0] -= coupling * rate / (1.0 + p)
        return (*own, *[as_expression(0.0)] * self.given)  # the engine gives these states: nothing is left to work out

    @property
    def _pressing(self) -> tuple[Expression, ...]:
        first = len(self.law.states)
        return STATES[first : first + self.given]

    @override
    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        *own, p, _ = self.each_state(w)
        return (1.0 + p) * self.law.piece_coefficient(i, u, v, one_argument(own))

    @override
    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return mu as in `FrictionLaw.coefficient`, times 1 + p."""
        *own, p, _ = self.each_state(w)
        return np.asarray((1.0 + np.asarray(p)) * self.law.coefficient(u, v, one_argument(own)))

    @override
    def range(self) -> tuple[float, float]:
        low, high = self.law.range()
        return low * (self.least if low >= 0.0 else self.most), high * self.most

    @cached_property
    @override
    def variation(self) -> float:
        return self.law.variation
