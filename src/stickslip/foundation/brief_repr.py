"""Show a dataclass briefly, with 6 digits and units and only what differs from defaults, and document its fields."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Mapping
from numbers import Real
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arguments import CheckedArguments
from stickslip.foundation.formatting import brief
from stickslip.foundation.quantities import Choice, Field, NamedNumbers, Part, Quantity, Series, fields_of, in_units


class Declared(CheckedArguments):
    """Base of the classes whose fields are declared: these describe themselves in the docstring, and when an object is shown."""

    source: ClassVar[str] = ""
    """Paper and equation from which the class is taken."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        _document_fields(cls, vars(cls).get("source", ""))
        cls.__repr__ = cls.__repr__  # type: ignore[method-assign] # the decorator `dataclass` keeps one that the class itself has

    def __repr__(self) -> str:
        return brief_repr(self)


def _document_fields(kind: type, source: str) -> None:
    """Append the declared fields, as the section Parameters, and the source to the docstring of a class that is being defined.

    The fields of the class itself are still plain attributes. A class without a docstring, or with a section Parameters of its own,
    is left as it is.
    """
    text = kind.__doc__
    if not text or "Parameters\n" in text:
        return
    declared: dict[str, dataclasses.Field[Any]] = {}
    for base in reversed(kind.__mro__[1:]):
        declared |= {name: field for name, field in getattr(base, "__dataclass_fields__", {}).items() if field.metadata}
    declared |= {name: value for name, value in vars(kind).items() if isinstance(value, dataclasses.Field)}
    sections = [text.rstrip()]
    lines = [f"    {name}\n        {_described(one.metadata['declared'])}" for name, one in declared.items() if one.metadata]
    if lines:
        sections.append("    Parameters\n    ----------\n" + "\n".join(lines))
    if source:
        sections.append(f"    Notes\n    -----\n    Source: {source}.")
    kind.__doc__ = "\n\n".join(sections) + "\n    "


def _described(declared: Field) -> str:
    """Return meaning, unit and bounds of a field as a sentence."""
    parts = [declared.meaning]
    if isinstance(declared, Quantity | Series):
        parts = [(declared.item if isinstance(declared, Series) else declared).described]
    if isinstance(declared, Series):
        parts += [f"{declared.least} or more numbers"] + ["ascending"] * declared.ascending
    if isinstance(declared, Choice):
        parts.append(" or ".join(f'"{word}"' for word in declared.allowed))
    text = ", ".join(parts)
    return f"{text[:1].upper()}{text[1:]}."


MOST_SHOWN = 6
"""Largest number of entries of a series that are all shown."""


def brief_repr(owner: Any, units: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return a dataclass as the call that makes it, to 6 digits: "ElasticSlab(density='2800 kg/m^3', thickness='10 km', ...)".

    Fields with their default value are left out. The unit of a field is that of its declaration, or of its name in the class
    attribute `units`; `units` here replaces declared units such as "Pa or N".
    """
    return f"{type(owner).__name__}({', '.join(f'{name}={text}' for name, text in shown_fields(owner, units))})"


def shown_fields(owner: Any, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[tuple[str, str]]:
    """Yield name and text of each field of a dataclass that differs from its default."""
    plain = getattr(type(owner), "units", {})
    for field in dataclasses.fields(owner):
        value, declared = getattr(owner, field.name), field.metadata.get("declared")
        if not field.repr or (field.default is not dataclasses.MISSING and _same(value, field.default)):
            continue
        if declared is None and field.name in plain:
            declared = Quantity(plain[field.name], "")
        yield field.name, _text(value, in_units(declared, units) if declared else None)


def fields_in(owner: Any, place: str) -> Iterator[tuple[str, str, str]]:
    """Yield name, value and meaning of each declared field of a body, a law or a history; names begin with `place`."""
    for name, (declared, _) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if isinstance(declared, Part):
            yield from ((f"{place}{name}", type(value).__name__, declared.meaning), *fields_in(value, f"{place}{name}."))
        elif value is not None:
            yield f"{place}{name}", _text(value, declared).strip("'"), declared.meaning


def _same(value: Any, default: Any) -> bool:
    return value is default or (isinstance(value, Real | str | tuple) and bool(value == default))


def _text(value: Any, declared: Any) -> str:
    """Return a value of a field as text; quantities that have a unit are quoted, as they are given."""
    if isinstance(declared, NamedNumbers):
        return f"{{{', '.join(f'{one.name!r}: {_number(one.value, one.unit)}' for one in value)}}}"
    item = declared.item if isinstance(declared, Series) else declared
    unit = item.unit if isinstance(item, Quantity) and " or " not in item.unit else ""
    if isinstance(value, np.ndarray) and value.ndim:
        return f"<array of shape {value.shape}>"
    if isinstance(value, Real) and not isinstance(value, bool | np.bool_ | int):
        return _number(float(value), unit)
    if isinstance(value, tuple) and type(value) is tuple:
        return _several(value, declared)
    return repr(value)


def _several(values: tuple[Any, ...], declared: Any) -> str:
    texts = [_text(one, declared) for one in (values if len(values) <= MOST_SHOWN else (values[0], values[-1]))]
    if len(values) > MOST_SHOWN:
        return f"<{len(values)} values, {texts[0]} to {texts[1]}>"
    return f"[{', '.join(texts)}]" if isinstance(declared, Series) else f"({', '.join(texts)}{',' * (len(texts) == 1)})"


def _number(value: float, unit: str) -> str:
    return brief(value, "") if unit in ("", "1") or not math.isfinite(value) else f"'{brief(value, unit)}'"
