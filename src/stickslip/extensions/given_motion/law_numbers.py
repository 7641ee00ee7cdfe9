"""The numbers of a law that a fit may change, by name, and a law with other values of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from stickslip.foundation.errors import InputError, full_name
from stickslip.foundation.quantities import LawField, Named, NamedNumbers, Quantity, fields_of
from stickslip.friction import FrictionLaw


@dataclass(frozen=True)
class LawNumber:
    """A number of a law: its place as in a scenario file, its value and unit, its lower limit, and whether that is exclusive."""

    name: str
    value: float
    unit: str
    least: float | None = None
    positive: bool = False


def numbers_of(law: FrictionLaw, prefix: str = "friction") -> Iterator[LawNumber]:
    """Yield the numbers of a law, those of its parts, and the values of a typed one."""
    for name, (declared, _) in fields_of(type(law)).items():
        value = getattr(law, name)
        if isinstance(declared, LawField):
            yield from numbers_of(value, f"{prefix}.{name}")
        elif isinstance(declared, NamedNumbers):
            yield from (LawNumber(f"{prefix}.{one.name}", one.value, one.unit or "1") for one in value)
        elif isinstance(declared, Quantity) and value is not None and not declared.whole:
            least = declared.at_least if declared.above is None else declared.above
            yield LawNumber(f"{prefix}.{name}", float(value), declared.unit, least, declared.above == 0.0)


def with_numbers(law: FrictionLaw, values: Mapping[str, float], prefix: str = "friction") -> FrictionLaw:
    """Return a law with other values of some of its numbers, by their whole names. Raises InputError as the law does."""
    changed: dict[str, Any] = {}
    for name, (declared, _) in fields_of(type(law)).items():
        own = f"{prefix}.{name}"
        if isinstance(declared, LawField) and any(one.startswith(f"{own}.") for one in values):
            changed[name] = with_numbers(getattr(law, name), values, own)
        elif isinstance(declared, NamedNumbers):
            given = getattr(law, name)
            changed[name] = tuple(Named(one.name, values.get(f"{prefix}.{one.name}", one.value), one.unit) for one in given)
        elif own in values:
            changed[name] = values[own]
    return replace(law, **changed)


def free_numbers(law: FrictionLaw, free: list[str], extra: Mapping[str, float]) -> list[LawNumber]:
    """Return the free numbers of a law, and those in `extra` with their values, by whole or last names. Raises InputError."""
    known = {one.name: one for one in numbers_of(law)}
    known |= {name: LawNumber(name, value, "") for name, value in extra.items()}
    names = [full_name(one.strip(), known, "identify: free: ", "is no number of this law or record") for one in free]
    if not names or len(set(names)) < len(names):
        raise InputError(f"identify: free must name numbers, each once, such as {', '.join(list(known)[:3])}")
    return [known[name] for name in names]
