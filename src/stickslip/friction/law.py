"""What every friction law is: a formula, in pieces where it has kinks, and what counts as slip."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import SimpleNamespace
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity, quantities_of
from stickslip.friction.formula.expression import RATE, SLIP, STATE, Expression, Parameter, as_expression, depends_on
from stickslip.friction.parameters import Series, check_fields, fields_of

Formula = Callable[..., Any]
"""mu from the parameters (attributes of the first argument), slip u (m) and slip rate v >= 0 (m/s); a law with a state has it as
a fourth argument."""


@dataclass(frozen=True)
class StateVariable:
    """What a law with memory remembers besides slip: name, unit and meaning of the number that users see."""

    name: str
    unit: str
    meaning: str
    scale: float = 0.0
    """Size of a change that matters, of the number that the formulas see; 0: relative to the number itself."""


@lru_cache(maxsize=256)
def _trees(
    pieces: tuple[Formula, ...], parameters: tuple[str, ...], literals: tuple[tuple[str, float], ...], has_state: bool
) -> tuple[Expression, ...]:
    """The formulas as trees: made once for all laws that differ in the values of their parameters only."""
    symbols = SimpleNamespace(**({name: Parameter(name) for name in parameters} | dict(literals)))
    variables = (SLIP, RATE, STATE) if has_state else (SLIP, RATE)
    made = {formula: as_expression(formula(symbols, *variables)) for formula in dict.fromkeys(pieces)}
    return tuple(made[formula] for formula in pieces)


@lru_cache(maxsize=256)
def _contain(trees: tuple[Expression, ...], variable: Expression) -> bool:
    """Whether one of the trees contains the variable."""
    return any(depends_on(tree, variable) for tree in dict.fromkeys(trees))


@dataclass(frozen=True)
class FrictionLaw(ABC):
    """mu(u, v): the friction coefficient of a contact that slips, and its static value at rest.

    A law declares its parameters as fields (`quantity`, or what `friction.parameters` offers), its formula once (`formula`, or one
    for each stretch of slip or slip rate in `pieces` with the knots between them), and the class attributes below. It is frozen
    and has no state. The formula is written for a slip rate v >= 0; for slip backwards the traction changes sign and v is its
    magnitude. Pieces may share a formula and differ in the values of its parameters: `piece_values`.
    """

    kind: ClassVar[str]
    """Name in scenario files and in the registry."""
    source: ClassVar[str]
    """Paper and equation."""
    counts: ClassVar[Literal["net", "path"]] = "net"
    """What slip the law sees: "net" (u itself, forwards and backwards) or "path" (its length; initial_slip counts as walked)."""
    memory: ClassVar[Literal["all", "since-arrest"]] = "all"
    """Since when slip is counted: the start, or the last arrest, with which the contact heals (see `friction.memory`)."""
    knot_variable: ClassVar[Literal["slip", "rate"]] = "slip"
    """What the knots between pieces are places of: slip (m) or slip rate (m/s)."""
    state: ClassVar[StateVariable | None] = None
    """A state variable of the law's own: then `formula` has it as a fourth argument, and `state_rate` says how it changes."""
    sticks: ClassVar[bool] = True
    """Whether there is a static strength below which the contact rests; else friction passes smoothly through v = 0."""
    many: ClassVar[bool] = False
    """Whether fields may be arrays, one number a member of a batch: formulas, `range`, `knots`, `static_excess` then are too."""
    start: ClassVar[Mapping[str, Any]] = {}
    """Of a law that never sticks: `coefficient` (load per normal load) and `state` from which its example may start."""
    example: ClassVar[Mapping[str, Any]] = {}
    """Plausible values of the fields as a scenario file would give them: shown by `stickslip new`, used by tests."""
    columns: ClassVar[Mapping[str, str]] = {}
    """Columns of a data file, and the fields they fill: a law with columns may be given as `file` in a scenario."""

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        """mu at slip u (m) and slip rate v >= 0 (m/s), with ordinary operators and the functions of `formula.expression`.

        Every law has it, unless it says in `pieces` what it is made of.
        """
        raise TypeError(f"{type(law).__name__} has neither a formula nor pieces")

    def __post_init__(self) -> None:
        check_fields(self)
        self.check()
        low, _ = self.range()
        if low < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")

    def check(self) -> None:  # noqa: B027 - most laws have nothing to add
        """What the fields must satisfy together. Raises InputError."""

    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Bounds of the coefficient of friction while slipping; the upper one is inf where it grows without bound."""

    @property
    def pieces(self) -> tuple[Formula, ...]:
        """One formula for each stretch of slip or slip rate; most laws have one."""
        return (type(self).formula,)

    @property
    def knots(self) -> tuple[float, ...]:
        """Where one piece hands over to the next, ascending: one fewer than `pieces`. See `knot_variable`."""
        return ()

    @property
    def static_excess(self) -> float:
        """How far static friction exceeds the formula at v = 0+: zero for a law that is continuous there."""
        return 0.0

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Parameter and value at which Z v + S mu(v) begins to fall somewhere, for Z = impedance (Pa s/m) and S = normal (Pa).

        The parameter is named as in `stickslip.parameters`. None for a law without a closed form of it, or that never falls. On one
        side of the value several slip rates solve the contact equation (paper, section 3).
        """
        return None

    def rate_at_slope(self, slope: Any) -> Any:
        """Slip rate (m/s) at which dmu/dv (s/m) has a value, for a law that `bends_one_way`; None where that has no closed form.

        NaN, or anything else, where it never has. A batch looks there first for the fold of Z v + S mu(v): a rate that is wrong
        costs time, no digits.
        """
        return None

    # ---- state --------------------------------------------------------------------------------------------------------------

    @property
    def state_rate(self) -> Formula:
        """dw/dt from the parameters, slip, slip rate and state w, for a law with a state."""
        raise TypeError(f"{type(self).__name__} has no state variable")

    def inner_state(self, value: float) -> float:
        """The number w that the formulas see, for a value of the state as users give it."""
        return value

    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        """The state as users see it, for values of w."""
        return w

    def state_tree(self) -> Expression:
        """dw/dt as an expression tree in SLIP, RATE, STATE and parameters."""
        (tree,) = _trees((self.state_rate,), self.parameters(), tuple(self.literals().items()), True)
        return tree

    # ---- parameters ---------------------------------------------------------------------------------------------------------

    def parameters(self) -> tuple[str, ...]:
        """Names of the numbers in the formulas, in the order in which compiled code receives their values."""
        return tuple(quantities_of(type(self)))

    def piece_values(self, i: int) -> tuple[float, ...]:
        """Values of `parameters` in piece i: the law's own, unless its pieces have different ones."""
        return tuple(float(getattr(self, name)) for name in self.parameters())

    def numbers(self, i: int = 0) -> dict[str, float]:
        """Values of `parameters` in piece i, by name."""
        return dict(zip(self.parameters(), self.piece_values(i), strict=True))

    def literals(self) -> dict[str, float]:
        """Parameters that stand in the tree as numbers, because the tree depends on them: whole exponents."""
        return {name: getattr(self, name) for name, declared in quantities_of(type(self)).items() if declared.whole}

    # ---- values -------------------------------------------------------------------------------------------------------------

    def piece_at(self, u: ArrayLike, v: ArrayLike = 0.0) -> NDArray[np.intp]:
        """Which piece holds at slip u (m) and slip rate v (m/s); at a knot the one above it. Broadcasts."""
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        return np.asarray(np.searchsorted(np.asarray(self.knots), slip if self.knot_variable == "slip" else rate, side="right"))

    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        """mu by the formula of piece i, also outside its stretch. Complex slips and rates give complex values."""
        variables = (u, v) if self.state is None else (u, v, w)
        return self.pieces[i](SimpleNamespace(**self.numbers(i)), *variables)

    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """mu at slip u (m) and slip rate of magnitude v (m/s, >= 0; 0 means the limit 0+). Broadcasts; no unit.

        w is the state as the formulas see it (`inner_state`), for a law that has one.
        """
        slip, rate, state = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float), np.asarray(w, float))
        piece = self.piece_at(slip, rate)
        values = np.empty(slip.shape)
        with np.errstate(over="ignore", under="ignore"):  # exp(-v / 1e-9) is 0, exp(v / 1e-9) below a line is too
            for i in np.unique(piece).tolist():
                chosen = piece == i
                values[chosen] = self.piece_coefficient(i, slip[chosen], rate[chosen], state[chosen])
        return values

    def static_coefficient(self, u: ArrayLike) -> NDArray[np.float64]:
        """Static friction coefficient at slip u (m): the largest |traction| / normal stress while v = 0."""
        return self.coefficient(u) + self.static_excess

    # ---- what follows from the formulas ---------------------------------------------------------------------------------------

    def trees(self) -> tuple[Expression, ...]:
        """The formulas of `pieces` as expression trees in SLIP, RATE (STATE) and parameters."""
        return self._own_trees

    @cached_property
    def _own_trees(self) -> tuple[Expression, ...]:
        return _trees(self.pieces, self.parameters(), tuple(self.literals().items()), self.state is not None)

    @property
    def depends_on_slip(self) -> bool:
        """Whether mu changes with slip."""
        return self._depends_on(SLIP)

    @property
    def depends_on_rate(self) -> bool:
        """Whether mu changes with slip rate, the step from static to sliding friction included."""
        return self.static_excess != 0.0 or self._depends_on(RATE)

    def _depends_on(self, variable: Expression) -> bool:
        knotted = len(self.pieces) > 1 and self.knot_variable == variable.operation
        return knotted or _contain(self.trees(), variable)

    @property
    def variation(self) -> float:
        """How much friction changes, finite: high - low, or what it changes up to 1 m/s where it grows without bound."""
        low, high = self.range()
        if np.all(np.isfinite(high)):
            return high - low
        return float(np.ptp(self.coefficient(0.0, np.linspace(0.0, 1.0, 101))))

    @property
    def bends_one_way(self) -> bool:
        """Whether mu is convex, or concave, over all slip rates v > 0: then Z v + S mu(v) turns at most once."""
        return not self.depends_on_rate

    @property
    def rate_scales(self) -> tuple[float, ...]:
        """Slip rates (m/s) at which something happens: parameters that are rates, or inverses of rates."""
        scales: list[float] = []
        for name, (declared, _) in fields_of(type(self)).items():
            item = declared.item if isinstance(declared, Series) else declared
            if isinstance(item, Quantity) and item.unit in ("m/s", "s/m"):
                value = getattr(self, name) or ()
                sizes = [abs(number) for number in (value if isinstance(value, tuple) else (value,)) if number]
                scales += [size if item.unit == "m/s" else 1.0 / size for size in sizes]
        return tuple(scales)
