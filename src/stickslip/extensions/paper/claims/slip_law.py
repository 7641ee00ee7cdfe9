"""Claims 1 to 4, 10, 16 and 21, on the slip law."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from stickslip.extensions.paper.cases import Runs, problem, typed
from stickslip.extensions.paper.claims.verdict import ClaimVerdict, Number, Outcome, claim, each, judge, verdict
from stickslip.foundation.constants import YEAR
from stickslip.friction import SinusoidalSlip
from stickslip.problem import Problem
from stickslip.solution import Solution

MUCH = 0.25
"""A release of more than this share of the initial load counts as "much of its stress"."""
SEVERAL = 2
"""This many pulses or more count as "several"."""
LATER = 100.0 * YEAR
"""How long (s) the block is pulled on at the plate rate."""
READINGS = {"as printed": "fig5-slab-printed", "ω = 50 /m": "fig5-slab-reconstructed"}
"""Cases of the slab by the reading of the constants."""
BLOCKS = {
    "as printed": "fig5-block-printed",
    "K = G × 10³ m": "fig5-block-reconstructed-k",
    "ω = 50 /m": "fig5-block-reconstructed-omega",
}
"""Cases of the block by the reading of the constants."""


@claim(1, "Under the slip law the block slips once, releases much of its stress, and stops.")
def block_slips_once(runs: Runs) -> ClaimVerdict:
    """Measure the number of events, the share of the load that is released, and whether the block rests at the end."""
    solutions = {reading: runs.case(name) for reading, name in BLOCKS.items()}
    released = {r: _released(s) for r, s in solutions.items()}
    rests = {r: bool(s.slip_rate(s.duration) == 0.0) for r, s in solutions.items()}
    holds = {r: len(s.events) == 1 and released[r] > MUCH and rests[r] for r, s in solutions.items()}
    printed = solutions["as printed"].problem
    why = (
        "As printed the start S μ'(u0) + K = 0 does not exist: friction weakens less steeply than the spring unloads, so that "
        "a block started where it weakens fastest only settles. With K = G × 10³ m (m and S describe a cube of 1 km), or with "
        "ω ≥ K/(a S), it slips once and stops, below the load at which it would be in balance: inertia carries it past."
    )
    return verdict(
        judge(holds["as printed"], any(holds.values())),
        "; ".join(r for r in solutions if holds[r]),
        why,
        ("steepest weakening S |μ'|, as printed", _steepest(printed), "N/m"),
        ("stiffness K, as printed", printed.body.stiffness, "N/m"),
        *each("events", {r: len(s.events) for r, s in solutions.items()}),
        *each("share of the load released", released),
        *each("slip", {r: s.catalogue(0.0).slip.abs().sum() for r, s in solutions.items()}, "m"),
        *each("stop", {r: s.catalogue(0.0).end.max() for r, s in solutions.items()}, "s"),
    )


def _released(solution: Solution) -> float:
    start, end = solution.load(np.array([0.0, solution.duration]))
    return float((start - end) / start)


def _steepest(case: Problem) -> float:
    """Return the steepest weakening with slip, S a omega (block: N/m; slab: Pa/m)."""
    law = typed(case.friction, SinusoidalSlip)
    return case.normal * abs(law.amplitude) * law.wavenumber


@claim(2, "Under the slip law the slab shows several pulses of slip.")
def slab_pulses(runs: Runs) -> ClaimVerdict:
    """Measure the number of pulses in each reading."""
    cases = {
        "as printed": "fig5-slab-printed",
        "u0 = uc + 1 cm": "fig5-slab-u0-1e-2",
        "ω = 50 /m": "fig5-slab-reconstructed",
    }
    pulses = {reading: int(runs.case(name).events.pulses.sum()) for reading, name in cases.items()}
    printed, other = (runs.case(cases[reading]) for reading in READINGS)
    why = (
        "As printed (u0 = uc + 1 mm) the start is statically stable: the slab creeps and settles. Started 1 cm beyond uc it "
        "slips in a single pulse. Several pulses within one round trip need friction that repeats within a shorter slip (ω = "
        "50 /m). A coarse grid shows several where the exact solution has one: `stickslip schemes`, and the page on schemes."
    )
    return verdict(
        judge(pulses["as printed"] >= SEVERAL, pulses["ω = 50 /m"] >= SEVERAL),
        "ω = 50 /m and 1 mm added to D0",
        why,
        ("pulses, as printed", pulses["as printed"], ""),
        ("largest slip rate, as printed", printed.events.peak_rate.max(), "m/s"),
        ("pulses, u0 = uc + 1 cm", pulses["u0 = uc + 1 cm"], ""),
        ("pulses, ω = 50 /m", pulses["ω = 50 /m"], ""),
        ("largest slip rate, ω = 50 /m", other.events.peak_rate.max(), "m/s"),
        ("slip, ω = 50 /m", abs(other.catalogue(0.0).slip.iloc[0]), "m"),
    )


@claim(3, "The wave reflected at the driver arrests the slab completely.")
def echo_arrests(runs: Runs) -> ClaimVerdict:
    """Measure the end of all slip compared with 2h/c, and the rest after it."""
    solutions = {reading: runs.case(name) for reading, name in READINGS.items()}
    back = solutions["as printed"].problem.round_trip_time
    ends = {r: float(s.catalogue(0.0).end.iloc[0]) for r, s in solutions.items()}
    after = {r: _largest_after(s, ends[r]) for r, s in solutions.items()}
    why = (
        "With ω = 50 /m the echo of the first slip, returning at 2h/c, lowers the load by twice what slip had radiated and "
        "stops the contact at once, by a shock; the rest of the echo keeps it there through a whole further round trip. As "
        "printed the slab creeps too slowly for that: it slows down by itself after the echo and arrests later."
    )
    return verdict(
        judge(*(abs(ends[r] - back) < 1e-9 * back and after[r] == 0.0 for r in READINGS)),
        "ω = 50 /m and 1 mm added to D0",
        why,
        ("two-way time 2h/c", back, "s"),
        *each("arrest", ends, "s"),
        *each("slip rate just before 2h/c", {r: s.slip_rate(back, side="left") for r, s in solutions.items()}, "m/s"),
        *each("largest slip rate after arrest", after, "m/s"),
    )


def _largest_after(solution: Solution, end: float) -> float:
    time, rate = solution.curve("slip_rate", end)
    return float(np.abs(rate[time > end]).max())


@claim(4, "The number of pulses depends only on the thickness and the wave speed.")
def what_sets_the_pulses(runs: Runs) -> ClaimVerdict:
    """Measure the number of pulses at the same thickness and wave speed, for other initial loads and other wavenumbers."""
    start = problem("fig5-slab-reconstructed")
    body, omega = start.body, typed(start.friction, SinusoidalSlip).wavenumber
    larger = {more: replace(start, initial_excess=start.excess + body.stiffness * more) for more in (0.0, 2e-3, 5e-3, 2e-2)}
    variants = {f"D0 larger by {1e3 * more:g} mm": case for more, case in larger.items()}
    variants |= {f"ω = {omega * factor:g} /m": _with_wavenumber(start, omega * factor) for factor in (0.5, 2.0)}
    counts = {name: int(runs(case, body.round_trip_time).events.pulses.sum()) for name, case in variants.items()}
    period = pulse_period(start)
    why = (
        "At one thickness and wave speed the number of pulses changes with the initial excess and with the law. Under a "
        "constant load the pulses follow each other after 2πZ/(ω√((β − μ0S)² − (aS)²)), which holds no thickness; how many "
        "fit into 2h/c therefore depends on the excess, ω, a and S as much as on h and c."
    )
    return verdict(
        judge(len(set(counts.values())) == 1),
        "",
        why,
        *each("pulses", counts),
        ("pulse period under the initial load", period, "s"),
        ("2h/c over that period", body.round_trip_time / period, ""),
    )


def _with_wavenumber(start: Problem, wavenumber: float) -> Problem:
    """Return the problem with another omega, and the same initial load and slip beyond the first peak of friction."""
    beyond = start.initial_slip - math.pi / (2.0 * typed(start.friction, SinusoidalSlip).wavenumber)
    slip = math.pi / (2.0 * wavenumber) + beyond
    same_load = replace(start, initial_slip=slip, initial_load=start.load, initial_excess=None)
    return same_load.parameters["wavenumber"].put(wavenumber)


def pulse_period(case: Problem) -> float:
    """Return the time (s) between pulses if the load beta kept its initial value.

    It is 2 pi Z / (omega sqrt((beta - mu0 S)^2 - (a S)^2)).
    """
    body, law = case.body, typed(case.friction, SinusoidalSlip)
    above = (case.load - law.mean * case.normal) ** 2 - (law.amplitude * case.normal) ** 2
    return 2.0 * math.pi * body.impedance / (law.wavenumber * math.sqrt(above))


@claim(10, "With the slip law the slab's problem is well-posed.")
def well_posed(runs: Runs) -> ClaimVerdict:
    """Measure the change of slip at 2h/c per small change of the initial load, for two sizes of that change."""
    numbers: list[Number] = []
    holds = []
    for reading, name in READINGS.items():
        large, small = (_response(runs, problem(name), share) for share in (1e-4, 1e-5))
        spread = abs(small / large - 1.0)
        holds.append(spread < 1e-2)
        numbers.append((f"change of slip per change of load, {reading}", small, "m/Pa"))
        numbers.append((f"relative change of it for a ten times smaller change, {reading}", spread, ""))
    why = (
        "Friction that depends on slip alone leaves the contact equation Zv + Sμ(u) = β with exactly one slip rate for every "
        "load, and that rate is a smooth function of slip and load: the motion is the solution of a differential equation "
        "with a Lipschitz right-hand side. Measured: slip at 2h/c answers a small change of the initial load in proportion to "
        "it."
    )
    return verdict(judge(*holds), "both readings" if all(holds) else "", why, *numbers)


def _response(runs: Runs, case: Problem, share: float) -> float:
    """Return the change of slip at 2h/c per change of the initial load (m/Pa); the load changes by `share` of its excess."""
    end = case.round_trip_time
    changed = replace(case, initial_excess=case.excess * (1.0 + share), initial_load=None)
    step = runs(changed, end).slip(end) - runs(case, end).slip(end)
    return float(step) / (case.excess * share)


@claim(16, "The initial data are close to instability.")
def close_to_instability(_: Runs) -> ClaimVerdict:
    """Measure the distance from the initial slip to the slip where friction weakens as fast as the slab unloads."""
    cases = {reading: problem(name) for reading, name in READINGS.items()}
    missing = {r: unstable_from(case) - case.initial_slip for r, case in cases.items()}
    ratio = {r: _weakening(case) / case.body.stiffness for r, case in cases.items()}
    printed = missing["as printed"]
    close = abs(printed) < 0.01 * cases["as printed"].initial_slip
    outcome = Outcome.PRINTED if close and printed < 0.0 else Outcome.QUALIFIED if close else Outcome.NOT
    why = (
        f"As printed the start is {1e3 * printed:.3f} mm short of the slip from which friction weakens faster "
        "than the slab unloads: close, but on the stable side, and nothing but creep follows. With ω = 50 /m the same "
        "millimetre lies beyond it. The block starts exactly there (S μ'(u0) + K = 0), with 1 mm more in D0; the rate-law "
        "cases start exactly at the static strength."
    )
    return verdict(
        outcome,
        "on the stable side as printed; unstable with ω = 50 /m",
        why,
        *each("slip still missing to instability", missing, "m"),
        *each("weakening over stiffness (unstable beyond 1)", ratio),
        *each("excess over static strength", {r: case.excess for r, case in cases.items()}, "Pa"),
    )


def unstable_from(case: Problem) -> float:
    """Return the slip (m) after the first peak of friction where S |mu'| = G/h."""
    body, law = case.body, typed(case.friction, SinusoidalSlip)
    return (math.pi / 2.0 + math.asin(body.stiffness / _steepest(case))) / law.wavenumber


