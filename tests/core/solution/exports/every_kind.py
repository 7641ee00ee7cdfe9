"""Runs of every kind of body, and the units of headings."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache

import stickslip as ss
from stickslip.problem.bodies import SpringBlock
from stickslip.solution.solution import Solution

SIZES = {"MPa": ("Pa", 1e6), "m s-1": ("m/s", 1.0), "rad s-1": ("rad/s", 1.0)}
"""Units of files that are spelled or sized unlike SI: their SI unit, and the factor to it. Others are SI already."""
AREA = 0.75


def in_si(unit: str) -> tuple[str, float]:
    return SIZES.get(unit, (unit, 1.0))


def pressed() -> ss.Problem:
    """A block on which the normal force is halved after 2 s, so that it slips."""
    falls = ss.loading.Steps(times=[0.0, 2.0], values=[1e6, 5e5])
    return ss.Problem(
        SpringBlock(1e5, 1e7, 1e6), ss.friction.Coulomb(0.6, 0.4), initial_load=4e5, pull_rate=1e-3, normal_load=falls
    )


RUNS: dict[str, Callable[[], Solution]] = {
    "block": lambda: ss.simulate("direct-shear-block", 5.0),
    "block, pressed": lambda: ss.simulate(pressed(), 4.0),
    "block to and fro": lambda: ss.simulate("reversing-axis", 0.15),
    "slab": lambda: ss.simulate("fig6-slab"),
    "slab, slip law": lambda: ss.simulate("fig5-slab-reconstructed", 3.0),
    "slab with a state": lambda: ss.simulate("rate-and-state-slab", 0.3),
    "layers": lambda: ss.simulate("low-velocity-zone", 12.0),
    "string": lambda: ss.simulate("drill-string", 12.0),
    "string of sections": lambda: ss.simulate("pipe-and-collar", 8.0),
}
"""Runs of every kind of body, short ones."""
KINDS = list(RUNS)


@cache
def run_of(kind: str) -> Solution:
    return RUNS[kind]()


def parts(heading: str) -> tuple[str, str]:
    """Name and unit of a heading such as "slip rate (m/s)"."""
    found = re.fullmatch(r"(.*?)(?: \((.*)\))?", heading)
    assert found is not None
    return found[1], found[2] or "1"
