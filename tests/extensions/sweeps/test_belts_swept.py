"""Sweeps over how a belt moves under a block."""

from __future__ import annotations

from pathlib import Path

import stickslip as ss
from stickslip.problem.loading import Sinusoidal
from tests.core.problem.loading.belts import BLOCK, LAW, SCENARIO


def test_a_sweep_over_how_the_belt_swings_is_its_runs(tmp_path: Path) -> None:
    file = tmp_path / "belt.toml"
    file.write_text(SCENARIO)
    amplitudes, periods = [0.0, 0.12], [0.4, 0.5]
    swept = ss.sweep(file, {"loading.pull_rate.amplitude": amplitudes, "loading.pull_rate.period": periods}, progress=False)
    for i, amplitude in enumerate(amplitudes):
        for k, period in enumerate(periods):
            one = ss.simulate(ss.Problem(BLOCK, LAW, pull_rate=Sinusoidal(0.3, amplitude, period, 0.4), initial_load=0.0), 4.0)
            assert float(swept.slip[i, k]) == float(one.slip(4.0))
