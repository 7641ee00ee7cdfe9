"""The house: the rooms of the package and what they import from each other, read from the source alone.

A room is a folder of the core, in the order CORE, or an extension. What else stands in the package is a face: the public names, and
`extension.py`, by which the core asks extensions.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from functools import cached_property
from graphlib import CycleError, TopologicalSorter
from pathlib import Path
from typing import NamedTuple

CORE = ("foundation", "friction", "problem", "contact", "engine", "solution", "run", "figures", "cli")
"""Rooms of the core from the bottom up: a room may import those before it."""
EXTENSIONS = "extensions"
"""The folder of the extensions, which stand side by side above the core."""
FACE = "(face)"
"""Room of what stands in neither."""


class Import(NamedTuple):
    """A module or a name of one that a file imports."""

    file: str
    """Path below the package."""
    own: str
    """Room of the file."""
    room: str
    """Room that it imports from."""
    module: str
    """Module that it imports, or imports from."""
    name: str | None
    """Name in the module; None for the module itself."""
    when: str
    """"eager", "later" (inside a function) or "types" (for type checkers)."""

    @property
    def edge(self) -> str:
        """What stands for it in rooms.toml."""
        return f"{self.file} -> {self.room}, {self.when}"


@dataclass(frozen=True)
class House:
    """The package in a folder."""

    package: Path

    @cached_property
    def trees(self) -> dict[str, ast.Module]:
        """The syntax tree of each file, by its path below the package."""
        files = sorted(self.package.rglob("*.py"))
        return {path.relative_to(self.package).as_posix(): ast.parse(path.read_text(encoding="utf-8")) for path in files}

    @cached_property
    def nodes(self) -> dict[str, list[ast.AST]]:
        """The nodes of each tree, which most measures walk."""
        return {file: list(ast.walk(tree)) for file, tree in self.trees.items()}

    @cached_property
    def modules(self) -> dict[str, str]:
        """The file of each module."""
        return {self.module_of(file): file for file in self.trees}

    def module_of(self, file: str) -> str:
        """Return the dotted name of a file."""
        parts = Path(file).with_suffix("").parts
        return ".".join((self.package.name, *(parts[:-1] if parts[-1] == "__init__" else parts)))

    @cached_property
    def extensions(self) -> list[str]:
        """The names of the extensions."""
        return sorted({file.split("/")[1] for file in self.trees if file.startswith(f"{EXTENSIONS}/") and file.count("/") > 1})

    def room_of(self, file: str) -> str:
        """Return the room of a file."""
        first, *rest = file.split("/")
        if first == EXTENSIONS and len(rest) > 1:
            return rest[0]
        return first if first in CORE and rest else FACE

    @cached_property
    def all_imports(self) -> list[Import]:
        """What the files import from each other, but for the package itself, which is loaded before them in any case."""
        return [one for file in self.trees for one in self._imports_of(file) if one.module != self.package.name]

    @cached_property
    def imports(self) -> list[Import]:
        """What crosses the border of a room."""
        return [one for one in self.all_imports if one.own != one.room]

    def _imports_of(self, file: str) -> Iterator[Import]:
        for when, module, name in self.imported[file]:
            if name and f"{module}.{name}" in self.modules:
                module, name = f"{module}.{name}", None
            found = self._nearest(module)
            if found:
                yield Import(file, self.room_of(file), self.room_of(self.modules[found]), found, name, when)

    @cached_property
    def imported(self) -> dict[str, list[tuple[str, str, str | None]]]:
        """What each file imports, from other packages, too: when, the module and a name in it."""
        return {
            file: list(_imported(tree, self.module_of(file), file.endswith("__init__.py"))) for file, tree in self.trees.items()
        }

    def _nearest(self, module: str) -> str:
        """Return the module or the package around it that there is a file of; empty for other people's."""
        while module and module not in self.modules:
            module = module.rpartition(".")[0]
        return module

    # ---- what is measured ----------------------------------------------------------------------------------------------------

    def upward(self) -> list[Import]:
        """Return imports within the core that do not point down."""
        return [one for one in self.imports if one.own in CORE and one.room in CORE and CORE.index(one.room) > CORE.index(one.own)]

    def of_extensions(self) -> list[Import]:
        """Return imports of extensions by the core and by the faces."""
        return [one for one in self.imports if one.own not in self.extensions and one.room in self.extensions]

    def between_extensions(self) -> list[Import]:
        """Return imports of an extension by another one that it does not declare.

        What an extension `needs` it may import. What it `uses` where it is there, it imports when it is used, and only from the
        front, which is the package itself.
        """
        there = self.extensions
        found = [one for one in self.imports if one.own in there and one.room in there]
        return [one for one in found if one.room not in self.declared(one.own, "needs") and not self._is_used_lightly(one)]

    def _is_used_lightly(self, one: Import) -> bool:
        is_front = one.module == f"{self.package.name}.{EXTENSIONS}.{one.room}"
        return one.room in self.declared(one.own, "uses") and one.when != "eager" and is_front

    def declared(self, extension: str, kind: str) -> set[str]:
        """Return the names of extensions that an extension declares as `needs`, or as `uses`."""
        found: set[str] = set()
        for node in ast.walk(self.trees.get(f"{EXTENSIONS}/{extension}/__init__.py", ast.Module([], []))):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
            if any(isinstance(one, ast.Name) and one.id == kind for one in targets):
                found |= {one.value for one in ast.walk(node) if isinstance(one, ast.Constant) and isinstance(one.value, str)}
        return found

    def named_extensions(self) -> list[str]:
        """Return where a text in the core, other than a docstring, names the module or the folder of an extension."""
        any_of = re.compile(rf"\b{EXTENSIONS}[./]({'|'.join(self.extensions)})\b")
        return [
            f"{file}:{node.lineno}: {found[0]}"
            for file, nodes in self.nodes.items()
            if self.room_of(file) in CORE
            for node in _texts(nodes)
            if (found := any_of.search(node.value))
        ]

    def taken_from_the_top(self) -> set[tuple[str, str]]:
        """Return what files of the core take from the package itself: (file, name)."""
        found = set()
        for file, nodes in self.nodes.items():
            if self.room_of(file) not in CORE:
                continue
            own = {self.package.name} | {
                alias.asname
                for node in nodes
                if isinstance(node, ast.Import)
                for alias in node.names
                if alias.name == self.package.name and alias.asname
            }
            for node in nodes:
                if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in own:
                    found.add((file, node.attr))
                elif isinstance(node, ast.ImportFrom) and node.module == self.package.name:
                    found |= {(file, alias.name) for alias in node.names}
        return {(file, name) for file, name in found if f"{self.package.name}.{name}" not in self.modules}

    def lines(self, room: str) -> tuple[int, int]:
        """Return the number of files of a room, and of their lines."""
        files = [file for file in self.trees if self.room_of(file) == room]
        return len(files), sum(len((self.package / file).read_text(encoding="utf-8").splitlines()) for file in files)

    def crossing(self, room: str) -> set[tuple[str, str | None]]:
        """Return the names that other rooms take from a room, each with its module; None for a module as a whole."""
        return {(one.module, one.name) for one in self.imports if one.room == room}

    def numbers(self) -> dict[str, int]:
        """Return the numbers that may only fall."""
        taken = [self.crossing(room) for room in (*CORE, *self.extensions, FACE)]
        return {
            "lines of the core": sum(self.lines(room)[1] for room in CORE),
            "names that cross rooms": sum(map(len, taken)),
            "files entered from outside": sum(len({module for module, _ in one}) for one in taken),
            "imports of extensions by the core": len(self.of_extensions()),
            "imports between extensions": len(self.between_extensions()),
        }

    def circles(self, doors: Collection[str] = ()) -> dict[str, list[str]]:
        """Return for each folder names in it that import each other in a circle; a folder without a circle is left out.

        At every depth within a room or an extension; names in annotations count. What `doors` import inside functions, or for type
        checkers, does not, and between rooms their order decides.
        """
        beside: dict[str, dict[str, set[str]]] = {}
        for one, folder, own, other in self._beside:
            if one.when == "eager" or one.file not in doors:
                beside.setdefault(folder, {}).setdefault(own, set()).add(other)
        return {folder: circle for folder, imported in beside.items() if (circle := _circle_in(imported))}

    @cached_property
    def _beside(self) -> list[tuple[Import, str, str, str]]:
        """Imports within rooms, each with the innermost folder of both files, and where in it either stands."""
        parts = {file: Path(file).with_suffix("").parts for file in self.trees}
        found = []
        for one in self.all_imports:
            own, other = parts[one.file], parts[self.modules[one.module]]
            shared = next((i for i, (a, b) in enumerate(zip(own, other, strict=False)) if a != b), 0)
            if shared and one.own == one.room:
                found.append((one, "/".join(own[:shared]), own[shared], other[shared]))
        return found

    def lists(self) -> dict[str, set[str]]:
        """Return the lists that may only shrink, each under its heading in rooms.toml."""
        return {
            "up": {one.edge for one in self.upward()},
            "of_extensions": {one.edge for one in self.of_extensions()},
            "between_extensions": {one.edge for one in self.between_extensions()},
        }


