"""The bundled slab that the paper shows beside a bundled block."""

from __future__ import annotations

SLABS = {"fig5-block": "fig5-slab-printed", "fig6-block": "fig6-slab", "fig7-block": "fig7-slab-critical"}
"""The slab by the beginning of the block's name."""


def slab_of_figure(name: str) -> str | None:
    """Return the name of the bundled slab that the paper shows beside a bundled block, or None for another name."""
    return next((slab for start, slab in SLABS.items() if name.startswith(start)), None)
