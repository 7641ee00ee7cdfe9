"""Free the drift of a record by itself if its plateaus show one, and hold it again if the fit does not need it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from stickslip.foundation.show import brief
from stickslip.inference.fit.estimate import Estimate
from stickslip.inference.fit.free import DRIFT, TREND, Free
from stickslip.inference.fit.part import Part
from stickslip.inference.fit.plateaus import PlateauDrift
from stickslip.inference.fit.starting import shown_drift
from stickslip.problem.problem import Problem

TRENDS = ("auto", "none")
"""What may be done about a drift of plateaus: free it where it shows, or nothing."""
KEPT = 3.0
"""A drift stays free if it is larger than this many standard errors: less than one record without a drift in 300 gets one."""


@dataclass(frozen=True)
class Offer:
    """A drift that the plateaus of a record show, and the name of the free number that describes it."""

    name: str
    drift: PlateauDrift

    @property
    def text(self) -> str:
        """What the plateaus do, as text."""
        return (
            f"plateaus of friction {'fall' if self.drift.value < 0.0 else 'rise'} with {'slip' if self.name == TREND else 'time'}"
        )


def offered(problem: Problem, parts: Sequence[Part], free: Sequence[Free], trend: str) -> tuple[Offer | None, PlateauDrift | None]:
    """Return the drift to free beside other numbers, if any, and the drift with which starting values are read off plateaus."""
    named = {one.name for one in free} & {TREND, DRIFT}
    if named:
        return None, shown_drift(problem, parts, with_slip=TREND in named)
    look = shown_drift(problem, parts)
    if trend == "none" or look is None or not look.seen:
        return None, None
    return Offer(TREND if look.with_slip else DRIFT, look), look


def decided(
    found: Estimate, widths: Sequence[float], offer: Offer, again: Callable[[Estimate, str], Estimate]
) -> tuple[Estimate, list[str]]:
    """Return a fit with the drift that was offered, or without it if the fit does not need it, and sentences on that.

    `widths` are the standard uncertainties of the searched numbers. `again` fits anew without a number, from where a fit has ended.
    """
    free = found.model.free
    i = next(i for i, one in enumerate(free) if one.name == offer.name)
    value, width = found.model.values(found.searched)[i], float(widths[i])
    error = free[i].width(value, width)
    if np.isfinite(error) and abs(value) > KEPT * error > 0.0:
        return found, said(offer, value, error)
    held = again(found, offer.name)
    return (held, []) if held.finished else (found, [])


def said(offer: Offer, value: float, error: float) -> list[str]:
    """Return sentences on a drift that is free although nobody asked for it, and on what the record does not tell of it."""
    unit, look = ("1/m" if offer.name == TREND else "1/s"), offer.drift
    size = f"{brief(value, unit, 3)} ± {brief(error, unit, 1)}"
    found = [f"{offer.text}: {offer.name} is free, too, and is {size}; trend='none' leaves it out"]
    if not look.told and look.rates > 1:
        found.append(
            f"whether friction drifts with slip ({TREND}) or with time ({DRIFT}) cannot be told from {look.plateaus} plateaus "
            f"at {look.rates} rates: free the other one instead, and compare"
        )
    if look.rates == look.plateaus and look.plateaus > 1:
        found.append(
            f"each of the {look.plateaus} rates comes once: levels cannot tell a drift from the effect of rate (a - b), only "
            "slopes within plateaus do; a record that comes back to a rate is surer"
        )
    return found
