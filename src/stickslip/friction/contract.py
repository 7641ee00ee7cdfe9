"""Define what a friction law states about itself: everything that the author of a law may write is on this page.

`HyperbolicRate` in `laws/of_rate.py` is a typical law. What the code works out from these statements is in `values.py`.
"""

from __future__ import annotations

import math
from abc import ABC
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stickslip.foundation.errors import InputError
from stickslip.foundation.names import TURNS, own_units
from stickslip.foundation.quantities import LawField, check_fields, fields_of, given_in
from stickslip.foundation.show import Declared

Formula = Callable[..., Any]
"""A function that returns mu from the parameters (attributes of the first argument), slip u (m) and slip rate v >= 0 (m/s).

The states of a law that has some are further arguments, in their order.
"""


STATE_NAMES: tuple[Literal["state", "second_state"], ...] = ("state", "second_state")
"""Names of the states of a law for its users: of the only one, or of the first and the second."""
MOST_STATES = 2
"""Largest number of states of a law, beside those that follow from time alone."""


def one_argument(states: Sequence[Any]) -> Any:
    """Return the states of a law, which may be none, as the one argument `w` of `FrictionLaw.coefficient`."""
    return states if len(states) > 1 else states[0] if states else 0.0


@dataclass(frozen=True)
class StateVariable:
    """Describe a state variable of a law: name, unit and meaning of the number that users see."""

    name: str
    unit: str
    meaning: str
    scale: float = 0.0
    """For a state smaller than this, in the form that the formulas use, the error is absolute and not relative.

    With 0 the error is always relative to the state itself.
    """
    reverses: bool = False
    """True if the state has a direction, as the bending of bristles has, and changes its sign where slip reverses.

    Formulas see it in the direction of slip. Friction then passes smoothly through v = 0 at any state, and may drive slip for a
    while: the bristles spring back. Users give and see it in the forward direction.
    """
    signed: bool = False
    """True if the state may be negative at the start. A state that reverses may in any case."""


def states_in(declared: Any) -> tuple[StateVariable, ...]:
    """Return the state variables that a class declares as its `state`."""
    return declared if isinstance(declared, tuple) else (declared,) if isinstance(declared, StateVariable) else ()


