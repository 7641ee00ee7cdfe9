"""Make a friction law from a Python function, by calling it once with symbols: the recorded formula can be compiled."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from stickslip.foundation.errors import InputError, nearest
from stickslip.friction.custom.from_expression import FromExpression
from stickslip.friction.formula.expression import RATE, SLIP, Expression, Parameter, as_expression, nodes_of
from stickslip.friction.formula.text import to_text

OPTIONS = ("static", "counts", "memory")
"""Options of the law itself, given together with the values of the function's parameters."""


def FromFunction(function: Callable[..., Any] | None = None, **given: Any) -> Any:  # noqa: N802 - reads as the law it makes
    """Make a friction law from a Python function mu(u, v, **parameters).

        law = ss.friction.FromFunction(my_function, mu_s=0.8, mu_d=0.3)

        @ss.friction.FromFunction(mu_s=0.8, mu_d=0.3)
        def law(u, v, mu_s, mu_d): return mu_d + (mu_s - mu_d) * np.exp(-v / 0.1)

    Parameters
    ----------
    function
        A function of slip u (m), slip rate v >= 0 (m/s) and named parameters that returns the friction coefficient (no unit).
        Leave it out to use `FromFunction` as a decorator.
    **given
        Values of the function's parameters: numbers in SI, or texts with a unit. `static`, `counts` and `memory` are options of
        the law (see `FromExpression`), unless the function has a parameter of that name.

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
    The function is called once, with symbols for u, v and the parameters. Ordinary operators, numpy's sin, cos, exp, log, sqrt,
    tanh and arcsinh, and numpy functions composed of these are recorded. Branches on values cannot be recorded.
    """
    if function is None:
        return lambda decorated: FromFunction(decorated, **given)
    values = _values(function, given)
    options = {name: value for name, value in given.items() if name in OPTIONS and name not in values}
    try:
        tree = _traced(function, tuple(values))
        used = {node.name for node in nodes_of(tree) if node.operation == "parameter"}
        return FromExpression(to_text(tree), {name: value for name, value in values.items() if name in used}, **options)
    except InputError as error:
        fault = str(error).removeprefix("formula: ").removeprefix("FromExpression: ")
        raise InputError(f"FromFunction: {_name(function)}: {fault}") from None


def _values(function: Callable[..., Any], given: dict[str, Any]) -> dict[str, Any]:
    """Return the values of the function's parameters other than u and v, from its defaults and the given values."""
    name = _name(function)
    try:
        signature = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        raise InputError(f"FromFunction: {name} is not a Python function whose parameters can be read") from None
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    first, rest = list(signature)[:2], list(signature)[2:]
    if len(first) < 2 or any(p.kind not in kinds for p in rest):
        raise InputError(f"FromFunction: {name} must be a function of u and v, then named parameters")
    names = [p.name for p in rest]
    for extra in given:
        if extra not in names and extra not in OPTIONS:
            raise InputError(f"FromFunction: {name} has no parameter {extra}; {nearest(extra, [*names, *OPTIONS])}")
    values = {p.name: given.get(p.name, p.default) for p in rest}
    missing = [p for p, value in values.items() if value is inspect.Parameter.empty]
    if missing:
        raise InputError(f"FromFunction: {name}: parameter {missing[0]} has no value")
    return values


def _traced(function: Callable[..., Any], names: tuple[str, ...]) -> Expression:
    """Return the formula that the function records when it is called with symbols."""
    try:
        return as_expression(function(SLIP, RATE, **{name: Parameter(name) for name in names}))
    except InputError:
        raise
    except Exception as error:  # a user's function may raise anything when it is called with symbols
        said = " ".join(str(error).split())[:120]
        raise InputError(
            f"it cannot be traced ({type(error).__name__}: {said}); "
            "use + - * / ** and numpy's sin, cos, exp, log, sqrt, tanh, arcsinh"
        ) from None


def _name(function: Any) -> str:
    return str(getattr(function, "__name__", type(function).__name__))
