"""Give some numbers of a law, a body, a loading history or a problem other values, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields, replace
from typing import Any, TypeVar, cast

from stickslip.foundation.quantities import NamedNumbers, fields_of

Owner = TypeVar("Owner")


def with_values(owner: Owner, values: Mapping[str, Any], make: Callable[..., Owner] = replace) -> Owner:
    """Return an owner with other values (SI) of its numbers, by names such as "alpha", "values[1]", "rate.alpha", "parameters.k".

    `make` is `replace`, or `unchecked`: it is called once for each owner whose numbers change. Raises InputError for what an owner
    does not allow.
    """
    inside: dict[str, dict[str, Any]] = {}
    for name, value in values.items():
        step, _, rest = name.partition(".")
        inside.setdefault(step, {})[rest] = value
    named = {declared.key: name for name, (declared, _) in fields_of(type(owner)).items() if isinstance(declared, NamedNumbers)}
    changes: dict[str, Any] = {}
    for step, given in inside.items():
        field, _, index = step.partition("[")
        if index:
            entries = list(changes.get(field, getattr(owner, field)))
            entries[int(index[:-1])] = given[""]
            changes[field] = tuple(entries)
        elif step in named:
            numbers = getattr(owner, named[step])
            changes[named[step]] = tuple(one._replace(value=given.get(one.name, one.value)) for one in numbers)
        else:
            changes[field] = given[""] if "" in given else with_values(getattr(owner, field), given, make)
    return make(owner, **changes)


def unchecked(owner: Owner, **numbers: Any) -> Owner:
    """Return a body, law or problem with other numbers, which may be arrays and are not checked."""
    made = object.__new__(type(owner))  # without what the owner remembers that follows from its numbers
    vars(made).update({one.name: getattr(owner, one.name) for one in fields(cast(Any, owner))} | numbers)
    return made
