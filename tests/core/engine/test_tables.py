"""The tables of all events at once against a plain walk along the history, event by event, piece by piece.

The plain walk finds places with numpy's roots of polynomials (eigenvalues, polished), and reads tractions at times. Places so found
are right to 1e-9 of a piece, values at them to 1e-12 of the largest in the table, where they stand still to first order or jump.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import stickslip as ss
from stickslip.engine.history import turning_points
from stickslip.engine.history.history import Epoch, History, Positions
from stickslip.engine.history.phase_index import Phases, standing_behind
from stickslip.engine.history.slip_events import EventTurns, SlipEvents, group_turns_in
from stickslip.engine.history.turning_points import Turn
from stickslip.engine.series.polynomial import MOST_CROSSINGS, crossings
from stickslip.engine.state.layout import TERMS
from stickslip.problem.event_rate import default_event_rate
from tests.core.engine.compiled import compiled
from tests.core.run.long_runs.problems import RUNS
from tests.problems import SLAB

F = ss.friction
SWING = ss.Problem(ss.SpringBlock(2.0, 50.0, 10.0), F.LinearSlipWeakening(0.3, 0.1, 2.0), initial_load=20.0)
BACKWARDS = ss.Problem(SLAB, F.HyperbolicRate(0.8, 0.3, 1.0), pull_rate=-1e-3, initial_load=-8.1e7)

CASES: dict[str, tuple[ss.Problem, float]] = {
    "slip that turns": (SWING, 10.0),
    "backwards, left open": (BACKWARDS, 4.0),
    "many pulses": RUNS["slip law, slab"],
    "events that heal": RUNS["slab that heals"],
    "leaps, rate law": RUNS["rate law, maximal"],
    "leaps, block": RUNS["block that heals"],
    "micro-events": (ss.load_scenario("fig7-slab-critical").problem, 9.6e4),
    "contact mass": RUNS["contact mass"],
    "creep": RUNS["rate and state, slab"],
    "left open": (RUNS["slip law, slab"][0], 3.0),
    "Coulomb, block": (ss.Problem(SWING.body, F.Coulomb(0.3, 0.2), pull_rate=1.0, initial_excess=-1.0), 10.0),
}
RATES: dict[str, Callable[[ss.Solution], float]] = {
    "every slip": lambda run: 0.0,
    "default": lambda run: default_event_rate(run.problem),
    "half the largest": lambda run: 0.5 * float(run.events.peak_rate.max()),
}


@dataclass
class PlainEvent:
    """Stretches [low, high] of pieces in which it goes on, and heights of |slip rate| along it with their places."""

    stretches: list[tuple[int, float, float]]
    points: list[tuple[float, int, float]]
    is_over: bool = False


def roots(p: Polynomial) -> list[float]:
    """Inside (0, 1) but for rounding, ascending, polished by Newton's method."""
    slope, found = p.deriv(), []
    for root in p.trim().roots():
        x = float(root.real)
        if abs(root.imag) < 1e-6 and -1e-6 < x < 1.0 + 1e-6:
            for _ in range(4):
                x -= p(x) / slope(x) if slope(x) != 0.0 else 0.0
            if 1e-14 < x < 1.0 - 1e-14:
                found.append(x)
    return sorted(found)


def plain_events(history: History, threshold: float) -> list[PlainEvent]:
    """Maximal intervals above the threshold."""
    events: list[PlainEvent] = []
    store, reached = history.store, (-1, 0)
    for n, mode in enumerate(store.mode):
        p = Polynomial(mode * store.rate[n])
        for low, high in pairwise([0.0, *(roots(p - threshold) if mode else []), 1.0]):
            if mode == 0 or p(0.5 * (low + high)) <= threshold:
                continue
            if reached != (n - 1, mode) or low > 0.0 or store.rate[n, 0] == 0.0:
                events.append(PlainEvent([], []))
            event = events[-1]
            event.stretches.append((n, low, high))
            event.points += [(float(p(x)), n, x) for x in (low, *(x for x in roots(p.deriv()) if low < x < high), high)]
            reached = (n, int(mode)) if high == 1.0 else (-1, 0)
            event.is_over = high < 1.0 or n + 1 < len(history)
    if history.problem.friction.sticks:
        for event in events:
            first, last = event.stretches[0], event.stretches[-1]
            before = straight_to_rest(history, first[:2], -1, threshold)
            after = straight_to_rest(history, last[::2], 1, threshold) if event.is_over else []
            event.stretches = [*before[::-1], *event.stretches, *after]
    return events


