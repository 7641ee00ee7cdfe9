"""Define the base class of all friction laws.

A law is a formula mu(u, v), split into pieces where it has kinks, together with the rule by which slip is counted.
"""

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
"""A function that returns mu from the parameters (attributes of the first argument), slip u (m) and slip rate v >= 0 (m/s).

For a law with a state variable the state is the fourth argument.
"""


@dataclass(frozen=True)
class StateVariable:
    """Describe the state variable of a law: name, unit and meaning of the number that users see."""

    name: str
    unit: str
    meaning: str
    scale: float = 0.0
    """Size below which the error of the state, in the form that the formulas use, is measured absolutely.

    With 0 the error is relative to the state itself.
    """


@lru_cache(maxsize=256)
def _trees(
    pieces: tuple[Formula, ...], parameters: tuple[str, ...], literals: tuple[tuple[str, float], ...], has_state: bool
) -> tuple[Expression, ...]:
    """Return the formulas as expression trees; laws that differ only in the values of their parameters share them."""
    symbols = SimpleNamespace(**({name: Parameter(name) for name in parameters} | dict(literals)))
    variables = (SLIP, RATE, STATE) if has_state else (SLIP, RATE)
    made = {formula: as_expression(formula(symbols, *variables)) for formula in dict.fromkeys(pieces)}
    return tuple(made[formula] for formula in pieces)


@lru_cache(maxsize=256)
def _contain(trees: tuple[Expression, ...], variable: Expression) -> bool:
    """Return True if one of the trees contains the variable."""
    return any(depends_on(tree, variable) for tree in dict.fromkeys(trees))


