"""Claims 14 and 15, on the mass of the block and on its rest after an event."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from stickslip.contact import sign_change
from stickslip.extensions.paper.cases import Runs, problem, typed
from stickslip.extensions.paper.claims.verdict import ClaimVerdict, Number, claim, each, judge, verdict
from stickslip.foundation.constants import YEAR
from stickslip.friction import HyperbolicRate
from stickslip.problem import Problem
from stickslip.problem.bodies import as_block, as_slab
from stickslip.solution import Solution

LONG_REST = YEAR
"""A rest of at least this time (s) counts as long: one year, against events of seconds."""
MASS_FACTORS = (1.0, 1e-2, 1e-4, 1e-6)
"""Factors on the mass of the block."""
CONTACT_MASSES = (1e6, 1e5, 1e4)
"""Masses on the slab's contact, in kg/m^2; the slab itself has rho h = 2.8e7."""


@claim(14, "The difference comes from the mass concentrated in the block.")
def concentrated_mass(runs: Runs) -> ClaimVerdict:
    """Measure how without mass the block's rise becomes a jump, and with mass on the slab's contact its jumps vanish."""
    case = problem("fig6-slab")
    slab = as_slab(case.body)
    jump = runs.case("fig6-slab").shocks.rate_after.iloc[0]
    blocks = {f"block with mass × {factor:g}": runs(*_lightened(factor)) for factor in MASS_FACTORS}
    heavy = {mass: replace(case, body=replace(slab, contact_mass=mass)) for mass in CONTACT_MASSES}
    slabs = {f"slab with {mass:g} kg/m² on its contact": runs(one, 12.0) for mass, one in heavy.items()}
    block_rise, slab_rise = ({name: rise_time(s) for name, s in group.items()} for group in (blocks, slabs))
    block_peak, slab_peak = ({name: float(s.events.peak_rate.max()) for name, s in group.items()} for group in (blocks, slabs))
    shocks = {name: len(s.shocks) for name, s in slabs.items()}
    (whole, *_, lightest), (heaviest, *_, least) = block_rise.values(), slab_rise.values()
    to_a_jump = lightest < 1e-4 * whole and abs([*block_peak.values()][-1] / jump - 1.0) < 0.01
    proportional = least < 0.1 * heaviest
    why = (
        "Both ways. The block, with the slab's radiation resistance Z times its area as damping, rises from 10 to 90 % of its "
        "peak in a time that goes to zero with its mass, and its peak goes to the slab's jump: without mass its slip rate "
        "jumps. The slab with mass on its contact has no shock at all, and rises in a time proportional to that mass."
    )
    return verdict(
        judge(to_a_jump and not any(shocks.values()) and proportional),
        "α = 1 s/m, block with K = G × 10³ m",
        why,
        ("jump of the slab", jump, "m/s"),
        *each("rise time", block_rise, "s"),
        *each("largest slip rate", block_peak, "m/s"),
        *each("shocks", shocks),
        *each("rise time", slab_rise, "s"),
        *each("largest slip rate", slab_peak, "m/s"),
    )


def _lightened(factor: float) -> tuple[Problem, float]:
    """Return the block of Fig. 6 with its mass times `factor` and the slab's radiation as damping, and a duration (s).

    The duration is 120 times that in which a small slip rate grows by a factor e without the spring; it ends after the peak.
    """
    case, slab = problem("fig6-block-reconstructed"), as_slab(problem("fig6-slab").body)
    body, law = as_block(case.body), typed(case.friction, HyperbolicRate)
    mass, damping = body.mass * factor, slab.impedance * (body.normal_force / slab.normal_stress)
    growth = (body.normal_force * (law.static - law.dynamic) * law.alpha - damping) / mass
    return replace(case, body=replace(body, mass=mass, damping=damping)), 120.0 / growth


def rise_time(solution: Solution) -> float:
    """Return the time (s) that the slip rate of the first event takes to rise from 10 to 90 % of its peak."""
    event = solution.events.iloc[0]
    low, high = (_reaches(solution, share * event.peak_rate, event.start, event.peak_time) for share in (0.1, 0.9))
    return high - low


def _reaches(solution: Solution, rate: float, start: float, end: float) -> float:
    """Return the first time (s) between `start` and `end` when the slip rate reaches `rate` (m/s)."""
    time = np.linspace(start, end, 257)
    first = int(np.argmax(solution.slip_rate(time) >= rate))
    if first == 0:
        return end
    return sign_change(lambda t: float(solution.slip_rate(t)) - rate, float(time[first - 1]), float(time[first]))


@claim(15, "After its event the block stays put for a long period.")
def block_stays_put(runs: Runs) -> ClaimVerdict:
    """Measure the rest of the block before its second event, and the time in which the spring regains the strength."""
    readings = {
        "slip law, as printed": "fig5-block-printed",
        "rate law, as printed": "fig6-block-printed",
        "slip law, K = G × 10³ m": "fig5-block-reconstructed-k",
        "slip law, ω = 50 /m": "fig5-block-reconstructed-omega",
        "rate law, K = G × 10³ m": "fig6-block-reconstructed",
    }
    rests: dict[str, float] = {}
    numbers: list[Number] = []
    for reading, name in readings.items():
        rests[reading], expected, lasted = rest_after_event(runs, name)
        numbers += [
            (f"rest, {reading}", rests[reading] / YEAR, "year"),
            (f"reloading time (strength − force)/(K V), {reading}", expected / YEAR, "year"),
            (f"duration of the slip before it, {reading}", lasted, "s"),
        ]
    printed, other = (min(t for r, t in rests.items() if ("printed" in r) == as_printed) for as_printed in (True, False))
    why = (
        "The spring has to be pulled by what the event released before the block moves again: years, against an event of "
        "seconds. As printed there is no event worth the name: under the slip law the block settles by millimetres, under the "
        "rate law it follows the driver in steps of nanometres."
    )
    return verdict(judge(printed > LONG_REST, other > LONG_REST), "K = G × 10³ m, or ω = 50 /m", why, *numbers)


def rest_after_event(runs: Runs, name: str) -> tuple[float, float, float]:
    """Return three times (s) of a case: the rest, the reloading time, and the duration of the first slip.

    The rest lies between the first two intervals in which the block slips at all; the reloading time counts from the end of the
    first.
    """
    first = runs.case(name)
    slip = first.catalogue(0.0).iloc[0]
    expected = reloading_time(first, slip.end)
    later = runs(problem(name), slip.end + expected + 1.0).catalogue(0.0)
    return float(later.start.iloc[1] - later.end.iloc[0]), expected, float(slip.end - slip.start)


def reloading_time(solution: Solution, at: float) -> float:
    """Return the time (s) that the driver needs to raise the spring's force from its value at `at` (s) to the static strength.

    The block must rest at that time.
    """
    case = solution.problem
    strength = case.normal * float(case.friction.static_coefficient(float(solution.slip(at))))
    return float(strength - solution.load(at)) / (case.body.stiffness * case.first_pull_rate)
