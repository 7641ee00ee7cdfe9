"""Imports point down: each folder knows only what lies below it, and only some know the heavy libraries."""

from __future__ import annotations

import ast
import subprocess
import sys
from collections import Counter
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import stickslip
from stickslip.engine.history.status import DECIDE, engine

PACKAGE = Path(stickslip.__file__).parent

LAYERS = (
    ("foundation",),
    ("friction",),
    ("bodies", "engine", "loading", "resistance"),
    ("problem",),
    ("contact", "reference"),
    ("engine_input", "planar", "schemes"),
    ("scenarios", "trajectory"),
    ("creep", "observables"),
    ("solution",),
    ("io",),
    ("run",),
    ("batch", "study"),
    ("inference", "sweeps"),
    ("studies",),
    ("figures",),
    ("reports",),
    ("explorer", "paper"),
    ("cli",),
)
"""Folders of the package from the bottom up; those of one layer do not know each other. `engine` never imports a `Problem`."""
ROOMS = {
    "foundation": (
        ("synonyms",),
        ("arrays", "constants", "errors", "place"),
        ("lazy_names", "locks"),
        ("arguments", "atomic_write", "determined", "marks", "memory", "units"),
        ("given",),
        ("names",),
        ("headings", "meant", "netcdf_file"),
        ("conversion",),
        ("named_columns", "unit_doubts"),
        ("axis", "columns", "quantities", "record_files"),
        ("other_values", "show", "text_columns"),
        ("zarr_folder",),
    ),
    "friction": (
        ("formula",),
        ("contract",),
        ("values",),
        ("law",),
        ("piecewise", "pressed"),
        ("laws", "custom"),
    ),
    "engine": (
        ("compile",),
        ("memory",),
        ("formula_code",),
        ("state",),
        ("series",),
        ("compiled_formula", "contact"),
        ("folds", "radau"),
        ("contact_step",),
        ("waves",),
        ("on_demand",),
        ("loop",),
    ),
    "problem": (
        ("ground", "normal_load", "run_quantities", "selection_rule"),
        ("fields",),
        ("parameters", "start"),
        ("problem",),
        ("given_units",),
    ),
    "engine_input": (("branch_table", "forcing", "limits"), ("ladder", "shaking"), ("prepare",)),
    "planar": (
        ("driving", "echo", "layout", "memory", "nodes"),
        ("friction", "slab"),
        ("step",),
        ("solver",),
    ),
    "scenarios": (
        ("contact", "entries", "facts", "library", "stability", "starts"),
        ("examine_layers", "schema", "text_of_files"),
        ("contact_table",),
        ("scenario",),
        ("examine", "parameter_paths", "source"),
        ("examine_contact", "templates"),
    ),
    "observables": (
        ("given_load", "given_on_discs", "layer_machine", "layer_records", "planar", "predictability", "severity", "quadrature"),
        ("layer_replay", "proof", "rule_influence"),
        ("layers", "proof_of_rest", "proof_of_slip", "proof_of_states", "waves"),
        ("inside_layers", "layers_found_again"),
        ("energy", "field", "proof_of_load"),
        ("at_driver", "event_table", "proof_of_run"),
        ("energetics", "event_stream"),
    ),
    "solution": (("evaluation",), ("accessors",), ("planar", "window"), ("solution",), ("interval",)),
    "io": (
        ("catalogue_rows", "sampling", "series", "soundness", "zarr_store"),
        ("planar_layout", "scec"),
        ("netcdf", "planar_store"),
        ("curves",),
    ),
    "run": (
        ("options", "progress"),
        ("session", "solver"),
        ("exact_run", "run_loop"),
        ("catalogue", "planar_run"),
        ("resume", "simulate"),
    ),
    "studies": (
        ("kept_runs", "longer_runs", "reach_of_runs", "separation"),
        ("analogy", "compare", "ensemble", "find", "inference", "regularisations", "verdict"),
        ("one_run", "scheme_shocks"),
        ("scheme_measures",),
        ("judgement",),
        ("schemes",),
        ("benchmarks",),
    ),
    "inference": (("record",), ("fit",), ("certainty",), ("fitted_record",), ("inference",), ("infer",)),
    "trajectory": (
        ("phase_index", "series", "status", "turning_points"),
        ("machine_motion",),
        ("history",),
        ("reach", "slip_events", "tables"),
    ),
    "contact": (
        ("roots", "secant", "sliding", "wave_modes", "wave_proof"),
        ("layer_discs",),
        ("layer_count",),
        ("rightmost",),
        ("layer_roots",),
        ("layer_search",),
        ("layer_modes",),
        ("disturbance", "slopes", "steady_proof"),
        ("areas", "crossing", "lowest_slope", "turns"),
        ("folds",),
        ("branches", "steady"),
        ("critical", "rules"),
        ("regime_map",),
        ("uniqueness",),
    ),
    "creep": (
        ("leaping_run", "pattern", "slow"),
        ("averaged", "steady"),
        ("landing", "planner", "slow_leaps", "steady_landing", "swing"),
        ("creep_writer", "slow_landing", "swing_leaps"),
        ("cycles", "swing_landing"),
        ("stepper",),
    ),
    "batch": (("kernels",), ("vectorised_problem",), ("long_member", "setups"), ("run",)),
    "sweeps": (("design",), ("execution",), ("results",), ("sweep",)),
    "figures": (("names", "style"), ("sheet",), ("panels",), ("contact", "runs", "sweeps"), ("studies",)),
    "explorer": (("model",), ("page",), ("server", "static"), ("notebook",)),
    "schemes": (
        ("contract",),
        ("explicit", "implicit", "sbp"),
        ("run",),
    ),
    "reference": (("rate_and_state",), ("block", "folds", "planar", "slab")),
    "cli": (
        ("expand", "options"),
        ("extra_words",),
        ("mistyped",),
        ("output", "overrides"),
        ("long_run", "installation"),
        ("commands",),
        ("app",),
        ("main",),
    ),
}
"""The same inside some folders."""
LAZY_DOORS = {
    "contact/sliding.py",
    "contact/uniqueness.py",
    "extensions/inference/points/fit.py",
    "extensions/inference/points/fit_search.py",
    "friction/formula/expression.py",
    "problem/scenarios/scenario.py",
    "solution/accessors.py",
    "extensions/planar/solution.py",
    "solution/solution.py",
    "extensions/inference/record/record.py",
}
"""Files that may import upwards inside functions.

A run reaches figures and files there, findings are drawn, a scenario gets other values, a record is read, a law is found by its
name, and a function of numpy becomes an operation of a formula.
"""