def _imported(tree: ast.Module, module: str, is_package: bool) -> Iterator[tuple[str, str, str | None]]:
    """Yield what a file imports: when, the module and a name in it."""

    def walk(node: ast.AST, when: str) -> Iterator[tuple[str, str, str | None]]:
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                yield from ((when, alias.name, None) for alias in child.names)
            elif isinstance(child, ast.ImportFrom):
                around = module.split(".")[: (1 if is_package else 0) - child.level or None] if child.level else []
                home = ".".join([*around, *([child.module] if child.module else [])])
                yield from ((when, home, alias.name) for alias in child.names)
            elif isinstance(child, ast.If) and _is_for_types(child.test):
                yield from walk(ast.Module(child.body, []), "types")
                yield from walk(ast.Module(child.orelse, []), when)
            elif isinstance(child, ast.stmt | ast.ExceptHandler | ast.match_case):
                inside = isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
                yield from walk(child, "later" if inside and when == "eager" else when)

    yield from walk(tree, "eager")


def _circle_in(imported: dict[str, set[str]]) -> list[str]:
    """Return names each of which imports the one before it, the first and the last the same; empty if there are none."""
    try:
        TopologicalSorter(imported).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def _is_for_types(test: ast.expr) -> bool:
    return any(isinstance(one, ast.Name) and one.id == "TYPE_CHECKING" for one in ast.walk(test))


def _texts(nodes: list[ast.AST]) -> Iterator[ast.Constant]:
    """Yield the texts among the nodes of a file that are no statements of their own, as docstrings are."""
    said = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in said:
            yield node
