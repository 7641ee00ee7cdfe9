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
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeVar

if TYPE_CHECKING:
    from stickslip.problem.scenarios import ScenarioTable
    from stickslip.run import Reader, SolverKind

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
    needs: ClassVar[tuple[str, ...]] = ()
    """Names of extensions without which it is left out."""
    uses: ClassVar[tuple[str, ...]] = ()
    """Names of extensions that it uses where they are there: it asks `is_there`, and imports them inside functions."""

    def solvers(self) -> Sequence[SolverKind]:
        """Return solvers for kinds of problems that the core cannot run, each with the options that it takes."""
        return ()

    def tables(self) -> Mapping[str, ScenarioTable]:
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


class LeftOut(NamedTuple):
    """An extension that is left out: its name, why in one line, and the extension itself if it could be loaded."""

    name: str
    why: str
    extension: Extension | None = None


class Found(NamedTuple):
    """The extensions that are there, with what says where each comes from ("" for our own), and those that are left out."""

    there: Mapping[str, Extension]
    origins: Mapping[str, str]
    left_out: tuple[LeftOut, ...]


def extensions() -> tuple[Extension, ...]:
    """Return all extensions: our own, and those of other packages, each in the order of the names.

    One of another package that cannot be loaded is left out with a warning, and so is each that needs one that is not there.
    """
    return tuple(found().there.values())


def is_there(name: str) -> bool:
    """Return True if there is an extension of this name."""
    return name in found().there


def check_is_there(name: str, who: str) -> None:
    """Refuse to go on without the extension of this name. Raises InputError, which begins with `who`."""
    if not is_there(name):
        from stickslip.foundation.errors import InputError

        raise InputError(f"{who} needs the extension '{name}', which {why_missing(name)}")


@cache
def found() -> Found:
    """Look for extensions, and return what there is."""
    origins = dict.fromkeys(own := _own(), "")
    others, left_out = _of_others(own)
    there = own | {name: one for name, (one, _) in others.items()}
    origins |= {name: origin for name, (_, origin) in others.items()}
    while lacking := {name: lacks for name, one in there.items() if (lacks := [need for need in one.needs if need not in there])}:
        for name, lacks in lacking.items():
            missing = f"it needs the extension{'s' * (len(lacks) > 1)} {' and '.join(map(repr, lacks))}, which is not installed"
            left_out.append(LeftOut(name, missing.replace("which is", "which are") if len(lacks) > 1 else missing, there.pop(name)))
    for one in left_out:
        if one.extension is None or origins.get(one.name):
            _warn(f"the extension '{one.name}' is left out: {one.why}")
    return Found(there, origins, tuple(left_out))


def _own() -> dict[str, Extension]:
    """Return the extensions whose folders there are."""
    folders = sorted(Path(__file__).with_name("extensions").iterdir())
    names = [folder.name for folder in folders if (folder / "__init__.py").is_file()]
    return {name: import_module(f"{GROUP}.{name}").EXTENSION for name in names}


def _of_others(own: Mapping[str, Extension]) -> tuple[dict[str, tuple[Extension, str]], list[LeftOut]]:
    """Return the extensions of other packages by name, each with its package and version, and those that cannot be used."""
    good: dict[str, tuple[Extension, str]] = {}
    left_out: list[LeftOut] = []
    if not _is_declared():
        return good, left_out
    from importlib.metadata import entry_points

    for one in sorted(entry_points(group=GROUP), key=lambda one: one.name):
        origin = f"{one.dist.name} {one.dist.version}" if one.dist else one.value
        if one.name in own or one.name in good:
            left_out.append(LeftOut(one.name, f"there is another one of this name; this one is of {origin}"))
            continue
        try:
            good[one.name] = _checked(one.name, one.load()), origin
        except (Exception, SystemExit) as error:  # whatever another package raises
            left_out.append(LeftOut(one.name, f"{one.value} of {origin} cannot be used ({_in_one_line(error)})"))
    return good, left_out


def _checked(name: str, given: Any) -> Extension:
    """Return what an entry point stands for. Raises TypeError if it is no extension, or has another name."""
    if not isinstance(given, Extension):
        raise TypeError(f"it is no instance of stickslip.extension.Extension, but a {type(given).__name__}")
    if getattr(given, "name", None) != name:
        raise TypeError(f"its name is {getattr(given, 'name', None)!r}, and that of its entry point {name!r}")
    return given


def _is_declared() -> bool:
    """Return True if the metadata of an installed package names the group.

    `importlib.metadata` takes 50 ms to load, a tenth of what `stickslip --help` takes: it is loaded where there is something to
    find.
    """
    for folder in sys.path:
        with suppress(OSError), os.scandir(folder or ".") as there:
            for one in there:
                if one.name.endswith((".dist-info", ".egg-info")):
                    with suppress(OSError):
                        if f"[{GROUP}]" in Path(one.path, "entry_points.txt").read_text(encoding="utf-8", errors="replace"):
                            return True
    return False


def _in_one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())


def _warn(message: str) -> None:
    from stickslip.foundation.errors import warn

    warn(message)


def _asked(extension: Extension, ask: Callable[[Extension], Mapping[str, T]], what: str) -> Mapping[str, T]:
    """Return what an extension answers; one of another package that cannot answer adds nothing of the kind, with a warning."""
    try:
        return ask(extension)
    except Exception as error:  # whatever another package raises
        if not found().origins[extension.name]:
            raise
        _warn(f"the extension '{extension.name}' cannot say which {what}s it adds ({_in_one_line(error)})")
        return {}


def _gathered(ask: Callable[[Extension], Mapping[str, T]], what: str) -> dict[str, T]:
    """Return what all extensions add, by its name. Raises InputError if two add the same name."""
    all_of_them: dict[str, T] = {}
    owners: dict[str, str] = {}
    for extension in extensions():
        for name, one in _asked(extension, ask, what).items():
            if name in all_of_them:
                from stickslip.foundation.errors import InputError

                raise InputError(
                    f"the extensions '{owners[name]}' and '{extension.name}' both add the {what} '{name}': uninstall one"
                )
            all_of_them[name], owners[name] = one, extension.name
    return all_of_them


@cache
def tables() -> Mapping[str, ScenarioTable]:
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
    """Return the commands that extensions add, by their heading."""
    by_heading: dict[str, list[Command]] = {}
    for extension in extensions():
        for heading, added in _asked(extension, lambda one: one.commands(), "command").items():
            by_heading.setdefault(heading, []).extend(added)
    return by_heading


def why_missing(name: str) -> str:
    """Return why there is no extension of a name, for the end of a message."""
    return next((f"is left out: {one.why}" for one in found().left_out if one.name == name), "is not installed")


def command_left_out(name: str) -> str:
    """Return a message for a command of an extension that is left out, or "" if there is no such command."""
    for one in found().left_out:
        with suppress(Exception):  # the extension may need what is missing even to say what it adds
            if one.extension and name in (each.__name__ for group in one.extension.commands().values() for each in group):
                return f"'{name}' is a command of the extension '{one.name}', which is left out: {one.why}"
    return ""


def figures_of(kind: type) -> Mapping[str, Drawing]:
    """Return the figures that extensions add to a class of results, by their names."""
    return _gathered(lambda one: one.figures(kind), f"figure of {kind.__name__}")


def home_of(where: str) -> Any:
    """Return what "module:name" stands for."""
    module, _, name = where.partition(":")
    return getattr(import_module(module), name)
