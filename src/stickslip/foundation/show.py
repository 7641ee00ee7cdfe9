"""Show numbers with units, tables and dataclasses to people: on the terminal, in notebooks and in `repr`."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import chain, repeat, zip_longest
from numbers import Real
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np

from stickslip.foundation.arguments import CheckedArguments
from stickslip.foundation.constants import YEAR
from stickslip.foundation.given import Given, display_name, preferred
from stickslip.foundation.names import has_prefixes, readable_unit, short_units, si_unit
from stickslip.foundation.quantities import Choice, Field, LawField, NamedNumbers, NumberSeries, Quantity, fields_of, in_units

_TIMES = ((YEAR, "years"), (86_400.0, "days"), (3_600.0, "hours"), (60.0, "min"), (1.0, "s"))
"""Units of time with their lengths in s, longest first."""
NamedLine = tuple[str, str]
"""The name of a line, and its text."""
BRIEF_DIGITS = 6
"""Number of significant digits of `brief`."""
UNHANDY = 2
"""A text may be this many characters longer if its number then lies between 0.1 and 1000."""


def number(value: float, digits: int = 8) -> str:
    """Format a number with the given number of significant digits; NaN is shown as a dash."""
    return "-" if math.isnan(value) else f"{value:.{digits}g}"


def with_unit(value: float, unit: str) -> str:
    """Format a quantity for users: 34.3 GPa, 1.5147648e+10 s (480 years); slow rates are also given per year.

    A number that was given in a unit of a trade is shown as it was given.
    """
    if unit == "1":
        return number(value)
    if isinstance(value, Given):
        return f"{number(value.amount)} {display_name(value.unit, unit)}"
    shown, size = readable_unit(unit, value, plain=True)
    plain = f"{number(value / size)} {shown}"
    if unit == "s" and 1e5 <= abs(value) < math.inf:
        return f"{plain} ({number(value / YEAR, 6)} years)"
    if unit.endswith("/s") and not has_prefixes(unit) and 0 < abs(value) < 1e-4:
        return f"{plain} ({number(value * YEAR, 6)} {unit.removesuffix('/s')}/year)"
    return plain


def in_turns(angle: float) -> str:
    """Return an angle (rad) in turns, in brackets, if it has one or more: " (600.5 turns)"."""
    turns = angle / (2.0 * math.pi)
    return f" ({number(turns, 6)} turns)" if abs(turns) >= 1.0 else ""


def brief(value: float, unit: str, digits: int = BRIEF_DIGITS) -> str:
    """Format a quantity, with 6 digits by default, in the unit that makes it short: "10 km", "0.05 m/year", "100 MPa".

    Unlike `with_unit` it gives a text that can be given for the quantity again; "1/m" is then written "/m".
    """
    if unit in ("1", ""):
        return f"{value:.{digits}g}"
    if given := preferred(unit, abs(value)):
        return f"{value / given[1]:.{digits}g} {given[0]}"
    units = ((unit.removeprefix("1"), 1.0), *short_units(unit))
    sizes = ((f"{value / factor:.{digits}g}", name, abs(value / factor)) for name, factor in units)
    shown, name, _ = min(sizes, key=lambda one: len(one[0] + one[1]) + (0 if 0.1 <= one[2] < 1000.0 else UNHANDY))
    return f"{shown} {name.removesuffix('s') if (shown, name) == ('1', 'years') else name}"


def exactly(value: float, unit: str, digits: int = 9) -> str:
    """Format a quantity with many digits in its SI unit, or in the given unit of its kind."""
    return exact_range((value,), unit, digits)


def exact_range(values: Sequence[float], unit: str, digits: int = 9, between: str = " to ") -> str:
    """Format quantities, such as both ends of a range, in one unit, as `exactly` does."""
    name, size = preferred(unit, max(abs(value) for value in values)) or (unit, 1.0)
    return f"{between.join(f'{value / size:.{digits}g}' for value in values)} {name}"


def how_long(reached: float, asked: float) -> str:
    """Return the time (s) that a run reached and, if it ended early, the time (s) that was asked for."""
    return with_unit(reached, "s") + (f" of {with_unit(asked, 's')} asked for" if reached < asked else "")


def in_unit(seconds: float) -> tuple[float, str]:
    """Return the length (s) and the name of the largest unit that is not longer than a time; seconds for times below 1 s."""
    return next(((length, name) for length, name in _TIMES if seconds >= length), _TIMES[-1])


def about_time(seconds: float) -> str:
    """Format a time (s) briefly in its largest unit, such as 3.2 min."""
    length, name = in_unit(seconds)
    value = seconds / length
    return f"{value:.0f} {name}" if value >= 100.0 else f"{number(value, 2)} {name}"


def with_uncertainty(value: float, uncertainty: float | None) -> str:
    """Return a value with the digits that its standard uncertainty leaves, and the uncertainty with two digits.

    Without an uncertainty the value has six digits.
    """
    if uncertainty is None or not math.isfinite(uncertainty):
        return f"{value:.6g}"
    if uncertainty < 1e-12 * abs(value) or uncertainty == 0.0:
        return f"{value:.10g} ± {uncertainty:.1g}"
    size = max(abs(value), uncertainty)
    digits = min(max(2 + math.floor(math.log10(size)) - math.floor(math.log10(uncertainty)), 2), 15)
    if 1e-4 <= size < 1e6:
        decimals = max(1 - math.floor(math.log10(uncertainty)), 0)
        return f"{value:.{decimals}f} ± {uncertainty:.{decimals}f}"
    return f"{value:.{digits - 1}e} ± {uncertainty:.1e}"


def text_table(title: str, rows: Sequence[Sequence[str]]) -> str:
    """Return a title and rows, the first text of each its name, as lines of text; the last column may be any length."""
    widths = [max(map(len, column)) for column in zip_longest(*(row[:-1] for row in rows), fillvalue="")]
    lines = ("  ".join(("", *(f"{text:<{width}}" for text, width in zip(row[:-1], widths, strict=False)), row[-1])) for row in rows)
    return "\n".join([title, *(line.rstrip() for line in lines)])


def html_table(caption: str, rows: Iterable[Sequence[object]], heading: Sequence[str] = ()) -> str:
    """Return a table for notebooks; the first cell of each row is its name, but for a row of one cell. All texts are escaped."""
    from html import escape

    def line(cells: Sequence[object], tags: Iterable[str]) -> str:
        aligned = (f"<{tag} style='text-align:left'>{escape(str(cell))}</{tag}>" for tag, cell in zip(tags, cells, strict=False))
        return f"<tr>{''.join(aligned)}</tr>"

    top = f"<thead>{line(heading, repeat('th'))}</thead>" if heading else ""
    body = "".join(line(cells, chain(["th"] if len(cells) > 1 else [], repeat("td"))) for cells in rows)
    return f"<table><caption>{escape(caption)}</caption>{top}<tbody>{body}</tbody></table>"


class ShownAsTable:
    """Base of results that are shown as rows below a title, as text and in notebooks."""

    @property
    def _caption(self) -> str:
        return f"stickslip {type(self).__name__}"

    def _lines(self) -> Sequence[Sequence[str]]:
        """Return the rows, the first text of each its name."""
        raise NotImplementedError

    def __repr__(self) -> str:
        return text_table(self._caption, self._lines())

    def _repr_html_(self) -> str:
        return html_table(self._caption, self._lines())


def clean(text: str) -> str:
    """Return a text of a scenario with spaces in place of control characters, which could change the terminal."""
    return "".join(letter if letter.isprintable() else " " for letter in text)


def sentence(text: str) -> str:
    """Return a text as a sentence; a name at its begin, as friction.a, keeps its small letter, so that it can be pasted back."""
    first = text if "." in text.split(maxsplit=1)[0].rstrip(".") else text[:1].upper() + text[1:]
    return first if first[-1] in ".?!" else f"{first}."


class Declared(CheckedArguments):
    """Base of the classes whose fields are declared: these describe themselves in the docstring, and when an object is shown."""

    source: ClassVar[str] = ""
    """Paper and equation that the class is taken from."""

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
    if isinstance(declared, Quantity | NumberSeries):
        parts = [(declared.item if isinstance(declared, NumberSeries) else declared).described]
    if isinstance(declared, NumberSeries):
        parts += [f"{declared.least} or more numbers"] + ["ascending"] * declared.ascending
    if isinstance(declared, Choice):
        parts.append(" or ".join(f'"{word}"' for word in declared.allowed))
    text = ", ".join(parts)
    return f"{text[:1].upper()}{text[1:]}."


MOST_SHOWN = 6
"""Show all entries of a series that has at most this many."""


def brief_repr(owner: Any, units: Mapping[str, str] = MappingProxyType({})) -> str:
    """Return a dataclass as the call that makes it, to 6 digits: "ElasticSlab(density='2800 kg/m^3', thickness='10 km', ...)".

    Fields with their default value are left out. The unit of a field is that of its declaration, or of its name in the class
    attribute `units`, where "slip_rate" and such words stand for the units of a body whose loads have the unit `load_unit` of the
    owner; `units` here replaces declared units such as "Pa or N".
    """
    return f"{type(owner).__name__}({', '.join(f'{name}={text}' for name, text in shown_fields(owner, units))})"


def shown_fields(owner: Any, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[tuple[str, str]]:
    """Yield name and text of each field of a dataclass that differs from its default."""
    plain, loads = getattr(type(owner), "units", {}), getattr(owner, "load_unit", "Pa")
    for field in dataclasses.fields(owner):
        value, declared = getattr(owner, field.name), field.metadata.get("declared")
        if not field.repr or (field.default is not dataclasses.MISSING and _same(value, field.default)):
            continue
        if declared is None and field.name in plain:
            declared = Quantity(" ".join(si_unit(word, loads) for word in plain[field.name].split()), "")
        if isinstance(declared, LawField) and units:
            yield field.name, brief_repr(value, units)
        else:
            yield field.name, _text(value, in_units(declared, units) if declared else None)


def fields_in(owner: Any, place: str, units: Mapping[str, str] = MappingProxyType({})) -> Iterator[tuple[str, str, str]]:
    """Yield name, value and meaning of each declared field of a body, a law or a history; names begin with `place`.

    `units` are as for `in_units`.
    """
    for name, (declared, _) in fields_of(type(owner)).items():
        value = getattr(owner, name)
        if isinstance(declared, LawField):
            yield from ((f"{place}{name}", type(value).__name__, declared.meaning), *fields_in(value, f"{place}{name}.", units))
        elif value is not None:
            yield f"{place}{name}", _text(value, in_units(declared, units)).strip("'"), declared.meaning


def _same(value: Any, default: Any) -> bool:
    return value is default or (isinstance(value, Real | str | tuple) and bool(value == default))


def _text(value: Any, declared: Any) -> str:
    """Return a value of a field as text; quantities that have a unit are quoted, as they are given."""
    if isinstance(declared, NamedNumbers):
        return f"{{{', '.join(f'{one.name!r}: {_number(one.value, one.unit)}' for one in value)}}}"
    item = declared.item if isinstance(declared, NumberSeries) else declared
    unit = item.unit if isinstance(item, Quantity) and " or " not in item.unit else ""
    if isinstance(value, np.ndarray) and value.ndim:
        return f"<array of shape {value.shape}>"
    if isinstance(value, Given):
        return f"'{value.amount:.{BRIEF_DIGITS}g} {value.unit}'"
    if isinstance(value, Real) and not isinstance(value, bool | np.bool_ | int):
        return _number(float(value), unit)
    if isinstance(value, tuple) and type(value) is tuple:
        return _several(value, declared)
    return repr(value)


def _several(values: tuple[Any, ...], declared: Any) -> str:
    texts = [_text(one, declared) for one in (values if len(values) <= MOST_SHOWN else (values[0], values[-1]))]
    if len(values) > MOST_SHOWN:
        return f"<{len(values)} values, {texts[0]} to {texts[1]}>"
    return f"[{', '.join(texts)}]" if isinstance(declared, NumberSeries) else f"({', '.join(texts)}{',' * (len(texts) == 1)})"


def _number(value: float, unit: str) -> str:
    return brief(value, "") if unit in ("", "1") or not math.isfinite(value) else f"'{brief(value, unit)}'"
