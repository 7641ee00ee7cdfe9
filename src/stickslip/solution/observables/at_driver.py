"""Rate and load at the driver of a run: what a sensor at the top drive of a string, or behind the spring of a block, measures.

At the face that the driver holds the two waves of a body with waves meet: the one that left the contact h/c ago, and the one that
the driver sends back, which reaches the contact h/c later. Half their difference is the load there, half their sum over Z the rate.
A block has no waves: its driver moves at the pull rate, and bears the force of the spring.
"""

from __future__ import annotations

import numpy as np

from stickslip.engine import History
from stickslip.foundation.arrays import Floats


def fronts_at_driver(history: History) -> Floats:
    """Return the times (s since the epoch) when the ends of recorded pieces are at the driver, in the run, and the run's ends.

    In layers these are the fronts that come straight from the contact.
    """
    begin, end = history.span
    fronts = history.breaks + history.problem.body.time_to_driver
    return np.concatenate([[begin], fronts[(fronts > begin) & (fronts < end)], [end]])
