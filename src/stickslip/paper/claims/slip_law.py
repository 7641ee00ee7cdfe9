"""Claims 1 to 4, 10 and 16, on the slip law."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip.friction import SinusoidalSlip
from stickslip.paper.cases import Runs, problem
from stickslip.paper.claims.verdict import Outcome, Verdict, judge, verdict
from stickslip.problem.problem import Problem
from stickslip.solution.solution import Solution

MUCH = 0.25
"""A release of more than this share of the initial load counts as "much of its stress"."""
SEVERAL = 2
"""This many pulses or more count as "several"."""


def block_slips_once(runs: Runs) -> Verdict:
    """Measure claim 1: the number of events, the share of the load that is released, and whether the block rests at the end."""
    names = {
        "as printed": "fig5-block-printed",
        "K = G × 10³ m": "fig5-block-reconstructed-k",
        "ω = 50 /m": "fig5-block-reconstructed-omega",
    }
    solutions = {reading: runs.case(name) for reading, name in names.items()}
    released = {reading: _released(s) for reading, s in solutions.items()}
    holds = {r: len(s.events) == 1 and released[r] > MUCH and _rests_at_end(s) for r, s in solutions.items()}
    printed = solutions["as printed"].problem
    weakening = _steepest(printed)
    numbers = [
        ("steepest weakening S |μ'|, as printed", weakening, "N/m"),
        ("stiffness K, as printed", printed.body.stiffness, "N/m"),
        *((f"events, {r}", len(s.events), "") for r, s in solutions.items()),
        *((f"share of the load released, {r}", released[r], "") for r in solutions),
        *((f"slip, {r}", s.catalogue(0.0).slip.sum(), "m") for r, s in solutions.items()),
        *((f"stop, {r}", s.catalogue(0.0).end.max(), "s") for r, s in solutions.items()),
    ]
    why = (
        "As printed the start S μ'(u0) + K = 0 does not exist: friction weakens less steeply than the spring unloads, so that "
        "a block started where it weakens fastest only settles. With K = G × 10³ m (m and S describe a cube of 1 km), or with "
        "ω ≥ K/(a S), it slips once and stops, below the load at which it would be in balance: inertia carries it past."
    )
    reading = "; ".join(r for r in solutions if holds[r])
    return verdict(1, judge(holds["as printed"], any(holds.values())), reading, why, *numbers)


def _released(solution: Solution) -> float:
    start, end = solution.load(np.array([0.0, solution.duration]))
    return float((start - end) / start)


def _rests_at_end(solution: Solution) -> bool:
    return bool(solution.slip_rate(solution.duration) == 0.0)


def _steepest(case: Problem) -> float:
    """Return the steepest weakening with slip, S a omega (block: N/m; slab: Pa/m)."""
    law = case.friction
    assert isinstance(law, SinusoidalSlip)
    return case.normal * abs(law.amplitude) * law.wavenumber


def slab_pulses(runs: Runs) -> Verdict:
    """Measure claim 2: the number of pulses in each reading."""
    printed, other = runs.case("fig5-slab-printed"), runs.case("fig5-slab-reconstructed")
    centimetre = runs.case("fig5-slab-u0-1e-2")
    pulses = {name: int(s.events.pulses.sum()) for name, s in (("printed", printed), ("other", other), ("cm", centimetre))}
    outcome = judge(pulses["printed"] >= SEVERAL, pulses["other"] >= SEVERAL)
    why = (
        "As printed (u0 = uc + 1 mm) the start is statically stable: the slab creeps and settles. Started 1 cm beyond uc it "
        "slips in a single pulse. Several pulses within one round trip need friction that repeats within a shorter slip (ω = "
        "50 /m)."
    )
    numbers = [
        ("pulses, as printed", pulses["printed"], ""),
        ("largest slip rate, as printed", printed.events.peak_rate.max(), "m/s"),
        ("pulses, u0 = uc + 1 cm", pulses["cm"], ""),
        ("pulses, ω = 50 /m", pulses["other"], ""),
        ("largest slip rate, ω = 50 /m", other.events.peak_rate.max(), "m/s"),
        ("slip, ω = 50 /m", other.catalogue(0.0).slip.iloc[0], "m"),
    ]
    return verdict(2, outcome, "ω = 50 /m and 1 mm added to D0", why, *numbers)


def echo_arrests(runs: Runs) -> Verdict:
    """Measure claim 3: the end of all slip compared with 2h/c, and the rest after it."""
    solutions = {"as printed": runs.case("fig5-slab-printed"), "ω = 50 /m": runs.case("fig5-slab-reconstructed")}
    ends = {r: float(s.catalogue(0.0).end.iloc[0]) for r, s in solutions.items()}
    back = solutions["as printed"].problem.round_trip_time
    holds = {r: abs(ends[r] - back) < 1e-9 * back and _rests_after(s, ends[r]) for r, s in solutions.items()}
    rate = {r: float(s.slip_rate(back, side="left")) for r, s in solutions.items()}
    why = (
        "With ω = 50 /m the echo of the first slip, returning at 2h/c, lowers the load by twice what slip had radiated and "
        "stops the contact at once, by a shock; the rest of the echo keeps it there through a whole further round trip. As "
        "printed the slab creeps too slowly for that: it slows down by itself after the echo and arrests later."
    )
    numbers = [
        ("two-way time 2h/c", back, "s"),
        *((f"arrest, {r}", ends[r], "s") for r in solutions),
        *((f"slip rate just before 2h/c, {r}", rate[r], "m/s") for r in solutions),
        *((f"largest slip rate after arrest, {r}", _largest_after(s, ends[r]), "m/s") for r, s in solutions.items()),
    ]
    return verdict(3, judge(*holds.values()), "ω = 50 /m and 1 mm added to D0", why, *numbers)


def _largest_after(solution: Solution, end: float) -> float:
    time, rate = solution.curve("slip_rate", end)
    return float(np.abs(rate[time > end]).max())


def _rests_after(solution: Solution, end: float) -> bool:
    return _largest_after(solution, end) == 0.0


def what_sets_the_pulses(runs: Runs) -> Verdict:
    """Measure claim 4: the number of pulses at the same thickness and wave speed, for other initial loads and other wavenumbers."""
    start = problem("fig5-slab-reconstructed")
    body, law = start.body, start.friction
    assert isinstance(law, SinusoidalSlip)
    variants = {
        f"D0 larger by {1e3 * more:g} mm": replace(start, initial_excess=start.excess + body.stiffness * more)
        for more in (0.0, 2e-3, 5e-3, 2e-2)
    } | {f"ω = {law.wavenumber * factor:g} /m": _with_wavenumber(start, law.wavenumber * factor) for factor in (0.5, 2.0)}
    counts = {name: int(runs(case, body.round_trip_time).events.pulses.sum()) for name, case in variants.items()}
    period = pulse_period(start)
    why = (
        "At one thickness and wave speed the number of pulses changes with the initial excess and with the law. Under a "
        "constant load the pulses follow each other after 2πZ/(ω√((β − μ0S)² − (aS)²)), which holds no thickness; how many "
        "fit into 2h/c therefore depends on the excess, ω, a and S as much as on h and c."
    )
    numbers = [
        *((f"pulses, {name}", n, "") for name, n in counts.items()),
        ("pulse period under the initial load", period, "s"),
        ("2h/c over that period", body.round_trip_time / period, ""),
    ]
    return verdict(4, judge(len(set(counts.values())) == 1), "", why, *numbers)


def _with_wavenumber(start: Problem, wavenumber: float) -> Problem:
    """Return the problem with another omega, and the same initial load and slip beyond the first peak of friction."""
    law = start.friction
    assert isinstance(law, SinusoidalSlip)
    beyond = start.initial_slip - math.pi / (2.0 * law.wavenumber)
    slip = math.pi / (2.0 * wavenumber) + beyond
    return replace(
        start, friction=replace(law, wavenumber=wavenumber), initial_slip=slip, initial_load=start.load, initial_excess=None
    )


def pulse_period(case: Problem) -> float:
    """Return the time (s) between pulses if the load beta kept its initial value.

    It is 2 pi Z / (omega sqrt((beta - mu0 S)^2 - (a S)^2)).
    """
    body, law = case.body, case.friction
    assert isinstance(law, SinusoidalSlip)
    above = (case.load - law.mean * case.normal) ** 2 - (law.amplitude * case.normal) ** 2
    return 2.0 * math.pi * body.impedance / (law.wavenumber * math.sqrt(above))


def well_posed(runs: Runs) -> Verdict:
    """Measure claim 10: the change of slip at 2h/c per small change of the initial load, for two sizes of that change."""
    numbers, holds = [], {}
    for reading, name in (("as printed", "fig5-slab-printed"), ("ω = 50 /m", "fig5-slab-reconstructed")):
        case = problem(name)
        responses = [_response(runs, case, share) for share in (1e-4, 1e-5)]
        spread = abs(responses[-1] / responses[-2] - 1.0)
        holds[reading] = spread < 1e-2
        numbers += [(f"change of slip per change of load, {reading}", responses[-1], "m/Pa")]
        numbers += [(f"relative change of it for a ten times smaller change, {reading}", spread, "")]
    why = (
        "Friction that depends on slip alone leaves the contact equation Zv + Sμ(u) = β with exactly one slip rate for every "
        "load, and that rate is a smooth function of slip and load: the motion is the solution of a differential equation "
        "with a Lipschitz right-hand side. Measured: slip at 2h/c answers a small change of the initial load in proportion to "
        "it."
    )
    return verdict(10, judge(*holds.values()), "both readings" if all(holds.values()) else "", why, *numbers)


def _response(runs: Runs, case: Problem, share: float) -> float:
    """Return the change of slip at 2h/c per change of the initial load (m/Pa); the load changes by `share` of its excess."""
    changed = replace(case, initial_excess=case.excess * (1.0 + share), initial_load=None)
    end = case.round_trip_time
    step = runs(changed, end).slip(end) - runs(case, end).slip(end)
    return float(step) / (case.excess * share)


def close_to_instability(_: Runs) -> Verdict:
    """Measure claim 16: the distance from the initial slip to the slip at which friction weakens as fast as the slab unloads."""
    printed, other = problem("fig5-slab-printed"), problem("fig5-slab-reconstructed")
    missing, ratio = {}, {}
    for reading, case in (("as printed", printed), ("ω = 50 /m", other)):
        missing[reading] = unstable_from(case) - case.initial_slip
        ratio[reading] = _weakening(case) / case.body.stiffness
    unstable = {r: m < 0.0 for r, m in missing.items()}
    close = abs(missing["as printed"]) < 0.01 * printed.initial_slip
    outcome = Outcome.PRINTED if close and unstable["as printed"] else Outcome.QUALIFIED if close else Outcome.NOT
    why = (
        f"As printed the start is {1e3 * missing['as printed']:.3f} mm short of the slip from which friction weakens faster "
        "than the slab unloads: close, but on the stable side, and nothing but creep follows. With ω = 50 /m the same "
        "millimetre lies beyond it. The block starts exactly there (S μ'(u0) + K = 0), with 1 mm more in D0; the rate-law "
        "cases start exactly at the static strength."
    )
    numbers = [
        *((f"slip still missing to instability, {r}", m, "m") for r, m in missing.items()),
        *((f"weakening over stiffness (unstable beyond 1), {r}", q, "") for r, q in ratio.items()),
        *((f"excess over static strength, {r}", c.excess, "Pa") for r, c in (("as printed", printed), ("ω = 50 /m", other))),
    ]
    return verdict(16, outcome, "on the stable side as printed; unstable with ω = 50 /m", why, *numbers)


def unstable_from(case: Problem) -> float:
    """Return the slip (m) after the first peak of friction at which S |mu'| = G/h."""
    body, law = case.body, case.friction
    assert isinstance(law, SinusoidalSlip)
    return (math.pi / 2.0 + math.asin(body.stiffness / _steepest(case))) / law.wavenumber


def _weakening(case: Problem) -> float:
    """Return the weakening at the initial slip, -S mu'(u0), in Pa/m."""
    law = case.friction
    assert isinstance(law, SinusoidalSlip)
    return -case.normal * law.amplitude * law.wavenumber * math.cos(law.wavenumber * case.initial_slip)
