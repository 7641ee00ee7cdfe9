"""A normal load that varies in time: closed forms, own integrators, jumps of the state, rest, energy, files and refusals.

Times are compared to 1e-9 of a second and slips to 1e-9 of a metre, absolutely, where a closed form is known.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import stickslip as ss
from stickslip.engine.state.layout import SAVED as SET_ASIDE
from stickslip.engine.state.workspace import Run
from stickslip.problem.loading import LoadingHistory, PiecewiseLinear, Sinusoidal, Steps

STATIC, DYNAMIC, FORCE, STIFFNESS, PULL, LOAD = 0.6, 0.4, 10.0, 100.0, 0.05, 5.0
BODY = ss.SpringBlock(mass=1.0, stiffness=STIFFNESS, normal_force=FORCE)
SLAB = ss.ElasticSlab(density=2700.0, wave_speed=3000.0, thickness=3000.0, normal_stress=1e7)


def block(history: object, **more: object) -> ss.Problem:
    """Return a block under Coulomb friction and a normal force that varies."""
    law = ss.friction.Coulomb(static=STATIC, dynamic=DYNAMIC)
    return ss.Problem(BODY, law, pull_rate=PULL, initial_load=LOAD, normal_load=history, **more)  # type: ignore[arg-type]


def first_event(amplitude: float, period: float) -> tuple[float, float, float]:
    """Return start, end and slip of the first event under S = FORCE + amplitude sin(2 pi t / period), by closed forms.

    While the block slips it is a linear oscillator: u = (load + K V t - mu_d S0)/K - mu_d a sin(w t)/(K - m w^2) + A cos + B sin.
    """
    omega, own = 2.0 * math.pi / period, math.sqrt(STIFFNESS)

    def short(t: float) -> float:
        return STATIC * (FORCE + amplitude * math.sin(omega * t)) - LOAD - STIFFNESS * PULL * t

    begin = next(t for t in np.arange(0.0, 5.0, 1e-4) if short(t + 1e-4) < 0.0)
    start = brentq(short, begin, begin + 1e-4, xtol=1e-15)
    driven = DYNAMIC * amplitude / (STIFFNESS - omega**2)

    def forced(t: float) -> float:
        return (LOAD + STIFFNESS * PULL * t - DYNAMIC * FORCE) / STIFFNESS - driven * math.sin(omega * t)

    a = -forced(start)
    b = -(PULL - driven * omega * math.cos(omega * start)) / own

    def rate(t: float) -> float:
        since = t - start
        free = own * (b * math.cos(own * since) - a * math.sin(own * since))
        return PULL - driven * omega * math.cos(omega * t) + free

    later = next(t for t in start + np.arange(1e-3, 5.0, 1e-4) if rate(t + 1e-4) < 0.0)
    end = brentq(rate, later, later + 1e-4, xtol=1e-15)
    return start, end, forced(end) + a * math.cos(own * (end - start)) + b * math.sin(own * (end - start))


@pytest.mark.parametrize(("amplitude", "period"), [(3.0, 0.37), (1.0, 2.0), (6.0, 0.05)])
def test_a_block_under_a_sinusoidal_normal_force_is_an_oscillator_between_closed_form_events(
    amplitude: float, period: float
) -> None:
    event = ss.simulate(block(Sinusoidal(FORCE, amplitude, period)), 2.0).events.iloc[0]
    assert [event.start, event.end, event.slip] == pytest.approx(first_event(amplitude, period), rel=0.0, abs=1e-9)


def test_steps_move_the_strength_at_rest_and_the_drop() -> None:
    """Rests of years are leapt over: the load K V t meets the strength of the present step."""
    year, pull = ss.YEAR, 0.01 / ss.YEAR
    history = Steps([0.0, 3.3 * year, 7.7 * year], [10.0, 6.0, 12.0])
    run = ss.simulate(replace(block(history), pull_rate=pull, initial_load=0.0), 20.0 * year)
    assert run.events.start.to_numpy() / year == pytest.approx([3.6, 6.0, 12.0, 16.8], abs=1e-7)  # a slip takes 1e-8 years
    assert run.events.slip.to_numpy() == pytest.approx([0.024, 0.024, 0.048, 0.048], rel=1e-6)
    assert len(run.history) < 100


def test_a_slab_without_mass_jumps_where_the_normal_stress_steps() -> None:
    law = ss.friction.FromExpression("0.6 + 0.05*log(1 + v/v1)", {"v1": "0.1 m/s"})
    shocks = ss.simulate(
        ss.Problem(SLAB, law, initial_load=6.5e6, normal_load=Steps([0.0, 1.3, 3.7], [1e7, 0.9e7, 1.2e7])), 5.0
    ).shocks
    assert shocks.cause.to_list() == ["start", "loading", "echo", "echo"]
    assert shocks.time.to_numpy() == pytest.approx([0.0, 1.3, 2.0, 3.3], abs=1e-12)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize(
    ("history", "coupling"), [(Sinusoidal(1e6, 2e5, 20.0), 0.3), (PiecewiseLinear([0.0, 10.0], [1e6, 1.3e6]), 0.0)]
)
def test_rate_and_state_follows_an_own_integrator(history: LoadingHistory, coupling: float) -> None:
    """To 1e-7 of the slip and 1e-7 in the logarithm of the state; the integrator's own error is 1e-8."""
    reference, a, b, distance, rate, pull = 0.6, 0.01, 0.008, 1e-4, 1e-6, 1e-5
    law = ss.friction.RateAndState(reference, a, b, distance, rate, normal_stress_coupling=coupling)
    body = ss.SpringBlock(mass=1e3, stiffness=2e7, normal_force=1e6)
    run = ss.simulate(ss.Problem(body, law, pull_rate=pull, normal_load=history), 10.0)
    start, tone, slope = math.log(rate / pull), history.tone, history.segments[0].slope

    def mu(v: float, w: float) -> float:
        return a * math.asinh(v / (2.0 * rate) * math.exp((reference + b * w) / a))

    def change(t: float, y: list[float]) -> list[float]:
        u, v, w = y
        normal = 1e6 + slope * t + tone.amplitude * math.sin(tone.frequency * t)
        grows = slope + tone.amplitude * tone.frequency * math.cos(tone.frequency * t)
        load = 1e6 * mu(pull, start) + 2e7 * (pull * t - u)
        return [v, (load - normal * mu(v, w)) / 1e3, (rate * math.exp(-w) - v) / distance - coupling / b * grows / normal]

    begins = [0.0, pull, start]
    slip, _, w = solve_ivp(change, (0.0, 10.0), begins, method="Radau", rtol=1e-8, atol=[1e-14, 1e-14, 1e-8]).y[:, -1]
    assert float(run.slip(10.0)) == pytest.approx(slip, rel=1e-7)
    assert math.log(rate * float(run.state(10.0)) / distance) == pytest.approx(w, abs=1e-7)


