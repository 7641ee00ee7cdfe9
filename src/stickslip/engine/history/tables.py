"""Tables of a run: shocks and leaps over creep."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from stickslip.contact import regime_when_pressed
from stickslip.engine.history.history import History, Positions
from stickslip.engine.input.branch_table import is_algebraic
from stickslip.problem import Problem, leaps_over

if TYPE_CHECKING:
    import pandas as pd

Columns = dict[str, Any]
"""Arrays or lists of one length, by name: a table that needs no pandas, which takes a fifth of a second to import."""

CAUSES = ("", "start", "fold", "echo", "loading", "healing", "stop")
"""Names of the causes of shocks, by their code in the history; code 0 is no shock."""


SHOCK_COLUMNS = {
    "time": "s",
    "cause": "",
    "rate_before": "slip_rate",
    "rate_after": "slip_rate",
    "traction_before": "load",
    "traction_after": "load",
    "rule": "",
}
"""Units of the columns of the table of shocks, as `names.si_unit` understands them. `Solution.shocks` says what they mean."""


def shocks_table(history: History, first: float = -np.inf, last: float = np.inf) -> pd.DataFrame:
    """Return a table with one row per jump of the slip rate between two times (s)."""
    import pandas as pd

    columns = shock_columns(history, first, last)
    return pd.DataFrame(columns).assign(rule=rule_in_force(history.problem) if columns["cause"] else "")


def shock_columns(history: History, first: float = -np.inf, last: float = np.inf) -> Columns:
    """Return the columns of `shocks_table` but the last one."""
    piece = np.flatnonzero((history.store.cause > 0) & (history.start >= first) & (history.start <= last))
    before, after = history.just_before(piece), Positions.inside(piece, 0.0)
    reference = history.problem.strength
    return {
        "time": history.start[piece],
        "cause": [CAUSES[cause] for cause in history.store.cause[piece]],
        "rate_before": history.rate(before),
        "rate_after": history.rate(after),
        "traction_before": reference + history.friction(before),
        "traction_after": reference + history.friction(after),
    }


def creep_table(history: History) -> pd.DataFrame:
    """Return a table with one row per leap over creep; for the columns see `Solution.creep`."""
    import pandas as pd

    row, trips, error, delay = history.creep.T
    start, end = history.seconds(row, np.zeros(len(row))), history.seconds(row + trips, np.zeros(len(row)))
    columns = {"start": start, "end": end, "start_row": row, "round_trips": trips, "error": error, "time_error": delay}
    return pd.DataFrame(columns).astype({"start_row": int, "round_trips": int})


def creep_note(history: History) -> str:
    """Return one line on the leaps over creep, or steady or slow sliding, in a history; empty if there are none."""
    if not len(history.creep):
        return ""
    leaps, (row, trips, error, delay) = len(history.creep), history.creep.T
    passed = leaps_over(history.problem)
    turns = f"{history.problem.body.turn}s"
    cycles = passed == "steady sliding" and _touches_rest(history)
    of = " of cycles that touch rest" if cycles else f" of {passed}" * (passed != "creep")
    over = f"{leaps} leap{'s' * (leaps > 1)} over {int(trips.sum())} {turns}{of}"
    note = f"{over}, {_error_of(history, error.max(), delay.max())}"
    ends = (row[-1] + trips[-1] + NEAR_THE_END) * history.round_trip_time >= history.duration
    return f"{note}; {_lasts(history.problem)}" if ends and not cycles and _slides_steadily(history) else note


END_ROUNDING = 1e-15
"""Rounding of slip and times at the end of a run, relative to them."""


def _error_of(history: History, slip: float, time: float) -> str:
    """Return a few words on the error of leaps: of slip, in its unit, and of time (s); both are known up to rounding."""
    least = END_ROUNDING * abs(float(history.slipped(Positions.inside(len(history) - 1, 1.0))[0])), END_ROUNDING * history.duration
    if slip <= least[0] and time <= least[1]:
        return "error no larger than rounding"
    return f"error at most {max(slip, least[0]):.1e} {history.problem.unit_of('slip')} of slip, {max(time, least[1]):.3g} s of time"


def _touches_rest(history: History) -> bool:
    """Return True if a contact has been at rest since its last leap."""
    return bool((history.store.mode[history.store.trip >= history.creep[-1, 0]] == 0).any())


NEAR_THE_END = 8
"""A leap was cut by the end of the run if the run ends within this many round trips after it."""


STEADY = 1e-3
"""Sliding is called steady if its slip rate differs from that of steady sliding by at most this share."""


def _slides_steadily(history: History) -> bool:
    """Return True if a history that leaps over sliding ends in steady sliding."""
    from stickslip.contact import steady_slidings  # here and below, because only leaps over sliding need it

    over, rate = leaps_over(history.problem), float(history.store.rate[-1].sum())
    steady = (one.rate for one in steady_slidings(history.problem).slidings)
    return over == "steady sliding" or (over == "slow sliding" and any(abs(rate - one) <= STEADY * abs(one) for one in steady))


def _lasts(problem: Problem) -> str:
    """Return a few words on a contact that slides steadily at the end of its run."""
    from stickslip.contact import driven_at, slides_on, steady_slidings

    found = steady_slidings(problem).slidings
    if len(found) != 1:
        return "it slides steadily up to the end"
    one, rigid, unit = found[0], problem.body.is_driven_rigidly, problem.unit_of("slip_rate")
    if one.lasts:
        return f"it {slides_on(one, is_driven_rigidly=rigid, unit=unit)}"
    return f"it slides steadily at {driven_at(one.rate, is_driven_rigidly=rigid, unit=unit)} to the end"


def rule_in_force(problem: Problem) -> str:
    """Return the selection rule if the contact equation has several solutions at some load, slip or normal load, else ""."""
    if not is_algebraic(problem):
        return ""
    several = problem.folds_move or regime_when_pressed(problem) != "regular"
    return problem.rule if several else ""