def straight_to_rest(history: History, place: tuple[int, float], way: int, threshold: float) -> list[tuple[int, float, float]]:
    """Stretches from a crossing of the threshold to the rest before it (way -1) or after it; none if |slip rate| turns between."""
    store, (n, x), found, height, slack = history.store, place, [], threshold * (1.0 - 1e-6), threshold * 1e-6
    while True:
        p, edge = Polynomial(store.mode[n] * store.rate[n]), max(way, 0)
        ahead = [y for y in roots(p.deriv())[::way] if way * (y - x) > 0.0]
        for y in [*ahead, edge] if x != edge else []:
            if p(y) > height + slack:
                return []
            height = min(height, float(p(y)))
        found.append((n, min(x, edge), max(x, edge)))
        behind = n + edge
        if behind == len(history):
            return []
        if behind == 0 or store.mode[behind] != store.mode[behind - 1] or store.rate[behind, 0] == 0.0:
            return found
        n, x = n + way, 1 - edge
        entry = float(store.mode[n] * Polynomial(store.rate[n])(x))
        if entry > height + slack:
            return []
        height = min(height, entry)


def slip_of(history: History, event: PlainEvent) -> float:
    total = 0.0
    for n, low, high in event.stretches:
        pace = Polynomial([history.store.speed[n], 2.0 * history.store.bend[n]])
        total += float((Polynomial(history.store.rate[n]) * pace).integ(lbnd=low)(high))
    return total


def plain_pulses(event: PlainEvent) -> int:
    heights = [height for height, _, _ in event.points if height > 0.0]
    pulses, peak, low = 1, heights[0], heights[0]
    for height in heights[1:]:
        if low < 0.5 * min(peak, height):
            pulses, peak, low = pulses + 1, height, height
        elif height > peak:
            peak = low = height
        low = min(low, height)
    return pulses


def place(history: History, n: int, xi: float) -> Epoch:
    store = history.store
    offset = store.phase_to[n] if xi == 1.0 else store.phase_from[n] + xi * (store.speed[n] + xi * store.bend[n])
    return Epoch(int(store.trip[n]), float(offset))


def traction(history: History, when: Epoch, side: str) -> float:
    local = history.seen_from(when)
    found = local.find(np.zeros(1), side)  # type: ignore[arg-type]
    return history.problem.strength + float(local.friction(found)[0])


def traction_before(history: History, event: PlainEvent) -> float:
    """Just before the event begins; the load where slip turns round, or begins again, in an instant of rest."""
    (first, low, _), store = event.stretches[0], history.store
    when = place(history, first, low)
    sliding = traction(history, when, "left")
    goes_on = first > 0 and store.mode[first - 1] == store.mode[first] and store.rate[first, 0] != 0.0
    if not history.problem.friction.sticks or low > 0.0 or goes_on:
        return sliding
    local = history.seen_from(when)
    at_rest = history.problem.strength + float(local.excess(local.find(np.zeros(1), "left"))[0])
    return max(sliding, at_rest) if store.mode[first] > 0 else min(sliding, at_rest)


def traction_after(history: History, n: int, xi: float) -> float:
    """At rest, where the slip rate falls on to zero; else where the event ends."""
    mode, rate = history.store.mode, abs(Polynomial(history.store.rate[n])(xi))
    for later in range(n + 1, len(history)):
        if mode[later] != mode[n]:
            return traction(history, place(history, later, 0.0), "right")
        if max(abs(Polynomial(history.store.rate[later])(x)) for x in (0.25, 0.5, 0.75, 1.0)) > rate:
            break
    if xi == 1.0 and n + 1 < len(history):
        return traction(history, place(history, n + 1, 0.0), "right")
    return history.problem.strength + float(history.friction(Positions.inside(n, xi))[0])


def plain_row(history: History, event: PlainEvent) -> dict[str, float]:
    (first, low, _), (last, _, high) = event.stretches[0], event.stretches[-1]
    top, peak_piece, peak_xi = max(event.points, key=lambda point: point[0])
    start, end, peak = place(history, first, low), place(history, last, high), place(history, peak_piece, peak_xi)
    before, after = traction_before(history, event), traction_after(history, last, high)
    row, slip = history.round_trip_time, slip_of(history, event)
    lasts = (end.trip - start.trip) * row + (end.offset - start.offset)
    return {
        "start": start.trip * row + start.offset,
        "end": end.trip * row + end.offset if event.is_over else np.nan,
        "duration": lasts if event.is_over else np.nan,
        "slip": slip,
        "peak_rate": top,
        "peak_time": peak.trip * row + peak.offset,
        "peak_after": (peak.trip - start.trip) * row + (peak.offset - start.offset),
        "traction_before": before,
        "traction_after": after,
        "traction_drop": before - after,
        "static_drop": history.problem.body.stiffness * slip,
        "pulses": plain_pulses(event),
        "phase": start.offset / row,
        "start_row": start.trip,
        "start_offset": start.offset,
    }


@pytest.fixture(scope="module", params=list(CASES))
def run(request: pytest.FixtureRequest) -> ss.Solution:
    return ss.simulate(*CASES[request.param])