ALLOWED = {
    "matplotlib": {"figures", "paper"},
    "jinja2": {"reports"},
    "typer": {"cli"},
    "xarray": {"foundation", "observables", "io", "run", "sweeps", "figures", "paper"},
}


def heights(layers: tuple[tuple[str, ...], ...]) -> dict[str, int]:
    """Return the number of each name's layer."""
    return {name: height for height, names in enumerate(layers) for name in names}


HEIGHT = heights(LAYERS)
ROOM_HEIGHT = {package: heights(rooms) for package, rooms in ROOMS.items()}


@cache
def tree_of(path: Path) -> ast.Module:
    """Return the syntax tree of a file, which several tests walk."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def imports(path: Path) -> list[tuple[str, str]]:
    """Return what a file imports as dotted names, each with "eager", "later" (inside a function) or "types" (for type checkers)."""
    found: list[tuple[str, str]] = []

    def walk(node: ast.AST, kind: str) -> None:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                found.extend((kind, alias.name) for alias in child.names)
            elif isinstance(child, ast.ImportFrom) and child.module:
                found.extend((kind, f"{child.module}.{alias.name}") for alias in child.names)
            elif isinstance(child, ast.If) and "TYPE_CHECKING" in ast.unparse(child.test):
                walk(ast.Module(child.body, []), "types")
                walk(ast.Module(child.orelse, []), kind)
            elif isinstance(child, ast.stmt | ast.ExceptHandler | ast.match_case):
                inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
                walk(child, "later" if inside and kind == "eager" else kind)

    walk(tree_of(path), "eager")
    return found


def parts(path: Path) -> tuple[str, ...]:
    """Return folder, room and so on of a file."""
    return path.relative_to(PACKAGE).with_suffix("").parts


def points_up(own: tuple[str, ...], other: list[str]) -> bool:
    """Return True if a file in `own` must not import `other` (parts of a dotted name without that of the package)."""
    if other[0] not in HEIGHT or own[0] not in HEIGHT:
        return False  # a name of the package itself; every folder has its place: see below
    if other[0] != own[0]:
        return HEIGHT[other[0]] >= HEIGHT[own[0]]
    rooms = ROOM_HEIGHT.get(own[0], {})
    if len(own) < 2 or len(other) < 2 or own[1] not in rooms or other[1] not in rooms or own[1] == other[1]:
        return False
    return rooms[other[1]] >= rooms[own[1]]


def upward(path: Path) -> dict[str, set[str]]:
    """Return what a file imports from above, by when; a folder, or a room of the file's own folder."""
    own = parts(path)
    found: dict[str, set[str]] = {"eager": set(), "later": set(), "types": set()}
    for kind, name in imports(path):
        root, *other = name.split(".")
        if root == "stickslip" and other and points_up(own, other):
            found[kind].add(other[0] if other[0] != own[0] else ".".join(other[:2]))
    return found


FILES = [path for path in sorted(PACKAGE.rglob("*.py")) if parts(path)[0] not in ("__init__", "__main__")]