def test_a_step_multiplies_the_state_as_linker_and_dieterich_measured() -> None:
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, "20 um", normal_stress_coupling=0.25)
    body = ss.SpringBlock(mass=1e3, stiffness=1e9, normal_force=1e6)
    history = Steps([0.0, 7.0], [1e6, 1.2e6])
    run = ss.simulate(ss.Problem(body, law, pull_rate="1 um/s", normal_load=history), 10.0)
    before, after = float(run.state(7.0 - 1e-9)), float(run.state(7.0))
    assert after / before == pytest.approx((1e6 / 1.2e6) ** (0.25 / 0.015), rel=1e-6)


def test_a_history_that_does_not_change_is_the_constant_normal_load() -> None:
    for problem in (block(None), ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.8, 0.5, 0.1), initial_load=8.5e6)):
        steady = ss.simulate(problem, 3.0)
        held = ss.simulate(replace(problem, normal_load=Steps([0.0, 1.0], [problem.normal] * 2)), 3.0)
        names = ["start", "slip", "peak_rate"]
        assert held.events[names].to_numpy() == pytest.approx(steady.events[names].to_numpy(), rel=1e-8, abs=1e-9)


def test_scenario_file_and_resumed_run_are_the_same_to_the_bit(tmp_path: Path) -> None:
    from stickslip.problem.scenarios.scenario import Scenario

    scenario = Scenario(block(Sinusoidal("10 N", "3 N", "0.37 s")), 3.0)
    path = tmp_path / "pressed.toml"
    path.write_text(scenario.to_toml(), encoding="utf-8")
    again = ss.load_scenario(str(path))
    assert again.problem == scenario.problem
    whole = ss.simulate(again)
    opened = ss.open_solution(whole.to_netcdf(tmp_path / "run.nc"))
    assert opened.problem == scenario.problem
    assert np.array_equal(opened.history.store.state, whole.history.store.state)
    ss.simulate(again, 1.0, checkpoint=tmp_path / "part.nc")
    assert np.array_equal(ss.resume(tmp_path / "part.nc", 3.0).history.store.rate, whole.history.store.rate)


