"""Write the declared fields of a class into its docstring."""

from __future__ import annotations

import dataclasses
from typing import Any

from stickslip.foundation.quantities import Choice, Field, Quantity, Series


def document_fields(kind: type, source: str = "") -> None:
    """Append the declared fields, as the section Parameters, and the source to the docstring of a class that is being defined.

    Call it in `__init_subclass__`, where the fields of the class itself are still plain attributes. A class without a docstring, or
    with a section Parameters of its own, is left as it is.
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
