"""Show fits of laws to measured points, smooth curves, and comparisons of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from stickslip.cli.output.show import console, print_sentences, say
from stickslip.cli.output.tables import print_words
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import clean

if TYPE_CHECKING:
    from stickslip.friction import Fit, Points, Smooth
    from stickslip.problem.problem import Problem

MOST_JOINED = 2000
"""Largest number of points whose exact interpolation is searched for folds, to say how many there would be."""


def show_result(result: Fit | Smooth) -> None:
    """Print the numbers of a fit or of a smooth curve, and what was noticed."""
    screen = console()
    say(screen, clean(f"{result.points.name}: {result.title}"), style="bold")
    print_words(screen, ("", "value", "unit"), list(result.rows))
    print_sentences(screen, *result.notes)


def show_comparison(points: Points, fits: Sequence[Fit]) -> None:
    """Print the fits of several laws to the same points, best first."""
    screen = console()
    say(screen, clean(f"{points.name}: {len(points)} points along {' and '.join(points.has)}"), style="bold")
    rows = []
    for one in fits:
        known = f"{len(one.uncertainty)}"
        noticed = "; ".join(one.notes[:1]) + (f" (and {len(one.notes) - 1} more)" if len(one.notes) > 1 else "")
        rows.append((one.law.kind, known, f"{one.residual:.3g}", f"{one.bic - fits[0].bic:.1f}", noticed))
    print_words(screen, ("law", "parameters", "residual", "BIC above best", "noticed"), rows)
    print_sentences(
        screen,
        "a difference of BIC above 10 is decisive. The best of several wrong laws is wrong too: see what was noticed, and a figure",
    )


def show_uniqueness(result: Fit | Smooth, problem: Problem) -> None:
    """Print whether the slip rate is unique under a law, and how many folds exact interpolation and the law have."""
    from stickslip.contact.uniqueness import uniqueness_of

    contact = uniqueness_of(problem)
    screen = console()
    print_sentences(screen, contact.summary.removesuffix("."))
    if contact.resistance is None or not problem.friction.depends_on_rate:
        return
    joined = _folds_of_points(result.points, problem)
    before = "" if joined is None else f"{joined} with the points joined exactly, "
    print_sentences(screen, f"folds of the contact equation: {before}{len(contact.folds)} with this law")


def _folds_of_points(points: Points, problem: Problem) -> int | None:
    """Return the number of folds of the same problem with the points joined exactly, or None if they cannot be."""
    import warnings

    from stickslip.contact.uniqueness import uniqueness_of
    from stickslip.foundation.errors import InputWarning
    from stickslip.friction import FromTable

    if len(points) > MOST_JOINED or len(points.has) != 1:
        return None
    try:
        with warnings.catch_warnings(action="ignore", category=InputWarning):
            return len(uniqueness_of(replace(problem, friction=FromTable(points))).folds)
    except InputError:
        return None
