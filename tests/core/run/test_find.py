"""Edges along one parameter: against an independent integration, against closed forms, and what is refused."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from scipy.integrate import solve_ivp

import stickslip as ss
from stickslip.engine.history.slip_events import share_sticking
from stickslip.figures.contact import steady
from tests.core.figures.legible import has_unit, labels
from tests.messages import refused

BODY = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=5.0)
STRIBECK = ss.friction.FromExpression("0.3 + 0.2*exp(-v/v1)", {"v1": "50 mm/s"})
AXIS = ss.Problem(BODY, STRIBECK, pull_rate=0.05, initial_load=0.0)


def stops_again(pull: float) -> bool:
    """Whether the block, released at its strength, comes to rest again: then each cycle is like the first. By scipy."""

    def derivative(_: float, y: Any) -> list[float]:
        stretch, rate = y
        friction = 10.0 * (0.3 + 0.2 * math.exp(-max(rate, 0.0) / 0.05))
        return [pull - rate, 1e3 * stretch - 5.0 * rate - friction]

    def at_rest(_: float, y: Any) -> float:
        return float(y[1])

    at_rest.terminal, at_rest.direction = True, -1.0  # type: ignore[attr-defined]
    begin = [5.0 / 1e3 + 1e-6 * pull, 1e3 * pull * 0.5e-12]  # 1 us after the release
    return bool(solve_ivp(derivative, (0.0, 2.0), begin, events=at_rest, rtol=1e-11, atol=1e-14).t_events[0].size)


def test_the_edge_of_stick_slip_from_rest_is_that_of_an_independent_integration():
    """Hysteresis: from rest it sticks up to 0.155 m/s, while steady sliding is stable from 0.104 m/s on."""
    edge = ss.studies.find(AXIS, duration=20.0)
    assert (edge.at_low, edge.at_high) == (True, False)
    assert edge.high - edge.low <= 1e-3 * edge.high
    assert stops_again(edge.low)
    assert not stops_again(edge.high)
    assert ss.studies.steady(AXIS).changes[0].pull_rate < 0.7 * edge.low
    assert edge.runs == len(edge.table) == len(set(edge.table["loading.pull_rate"]))


def test_runs_that_are_short_are_made_longer_until_the_edge_holds():
    """The scenario of the drill string lasts 60 s, in which stick-slip from rest has not died out where it dies out in the end."""
    rpm = math.pi / 30.0
    edge, problem = ss.studies.find("drill-string", within=3e-3), ss.load_scenario("drill-string").problem
    long = [ss.simulate(replace(problem, pull_rate=rate), "480 s") for rate in (edge.low, edge.high)]
    assert [share_sticking(run.history) > 0.0 for run in long] == [True, False]
    assert edge.duration > 60.0
    assert f"runs of {2.0 * edge.duration:g} s give the same at both ends (runs of 60 s were short: 124." in edge.text
    short = ss.studies.find("drill-string", low="115 rpm", high="130 rpm", duration="60 s")
    assert short.low > edge.high + 1.5 * rpm
    assert short.duration == 60.0
    assert "runs of 60 s are short: at 124." in short.text
    assert short.text.endswith("those of 120 s give something else; leave the duration out, or give a longer one")


def test_what_grows_with_the_duration_is_not_asked_of_longer_runs():
    edge = ss.studies.find(AXIS, "initial.load", "1 N", "4.9 N", what="events", duration=0.5, within=0.1)
    assert edge.longer == ""


def test_steady_finds_by_itself_that_it_sticks_from_rest_where_sliding_is_stable():
    """An independent integration: it sticks at the lower rate and not at the upper one, within 2 % of each other."""
    found = ss.studies.steady(AXIS)
    rest = found.from_rest
    assert rest is not None
    assert rest.sticks_at is not None
    assert rest.slides_at is not None
    assert stops_again(rest.sticks_at)
    assert not stops_again(rest.slides_at)
    assert rest.slides_at - rest.sticks_at <= 0.02 * rest.slides_at
    assert "stable above (proven by interval arithmetic); from rest it sticks up to 15" in str(found)
    assert ss.studies.steady(AXIS, from_rest=False).from_rest is None


def test_a_start_in_steady_sliding_makes_no_difference_to_what_happens_from_rest():
    steady = replace(AXIS, initial_load=None, initial_rate="steady")
    assert ss.studies.steady(steady).from_rest == ss.studies.steady(AXIS).from_rest


def test_a_block_that_is_pulled_backwards_sticks_up_to_the_same_rate():
    forwards, backwards = ss.studies.steady(AXIS).from_rest, ss.studies.steady(replace(AXIS, pull_rate=-0.05)).from_rest
    assert backwards == forwards


def test_without_hysteresis_one_run_tells():
    """10 N * 0.1 * 2 v/(1 + v^2)^2 = 0.5 N s/m at v = 1 m/s: stable above. The law is flat near rest: it slides there, too."""
    law = ss.friction.FromExpression("0.5 - 0.1*v**2/(v**2 + w**2)", {"w": "1 m/s"})
    heavy = ss.Problem(replace(BODY, damping=0.5), law, pull_rate=0.02, initial_load=0.0)
    found = ss.studies.steady(heavy)
    assert found.from_rest is not None
    assert found.from_rest.sticks_at is None
    assert found.from_rest.slides_at == pytest.approx(1.02, rel=1e-9, abs=0.0)
    assert found.from_rest.runs == 1
    assert "from rest it slides at" in str(found)


def test_runs_from_rest_have_a_limit(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys.modules["stickslip.run.find"], "MOST_PIECES", 10)
    assert "from rest: not known, because a run did not reach its end" in str(ss.studies.steady(AXIS))


RISES = ss.friction.FromExpression("0.3 + 0.3*exp(-v/v1) + 0.001*v/v1", {"v1": "1 m/s"})
SLOW = ss.ElasticSlab(density=2800, wave_speed=50, thickness=143, normal_stress="1.43 MPa")
"""A slab in which waves run at 50 m/s; it sticks from rest up to more than that, though sliding is stable from 5.7 m/s on."""


def test_the_search_from_rest_ends_where_a_body_would_slide_as_fast_as_its_waves():
    problem = ss.Problem(SLOW, RISES, pull_rate=0.5, initial_load=0.0)
    rest = ss.studies.steady(problem).from_rest
    assert rest is not None
    assert (rest.sticks_at, rest.slides_at, rest.fastest) == (50.0, None, 50.0)
    assert f"from rest it sticks at every rate that was tried, up to 50 m/s, as fast as its waves run (by {rest.runs} exact" in str(
        rest
    )
    with refused("find: at both loading.pull_rate = 5.1"):
        ss.studies.find(problem, duration=rest.duration)
    slower = replace(problem, body=replace(SLOW, density=28_000, wave_speed=5))
    assert str(ss.studies.steady(slower).from_rest) == "from rest: not examined, because waves run at 5 m/s only"


@pytest.mark.parametrize(
    ("body", "fastest"),
    [
        (SLOW, 50.0),
        (ss.TwoSlabs([1.0], [2.0], [30.0], [1.0, 1.0], [2.0, 2.0], [40.0, 20.0], 1.0), 20.0),
        (ss.TorsionalString(1e3, 8000.0, 8e10, 0.2, normal_torque=1.0), 31_622.7766),
        (ss.TorsionalString(1e3, 8000.0, 8e10, polar_moment=math.pi / 32.0 * 0.2**4, normal_torque=1.0), 31_622.7766),
        (ss.SectionedString([10.0, 10.0], [0.2, 0.4], [0.0, 0.0], [8000.0] * 2, [8e10] * 2, normal_torque=1.0), 15_811.3883),
        (BODY, math.inf),
    ],
)
def test_the_fastest_rate_is_that_at_which_the_surface_moves_as_fast_as_waves(body: Any, fastest: float):
    assert body.fastest_rate == pytest.approx(fastest, rel=1e-8, abs=0.0)


@pytest.mark.parametrize(
    ("limit", "said"),
    [
        (
            1800,
            "sticks at 106 mm/s and slides at 212 mm/s (by 2 exact runs of 21.1 s); at 0.15 m/s it is not known",
        ),
        (5000, "sticks up to 155 mm/s (to 2 %, by 8 exact runs of 21.1 s)"),
    ],
)
def test_what_is_not_known_from_rest_is_said_between_two_runs(limit: int, said: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys.modules["stickslip.run.find"], "MOST_PIECES", limit)
    assert f"from rest it {said}" in str(ss.studies.steady(AXIS))


def test_what_is_not_known_from_rest_is_said_beyond_the_last_run(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys.modules["stickslip.run.find"], "MOST_PIECES", 55_000)
    rest = ss.studies.steady(ss.Problem(SLOW, RISES, pull_rate=0.5, initial_load=0.0)).from_rest
    assert rest is not None
    assert rest.stopped_at == pytest.approx(2.0 * rest.sticks_at, rel=1e-12, abs=0.0)
    assert str(rest).startswith("from rest it still sticks at 11.6 m/s (by 2 exact runs of ")
    assert str(rest).endswith("; at 23.3 m/s it is not known, because a run met its limit before its end")


def test_each_range_of_stability_has_its_two_ends():
    """Friction 0.3/(1 + v^2) + v/1e4 falls from 1/6000 m/s to 18.13 m/s, by hand: 0.6 v = (1 + v^2)^2/1e4."""
    law = ss.friction.FromExpression("0.3/(1 + v**2/w**2) + 0.0001*v/w", {"w": "1 m/s"})
    found = ss.studies.steady(ss.Problem(replace(BODY, damping=0.0), law, pull_rate=0.5, initial_load=0.0), from_rest=False)
    low, high = (float(f"{one.rate:.9g}") for one in found.changes)
    for rate in (low, high):
        assert 0.6 * rate == pytest.approx((1.0 + rate**2) ** 2 / 1e4, rel=1e-7, abs=0.0)
    ranges = f"stable below a pull rate of {low} m/s, unstable from {low} m/s to {high} m/s, stable above {high} m/s"
    assert ranges in str(found.lines()[-1])


def test_an_edge_and_steady_sliding_are_drawn(tmp_path: Path):
    edge = ss.studies.find(AXIS, "pull_rate", 0.05, 0.4, duration=5.0, within=0.3)
    drawn = edge.to_dataset()
    assert drawn.bracket.values.tolist() == [edge.low, edge.high]
    assert drawn.given.values.tolist() == edge.table.sticking.astype(float).tolist()
    found = ss.studies.steady(AXIS)
    curve = steady.steady_data(found)
    at = int(np.argmin(np.abs(curve.slip_rate.values - found.changes[0].rate)))
    assert curve.stable.values[at:].all()
    assert not curve.stable.values[:at].any()
    np.testing.assert_allclose(curve.traction, 10.0 * (0.3 + 0.2 * np.exp(-curve.slip_rate / 0.05)), rtol=1e-14, atol=0.0)
    for figure in (edge.plot(), found.plot()):
        assert all(has_unit(text) or text == "sticking" for text in labels(figure))
        pyplot.close(figure)
    still = ss.Problem(BODY, STRIBECK, initial_load=0.0)
    with pytest.raises(ss.InputError, match="plot: no steady sliding: nothing pulls"):
        ss.studies.steady(still).plot()


def test_sliding_that_only_ages_make_unstable_brings_no_event():
    """The paper's slab under a law that is flat at small rates: a disturbance grows at 7e-27 /s, and nothing will come of it."""
    law = ss.friction.FromExpression("fw + (f0 - fw)/(1 + (v/vw)**4)**0.25", {"f0": 0.8, "fw": 0.3, "vw": "1 m/s"})
    slab = ss.ElasticSlab(density=2800, wave_speed=3500, thickness=1e4, normal_stress=1e8)
    slow = ss.Problem(slab, law, pull_rate=0.05 / ss.YEAR, initial_excess=0.0)
    assert "Slides steadily at the driver's rate: no event will come." in str(ss.studies.steady(slow))
    assert "no event will come" not in str(ss.studies.steady(replace(slow, pull_rate=0.5)))
    run = ss.simulate(slow, "1 year")
    assert "it slides steadily at the driver's rate: no event will come" in run.creep_note
    assert len(run.events) == 0