def test_pressing_a_problem_scales_its_history() -> None:
    from stickslip.problem.parameters import pressed

    harder = pressed(block(Sinusoidal(10.0, 3.0, 0.37)), 20.0)
    assert isinstance(harder.normal_load, Sinusoidal)
    assert (harder.normal, harder.normal_load.mean, harder.normal_load.amplitude, harder.load) == (20.0, 20.0, 6.0, 2.0 * LOAD)


HELD_FORCE = Steps([0.0, 1.0], [10.0, 9.0])
HELD = Steps([0.0, 1.0], [1e7, 9e6])
PLANAR = ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.8, 0.5, 0.1), pull_rate=1e-3, initial_load=7.9e6)
IN_BODY = """normal_force = { kind = "steps", times = [0, 1], values = [10, 9] }"""
IN_PASCAL = ["10 N", "9 Pa"]
IRREGULAR = ss.Problem(SLAB, ss.friction.HyperbolicRate(0.8, 0.3, "10 s/m"), initial_load=8.1e6)
GRADUAL = replace(IRREGULAR, normal_load=Sinusoidal(1e7, 1e6, 3.0), selection="maxwell")


def written(values: object = (10.0, 9.0), *, body: str = "normal_force = 10.0", folder: Path | None = None) -> ss.Scenario:
    """Return the scenario of a block whose normal load steps to the last of some values at 1 s; `body` has its normal force."""
    text = f"""
[body]
kind = "spring-block"
mass = 1.0
stiffness = 100.0
{body}
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.4
[loading.normal_load]
kind = "steps"
{values if isinstance(values, str) else f"times = [0, 1]{chr(10)}values = {list(values)}"}
[initial]
load = 5.0
[run]
duration = 3.0
"""
    path = (folder or Path(tempfile.mkdtemp())) / "pressed.toml"
    path.write_text(text, encoding="utf-8")
    return ss.load_scenario(str(path))


@pytest.mark.parametrize("heading", ["normal_force (kN)", "normal load (kN)"])
def test_a_measured_normal_load_is_read_from_a_file_in_its_unit(tmp_path: Path, heading: str) -> None:
    (tmp_path / "pressed.csv").write_text(f"time (min),{heading}\n0,0.01\n0.5,0.009\n", encoding="utf-8")
    assert written('file = "pressed.csv"', folder=tmp_path).problem.normal_load == Steps([0.0, 30.0], [10.0, 9.0])
    (tmp_path / "pressed.csv").write_text("time (s),normal_stress (Pa)\n0,10\n1,9\n", encoding="utf-8")
    with pytest.raises(ss.InputError, match=r"pressed\.csv', line 1: no column 'normal_force' in the header"):
        written('file = "pressed.csv"', folder=tmp_path)


STRING = ss.load_scenario("drill-string").problem
"""Its bit is pressed by a weight of 97.347 kN, which is a normal torque of 15144.759525 N m."""


