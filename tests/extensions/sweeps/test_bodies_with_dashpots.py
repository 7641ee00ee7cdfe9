"""A body whose damping is not its impedance is solved rightly in a batch, and refused by name where it has no kind of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.sweeps.batch.run import run_members
from stickslip.problem.scenarios.scenario import Scenario
from tests.core.problem.bodies.dashpot import OWN, PROBLEM, SLAB


def test_members_of_a_batch_are_single_runs() -> None:
    batch = run_members(Scenario(PROBLEM, 5.0), {"friction.dynamic": np.array([0.4, 0.5])}, ["slip"]).results
    runs = [ss.simulate(ss.Problem(SLAB, ss.friction.Coulomb(0.8, mu), initial_excess=1e6), 5.0) for mu in (0.4, 0.5)]
    assert batch["slip"] == pytest.approx([float(run.slip(5.0)) for run in runs], rel=1e-12, abs=0.0)


def test_sweeps_do_not_take_it_for_the_body_whose_kind_it_has() -> None:
    with pytest.raises(ss.InputError, match=r"\[body\] kind 'SlabWithDashpot' is unknown"):
        ss.sweep(replace(PROBLEM, body=OWN), {"friction.dynamic": [0.4, 0.5]}, duration=5.0)


def test_a_sweep_over_dashpots_is_single_runs() -> None:
    """Slip and what the dashpot takes, within 1e-12: (Z + D) v = drop + excess for the first round trip, and then echoes."""
    dashpots = [0.0, 1e6, 4.9e6, 3e7]
    swept = ss.sweep(PROBLEM, {"body.contact_damping": dashpots}, duration=20.0, quantities=["slip", "damped"])
    runs = [ss.simulate(replace(PROBLEM, body=replace(SLAB, contact_damping=one)), 20.0) for one in dashpots]
    assert np.asarray(swept["slip"]) == pytest.approx([float(run.slip(20.0)) for run in runs], rel=1e-12, abs=0.0)
    assert np.asarray(swept["damped"]) == pytest.approx([float(run.energetics().damped.sum()) for run in runs], rel=1e-12, abs=0.0)
    assert len({float(one) for one in swept["slip"]}) == len(dashpots)
