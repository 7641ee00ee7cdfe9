"""Tests share problems, laws and truth through helper modules, never through each other."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

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
