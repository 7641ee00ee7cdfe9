"""Make a friction law from a law, a text, or a Python function, which is called once with symbols and recorded."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from numbers import Real
from typing import Any, Literal, overload

import numpy as np

from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError, nearest
from stickslip.friction.custom.from_expression import AtReversal, FromExpression
from stickslip.friction.formula.expression import RATE, SLIP, Expression, Magnitude, Parameter, as_expression, nodes_of
from stickslip.friction.formula.text import UNDECLARED, to_text
from stickslip.friction.law import FrictionLaw

VARIABLES = {"u": SLIP, "v": RATE}
"""Symbols of the possible arguments of friction."""
OPTIONS = ("static", "counts", "memory", "state", "state_unit", "at_reversal")
"""Options of the law itself, given together with the values of the function's parameters."""
NUMPY = "sin, cos, exp, log, sqrt, tanh, arcsinh, expm1, log1p"
"""The functions of numpy that a message names."""
_NAMED = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
"""Kinds of arguments that have a name each: not *args, not **named."""


@overload
def FromFunction(
    function: Callable[..., Any],
    /,
    *,
    static: float | str | None = None,
    counts: Literal["net", "path"] = "net",
    memory: Literal["all", "since-arrest"] = "all",
    state: str | Sequence[str] = "",
    state_unit: str = "",
    at_reversal: AtReversal = "keeps-sign",
    **parameters: float | str | WithUnit,
) -> FromExpression: ...
@overload
def FromFunction(
    function: None = None,
    /,
    *,
    static: float | str | None = None,
    counts: Literal["net", "path"] = "net",
    memory: Literal["all", "since-arrest"] = "all",
    state: str | Sequence[str] = "",
    state_unit: str = "",
    at_reversal: AtReversal = "keeps-sign",
    **parameters: float | str | WithUnit,
) -> Callable[[Callable[..., Any]], FromExpression]: ...
@for_users
def FromFunction(function: Callable[..., Any] | None = None, /, **given: Any) -> Any:  # noqa: N802 - reads as the law it makes
    """Make a friction law from a Python function of slip u, of slip rate v, or of both, with named parameters.

    Call it, or write it over the function::

        law = ss.friction.FromFunction(my_function, mu_s=0.8, mu_d=0.3)

        @ss.friction.FromFunction
        def law(v, mu_s=0.8, mu_d=0.3, v_c="0.1 m/s"):
            return mu_d + (mu_s - mu_d) * np.exp(-v / v_c)

        @ss.friction.FromFunction(state="z")
        def healing(v, z, mu_0=0.6, b=0.02, tau="1 s", d="10 um"):
            return mu_0 + z, (b - z) / tau - v * z / d

    Parameters
    ----------
    function
        A function that returns the friction coefficient (no unit). Its argument named u is the slip (m), its argument named v the
        magnitude of the slip rate (m/s, never negative); all others are parameters. Leave it out to use `FromFunction` as a
        decorator with values.
    **given
        Values of the function's parameters: numbers in SI, or texts with a unit. The others have their defaults. `static`,
        `counts`, `memory`, `state_unit` and `at_reversal` are options of the law (see `FromExpression`), unless the function has a
        parameter of that name. `state` names the one or two arguments that are states of the law; the function then returns the
        friction coefficient and the rate of change of each state (its unit over s).

    Returns
    -------
    FromExpression or decorator
        The law, which a scenario file can also hold; without `function`, a decorator that makes the law.

    Raises
    ------
    InputError
        If the function cannot be traced, or a value is missing or wrong; the message is one line that says what.

    Notes
    -----
    The static friction coefficient is the value at v = 0, the limit from v > 0. A higher one is given as `static`: friction then
    drops by the difference as soon as the contact slips.

    The function is called once, with symbols for u, v and the parameters. Ordinary operators, numpy's sin, cos, exp, log, sqrt,
    tanh, arcsinh, expm1 and log1p, and numpy functions composed of these are recorded. Branches on values cannot be recorded: a law
    with a kink is `PiecewiseLinearRate`, `PiecewiseLinearSlip`, `LinearSlipWeakening` or `FromTable`.
    """
    if function is None:
        return lambda decorated: FromFunction(decorated, **given)
    try:
        signature = _signature(function)
        states = _states(signature, given)
        values = _values(signature, given, states)
        options = {name: value for name, value in given.items() if name in OPTIONS and name not in values and name != "state"}
        trees = _traced(function, signature, states)
        if states:
            equations = [f"d{state}/dt = {to_text(tree)}" for state, tree in zip(states, trees[1:], strict=True)]
            options["evolution"] = "; ".join(equations)
        used = {node.name for tree in trees for node in nodes_of(tree) if node.operation == "parameter"}
        return FromExpression(to_text(trees[0]), {name: value for name, value in values.items() if name in used}, **options)
    except InputError as error:
        fault = str(error).removeprefix("formula: ").removeprefix("FromExpression: ").removeprefix("expression: ")
        name = getattr(function, "__name__", None) or shown(function)
        raise InputError(f"FromFunction: {ascii(name)[1:-1]}: {fault}") from None


