"""Laws of slip and slip rate on a massless slab: moving folds, against closed forms and against every root there is."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

import stickslip as ss
from tests.core.engine.moving_folds import (
    FREE,
    KINKED,
    MATCHED,
    PRODUCT,
    SLAB,
    WAVY,
    WEAKENING,
    S,
    Z,
    hardening,
)

F = ss.friction


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("rtol", [1e-6, 1e-10, 1e-13])
def test_fold_is_reached_at_the_slip_of_the_closed_form(sense: int, rtol: float) -> None:
    """Z + S mu_v(v_f) = 0 whatever the slip; then S k u_f = load - Z v_f - S mu(0, v_f)."""
    load = 0.8 * S + 1e5
    run = ss.simulate(ss.Problem(MATCHED, hardening(), initial_load=sense * load), 5.0, rtol=rtol)
    fold = math.sqrt(0.5 * S / Z) - 1.0
    slip = (load - Z * fold - S * (0.3 + 0.5 / (1.0 + fold))) / (0.05 * S)
    assert list(run.shocks.cause) == ["start", "fold"]
    assert run.shocks.rate_before.iloc[1] == pytest.approx(sense * fold, rel=1e-9, abs=0.0)
    assert run.shocks.rate_after.iloc[1] == 0.0
    assert float(run.slip(5.0)) == pytest.approx(sense * slip, rel=1e-12, abs=0.0)
    assert len(run.history) < 150
    energy = run.energy(5.0)
    assert abs(float(energy.balance[0] / energy.heat[0])) < 10 * rtol * 1e-2


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("distance", "jumps"), [(0.5, True), (0.02, False)])
def test_slip_weakening_lifts_slow_slip_over_its_upper_fold(distance: float, jumps: bool) -> None:
    """mu = 0.3 (1 - u / 3D), to its knot at D, + 0.3 + v exp(-v/0.3): slow slip ends at v_f, if that comes before the knot."""
    law = F.SlipPlusRate(slip=F.LinearSlipWeakening(0.3, 0.2, distance), rate=F.FromExpression("0.3 + v*exp(-v/0.3)"))
    excess = 6e6 if jumps else 1e5
    run = ss.simulate(ss.Problem(MATCHED, law, initial_excess=excess), 20.0)
    low, high = 0.3, 0.6  # Z + S (1 - v / 0.3) exp(-v / 0.3) falls through zero once between them
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if Z + S * (1.0 - middle / 0.3) * math.exp(-middle / 0.3) > 0.0 else (low, middle)
    slip = (Z * low + S * low * math.exp(-low / 0.3) - excess) * distance / (0.1 * S)
    assert (slip < distance) == jumps
    assert (list(run.shocks.cause) == ["start", "fold"]) == jumps
    if jumps:
        shock = run.shocks.iloc[1]
        assert shock.rate_before == pytest.approx(low, rel=1e-9, abs=0.0)
        assert float(run.slip(shock.time)) == pytest.approx(slip, rel=1e-9, abs=0.0)
        assert shock.rate_after > 2.0 * low
    else:
        rate = float(run.slip_rate(run.history.end[-1]))
        assert Z * rate + S * rate * math.exp(-rate / 0.3) == pytest.approx(excess + 0.1 * S, rel=1e-12, abs=0.0)


# ---- against every root ---------------------------------------------------------------------------------------------------------

Resistance = Callable[[NDArray[np.float64]], NDArray[np.float64]]


def resistance(law: ss.friction.FrictionLaw, law_slip: float) -> Resistance:
    """g(v) at a law slip, Pa."""
    return lambda v: Z * v + S * law.coefficient(law_slip, v)


def stable_roots(law: ss.friction.FrictionLaw, law_slip: float, load: float) -> list[float]:
    """Rates v >= 0 at which g rises through the load, from a dense scan, each by bisection; stick (0) included."""
    g = resistance(law, law_slip)
    rates = np.concatenate(([1e-14], np.geomspace(1e-9, 20.0, 4000), np.linspace(1e-3, 20.0, 4000)))
    rates.sort()
    below = g(rates) < load
    found = [0.0] if load <= S * float(law.static_coefficient(law_slip)) else []
    for n in np.flatnonzero(below[:-1] & ~below[1:]):
        low, high = rates[n], rates[n + 1]
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if g(middle) < load else (low, middle)
        found.append(float(high))
    return found


def sampled(run: ss.Solution, points: int) -> list[tuple[float, float, float]]:
    """(law slip, |v|, load in the direction of slip) at so many times inside the run."""
    times = np.linspace(0.0, run.history.end[-1], points + 2)[1:-1]
    at = run.history.find(times, "right")
    mode, law = run.history.store.mode[at.piece], run.problem.friction
    walked = run.history.grown(at) * (mode if law.counts == "path" else 1)
    slips = run.problem.law_slip + run.history.store.law_slip[at.piece] + walked
    if law.counts == "net":  # a piece that comes back in a leap over rest knows the load of that phase, but an older slip
        slips = np.where(at.leaped > 0, run.slip(times), slips)
    loads = np.where(mode == 0, np.abs(run.load(times)), mode * run.load(times))
    return list(zip(slips.tolist(), np.abs(run.slip_rate(times)).tolist(), loads.tolist(), strict=True))


@pytest.mark.sampled(every=11)
@pytest.mark.parametrize("driver", [math.inf, 0.5 * Z])
@pytest.mark.parametrize("law", [WAVY, WEAKENING, PRODUCT, FREE, KINKED], ids=["wavy", "weakening", "product", "free", "kinked"])
def test_perfect_delay_keeps_a_stable_root_until_it_ends(law: ss.friction.FrictionLaw, driver: float) -> None:
    """At each time a stable root; jumps under a smooth load only where g turns (or stick ends), and to the next root that way."""
    slab = replace(SLAB, driver_impedance=driver)
    run = ss.simulate(ss.Problem(slab, law, pull_rate=0.1, initial_excess=1e6), 12.0)
    assert run.status.ok
    for law_slip, rate, load in sampled(run, 120):
        assert min(abs(rate - root) for root in stable_roots(law, law_slip, load)) < 1e-9
    folds = run.shocks[run.shocks.cause == "fold"]
    assert len(folds) >= 2 or (law, driver) != (WAVY, math.inf)
    for shock in folds.itertuples():
        sense = math.copysign(1.0, shock.rate_before or shock.rate_after)
        before, after = abs(shock.rate_before), abs(shock.rate_after)
        law_slip, load = float(run.slip(shock.time)), sense * float(run.load(shock.time))
        g = resistance(law, law_slip)
        assert g(np.array(before)) == pytest.approx(load, rel=1e-12, abs=0.0)
        if before > 0.0:
            beyond = before + 1e-3 * math.copysign(1.0, after - before)  # there g has come back from its fold
            assert (float(g(np.array(beyond))) - load) * (after - before) < 0.0
        nearest = [root for root in stable_roots(law, law_slip, load) if (root - before) * (after - before) > 1e-6]
        assert after == pytest.approx(min(nearest, key=lambda root: abs(root - before)), rel=0.0, abs=1e-9)
    energy = run.energy(12.0)
    assert abs(float(energy.balance[0] / energy.heat[0])) < 1e-10


@pytest.mark.parametrize("selection", ["minimal", "maximal", "maxwell"])
def test_only_perfect_delay_follows_folds_that_move(selection: str) -> None:
    """Other rules are refused in one line; with mass, or under a law of the slip rate alone, they are not."""
    problem = ss.Problem(SLAB, WAVY, initial_excess=1e6, selection=selection)
    with pytest.raises(ss.InputError, match=r"^simulate: selection '[^\n]*only perfect-delay is followed there[^\n]*$"):
        ss.simulate(problem, 1.0)
    assert problem.rules == ("perfect-delay",)
    for other in (replace(problem, friction=WAVY.rate), replace(problem, body=replace(SLAB, contact_mass=1e4))):
        assert not replace(other, selection="maxwell").why_not_run
        assert other.rules == ss.selection.SELECTION_RULES


def test_a_step_at_rest_added_to_a_slip_law_changes_where_slip_begins_and_nothing_in_slip() -> None:
    """Slip law + Coulomb slips as the slip law plus the dynamic coefficient does under the same load, to its arrest."""
    weakening = F.LinearSlipWeakening(0.4, 0.2, 0.3)
    stepped = ss.Problem(SLAB, F.SlipPlusRate(slip=weakening, rate=F.Coulomb(0.3, 0.2)), initial_excess=1e5)
    smooth = ss.Problem(SLAB, F.LinearSlipWeakening(0.6, 0.4, 0.3), initial_excess=1e5 + 0.1 * S)
    ours, theirs = (ss.simulate(problem, 5.0) for problem in (stepped, smooth))
    times = np.linspace(0.0, 5.0, 101)
    assert ours.slip(times) == pytest.approx(theirs.slip(times), rel=0.0, abs=1e-11)
    assert ours.catalogue(0.0).end.iloc[0] == pytest.approx(theirs.catalogue(0.0).end.iloc[0], rel=1e-11, abs=0.0)
    assert float(theirs.slip(5.0)) > 1.0
