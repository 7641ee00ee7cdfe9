"""Imports point down: each folder knows only what lies below it, and only figures, paper and storage know their libraries."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import stickslip

PACKAGE = Path(stickslip.__file__).parent

LAYERS = (
    ("errors",),
    ("files",),
    ("netcdf",),
    ("quantities", "selection", "units"),
    ("friction",),
    ("bodies", "loading"),
    ("problem",),
    ("parameters",),
    ("contact", "reference"),
    ("evolution",),
    ("observables",),
    ("studies",),
    ("scenarios",),
    ("batch",),
    ("soundness",),
    ("storage",),
    ("long_runs",),
    ("exports", "side_by_side"),
    ("sweeps",),
    ("figures",),
    ("paper",),
    ("cli",),
)
HEIGHT = {name: height for height, names in enumerate(LAYERS) for name in names}

ALLOWED = {
    "matplotlib": {"figures", "paper"},
    "jinja2": {"paper"},
    "typer": {"cli"},
    "xarray": {"netcdf", "observables", "storage", "long_runs", "sweeps", "figures", "paper"},
}


def imports(path: Path) -> Iterator[str]:
    """Modules imported when a file is imported: not those inside functions nor for type checkers."""

    def walk(nodes: list[ast.stmt]) -> Iterator[str]:
        for node in nodes:
            if isinstance(node, ast.Import):
                yield from (alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and node.module:
                yield node.module
            elif (isinstance(node, ast.If) and "TYPE_CHECKING" not in ast.unparse(node.test)) or isinstance(
                node, ast.ClassDef | ast.Try | ast.With
            ):
                yield from walk(node.body)

    yield from walk(ast.parse(path.read_text()).body)


def layer(path: Path) -> str:
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


FILES = [path for path in sorted(PACKAGE.rglob("*.py")) if layer(path) not in ("__init__", "__main__")]


def test_every_folder_has_its_place() -> None:
    assert {layer(path) for path in FILES} <= set(HEIGHT)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(PACKAGE)))
def test_imports_point_down(path: Path) -> None:
    own = layer(path)
    for module in imports(path):
        root, _, rest = module.partition(".")
        if root == "stickslip" and rest:
            other = rest.split(".")[0]
            assert other == own or HEIGHT[other] < HEIGHT[own], f"{own} imports {module}"
        assert own in ALLOWED.get(root, {own}), f"{own} imports {root}"


def test_importing_the_package_is_light() -> None:
    """Tables, units, files, figures and the compiler are imported when they are used."""
    heavy = "{'numba', 'pandas', 'xarray', 'pint', 'matplotlib', 'jinja2', 'typer', 'scipy', 'zarr'}"
    code = f"import sys, stickslip; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