def _signature(function: Callable[..., Any]) -> inspect.Signature:
    if isinstance(function, type):
        raise InputError(f"it is a class: a law is made with its parameters, {function.__name__}(...)")
    if isinstance(function, str):
        raise InputError("it is a text: a formula as text makes a law with FromExpression")
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):
        raise InputError("it is not a Python function whose arguments can be read; wrap it: lambda v: ...") from None
    if any(one.kind not in _NAMED for one in signature.parameters.values()):
        raise InputError("it must name each of its arguments: u, v and parameters, without *args and **named")
    if not set(VARIABLES) & set(signature.parameters):
        found = ", ".join(signature.parameters) or "none"
        raise InputError(f"it must have an argument named u (slip, m) or v (slip rate, m/s), or both; its arguments are: {found}")
    return signature


def _states(signature: inspect.Signature, given: dict[str, Any]) -> tuple[str, ...]:
    if "state" in signature.parameters:
        return ()
    named = given.get("state", "")
    states = (named,) if isinstance(named, str) and named else tuple(named)
    for state in states:
        if state not in signature.parameters:
            arguments = [name for name in signature.parameters if name not in VARIABLES]
            hint = nearest(str(state), arguments)
            raise InputError(f"state names the argument that is the state; it has none called {shown(state)}; {hint}")
    return states


def _values(signature: inspect.Signature, given: dict[str, Any], states: tuple[str, ...]) -> dict[str, Any]:
    """Return the values of the function's parameters other than u, v and the states, from its defaults and the given values."""
    parameters = [one for one in signature.parameters.values() if one.name not in (*VARIABLES, *states)]
    names = [one.name for one in parameters]
    for extra in given:
        if extra in VARIABLES:
            raise InputError(f"{extra} is the {'slip' if extra == 'u' else 'slip rate'}, not a parameter: it takes no value")
        if extra not in names and extra not in OPTIONS:
            raise InputError(f"it has no parameter {extra}; {nearest(extra, [*names, *OPTIONS])}")
    values = {one.name: given.get(one.name, one.default) for one in parameters}
    for name, value in values.items():
        if value is inspect.Parameter.empty:
            raise InputError(f"parameter {name} has no value: give it a default, or FromFunction(..., {name}=...)")
    return values


def _traced(function: Callable[..., Any], signature: inspect.Signature, states: tuple[str, ...]) -> tuple[Expression, ...]:
    """Return the formula that the function records when it is called with symbols, and the formulas of its states' changes.

    A state is a symbol with its own name, as a parameter is: the formulas are written out as text.
    """
    symbols = {name: VARIABLES[name] if name in VARIABLES else Parameter(name) for name in signature.parameters}
    call = inspect.BoundArguments(signature, symbols)
    try:
        value = function(*call.args, **call.kwargs)
    except InputError:
        raise
    except Exception as error:  # a user's function may raise anything when it is called with symbols
        said = " ".join(str(error).split())[:120]
        raise InputError(
            f"it cannot be traced ({type(error).__name__}: {said}); use + - * / ** and numpy's {NUMPY}; points make a FromTable"
        ) from None
    if not states:
        return (_formula(value),)
    if not (isinstance(value, tuple | list) and len(value) == 1 + len(states)):
        number, changes = ("two", "three")[len(states) - 1], " and ".join(f"d{state}/dt" for state in states)
        raise InputError(f"with a state it must return {number} numbers, the friction coefficient and {changes}")
    return tuple(_formula(one) for one in value)


def _formula(value: Any) -> Expression:
    """Return what the function returned as a formula. Raises InputError if it is neither a formula nor a number."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, Expression | Magnitude) or (isinstance(value, Real) and not isinstance(value, bool)):
        return as_expression(value)
    if value is None:
        raise InputError("it returns nothing: end it with return and the friction coefficient")
    if isinstance(value, tuple):
        cure = 'name the argument that is a state of the law, as in FromFunction(f, state="z")'
        raise InputError(f"it returns several numbers: {cure}")
    what = "an array" if isinstance(value, np.ndarray) else shown(value) if isinstance(value, str | bool) else type(value).__name__
    raise InputError(f"it must return one number, the friction coefficient, and returns {what}: it is called with one u and one v")


WANTED = 'a friction law, a function of u and v, or a text such as "0.3 + 0.5/(1 + v)"'
"""What may be given as a law, for messages."""


def as_law(where: str, given: Any) -> FrictionLaw:
    """Return a law unchanged, a Python function or the text of an expression as a law.

    Raises InputError, beginning with `where`, for anything else, and for a function or a text that cannot be made a law.
    """
    if isinstance(given, FrictionLaw):
        return given
    if isinstance(given, type) or not (callable(given) or isinstance(given, str)):
        cure = ""
        if isinstance(given, type) and issubclass(given, FrictionLaw):
            cure = f" with its parameters, {given.__name__}({', '.join(f'{name}=...' for name in given.example)})"
        raise InputError(f"{where} must be {WANTED}, got {shown(given)}{cure}")
    try:
        return _from_text(given) if isinstance(given, str) else FromFunction(given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _from_text(text: str) -> FrictionLaw:
    """Return the law of an expression. Raises InputError with a hint if the text looks like something else."""
    try:
        return FromExpression(text)
    except InputError as error:
        word, fault = text.strip(), str(error).removeprefix("FromExpression: ").removeprefix("expression: ")
    if word.replace("-", "_").isidentifier():
        fault = f"{ascii(word)[:60]} is not a formula; the laws of the package are classes, such as ss.friction.Coulomb(...)"
    elif word.lower().endswith((".csv", ".txt", ".dat")):
        fault = f"{ascii(word)[:60]} is not a formula; measured points make a law with ss.friction.FromTable(file)"
    elif UNDECLARED in fault:
        fault += "; parameters get values in ss.friction.FromExpression(text, {name: value})"
    raise InputError(fault)
