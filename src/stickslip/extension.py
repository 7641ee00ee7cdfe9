"""What an extension adds to the core, and which extensions there are.

An extension is a package with an object `EXTENSION`, an instance of a subclass of `Extension`. Its methods are the seven questions
that the core asks; each is asked when its answer is needed, and imports what it needs then, so that a run does not load what it
does not use. The extensions of stickslip are the folders of `stickslip/extensions`; those of others are named by the entry points
of the group `stickslip.extensions`. The core knows no extension by its name, and an extension knows another one only if it
says so, in `needs` or `uses`. docs/extensions.md shows two that are complete.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, TypeVar

if TYPE_CHECKING:
    from stickslip.foundation.record_files import RecordForm
    from stickslip.problem.scenarios import ScenarioTable
    from stickslip.run import Reader, SolverKind

GROUP = "stickslip.extensions"
"""The folder of our own extensions as a package, and the group of the entry points of others."""
Command = Callable[..., None]
"""A command: a function whose arguments are those of the command line, as typer reads them; its docstring is the help."""
Drawing = Callable[..., Any]
"""A figure: a function that draws a result, and takes the keywords `ax`, `figure`, `size` and `dpi` that it understands."""
T = TypeVar("T")
ANSWERS = {
    "solvers": ("solver", "a list of SolverKind"),
    "tables": ("table", "a dict of ScenarioTable by name"),
    "readers": ("reader", "a list of Reader"),
    "forms": ("record form", "a list of RecordForm"),
    "commands": ("command", "a dict of lists of functions by heading"),
    "figures": ("figure", "a dict of functions by name"),
    "public": ("public name", 'a dict of "module:name" by name'),
}
"""What each method of an extension adds, and what it returns."""


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

    def forms(self) -> Sequence[RecordForm]:
        """Return formats of text for records, each with what knows it by the first lines of a file."""
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
            from stickslip.foundation.errors import warn

            warn(f"the extension '{one.name}' is left out: {one.why}")
    return Found(there, origins, tuple(left_out))


def _own() -> dict[str, Extension]:
    """Return the extensions whose folders there are."""
    names = [one.name for one in sorted(Path(__file__).with_name("extensions").iterdir()) if (one / "__init__.py").is_file()]
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


def _asked(extension: Extension, slot: str, fits: Callable[[Any], bool], *kinds: type) -> Any:
    """Return what a method of an extension answers; of another package nothing, with a warning, if it or a member does not fit."""
    try:
        given = getattr(extension, slot)(*kinds)
        if found().origins[extension.name] and not _is_answer(given, slot, fits):
            raise TypeError(f"{slot}() must return {ANSWERS[slot][1]}, not {given!r:.60}")
        return given
    except Exception as error:  # whatever another package raises
        if not found().origins[extension.name]:
            raise
        from stickslip.foundation.errors import warn

        warn(f"the extension '{extension.name}' cannot say which {ANSWERS[slot][0]}s it adds ({_in_one_line(error)})")
        return {}


def _is_answer(given: Any, slot: str, fits: Callable[[Any], bool]) -> bool:
    if slot in ("solvers", "readers", "forms"):
        return isinstance(given, Sequence) and not isinstance(given, str) and all(map(fits, given))
    return isinstance(given, Mapping) and all(isinstance(name, str) and fits(one) for name, one in given.items())


def members(slot: str, kind: type[T]) -> Iterator[T]:
    """Return what all extensions add as "solvers", "readers" or "forms"; each is asked when it is needed."""
    return (one for extension in extensions() for one in _asked(extension, slot, lambda given: isinstance(given, kind)))


def _gathered(slot: str, fits: Callable[[Any], bool], *kinds: type) -> dict[str, Any]:
    """Return what all extensions add, by its name. Raises InputError if two add the same name."""
    all_of_them: dict[str, Any] = {}
    owners: dict[str, str] = {}
    for extension in extensions():
        for name, one in _asked(extension, slot, fits, *kinds).items():
            if name in all_of_them:
                from stickslip.foundation.errors import InputError

                both = f"'{owners[name]}' and '{extension.name}' both add the {ANSWERS[slot][0]} '{name}'"
                raise InputError(f"the extensions {both}: uninstall one")
            all_of_them[name], owners[name] = one, extension.name
    return all_of_them


@cache
def tables() -> Mapping[str, ScenarioTable]:
    """Return the tables that extensions add to scenario files, by their names."""
    from stickslip.problem.scenarios import ScenarioTable

    return _gathered("tables", lambda one: isinstance(one, ScenarioTable))


@cache
def _public() -> Mapping[str, str]:
    return _gathered("public", lambda home: isinstance(home, str) and home.count(":") == 1)


def public_names(package: str) -> Mapping[str, str]:
    """Return what extensions add to a package: each name with its home as "module:name"."""
    prefix = package.partition(".")[2]
    split = {name.rpartition(".")[::2]: home for name, home in _public().items()}
    return {name: home for (owner, name), home in split.items() if owner == prefix}


def commands() -> Mapping[str, list[Command]]:
    """Return the commands that extensions add, by their heading."""
    by_heading: dict[str, list[Command]] = {}
    for extension in extensions():
        for heading, added in _asked(
            extension, "commands", lambda group: isinstance(group, Sequence) and all(map(callable, group))
        ).items():
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
    return _gathered("figures", callable, kind)


def home_of(where: str) -> Any:
    """Return what "module:name" stands for."""
    module, _, name = where.partition(":")
    return getattr(import_module(module), name)
