"""Import the names of a package when they are first used, and answer a wrong name with the nearest one."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import resolve_name
from pathlib import Path
from typing import Any

from stickslip.extension import GROUP, home_of, public_names, why_missing

Get = Callable[[str], Any]


def lazy_names(package: str, file: str) -> tuple[Get, Callable[[], list[str]]]:
    """Return `__getattr__` and `__dir__` of a package whose names are those of its stub.

    The stub names those of our own extensions, too, for type checkers. While the program runs, extensions say themselves what they
    add, so that a name whose extension is not there is answered with what is missing.
    """
    homes, own = _homes(package, Path(file).with_suffix(".pyi"))
    of_core = {name: home for name, home in homes.items() if not home[0].startswith(GROUP)}
    others = other_names(package)

    def listed() -> list[str]:
        return sorted({*own, *of_core, *public_names(package)})

    def get(name: str) -> Any:
        if name == "__all__":
            return listed()
        if name in of_core:
            module, inside = of_core[name]
            found = import_module(f"{package}.{inside}") if module == package else _inside(module, inside)
            setattr(sys.modules[package], name, found)
            return found
        if "." in package and _is_module(Path(file).parent, name):  # `from stickslip.figures import style` asks for it here first
            return import_module(f"{package}.{name}")
        if name in homes and name not in public_names(package):
            raise _missing(package, name, homes[name][0])
        return others(name)

    return get, listed


def _homes(package: str, stub: Path) -> tuple[dict[str, tuple[str, str]], set[str]]:
    """Return the names that a stub imports, each with its module and its name there, and the names of the package itself.

    What the stub imports for a type, and does not list in `__all__`, is none of them.
    """
    tree = ast.parse(stub.read_text(encoding="utf-8"))
    found: dict[str, tuple[str, str]] = {}
    listed: set[str] = set()
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            module = resolve_name("." * node.level + (node.module or ""), package)
            found |= {alias.asname or alias.name: (module, alias.name) for alias in node.names}
        elif isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            listed = set(ast.literal_eval(node.value))
    return {name: home for name, home in found.items() if name in listed}, listed - found.keys()


def _inside(module: str, name: str) -> Any:
    """Return what a module has under a name; a module of a package may be it, too."""
    home = import_module(module)
    return getattr(home, name) if hasattr(home, name) else import_module(f"{module}.{name}")


def _is_module(folder: Path, name: str) -> bool:
    return (folder / f"{name}.py").is_file() or (folder / name / "__init__.py").is_file()


def _missing(package: str, name: str, home: str) -> AttributeError:
    extension = home.removeprefix(f"{GROUP}.").partition(".")[0]
    return AttributeError(
        f"{package} has no {name} here: it belongs to the extension '{extension}', which {why_missing(extension)}"
    )


def other_names(package: str) -> Get:
    """Return the `__getattr__` of a module: it finds the names that extensions add to it.

    It answers any other name with the nearest one.
    """

    def get(name: str) -> Any:
        if not name.startswith("__") and name in (added := public_names(package)):
            return home_of(added[name])
        from stickslip.foundation.errors import UnknownAttributeError

        raise UnknownAttributeError(sys.modules[package], name)

    return get