def _weakening(case: Problem) -> float:
    """Return the weakening at the initial slip, -S mu'(u0), in Pa/m."""
    law = typed(case.friction, SinusoidalSlip)
    return -case.normal * law.amplitude * law.wavenumber * math.cos(law.wavenumber * case.initial_slip)


@claim(21, "Of the block under the slip law one cannot expect stick-slip events.")
def block_sticks_and_slips(runs: Runs) -> ClaimVerdict:
    """Measure the events of the block within 100 years of the plate's motion, and how long it rests between them."""
    solutions = {reading: runs(problem(name), LATER) for reading, name in BLOCKS.items()}
    events = {reading: solution.events for reading, solution in solutions.items()}
    slips = [reading for reading, table in events.items() if _released(runs.case(BLOCKS[reading])) > MUCH and len(table)]
    again = [reading for reading in slips if len(events[reading]) > 1]
    years = events["K = G × 10³ m"].start.to_numpy() / YEAR
    why = (
        "The block slips again whenever the plate has pulled it to a slip at which friction weakens faster than its spring "
        "unloads; the sinusoidal law has such slips in each of its periods. Between two events it rests, and creeps where "
        "friction rises with slip. Only with the constants as printed, where friction nowhere weakens so fast, does it creep "
        "for ever. Under friction that falls once and stays low it would indeed slip only once."
    )
    return verdict(
        judge(not again),
        "",
        why,
        *each("events in 100 years", {reading: len(table) for reading, table in events.items()}),
        *[(f"start of event {k + 1}, K = G × 10³ m", start, "years") for k, start in enumerate(years[:3].tolist())],
        *each("largest slip of an event", {reading: events[reading].slip.abs().max() for reading in again}, "m"),
        *each("periods of creep leaped over", {r: s.creep.round_trips.sum() for r, s in solutions.items()}),
    )