def test_no_two_classes_have_one_name() -> None:
    """A name that grep finds once: annotations of one class do not read as those of another."""
    places = [(node.name, path.name) for path in FILES for node in ast.walk(tree_of(path)) if isinstance(node, ast.ClassDef)]
    count = Counter(name for name, _ in places)
    assert [place for place in places if count[place[0]] > 1] == []


def test_every_folder_has_its_place() -> None:
    assert {parts(path)[0] for path in FILES} == set(HEIGHT)
    for package, rooms in ROOM_HEIGHT.items():
        assert {parts(path)[1] for path in FILES if parts(path)[0] == package} - {"__init__"} == set(rooms), package


def test_imports_point_down() -> None:
    found = {str(path.relative_to(PACKAGE)): upward(path) for path in FILES}
    assert {name: ups["eager"] for name, ups in found.items() if ups["eager"]} == {}
    assert {name: ups["later"] for name, ups in found.items() if ups["later"] and name not in LAZY_DOORS} == {}
    assert {name: ups["types"] for name, ups in found.items() if ups["types"]} == {}


def test_what_stands_side_by_side_does_not_import_each_other_in_a_circle() -> None:
    """Files and folders at every depth; names in annotations count, and what `LAZY_DOORS` import inside functions does not."""
    found = {folder: circle for folder, imported in side_by_side().items() if (circle := circle_in(imported))}
    assert found == {}


def side_by_side() -> dict[str, dict[str, set[str]]]:
    """Return for each folder what its files and folders import from each other, by their names."""
    found: dict[str, dict[str, set[str]]] = {}
    for path in FILES:
        own, is_door = parts(path), str(path.relative_to(PACKAGE)) in LAZY_DOORS
        for kind, name in imports(path):
            root, *other = name.split(".")
            if root != "stickslip" or (kind == "later" and is_door):
                continue
            shared = next((i for i, (a, b) in enumerate(zip(own, other, strict=False)) if a != b), None)
            if shared is not None:
                beside = other[shared] if _file(f"{root}.{'.'.join(other[: shared + 1])}") else "__init__"
                found.setdefault("/".join(own[:shared]), {}).setdefault(own[shared], set()).add(beside)
    return found


def circle_in(imported: dict[str, set[str]]) -> list[str]:
    """Return names each of which imports the one before it, the first and the last the same; empty if there are none."""
    try:
        TopologicalSorter(imported).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_heavy_libraries_are_known_to_few() -> None:
    eager = {(path, name.split(".")[0]) for path in FILES for kind, name in imports(path) if kind == "eager"}
    assert [(str(path), root) for path, root in eager if parts(path)[0] not in ALLOWED.get(root, {parts(path)[0]})] == []


def test_the_key_of_the_compile_cache_covers_all_that_is_compiled() -> None:
    """Each file with compiled functions, and each file from which such functions take a name."""
    from stickslip.engine.compile.cache import NOT_COMPILED, compiled_sources

    covered = set(compiled_sources())
    assert all(path.is_file() for path in covered)
    for path in FILES:
        tree = tree_of(path)
        origin = {
            alias.asname or alias.name: (node.module, alias.name)
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("stickslip")
            for alias in node.names
        }
        kernels = [
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef) and any(_is_compiler(one) for one in node.decorator_list)
        ]
        if kernels and path.name not in NOT_COMPILED:
            assert path in covered, f"{path} is compiled"
        for kernel in kernels:
            body = [one for statement in kernel.body for one in ast.walk(statement)]
            for name in {one.id for one in body if isinstance(one, ast.Name)} & set(origin):
                module, wanted = origin[name]
                file = _file(f"{module}.{wanted}") or _file(module)
                assert file in covered, f"{path}: {kernel.name} uses {name}"


def _is_compiler(decorator: ast.expr) -> bool:
    node = decorator.func if isinstance(decorator, ast.Call) else decorator
    word = node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""
    if word == "overload":
        return isinstance(decorator, ast.Call)  # numba's takes the function to compile; that of typing takes nothing
    return word in ("kernel", "inlined", "njit", "intrinsic", "register_jitable")


def _file(module: str) -> Path | None:
    path = PACKAGE.joinpath(*module.split(".")[1:])
    return next((one for one in (path.with_suffix(".py"), path / "__init__.py") if one.is_file()), None)


def test_importing_the_package_is_light() -> None:
    """Tables, units, files, figures and the compiler are imported when they are used."""
    heavy = "{'numba', 'pandas', 'xarray', 'pint', 'matplotlib', 'jinja2', 'typer', 'scipy', 'zarr'}"
    code = f"import sys, stickslip; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_the_code_of_every_package_that_decides_a_run_is_in_the_hash_of_a_checkpoint() -> None:
    assert all(engine(tuple(other for other in DECIDE if other != name)) != engine() for name in DECIDE)
