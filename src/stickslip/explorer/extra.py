"""Say how to install the libraries of the explorer where they are missing; the rest of the package does without them."""

from __future__ import annotations

from importlib.util import find_spec

from stickslip.foundation.errors import InputError

LIBRARIES = ("panel", "bokeh")
"""The libraries of the extra `explorer`."""


def check_extra(who: str) -> None:
    """Refuse to go on without the libraries of the explorer. Raises InputError, which begins with `who`."""
    missing = [name for name in LIBRARIES if find_spec(name) is None]
    if missing:
        raise InputError(f'{who}: the explorer needs {" and ".join(missing)}: install them with pip install "stickslip[explorer]"')
