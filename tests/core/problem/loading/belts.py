"""A block on a belt, under Coulomb friction, in Python and as a scenario."""

from __future__ import annotations

import stickslip as ss
from tests.core.problem.loading.belt_by_scipy import MASS, STIFFNESS

FORCE = 12.0
"""N."""
BLOCK = ss.SpringBlock(MASS, STIFFNESS, FORCE).on_belt()
LAW = ss.friction.Coulomb(static=0.6, dynamic=0.4)
SCENARIO = """
title = "A box on a belt"
[body]
kind = "block-on-belt"
mass = "2 kg"
stiffness = "150 N/m"
normal_force = "12 N"
[friction]
kind = "coulomb"
static = 0.6
dynamic = 0.4
[loading.pull_rate]
kind = "sinusoidal"
mean = "0.3 m/s"
amplitude = "12 cm/s"
period = "0.5 s"
phase = 0.4
[initial]
load = 0
[run]
duration = "4 s"
"""
