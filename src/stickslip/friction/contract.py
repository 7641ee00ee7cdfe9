"""What every friction law is: a formula, in pieces where it has kinks, and what counts as slip."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.errors import InputError
from stickslip.friction.expression import RATE, SLIP, Expression, Parameter, as_expression, depends_on
from stickslip.quantities import check_quantities


class _Symbols:
    """Stands for a law when its formula is asked for as a tree: every attribute is the parameter of that name."""

    def __getattr__(self, name: str) -> Expression:
        return Parameter(name)


@dataclass(frozen=True)
class FrictionLaw(ABC):
    """mu(u, v): the friction coefficient of a contact that slips, and its static value at rest.

    A law declares its parameters as fields (`quantity`), its formula once (`formula`, or one for each stretch of slip in
    `pieces` with the slips between them in `knots`), and the class attributes below. It is frozen and has no state.
    The formula is written for a slip rate v >= 0; for slip backwards the traction changes sign and v is its magnitude.
    """

    kind: ClassVar[str]
    """Name in scenario files and in the registry."""
    source: ClassVar[str]
    """Paper and equation."""
    counts: ClassVar[Literal["net", "path"]] = "net"
    """What slip the law sees: "net" (u itself, forwards and backwards) or "path" (its length; initial_slip counts as walked)."""

    def __post_init__(self) -> None:
        check_quantities(self)
        low, _ = self.range()
        if low < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")

    @staticmethod
    @abstractmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        """mu at slip u (m) and slip rate v >= 0 (m/s), with ordinary operators and the functions of `expression`."""

    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Smallest and largest coefficient of friction while slipping."""

    @property
    def pieces(self) -> tuple[Any, ...]:
        """One formula for each stretch of slip; most laws have one."""
        return (type(self).formula,)

    @property
    def knots(self) -> tuple[float, ...]:
        """Slip (m) at which one piece hands over to the next, ascending: one fewer than `pieces`."""
        return ()

    @property
    def static_excess(self) -> float:
        """How far static friction exceeds the formula at v = 0+: zero for a law that is continuous there."""
        return 0.0

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Parameter and value beyond which Z v + S mu(v) falls somewhere, for Z = impedance (Pa s/m) and S = normal (Pa).

        None for a law without a closed form of it. Several slip rates then solve the contact equation (paper, section 3).
        """
        return None

    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0) -> NDArray[np.float64]:
        """mu at slip u (m) and slip rate of magnitude v (m/s, >= 0; 0 means the limit 0+). Broadcasts; no unit."""
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        piece = np.searchsorted(np.asarray(self.knots), slip, side="right")
        values = np.empty(slip.shape)
        for i, formula in enumerate(self.pieces):
            chosen = piece == i
            values[chosen] = formula(self, slip[chosen], rate[chosen])
        return values

    def static_coefficient(self, u: ArrayLike) -> NDArray[np.float64]:
        """Static friction coefficient at slip u (m): the largest |traction| / normal stress while v = 0."""
        return self.coefficient(u) + self.static_excess

    @classmethod
    def parameters(cls) -> tuple[str, ...]:
        """Names of the fields, in the order in which compiled code receives their values."""
        return tuple(f.name for f in fields(cls) if "quantity" in f.metadata)

    def trees(self) -> tuple[Expression, ...]:
        """The formulas of `pieces` as expression trees in SLIP, RATE and parameters."""
        return tuple(as_expression(formula(_Symbols(), SLIP, RATE)) for formula in self.pieces)

    @property
    def depends_on_slip(self) -> bool:
        """Whether mu changes with slip."""
        return len(self.pieces) > 1 or any(depends_on(tree, SLIP) for tree in self.trees())

    @property
    def depends_on_rate(self) -> bool:
        """Whether mu changes with slip rate, the step from static to sliding friction included."""
        return self.static_excess != 0.0 or any(depends_on(tree, RATE) for tree in self.trees())
