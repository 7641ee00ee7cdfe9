"""A table has the numbers of the run in the unit of its heading, for every kind of body."""

from __future__ import annotations

import pytest

import stickslip as ss
from stickslip.extensions.sweeps.results.layout import table_of
from tests.core.solution.exports.every_kind import run_of


@pytest.mark.parametrize("kind", ["block", "string"])
def test_table_and_store_of_a_sweep(kind: str) -> None:
    run = run_of(kind)
    wanted = ("slip", "peak_rate", "first_slip", "first_static_drop")
    found = ss.sweep(run.scenario(), {"friction.dynamic": [run.problem.friction.dynamic]}, quantities=wanted)
    table = table_of(found)
    expected = {
        f"slip ({run.problem.unit_of('slip')})": float(run.slip()) - run.problem.initial_slip,
        f"peak_rate ({run.problem.unit_of('slip')}/s)": run.events.peak_rate.max(),
        f"first_slip ({run.problem.unit_of('slip')})": run.events.slip[0],
        f"first_static_drop ({run.problem.load_unit})": run.events.static_drop[0],
    }
    for heading, value in expected.items():
        assert table[heading][0] == pytest.approx(value, rel=1e-6, abs=0.0), heading
