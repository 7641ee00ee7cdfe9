"""The severity of stick-slip: how far the slip rate swings about its mean."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from stickslip.engine import LAST_THIRD, History, Positions, Turn, walk
from stickslip.foundation.arguments import for_users, shown
from stickslip.foundation.conversion import WithUnit
from stickslip.foundation.errors import InputError
from stickslip.foundation.quantities import Quantity

TIME_OF_RUN = Quantity("s", "time since the start of the run")


class RunWithHistory(Protocol):
    """What `severity` takes: a `Solution`."""

    @property
    def history(self) -> History:
        """All slip so far."""
        ...


@for_users
def severity(run: RunWithHistory, start: float | str | WithUnit | None = None, end: float | str | WithUnit | None = None) -> float:
    """Return the severity of stick-slip (1): half the range of the slip rate over the magnitude of its mean.

    It is 0 in steady sliding, and about 1 or more where the contact comes to rest again and again; drillers judge a bit by it. The
    range is that of the exact run, not of samples.

    Parameters
    ----------
    run : Solution
        The run.
    start, end : float, str or None
        Between which times (s since the start of the run, or texts with a unit). The default is the last third of the run.

    Returns
    -------
    float
        NaN if the contact ends where it began, so that the mean is 0.

    Raises
    ------
    InputError
        If the times do not follow each other within the run.

    Examples
    --------
    >>> import stickslip as ss
    >>> run = ss.simulate("drill-string", "60 s")
    >>> print(f"{ss.studies.severity(run):.2f}")
    1.20
    """
    history = getattr(run, "history", None)
    if not isinstance(history, History):
        raise InputError(f"severity: needs a Solution, got {shown(run)}")
    lasts = history.duration
    begin = LAST_THIRD * lasts if start is None else TIME_OF_RUN.check("severity", "start", start)
    until = lasts if end is None else TIME_OF_RUN.check("severity", "end", end)
    if not 0.0 <= begin < until <= lasts:
        raise InputError(f"severity: start and end must ascend within the run, 0 to {lasts:g} s, got {begin:g} and {until:g} s")
    turns = Turn.of(walk(history, 0.0))
    places = Positions.inside(turns.piece, turns.xi)
    time = history.seconds(*history.placed(places))
    between = history.rate(places)[(begin < time) & (time < until)]
    first, last = history.find(np.array([begin]), "right"), history.find(np.array([until]), "left")
    swing = float(np.ptp(np.concatenate([history.rate(first), between, history.rate(last)])))
    mean = float((history.slipped(last) - history.slipped(first))[0]) / (until - begin)
    return 0.5 * swing / abs(mean) if mean else math.nan
