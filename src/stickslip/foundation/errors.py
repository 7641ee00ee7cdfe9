"""What goes wrong, in the user's words."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class InputError(ValueError):
    """The user's input cannot be used: one line that says where, what, and what is allowed."""


def nearest(word: str, allowed: Iterable[str]) -> str:
    """A hint at the nearest allowed word, or at all of them: to be put behind an error message."""
    allowed = list(allowed)
    close = difflib.get_close_matches(word, allowed, n=1)
    return f"did you mean '{close[0]}'?" if close else f"allowed: {', '.join(sorted(allowed))}"
