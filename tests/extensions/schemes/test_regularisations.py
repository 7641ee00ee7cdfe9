"""Regularisations as schemes against theory: the rule that they tend to, the delayed passage of a fold, the answer after a rest."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.extensions.schemes.contract import Scheme
from stickslip.extensions.schemes.regularisations import LAB, Regularisation, with_contact_mass, with_lag
from stickslip.extensions.schemes.run import run_scheme
from stickslip.extensions.schemes.schemes import SETTLES, Schemes, schemes
from stickslip.extensions.schemes.verdict import local_orders
from stickslip.run.reference.folds import HyperbolicFolds, fold_delay

LOOP = ss.load_scenario("fig4-loop")
SECOND = ss.load_scenario("second-event-perfect-delay")
SLAB = SECOND.problem.body
assert isinstance(SLAB, ss.ElasticSlab)
Z, R = SLAB.impedance, SLAB.two_way_time
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)
MESHES = [50 * 4**k for k in range(5)]


def with_direct_effect(problem: ss.Problem, size: float) -> ss.Problem:
    """A regularisation of a user's own: a direct effect beside the lag; both vanish with the size."""
    direct = problem.friction.variation * size / R
    return replace(problem, friction=ss.friction.LaggedFriction(problem.friction, size, direct))


KINDS: dict[str, tuple[str | Scheme, Callable[[ss.Problem, float], ss.Problem]]] = {
    "contact-mass": ("contact-mass", with_contact_mass),
    "lag": ("lag", with_lag),
    "direct-effect": (Regularisation("direct-effect", "a lag and a direct effect", with_direct_effect), with_direct_effect),
}


@pytest.fixture(scope="module", params=[pytest.param("contact-mass", marks=pytest.mark.slow), "lag", "direct-effect"])
def loop(request: pytest.FixtureRequest) -> Schemes:
    """The loop of Fig. 4 under every kind."""
    return schemes(LOOP, scheme=KINDS[request.param][0], cells=MESHES)


def test_every_kind_tends_to_perfect_delay_on_a_loop(loop: Schemes) -> None:
    table = loop.table
    (verdict,) = loop.verdicts.values()
    assert verdict.startswith("perfect-delay")
    assert len(loop.paths.groups()) == 4
    others = [loop.paths.gap(loop.series[-1], rule).slip for rule in ("minimal", "maxwell", "maximal")]
    assert table.slip_error.iloc[-1] < 5e-3 * min(others)
    orders = table.slip_order[1:]
    assert orders.iloc[-2:].between(0.7, 0.9).all()
    assert (orders.diff()[1:] < 0.0).all()  # on its way from 1, out of rest, to 2/3, at the fold
    assert (table.rule.iloc[2:] == "perfect-delay").all()
    assert (table.own_shocks == 0).all()
    assert table.heat_error.abs().iloc[-1] < 1e-3


def test_shocks_are_late_by_the_orders_that_theory_gives(loop: Schemes) -> None:
    """Out of rest under a ramp L ln(1/L), and at a fold L^(2/3)."""
    late = loop.shocks.pivot(index="cells", columns="exact_time", values="delay").to_numpy()
    sizes = loop.table.step.to_numpy()
    assert (late > 0.0).all()
    assert local_orders(sizes, late[:, 0])[-1] == pytest.approx(0.96, abs=0.05)
    assert local_orders(sizes, late[:, 1])[-1] == pytest.approx(2 / 3, abs=0.035)


def test_the_size_is_the_step_of_the_mesh_and_at_courant_number_one_half_a_grids_mass() -> None:
    """Closed form under Coulomb friction: v = v0 (1 - exp(-t/L)), L = dx/(2c), from rest to the first echo."""
    problem = ss.Problem(replace(SLAB), ss.friction.Coulomb(0.8, 0.3), initial_load=81e6)
    series = run_scheme(problem, 5.0, LAB["contact-mass"], 100)
    size = SLAB.thickness / 100 / (2.0 * SLAB.wave_speed)
    assert series.step == pytest.approx(size, rel=1e-9, abs=0.0)
    assert Z * size == pytest.approx(0.5 * SLAB.density * SLAB.thickness / 100, rel=1e-12, abs=0.0)
    fastest = 51e6 / Z
    assert series.rate == pytest.approx(fastest * -np.expm1(-series.time / size), rel=1e-9, abs=1e-9 * fastest)
    assert series.slip[-1] == pytest.approx(fastest * (series.time[-1] - size), rel=1e-9, abs=0.0)
    half = run_scheme(problem, 5.0, LAB["contact-mass"], 100, courant=0.25)
    assert half.rate[1] == pytest.approx(fastest * -np.expm1(-1.0), rel=1e-9, abs=0.0)
    assert half.step == pytest.approx(0.5 * size, rel=1e-9, abs=0.0)


