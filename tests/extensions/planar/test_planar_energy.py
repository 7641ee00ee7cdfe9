"""The energy of a planar run: against the engine in 1D, against the volume method that solves the problem itself, its balance."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.planar import solver
from stickslip.extensions.planar.energy import NAMES
from stickslip.extensions.planar.friction import ContactOfNodes
from stickslip.extensions.planar.memory import MemoryRecurrence
from stickslip.extensions.planar.solution import PlanarSolution
from tests.extensions.planar.patches import LAW, SLAB, patch
from tests.extensions.planar.planar_methods import FrictionalVolume, LawAtNodes, PlanarCase

DRIVERS: dict[str, dict[str, Any]] = {
    "rigid": {"pull_rate": 2.0},
    "half-space": {"pull_rate": 1.0, "far_stress": 20e6, "far_stress_rate": 1e6},
    "dead load": {},
}
IMPEDANCES = {"rigid": math.inf, "half-space": 2e7, "dead load": 0.0}


def missed(run: PlanarSolution) -> float:
    """The largest error of the balance, as a share of the heat."""
    found = run.energy()
    return float(np.abs(found.balance).max() / found.heat[-1])


SLOW = pytest.mark.slow


@pytest.mark.slow
@pytest.mark.parametrize("driver", ["half-space", *(pytest.param(one, marks=SLOW) for one in ("rigid", "dead load"))])
def test_a_uniform_contact_has_the_energies_of_the_slab_in_1d(driver: str) -> None:
    """Each of them to 5e-3 of the heat, over 2.5 round trips. The steps are those of the distance of 31 m between nodes."""
    slab = replace(SLAB, driver_impedance=IMPEDANCES[driver])
    problem = ss.Problem(slab, LAW, initial_excess=5e6, **DRIVERS[driver])
    exact = ss.simulate(problem, 2.5 * SLAB.two_way_time)
    run = ss.simulate(ss.PlanarSlab(problem, nodes=8, length=250.0), 2.5 * SLAB.two_way_time, frames=640)
    times = np.linspace(0.1, 14.0, 20)
    found, wanted = run.energy(times), exact.energy(times)
    heat = float(wanted.heat[-1])
    for name in NAMES:
        assert np.abs(found[name] / 250.0 - wanted[name]).max() < 5e-3 * heat, name
    assert missed(run) < 5e-3
    assert (float(found.radiated[-1]) > 0.1 * 250.0 * heat) == (driver == "half-space")


@pytest.mark.sampled(every=2)
@pytest.mark.parametrize("impedance", [math.inf, 0.5 * SLAB.impedance])
def test_energies_are_those_of_the_volume_method_which_solves_the_problem_itself(impedance: float) -> None:
    """The load of the nucleus exceeds that of its surroundings; slab and driver to 1 % of the heat at the end, with 128 nodes."""
    slab = replace(SLAB, driver_impedance=impedance)
    like = patch(nodes=128, length=2e4)
    contact = replace(like, problem=ss.Problem(slab, LAW, initial_load=60e6), along=like.along)
    run = ss.simulate(contact, 7.0)
    friction = LawAtNodes(LAW, np.full(128, 1e8))
    case = PlanarCase(2800.0, 3500.0, 1e4, (2e4,), contact.values.load, friction, contact.locked, driver_impedance=impedance)
    volume = FrictionalVolume(case, 256, 7.1)
    while volume.time < 7.0:
        volume.advance()
    kinetic, elastic, beyond = volume.energies()
    found, heat = run.energy([volume.time - 0.5 * volume.step_of_time]), volume.heat
    assert float(found.heat[0]) == pytest.approx(heat, rel=1e-2)
    assert float(found.kinetic[0]) == pytest.approx(kinetic, abs=1e-2 * heat)
    assert float(found.radiated[0]) == pytest.approx(beyond, abs=1e-2 * heat)
    # there the initial stress does no work at the driver
    assert float((found.elastic - found.work - found.radiated)[0]) == pytest.approx(elastic, abs=1e-2 * heat)


@pytest.mark.slow
def test_the_balance_closes_with_the_grid() -> None:
    """Below 0.3 % of the heat with 64 nodes and below 0.1 % with 256."""
    coarse, fine = (ss.simulate(patch(nodes=nodes, length=2e4), 8.0, frames=2 * nodes) for nodes in (64, 256))
    assert missed(coarse) < 3e-3
    assert missed(fine) < 1e-3
    assert "the energy balance misses up to 0.2% of that" in str(coarse)


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_anew")
def test_a_wrong_memory_of_the_half_space_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Waves along the contact that are half as strong again: four times the error of the right ones."""
    right = solver.recurrence

    def wrong(*given: Any) -> MemoryRecurrence:
        return MemoryRecurrence(*(part if name == "decay" else 1.5 * part for name, part in right(*given)._asdict().items()))

    monkeypatch.setattr(solver, "recurrence", wrong)
    assert missed(ss.simulate(patch(nodes=64, length=2e4), 8.0)) > 1e-2


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_anew")
def test_a_wrong_echo_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Under a dead load: a driver that reflects 0.9 of the waves, and one that reflects all wavenumbers as it does the mean."""
    right = solver.echo_of
    like = patch(nodes=64, length=2e4)
    contact = replace(like, problem=ss.Problem(replace(SLAB, driver_impedance=0.0), LAW, initial_load=60e6), along=like.along)
    assert missed(ss.simulate(contact, 9.0)) < 3e-3
    for wrong in (
        lambda sent, echo, spectra, reflection: right(sent, echo, spectra, 0.9 * reflection),
        lambda sent, echo, spectra, reflection: (reflection * sent, echo),
    ):
        monkeypatch.setattr(solver, "echo_of", wrong)
        solver.functions_of.cache_clear()
        assert missed(ss.simulate(contact, 9.0)) > 1e-2


@pytest.mark.slow
@pytest.mark.usefixtures("compiled_anew")
def test_a_wrong_law_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Slip rates under friction that is 1 % higher than that of the law miss the contact equation, which every step checks."""
    right = ContactOfNodes.rate

    def wrong(self: ContactOfNodes, nodes: Any, load: Any, *others: Any) -> Any:
        return right(self, nodes._replace(normal=1.01 * nodes.normal), load, *others)

    monkeypatch.setattr(ContactOfNodes, "rate", wrong)
    assert ss.simulate(patch(nodes=64, length=2e4), 8.0).status.name == "off the law"


def test_energies_outside_the_run_are_refused() -> None:
    with pytest.raises(ss.InputError, match="times must be from 0 to"):
        ss.simulate(patch(nodes=32, length=2e4), 1.0).energy([0.0, 2.0])


def test_a_run_of_one_step_has_energies() -> None:
    run = ss.simulate(patch(nodes=32, length=2e4), 1e-3)
    assert len(run.times) == 2
    assert float(run.energy().heat[-1]) > 0.0
    assert "energy" not in str(run)
