"""The core stands alone: its rooms import downwards, extensions stand beside it, and what is left to mend only becomes less."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from pathlib import Path

from benchmarks.house import CORE, EXTENSIONS
from benchmarks.rooms import BOUNDS, Bounds

import stickslip
from stickslip.engine.history.status import RUN_CODE
from tests.source import HOUSE

PACKAGE = Path(stickslip.__file__).parent
FACES = {"__init__.py", "__main__.py", "extension.py", "loading", "studies"}
"""What stands in no room: the public names, the start of the command line, and what the core knows of extensions."""
HEAVY = {
    "jinja2": {"figures"},
    "matplotlib": {"figures"},
    "numba": {"foundation"},
    "scipy": {"run"},
    "typer": {"cli"},
    "xarray": {"figures"},
    "zarr": {"foundation", "solution"},
}
"""The rooms of the core that import a heavy library as soon as one of their files is imported."""
COMPILER, COMPILER_MODULE = "foundation/kernels/compiler/", "stickslip.foundation.kernels.compiler"
"""What makes machine code when the package is built."""
OTHERS = ("dask", "distributed", "jax", "panel", "bokeh", "pandas", "pint", "h5py", "sympy")
"""Libraries that no room of the core imports before they are used."""


def test_what_may_only_become_less_has_not_become_more() -> None:
    """The size of the core, names that cross rooms, imports that run up, or between core and extensions, circles."""
    assert Bounds.read(BOUNDS.read_text(encoding="utf-8")).broken(HOUSE) == []


def test_every_folder_is_a_room_an_extension_or_a_face() -> None:
    there = {path.name for path in PACKAGE.iterdir() if path.suffix == ".py" or (path / "__init__.py").is_file()}
    assert there == {*CORE, EXTENSIONS, *FACES}
    assert {path.name for path in (PACKAGE / EXTENSIONS).iterdir() if path.suffix == ".py"} == {"__init__.py"}


def test_the_core_names_no_extension_in_a_text() -> None:
    assert HOUSE.named_extensions() == []


def test_the_core_takes_nothing_but_the_version_from_the_public_names() -> None:
    """By them it would reach extensions and higher rooms without an import of theirs."""
    taken = {(file, name) for file, name in HOUSE.taken_from_the_top() if HOUSE.room_of(file) != "cli"}
    assert {name for _, name in taken} <= {"__version__"}, taken


def test_no_two_classes_have_one_name() -> None:
    """A name that grep finds once: annotations of one class do not read as those of another."""
    places = [(node.name, file) for file, nodes in HOUSE.nodes.items() for node in nodes if isinstance(node, ast.ClassDef)]
    count = Counter(name for name, _ in places)
    assert [place for place in places if count[place[0]] > 1] == []


def eager(file: str) -> set[str]:
    """Return the packages that a file imports as soon as it is imported."""
    return {module.split(".")[0] for when, module, _ in HOUSE.imported[file] if when == "eager"}


def test_heavy_libraries_are_known_to_few_rooms_of_the_core() -> None:
    found: dict[str, set[str]] = {}
    for file in HOUSE.trees:
        for library in eager(file) & {*HEAVY, *OTHERS}:
            found.setdefault(library, set()).add(HOUSE.room_of(file))
    assert {library: rooms & set(CORE) for library, rooms in found.items() if rooms & set(CORE)} == HEAVY


def test_only_the_compiler_imports_numba_and_only_kernels_and_formulas_llvmlite() -> None:
    """Machine code comes with the package: what is imported when the engine runs does without the compiler, at any time."""
    homes = {"numba": (COMPILER,), "llvmlite": ("foundation/kernels/", "engine/formula_code/")}
    for file, imported in HOUSE.imported.items():
        for _, module, _ in imported:
            assert file.startswith(homes.get(module.split(".")[0], ("",))), f"{file} imports {module}"
    into = {(file, when) for file, all_of in HOUSE.imported.items() for when, module, _ in all_of if COMPILER_MODULE in module}
    assert {one for one in into if not one[0].startswith(COMPILER)} <= {("foundation/kernels/code.py", "later")}


def test_what_every_start_loads_of_an_extension_is_light() -> None:
    """The core asks all extensions for their names: their fronts import nothing but what an extension is."""
    for name in HOUSE.extensions:
        front = f"{EXTENSIONS}/{name}/__init__.py"
        assert {one.module for one in HOUSE.all_imports if one.file == front and one.when == "eager"} == {"stickslip.extension"}
        assert eager(front) <= {"stickslip", *sys.stdlib_module_names}, front


def test_the_key_of_the_compile_cache_covers_all_that_is_compiled() -> None:
    """Each file with compiled functions, and each file from which such functions take a name."""
    from stickslip.foundation.kernels.code import NOT_COMPILED, compiled_sources

    covered = {*compiled_sources(), *PACKAGE.glob("extensions/*/compiled/*.py")}
    assert all(path.is_file() for path in covered)
    for file, nodes in HOUSE.nodes.items():
        path = PACKAGE / file
        origin = {
            alias.asname or alias.name: (node.module, alias.name)
            for node in nodes
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("stickslip")
            for alias in node.names
        }
        kernels = [
            node for node in nodes if isinstance(node, ast.FunctionDef) and any(_is_compiler(one) for one in node.decorator_list)
        ]
        if kernels and path.name not in NOT_COMPILED:
            assert path in covered, f"{path} is compiled"
        for kernel in kernels:
            body = [one for statement in kernel.body for one in ast.walk(statement)]
            for name in {one.id for one in body if isinstance(one, ast.Name)} & set(origin):
                module, wanted = origin[name]
                file = _file(f"{module}.{wanted}") or _file(_home(module, wanted))
                assert file in covered, f"{path}: {kernel.name} uses {name}"


def _is_compiler(decorator: ast.expr) -> bool:
    node = decorator.func if isinstance(decorator, ast.Call) else decorator
    word = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
    return word in ("kernel", "inlined", "entry", "exact", "exact_entry")


def _home(module: str, name: str) -> str:
    """Return the module of a name that a package imports when it is first used, as its stub says; otherwise the module itself."""
    stub = PACKAGE.joinpath(*module.split(".")[1:], "__init__.pyi")
    tree = ast.parse(stub.read_text(encoding="utf-8") if stub.is_file() else "")
    homes = {
        alias.asname or alias.name: node.module for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    return homes.get(name) or module


def _file(module: str) -> Path | None:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    return next((one for one in (path.with_suffix(".py"), path / "__init__.py") if one.is_file()), None)


def test_every_room_that_decides_a_run_is_in_the_key_of_a_checkpoint() -> None:
    """What stands below friction serves all, and figures and the command line decide nothing."""
    assert set(RUN_CODE) == set(CORE) - {"foundation", "figures", "cli"}


def test_importing_the_package_is_light() -> None:
    """Tables, units, files, figures and the compiler are imported when they are used."""
    heavy = "{'numba', 'pandas', 'xarray', 'pint', 'matplotlib', 'jinja2', 'typer', 'scipy', 'zarr'}"
    code = f"import sys, stickslip; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
