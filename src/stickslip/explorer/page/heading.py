"""The line above a panel: its title and its legend, as HTML that takes its colours from the page."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from stickslip.explorer.page.view import Key


def heading(title: str, keys: Sequence[Key]) -> str:
    """Return the heading of a panel as HTML."""
    entries = "".join(
        f'<li><span class="sample {key.style}" style="--role: var(--{key.role})" aria-hidden="true"></span>{escape(key.text)}</li>'
        for key in keys
    )
    return f'<div class="heading"><h2>{escape(title)}</h2><ul role="list" aria-label="Legend">{entries}</ul></div>'