@pytest.mark.parametrize(
    "history",
    [
        Steps([0.0, 5.0], ["97.347 kN", "107.0817 kN"]),
        Steps([0.0, 5.0], ["15.1447595 kN m", "16.65923545 kN m"]),
        Steps([0.0, 5.0], [15144.8, 16659.28]),
    ],
    ids=["weight", "torque in kN m", "six digits"],
)
def test_a_weight_on_the_bit_that_varies_is_its_torque_and_need_not_be_given_to_all_digits(history: Steps) -> None:
    exact = Steps([0.0, 5.0], [STRING.normal, 1.1 * STRING.normal])
    expected, run = (ss.simulate(replace(STRING, normal_load=one), 12.0) for one in (exact, history))
    assert run.problem.normal_load is not None
    assert run.problem.normal_load.first == pytest.approx(STRING.normal, rel=1e-15, abs=0.0)
    assert abs(expected.slip(12.0) - ss.simulate(STRING, 12.0).slip(12.0)) > 0.1
    np.testing.assert_allclose(run.slip([4.0, 8.0, 12.0]), expected.slip([4.0, 8.0, 12.0]), rtol=1e-9, atol=0.0)


def test_a_scenario_gives_the_weight_on_the_bit_in_its_unit(tmp_path: Path) -> None:
    text = (Path(ss.__file__).parent / "problem/scenarios/bundled/drill-string.toml").read_text(encoding="utf-8")
    table = '[loading.normal_load]\nkind = "sinusoidal"\nmean = "97.347 kN"\namplitude = "{}"\nperiod = "2 s"\n[initial]'
    path = tmp_path / "weight.toml"
    path.write_text(text.replace("[initial]", table.format("10 kN")), encoding="utf-8")
    pressed = ss.load_scenario(path).problem.normal_load
    assert isinstance(pressed, Sinusoidal)
    assert (pressed.mean, pressed.amplitude) == pytest.approx((STRING.normal, STRING.normal * 10 / 97.347), rel=1e-14, abs=0.0)
    (tmp_path / "weight.csv").write_text("time (s),WOB (kN)\n0,97.347\n5,107.0817\n", encoding="utf-8")
    measured = '[loading.normal_load]\nkind = "steps"\nfile = "weight.csv"\n[initial]'
    path.write_text(text.replace("[initial]", measured), encoding="utf-8")
    found = ss.load_scenario(path).problem.normal_load
    assert isinstance(found, Steps)
    assert found.values == pytest.approx((STRING.normal, 1.1 * STRING.normal), rel=1e-14, abs=0.0)
    (tmp_path / "weight.csv").write_text("time (s),WOB (kN)\n0,97.347\n0,107.0817\n", encoding="utf-8")
    with pytest.raises(ss.InputError, match=r"weight\.csv', line 3: time must ascend"):
        ss.load_scenario(path)
    (tmp_path / "weight.csv").write_text("time (s),height (m)\n0,97.347\n5,107.0817\n", encoding="utf-8")
    with pytest.raises(ss.InputError, match=r"weight\.csv', line 1: no column 'normal_torque' in the header"):
        ss.load_scenario(path)
    path.write_text(text.replace("[initial]", table.format("10 kPa")), encoding="utf-8")
    with pytest.raises(ss.InputError, match=r"\[loading\.normal_load\] must be in N m, as the loads of this body are"):
        ss.load_scenario(path)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (["90 kN", "100 kN"], "begins with 90000 N, but the body's weight_on_bit is 97347 N: make them equal$"),
        ([97347, 1e5], "is 15144.759525 N m: make them equal, or give the weight on bit in N, with its unit$"),
        (["15.14 kN m", "16 kN m"], "begins with 15140 N m, but the body's normal load by its weight_on_bit is 15144.759525 N m"),
        (["97 kPa", "98 kPa"], "normal_load must be in N m, got a history of values in Pa$"),
    ],
)
def test_another_weight_than_that_of_the_body_is_refused(values: list[str], message: str) -> None:
    with pytest.raises(ss.InputError, match=message):
        replace(STRING, normal_load=Steps([0.0, 5.0], values))
    torque = replace(STRING.body, weight_on_bit=None, bit_radius=None, normal_torque=15e3)
    with pytest.raises(ss.InputError, match=r"normal_load must be in N m, got a history of values in N$"):
        replace(STRING, body=torque, normal_load=Steps([0.0, 5.0], ["15 kN", "16 kN"]))


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("pull", [PULL, Steps([0.0, 1.0], [PULL, 0.1])])
def test_check_tells_under_which_load_and_at_which_rate_steady_sliding_is_examined(pull: object) -> None:
    law = ss.friction.RateAndState(0.6, 0.01, 0.015, "1 mm")
    for pressed in (None, Sinusoidal(10.0, 3.0, 0.37)):
        lines = ss.studies.steady(ss.Problem(BODY, law, pull_rate=pull, normal_load=pressed)).lines()  # type: ignore[arg-type]
        first = "under the first normal load, " if pressed else ""
        assert lines[0].startswith(f"{first}at {'' if pull == PULL else 'the first pull rate, '}")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: block(8.0), r"^Problem: normal_load must be a loading history, got 8\.0: a constant one is normal_stress or"),
        (lambda: block("8 N"), r"^Problem: normal_load must be a loading history, got '8 N'"),
        (lambda: block(Steps([0, 1], [8, 9])), r"begins with 8 N, but the body's normal_force is 10 N: make them equal$"),
        (lambda: block(Steps([0, 1], [10, -1])), r"must stay above 0 N, but may fall to -1: the contact would open$"),
        (lambda: block(Sinusoidal("10 N", "11 N", "1 s")), r"must stay above 0 N, but may fall to -1: the contact would open$"),
        (lambda: block(Sinusoidal("10 Pa", "1 Pa", "1 s")), r"^Problem: normal_load must be in N, got a history of values in Pa$"),
        (lambda: ss.simulate(GRADUAL, 2.0), r"^selection 'maxwell': under 11 MPa several slip rates.*changes by steps alone"),
        (lambda: ss.simulate(block(HELD_FORCE), 1.0, shortest_event=1e-9), r"shortest_event must be 0 here"),
        (lambda: ss.simulate(replace(PLANAR, normal_load=HELD), 1.0, creep_rtol=1e-3), r"creep_rtol must be 0 .* and normal load"),
        (lambda: replace(BODY, normal_force=HELD_FORCE), r"^SpringBlock: normal_force is one number.* normal_load of the Problem"),
        (lambda: replace(SLAB, normal_stress=HELD), r"^ElasticSlab: normal_stress is one number.*\[loading\.normal_load\]"),
        (lambda: written(body=IN_BODY), r"toml: \[body\] normal_force is one number, .* a history is \[loading\.normal_load\]$"),
        (lambda: written(IN_PASCAL), r"toml: \[loading\.normal_load\] must be in N, as the loads of this body are$"),
        (lambda: written([10.0, math.nan]), r"\[loading\.normal_load\] values\[1\] must be finite"),
    ],
)  # fmt: skip
def test_what_cannot_be_followed_is_refused_in_one_line(make: object, message: str) -> None:
    with pytest.raises(ss.InputError, match=message) as refused:
        make()  # type: ignore[operator]
    assert "\n" not in str(refused.value)


def test_what_is_set_aside_beside_a_fold_has_room() -> None:
    """A state longer than its room in the scratch space would overwrite what lies behind it."""
    assert Run.places["saved"].size >= SET_ASIDE


def test_check_tells_the_history_and_calls_a_constant_pull_rate_constant(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    from stickslip.cli.main import main
    from stickslip.problem.scenarios.scenario import Scenario

    path = tmp_path / "pressed.toml"
    path.write_text(Scenario(block(Sinusoidal(10.0, 3.0, 0.37)), 3.0).to_toml(), encoding="utf-8")
    with pytest.raises(SystemExit, match=r"^0$"):
        main(["check", str(path)])
    told = capsys.readouterr().out
    assert "normal_load.amplitude" in told
    assert "at first" not in told.split("K V")[1].splitlines()[0]
