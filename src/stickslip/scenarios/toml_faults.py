"""Explain in one line why a text is not TOML: the line, what it says, and how to write it."""

from __future__ import annotations

import re

from stickslip.foundation.conversion import decimal_point
from stickslip.scenarios.values import show

LONGEST = 200
"""Longest line (characters) for which a cure is looked for: scenarios are untrusted, and patterns take time."""
_PLACE = re.compile(r"\(at line (\d+), column (\d+)\)")
_ENTRY = re.compile(r"""\s*(?P<key>[\w."'-]+)\s*(?P<sign>[=:])\s*(?P<value>.*)""")
_HEADING = re.compile(r"\s*\[+\s*(?P<name>[\w.\- ]+?)\s*\]*\s*")
_TWICE = re.compile(r"Cannot (overwrite|declare|mutate)")
_NUMBER = r"[+-]?[\d_]*\.?\d[\d_]*\.?(?:[eE][+-]?\d+)?"


def why_not_toml(text: str, fault: str) -> str:
    """Return why a text is not TOML, from the message of the parser: where, what is there, and the cure if it is known."""
    place, fault = _PLACE.search(fault), " ".join(fault.split())
    if place is None:
        ends = "end of document" in fault
        return f"not TOML: {fault}{'; a quotation mark or a bracket is not closed' if ends else ''}"
    line = _line(text, int(place[1]))
    cure = _cure(line, fault) if len(line) <= LONGEST and line.isprintable() else None
    return f"line {place[1]}: {show(line.strip())} is not TOML: {cure}" if cure else f"not TOML: {fault}: {show(line.strip())}"


def _line(text: str, number: int) -> str:
    lines = text.split("\n")
    return lines[number - 1].rstrip("\r").replace("\t", " ") if number <= len(lines) else ""


def _cure(line: str, fault: str) -> str | None:
    """Return how to write a line, or None if that is not known."""
    entry, heading = _ENTRY.fullmatch(line), _HEADING.fullmatch(line)
    if _TWICE.search(fault):
        return f"{show(entry['key'])} is given twice" if entry else "this table is given twice"
    if line.lstrip().startswith("["):
        whole = heading is not None and line.strip() == f"[{heading['name']}]"
        if whole:
            return "a bracket or a quotation mark before it is not closed"
        return f"write [{heading['name']}]" if heading else None
    if entry is None:
        return "write KEY = VALUE, or # before a comment" if "=" not in line else None
    value = re.split(r"\s+#", entry["value"])[0].strip()
    if entry["sign"] == ":":
        is_whole = re.fullmatch(rf"{_NUMBER}|\"[^\"]*\"", value)
        return f"write {entry['key']} = {value}" if is_whole else "write KEY = VALUE, or # before a comment"
    if not value:
        return f"{entry['key']} has no value"
    written = _written(value)
    return f"write {entry['key']} = {written}" if written else None


def _written(value: str) -> str | None:
    """Return a value as TOML has it, with the reason, or None if it is not known what was meant."""
    if any(mark in value for mark in "\u201c\u201d\u201e\u2018\u2019"):
        straight = re.sub("[\u201c\u201d\u201e\u2018\u2019]", '"', value)
        return f"{straight}, with straight quotes"
    point = decimal_point(value)
    plain = value.strip("=;, ")
    if plain != value and re.fullmatch(_NUMBER, plain):
        return f"{plain}, and no other sign"
    if re.fullmatch(rf"{_NUMBER}(?:\s*(?:[*^/+-]|\*\*)\s*{_NUMBER})+", value):
        return "the number itself, as 1e3: nothing is calculated"
    if point:
        quoted = f'"{point}"' if re.search(r"[A-Za-z/%]", re.sub(r"[eE][+-]?\d", "", point)) else point
        return f"{quoted}, with a decimal point"
    if value.count('"') % 2:
        whole = value.replace('"', "").strip()
        return f'"{whole}", with both quotes'
    return _by_form(value)


def _by_form(value: str) -> str | None:
    if re.fullmatch(r"[+-]?\.\d[\d_]*(?:[eE][+-]?\d+)?", value):
        return f"{value.replace('.', '0.', 1)}, with a digit before the point"
    if re.fullmatch(r"[+-]?\d[\d_]*\.(?:[eE][+-]?\d+)?", value):
        return f"{value.replace('.', '.0', 1)}, with a digit after the point"
    if re.fullmatch(r"(?i:true|false|nan|[+-]?inf)", value):
        return f"{value.lower()}, in small letters"
    grouped = re.sub(r"(?<=\d)[ '\u00a0\u202f](?=\d{3})", "", value)
    if grouped != value and re.fullmatch(_NUMBER, grouped):
        return f"{grouped}, without gaps"
    if re.fullmatch(r"[+-]?0[\d_]+(?:\.\d+)?", value):
        shorter = re.sub(r"^([+-]?)0+(?=[0-9])", r"\1", value)
        return f"{shorter}, without the first 0"
    if re.fullmatch(rf"{_NUMBER}\s*[A-Za-z/%\u00b5\u03bc][^\"']*", value) or re.fullmatch(r"[A-Za-z][\w ./^-]*", value):
        return f'"{value}", in quotes'
    return None
