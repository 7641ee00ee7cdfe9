"""The options of a run as they are given by name, and what is said of each, in Python and on the command line.

`problem.run_options` declares which of them a scenario has. Nothing here needs numpy: the command line starts without it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypedDict

from stickslip.foundation.takes import Said

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from stickslip.foundation.conversion import WithUnit
    from stickslip.problem import SelectionRule

CHECKPOINT_EVERY = 30.0
"""Default interval between two checkpoints, s of wall clock: a killed run loses little, and writing costs little."""

WORDS = {
    "duration": Said(
        "float or str, optional",
        'Latest end of the run: a number in s, or a text with a unit such as "480 years".',
        "A scenario has one; a problem has none. Other times may be given as texts, too, and as quantities of the library pint.",
    ),
    "rtol": Said("float, optional", "Relative tolerance of the run, between 1e-15 and 1e-2; 1e-10 by default."),
    "max_events": Said("int, optional", "Number of slip events after which the run stops."),
    "creep_rtol": Said(
        "float, optional",
        "Error of slip that leaps over slow creep and over steady sliding may cause, as a share of the slip since the start: up to "
        "1e-2, and 0 for no leaps. Not given: leaps begin after 200 round trips, or periods of a block, and their error follows "
        "rtol (1e-6).",
    ),
    "shortest_event": Said(
        "float or str, optional",
        'Slip events shorter than this ("1 ms") are lumped: up to 1 % of the two-way travel time, and 0 for no lumping. Not given: '
        "only where a round trip has more than 4096 pieces, as a slab under rate weakening may come to.",
    ),
    "selection": Said(
        "str or callable, optional",
        "The selection rule; by default that of the problem.",
        "It decides where the contact equation has several solutions: "
        '"perfect-delay", "maxwell", "minimal", "maximal", or one of your own (see `stickslip.selection`).',
    ),
    "progress": Said(
        "bool or callable, optional",
        "True shows the progress in one line, on a terminal or in a notebook.",
        "A function is called with a `stickslip.run.progress.Report` while the run continues.",
    ),
    "checkpoint": Said(
        "str or Path, optional",
        "File (.nc) that lets `stickslip.resume` continue the run, even after it has been killed. At its end it holds "
        "the solution.",
        "For a `PlanarSlab` a new folder (NAME.zarr); all frames are written to it.",
    ),
    "checkpoint_every": Said("float or str", "Interval between two checkpoints, s of wall clock.", default=CHECKPOINT_EVERY),
    "max_pieces": Said(
        "int, optional",
        "Largest number of pieces of history, which are intervals with one polynomial each for load and slip rate (0.42 kB each): "
        "two million by default. Whatever the number, a history takes at most a sixth of the free memory.",
    ),
    "title": Said("str, optional", "Title of the run, for figures; by default the scenario's title."),
}
"""What is said of each option of a run."""


class GivenToContinue(TypedDict, total=False):
    """How a run is watched, and when it stops: see `WORDS`."""

    max_events: int | None
    progress: Callable[[Any], object] | bool | None
    checkpoint_every: float | str | WithUnit
    max_pieces: int | None


class GivenToCatalogue(GivenToContinue, total=False):
    """How accurately slip events are found, too."""

    creep_rtol: float | None
    shortest_event: float | str | WithUnit | None


class GivenToRun(GivenToCatalogue, total=False):
    """How one run with its history is made: under which rule, into which file, and under which title."""

    selection: str | SelectionRule | None
    checkpoint: str | Path | None
    title: str
