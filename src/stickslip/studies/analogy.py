"""When does a block stand for a slab? The first slip event of both under the same law, over two numbers of a problem.

The block is the slab's slow limit (`ElasticSlab.equivalent_block`): it is right where motion takes many travel times. Two pure
numbers say how far a problem is from there: how fast friction weakens with slip against the slab's stiffness, alpha_w h =
-S (dmu/du) h/G, and with slip rate against its impedance, -S (dmu/dv)/Z, which is alpha/alpha_c under law (15).
Source: the comparison of Campillo et al. 1996, Figs 5-7, at every point instead of three.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import pandas as pd

from stickslip.bodies import ElasticSlab
from stickslip.contact.critical import margin
from stickslip.contact.regime_map import Axis
from stickslip.foundation.errors import InputError
from stickslip.friction.slopes import slopes
from stickslip.problem.parameters import Parameter, parameter
from stickslip.problem.problem import Problem
from stickslip.run.simulate import simulate
from stickslip.trajectory.history import Floats

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Quantity = Literal["slip", "peak_rate", "duration"]
QUANTITIES: tuple[Quantity, ...] = ("slip", "peak_rate", "duration")
WITHIN = 0.1
"""The block stands for the slab where its answers are within this share of the slab's."""
RTOL = 1e-8
REFUSED, NO_EVENT = "refused", "no slip event"


@dataclass(frozen=True, eq=False, repr=False)
class Analogy:
    """What `analogy` found: `table` has a row a point, x fastest.

    Columns: the two numbers of the problem (SI); weakening_slip = -S (dmu/du) h/G at the start and weakening_rate =
    -S (dmu/dv)/Z where it is largest; for the first slip event slip_ (m), peak_rate_ (m/s), duration_ (s), pulses_, shocks_ and
    status_ of the slab and of the block; slip_ratio, peak_rate_ratio and duration_ratio, slab over block; `stands`. NaN where
    there is no event, or it does not end in the run.
    """

    problem: Problem
    duration: float
    x: Axis
    y: Axis
    within: float
    table: pd.DataFrame

    def ratio(self, quantity: Quantity) -> Floats:
        """Slab over block, shape (y, x)."""
        return self.grid(f"{quantity}_ratio")

    def grid(self, column: str) -> Floats:
        """A column of the table, shape (y, x)."""
        return self.table[column].to_numpy(float).reshape(self.y.points, self.x.points)

    @cached_property
    def text(self) -> str:
        """Where the block stands for the slab, and how far it is off elsewhere."""
        table, percent = self.table, f"{100 * self.within:g} %"
        known, good = table.dropna(subset=[f"{one}_ratio" for one in QUANTITIES]), table[table.stands]
        count = f"at {len(good)} of {len(known)} points with an event (slip, peak rate and duration within {percent}, same pulses)"
        if good.empty:
            where = f"the block stands for the slab {count}"
        else:
            slip, rate = good.weakening_slip.max(), good.weakening_rate.max()
            where = (
                f"the block stands for the slab {count}: there friction weakens with slip up to {slip:.3g} times the stiffness, "
                f"and with slip rate up to {rate:.3g} times the impedance"
            )
        ranges = (f"{name} {low:.2g} to {high:.2g}" for name in QUANTITIES for low, high in [_range(known[f"{name}_ratio"])])
        return f"{where}; slab over block: {', '.join(ranges).replace('_', ' ')}"

    def plot(self) -> Figure:
        """The three ratios, and where the block stands for the slab."""
        from stickslip.figures.studies.analogy import data, draw

        return draw(data(self))

    def __repr__(self) -> str:
        return f"stickslip Analogy\n  {self.text}"


def _range(values: pd.Series[float]) -> tuple[float, float]:
    return float(values.min()), float(values.max())


def block_for(problem: Problem) -> Problem:
    """The same problem for the slab's equivalent block, for each m^2 of contact. Raises InputError where there is none."""
    if not isinstance(problem.body, ElasticSlab):
        raise InputError("analogy: needs a slab: a block has no other block that stands for it")
    return replace(problem, body=problem.body.equivalent_block())


