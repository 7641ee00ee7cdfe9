"""Names and texts of the scenarios that come with the package."""

from __future__ import annotations

from importlib import resources
from importlib.resources.abc import Traversable

from stickslip.foundation.errors import InputError, nearest


def _folder() -> Traversable:
    return resources.files("stickslip.scenarios") / "bundled"


def names() -> list[str]:
    """Return the sorted names of the bundled scenarios."""
    return sorted(file.name.removesuffix(".toml") for file in _folder().iterdir() if file.name.endswith(".toml"))


def text(name: str) -> str:
    """Return the TOML text of a bundled scenario. Raises InputError for a name that is not among `names()`."""
    if name not in names():
        raise InputError(f"no bundled scenario '{name}'; {nearest(name, names())}")
    return (_folder() / f"{name}.toml").read_text(encoding="utf-8")