@dataclass(frozen=True)
class LawContract(Declared, ABC):
    """The statements of a friction law; subclass `stickslip.friction.FrictionLaw` to make one.

    A law declares its parameters as fields (`quantity` or `declare` of `foundation.quantities`), its formula once, and the class
    attributes below. The formula is either `formula`, or a list `pieces` with one formula for each interval of slip or slip rate,
    separated by `knots`. Parameters and source are added to the docstring of the class.

    The formula is written for a slip rate v >= 0. For backward slip the traction changes sign and v is the magnitude of the slip
    rate. A law is frozen: whatever changes during a run, a state variable included, is stored in the run.
    """

    kind: ClassVar[str]
    """Name of the law in scenario files and in `LAWS`."""
    example: ClassVar[Mapping[str, Any]] = {}
    """Plausible values of the fields, in the form of a scenario file: `stickslip new` shows them and tests use them."""
    counts: ClassVar[Literal["net", "path"]] = "net"
    """The slip that the law sees: "net" is u itself, with its sign; "path" is the accumulated length of slip in both directions.

    The magnitude of initial_slip is included in the path.
    """
    memory: ClassVar[Literal["all", "since-arrest"]] = "all"
    """The time when counting of slip begins: the start of the run, or the last arrest (see `RemembersSlip`)."""
    knot_variable: ClassVar[Literal["slip", "rate"]] = "slip"
    """The variable of `knots`: slip (m) or slip rate (m/s)."""
    state: ClassVar[StateVariable | tuple[StateVariable, ...] | None] = None
    """The state variable, if the law has one, or a tuple of two.

    Formulas then take it as a fourth argument, the second as a fifth, and `state_rate` is their evolution. For a law with two
    states, whatever is said of "the state" below is an array with one more axis in front, for the states.
    """
    given: ClassVar[int] = 0
    """Number of states, the last ones, that follow from time alone, such as a normal load (see `pressed`)."""
    sticks: ClassVar[bool] = True
    """True if the contact rests below a static strength; False if friction passes smoothly through v = 0."""
    start: ClassVar[Mapping[str, Any]] = {}
    """Initial values for the example of a law that never sticks: `coefficient` (load / normal load), `state` and `second_state`."""
    many: ClassVar[bool] = False
    """True if fields may be arrays with one number for each member of a batch.

    Formulas, `range`, `knots` and `static_excess` then return arrays too.
    """
    critical: ClassVar[str] = ""
    """Name of the parameter whose critical value `uniqueness` tells, as in `problem.parameters`; without one, the normal stress.

    On one side of that value several slip rates solve the contact equation (paper, section 3).
    """
    columns: ClassVar[Mapping[str, str]] = {}
    """Columns of a data file and the fields that they fill; a scenario may give a law with columns as `file`."""

    @staticmethod
    def formula(law: Any, u: Any, v: Any) -> Any:
        """Return mu from the parameters (attributes of `law`), slip u (m) and slip rate v >= 0 (m/s).

        u and v are numbers, arrays or expressions: use only ordinary operators and the functions of `formula.functions`.
        """
        raise TypeError(f"{type(law).__name__} has neither a formula nor pieces")

    def range(self) -> tuple[float, float]:
        """Return a lower and an upper bound of the friction coefficient (no unit), at rest and while slipping.

        Without a statement of the law they follow from its formula by interval arithmetic, which is sharp unless a variable
        occurs more than once. The lower bound must not be negative. The upper bound is inf if friction grows without bound.
        """
        return 0.0, math.inf

    @property
    def can_be_negative(self) -> bool:
        """True if the friction coefficient is not known to stay above zero: the engine then watches it inside every step.

        A law that states its `range` is believed. A state that reverses may drive slip, and friction below zero is then no fault.
        """
        return False

    def check(self) -> None:
        """Check conditions that involve several fields. Raise InputError if one is violated."""

    def check_start(self, slip: float) -> None:
        """Check that a run can begin at a slip (m). Raise InputError if friction is no number >= 0 there, or has no slope."""

    @property
    def states(self) -> tuple[StateVariable, ...]:
        """The state variables: none, one or two."""
        return states_in(self.state)

    @property
    def reverses(self) -> tuple[int, ...]:
        """The numbers of the states that change their sign when slip reverses."""
        return tuple(i for i, state in enumerate(self.states) if state.reverses)

    @property
    def static_excess(self) -> float:
        """Static friction minus the formula at v = 0+ (no unit): zero for a law that is continuous at rest."""
        return 0.0

    @property
    def pieces(self) -> tuple[Formula, ...]:
        """One formula for each interval of slip or slip rate; most laws have a single one."""
        return (type(self).formula,)

    @property
    def knots(self) -> tuple[float, ...]:
        """The ascending places (m or m/s) between consecutive pieces: one fewer than `pieces`."""
        return ()

    @property
    def normal_coupling(self) -> float:
        """How far the first state, in the form of the formulas, falls as the normal load grows by a factor e; 0 for most laws."""
        return 0.0

    @property
    def backward_from(self) -> int:
        """The number of the first of `pieces` that holds in backward slip, which `knots` end with inf; 0 if all hold both ways."""
        return 0

    @property
    def ways(self) -> tuple[Any, Any]:
        """The laws that forward and backward slip see: this one twice, unless friction differs with the direction of slip."""
        return self, self

    @property
    def said_of_uniqueness(self) -> str:
        """What `uniqueness` says of the law besides what its values show, a sentence that begins with a space; empty for most."""
        return ""

    # ---- state ----------------------------------------------------------------------------------------------------------------

    @property
    def state_rate(self) -> Formula | tuple[Formula, ...]:
        """The function for dw/dt (unit of w per s) from parameters, slip, slip rate and state; a tuple of two for two states."""
        raise TypeError(f"{type(self).__name__} has no state variable")

    def inner_state(self, value: Any) -> Any:
        """Convert a state as users give it to the number w that the formulas use."""
        return value

    def outer_state(self, w: NDArray[np.float64]) -> NDArray[np.float64]:
        """Convert values of w, the state that the formulas use, to the state that users see."""
        return w

    def steady_state(self, v: ArrayLike) -> NDArray[np.float64] | None:
        """Return the state, as users see it, of steady sliding at slip rates v > 0 (m/s); None if the law does not say.

        Under a law that never sticks, a contact with mass starts there by default.
        """
        return None

    @property
    def healed_state(self) -> Any:
        """The state, as users see it, after endless rest: a contact under a law that sticks starts in it by default."""
        return 0.0 if len(self.states) < 2 else np.zeros(len(self.states))

    # ---------------------------------------------------------------------------------------------------------------------------

    @property
    def slips_in(self) -> str:
        """The unit of slip, "m" or "rad", of numbers of the law that were given with a unit; "" if none was.

        A law of plain numbers fits a contact that slides, where they are in m and m/s, and one that turns: in rad and rad/s.
        """
        parts = [getattr(self, name).slips_in for name, (one, _) in fields_of(type(self)).items() if isinstance(one, LawField)]
        return next((one for one in (vars(self).get("_slips_in", ""), *parts) if one), "")

    def __post_init__(self) -> None:
        given = given_in(self)
        object.__setattr__(self, "_slips_in", given)
        check_fields(self, units=own_units(TURNS) if given == "rad" else {})
        self.check()
        if len(self.states) - self.given > MOST_STATES:
            raise InputError(f"{type(self).__name__}: a law has at most {MOST_STATES} states, this one {len(self.states)}")
