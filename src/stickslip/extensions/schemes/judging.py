"""Compare series of any other program with the exact solution of every selection rule."""

from __future__ import annotations

from collections.abc import Sequence

from stickslip.extensions.schemes.contract import Series
from stickslip.extensions.schemes.schemes import Schemes
from stickslip.extensions.schemes.shocks import check_length, check_units
from stickslip.extensions.schemes.verdict import exact_runs
from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.problem.scenarios import Scenario
from stickslip.run import TextProgress, telling


def check_tolerance(tolerance: float) -> None:
    """Raise InputError if a tolerance cannot be one."""
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"judge_series: tolerance must lie between 0 and 1, got {shown(tolerance)}")


def judged(
    scenario: Scenario,
    several: Sequence[Series],
    tolerances: tuple[float, float],
    progress: TextProgress | bool | None,
    *,
    to_their_ends: bool = False,
) -> Schemes:
    """Compare series with the exact solution of a scenario.

    `tolerances` are the largest share that a series may be off by and pass, and the relative tolerance of the exact runs. Each
    series must last as long as the scenario; one may end earlier if the comparison goes `to_their_ends`.
    """
    tolerance, rtol = tolerances
    check_tolerance(tolerance)
    given = scenario.problem
    for one in several:
        check_length(one, float(one.time[-1]) if to_their_ends else scenario.duration)
    with telling(progress, "judge_series") as tell:
        exact = exact_runs(given, scenario.duration, rtol, tell)
    for one in several:
        check_units(one, exact[given.rule], given)
    return Schemes(given, exact, tuple(several), tolerance=tolerance)
