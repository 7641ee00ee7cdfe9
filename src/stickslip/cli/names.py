"""Complete names for the shell."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path

from typer import Context  # typer evaluates the annotation at run time

STARTERS = ("slab", "block")
"""Names of `templates.STARTERS`, repeated because completion must not wait for the import of that module."""


def _completion(module: str, names: str) -> Callable[[str], list[str]]:
    """Return a function that completes the names in a module's table, which it imports only when the shell asks."""

    def complete(incomplete: str) -> list[str]:
        found: Iterable[str] = getattr(import_module(f"stickslip.{module}"), names)
        return [name for name in found if name.startswith(incomplete)]

    return complete


complete_law = _completion("friction", "LAWS")
complete_pull = _completion("loading", "HISTORIES")
complete_rule = _completion("problem.selection_rule", "SELECTION_RULES")
complete_regularisation = _completion("studies.regularisations", "KINDS")
complete_quantity = _completion("sweeps.design.quantities", "QUANTITIES")
complete_design = _completion("sweeps.design.design", "KINDS")


def complete_fitted(incomplete: str) -> list[str]:
    """Return the names of laws that can be fitted to points, as far as they begin with what is typed."""
    from stickslip.foundation.errors import InputError
    from stickslip.friction import LAWS
    from stickslip.friction.custom.fit_parameters import template

    found = []
    for name in complete_law(incomplete):
        try:
            template(LAWS[name])
        except InputError:
            continue
        found.append(name)
    return found


def complete_table(incomplete: str) -> list[str]:
    """Return the CSV files and folders that begin with what is typed."""
    return _files(incomplete, (".csv", ".txt", ".tsv", ".dat"))


def complete_scenario(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml",))


def complete_source(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files, files of runs (.nc) and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml", ".nc"))


def _complete_files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    from stickslip.scenarios import library

    return [name for name in library.names() if name.startswith(incomplete)] + _files(incomplete, suffixes)


def _files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    typed = Path(incomplete)
    folder = typed if incomplete.endswith("/") else typed.parent
    files = [str(path) + ("/" if path.is_dir() else "") for path in _listing(folder) if path.is_dir() or path.suffix in suffixes]
    return [name for name in sorted(files) if name.startswith(incomplete)]


def _listing(folder: Path) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if not path.name.startswith(".")]
    except OSError:
        return []


def complete_template(incomplete: str) -> list[str]:
    """Return the starters and bundled scenarios that begin with what is typed."""
    from stickslip.scenarios import library

    return [name for name in [*STARTERS, *library.names()] if name.startswith(incomplete)]


def complete_vary(context: Context, incomplete: str) -> list[str]:
    """Return the keys that a sweep can vary in the scenario on the command line, as far as they begin with what is typed."""
    from stickslip.foundation.errors import InputError
    from stickslip.scenarios.scenario import load_scenario
    from stickslip.sweeps.design.parameter_paths import parameter_paths

    try:
        found = parameter_paths(load_scenario(context.params["scenario"]))
        return [f"{one.name}=" for one in found if one.name.startswith(incomplete)]
    except (InputError, KeyError, TypeError):
        return []
