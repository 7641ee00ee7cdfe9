"""The names of packages: imported when they are first used, and answered with the nearest one where there is none."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import lazy_loader

Get = Callable[[str], Any]


def lazy_names(package: str, file: str) -> tuple[Get, Callable[[], list[str]], list[str]]:
    """Return `__getattr__`, `__dir__` and `__all__` of a package whose names are those of its stub."""
    imported, listed, names = lazy_loader.attach_stub(package, file)
    unknown = no_other_name(package)

    def get(name: str) -> Any:
        return imported(name) if name in names else unknown(name)

    return get, listed, names


def no_other_name(package: str) -> Get:
    """Return the `__getattr__` of a module that has all its names: it answers any other with the nearest."""

    def unknown(name: str) -> Any:
        from stickslip.foundation.errors import UnknownAttributeError

        raise UnknownAttributeError(sys.modules[package], name)

    return unknown
