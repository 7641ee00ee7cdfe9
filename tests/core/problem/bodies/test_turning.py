"""A string in torsion and a disc on a torsion spring are the slab and the block with angles for lengths, to the last bit."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.scenarios.scenario import read_scenario
from tests.core.run.reference.method_of_steps import method_of_steps

RPM = math.pi / 30.0
STRING = ss.TorsionalString(1770.0, 7850.0, 61e9, polar_moment=2.28e-5, normal_torque=15e3, inertia=305.0)
DISC = ss.RotatingBlock(305.0, 800.0, 15e3, damping=5.0)
BIT = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate=1.1, exponent=1, viscosity=0.0033)


def sliding(body: ss.TorsionalString | ss.RotatingBlock) -> ss.ElasticSlab | ss.SpringBlock:
    """Return the slab or the block with the same numbers."""
    if isinstance(body, ss.RotatingBlock):
        return ss.SpringBlock(body.inertia, body.stiffness, body.normal_torque, body.damping)
    slab = ss.ElasticSlab(
        density=body.inertia_per_length,
        wave_speed=body.wave_speed,
        thickness=body.length,
        normal_stress=body.normal_load,
        driver_impedance=body.driver_impedance,
        driver_inertia=body.driver_inertia,
        driver_integral_gain=body.driver_integral_gain,
        contact_mass=body.inertia,
    )
    assert (slab.impedance, slab.stiffness) == pytest.approx((body.impedance, body.stiffness), rel=1e-15, abs=0.0)
    return slab


SOFT = replace(STRING, driver_impedance=900.0)
MACHINE = replace(SOFT, driver_inertia=2900.0, driver_integral_gain=500.0)


@pytest.mark.sampled(every=5)
@pytest.mark.parametrize("body", [STRING, replace(STRING, inertia=0.0), SOFT, MACHINE, DISC])
def test_a_body_that_turns_moves_as_one_that_slides_with_the_same_numbers(body: ss.TorsionalString | ss.RotatingBlock) -> None:
    far: dict[str, Any] = {} if body.is_driven_rigidly or body.has_machine else {"far_stress": 13e3}
    turning = ss.Problem(body, BIT, pull_rate=60.0 * RPM, initial_load=0.0, **far)
    run, other = (ss.simulate(replace(turning, body=one), 30.0) for one in (body, sliding(body)))
    assert np.ptp(run.slip([0.0, 30.0])) > 90.0
    assert len(run.history) == len(other.history)
    time = np.linspace(0.0, 30.0, 301)
    some = time[::30]
    assert np.abs(run.slip_rate(time) - other.slip_rate(time)).max() <= 1e-9 * run.slip_rate(time).max()
    assert run.energy(some).heat.values == pytest.approx(other.energy(some).heat.values, rel=1e-9)


def test_a_disc_makes_the_history_of_a_block_bit_for_bit() -> None:
    turning = ss.Problem(DISC, BIT, pull_rate=60.0 * RPM, initial_load=0.0)
    run, other = (ss.simulate(replace(turning, body=one), 30.0) for one in (DISC, sliding(DISC)))
    assert run.slip(run.history.start).tobytes() == other.slip(other.history.start).tobytes()


def test_the_drill_string_agrees_with_an_integrator_by_the_method_of_steps() -> None:
    problem = ss.load_scenario("drill-string").problem
    time = np.linspace(0.0, 6.0, 301)
    ours, theirs = ss.simulate(problem, 6.0).slip(time), method_of_steps(problem, 6.0, rtol=1e-11).slip(time)
    assert np.ptp(theirs) > 10.0
    assert np.abs(ours - theirs).max() <= 1e-7 * np.ptp(theirs)


def test_the_section_follows_from_diameters_and_the_torque_from_weight_and_radius() -> None:
    drawn = ss.load_scenario("drill-string").problem.body
    assert isinstance(drawn, ss.TorsionalString)
    assert drawn.section == pytest.approx(math.pi / 32.0 * (0.146529**4 - 0.123024**4), rel=1e-15)
    assert drawn.normal_load == 97347.0 * 0.155575
    given = replace(drawn, outer_diameter=None, inner_diameter=0.0, polar_moment=drawn.section)
    assert (given.impedance, given.stiffness) == (drawn.impedance, drawn.stiffness)
    assert drawn.impedance == pytest.approx(drawn.section * math.sqrt(7850.0 * 61e9), rel=1e-15)


def test_the_equivalent_block_of_a_string_turns() -> None:
    block = STRING.equivalent_block()
    assert block == ss.RotatingBlock(STRING.inertia_per_length * 1770.0 / 3.0 + 305.0, STRING.stiffness, 15e3)
    with pytest.raises(ss.InputError, match=r"^TorsionalString: equivalent_block needs a rigid driver: .* 900 N m s$"):
        SOFT.equivalent_block()


def test_pressed_harder_the_weight_grows_with_the_torque() -> None:
    problem = ss.Problem(
        replace(STRING, normal_torque=None, weight_on_bit="100 kN", bit_radius="0.1 m"),
        BIT,
        pull_rate="60 rpm",
        initial_load="2 kN m",
    )
    pressed = problem.parameters["pressing"].put(2e4)
    assert isinstance(pressed.body, ss.TorsionalString)
    assert (pressed.normal, pressed.body.weight_on_bit, pressed.load) == (2e4, 2e5, 4e3)


def make(body: object = STRING, law: object = BIT, **given: object) -> Callable[[], object]:
    return lambda: ss.Problem(body, law, **{"pull_rate": 6.0, "initial_load": 0.0} | given)  # type: ignore[arg-type]


SLAB = ss.ElasticSlab(2800, 3500, 1e4, 1e8)
METRES = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate="1 m/s", exponent=1)
TURNS = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate="10 rpm", exponent=1)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (make(pull_rate="1 m/s"), "Problem: pull_rate must be a number in rad/s .*: 'm/s' does not convert to rad/s"),
        (make(SLAB, pull_rate="60 rpm"), "Problem: pull_rate must be a number in m/s .*: 'rpm' does not convert to m/s"),
        (make(pull_rate="1 Hz"), ".*: 'Hz' may be turns or radians per second: write rpm or rad/s"),
        (make(initial_load="5 kPa"), ".*: 'kPa' does not convert to N m"),
        (make(initial_slip="5 mm"), ".*: 'mm' does not convert to rad"),
        (make(law=METRES), r"Problem: friction: ExponentialStribeck has numbers in m or m/s, but .* turns: give them in rad .*"),
        (make(SLAB, TURNS), "Problem: friction: ExponentialStribeck has numbers in rad or rad/s, but .* slides: give them in m .*"),
        (make(law=ss.friction.SlipPlusRate(ss.friction.SinusoidalSlip(0.5, 0.1, "2 /m"), BIT)), ".* has numbers in m or m/s.*"),
        (make(pull_rate=ss.loading.Steps([0.0, 1.0], ["1 m/s", "2 m/s"])), ".* must be in rad/s, got a history of values in m/s"),
        (lambda: replace(STRING, outer_diameter=0.1), "TorsionalString: give either outer_diameter, .*, or polar_moment"),
        (lambda: replace(STRING, polar_moment=None), "TorsionalString: give either outer_diameter, .*, or polar_moment"),
        (
            lambda: replace(STRING, polar_moment=None, outer_diameter=0.1, inner_diameter=0.1),
            "TorsionalString: inner_diameter must be below .*",
        ),
        (lambda: replace(STRING, weight_on_bit=1e5), "TorsionalString: give either normal_torque, or weight_on_bit and bit_radius"),
        (lambda: replace(STRING, normal_torque=None, bit_radius=0.1), "TorsionalString: give either normal_torque, or .*"),
        (lambda: replace(STRING, inertia=-1.0), "TorsionalString: inertia must be at least 0 kg m\\^2, got -1"),
        (lambda: replace(DISC, inertia="3 kg"), "RotatingBlock: inertia must be .*: 'kg' does not convert to kg m\\^2"),
    ],
)
def test_numbers_of_the_wrong_kind_are_refused_in_one_line(made: Callable[[], object], message: str) -> None:
    with pytest.raises(ss.InputError, match=rf"^{message}(; what varies in time .*)?$") as error:
        made()
    assert "\n" not in str(error.value)


def test_laws_take_angles_and_plain_numbers() -> None:
    assert TURNS.rate == pytest.approx(10.0 * RPM, rel=1e-15)
    assert (TURNS.slips_in, METRES.slips_in, BIT.slips_in) == ("rad", "m", "")
    formula = ss.friction.FromExpression("0.5 + 0.3/(1 + v/v1)", values={"v1": "10 rpm"})
    assert formula.slips_in == "rad"
    problem = ss.Problem(STRING, TURNS, pull_rate="60 rpm", initial_load="1 kN m", initial_slip="90 deg")
    assert problem.pull_rate == pytest.approx(60.0 * RPM, rel=1e-15)
    assert "rate='10 rpm'" in repr(problem)
    assert [problem.parameters[name].unit for name in ("rate", "viscosity", "initial.slip")] == ["rad/s", "s/rad", "rad"]


def test_a_scenario_says_rpm_and_is_written_and_read_back(tmp_path: Path) -> None:
    scenario = ss.load_scenario("drill-string")
    assert read_scenario(scenario.to_toml(), "again") == scenario
    with pytest.raises(ss.InputError, match=r"^bad: \[friction\] rate must be .*: 'm/s' does not convert to rad/s$"):
        read_scenario(scenario.source.replace("1.1111 rad/s", "1 m/s"), "bad")
    with pytest.raises(ss.InputError, match=r"^bad: \[loading\] pull_rate must be .*: 'm/s' does not convert to rad/s.*$"):
        read_scenario(scenario.source.replace("60 rpm", "1 m/s"), "bad")
    run = ss.open_solution(ss.simulate(scenario.problem, 5.0).to_netcdf(tmp_path / "run.nc"))
    assert isinstance(run, ss.Solution)
    assert run.problem == scenario.problem


def test_files_of_a_scenario_hold_rpm_for_what_turns_and_not_for_what_slides(tmp_path: Path) -> None:
    (tmp_path / "mu.csv").write_text("bit speed (rpm),mu\n0,0.8\n30,0.6\n60,0.5\n", encoding="utf-8")
    (tmp_path / "drive.csv").write_text("time (s),drive speed (rpm)\n0,20\n10,40\n", encoding="utf-8")
    rest = '[friction]\nkind = "piecewise-linear-rate"\nfile = "mu.csv"\n[loading.pull_rate]\nkind = "piecewise-linear"\n'
    rest += 'file = "drive.csv"\n[initial]\nload = 0.0\n[run]\nduration = "10 s"\n'
    disc = f'[body]\nkind = "rotating-block"\ninertia = 1.0\nstiffness = 100\nnormal_torque = 10\n{rest}'
    problem = read_scenario(disc, "disc", folder=tmp_path).problem
    assert isinstance(problem.friction, ss.friction.PiecewiseLinearRate)
    assert problem.friction.rates == pytest.approx([0.0, math.pi, 2.0 * math.pi], rel=1e-15)
    assert problem.pull_rate_at([0.0, 10.0]) == pytest.approx([20.0 * RPM, 40.0 * RPM], rel=1e-15)
    block = f'[body]\nkind = "spring-block"\nmass = 1.0\nstiffness = 100\nnormal_force = 10\n{rest}'
    with pytest.raises(ss.InputError, match=r"^block: \[friction\] file: 'mu.csv', line 1: .*$"):
        read_scenario(block, "block", folder=tmp_path)


BUNDLED = "drill-string"


def test_sentences_on_steady_sliding_speak_of_rates_of_rotation() -> None:
    found = ss.studies.steady(BUNDLED, from_rest=False)
    assert str(found).startswith("At 60 rpm, traction 7.9023 kN m: stable")
    assert "m/s" not in str(found)
    shown = repr((found.slidings, found.changes))
    assert "rate='60 rpm', traction='7.9023 kN m'" in shown
    assert "m/s" not in shown
    massless = ss.Problem(replace(STRING, inertia=0.0), BIT, pull_rate="60 rpm", initial_load=0.0)
    contact = ss.uniqueness(massless)
    assert not re.search(r" k?Pa\b|m/s", f"{contact} {contact!r} {contact.branches!r}")
    falling = ss.friction.HyperbolicRate(0.8, 0.5, alpha="2 s/rad")
    several = ss.uniqueness(replace(massless, friction=falling))
    assert not re.search(r"Pa\b|m/s", f"{several} {several!r}")
    assert several.regime == "irregular"
    for part in (*several.folds, *several.jumps, *several.branches, several.loop):
        assert not re.search(r"Pa\b|m/s", repr(part)), part
        assert re.search(r"\d (k?N m|rad/s|rpm)", repr(part)), part


@pytest.mark.parametrize(("heaviest", "irregular"), [(1.05, False), (1.3, True)])
def test_a_heavier_weight_is_a_torque_in_proportion(heaviest: float, irregular: bool) -> None:
    """A string without mass under a law that falls by Z at 1.2 times its normal torque: several slip rates beyond that."""
    weight, radius = 97e3, 0.15
    string = replace(STRING, normal_torque=None, weight_on_bit=weight, bit_radius=radius, inertia=0.0)
    alpha = string.impedance / (1.2 * weight * radius) / 0.3
    law = ss.friction.HyperbolicRate(static=0.8, dynamic=0.5, alpha=f"{alpha} s/rad")
    heavier = ss.loading.PiecewiseLinear([0.0, 1.0], [weight * radius, heaviest * weight * radius])
    problem = ss.Problem(string, law, pull_rate="60 rpm", initial_load=0.0, normal_load=heavier)
    assert ss.simulate(problem, 1.0).status.ok
    other = replace(problem, selection="maximal")
    if irregular:
        with pytest.raises(ss.InputError, match=r"normal_load|selection"):
            ss.simulate(other, 1.0)
    else:
        assert ss.simulate(other, 1.0).status.ok
