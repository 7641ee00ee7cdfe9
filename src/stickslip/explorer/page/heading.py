"""The line above a panel: its title and its legend, as HTML that takes its colours from the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from stickslip.explorer.page.view import Key, View


def heading(title: str, keys: Sequence[Key]) -> str:
    """Return the heading of a panel as HTML."""
    entries = "".join(
        f'<li><span class="sample {key.style}" style="--role: var(--{key.role})" aria-hidden="true"></span>{escape(key.text)}</li>'
        for key in keys
    )
    return f'<div class="heading"><h2>{escape(title)}</h2><ul role="list" aria-label="Legend">{entries}</ul></div>'


def headings_of(view: View, titles: Mapping[str, str]) -> dict[str, str]:
    """Return the heading of each panel as HTML; `titles` are used for panels of which the view says none."""
    return {name: heading(view.titles.get(name, title), view.keys.get(name, ())) for name, title in titles.items()}
