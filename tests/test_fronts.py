"""Front pages of rooms: each name is what its module has, and other rooms take from a front what stands there."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest

import stickslip
from tests.source import HOUSE

PACKAGE = Path(stickslip.__file__).parent
USERS = {"", "studies", "figures", "friction", "loading"}
"""Folders whose stubs are pages for users: tests/test_public_names.py looks at them."""
STUBS = {stub.parent.relative_to(PACKAGE).as_posix().removeprefix("."): stub for stub in sorted(PACKAGE.rglob("__init__.pyi"))}
FRONTS = {folder: stub for folder, stub in STUBS.items() if folder not in USERS}


def homes(stub: Path) -> dict[str, str]:
    """Return the names of a front page, each with the module that has it."""
    nodes = [node for node in ast.parse(stub.read_text(encoding="utf-8")).body if isinstance(node, ast.ImportFrom)]
    return {alias.asname or alias.name: f"{node.module}" for node in nodes for alias in node.names}


@pytest.mark.parametrize("folder", FRONTS)
def test_each_name_of_a_front_is_what_its_module_has(folder: str) -> None:
    package = importlib.import_module(f"stickslip.{folder.replace('/', '.')}")
    for name, home in homes(FRONTS[folder]).items():
        if home != package.__name__:  # else a module of the room itself
            assert getattr(package, name) is getattr(importlib.import_module(home), name)
    assert sorted(homes(FRONTS[folder])) == package.__all__


@pytest.mark.parametrize("folder", FRONTS)
def test_no_name_of_a_front_is_also_a_module_of_the_room(folder: str) -> None:
    """`from stickslip.run import simulate` would give the function or the module, whichever comes first."""
    modules = {path.stem for path in (PACKAGE / folder).glob("*.py")} | {path.name for path in (PACKAGE / folder).glob("*/")}
    own = {name for name, home in homes(FRONTS[folder]).items() if home == f"stickslip.{folder.replace('/', '.')}"}
    assert sorted((homes(FRONTS[folder]).keys() - own) & modules) == []


def test_a_front_loads_what_is_asked_for_and_nothing_else() -> None:
    code = "import sys; from stickslip.solution import Window; print(*(m for m in sys.modules if m.startswith('stickslip.')))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "stickslip.solution.window" in loaded
    assert "stickslip.solution.solution" not in loaded


def test_other_rooms_take_from_the_front_what_stands_there() -> None:
    known = {(home, name): folder for folder, stub in FRONTS.items() for name, home in homes(stub).items()}
    around = []
    for file, nodes in HOUSE.nodes.items():
        room = file.partition("/")[0]
        for node in nodes:
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("stickslip."):
                for alias in node.names:
                    front = known.get((str(node.module), alias.name))
                    if front and front.split("/")[0] != room and node.module != f"stickslip.{front.replace('/', '.')}":
                        around.append(f"{file}: {alias.name} is taken from {node.module}, not from {front}")
    assert around == []
