"""Runs of planar slabs whose numbers are no solution end with a status that says so, and keep the frames before that."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar.run import PlanarReport
from stickslip.extensions.planar.solver import functions_of
from stickslip.run import progress
from tests.extensions.planar.patches import LAW, SLAB, patch, state_patch

STATE: dict[str, Any] = {"initial_load": 63e6, "initial_state": 1.0, "pull_rate": 1e-3}
UNEVEN = {"initial.excess": lambda y: np.where(np.abs(y) < 4e3, 2e6, -2e6)}


def contact(law: Any, along: Any = UNEVEN, **start: Any) -> ss.PlanarSlab:
    return ss.PlanarSlab(ss.Problem(SLAB, law, **(start or {"initial_excess": 1e6})), nodes=32, length=2e4, along=along)


def check_end(run: Any, status: str) -> None:
    """The run has this status, says so, and holds what came before."""
    assert run.status.name == status
    assert str(run).startswith(f"{status}: ")
    assert run.times[-1] < 11.0
    assert all(np.isfinite(getattr(run, name)).all() for name in ("slip", "slip_rate", "traction", "heat"))


@pytest.mark.slow
def test_rate_and_state_friction_far_below_the_grid_is_not_finite_and_not_resolved(tmp_path: Path) -> None:
    """The states of some nodes overflow, at which these nodes would seem to rest."""
    run = ss.simulate(state_patch(1e-6), 3.0, frames=16, checkpoint=tmp_path / "run.zarr")
    check_end(run, "not finite")
    assert "NOT resolved" in str(run)
    assert ss.resume(tmp_path / "run.zarr").status.name == ss.open_solution(tmp_path / "run.zarr").status.name == "not finite"


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_anew")
def test_a_search_that_does_not_find_the_slip_rate_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    slab = state_patch()
    found = ss.simulate(slab, 3.0, frames=16)
    assert found.status.ok
    assert found.residual < 1e-13
    monkeypatch.setattr("stickslip.extensions.planar.friction.ITERATIONS", 2)
    functions_of.cache_clear()
    missed = ss.simulate(slab, 3.0, frames=16)
    check_end(missed, "off the law")
    assert missed.residual > 1e-6


@pytest.mark.usefixtures("compiled_anew")
def test_an_unstable_run_is_noticed_before_its_numbers_overflow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("stickslip.extensions.planar.slab.WIDEST_STEP", 10.0)
    run = ss.simulate(patch(nodes=128, length=2e4, courant=2.0), 12.0, frames=100)
    check_end(run, "unstable")
    assert np.abs(run.slip_rate).max() < 1e4


@pytest.mark.parametrize(
    "formula", ["0.6 - 0.05*u + 0.001/(10.5 - u)", pytest.param("0.6 - 0.055*u", marks=pytest.mark.slow)], ids=["pole", "negative"]
)
def test_friction_that_would_drive_slip_ends_the_run(formula: str) -> None:
    """Formulas are looked at up to 10 m of slip; friction falls below zero, or behind a pole, after that."""
    check_end(ss.simulate(contact(ss.friction.FromExpression(formula), {}), 12.0, frames=32), "negative friction")


@pytest.mark.slow
@pytest.mark.parametrize(
    "slab",
    [
        pytest.param(lambda: contact(ss.friction.VelocityStrengthening(0.6, 1e3)), marks=pytest.mark.slow),
        pytest.param(
            lambda: contact(ss.friction.HyperbolicRate(0.8, 0.3, 0.9999 * SLAB.impedance / (0.5 * 1e8))), marks=pytest.mark.slow
        ),
        lambda: contact(LAW, {"initial.load": lambda y: np.where(y < 0.0, 1e50, -1e50)}, initial_load=1e50),
        pytest.param(
            lambda: contact(LAW, {"normal_stress": lambda y: np.where(np.abs(y) < 4e3, 1e3, 1e9)}, initial_load=1e6),
            marks=pytest.mark.slow,
        ),
    ],
    ids=["strengthening", "close to the radiation limit", "loads of 1e50 Pa", "normal stress of 1e3 to 1e9 Pa"],
)
def test_extreme_laws_are_solved(slab: Any) -> None:
    run = ss.simulate(slab(), 12.0, frames=10)
    assert run.status.name == "finished"
    assert run.residual < 1e-9
    assert (run.slip_rate * run.traction >= 0.0).all()


JUMP = 63e6 / SLAB.impedance * 1.0 / 1e-2
"""v theta/Dc at the slip rate that radiation alone would allow."""


@pytest.mark.parametrize(("evolution", "factor"), [("ageing", 1.0 - 1.0 / JUMP), ("slip", math.log(JUMP))])
def test_the_process_zone_of_rate_and_state_friction(evolution: str, factor: float) -> None:
    """Strength falls by b S/Dc per slip, times a factor: 9 pi/16 G Dc/(b S) over the 625 m between nodes."""
    law = ss.friction.RateAndState(reference=0.6, a=0.01, b=0.015, distance=1e-2, evolution=evolution)
    zone = 9.0 * math.pi / 16.0 * SLAB.shear_modulus * 1e-2 / (0.015 * 1e8) / factor
    assert contact(law, {}, **STATE).nodes_per_process_zone(1.0) == pytest.approx(zone / 625.0, rel=1e-3, abs=0.0)


def test_progress_says_how_much_time_and_memory_it_takes(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[PlanarReport] = []
    ss.simulate(patch(nodes=32, length=2e4), 3.0, frames=10, progress=told.append)
    assert str(told[0]) == f"0 of 3 s, needs {told[0].memory / 1e9:.2g} GB"
    assert str(told[-1]._replace(time=1.5, fastest=2.0, pace=0.1, left=15.0)) == (
        "1.5 of 3 s, slips at up to 2 m/s, 0.1 s a second, 15 s left"
    )
    monkeypatch.setattr(progress, "time", SimpleNamespace(monotonic=iter([2.0, 8.0]).__next__))
    pace = progress.Pace()
    assert np.isnan(pace.at(1.0, 0.25)).all()
    assert pace.at(3.0, 0.75) == (2.0 / 6.0, 3.0)  # half of the run in 6 s


MEASURE = """
import sys
import jax
import stickslip as ss
from stickslip.extensions.planar import solver
from tests.extensions.planar.patches import patch

