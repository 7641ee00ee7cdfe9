"""Complete names for the shell."""

from __future__ import annotations

from pathlib import Path

from typer import Context  # typer evaluates the annotation at run time

STARTERS = ("slab", "block")
"""Names of `templates.STARTERS`, repeated because completion must not wait for the import of that module."""


def complete_scenario(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml",))


def complete_source(incomplete: str) -> list[str]:
    """Return the bundled scenarios, TOML files, files of runs (.nc) and folders that begin with what is typed."""
    return _complete_files(incomplete, (".toml", ".nc"))


def _complete_files(incomplete: str, suffixes: tuple[str, ...]) -> list[str]:
    from stickslip.scenarios import library

    typed = Path(incomplete)
    folder = typed if incomplete.endswith("/") else typed.parent
    files = [str(path) + ("/" if path.is_dir() else "") for path in _listing(folder) if path.is_dir() or path.suffix in suffixes]
    return [name for name in [*library.names(), *sorted(files)] if name.startswith(incomplete)]


def _listing(folder: Path) -> list[Path]:
    try:
        return [path for path in folder.iterdir() if not path.name.startswith(".")]
    except OSError:
        return []


def complete_template(incomplete: str) -> list[str]:
    """Return the starters and bundled scenarios that begin with what is typed."""
    from stickslip.scenarios import library

    return [name for name in [*STARTERS, *library.names()] if name.startswith(incomplete)]


def complete_law(incomplete: str) -> list[str]:
    """Return the kinds of friction laws that begin with what is typed."""
    from stickslip.friction import LAWS

    return [kind for kind in LAWS if kind.startswith(incomplete)]


def complete_pull(incomplete: str) -> list[str]:
    """Return the kinds of loading histories that begin with what is typed."""
    from stickslip.loading import HISTORIES

    return [kind for kind in HISTORIES if kind.startswith(incomplete)]


def complete_rule(incomplete: str) -> list[str]:
    """Return the built-in selection rules that begin with what is typed."""
    from stickslip.problem.selection_rule import SELECTION_RULES

    return [rule for rule in SELECTION_RULES if rule.startswith(incomplete)]


def complete_regularisation(incomplete: str) -> list[str]:
    """Return the kinds of regularisation that begin with what is typed."""
    from stickslip.studies.regularisations import KINDS

    return [kind for kind in KINDS if kind.startswith(incomplete)]


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


def complete_quantity(incomplete: str) -> list[str]:
    """Return the quantities of a sweep that begin with what is typed."""
    from stickslip.sweeps.design.quantities import QUANTITIES

    return [name for name in QUANTITIES if name.startswith(incomplete)]


def complete_design(incomplete: str) -> list[str]:
    """Return the designs of a sweep that begin with what is typed."""
    from stickslip.sweeps.design.design import KINDS

    return [kind for kind in KINDS if kind.startswith(incomplete)]
