"""Tests share problems, laws and truth through helper modules, never through each other; a release has one version."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

import stickslip

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def first(pattern: str, name: str) -> str:
    """Return what a pattern finds first in a file at the root."""
    found = re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
    assert found, name
    return found[1]


def test_changelog_and_citation_are_of_this_version() -> None:
    assert first(r"^## \[([^\]]+)\]", "CHANGELOG.md") == stickslip.__version__
    assert first(r"^version: (\S+)$", "CITATION.cff") == stickslip.__version__


def test_the_oldest_python_that_is_named_is_the_oldest_that_is_accepted() -> None:
    named = re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["classifiers"]))
    assert PROJECT["requires-python"] == f">={named[0]}"
    assert re.findall(r"3\.\d+", first(r"^- (Python 3.*)$", "CHANGELOG.md")) == named


def test_the_extra_of_notebooks_has_all_of_the_explorer() -> None:
    extras = PROJECT["optional-dependencies"]
    assert set(extras["explorer"]) <= set(extras["notebook"])


TESTS = Path(__file__).parent
IMPORT_OF_A_TEST_MODULE = re.compile(r"^[ \t]*(?:from|import)\b[^\n]*[ .,]test_\w+", re.MULTILINE)
"""Also in scripts that a test writes down as text, to be run in a process of their own."""


def test_no_module_imports_a_test_module() -> None:
    found = {path: IMPORT_OF_A_TEST_MODULE.findall(path.read_text(encoding="utf-8")) for path in TESTS.rglob("*.py")}
    found.pop(Path(__file__))  # it holds the examples below
    assert {path: lines for path, lines in found.items() if lines} == {}


@pytest.mark.parametrize(
    "line",
    [
        "from tests.engine.test_creep import SLAB",
        "from tests.engine import test_creep",
        "from .test_branches import (",
        "    import tests.sweeps.test_store as test",
    ],
)
def test_every_way_to_import_a_test_module_is_recognised(line: str) -> None:
    assert IMPORT_OF_A_TEST_MODULE.search(f"import math\n{line}\n")
