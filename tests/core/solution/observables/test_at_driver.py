"""What is measured at the driver: by characteristics, in closed form, as the field there, and by the work done there."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.problem.bodies.uniform.string import polar_moment_of

RPM = math.pi / 30.0
PIPE: dict[str, Any] = {"density": 7850.0, "shear_modulus": 79.3e9, "outer_diameter": 0.127, "inner_diameter": 0.10861}
STRING = ss.TorsionalString(1500.0, **PIPE, normal_torque=15e3, inertia=200.0)
SECTIONS = ss.SectionedString([180.0, 1500.0], [0.165, 0.127], [0.0714, 0.10861], [7850.0] * 2, [79.3e9] * 2, normal_torque=15e3)
BIT = ss.friction.ExponentialStribeck(static=0.8, dynamic=0.5, rate=1.1, exponent=1, viscosity=0.0033)
SOFT: dict[str, Any] = {"driver_impedance": 900.0}
MACHINE: dict[str, Any] = SOFT | {"driver_inertia": 2900.0, "driver_integral_gain": 500.0}
DRIVES = {"rigid": {}, "lossy": SOFT, "machine": MACHINE}
SLAB = ss.ElasticSlab(2700.0, 3000.0, 3000.0, 50e6, driver_impedance=5e6)
LAYERS = ss.LayeredSlab([500.0, 1000.0], [2700.0, 2500.0], [3000.0, 1500.0], 50e6, drag=[200.0, 0.0])
TWO = ss.TwoSlabs([500.0], [2700.0], [3000.0], [800.0], [2500.0], [2000.0], 50e6)


def run_of(body: Any, duration: float = 25.0, **more: Any) -> ss.Solution:
    """Return a run of a string from rest."""
    return ss.simulate(ss.Problem(body, BIT, pull_rate=60.0 * RPM, initial_load=0.0, **more), duration)


def characteristics(body: ss.TorsionalString, pull: float, duration: float, cells: int) -> tuple[Any, Any, Any]:
    """Return times, rate and torque at the drive by the method of characteristics, for a bit that resists with 0.3 + 0.02 v.

    The body has no inertia at the bit. The drive is integrated by the trapezoidal rule.
    """
    step, z, normal = body.length / body.wave_speed / cells, body.impedance, body.normal_load
    kp, ki, heavy = body.driver_impedance, body.driver_integral_gain, body.driver_inertia
    sheared = z * pull * np.linspace(0.0, 1.0, cells + 1)
    away, back = sheared.copy(), sheared.copy()  # Z v - T and Z v + T at the nodes from bit to drive
    rate, lag, faster = pull, 0.0, 0.0
    found = [(0.0, rate, 0.0)]
    for n in range(1, round(duration / step) + 1):
        away[1:], back[:-1] = away[:-1].copy(), back[1:].copy()
        slip = max(0.0, (back[0] - 0.3 * normal) / (z + 0.02 * normal))
        away[0] = 2.0 * z * slip - back[0]
        # J dv/dt = kp (V - v) + ki lag - (Z v - away), d lag/dt = V - v
        half = 0.5 * step
        known = heavy * rate + half * faster + half * (kp * pull + away[-1] + ki * (lag + half * (pull - rate) + half * pull))
        rate = known / (heavy + half * (kp + z + ki * half))
        lag += half * (pull - found[-1][1]) + half * (pull - rate)
        faster = kp * (pull - rate) + ki * lag - (z * rate - away[-1])
        torque = z * rate - away[-1]
        back[-1] = z * rate + torque
        found.append((n * step, rate, torque))
    return tuple(np.array(found).T)


def test_rate_and_torque_at_a_machine_are_those_of_the_method_of_characteristics() -> None:
    body = replace(STRING, inertia=0.0, **MACHINE)
    law = ss.friction.FromExpression("0.3 + 0.02*v")
    run = ss.simulate(ss.Problem(body, law, pull_rate=6.0, initial_load=0.0), 12.0)
    apart = []
    for cells in (150, 300):
        time, rate, torque = characteristics(body, 6.0, 11.9, cells)
        apart.append(
            (
                np.abs(run.drive_rate(time) - rate).max() / np.ptp(rate),
                np.abs(run.surface_torque(time) - torque).max() / np.ptp(torque),
            )
        )
    assert np.ptp(run.slip_rate(np.linspace(0.0, 12.0, 200))) > 3.0
    assert np.all(np.array(apart[1]) < 5e-5)
    assert np.all(np.array(apart[1]) < 0.4 * np.array(apart[0]))  # what is left is the step of the other method


@pytest.mark.parametrize(
    ("body", "drive"),
    [
        (STRING, "machine"),
        (SECTIONS, "lossy"),
        *(
            pytest.param(body, drive, marks=pytest.mark.slow)
            for body, drive in ((STRING, "rigid"), (STRING, "lossy"), (SECTIONS, "rigid"), (SECTIONS, "machine"))
        ),
    ],
)
def test_the_torque_at_the_drive_does_the_work_that_the_energies_have(body: Any, drive: str) -> None:
    run = run_of(replace(body, inertia=200.0, **DRIVES[drive]), 8.0)
    time = np.linspace(0.0, 8.0, 2001)
    rate, torque = run.drive_rate(time), run.surface_torque(time)
    own = 0.5 * run.problem.body.driver_inertia * float(rate[-1] ** 2 - rate[0] ** 2)  # of the machine, not of the string
    assert np.trapezoid(rate * torque, time) == pytest.approx(float(run.energy([8.0]).work[0]) - own, rel=3e-5)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize(
    "body",
    [
        *(replace(STRING, **MACHINE), replace(SECTIONS, **SOFT), SLAB, TWO, replace(LAYERS, driver_impedance=3e6)),
        *(
            pytest.param(body, marks=pytest.mark.slow)
            for body in (
                *(STRING, replace(STRING, **SOFT), SECTIONS, replace(SECTIONS, **MACHINE)),
                *(LAYERS, replace(TWO, sides="joined")),
            )
        ),
    ],
)
def test_what_is_at_the_driver_is_the_field_at_the_far_face(body: Any, side: Any) -> None:
    turns = body.load_unit == "N m"
    problem = ss.Problem(body, BIT, pull_rate=60.0 * RPM if turns else 0.02, initial_load=0.0 if turns else 0.79 * 50e6)
    run = ss.simulate(problem, 8.0)
    far = sum(body.thickness) if isinstance(body, ss.TwoSlabs) else body.distance
    time = np.linspace(0.0, 8.0, 150)[1:-1]
    field = run.field(far, time, side)
    assert run.drive_rate(time, side) == pytest.approx(field.velocity, rel=1e-9, abs=1e-9 * np.abs(field.velocity).max())
    assert run.drive_traction(time, side) == pytest.approx(field.stress, rel=1e-9, abs=1e-9 * np.abs(field.stress).max())
    assert np.ptp(run.drive_traction(time)) > 0.0


def test_in_steady_turning_the_drive_bears_the_torque_of_the_bit_and_of_the_drag_of_each_section() -> None:
    drag = [5.0, 0.8]  # N s: a metre resists with drag times the rate
    body = replace(SECTIONS, drag=drag, inertia=300.0)
    law = ss.friction.FromExpression("0.3 + 0.02*v")
    run = ss.simulate(ss.Problem(body, law, pull_rate=6.0, initial_rate="steady"), 20.0)
    torque = 15e3 * (0.3 + 0.02 * 6.0) + 6.0 * (180.0 * drag[0] + 1500.0 * drag[1])
    assert run.surface_torque([5.0, 20.0]) == pytest.approx([torque] * 2, rel=1e-6)
    assert run.drive_rate(20.0) == pytest.approx(6.0, rel=1e-12)


def test_while_the_bit_rests_a_rigid_drive_winds_the_string_up() -> None:
    run = run_of(STRING)
    time = np.array([0.5, 1.0, 1.5])
    stiffness = 79.3e9 * polar_moment_of(0.127, 0.10861) / 1500.0
    assert run.slip(1.5) == 0.0
    assert run.surface_torque(time) == pytest.approx(stiffness * 60.0 * RPM * time, rel=1e-12)


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("drive", ["lossy", "machine"])
def test_a_drive_obeys_its_own_equation(drive: str) -> None:
    body = replace(STRING, **DRIVES[drive])
    run, pull = run_of(body, 15.0), 60.0 * RPM
    time = np.linspace(0.0, 15.0, 20_001)
    rate, torque = run.drive_rate(time), run.surface_torque(time)
    lag = pull - rate
    lagged = np.append(0.0, np.cumsum(0.5 * (lag[1:] + lag[:-1]) * np.diff(time)))
    motor = body.driver_impedance * lag + body.driver_integral_gain * lagged
    gained = body.driver_inertia * (rate - rate[0])
    pushed = np.append(0.0, np.cumsum(0.5 * ((motor - torque)[1:] + (motor - torque)[:-1]) * np.diff(time)))
    if drive == "lossy":
        assert motor == pytest.approx(torque, rel=1e-9, abs=1e-9 * torque.max())
    assert gained == pytest.approx(pushed, abs=3e-6 * torque.max() * 15.0)


def test_a_jump_of_the_pull_rate_has_two_sides_at_a_rigid_driver() -> None:
    run = run_of(STRING, 10.0)
    stepped = replace(run.problem, pull_rate=ss.loading.Steps([0.0, 4.0], [6.0, 3.0]))
    run = ss.simulate(stepped, 10.0)
    assert run.drive_rate([3.9, 4.0, 4.1]) == pytest.approx([6.0, 3.0, 3.0], rel=1e-12)
    assert run.drive_rate(4.0, "left") == pytest.approx(6.0, rel=1e-12)
    jump = float(run.surface_torque(4.0) - run.surface_torque(4.0, "left"))
    assert jump == pytest.approx(-3.0 * STRING.impedance, rel=1e-9)  # a change of rate sends out a wave of Z dv


def test_the_driver_of_a_block_bears_the_force_of_its_spring() -> None:
    block = ss.SpringBlock(mass=2.0, stiffness=1e3, normal_force=10.0, damping=1.0)
    run = ss.simulate(ss.Problem(block, BIT, pull_rate=0.05, initial_load=0.0), 5.0)
    time = np.linspace(0.0, 5.0, 101)
    assert run.drive_traction(time) == pytest.approx(1e3 * (0.05 * time - run.slip(time)), abs=1e-6)
    assert np.all(run.drive_rate(time) == 0.05)
    with pytest.raises(ss.InputError, match="a SpringBlock does not turn; the load at its driver is drive_traction"):
        run.surface_torque(1.0)


def test_a_window_and_a_file_have_what_the_run_has_at_its_drive(tmp_path: Path) -> None:
    run = run_of(replace(STRING, **MACHINE))
    window = run.window(1)
    begin = float(run.events.start[1])
    assert window.surface_torque([-0.5, 0.5]) == pytest.approx(run.surface_torque([begin - 0.5, begin + 0.5]), rel=1e-9)
    import xarray as xr

    with xr.open_dataset(run.to_netcdf(tmp_path / "run.nc")) as kept:
        time = kept.drive_time.values
        assert kept.surface_torque.values == pytest.approx(run.surface_torque(time), rel=1e-12)
        assert kept.drive_rate.values == pytest.approx(run.drive_rate(time), rel=1e-12)
        assert (kept.surface_torque.units, kept.drive_rate.units) == ("N m", "rad s-1")
    made = run.to_dataset([1.0, 2.0])
    assert made.surface_torque.values == pytest.approx(run.surface_torque([1.0, 2.0]), rel=1e-12)


def test_a_curve_of_the_drive_has_both_limits_where_a_front_of_the_bit_arrives() -> None:
    run = run_of(replace(STRING, inertia=0.0))
    time, torque = run.curve("surface_torque", 0.0, 15.0)
    shock = float(run.shocks.time[0]) + STRING.length / STRING.wave_speed
    at = np.flatnonzero(np.abs(time - shock) < 1e-9)
    assert len(at) >= 2
    sizes = torque[at[0]], torque[at[-1]]
    assert abs(sizes[1] - sizes[0]) > 100.0
    assert sizes == pytest.approx((float(run.surface_torque(shock, "left")), float(run.surface_torque(shock))), rel=1e-9)


def test_times_outside_the_run_are_refused_at_the_driver_too() -> None:
    run = run_of(STRING, 5.0)
    with pytest.raises(ss.InputError, match="times must lie between 0 and the end of the run"):
        run.surface_torque(6.0)
    with pytest.raises(ss.InputError, match="side must be"):
        run.drive_rate(1.0, "up")  # type: ignore[arg-type]
