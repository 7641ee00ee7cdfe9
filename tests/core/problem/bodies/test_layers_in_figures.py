"""Figures and tables of layers: equal layers are a uniform slab, and a second side is drawn below the contact."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss
from stickslip.figures.runs import inside
from stickslip.solution.observables.energetics import ENERGETICS_COLUMNS
from tests.core.problem.bodies.layers import CASES, DENSITY, NORMAL, SPEED, THICKNESS, layered


@pytest.fixture(autouse=True)
def coarse(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inside, "TIMES", 60)
    monkeypatch.setattr(inside, "CELLS", 20)
    monkeypatch.setattr("stickslip.figures.runs.kinds.layered.ANSWERS.coarser", 1)


def pair(case: str) -> tuple[ss.Solution, ss.Solution]:
    """Runs of a uniform slab and of the same one cut into layers."""
    numbers, rest, duration = CASES[case]
    bodies = ss.ElasticSlab(DENSITY, SPEED, THICKNESS, NORMAL, **numbers), layered(0.2, 0.5, 0.3, **numbers)
    one, other = (ss.simulate(ss.Problem(body, **rest), duration) for body in bodies)
    return one, other


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("case", ["rate law", "contact mass", "fold and dead load"])
def test_the_budget_of_events_is_that_of_a_uniform_slab_and_balances(case: str) -> None:
    """Every column, to 1e-9 of the heat, of the normal stress, or of the column; the balance of the events to 1e-12 of the heat."""
    uniform, of_layers = (run.energetics() for run in pair(case))
    assert len(uniform) == len(of_layers) > 0
    heat = float(uniform.heat.max())
    assert np.abs(of_layers.balance).max() < 1e-12 * heat
    for name in uniform.columns:
        size = {"energy": heat, "load": NORMAL, "1": 1.0}.get(ENERGETICS_COLUMNS[name][0], 0.0)
        assert of_layers[name].to_numpy() == pytest.approx(uniform[name].to_numpy(), rel=1e-8, abs=1e-9 * size, nan_ok=True), name


def test_the_note_on_trapped_waves_is_that_of_a_uniform_slab() -> None:
    uniform, of_layers = pair("rate law")
    assert of_layers.trapped_note == uniform.trapped_note != ""


def test_the_image_of_equal_layers_is_that_of_a_uniform_slab() -> None:
    """Velocities to 1e-9. Stresses too where no front passes; layers are drawn where they meet."""
    uniform, of_layers = (inside.space_time_data(run) for run in pair("rate law"))
    assert of_layers.velocity.values == pytest.approx(uniform.velocity.values, rel=1e-9, abs=1e-9)
    apart = np.abs(of_layers.stress.values - uniform.stress.values) > 1.0
    assert apart.mean() < 0.1
    assert of_layers.attrs["boundaries"] == pytest.approx([0.2 * THICKNESS, 0.7 * THICKNESS], rel=1e-12)


def test_both_sides_of_a_contact_are_drawn() -> None:
    """Steel above, granite below it; the contact in between, where the velocity jumps by the slip rate."""
    run = ss.simulate(ss.load_scenario("steel-on-granite"), "60 us")
    dataset = inside.space_time_data(run)
    assert dataset.attrs["lowest"] == pytest.approx(-0.09, rel=1e-12)
    assert float(dataset.x[0]) < -0.08
    figure = run.plot.field(end=6e-5)
    low, high = figure.axes[0].get_ylim()
    assert (low, high) == pytest.approx((-90.0, 48.0), rel=1e-12)
    assert run.plot.snapshots([1e-5, 3e-5]).axes[0].get_ylim() == (low, high)
