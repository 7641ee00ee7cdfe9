"""A function of a record is called with the arguments of the record: a dataclass declares their names, types and defaults once."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import wraps
from inspect import signature
from typing import ParamSpec, TypeVar

from stickslip.foundation.arguments import check_names
from stickslip.foundation.takes import Said, told

Fields = ParamSpec("Fields")
Record = TypeVar("Record")
Result = TypeVar("Result")


def takes_fields(
    said: Mapping[str, Said], record: Callable[Fields, Record]
) -> Callable[[Callable[[Record], Result]], Callable[Fields, Result]]:
    """Decorate a function of a record: it is called with the arguments of the record, which type checkers see, too.

    `said` has what is said of each.
    """

    def decorate(function: Callable[[Record], Result]) -> Callable[Fields, Result]:
        full = list(signature(record).parameters.values())

        @wraps(function)
        def call(*args: Fields.args, **by_name: Fields.kwargs) -> Result:
            check_names(function.__name__, full, args, by_name)
            return function(record(*args, **by_name))

        return told(call, full, said, [one.name for one in full])

    return decorate