def resident(name):
    return 1024.0 * next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith(name))

slab, duration = patch(**eval(sys.argv[1])), 5.714 * float(sys.argv[2])
jax.numpy.fft.rfft(jax.numpy.zeros(8)).block_until_ready()
before, told = resident("VmRSS"), []
ss.simulate(slab, duration, frames=50, progress=told.append)
print((resident("VmHWM") - before) / told[0].memory)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="reads /proc")
@pytest.mark.parametrize(
    ("grid", "round_trips"),
    [
        ({"nodes": 1024, "length": 4e4}, 4),
        ({"nodes": 4096, "length": 4e4}, 1),
        ({"nodes": 256, "length": 1e5, "width": 1e5, "width_nodes": 256}, 1),
    ],
    ids=str,
)
def test_the_memory_that_is_stated_is_needed(grid: dict[str, Any], round_trips: int) -> None:
    """Peak of resident memory beside that of the libraries, within a factor of 1.5 both ways."""
    given = [sys.executable, "-c", MEASURE, repr(grid), str(round_trips)]
    found = subprocess.run(given, capture_output=True, text=True, check=True)
    assert 1.0 / 1.5 < float(found.stdout) < 1.5


@pytest.mark.slow
def test_friction_that_falls_to_zero_is_not_negative() -> None:
    """Rounding takes it to -2e-37 Pa."""
    assert ss.simulate(contact(ss.friction.ExponentialSlipWeakening(0.7, 0.0, 0.4), {}), 12.0, frames=16).status.ok


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("law", [LAW, ss.friction.HyperbolicRate(0.8, 0.3, 0.1)], ids=["of slip", "of rate"])
def test_a_fault_on_which_nothing_slips_has_an_answer(law: Any, tmp_path: Path) -> None:
    """The strength is 80 MPa or 70 MPa (LAW), the largest load nine tenths of it."""
    strength = float(law.static_coefficient(0.0)) * 1e8
    run = ss.simulate(
        contact(law, {"initial.load": lambda y: strength * np.where(np.abs(y) < 4e3, 0.9, 0.5)}, initial_load=1e6), 3.0
    )
    assert run.status.name == "finished"
    assert not run.slip.any()
    assert str(run) == "\n".join([
        f"No node slips faster than {run.threshold * 1e6:.6g} um/s up to {run.times[-1]:.6g} s.",
        "The node that is closest to slip bears up to 90.000% of its strength.",
    ])  # fmt: skip
    assert np.abs(run.energy().balance).max() < 1.0  # J per metre of z: nothing but rounding, of a load that stores 1e10
    run.plot().savefig(tmp_path / "run.png")
    assert np.isnan(run.rupture_speed).all()
