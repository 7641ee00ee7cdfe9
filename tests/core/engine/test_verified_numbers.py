"""The verified numbers of the design, row by row: computed outside the package by two independent methods.

Tolerances are relative, 1e-9 where the table carries the digits (`digits` says how many it carries), and no absolute slack.
"""

from __future__ import annotations

import math

import pytest

import stickslip as ss
from tests.problems import (
    CRITICAL,
    DENSITY,
    IMPEDANCE,
    MODULUS,
    NORMAL,
    ROUND,
    SLAB,
    THICKNESS,
    rate_law_slab,
    slip_law_slab,
)


def close(value: float, digits: str) -> bool:
    """Whether a value agrees with a number of the table: to 1e-9, or to half a unit of the last digit where it has fewer."""
    mantissa = digits.replace("-", "").replace(".", "").split("e")[0].lstrip("0")
    carried = max(len(mantissa) - 1, 1)
    tolerance = max(1e-9, 1.0 * 10.0**-carried)
    return math.isclose(value, float(digits), rel_tol=tolerance, abs_tol=0.0)


def test_slab_slip_law_printed() -> None:
    run = ss.simulate(slip_law_slab(5.0, 1e-3), 20.0)
    event = run.catalogue(0.0).iloc[0]
    assert close(float(run.slip_rate(0.0)), "6.377538e-5")
    assert close(float(run.slip(ROUND)) - run.problem.initial_slip, "5.734045e-4")
    assert close(event.end, "7.584372")
    assert close(event.slip, "6.057137e-4")
    assert len(run.shocks) == 2
    assert event.pulses == 1


def test_slab_slip_law_reconstructed() -> None:
    run = ss.simulate(slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0)
    event = run.events.iloc[0]
    assert event.pulses == 3
    assert close(event.peak_rate, "10.204432")
    assert close(event.slip, "0.376105283")
    assert close(event.end, "5.714286")
    assert event.end == pytest.approx(ROUND, rel=1e-15, abs=0.0)
    assert list(run.shocks.cause) == ["start", "echo"]
    assert run.shocks.rate_after.iloc[-1] == 0.0


def test_peak_times_of_the_reconstructed_slab() -> None:
    """The table's peak times belong to V = 0; at 5 cm/yr the third comes 7.5 microseconds earlier (scipy's DOP853 agrees)."""
    still = peak_times(ss.simulate(slip_law_slab(50.0, 1e-3, extra_load=3430.0, pull=0.0), 20.0))
    assert [close(peak, digits) for peak, digits in zip(still, ("0.153986", "2.256706", "4.359426"), strict=True)] == [True] * 3
    pulled = peak_times(ss.simulate(slip_law_slab(50.0, 1e-3, extra_load=3430.0), 20.0))
    assert pulled == pytest.approx([0.15398634612770, 2.25670427121972, 4.35941869353794], rel=1e-9, abs=0.0)


def peak_times(run: ss.Solution) -> list[float]:
    """Times of the maxima of the slip rate above half the largest, from the event's own table of pulses."""
    from stickslip.engine.history.slip_events import walk
    from stickslip.engine.history.turning_points import Turn

    turns = Turn.of(walk(run.history, 0.5 * run.events.peak_rate.max()))
    tops: list[tuple[float, float]] = []
    for n, place, height in zip(turns.piece, turns.xi, turns.rate, strict=True):
        store = run.history.store
        time = float(run.history.start[n] + place * (store.speed[n] + place * store.bend[n]))
        if tops and time - tops[-1][0] < 0.5:
            tops[-1] = max(tops[-1], (time, height), key=lambda top: top[1])
        else:
            tops.append((time, height))
    return [time for time, _ in tops]


def test_slab_rate_law_at_alpha_one() -> None:
    run = ss.simulate(rate_law_slab(), 480 * ss.YEAR)
    first, second = run.shocks.iloc[0], run.shocks.iloc[1]
    assert close(float(run.slip_rate(0.0)), "4.10204081633")
    assert float(run.slip_rate(0.0, side="left")) == 0.0
    assert close(first.traction_after, "39800000.0000")
    assert second.time == ROUND
    assert second.rate_after == 0.0
    assert second.cause == "echo"
    assert close(second.traction_after, "-399999.969")
    assert close(run.events.slip.iloc[0], "23.4402332474")
    next_event = run.shocks.iloc[2]
    assert round(next_event.time / ROUND) - 1 == 2_589_011_265
    assert close(next_event.time / ss.YEAR, "468.80466")


def test_slab_rate_law_just_above_critical() -> None:
    run = ss.simulate(rate_law_slab(alpha=CRITICAL + 1e-6), 94_000.0)
    assert close(float(run.slip_rate(0.0)), "2.60306876818e-5")
    assert close(float(run.slip_rate(ROUND, side="left")), "1.40832223e-4")
    assert close(float(run.traction(ROUND)), "79999489.83")
    assert close(run.events.slip.iloc[0], "5.65875644e-4")
    assert list(run.shocks.cause[:3]) == ["start", "echo", "echo"]
    after_arrest = run.shocks.time.iloc[2] - ROUND
    assert round(after_arrest / ROUND) == 16_429
    assert close(after_arrest, "93880.000")
    assert run.history.store.phase_from[run.history.store.cause > 0][2] == 0.0


def test_coulomb_slab_in_the_limit_of_no_pull() -> None:
    """v = (muS - muD) S / Z for exactly R, then rest; slip 2 (muS - muD) S h / G; end stress S (2 muD - muS)."""
    run = ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, 0.3), pull_rate=1e-14, initial_excess=0.0), 3 * ROUND)
    event = run.catalogue(0.0).iloc[0]
    assert event.end == ROUND
    assert event.peak_rate == pytest.approx(0.5 * NORMAL / IMPEDANCE, rel=1e-12, abs=0.0)
    assert event.slip == pytest.approx(2 * 0.5 * NORMAL * THICKNESS / MODULUS, rel=1e-12, abs=0.0)
    assert float(run.traction(2.5 * ROUND)) == pytest.approx(NORMAL * (2 * 0.3 - 0.8), rel=1e-9, abs=0.0)


def test_coulomb_block_in_the_limit_of_no_pull() -> None:
    """Slip 2 (muS - muD) S / K in pi sqrt(m / K), at most at (muS - muD) S / sqrt(K m)."""
    block = ss.SpringBlock(DENSITY * 1e9, MODULUS * 1e3, 1e14)
    run = ss.simulate(ss.Problem(block, ss.friction.Coulomb(0.8, 0.3), pull_rate=1e-14, initial_excess=0.0), 20.0)
    event = run.catalogue(0.0).iloc[0]
    assert event.slip == pytest.approx(2 * 0.5 * 1e14 / block.stiffness, rel=1e-10, abs=0.0)
    assert event.end - event.start == pytest.approx(math.pi * math.sqrt(block.mass / block.stiffness), rel=1e-10, abs=0.0)
    assert event.peak_rate == pytest.approx(0.5 * 1e14 / math.sqrt(block.stiffness * block.mass), rel=1e-10, abs=0.0)
