"""Sweeps over the stiffness of a spring that may be none, and over a force."""

from __future__ import annotations

import numpy as np
import pytest

import stickslip as ss

DRY = ss.friction.Coulomb(0.6, 0.4)
FREE = ss.SpringBlock(2.0, 0.0, 20.0)
SPRUNG = ss.SpringBlock(2.0, 30.0, 20.0)


def test_a_sweep_over_a_stiffness_begins_with_none() -> None:
    start = ss.Problem(SPRUNG, DRY, initial_load=13.0)
    found = ss.sweep(start, {"body.stiffness": [0.0, 1e-12, 30.0]}, quantities=["slip"], duration=2.0).slip.to_numpy()
    assert found[0] == pytest.approx(0.5 * 2.5 * 4.0, rel=1e-13)
    assert found[1] == pytest.approx(found[0], rel=1e-9)
    assert np.isfinite(found).all()
    forces = ss.sweep(ss.Problem(FREE, DRY, force=13.0), {"loading.force": [11.0, 13.0, 15.0]}, quantities=["slip"], duration=2.0)
    assert forces.slip.to_numpy() == pytest.approx([0.0, 5.0, 7.0], rel=1e-13)
