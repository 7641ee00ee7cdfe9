"""The study against theory: the delayed passage of a fold, orders, and what it must refuse or must not claim."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.foundation.axis import Axis
from stickslip.foundation.errors import InputError
from stickslip.reference.folds import HyperbolicFolds, fold_delay
from stickslip.scenarios.scenario import Scenario
from stickslip.studies.regularisations import KINDS, passage, regularised
from stickslip.studies.regularise import Regularisation, regularise

LOOP = ss.load_scenario("fig4-loop")
SECOND = ss.load_scenario("second-event-perfect-delay")
SLAB = SECOND.problem.body
assert isinstance(SLAB, ss.ElasticSlab)
Z, R = SLAB.impedance, SLAB.two_way_time
LAW = ss.friction.HyperbolicRate(static=0.8, dynamic=0.3, alpha=1.0)


@pytest.fixture(scope="module", params=KINDS)
def loop(request: pytest.FixtureRequest) -> Regularisation:
    """The loop of Fig. 4 by every kind."""
    return regularise(LOOP.problem, LOOP.duration, request.param)


def test_every_kind_tends_to_perfect_delay_on_a_loop(loop: Regularisation) -> None:
    assert loop.verdict.rules == ("perfect-delay",)
    assert loop.stopped == ""
    assert len(loop.groups) == 4
    assert loop.errors("perfect-delay")[-1] < 1e-3 * min(loop.errors(rule)[-1] for rule in ("minimal", "maxwell", "maximal"))
    assert 0.7 < loop.verdict.order.power < 0.9
    assert loop.verdict.order.last < loop.verdict.order.first  # on its way from 1, out of rest, to 2/3, at the fold


def test_jumps_are_late_by_the_orders_that_theory_gives(loop: Regularisation) -> None:
    jumps = loop.jumps
    assert list(jumps.expected) == ["1 (log)", "2/3"]
    assert jumps.order.iloc[0] == pytest.approx(0.96, abs=0.05)
    assert jumps.order.iloc[1] == pytest.approx(2 / 3, abs=0.035)
    assert (loop.delays[1:] > 0.0).all()


def test_the_table_says_what_was_run(loop: Regularisation) -> None:
    table = loop.table
    assert list(table["size"]) == [R / 30 / 4**k for k in range(8)]
    assert list(table.status) == ["finished"] * 8
    assert list(table.mean_perfect_delay) == list(loop.errors("perfect-delay"))
    assert (table.largest_perfect_delay >= table.mean_perfect_delay).all()
    assert (table.end_perfect_delay.abs() <= table.largest_perfect_delay).all()
    assert (table.pieces < 400).all()  # stiff runs stay short
    last = {"contact-mass": ("contact_mass", Z * R), "direct-effect": ("direct", 0.5), "lag": ("size", R)}[loop.by]
    assert table[last[0]].iloc[-1] == pytest.approx(last[1] / 30 / 4**7, rel=1e-12, abs=0.0)


@pytest.mark.parametrize("by", KINDS)
def test_delay_at_a_fold_is_the_zero_of_the_airy_function(by: str) -> None:
    """delay / [2.338 (eps^2 / (a b))^(1/3)] tends to 1; what is left goes as eps^(1/3) (ln eps + constant), the next order."""
    fold = HyperbolicFolds(Z, 1e8, 0.8, 0.3, 1.0)
    curvature, load_rate = 2.0 * 0.5e8 / (1.0 + fold.fold_rate) ** 3, Z * 2.6 / (R / 2)
    at = float(ss.simulate(LOOP.problem, LOOP.duration).shocks.time.iloc[1])
    left = []
    for size in (1e-7, 1e-8, 1e-9):
        run = ss.simulate(regularised(LOOP.problem, by, size), LOOP.duration, rtol=1e-12)
        delay = passage(run, 0.5 * fold.fold_rate, False, at, (at - 0.5, float(run.breaks[-1]))) - at
        left.append((delay / fold_delay(Z * size, curvature, load_rate) - 1.0) / size ** (1 / 3))
    assert abs(left[-1]) * 1e-3 < 0.0035
    assert left[0] - left[1] == pytest.approx(left[1] - left[2], rel=0.01, abs=0.0)


def test_on_the_first_event_all_rules_agree() -> None:
    found = regularise(SECOND.problem, 12.0, "lag")
    assert found.groups == (("perfect-delay", "maxwell", "minimal", "maximal"),)
    assert found.verdict.text.startswith("all rules have the same answer here, and the runs tend to it: order 0.9")


def test_a_regular_contact_is_a_check_of_convergence() -> None:
    regular = replace(SECOND.problem, friction=replace(LAW, alpha=0.1), pull_rate=0.1)
    found = regularise(regular, 20.0, sizes=[R / 30 / 4**k for k in range(4)])
    assert len(found.groups) == 1
    assert found.verdict.order.power == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize(("by", "nearest"), [("contact-mass", "perfect-delay"), ("lag", "maxwell")])
def test_after_a_rest_the_second_event_follows_no_rule(by: str, nearest: str) -> None:
    """The layers of the first event come back as spikes of the load, as narrow as the size but not lower: they begin early."""
    sizes, rules = [1e-3 / 4**k for k in range(5)], ("perfect-delay", "maxwell")
    found = regularise(replace(SECOND.problem, pull_rate=0.1), 45 * R, by, sizes, rules)
    assert found.verdict.rules == ()
    assert found.verdict.text.startswith("no rule: the runs tend to an answer of their own, order 0.9")
    assert found.target == nearest
    assert found.errors(nearest)[-1] > 1.0
    assert found.changes[-1] < 1e-3


def spike_in_the_limit() -> float:
    """Highest load (Pa) in the layers that the first event leaves, whatever the size: time in units of it, by scipy.

    Up: v' = (strength - g(v)) / Z from rest; down, a round trip later: the load is what the way up has left of it.
    """
    integrate = pytest.importorskip("scipy.integrate")

    def motion(t: float, y: np.ndarray) -> list[float]:
        up, down = y
        load = np.array([8e7, 8e7 - 2.0 * Z * up])
        resistance = Z * y + 1e8 * LAW.coefficient(0.0, np.maximum(y, 0.0))
        return list((load - resistance) / Z * (np.array([True, down > 0.0])))

    start = [1e-8, (1e8 * 0.5 / Z - 1.0)]
    run = integrate.solve_ivp(motion, (0.0, 20.0), start, rtol=1e-9, atol=1e-11, max_step=0.01)
    return float((8e7 - 2.0 * Z * (run.y[0] + np.maximum(run.y[1], 0.0))).max())


def test_spikes_of_the_load_do_not_shrink_with_the_size() -> None:
    """Third round trip: load = strength - 2 Z (v going up + v coming down), -0.4 MPa outside the layers."""
    expected = spike_in_the_limit()
    assert expected > 20e6
    for size in (R / 30, R / 480, R / 7680):
        run = ss.simulate(regularised(replace(SECOND.problem, pull_rate=1e-9), "contact-mass", size), 3 * R)
        breaks = run.breaks[run.breaks > 2 * R]
        inside = np.concatenate([breaks[:-1] + share * np.diff(breaks) for share in np.linspace(0.0, 1.0, 41)])
        assert float(run.load(inside).max()) == pytest.approx(expected, rel=1e-7, abs=0.0)


def test_runs_that_end_early_are_said_to() -> None:
    """After 312 years of rest the spikes reach the strength, and every round trip creeps: too many to count."""
    found = regularise(SECOND.problem, SECOND.duration, sizes=[0.1, 0.01, 0.001], max_pieces=2000)
    assert found.until == pytest.approx(312.1494 * ss.YEAR, rel=1e-6, abs=0.0)
    assert "too many pieces" in found.stopped
    assert len(found.groups) == 1


def test_rules_may_be_chosen_and_others_are_not_known() -> None:
    found = regularise(LOOP.problem, LOOP.duration, sizes=[1e-3, 1e-4, 1e-5], rules=("maxwell", "minimal", "maxwell"))
    assert list(found.exact) == ["maxwell", "minimal"]
    assert found.verdict.rules == ()
    with pytest.raises(ss.InputError, match="rule 'maximal' was not asked for"):
        found.errors("maximal")


def test_sizes_may_come_in_any_order() -> None:
    found = regularise(LOOP.problem, 1.0, sizes=[1e-5, 1e-3, 1e-4])
    assert list(found.sizes) == [1e-3, 1e-4, 1e-5]


def test_repr_gives_the_verdict(loop: Regularisation) -> None:
    assert loop.verdict.text in repr(loop)


BAD = [
    ({"body": ss.SpringBlock(2.8e12, 3.43e13, 1e14)}, {}, "a block has inertia"),
    ({"body": replace(SLAB, contact_mass=2.0)}, {}, "a contact_mass of 2 kg/m^2 makes the slip rate unique already"),
    ({"friction": ss.friction.LaggedFriction(LAW, time=0.1)}, {}, "lagged friction has a state of its own"),
    (
        {"friction": ss.friction.SinusoidalSlip(1.0, 0.5, 50.0)},
        {"by": "lag"},
        "a smooth law of slip rate only, sinusoidal-slip",
    ),
    ({"friction": ss.friction.Coulomb(0.8, 0.3)}, {"by": "direct-effect"}, "coulomb is not; try 'contact-mass'"),
    ({}, {"by": "contactmass"}, "no regularisation 'contactmass'; did you mean 'contact-mass'"),
    ({}, {"sizes": [0.1, 0.01]}, "sizes must have 3 to 10000 numbers, got 2"),
    ({}, {"sizes": [0.1, 0.1, 0.01]}, "sizes must be different times, got 0.1 s twice"),
    ({}, {"sizes": [0.1, 0.01, -1.0]}, "sizes[2] must be greater than 0 s, got -1"),
    ({}, {"sizes": [0.1, 0.01, np.nan]}, "sizes[2] must be finite, got nan"),
    ({}, {"rules": ("maxwel",)}, "selection rule 'maxwel' is unknown; did you mean 'maxwell'"),
    ({}, {"rules": ()}, "needs a selection rule to compare with"),
    ({}, {"duration": 0.0}, "duration must be greater than 0 s, got 0"),
    ({}, {"rtol": 1.0}, "rtol must be at most 0.01, got 1"),
]


@pytest.mark.parametrize(("changes", "arguments", "message"), BAD)
def test_what_makes_no_sense_is_refused_in_one_line(changes: dict, arguments: dict, message: str) -> None:
    with pytest.raises(ss.InputError) as refused:
        regularise(replace(SECOND.problem, **changes), **({"duration": 1.0} | arguments))
    assert message in str(refused.value)
    assert "\n" not in str(refused.value)


def test_ctrl_c_gives_no_half_result() -> None:
    def interrupted(text: str) -> None:
        if text.startswith("size"):
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        regularise(LOOP.problem, 1.0, progress=interrupted)


def test_an_interrupted_run_is_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    """simulate itself keeps what it has after Ctrl-C; a study does not use it."""

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(import_module("stickslip.studies.regularise"), "simulate", partial(ss.simulate, progress=stop))
    with pytest.raises(KeyboardInterrupt):
        regularise(LOOP.problem, 1.0)


def test_studies_take_a_scenario_and_its_duration(tmp_path: Path) -> None:
    problem = ss.Problem(ss.ElasticSlab(2800, 3500, 1e4, 1e8), ss.friction.HyperbolicRate(0.8, 0.3, 1.0), initial_excess=1.0)
    file = tmp_path / "one.toml"
    file.write_text(Scenario(problem, 3.0).to_toml())
    options: dict[str, Any] = {"sizes": [1.0, 0.5, 0.25], "rules": ["perfect-delay"], "rtol": 1e-6}
    found = ss.studies.regularise(file, **options)
    assert found.exact["perfect-delay"].duration == 3.0
    assert found.problem == problem
    pushed = ss.studies.ensemble(file, members=1, rtol=1e-6)
    assert (pushed.reference.duration, pushed.reference.problem) == (3.0, problem)
    axes = Axis("body.thickness", 1e4, 2e4, 2), Axis("friction.alpha", 0.5, 1.0, 2)
    assert len(ss.studies.analogy(file, None, *axes, rtol=1e-6).table) == 4
    with pytest.raises(InputError, match="ensemble: duration"):
        ss.studies.ensemble(problem)
