"""A load cell behind the spring of a block measures what the driver feels, a dashpot beside the spring among it."""

from __future__ import annotations

import math

import numpy as np
import pytest

import stickslip as ss
from stickslip.extensions.inference.fit.model import measured
from stickslip.problem.loading import Sinusoidal
from tests.core.problem.loading.on_dashpot import BLOCK, DASHPOT, LAW, STIFFNESS

SINE = Sinusoidal(0.1, 0.3, 1.7, 0.4)


def test_a_load_cell_behind_the_spring_measures_what_the_driver_feels() -> None:
    run = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=SINE, initial_load=4.0), 5.0)
    times = np.linspace(0.0, 5.0, 77)
    way = 0.1 * times + 0.3 * 1.7 / (2.0 * math.pi) * (math.cos(0.4) - np.cos(2.0 * math.pi / 1.7 * times + 0.4))
    spring = 4.0 - DASHPOT * SINE.first + STIFFNESS * (way - run.slip(times))
    force = spring + DASHPOT * (SINE.at(times) - run.slip_rate(times))
    assert measured(run, "shear", "spring", times) == pytest.approx(force, rel=1e-11)