def test_the_load_at_which_slip_begins_is_the_strength():
    """S mu(0) = 5 N; a block that is not pulled has one event above it and none below, to 1e-6."""
    rest = ss.Problem(BODY, STRIBECK, initial_load=4.0)
    edge = ss.studies.find(rest, "initial.load", "4 N", "6 N", what="events", duration=1.0, within=1e-6)
    assert edge.low <= 5.0 <= edge.high
    assert edge.high - edge.low < 6e-6
    assert (edge.at_low, edge.at_high) == (0, 1)


def test_a_function_may_say_what_to_look_for_and_ends_may_be_negative():
    edge = ss.studies.find(AXIS, "initial.slip", -1.0, 2.0, what=lambda run: run.problem.initial_slip > 0.3, duration=1e-3)
    assert edge.low <= 0.3 <= edge.high


def test_sticking_of_coulomb_friction_is_what_its_cycle_says():
    """A cycle lasts 2 (muS - muD) S/(K V) at rest and about half a period in slip, in the limit of slow pull: to 2 %."""
    body = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0)
    problem = ss.Problem(body, ss.friction.Coulomb(0.5, 0.4), pull_rate=1e-3, initial_load=5.0)
    rest, slip = 2 * 0.1 * 10.0 / (1e3 * 1e-3), math.pi * math.sqrt(1.0 / 1e3)
    assert share_sticking(ss.simulate(problem, 300.0).history) == pytest.approx(rest / (rest + slip), rel=0.02)


