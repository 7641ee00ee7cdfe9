"""The explorer in a notebook: `ss.explore(problem)`."""

from __future__ import annotations

from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stickslip.extension import check_is_there
from stickslip.foundation.arguments import for_users
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem

if TYPE_CHECKING:
    from stickslip.problem.scenarios import Scenario

LIBRARIES = ("panel", "bokeh")
"""The libraries of the extra `explorer`."""


def check_extra(who: str) -> None:
    """Refuse to go on without the libraries of the explorer. Raises InputError, which begins with `who`."""
    missing = [name for name in LIBRARIES if find_spec(name) is None]
    if missing:
        raise InputError(f'{who}: the explorer needs {" and ".join(missing)}: install them with pip install "stickslip[explorer]"')


ROUND_TRIPS = 3.0
"""A problem without a duration is shown for this many round trips of a slab, or periods of a block."""


@for_users
def explore(
    problem: Problem | Scenario | str | Path = "fig6-slab",
    duration: float | str | WithUnit | None = None,
    *,
    record: Any = None,
    sensor: str = "contact",
) -> Any:
    """Show a problem in a notebook, with controls for all of its numbers, as `stickslip explore` shows it in a browser.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        What to show first: a problem, a scenario (that of a fault in 2D, too), the name of a bundled scenario, or a scenario file.
    duration : float or str, optional
        Duration of the run: a number in s, or a text with a unit such as "480 years". By default the scenario's duration; for a
        problem three round trips of the waves in a slab, or three periods of a block.
    record : str, Path, DataFrame, mapping or Record, optional
        A laboratory record that is drawn behind the runs, as `studies.infer` reads it: the page says how far each run is from it.
    sensor : {"contact", "spring", "drive"}
        Where the shear of the record was measured: at the contact, by a load cell behind the spring of a block, or at the driver.

    Returns
    -------
    panel.viewable.Viewable
        The explorer. A notebook shows it as the last expression of a cell; its attribute `explorer` holds the setting and the
        answer.

    Raises
    ------
    InputError
        If the libraries of the extra `explorer` are missing, if the problem cannot be read, or if it cannot be written as a
        scenario because its law is a function of Python.

    See Also
    --------
    stickslip.simulate : run a problem without a page.

    Examples
    --------
    >>> import stickslip as ss
    >>> page = ss.explore("fig6-slab")  # in a notebook, where `page` as the last line of the cell shows it
    >>> page.explorer.answer.sentence[:40]
    'Irregular: several slip rates at some lo'
    """
    check_extra("explore")
    if record is not None:
        check_is_there("inference", "explore: record=")
    from stickslip.extensions.explorer.model.setting import explorable
    from stickslip.extensions.explorer.server.start import shown_in_notebook
    from stickslip.problem.scenarios import read_source

    if isinstance(problem, Problem):
        lasts = problem.round_trip_time * ROUND_TRIPS if duration is None else duration
        found = replace(read_source("explore", problem, lasts), name="problem")
    else:
        found = explorable(read_source("explore", problem, duration, any_kind=True))
    behind = None
    if record is not None and not found.is_of_core:
        raise InputError("explore: a record is not drawn behind a fault: leave out record, or [contact]")
    if record is not None:
        from stickslip.extensions.inference import record_beside

        behind = record_beside(record, sensor, found.problem, "explore")
    return shown_in_notebook(found, behind)
