"""Tests share helper modules, never each other; a release has one version; workflows and hooks run what the Makefile runs."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
import yaml

import stickslip

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def first(pattern: str, name: str) -> str:
    """Return what a pattern finds first in a file at the root."""
    found = re.search(pattern, (ROOT / name).read_text(encoding="utf-8"), re.MULTILINE)
    assert found, name
    return found[1]


def named_pythons() -> list[str]:
    """Return the versions of Python that the classifiers of the package name."""
    return re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["classifiers"]))


def test_changelog_and_citation_are_of_this_version() -> None:
    assert first(r"^## \[([^\]]+)\]", "CHANGELOG.md") == stickslip.__version__
    assert first(r"^version: (\S+)$", "CITATION.cff") == stickslip.__version__


def test_the_oldest_python_that_is_named_is_the_oldest_that_is_accepted() -> None:
    named = named_pythons()
    assert PROJECT["requires-python"] == f">={named[0]}"
    assert re.findall(r"3\.\d+", first(r"^- (Python 3.*)$", "CHANGELOG.md")) == named


def test_the_extra_of_notebooks_has_all_of_the_explorer() -> None:
    extras = PROJECT["optional-dependencies"]
    assert set(extras["explorer"]) <= set(extras["notebook"])


WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.yml"))


@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_each_step_of_a_workflow_is_a_make_target(path: Path) -> None:
    targets = set(re.findall(r"^([a-z -]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    known = {name for group in targets for name in group.split()}
    for job in yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"].values():
        matrix = job.get("strategy", {}).get("matrix", {})
        runs = [step["run"] for step in job["steps"] if "run" in step]
        asked = [run.replace("${{ matrix.target }}", target) for run in runs for target in matrix.get("target", [""])]
        assert asked
        assert {f"make {name}" for name in known} >= set(asked)
        assert matrix.get("python", named_pythons()) == named_pythons()


def test_hooks_run_the_tools_that_lint_runs() -> None:
    hooks = yaml.safe_load((ROOT / ".pre-commit-config.yaml").read_text(encoding="utf-8"))["repos"]
    assert [repository["repo"] for repository in hooks] == ["local"]
    entries = {hook["entry"].removesuffix(" --fix") for hook in hooks[0]["hooks"]}
    lint = first(r"^lint:[^\n]*\n((?:\t[^\n]*\n)+)", "Makefile").replace("$(BIN)", ".venv/bin").replace(" --check", "")
    assert {line.strip().removesuffix(" .") for line in lint.splitlines()} == entries


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
        "from tests.core.engine.test_creep import SLAB",
        "from tests.core.engine import test_creep",
        "from .test_branches import (",
        "    import tests.extensions.sweeps.test_store as test",
    ],
)
def test_every_way_to_import_a_test_module_is_recognised(line: str) -> None:
    assert IMPORT_OF_A_TEST_MODULE.search(f"import math\n{line}\n")
