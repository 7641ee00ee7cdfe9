"""Make a friction law from an expression in u and v with named parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import cached_property, partial
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import override

from stickslip.foundation.conversion import Converted, WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.quantities import Choice, Named, NamedNumbers, Text, declare, quantity
from stickslip.foundation.units import si_base
from stickslip.friction.contract import MOST_STATES, Formula, StateVariable
from stickslip.friction.custom.typed import STATES, check_samples, read_evolution, split, steady
from stickslip.friction.formula.expression import SLIP, Expression, depends_on, nodes_of
from stickslip.friction.formula.functions import evaluate
from stickslip.friction.formula.text import LARGEST_EXPONENT, LONGEST, RESERVED, check_dimensions, parse
from stickslip.friction.law import RemembersSlip

MOST_PARAMETERS = 50
"""Largest number of parameters of an expression, which comes from an untrusted scenario file."""
AtReversal = Literal["keeps-sign", "changes-sign", "first-changes-sign"]
"""Behaviour of states when slip reverses; in the last case the first of two changes its sign, and the second keeps it."""
STATE_UNITS = {"s": "s", "m": "m", "m/s": "m s^-1", "1/s": "s^-1", "1/m": "m^-1"}
"""Units that a state often has, as they are typed and as `si_base` writes them."""
LONGEST_NAME = 40
"""Largest number of characters in the name of a parameter, so that messages and tables stay readable."""
UNKNOWN_VARIATION = 0.1
"""Assumed size of friction's changes (no unit) if the samples do not show it."""


