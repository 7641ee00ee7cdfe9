"""Compile by numba's public compiler, with its own cache: the way that is left where a private name of numba is missing.

It makes machine code of every function by itself, so that a first start takes longer; the results are the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numba

from stickslip.engine.codegen.cache import CACHE, tell
from stickslip.engine.codegen.numba_privates import WHY_PLAIN
from stickslip.engine.codegen.private_folder import private_folder

FOLDER = None if CACHE is None else private_folder(CACHE / "plain")
"""Folder of numba's own cache files, which carry no checksums; None if this process has to compile for itself."""

tell(f"numba {numba.__version__} is used plainly ({WHY_PLAIN}): what is new is compiled several times as long, once")


def dispatchers(function: Callable[..., Any], entry: dict[str, Any], part: dict[str, Any]) -> tuple[Any, Any]:
    """Return what compiled code and what Python calls: here they are the same."""
    if FOLDER is None:
        both = numba.njit(**entry, **part)(function)
        return both, both
    before, numba.config.CACHE_DIR = numba.config.CACHE_DIR, str(FOLDER)
    try:
        both = numba.njit(cache=True, **entry, **part)(function)
    finally:
        numba.config.CACHE_DIR = before
    return both, both