def analogy(
    problem: Problem,
    duration: float,
    x: Axis,
    y: Axis,
    *,
    rtol: float = RTOL,
    within: float = WITHIN,
    progress: Callable[[int, int], Any] | None = None,
) -> Analogy:
    """The first slip event of a slab and of its equivalent block over two numbers of the problem, all else kept.

    duration (s) is how long to wait for its end. `progress` is told how many points of how many are done. Ctrl-C raises
    KeyboardInterrupt. Raises InputError for a block, a driver that is not rigid, and names that are no numbers of the problem.
    """
    names = (parameter(problem, x.parameter), parameter(problem, y.parameter))
    if names[0].name == names[1].name:
        raise InputError(f"analogy: needs two different parameters, got {names[0].name} twice")
    if not 0.0 < within < 1.0:
        raise InputError(f"analogy: within must lie between 0 and 1, got {within!r}")
    block_for(problem)
    rows = []
    for at_y, at_x in product(y.values.tolist(), x.values.tolist()):
        row = {names[0].name: at_x, names[1].name: at_y}
        rows.append(row | _point(names, (at_x, at_y), duration, rtol))
        if progress is not None:
            progress(len(rows), x.points * y.points)
    table = pd.DataFrame(rows)
    table["stands"] = _stands(table, within)
    return Analogy(problem, duration, x, y, within, table)


def _point(names: tuple[Parameter, Parameter], values: tuple[float, float], duration: float, rtol: float) -> dict[str, Any]:
    """What both bodies do at a point."""
    problem = _put(names, values)
    blank = {"weakening_slip": np.nan, "weakening_rate": np.nan}
    events = dict.fromkeys(("slab", "block"), _nothing(REFUSED))
    if problem is not None:
        blank = weakening(problem)
        events = {name: _first_event(one, duration, rtol) for name, one in (("slab", problem), ("block", block_for(problem)))}
    found = {f"{key}_{name}": value for key in events["slab"] for name in events for value in [events[name][key]]}
    return blank | found | {f"{key}_ratio": found[f"{key}_slab"] / found[f"{key}_block"] for key in QUANTITIES}


def _put(names: tuple[Parameter, Parameter], values: tuple[float, float]) -> Problem | None:
    """The problem at a point, None where it is refused."""
    pairs = list(zip(names, values, strict=True))
    for (first, one), (second, other) in (pairs, pairs[::-1]):  # one alone may be refused where both together are not
        try:
            return parameter(first.put(one), second.name).put(other)
        except InputError:
            continue
    return None


def weakening(problem: Problem) -> dict[str, float]:
    """weakening_slip = -S (dmu/du) h/G where the problem starts, at 0+; weakening_rate = -S (dmu/dv)/Z, the largest there."""
    body = problem.body
    assert isinstance(body, ElasticSlab)
    by_slip, _ = slopes(problem.friction, problem.law_slip)
    massless = replace(problem, body=replace(body, contact_mass=0.0))
    return {"weakening_slip": -problem.normal * by_slip / body.stiffness, "weakening_rate": 1.0 - margin(massless)}


def _first_event(problem: Problem, duration: float, rtol: float) -> dict[str, Any]:
    solution = simulate(problem, duration, rtol, events=1)
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    if solution.events.empty:
        return _nothing(NO_EVENT)
    event = solution.events.iloc[0]
    found = {name: float(event[name]) for name in QUANTITIES}
    return found | {"pulses": int(event.pulses), "shocks": len(solution.shocks), "status": solution.status.name}


def _nothing(status: str) -> dict[str, Any]:
    return dict.fromkeys(QUANTITIES, np.nan) | {"pulses": 0, "shocks": 0, "status": status}


def _stands(table: pd.DataFrame, within: float) -> pd.Series[bool]:
    near = [(table[f"{one}_ratio"] - 1.0).abs() <= within for one in QUANTITIES]
    return near[0] & near[1] & near[2] & (table.pulses_slab == table.pulses_block)
