"""Comparison of a slab with its equivalent block: the first slip event of both under one law, over two parameters.

The block is the slow limit of the slab (`ElasticSlab.equivalent_block`), valid for motion that takes many travel times. Two pure
numbers measure the distance of a problem from this limit: the weakening of friction with slip relative to the slab's stiffness,
alpha_w h = -S (dmu/du) h/G, and its weakening with slip rate relative to the impedance, -S (dmu/dv)/Z, which is alpha/alpha_c
under law (15).
Source: Campillo et al. 1996, Figs 5-7, who compare both bodies at three points; here the comparison is made on a grid of points.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
import pandas as pd

from stickslip.contact import margin, put_both, two_parameters
from stickslip.foundation.arguments import for_users
from stickslip.foundation.arrays import Floats
from stickslip.foundation.axis import Axis
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.problem import Problem, block_for
from stickslip.problem.bodies import BodyWithWaves
from stickslip.problem.scenarios import read_source
from stickslip.run import StudyWithDataset, TextProgress, telling, uninterrupted
from stickslip.run.simulate import simulate

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.problem.scenarios import Scenario


Quantity = Literal["slip", "peak_rate", "duration"]
QUANTITIES_COMPARED: tuple[Quantity, ...] = ("slip", "peak_rate", "duration")
"""Quantities of the first slip event that are compared: columns of `Solution.events` in m, m/s and s."""
WITHIN = 0.1
"""Default tolerance: the block represents the slab if the ratio of slab to block differs from 1 by no more than this."""
RTOL_OF_ANALOGY = 1e-8
"""Default relative tolerance of the runs, far below `WITHIN`."""
REFUSED, NO_EVENT = "refused", "no slip event"
"""Status at points at which the problem is not valid, and of runs in which nothing slips."""


@dataclass(frozen=True, eq=False, repr=False)
class Analogy(StudyWithDataset):
    """The result of `analogy`: the runs of slab and block over two parameters of a problem, x and y.

    The `table` has one row for each point, x varying fastest. Columns: the two parameters (SI); weakening_slip = -S (dmu/du) h/G at
    the start, and weakening_rate = -S (dmu/dv)/Z at the slip rate at which it is largest; for the first slip event ``slip_`` (m),
    ``peak_rate_`` (m/s), ``duration_`` (s), ``pulses_``, ``shocks_`` and ``status_``, each for slab and block; slip_ratio,
    peak_rate_ratio and duration_ratio, slab over block; stands, True if the block represents the slab, with ratios `within` their
    tolerance. Values are NaN if there is no event, and the duration also if the event does not end in the run.
    """

    problem: Problem
    duration: float
    x: Axis
    y: Axis
    within: float
    table: pd.DataFrame

    def ratio(self, quantity: Quantity) -> Floats:
        """Return the ratio of slab to block for a quantity, shape (y, x)."""
        return self.grid(f"{quantity}_ratio")

    def grid(self, column: str) -> Floats:
        """Return a column of the table as an array of shape (y, x)."""
        return self.table[column].to_numpy(float).reshape(self.y.points, self.x.points)

    @cached_property
    def text(self) -> str:
        """Summarise where the block represents the slab, and how far it deviates elsewhere."""
        table, percent = self.table, f"{100 * self.within:g} %"
        known, good = table.dropna(subset=[f"{one}_ratio" for one in QUANTITIES_COMPARED]), table[table.stands]
        count = f"at {len(good)} of {len(known)} points with an event (slip, peak rate and duration within {percent}, same pulses)"
        noun = self.problem.body.noun
        where = f"the block stands for the {noun} {count}"
        if not good.empty:
            where += (
                f": there friction weakens with slip up to {good.weakening_slip.max() + 0.0:.3g} times the stiffness, "
                f"and with slip rate up to {good.weakening_rate.max():.3g} times the impedance"
            )
        ratios = ((name, known[f"{name}_ratio"]) for name in QUANTITIES_COMPARED)
        ranges = (f"{name.replace('_', ' ')} {ratio.min():.2g} to {ratio.max():.2g}" for name, ratio in ratios)
        return f"{where}; {noun} over block: {', '.join(ranges)}"

    def to_dataset(self) -> xr.Dataset:
        """Return what `plot` draws, in SI units."""
        from stickslip.extensions.studies.figures.analogy import analogy_data

        return analogy_data(self)

    def _figure(self) -> Callable[..., Any]:
        from stickslip.extensions.studies.figures.analogy import draw_analogy

        return draw_analogy

    def _sentences(self) -> tuple[str, ...]:
        return (self.text,)


@for_users
def analogy(
    problem: Problem | Scenario | str | Path,
    duration: float | str | WithUnit | None,
    x: Axis,
    y: Axis,
    *,
    rtol: float = RTOL_OF_ANALOGY,
    within: float = WITHIN,
    progress: TextProgress | bool | None = None,
) -> Analogy:
    """Compare the first slip events of a slab and of its equivalent block, over two parameters of the problem.

    Parameters
    ----------
    problem : Problem, Scenario, str or Path
        Problem whose body is a slab under a rigid driver, its scenario, the name of a bundled scenario, or a scenario file.
        Everything except the two parameters is fixed.
    duration : float, str or None
        Longest time to wait for the end of the event (s, or a text with a unit); None takes the duration of the scenario.
    x, y : Axis
        The two parameters and their values.
    rtol : float
        Relative tolerance of the runs.
    within : float
        Largest difference of the ratios from 1 at which the block represents the slab, between 0 and 1.
    progress : bool or callable, optional
        True shows the progress in one line, on a terminal or in a notebook. A function is called with a line of text after each
        point.

    Raises
    ------
    InputError
        If the body is a block, if the driver is not rigid, if a name is no parameter or is given twice, or if `within` is out of
        range.
    KeyboardInterrupt
        If the user presses Ctrl-C.
    """
    scenario = read_source("analogy", problem, duration)
    lasts, given = scenario.duration, scenario.problem
    names = two_parameters(given, x, y, "analogy")
    if not 0.0 < within < 1.0:
        raise InputError(f"analogy: within must lie between 0 and 1, got {within!r}")
    block_for(given)  # raises InputError if there is no equivalent block
    rows = []
    with telling(progress, "analogy") as tell:
        for at_y, at_x in product(y.values.tolist(), x.values.tolist()):
            rows.append({names[0].name: at_x, names[1].name: at_y} | _point(put_both(names, (at_x, at_y)), lasts, rtol))
            tell(f"{len(rows)} of {x.points * y.points} points")
    table = pd.DataFrame(rows)
    table = table.assign(**{f"{key}_ratio": table[f"{key}_slab"] / table[f"{key}_block"] for key in QUANTITIES_COMPARED})
    return Analogy(given, lasts, x, y, within, table.assign(stands=_stands(table, within)))


def _point(problem: Problem | None, duration: float, rtol: float) -> dict[str, Any]:
    """Return the columns of the table that describe both bodies at a point; the problem is None if its values are refused."""
    if problem is None:
        numbers = {"weakening_slip": np.nan, "weakening_rate": np.nan}
        slab = block = _nothing(REFUSED)
    else:
        numbers = weakening(problem)
        slab, block = (_first_event(one, duration, rtol) for one in (problem, block_for(problem)))
    return numbers | {f"{key}_{name}": event[key] for key in slab for name, event in (("slab", slab), ("block", block))}


def weakening(problem: Problem) -> dict[str, float]:
    """Return -S (dmu/du) h/G at the initial slip and rate 0+, and the largest -S (dmu/dv)/Z over all slip rates there.

    The keys are "weakening_slip" and "weakening_rate".
    """
    body = cast(BodyWithWaves, problem.body)
    by_slip = float(problem.friction.slopes(problem.law_slip)[0])
    massless = replace(problem, body=replace(body, **{body.mass_field: 0.0}))
    return {"weakening_slip": -problem.normal * by_slip / body.stiffness, "weakening_rate": 1.0 - margin(massless)}


def _first_event(problem: Problem, duration: float, rtol: float) -> dict[str, Any]:
    solution = uninterrupted(simulate(problem, duration, rtol, max_events=1))
    if solution.events.empty:
        return _nothing(NO_EVENT)
    event = solution.events.iloc[0]
    found = {name: float(event[name]) for name in QUANTITIES_COMPARED}
    return found | {"pulses": int(event.pulses), "shocks": len(solution.shocks), "status": solution.status.name}


def _nothing(status: str) -> dict[str, Any]:
    return dict.fromkeys(QUANTITIES_COMPARED, np.nan) | {"pulses": 0, "shocks": 0, "status": status}


def _stands(table: pd.DataFrame, within: float) -> pd.Series[bool]:
    """Return where the block represents the slab: all ratios are near 1, and the events have the same number of pulses."""
    near = (table[[f"{key}_ratio" for key in QUANTITIES_COMPARED]] - 1.0).abs() <= within
    return near.all(axis=1) & (table.pulses_slab == table.pulses_block)
