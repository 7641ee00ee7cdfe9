"""The scenarios that the explorer offers: the paper's figures in both readings first, then the laboratory, then others."""

from __future__ import annotations

from typing import NamedTuple

from stickslip.scenarios import library

_SECTIONS = {
    "Figures of the paper": (
        "fig4-loop",
        "fig5-slab-printed",
        "fig5-slab-reconstructed",
        "fig5-slab-u0-1e-2",
        "fig5-block-printed",
        "fig5-block-reconstructed-k",
        "fig5-block-reconstructed-omega",
        "fig6-slab",
        "fig6-block-printed",
        "fig6-block-reconstructed",
        "fig7-slab-critical",
        "fig7-block-critical",
        "second-event-perfect-delay",
        "second-event-minimal",
        "second-event-maxwell",
        "second-event-maximal",
    ),
    "In the laboratory": (
        "direct-shear-block",
        "slide-hold-slide-block",
        "velocity-steps-block",
        "kolsky-slab",
        "cycles-slab",
        "bowed-string-slab",
        "reversing-axis",
    ),
}
OTHERS = "Faults and other cases"
"""Name of the section with the scenarios that no other section names."""
FIRST = "fig6-slab"
"""The scenario with which the explorer begins."""


class Offered(NamedTuple):
    """A scenario to choose: its section, its name, its title, and one sentence on what it shows."""

    section: str
    name: str
    title: str
    description: str


def offered() -> tuple[Offered, ...]:
    """Return all bundled scenarios in 1D in the order in which they are offered, section by section."""
    known = {name: library.entries()[name] for name in library.in_1d()}
    sections = {section: [name for name in names if name in known] for section, names in _SECTIONS.items()}
    named = {name for names in sections.values() for name in names}
    sections[OTHERS] = [name for name in known if name not in named]
    return tuple(Offered(section, name, *known[name]) for section, names in sections.items() for name in names)