def test_a_law_that_never_rests_sticks_where_it_is_slow_against_its_mean():
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, 1e-5, 1e-6)
    block = ss.SpringBlock(1.0, 1e8, 1e6)  # a fifth of the critical stiffness
    kicked = ss.Problem(block, law, pull_rate=1e-4, initial_rate=2e-4)
    steady = ss.Problem(ss.SpringBlock(1.0, 1e9, 1e6), law, pull_rate=1e-4, initial_rate=2e-4)
    assert share_sticking(ss.simulate(kicked, 10.0).history) > 0.5
    assert share_sticking(ss.simulate(steady, 10.0).history) == 0.0


def test_a_start_in_steady_sliding_is_no_start_of_a_search():
    """Only rounding disturbs it: runs of 50 s and of 200 s found 7.2 (nothing) and 7.54 mm/s. The edge is that from rest, to 5 %.

    Independent: runs from rest, with the state written as a number, on both sides of the bracket.
    """
    law = ss.friction.RateAndState(reference=0.6, a=0.008, b=0.012, distance=5e-6)
    body = ss.SpringBlock(mass=1.0, stiffness=1e3, normal_force=10.0, damping=5.0)
    steady = ss.Problem(body, law, pull_rate=1e-6)
    edge = ss.studies.find(steady, "pull_rate", 8e-3, 16e-3, duration=20.0, within=0.05)
    assert edge.low > 1.2 * abs(ss.studies.steady(steady).changes[-1].pull_rate)
    for rate, sticks in ((edge.low, True), (edge.high, False)):
        run = ss.simulate(replace(steady, pull_rate=rate, initial_load=0.0, initial_state=5e-6 / rate), 20.0)
        late = run.slip_rate(np.linspace(10.0, 20.0, 4001))
        assert (late.min() < 0.01 * rate) == sticks
    assert "which start without load, in the state of steady sliding" in edge.text


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"along": "pull_rate", "low": 0.3, "high": 0.4}, "at both loading.pull_rate = 0.3 m/s and 0.4 m/s it is sticking: no"),
        ({"what": "stickin"}, "what: 'stickin' is unknown; did you mean 'sticking'?"),
        ({"along": "pul_rate", "low": 0.1, "high": 0.2}, "did you mean"),
        ({"along": "body.mass"}, "give two values of body.mass between which to look"),
        ({"low": 0.1, "high": 0.1}, "the two ends of loading.pull_rate must differ"),
        ({"within": 0.0}, "within must lie between 0 and 1"),
        ({"along": "run.selection", "low": 0.0, "high": 1.0}, "no number that could be halved"),
        ({"low": 0.1, "high": 0.2, "what": lambda run: 0.5}, "what must be True, False or a whole number, got 0.5"),
        ({"along": "body.damping", "low": "1 kg", "high": 2.0}, "body.damping must be a number in N s/m"),
    ],
)
def test_what_cannot_be_found_is_refused_in_one_line(given: dict[str, Any], message: str):
    with refused(message, begins="find: "):
        ss.studies.find(AXIS, **({"duration": 5.0} | given))


def test_an_edge_tells_and_saves_its_runs(tmp_path: Path):
    edge = ss.studies.find(AXIS, "pull_rate", 0.05, 0.4, duration=5.0, within=0.3)
    assert repr(edge).startswith("stickslip Edge\n  between loading.pull_rate = ")
    assert "(sticking: yes below, no above), by" in edge.text
    lines = edge.to_csv(tmp_path / "edge.csv").read_text().splitlines()
    assert f"# {edge.text}" in lines
    rows = [line for line in lines if not line.startswith("#")]
    assert rows[0] == "loading.pull_rate,sticking"
    assert len(rows) == 1 + edge.runs
    assert np.isfinite(edge.table["loading.pull_rate"]).all()