def falls_through(run: ss.Solution, level: float, start: float) -> float:
    """Return the last time (s) after a start at which the slip rate falls through a level (m/s)."""
    breaks = run.breaks[run.breaks >= start]
    time = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * np.linspace(0.0, 1.0, 5)[:-1]).ravel(), breaks[-1])
    step = np.flatnonzero(np.diff((run.slip_rate(time) > level).astype(int)) < 0)[-1]
    return float(brentq(lambda t: float(run.slip_rate(t)) - level, time[step], time[step + 1], xtol=1e-15, rtol=1e-15))


@pytest.mark.parametrize("kind", KINDS)
def test_delay_at_a_fold_is_the_zero_of_the_airy_function(kind: str) -> None:
    """delay / [2.338 (eps^2 / (a b))^(1/3)] tends to 1; what is left goes as eps^(1/3) (ln eps + constant), the next order."""
    fold = HyperbolicFolds(Z, 1e8, 0.8, 0.3, 1.0)
    curvature, load_rate = 2.0 * 0.5e8 / (1.0 + fold.fold_rate) ** 3, Z * 2.6 / (R / 2)
    at = float(ss.simulate(LOOP.problem, LOOP.duration).shocks.time.iloc[1])
    left = []
    for size in (1e-7, 1e-8, 1e-9):
        run = ss.simulate(KINDS[kind][1](LOOP.problem, size), LOOP.duration, rtol=1e-12)
        delay = falls_through(run, 0.5 * fold.fold_rate, at - 0.5) - at
        left.append((delay / fold_delay(Z * size, curvature, load_rate) - 1.0) / size ** (1 / 3))
        assert len(run.history) < 400  # stiff runs stay short
    assert abs(left[-1]) * 1e-3 < 0.0035
    assert left[0] - left[1] == pytest.approx(left[1] - left[2], rel=0.01, abs=0.0)


@pytest.mark.slow
@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(("kind", "nearest"), [("contact-mass", "perfect-delay"), ("lag", "maxwell")])
def test_after_a_rest_the_second_event_follows_no_rule(kind: str, nearest: str) -> None:
    """The layers of the first event come back as spikes of the load, as narrow as the size but not lower: they begin early."""
    found = schemes(replace(SECOND.problem, pull_rate=0.1), 45 * R, kind, [400, 600, 900])
    assert found.verdicts == {kind: SETTLES}
    gaps = {rule: found.paths.gap(found.series[-1], rule).slip for rule in found.exact}
    assert min(gaps, key=lambda rule: gaps[rule]) == nearest
    assert gaps[nearest] > 1.0
    change = found.table.slip_change
    assert change.iloc[-1] < 2e-3
    assert np.log(change.iloc[1] / change.iloc[2]) / np.log(1.5) == pytest.approx(1.0, abs=0.1)
    events = ss.simulate(KINDS[kind][1](replace(SECOND.problem, pull_rate=0.1), 1e-5), 45 * R, shortest_event=0.0).events
    second = events[events.slip > 1.0].iloc[1]
    start, slip = {"contact-mass": (40.0, 20.881), "lag": (38.0, 17.760)}[kind]
    assert second.start / R == pytest.approx(start, abs=1e-3)
    assert second.slip == pytest.approx(slip, abs=1e-3)


def spike_in_the_limit() -> float:
    """Highest load (Pa) in the layers that the first event leaves, whatever the size: time in units of it, by scipy.

    Up: v' = (strength - g(v)) / Z from rest; down, a round trip later: the load is what the way up has left of it.
    """

    def motion(t: float, y: np.ndarray) -> list[float]:
        up, down = y
        load = np.array([8e7, 8e7 - 2.0 * Z * up])
        resistance = Z * y + 1e8 * LAW.coefficient(0.0, np.maximum(y, 0.0))
        return list((load - resistance) / Z * (np.array([True, down > 0.0])))

    start = [1e-8, (1e8 * 0.5 / Z - 1.0)]
    run = solve_ivp(motion, (0.0, 20.0), start, rtol=1e-9, atol=1e-11, max_step=0.01)
    return float((8e7 - 2.0 * Z * (run.y[0] + np.maximum(run.y[1], 0.0))).max())


