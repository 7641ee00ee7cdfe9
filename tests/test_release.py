"""What a release says about itself agrees: version, changelog, citation, supported versions of Python."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

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
