"""Compile what tests of sweeps need beyond the engine."""

from __future__ import annotations

import stickslip as ss


def main() -> None:
    """Run two members side by side."""
    ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]})
