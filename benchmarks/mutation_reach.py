"""Which functions of the engine must be compiled again for a mutant: those that reach the changed statement through names."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

from benchmarks.mutants import SOURCE, Mutant

Key = tuple[str, str]
"""Module and name."""
REGISTERED = (
    "engine/codegen/simd.py",
    "engine/codegen/compiler.py",
    "engine/codegen/lean_compiler.py",
    "engine/codegen/one_module.py",
    "engine/codegen/records.py",
    "engine/state/layout.py",
    "engine/state/workspace.py",
    "engine/series/differences.py",
    "engine/series/lane_differences.py",
    "engine/series/sine.py",
)
"""Files that give types and operations to the compiler, or that generated modules import: no name leads to their users."""
FOLDERS = (
    "engine",
    "engine_input",
    "trajectory",
    "creep",
    "solution",
    "run",
    "batch",
    "friction",
    "contact",
    "observables",
    "bodies",
    "loading",
)


def depends_on_no_cache(path: str) -> bool:
    """Return True if everything must be compiled for a change of this file."""
    return path in REGISTERED


def must_compile(root: Path, mutant: Mutant) -> set[Key]:
    """Modules and names of everything at module level that depends on what the mutant changes."""
    module = _module(mutant.path)
    text = (root / SOURCE / mutant.path).read_bytes()
    line = text[: mutant.begin].count(b"\n") + 1
    seeds = {
        (module, name) for node in ast.parse(text).body if node.lineno <= line <= (node.end_lineno or 0) for name in _defined(node)
    }
    users, compiled = _users(root)
    reached, todo = set(seeds), list(seeds)
    while todo:
        for user in users.get(todo.pop(), ()):
            if user not in reached:
                reached.add(user)
                todo.append(user)
    return reached if reached & compiled else set()


def _module(path: str) -> str:
    return "stickslip." + path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _defined(node: ast.stmt) -> set[str]:
    """Names that a statement of a module gives a value."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        return {node.name}
    return {one.id for one in ast.walk(node) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)}


@cache
def _users(root: Path) -> tuple[dict[Key, set[Key]], set[Key]]:
    """For each name of each module the names that use it, and the names of compiled functions."""
    users: dict[Key, set[Key]] = {}
    compiled: set[Key] = set()
    for folder in FOLDERS:
        for path in sorted((root / SOURCE / folder).rglob("*.py")):
            module = _module(str(path.relative_to(root / SOURCE)))
            tree = ast.parse(path.read_bytes())
            names, modules = _imported(tree)
            own = {name for node in tree.body for name in _defined(node)}
            for node in tree.body:
                used = _used(node, module, own, names, modules)
                for name in _defined(node):
                    for one in used:
                        users.setdefault(one, set()).add((module, name))
                    if isinstance(node, ast.FunctionDef) and any(
                        _word(one) in ("kernel", "inlined") for one in node.decorator_list
                    ):
                        compiled.add((module, name))
    return users, compiled


def _is_kernel(node: ast.stmt) -> bool:
    return isinstance(node, ast.FunctionDef) and any(_word(one) in ("kernel", "inlined") for one in node.decorator_list)


def _word(node: ast.expr) -> str:
    return node.id if isinstance(node, ast.Name) else node.attr if isinstance(node, ast.Attribute) else ""


def _imported(tree: ast.Module) -> tuple[dict[str, Key], dict[str, str]]:
    """What names of a file stand for: names of other modules, and modules."""
    names: dict[str, Key] = {}
    modules: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            for one in node.names:
                names[one.asname or one.name] = (node.module, one.name)
                modules[one.asname or one.name] = f"{node.module}.{one.name}"
        elif isinstance(node, ast.Import):
            for one in node.names:
                modules[one.asname or one.name] = one.name
    return names, modules


def _used(node: ast.stmt, module: str, own: set[str], names: dict[str, Key], modules: dict[str, str]) -> set[Key]:
    found: set[Key] = set()
    for one in ast.walk(node):
        if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Load):
            if one.id in own:
                found.add((module, one.id))
            if one.id in names:
                found.add(names[one.id])
        elif isinstance(one, ast.Attribute) and isinstance(one.value, ast.Name) and one.value.id in modules:
            found.add((modules[one.value.id], one.attr))
    return found
