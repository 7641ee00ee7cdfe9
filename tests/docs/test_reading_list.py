"""The lines that docs/architecture.md says to read first are as many as it says, and the page is short enough to be read."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

from tests.docs.pages import ROOT

PACKAGE = ROOT / "src" / "stickslip"
PAGE = ROOT / "docs" / "architecture.md"
CODE = re.compile(r"`([\w/]+(?:\.py)?)`")
MOST_LINES = 300
"""Of the page."""
OFF = 0.05
"""Share by which a number of lines may be off before the page says a better one."""


def files_below(place: str) -> set[Path]:
    """Return a file, or all files of a folder."""
    path = PACKAGE / place
    return {path} if path.is_file() else set(path.rglob("*.py"))


def with_imports(first: Path, folder: Path) -> set[Path]:
    """Return a file and all files of a folder that it imports when it is loaded, and so on."""
    found, todo = set(), [first]
    while todo:
        file = todo.pop()
        if file in found:
            continue
        found.add(file)
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("stickslip."):
                module = PACKAGE.parent.joinpath(*node.module.split("."))  # type: ignore[union-attr]
                named = [module.with_suffix(".py"), *((module / alias.name).with_suffix(".py") for alias in node.names)]
                todo += [one for one in named if one.is_file() and folder in one.parents]
    return found


def rows_of(text: str) -> list[tuple[str, int]]:
    """Return the rows of the list: what to read, and how many lines it is said to have."""
    part = text.partition("## Read this first")[2].partition("\n## ")[0]
    return [(row[1], int(row[2].replace(" ", ""))) for row in re.finditer(r"^\| (.+?) \| ([\d ]+) \|", part, re.MULTILINE)]


def lines_of(what: str) -> int:
    """Return the number of lines of what a row names."""
    places = CODE.findall(what)
    if "imports" in what:
        files = with_imports(PACKAGE / places[0], PACKAGE / places[1])
    else:
        whole, _, without = what.partition(" without ")
        files = set().union(*map(files_below, CODE.findall(whole))) - set().union(*map(files_below, CODE.findall(without)))
    return sum(file.read_text(encoding="utf-8").count("\n") for file in files)


ROWS = rows_of(PAGE.read_text(encoding="utf-8"))


@pytest.mark.parametrize(("what", "said"), ROWS, ids=[str(n) for n in range(len(ROWS))])
def test_what_to_read_first_has_as_many_lines_as_the_page_says(what: str, said: int) -> None:
    assert said == pytest.approx(lines_of(what), rel=OFF), f"{what}: {lines_of(what)} lines"


def test_the_list_is_read_from_the_page_and_a_wrong_number_is_seen() -> None:
    assert len(ROWS) == 4
    assert lines_of("`friction` without `friction/custom`") < lines_of("`friction`")
    assert lines_of("`engine/loop.py` and what it imports in `engine`") > 2 * lines_of("`engine/loop.py`")


def test_the_page_can_be_read_in_one_sitting() -> None:
    assert PAGE.read_text(encoding="utf-8").count("\n") <= MOST_LINES