@dataclass(frozen=True)
class FrictionLaw(ABC):
    """A friction law: the coefficient mu(u, v) of a contact that slips, and the static coefficient at rest.

    Subclass this to add a law.

    Notes
    -----
    A subclass declares its parameters as fields (`quantity`, or one of the declarations in `friction.parameters`), its formula
    once, and the class attributes below. The formula is either `formula`, or a list `pieces` with one formula for each interval
    of slip or slip rate, separated by `knots`. Pieces may share a formula and differ only in the values of its parameters
    (`piece_values`).

    The formula is written for a slip rate v >= 0. For backward slip the traction changes sign and v is the magnitude of the slip
    rate.

    A law is frozen. Whatever changes during a run, a state variable included, is stored in the run and not in the law.
    """

    kind: ClassVar[str]
    """Name of the law in scenario files and in the registry."""
    source: ClassVar[str]
    """Paper and equation from which the law is taken."""
    counts: ClassVar[Literal["net", "path"]] = "net"
    """The slip that the law sees: "net" is u itself, with its sign; "path" is the accumulated length of slip in both directions.

    The magnitude of initial_slip is included in the path.
    """
    memory: ClassVar[Literal["all", "since-arrest"]] = "all"
    """The time from which slip is counted: the start of the run, or the last arrest, at which the contact heals.

    See `friction.memory`.
    """
    knot_variable: ClassVar[Literal["slip", "rate"]] = "slip"
    """The variable in which `knots` are given: slip (m) or slip rate (m/s)."""
    state: ClassVar[StateVariable | None] = None
    """The state variable, if the law has one: `formula` then takes it as a fourth argument and `state_rate` is its evolution."""
    sticks: ClassVar[bool] = True
    """True if there is a static strength below which the contact rests; False if friction passes smoothly through v = 0."""
    many: ClassVar[bool] = False
    """True if fields may be arrays with one number for each member of a batch.

    Formulas, `range`, `knots` and `static_excess` then return arrays too.
    """
    start: ClassVar[Mapping[str, Any]] = {}
    """Initial values for the example of a law that never sticks: `coefficient` (load / normal load) and `state`."""
    example: ClassVar[Mapping[str, Any]] = {}
    """Plausible values of the fields, in the form of a scenario file: `stickslip new` shows them and tests use them."""
    columns: ClassVar[Mapping[str, str]] = {}
    """Columns of a data file and the fields that they fill; a scenario may give a law with columns as `file`."""

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        """Return mu at slip u (m) and slip rate v >= 0 (m/s).

        Parameters
        ----------
        law
            An object that has the parameters of the law as attributes.
        u
            Slip (m): a number, an array or an expression.
        v
            Slip rate (m/s), not negative: a number, an array or an expression.

        Returns
        -------
        number, array or expression
            The friction coefficient (no unit).

        Notes
        -----
        Use only ordinary operators and the functions of `formula.expression`. Every law defines this function, unless it
        overrides `pieces`.
        """
        raise TypeError(f"{type(law).__name__} has neither a formula nor pieces")

    def __post_init__(self) -> None:
        check_fields(self)
        self.check()
        low, _ = self.range()
        if low < 0:
            raise InputError(f"{type(self).__name__}: friction must not be negative anywhere it slips, its minimum here is {low:g}")

    def check(self) -> None:  # noqa: B027 - most laws have nothing to add
        """Check conditions that involve several fields. Raise InputError if one is violated."""

    @abstractmethod
    def range(self) -> tuple[float, float]:
        """Return a lower and an upper bound of the friction coefficient (no unit), at rest and while slipping.

        The lower bound must not be negative. The upper bound is inf if friction grows without bound.
        """

    @property
    def pieces(self) -> tuple[Formula, ...]:
        """Return one formula for each interval of slip or slip rate; most laws have a single one."""
        return (type(self).formula,)

    @property
    def knots(self) -> tuple[float, ...]:
        """Return the ascending places at which one piece ends and the next begins: one fewer than `pieces`.

        `knot_variable` says whether they are slips (m) or slip rates (m/s).
        """
        return ()

    @property
    def static_excess(self) -> float:
        """Return static friction minus the formula at v = 0+ (no unit): zero for a law that is continuous at rest."""
        return 0.0

    def critical_value(self, impedance: float, normal: float) -> tuple[str, float] | None:
        """Return the parameter, and its value, at which Z v + S mu(v) first has a falling part.

        Parameters
        ----------
        impedance
            Z (Pa s/m).
        normal
            Normal stress S (Pa).

        Returns
        -------
        tuple of str and float, or None
            The name of the parameter, as in `stickslip.parameters`, and its critical value in SI. None for a law without a
            closed form of it, or whose Z v + S mu(v) never falls.

        Notes
        -----
        On one side of the value several slip rates solve the contact equation (paper, section 3).
        """
        return None

    def rate_at_slope(self, slope: Any) -> Any:
        """Return the slip rate (m/s) at which dmu/dv equals `slope` (s/m), for a law that `bends_one_way`.

        Return None if there is no closed form. If no slip rate has that slope, the result may be NaN or any number: a batch only
        starts its search for the fold of Z v + S mu(v) there, so that a wrong rate costs time but no accuracy.
        """
        return None

    # ---- state --------------------------------------------------------------------------------------------------------------

    @property
    def state_rate(self) -> Formula:
        """Return the function that gives dw/dt (1/s times the unit of w) from parameters, slip, slip rate and state w.

        Raise TypeError for a law without a state.
        """
        raise TypeError(f"{type(self).__name__} has no state variable")

    def inner_state(self, value: float) -> float:
        """Convert a state as users give it to the number w that the formulas use."""
        return value

    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert values of w, the state that the formulas use, to the state that users see."""
        return w

    def state_tree(self) -> Expression:
        """Return dw/dt as an expression tree in SLIP, RATE, STATE and parameters."""
        (tree,) = _trees((self.state_rate,), self.parameters(), tuple(self.literals().items()), True)
        return tree

    # ---- parameters ---------------------------------------------------------------------------------------------------------

    def parameters(self) -> tuple[str, ...]:
        """Return the names of the numbers in the formulas, in the order in which compiled code receives their values."""
        return tuple(quantities_of(type(self)))

    def piece_values(self, i: int) -> tuple[float, ...]:
        """Return the values of `parameters` in piece i: those of the law, unless its pieces have different ones."""
        return tuple(float(getattr(self, name)) for name in self.parameters())

    def numbers(self, i: int = 0) -> dict[str, float]:
        """Return the values of `parameters` in piece i, by name."""
        return dict(zip(self.parameters(), self.piece_values(i), strict=True))

    def literals(self) -> dict[str, float]:
        """Return the parameters that enter the tree as plain numbers because its shape depends on them: whole exponents."""
        return {name: getattr(self, name) for name, declared in quantities_of(type(self)).items() if declared.whole}

    # ---- values -------------------------------------------------------------------------------------------------------------

    def piece_at(self, u: ArrayLike, v: ArrayLike = 0.0) -> NDArray[np.intp]:
        """Return the index of the piece that applies at slip u (m) and slip rate v (m/s); arguments broadcast.

        At a knot it is the piece above the knot.
        """
        slip, rate = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float))
        return np.asarray(np.searchsorted(np.asarray(self.knots), slip if self.knot_variable == "slip" else rate, side="right"))

    def piece_coefficient(self, i: int, u: Any, v: Any, w: Any = 0.0) -> Any:
        """Return mu by the formula of piece i, also outside its interval; complex slips and rates give complex values."""
        variables = (u, v) if self.state is None else (u, v, w)
        return self.pieces[i](SimpleNamespace(**self.numbers(i)), *variables)

    def coefficient(self, u: ArrayLike, v: ArrayLike = 0.0, w: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Return the friction coefficient mu while the contact slips.

        Parameters
        ----------
        u
            Slip (m) as the law counts it.
        v
            Magnitude of the slip rate (m/s), not negative; 0 means the limit v = 0+.
        w
            State in the form that the formulas use (`inner_state`), for a law that has one.

        Returns
        -------
        array
            mu (no unit), with the shape to which the arguments broadcast.
        """
        slip, rate, state = np.broadcast_arrays(np.asarray(u, float), np.asarray(v, float), np.asarray(w, float))
        piece = self.piece_at(slip, rate)
        values = np.empty(slip.shape)
        with np.errstate(over="ignore", under="ignore"):  # exp(-v / 1e-9) may underflow; in a denominator exp(v / 1e-9) overflows
            for i in np.unique(piece).tolist():
                chosen = piece == i
                values[chosen] = self.piece_coefficient(i, slip[chosen], rate[chosen], state[chosen])
        return values

    def static_coefficient(self, u: ArrayLike) -> NDArray[np.float64]:
        """Return the static friction coefficient at slip u (m): the largest |traction| / normal stress while v = 0."""
        return self.coefficient(u) + self.static_excess

    # ---- what follows from the formulas ---------------------------------------------------------------------------------------

    def trees(self) -> tuple[Expression, ...]:
        """Return the formulas of `pieces` as expression trees in SLIP, RATE, parameters and, for a law with a state, STATE."""
        return self._own_trees

    @cached_property
    def _own_trees(self) -> tuple[Expression, ...]:
        return _trees(self.pieces, self.parameters(), tuple(self.literals().items()), self.state is not None)

    @property
    def depends_on_slip(self) -> bool:
        """Return True if mu changes with slip."""
        return self._depends_on(SLIP)

    @property
    def depends_on_rate(self) -> bool:
        """Return True if mu changes with slip rate, or steps down from static to sliding friction."""
        return self.static_excess != 0.0 or self._depends_on(RATE)

    def _depends_on(self, variable: Expression) -> bool:
        knotted = len(self.pieces) > 1 and self.knot_variable == variable.operation
        return knotted or _contain(self.trees(), variable)

    @property
    def variation(self) -> float:
        """Return the finite size by which the friction coefficient changes (no unit).

        It is the upper minus the lower bound of `range`. For friction without an upper bound it is the change between slip rates
        0+ and 1 m/s, at slip 0.
        """
        low, high = self.range()
        if np.all(np.isfinite(high)):
            return high - low
        return float(np.ptp(self.coefficient(0.0, np.linspace(0.0, 1.0, 101))))

    @property
    def bends_one_way(self) -> bool:
        """Return True if mu is convex, or concave, over all slip rates v > 0, so that Z v + S mu(v) turns at most once."""
        return not self.depends_on_rate

    @property
    def rate_scales(self) -> tuple[float, ...]:
        """Return the characteristic slip rates (m/s): the parameters in m/s, and the inverses of those in s/m."""
        scales: list[float] = []
        for name, (declared, _) in fields_of(type(self)).items():
            item = declared.item if isinstance(declared, Series) else declared
            if isinstance(item, Quantity) and item.unit in ("m/s", "s/m"):
                value = getattr(self, name) or ()
                sizes = [abs(number) for number in (value if isinstance(value, tuple) else (value,)) if number]
                scales += [size if item.unit == "m/s" else 1.0 / size for size in sizes]
        return tuple(scales)
