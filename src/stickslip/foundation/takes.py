"""Options that several functions take by name: their names, their types and what is said of them stand once.

A function `f(problem, **options: Unpack[Given])` takes the options of a TypedDict, for type checkers. `takes` says the same to
people: `help(f)` lists them in its signature and under Parameters, where the docstring has a line "{options}".
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from inspect import Parameter, signature
from textwrap import fill
from typing import Any, NamedTuple, TypeVar, cast

Function = TypeVar("Function", bound=Callable[..., Any])
WIDTH = 128
"""Width of a line of a docstring, in characters."""


class Said(NamedTuple):
    """What is said of an option: the types that may be given, in words, and what it means."""

    types: str
    meaning: str
    """For the docstring and, in one sentence or two, for the help of the command line."""
    more: str = ""
    """What only the docstring says."""
    default: Any = None


def takes(said: Mapping[str, Said], given: type, *more: str, others: str = "") -> Callable[[Function], Function]:
    """Decorate a function that takes the options of `given`, a TypedDict, and `more` that it names itself: see the module.

    `said` has what is said of each. Arguments that the function does not have are refused with the nearest, unless it checks them
    itself: `others` is the name under which the signature shows these.
    """

    def decorate(function: Function) -> Function:
        from stickslip.foundation.arguments import for_users  # which needs numpy; what is said of options does not

        own = list(signature(function).parameters.values())
        named = [one for one in own if one.kind is not one.VAR_KEYWORD]
        names = [name for name in said if name in given.__annotations__]
        options = [_parameter(name, given.__annotations__[name], said[name].default) for name in names]
        any_name = [Parameter(others, Parameter.VAR_KEYWORD)] if others else []
        full = [*named, *options, *any_name]
        known = {one.name for one in full}

        @wraps(function)
        def call(*args: Any, **by_name: Any) -> Any:
            if not others and not known.issuperset(by_name):
                raise TypeError  # `for_users` answers it with the nearest name
            return function(*args, **by_name)

        return cast(Function, for_users(told(call, full, said, (*more, *names))))

    return decorate


def _parameter(name: str, kind: Any, default: Any) -> Parameter:
    """Return an option as the signature shows it."""
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=getattr(kind, "__forward_arg__", kind))


def told(call: Function, full: Sequence[Parameter], said: Mapping[str, Said], names: Iterable[str]) -> Function:
    """Return a function whose signature has all parameters, and its docstring the entries of these."""
    call.__signature__ = signature(call).replace(parameters=full)  # type: ignore[attr-defined] # `inspect` reads it
    entries = "".join(_entry(name, said[name]) for name in names)
    call.__doc__ = (call.__doc__ or "").replace("    {options}\n", entries)
    return call


def _entry(name: str, said: Said) -> str:
    """Return the entry of an option under Parameters."""
    text = " ".join(one for one in (said.meaning, said.more) if one)
    return f"    {name} : {said.types}\n{fill(text, WIDTH, initial_indent=' ' * 8, subsequent_indent=' ' * 8)}\n"
