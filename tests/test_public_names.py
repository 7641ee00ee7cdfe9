"""The public interface is one page: stub, lazy table and `__all__` agree, and mypy sees each name through the stub."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from importlib.util import resolve_name
from pathlib import Path

import pytest

import stickslip as ss
from stickslip.foundation.lazy_names import lazy_names
from tests.limits import mypy_on

LAZY = ("stickslip", "stickslip.studies", "stickslip.figures", "stickslip.friction", "stickslip.problem.bodies")
"""Packages whose names are those of their stub."""


def stub_of(package: str) -> ast.Module:
    """Return the parsed stub of a package."""
    file = importlib.import_module(package).__file__
    assert file is not None
    return ast.parse(Path(file).with_suffix(".pyi").read_text(encoding="utf-8"))


def test_there_are_at_most_thirty_two_public_names() -> None:
    assert len(ss.__all__) <= 32


@pytest.mark.parametrize("package", LAZY)
def test_stub_and_lazy_table_agree(package: str) -> None:
    stub, module = stub_of(package), importlib.import_module(package)
    listed = next(node.value for node in stub.body if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__")
    imported = [alias.asname or alias.name for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names]
    assert sorted(ast.literal_eval(listed)) == sorted(imported) == module.__all__ == dir(module)


@pytest.mark.parametrize("package", LAZY)
def test_each_name_is_what_the_stub_says(package: str) -> None:
    for node in stub_of(package).body:
        if isinstance(node, ast.ImportFrom):
            home = importlib.import_module(resolve_name("." * node.level + (node.module or ""), package))
            for alias in node.names:
                assert getattr(importlib.import_module(package), alias.name) is getattr(home, alias.name)


def test_what_a_stub_imports_for_a_type_is_no_name_of_the_package(tmp_path: Path) -> None:
    (tmp_path / "__init__.pyi").write_text(
        "from stickslip.foundation.errors import InputError, nearest\n"
        "TABLE: dict[str, InputError]\n__all__ = ['TABLE', 'nearest']\n"
    )
    assert lazy_names("made.up", str(tmp_path / "__init__.py"))[1]() == ["TABLE", "nearest"]


def test_functions_are_not_hidden_by_their_modules() -> None:
    """`studies.compare` stays the function after its module of the same name has been imported."""
    code = "import stickslip.extensions.studies.compare, stickslip as ss; print(callable(ss.studies.compare))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "True\n"


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="stickslip"):
        ss.simulat  # type: ignore[attr-defined] # noqa: B018


def test_mypy_knows_the_names_through_the_stub(tmp_path: Path) -> None:
    code = "import stickslip as ss\nreveal_type(ss.load_scenario)\nreveal_type(ss.studies.compare)\nss.simulat\n"
    scenario, comparison, unknown, *_ = mypy_on(tmp_path / "user_of_names.py", code).splitlines()
    assert scenario.endswith('-> stickslip.problem.scenarios.scenario.Scenario"')
    assert comparison.endswith('-> stickslip.extensions.studies.compare.Comparison"')
    assert 'Module has no attribute "simulat"' in unknown