@pytest.mark.sampled(every=14)
@pytest.mark.parametrize("rate", RATES.values(), ids=RATES)
def test_every_column_of_every_event_agrees_with_a_plain_walk(run: ss.Solution, rate: Callable[[ss.Solution], float]) -> None:
    history, threshold = run.history, rate(run)
    table, events = run.catalogue(threshold), plain_events(run.history, threshold)
    assert len(table) == len(events) > 0
    rows = [plain_row(history, event) for event in events]
    width = history.store.speed.max() + history.store.bend.max()
    strength = abs(run.problem.strength)
    slack = {"start": 1e-9 * width, "peak_time": 1e-7 * width, "peak_after": 1e-7 * width}
    slack |= dict.fromkeys(("end", "duration", "start_offset"), 1e-9 * width) | {"phase": 1e-9 * width / history.round_trip_time}
    slack |= dict.fromkeys(("traction_before", "traction_after", "traction_drop"), 1e-11 * strength)
    for name in rows[0]:
        wanted = np.array([row[name] for row in rows], float)
        largest = np.nanmax(np.abs(wanted), initial=0.0)
        tolerance = slack.get(name, 1e-12 * largest) + 1e-15 * largest
        assert table[name].to_numpy() == pytest.approx(wanted, rel=0.0, abs=tolerance, nan_ok=True), name
    since = [
        (b["start_row"] - a["start_row"]) * history.round_trip_time + (b["start_offset"] - a["start_offset"])
        for a, b in pairwise(rows)
    ]
    assert table.recurrence.to_numpy() == pytest.approx([np.nan, *since], rel=1e-15, abs=2e-9 * width, nan_ok=True)


@pytest.mark.sampled(every=12)
def test_every_shock_agrees_with_a_plain_walk(run: ss.Solution) -> None:
    history, shocks = run.history, run.shocks
    pieces = [n for n in range(len(history)) if history.store.cause[n] > 0]
    assert len(shocks) == len(pieces)
    for side in ("left", "right"):
        name = {"left": "before", "right": "after"}[side]
        local = [history.seen_from(place(history, n, 0.0)) for n in pieces]
        rates = [float(h.rate(h.find(np.zeros(1), side))[0]) for h in local]  # type: ignore[arg-type]
        assert shocks[f"rate_{name}"].to_numpy() == pytest.approx(rates, rel=1e-11, abs=1e-13)
        tractions = [traction(history, h.epoch, side) for h in local]
        assert shocks[f"traction_{name}"].to_numpy() == pytest.approx(tractions, rel=0.0, abs=1e-11 * abs(run.problem.strength))


def test_slip_is_summed_from_the_start_of_each_event(run: ss.Solution) -> None:
    """All at once is one by one, to the last digit."""
    events = SlipEvents.of(run.history, 0.0)
    together = run.history.slipped_within(events.begin, events.end)
    for n in range(len(events.pulses)):
        one = events.some(slice(n, n + 1))
        assert together[n] == run.history.slipped_since(one.begin, one.end)[0]


def test_each_event_has_its_fastest_point_and_its_pulses() -> None:
    table, found = Turn.table(10), EventTurns.table(10)
    turns, events = Turn.of(table), EventTurns.of(found)
    turns.kind[:] = [1, -1, 1, 0, 0, -1, 1, 0, 0, 0]
    turns.rate[:] = [3.0, 1.0, 1.0, 2.0, 2.0, 1.0, 4.0, 1.9, 5.0, 4.0]
    assert group_turns_in(table, found) == 3
    assert events.begin[:3].tolist() == [0, 2, 6]
    assert events.past[:3].tolist() == [2, 6, 10]
    assert events.top[:3].tolist() == [0, 3, 8]
    assert events.pulses[:3].tolist() == [1, 1, 2]


def test_bounds_never_hide_a_change_of_sign() -> None:
    rng, keeps_its_sign = np.random.default_rng(3), compiled(turning_points.keeps_its_sign)
    places, spare, kept = np.empty(MOST_CROSSINGS), np.empty(TERMS), 0
    for _ in range(3000):
        c = rng.normal(size=TERMS) * 0.5 ** np.arange(TERMS) * rng.uniform(0.1, 3.0)
        c[: rng.integers(0, 3)] = 0.0
        if keeps_its_sign(c):
            kept += 1
            assert crossings(c, places, spare) == 0
    assert 500 < kept < 2500


@pytest.mark.parametrize("name", ["block that heals", "slab that heals", "folds, lossy", "rate law, maximal"])
def test_a_search_from_the_end_finds_the_waves_in_the_body(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.engine.history.phase_index.RECENT_PIECES", 4)
    history = ss.simulate(*RUNS[name]).history
    for one, other in zip(
        standing_behind(history.store, history.round_trip_time),
        Phases.of(history.store, history.round_trip_time).standing(len(history) - 1),
        strict=True,
    ):
        assert np.array_equal(one, other)