@dataclass(frozen=True)
class FromExpression(RemembersSlip):
    """mu(u, v) as the user writes it; u is the slip (m) that `counts` names, v >= 0 the slip rate (m/s).

    For example `FromExpression("mu_d + (mu_s - mu_d) / (1 + alpha*v)", {"mu_s": 0.8, "mu_d": 0.3, "alpha": "1 s/m"})`. `values` has
    the parameters by name, as numbers in SI or as texts with a unit. The text is never evaluated as Python.

    The static friction coefficient is the value at v = 0, unless `static` gives a higher one: friction then drops by the difference
    as soon as the contact slips.

    The expression must not be negative and must have all derivatives, also where slip begins, at v = 0. Both are checked on
    samples up to 10 m/s at the initial slip of a problem. A run ends if it reaches a slip with negative friction.
    Units are checked if at least one value has a unit; a value without one is then a pure number.

    A law may have a state of its own; `evolution` gives its rate of change: `FromExpression("mu_0 + a*log(1 + v/v_0) + z",
    {"mu_0": 0.6, "a": 0.01, "v_0": "1 um/s", "b": 0.02, "tau": "1 s", "d": "10 um"}, evolution="dz/dt = (b - z)/tau - v*z/d")`. The
    state changes at rest, too, where v = 0. Friction must be finite at state 0. If it is zero at v = 0 in every state, or if the
    state changes its sign at reversal, the contact never sticks. A law may have two states: a semicolon separates their equations
    in `evolution`, and their units in `state_unit` ("m; 1").

    See Also
    --------
    stickslip.friction.FromFunction : a law from a function of Python.
    stickslip.friction.Fit : a law from measured points.

    Examples
    --------
    >>> import stickslip as ss
    >>> law = ss.friction.FromExpression("0.6 - a*(1 - exp(-u/d))", {"a": 0.3, "d": "1 m"})
    >>> print(law.coefficient([0.0, 1.0, 1e3], 0.0).round(6))
    [0.6      0.410364 0.3     ]
    """

    kind = "expression"
    source = "the user's formula"
    example: ClassVar = {
        "expression": "mu_d + (mu_s - mu_d) / (1 + alpha*v)",
        "values": {"mu_s": 0.8, "mu_d": 0.3, "alpha": "1 s/m"},
    }

    expression: str = declare(Text("friction coefficient in u (slip, m), v (slip rate, m/s) and parameters", LONGEST))
    values: Converted[tuple[Named, ...], Mapping[str, float | str | WithUnit] | Sequence[Named]] = declare(
        NamedNumbers("values of the parameters", "parameters"), ()
    )
    _: KW_ONLY
    static: float | None = quantity("1", "friction coefficient at rest, if above the value at v = 0+", at_least=0, default=None)
    evolution: str = declare(
        Text("rate of change of a state, such as dz/dt = (1 - z)/tau, in u, v, z and parameters; two are separated by ;", LONGEST),
        "",
    )
    state_unit: str = declare(
        Text("unit of the state; without it the state is a pure number; those of two states are separated by ;", LONGEST_NAME), ""
    )
    at_reversal: AtReversal = declare(
        Choice("what the state, or each of two states, does where slip reverses", get_args(AtReversal)), "keeps-sign"
    )
    counts: Literal["net", "path"] = declare(Choice("slip that u denotes", ("net", "path")), "net")  # type: ignore[misc] # here a choice of the user

    @override
    def check(self) -> None:
        self._check_names()
        self._check_state()
        self._check_formula("expression")
        if self.evolution:
            for number in range(len(self.states)):
                self._check_formula("evolution", number)
            if not depends_on(self.tree, SLIP):
                self._check_healed(0.0)
        if self.static is not None:
            self._check_static(self.static)

    def _check_names(self) -> None:
        names = [value.name for value in self.values]
        if len(names) > MOST_PARAMETERS:
            raise InputError(f"FromExpression: parameters: at most {MOST_PARAMETERS} parameters are allowed")
        for name in names:
            if not (isinstance(name, str) and name.isidentifier() and name.isascii() and len(name) <= LONGEST_NAME):
                raise InputError(f"FromExpression: parameters: {ascii(name)[:60]} is not a name: letters, digits and _, up to 40")
            if name in RESERVED or names.count(name) > 1:
                raise InputError(f"FromExpression: parameters: the name {name} is reserved or used twice")
        used = {node.name for tree in (self.tree, *self._changes) for node in nodes_of(tree) if node.operation == "parameter"}
        for name in names:
            if name not in used:
                hint = nearest(name, used) if used else "the expression has no parameters"
                raise InputError(f"FromExpression: parameters: {name} does not occur in the expression; {hint}")

    def _check_state(self) -> None:
        """Check the fields that a law with a state needs, and those that only such a law may have."""
        needless = "state_unit" if self.state_unit else "at_reversal" if self.at_reversal != "keeps-sign" else ""
        if needless and not self.evolution:
            raise InputError(f"FromExpression: {needless}: the law has no state: give its rate of change as evolution")
        if self.at_reversal == "first-changes-sign" and len(self._equations) < MOST_STATES:
            raise InputError("FromExpression: at_reversal: the law has no second state; changes-sign is for one state")
        if self.evolution and self.static is not None:
            raise InputError("FromExpression: static: a law with a state has the static coefficient of its expression at v = 0")

    def _check_formula(self, which: Literal["expression", "evolution"], number: int = 0) -> None:
        """Check units, exponents and samples of a formula; states are parameters like any other there."""
        names, is_change = tuple(self._equations), which == "evolution"
        units = {value.name: value.unit for value in self.values} | dict(zip(names, self._units, strict=True))
        text = tuple(self._equations.values())[number] if is_change else self.expression
        try:
            tree = parse(text, (*self.parameters(), *names))
            if any(units.values()):
                try:
                    self._check_dimensions(tree, units, self._units[number] if is_change else None)
                except InputError as error:
                    raise InputError(f"{error}{self._unit_hint()}") from None
            self._check_exponents(tree)
            check_samples(tree, self.numbers(), states=names, negative=is_change)
        except InputError as error:
            raise InputError(f"FromExpression: {which}: {error}") from None

    @override
    def check_start(self, slip: float) -> None:
        names = tuple(self._equations)
        if names:
            self._check_healed(slip)
        for which, trees in (("expression", (self.tree,)), ("evolution", self._changes)):
            for tree in trees:
                try:
                    check_samples(tree, self.numbers(), slip, states=names, negative=which == "evolution")
                except InputError as error:
                    raise InputError(f"FromExpression: {which}: {error}") from None

    def _unit_hint(self) -> str:
        """Return which unit of the state, if none is given, would make all units agree; "" if none of a few does."""
        names = tuple(self._equations)
        if self.state_unit or len(names) != 1:
            return ""
        given = {value.name: value.unit for value in self.values}
        for shown, unit in STATE_UNITS.items():
            units = given | {names[0]: unit}
            try:
                check_dimensions(parse(self.expression, (*self.parameters(), *names)), units)
                check_dimensions(parse(self._equations[names[0]], (*self.parameters(), *names)), units, unit)
            except InputError:
                continue
            return f'; with state_unit = "{shown}" the units agree'
        return ""

    def _check_dimensions(self, tree: Expression, units: Mapping[str, str], state: str | None) -> None:
        """Check the units of a formula: slip is a length, or an angle if the numbers agree with that alone."""
        try:
            check_dimensions(tree, units, state)
        except InputError:
            try:
                check_dimensions(tree, units, state, by_angle=True)
            except InputError:
                check_dimensions(tree, units, state)
            object.__setattr__(self, "_slips_in", "rad")

    def _check_healed(self, slip: float) -> None:
        """Check that friction at rest at a slip (m) in state 0 is a number: loads are kept as differences from it."""
        with np.errstate(all="ignore"):
            value = float(evaluate(self.tree, self.numbers(), slip, 0.0))
        if not math.isfinite(value):
            where = f"at u = {slip:g}, v = 0 and {' and '.join(f'{name} = 0' for name in self._equations)}"
            raise InputError(f"FromExpression: expression: {where} friction must be a finite number, but it is {value:g}")

    def _check_exponents(self, tree: Expression) -> None:
        for node in nodes_of(tree):
            if node.operation == "pow":
                with np.errstate(all="ignore"):
                    exponent = float(evaluate(node.arguments[1], self.numbers() | dict.fromkeys(self._equations, 0.0), 0.0, 0.0))
                if not abs(exponent) <= LARGEST_EXPONENT:
                    raise InputError(f"an exponent is {exponent:g}, it must be within {LARGEST_EXPONENT:g}")

    def _check_static(self, static: float) -> None:
        if depends_on(self.tree, SLIP):
            raise InputError("FromExpression: static needs an expression without u: the step at rest would change with slip")
        sliding = float(self.coefficient(0.0))
        if static < sliding:
            raise InputError(f"FromExpression: static must be at least the expression at v = 0, got {static:g} < {sliding:g}")

    @property
    def tree(self) -> Expression:
        """The formula as an expression tree."""
        states = tuple(self._equations)  # whose faults have their own place
        try:
            return parse(self.expression, self.parameters(), states)
        except InputError as error:
            raise InputError(f"FromExpression: expression: {error}") from None

    @property
    @override
    def pieces(self) -> tuple[Formula, ...]:
        return (self._formula(self.tree),)

    def _formula(self, tree: Expression) -> Formula:
        names = self.parameters()
        return lambda law, u, v, *states: evaluate(tree, {name: getattr(law, name) for name in names}, u, v, *states)

    # ---- the state ------------------------------------------------------------------------------------------------------------

    @cached_property
    def _equations(self) -> dict[str, str]:
        try:
            return read_evolution(self.evolution, self.parameters()) if self.evolution else {}
        except InputError as error:
            raise InputError(f"FromExpression: {error}") from None

    @property
    def _changes(self) -> tuple[Expression, ...]:
        equations = self._equations
        try:
            return tuple(parse(text, self.parameters(), tuple(equations)) for text in equations.values())
        except InputError as error:
            raise InputError(f"FromExpression: evolution: {error}") from None

    @property
    def _units(self) -> tuple[str, ...]:
        """The units of the states in powers of m, kg and s."""
        given = split(self.state_unit) or ("1",) * len(self._equations)
        if len(given) != len(self._equations):
            raise InputError(f'FromExpression: state_unit: give one unit for each state, such as "m; 1", got {self.state_unit!a}')
        units = []
        for one in given:
            try:
                number, unit = (1.0, "") if one == "1" else si_base(f"1 {one}")
            except InputError as error:
                raise InputError(f"FromExpression: state_unit: {error}") from None
            if number != 1.0:
                raise InputError(f"FromExpression: state_unit: {one} must be a unit of the SI without a prefix; write {unit}")
            units.append(unit)
        return tuple(units)

    @cached_property
    def state(self) -> StateVariable | tuple[StateVariable, ...] | None:  # type: ignore[override] # of the instance here
        """The state variables, if `evolution` is given."""
        reverse = {"keeps-sign": 0, "first-changes-sign": 1, "changes-sign": MOST_STATES}[self.at_reversal]
        units = split(self.state_unit) or ("1",) * len(self._equations)
        states = tuple(
            StateVariable(name, unit, f"state {name}", reverses=i < reverse, signed=True)
            for i, (name, unit) in enumerate(zip(self._equations, units, strict=False))
        )
        return states if len(states) > 1 else states[0] if states else None

    @cached_property
    def sticks(self) -> bool:  # type: ignore[override] # of the instance here
        """False for a law with a state if friction passes smoothly through v = 0."""
        if not self.evolution:
            return True
        with np.errstate(all="ignore"):
            at_rest = np.asarray(evaluate(self.tree, self.numbers(), 0.0, 0.0, *np.meshgrid(*[STATES] * len(self._equations))))
        return self.at_reversal == "keeps-sign" and bool(np.any(at_rest[np.isfinite(at_rest)] != 0.0))

    @property
    @override
    def state_rate(self) -> Formula | tuple[Formula, ...]:
        return tuple(self._formula(tree) for tree in self._changes) or super().state_rate

    @override
    def steady_state(self, v: ArrayLike) -> NDArray[np.float64] | None:
        """Return the state of steady sliding at slip rates v >= 0 (m/s) and slip 0; None where none is found.

        It is the stable steady state nearest 0: a disturbed state returns to it. The search covers magnitudes from 1e-18 to 1e18.
        """
        if not self.evolution:
            return None
        rates = np.ravel(np.asarray(v, float))

        def change(tree: Expression, cases: NDArray[np.int64], *states: NDArray[np.float64]) -> NDArray[np.float64]:
            return np.asarray(evaluate(tree, self.numbers(), 0.0, rates[cases], *states))

        found = steady([partial(change, tree) for tree in self._changes], len(rates))
        if found is None:
            return None
        return found.reshape(np.shape(v) if len(found) == 1 else (len(found), *np.shape(v)))

    @property
    @override
    def healed_state(self) -> Any:
        found = self.steady_state(0.0)
        return super().healed_state if found is None else found[()]

    # ---------------------------------------------------------------------------------------------------------------------------

    @override
    def parameters(self) -> tuple[str, ...]:
        return tuple(value.name for value in self.values)

    @override
    def piece_values(self, i: int) -> tuple[float, ...]:
        return tuple(value.value for value in self.values)

    @property
    @override
    def static_excess(self) -> float:
        return 0.0 if self.static is None else self.static - float(self.coefficient(0.0))

    @property
    @override
    def variation(self) -> float:
        """A finite size of friction's changes (no unit).

        If the bounds are not finite, it is the range of the values at slips up to 10 m and slip rates up to 10 m/s, as far as they
        are numbers.
        """
        low, high = self.range()
        if math.isfinite(high):
            return high - low
        if self.evolution:
            return self._steady_variation()
        slip, rate = np.linspace(0.0, 10.0, 201)[:, None], np.append(0.0, np.geomspace(1e-9, 10.0, 200))
        with np.errstate(all="ignore"):  # the formula may have a pole there
            values = self.coefficient(slip, rate)
        known = values[np.isfinite(values)]
        return max(float(np.ptp(known)) if known.size else UNKNOWN_VARIATION, self.static_excess)

    def _steady_variation(self) -> float:
        """Return the change of friction between steady sliding at slip rates up to 10 m/s, and state 0 at rest; 0.1 if unknown."""
        rates = np.geomspace(1e-9, 10.0, 41)
        states = self.steady_state(rates)
        with np.errstate(all="ignore"):
            known = 0.0 if states is None else np.concatenate((states, np.zeros((*states.shape[:-1], 1))), axis=-1)
            values = self.coefficient(0.0, np.append(rates, 0.0), known)
        known = values[np.isfinite(values)]
        return (float(np.ptp(known)) if known.size else 0.0) or UNKNOWN_VARIATION

    @property
    @override
    def rate_scales(self) -> tuple[float, ...]:
        """The characteristic slip rates (m/s): values in m/s, and inverses of values in s/m.

        If no value has a unit, any number of the expression may be a slip rate or the inverse of one: both are returned.
        """
        units = {value.unit for value in self.values} - {""}
        scales = [
            abs(value.value) ** (1 if value.unit == "m s^-1" else -1)
            for value in self.values
            if value.value and value.unit in ("m s^-1", "m^-1 s")  # as `si_base` writes them
        ]
        if units:
            return tuple(scales)
        constants = [node.value for node in nodes_of(self.tree) if node.operation == "constant"]
        sizes = [abs(number) for number in (*self.piece_values(0), *constants) if number]
        return tuple(dict.fromkeys(scale for size in sizes for scale in (size, 1.0 / size)))
