"""Make a friction law of what a user gives as one: a law, a Python function, or the text of an expression."""

from __future__ import annotations

from typing import Any

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.friction.custom.from_expression import FromExpression
from stickslip.friction.custom.from_function import FromFunction
from stickslip.friction.formula.parse import UNDECLARED
from stickslip.friction.law import FrictionLaw

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