def test_spikes_of_the_load_do_not_shrink_with_the_size() -> None:
    """Third round trip: load = strength - 2 Z (v going up + v coming down), -0.4 MPa outside the layers."""
    expected = spike_in_the_limit()
    assert expected > 20e6
    for size in (R / 30, R / 480, R / 7680):
        run = ss.simulate(with_contact_mass(replace(SECOND.problem, pull_rate=1e-9), size), 3 * R)
        breaks = run.breaks[run.breaks > 2 * R]
        inside = np.concatenate([breaks[:-1] + share * np.diff(breaks) for share in np.linspace(0.0, 1.0, 41)])
        assert float(run.load(inside).max()) == pytest.approx(expected, rel=1e-7, abs=0.0)


def test_after_312_years_of_rest_every_round_trip_creeps() -> None:
    """The spikes reach the strength then: more round trips than can be counted."""
    run = ss.simulate(with_contact_mass(SECOND.problem, 0.1), SECOND.duration, max_pieces=2000, shortest_event=0.0)
    assert run.history.span[1] == pytest.approx(312.1494 * ss.YEAR, rel=1e-6, abs=0.0)
    assert run.status.name == "too many pieces"


def test_a_run_that_ends_early_is_refused_by_name(monkeypatch: pytest.MonkeyPatch) -> None:
    module = import_module("stickslip.extensions.schemes.regularisations")
    monkeypatch.setattr(module, "simulate", partial(ss.simulate, max_pieces=256))
    with pytest.raises(ss.InputError, match=r"^schemes: contact-mass with 50 cells: its run ends at .* s \(too many pieces\)"):
        schemes(replace(SECOND.problem, pull_rate=0.1), 45 * R, "contact-mass", 50)


@pytest.mark.parametrize(
    ("law", "kind", "message"),
    [
        (ss.friction.SinusoidalSlip(1.0, 0.5, 50.0), "lag", "lag does not suit sinusoidal-slip friction: LaggedFriction: "),
        (ss.friction.Coulomb(0.8, 0.3), "lag", "lag does not suit coulomb friction: LaggedFriction: rate must be a smooth law"),
        (LAW, "contactmass", "there is no scheme 'contactmass'; did you mean 'contact-mass'"),
        (ss.friction.LaggedFriction(LAW, time=0.1), "lag", "lagged friction remembers more than slip"),
    ],
)
def test_what_makes_no_sense_is_refused_in_one_line_before_any_run(law: ss.friction.FrictionLaw, kind: str, message: str) -> None:
    told: list[str] = []
    with pytest.raises(ss.InputError, match=rf"^schemes: {message}") as refused:
        schemes(replace(SECOND.problem, friction=law), 1.0, ["theta", kind], progress=told.append)
    assert "\n" not in str(refused.value)
    assert told == []


def test_an_interrupted_run_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """simulate itself keeps what it has after Ctrl-C; the lab keeps the schemes before it only."""

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(
        import_module("stickslip.extensions.schemes.regularisations"), "simulate", partial(ss.simulate, progress=stop)
    )
    with pytest.raises(KeyboardInterrupt):
        schemes(LOOP.problem, 1.0, "lag")
    found = schemes(LOOP.problem, 1.0, ["theta", "lag"], [20, 40])
    assert found.interrupted
    assert found.table.scheme.tolist() == ["theta", "theta"]


def test_a_start_beyond_zero_slip_counts_from_there() -> None:
    moved = replace(LOOP.problem, initial_slip=0.3)
    here, there = (run_scheme(problem, 4.0, LAB["lag"], 50) for problem in (LOOP.problem, moved))
    assert here.slip == pytest.approx(there.slip, rel=1e-9, abs=1e-12)
    assert here.slip[0] == 0.0
    assert math.isclose(here.time[-1], 4.0, rel_tol=1e-2)
