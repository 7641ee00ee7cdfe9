"""Tests of the core use no extension, so that they pass without any."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import stickslip
from stickslip.extension import commands, public_names

CORE = Path(__file__).with_name("core")
FACES = ("stickslip", "stickslip.figures", "stickslip.friction", "stickslip.studies")
"""Packages to which extensions add public names."""


@cache
def added() -> re.Pattern[str]:
    """Return a pattern of what only extensions have: their modules and tests, and their public names as users write them."""
    names = [f"{face}.{name}".partition(".")[2] for face in FACES for name in public_names(face)]
    return re.compile(rf"\b(?:stickslip|tests)\.extensions\b|\b(?:ss|stickslip)\.(?:{'|'.join(map(re.escape, names))})\b")


@cache
def asked_for() -> frozenset[str]:
    """Return the commands of extensions and the scenarios that come with them, as they stand in quotes."""
    typed = {command.__name__.replace("_", "-") for group in commands().values() for command in group}
    folder = Path(stickslip.__file__).with_name("extensions")
    return frozenset(typed) | {file.stem for file in folder.glob("*/bundled/*.toml")}


def uses(code: str) -> Iterator[str]:
    """Yield what a module uses of extensions, also in scripts that it writes down as text."""
    yield from (found[0] for found in added().finditer(code))
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and node.module in FACES:
            yield from (one.name for one in node.names if one.name in public_names(node.module))
        first = _first(node)
        if isinstance(first, ast.Constant) and first.value in asked_for():
            yield str(first.value)


def _first(node: ast.AST) -> ast.expr | None:
    """Return the first word of a command or the name of a scenario: what a call or a list of words begins with."""
    if isinstance(node, ast.Call) and node.args:
        return node.args[0]
    if (
        isinstance(node, ast.List | ast.Tuple)
        and len(node.elts) > 1
        and all(isinstance(one, ast.Constant) for one in node.elts[:2])
    ):
        return node.elts[0]
    return None


@pytest.mark.parametrize("path", [CORE, *CORE.parent.glob("[!t]*.py")], ids=lambda path: path.stem)
def test_no_test_of_the_core_uses_an_extension(path: Path) -> None:
    files = path.rglob("*.py") if path.is_dir() else [path]
    found = {str(file.relative_to(CORE.parent)): list(uses(file.read_text(encoding="utf-8"))) for file in files}
    assert {file: names for file, names in found.items() if names} == {}


@pytest.mark.parametrize(
    "line",
    [
        "from stickslip.extensions.planar.slab import PlanarSlab",
        "import stickslip.extensions.sweeps as sweeps",
        "from tests.extensions.sweeps.batch.cases import CASES",
        'SCRIPT = """\nfrom stickslip.extensions.explorer.notebook import explore\n"""',
        "found = ss.sweep('fig6-slab', {})",
        "found = ss.studies.compare(run, run)",
        "law = stickslip.friction.fit(points)",
        "from stickslip.figures import plot_fit",
        "shown = command('sweep', 'fig6-slab')",
        'CASES = [(["fit", "a.csv"], "message")]',
        'scenario = load_scenario("planar-patch")',
    ],
)
def test_every_way_to_use_an_extension_is_recognised(line: str) -> None:
    assert list(uses(line))


@pytest.mark.parametrize(
    "line",
    [
        "run = ss.simulate('fig6-slab')",
        "found = ss.studies.find(problem)",
        "shown = command('run', 'fig6-slab')",
        'RUN = ["run", "a.nc"]',
    ],
)
def test_what_the_core_has_is_no_extension(line: str) -> None:
    assert not list(uses(line))
