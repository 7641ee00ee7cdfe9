"""Say what a record of a drill floor means: where its torque is measured, what its speed moves, and what weight is on the bit."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from stickslip.extensions.inference.record.record import Record
from stickslip.foundation.show import brief
from stickslip.problem import LoadingHistory, Problem

MANY_RATES = 40
"""A load point with more rates than this raises a doubt, unless it speeds up and slows down in turn so seldom as a ramp does."""
MOST_TURNS = 2
"""A ramp turns from speeding up to slowing down, or back, at most this many times."""
FAR_RATE = 100.0
"""A larger factor than this between the pull rates of record and problem raises a doubt about the record's units."""
LONG, LEVEL = 2.0, 0.1
"""A torque is level if it spreads by less than this share of its median over so many two-way travel times (both 1)."""
OTHER = 0.2
"""A weight on the bit is told if it differs from that of the problem by more than this share (1)."""


def is_level_at_first(record: Record, problem: Problem) -> bool:
    """Return True if the drive turns from the first sample on, under a torque that hardly changes while waves go to and fro.

    A string that is started from rest is wound up meanwhile, and one that sticks and slips lets its torque rise and fall.
    """
    of_rate = not problem.friction.states and not problem.friction.depends_on_slip
    if not of_rate or record.shear is None or record.load_rate is None or not record.load_rate[0]:
        return False
    first = record.measured[record.shear][record.clock <= LONG * problem.body.round_trip_time]
    first = first[np.isfinite(first)]
    return len(first) > 2 and float(np.ptp(first)) < LEVEL * abs(float(np.median(first)))


def about_drive(problem: Problem, record: Record, sensor: str, start: str | None, begins: str) -> Iterator[str]:
    """Yield sentences on what a record says of the drive of a body with waves that turns."""
    body = problem.body
    if record.shear == "surface_torque" or (sensor == "drive" and record.shear is not None):
        yield "the torque is that at the drive, which waves from the bit reach later"
        if start is None and begins == "steady":
            yield "the run begins in steady turning, because the torque is level at first: --start problem is another way"
        elif start is None:
            yield "the run begins as the problem says, because a torque at the drive is not the load at the bit"
    elif record.shear == "torque":
        yield "the torque is taken as that at the bit: sensor='drive' takes it as that at the drive, as a heading STOR does"
    if record.load_rate is not None and not body.is_driven_rigidly:
        yield (
            "the speed of the drive is taken as what it is asked for: observe='surface_torque,drive_rate' takes it as measured, "
            "and driver_impedance='rigid' as the motion of the drive"
        )
    elif record.load_rate is not None and len(np.unique(record.load_rate)) > 1:
        yield "the speed of the drive is taken as its motion: the error with which it was measured is not in the intervals"
    weight = getattr(body, "weight_on_bit", None)
    if record.normal_name == "weight_on_bit" and weight is not None and record.normal is not None:
        usual = float(np.nanmedian(record.normal))
        if abs(usual - weight) > OTHER * weight:
            both = f"{brief(usual, 'N', 4)} in the median of the record, and {brief(weight, 'N', 4)} in the problem"
            yield f"the weight on the bit is {both}"


def doubts_of_rate(problem: Problem, rate: LoadingHistory | float) -> Iterator[str]:
    """Yield sentences on a load point that hardly moves like a machine."""
    segments = rate.parts[1] if isinstance(rate, LoadingHistory) else np.array([rate])
    ways = np.sign(np.diff(segments))
    ways = ways[ways != 0.0]
    if len(segments) > MANY_RATES and np.count_nonzero(ways[1:] != ways[:-1]) > MOST_TURNS:
        cure = "if the column is slip, call it slip and give the load rate"
        yield f"the rate of the load point changes in {len(segments) - 1} places, as slip does and a driven machine hardly: {cure}"
    moving, assumed = np.abs(segments[segments != 0.0]), abs(problem.first_pull_rate)
    usual = float(moving[0]) if len(moving) else 0.0
    if assumed > 0.0 and usual > 0.0 and not assumed / FAR_RATE < usual < assumed * FAR_RATE:
        unit = problem.unit_of("slip_rate")
        speeds = f"{brief(usual, unit, 3)}, and at {brief(assumed, unit, 3)} in the problem"
        yield f"the load point moves at {speeds}: are the units of time and load point in their headings?"
