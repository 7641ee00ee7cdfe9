"""Sweeps of a soil column: a batch follows no damper, so that a damped member of one would not be damped."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import stickslip as ss

COLUMN = ss.SoilColumn(density=1900.0, wave_speed=160.0, thickness=20.0, normal_stress=359955.0)
PROBLEM = ss.Problem(COLUMN, ss.friction.Coulomb(0.3715, 0.3), pull_rate=0.0, initial_load=133000.0, far_stress=140000.0)


def test_members_of_other_damping_are_run_one_by_one_as_alone() -> None:
    ratios = [0.0, 0.1]
    swept = ss.sweep(PROBLEM, {"body.damping_ratio": ratios}, duration=2.0, quantities=["slip"])
    alone = [float(ss.simulate(replace(PROBLEM, body=replace(COLUMN, damping_ratio=ratio)), 2.0).slip(2.0)) for ratio in ratios]
    assert alone[0] != alone[1]
    assert np.allclose(swept.slip, alone, rtol=1e-9, atol=0.0)


def test_members_of_other_thickness_are_run_as_alone() -> None:
    heights = [15.0, 25.0]
    swept = ss.sweep(PROBLEM, {"body.thickness": heights}, duration=2.0, quantities=["slip"])
    alone = [float(ss.simulate(replace(PROBLEM, body=replace(COLUMN, thickness=height)), 2.0).slip(2.0)) for height in heights]
    assert np.allclose(swept.slip, alone, rtol=1e-9, atol=0.0)
