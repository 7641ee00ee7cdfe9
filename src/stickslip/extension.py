"""What an extension adds to the core, and which extensions there are.

An extension is a package with an object `EXTENSION`, an instance of a subclass of `Extension`. Its methods are the six questions
that the core asks; each is asked when its answer is needed, and imports what it needs then, so that a run does not load what it
does not use. The extensions of stickslip are the folders of `stickslip/extensions`; those of others are named by the entry points
of the group `stickslip.extensions`:

    [project.entry-points."stickslip.extensions"]
    spectra = "stickslip_spectra:EXTENSION"

The core knows no extension by its name, and an extension knows another one only through the core. docs/extensions.md shows two that
are complete.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

if TYPE_CHECKING:
    from stickslip.problem.scenarios.table import Table
    from stickslip.run.reader import Reader
    from stickslip.run.solver_kind import SolverKind

GROUP = "stickslip.extensions"
"""The folder of our own extensions as a package, and the group of the entry points of others."""
Command = Callable[..., None]
"""A command: a function whose arguments are those of the command line, as typer reads them; its docstring is the help."""
Drawing = Callable[..., Any]
"""A figure: a function that draws a result, and takes the keywords `ax`, `figure`, `size` and `dpi` that it understands."""
T = TypeVar("T")


class Extension:
    """What an extension adds; by default nothing. See the module for how an extension is found."""

    name: ClassVar[str]
    """Its name: that of its folder, or of its entry point."""

    def solvers(self) -> Sequence[SolverKind]:
        """Return solvers for kinds of problems that the core cannot run, each with the options that it takes."""
        return ()

    def tables(self) -> Mapping[str, Table]:
        """Return tables of scenario files, such as [contact], by their names."""
        return {}

    def readers(self) -> Sequence[Reader]:
        """Return readers of files and folders of results, for `show`, `export`, `resume` and `stickslip.open_solution`."""
        return ()

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return commands by the heading under which `stickslip --help` lists them."""
        return {}

    def figures(self, kind: type) -> Mapping[str, Drawing]:
        """Return figures of results of a class by their names: `solution.plot.NAME(...)` draws one."""
        return {}

    def public(self) -> Mapping[str, str]:
        """Return names that users write after `ss.`, such as "sweep" and "friction.fit", each with its home as "module:name"."""
        return {}


@cache
def extensions() -> tuple[Extension, ...]:
    """Return all extensions: our own, and those of other packages, each in the order of the names.

    One of another package that cannot be loaded is left out with a warning.
    """
    return (*_own(), *_of_others())


def _own() -> Iterator[Extension]:
    """Yield the extensions whose folders there are."""
    for folder in sorted(Path(__file__).with_name("extensions").iterdir()):
        if (folder / "__init__.py").is_file():
            yield import_module(f"{GROUP}.{folder.name}").EXTENSION


def _of_others() -> Iterator[Extension]:
    if not _is_declared():
        return
    from importlib.metadata import entry_points

    for one in sorted(entry_points(group=GROUP), key=lambda one: one.name):
        try:
            found = one.load()
            if not isinstance(found, Extension):
                raise TypeError(f"{one.value} is no instance of stickslip.extension.Extension")
        except Exception as error:
            _warn(f"the extension {one.name!r} ({one.value}) is left out: {type(error).__name__}: {error}")
            continue
        yield found


def _is_declared() -> bool:
    """Return True if the metadata of an installed package names the group.

    `importlib.metadata` takes 50 ms to load, a tenth of what `stickslip --help` takes: it is loaded where there is something to
    find.
    """
    for folder in map(Path, sys.path):
        with suppress(OSError):
            for one in os.scandir(folder):
                if one.name.endswith((".dist-info", ".egg-info")):
                    with suppress(OSError):
                        if f"[{GROUP}]" in Path(one.path, "entry_points.txt").read_text(encoding="utf-8", errors="replace"):
                            return True
    return False


def _warn(message: str) -> None:
    from stickslip.foundation.errors import warn

    warn(message)


def _gathered(asked: Callable[[Extension], Mapping[str, T]], what: str) -> dict[str, T]:
    """Return what all extensions add, by its name. Raises InputError if two add the same name."""
    found: dict[str, T] = {}
    owners: dict[str, str] = {}
    for extension in extensions():
        for name, one in asked(extension).items():
            if name in found:
                from stickslip.foundation.errors import InputError

                raise InputError(
                    f"the extensions '{owners[name]}' and '{extension.name}' both add the {what} '{name}': uninstall one"
                )
            found[name], owners[name] = one, extension.name
    return found


@cache
def tables() -> Mapping[str, Table]:
    """Return the tables that extensions add to scenario files, by their names."""
    return _gathered(lambda one: one.tables(), "table")


@cache
def _public() -> Mapping[str, str]:
    return _gathered(lambda one: one.public(), "public name")


def public_names(package: str) -> Mapping[str, str]:
    """Return what extensions add to a package: each name with its home as "module:name"."""
    prefix = package.partition(".")[2]
    split = {name.rpartition(".")[::2]: home for name, home in _public().items()}
    return {name: home for (owner, name), home in split.items() if owner == prefix}


def commands() -> Mapping[str, list[Command]]:
    """Return the commands that extensions add, by their heading. Raises InputError if two of them have one name."""
    found: dict[str, list[Command]] = {}
    for extension in extensions():
        for heading, added in extension.commands().items():
            found.setdefault(heading, []).extend(added)
    return found


def figures_of(kind: type) -> Mapping[str, Drawing]:
    """Return the figures that extensions add to a class of results, by their names."""
    return _gathered(lambda one: one.figures(kind), f"figure of {kind.__name__}")


def home_of(where: str) -> Any:
    """Return what "module:name" stands for."""
    module, _, name = where.partition(":")
    return getattr(import_module(module), name)
