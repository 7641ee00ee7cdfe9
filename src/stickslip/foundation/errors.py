"""Errors that a user can act on, and hints at the nearest allowed word."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """Raised for input that cannot be used; the message says in one line where the fault is, what it is and what is allowed."""


def nearest(word: str, allowed: Iterable[str]) -> str:
    """Return a hint that names the allowed word nearest to `word`, or else all of them, to be appended to an error message."""
    allowed = list(allowed)
    close = difflib.get_close_matches(word, allowed, n=1)
    return f"did you mean '{close[0]}'?" if close else f"allowed: {', '.join(sorted(allowed))}"
