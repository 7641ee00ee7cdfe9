"""Names of code that pages and docstrings give are names that the code has: what a renaming leaves behind is found here."""

from __future__ import annotations

import builtins
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, ROOT

SRC = ROOT / "src" / "stickslip"
OF_CODE = [
    ROOT / "docs" / f"{name}.md"
    for name in ("architecture", "inside-the-engine", "glossary", "guarantees", "numerics", "adding-a-law")
]
"""The pages that are about the code."""
NAME = re.compile(r"[A-Za-z_][A-Za-z_0-9]*")
CODE = re.compile(r"`([^`\n]+)`")
PLACED = re.compile(r"((?:`\w+`(?:, | and )?)+) \(`([\w/]+\.py)`\)")
"""One name or several, and in brackets the file in which they are."""
SHORTEST = 4
"""Shorter words may be symbols of the paper."""
MAY_COME = {"contact_damping"}
"""What a worked list would add."""


TEXT = re.compile(r'(^[ \t]*r?)?"""(.*?)"""', re.MULTILINE | re.DOTALL)
"""A long text; one that begins its line is a docstring. A tree of syntax would take twenty times as long to say so."""


def parsed(file: Path) -> tuple[set[str], list[str]]:
    """Return the words of the code of a file, and its docstrings, those below constants and fields included."""
    text = file.read_text(encoding="utf-8")
    without = TEXT.sub(lambda found: found[0] if found[1] is None else "", text)
    code = (line.partition("  # ")[0] for line in without.splitlines())  # a comment does not vouch for a name either
    docstrings = [found[2] for found in TEXT.finditer(text) if found[1] is not None]
    return set(NAME.findall("\n".join(code))) | set(file.parts) | {file.stem}, docstrings


@cache
def words() -> frozenset[str]:
    """Return every word of the code and of files of settings; a docstring does not vouch for itself."""
    found = set(dir(builtins))
    for folder in ("src", "tests", "benchmarks", "docs", "examples"):
        for file in (ROOT / folder).rglob("*.py*"):
            found |= parsed(file)[0] if file.suffix in (".py", ".pyi") else set()
        for file in (ROOT / folder).rglob("*"):
            if file.suffix in (".toml", ".js", ".c", ".h", ".html", ".j2"):
                found |= set(NAME.findall(file.read_text(encoding="utf-8")))
    return frozenset(found | set(NAME.findall((ROOT / "pyproject.toml").read_text(encoding="utf-8"))))


def unknown(text: str) -> list[str]:
    """Return the names in a text that the code does not have; calls and beginnings of names, as `peak_`, are not looked at."""
    names = [code for code in CODE.findall(text) if re.fullmatch(r"[A-Za-z_][\w.]*[A-Za-z0-9]", code)]
    parts = [part for name in names for part in name.split(".")]
    return [part for part in parts if len(part) >= SHORTEST and part not in words() and part not in MAY_COME]


@pytest.mark.parametrize("page", OF_CODE, ids=lambda page: page.stem)
def test_pages_name_what_the_code_has(page: Path) -> None:
    assert unknown(page.read_text(encoding="utf-8")) == []


def test_docstrings_name_what_the_code_has() -> None:
    found = {str(file.relative_to(SRC)): unknown("\n".join(parsed(file)[1])) for file in sorted(SRC.rglob("*.py"))}
    assert {file: names for file, names in found.items() if names} == {}


def test_a_name_that_is_gone_is_found() -> None:
    gone = "a_name_" + "that_was"
    assert unknown(f"`Problem.strength` and `{gone}`, `f(x)`, `mu`") == [gone]


def places(page: Path) -> Iterator[tuple[list[str], str]]:
    """Yield the names that a page says to be in a file, and the file; no names where it gives the file alone."""
    text = page.read_text(encoding="utf-8")
    yield from ((CODE.findall(names), file) for names, file in PLACED.findall(text))
    yield from (([], file) for file in re.findall(r"`([\w/]+/[\w/]+\.py)`", text))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).with_suffix("").as_posix())
def test_files_are_there_and_hold_what_the_page_says(page: Path) -> None:
    for names, file in places(page):
        found = [path for base in (SRC, ROOT, ROOT / "docs") for path in [base / file] if path.is_file()]
        found = found or ([*SRC.rglob(file)] if "/" not in file else [])  # the folder is named before
        assert found, f"{page.name}: there is no {file}"
        held = set().union(*(NAME.findall(path.read_text(encoding="utf-8")) for path in found))
        assert set(names) <= held, f"{page.name}: {file} has no {', '.join(sorted(set(names) - held))}"
