"""A table has the numbers of the run in the unit of its heading, for every kind of body."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import stickslip as ss
from tests.core.solution.exports.every_kind import KINDS, parts, run_of


@pytest.mark.sampled(every=3)
@pytest.mark.parametrize("kind", KINDS)
def test_table_of_a_comparison(kind: str, tmp_path: Path) -> None:
    run, other = run_of(kind), run_of("slab")
    found = ss.studies.compare(run, other, names=["it", "slab"])
    file = found.to_csv(tmp_path / "a.csv")
    said = dict(
        parts(line[2:].split(":")[0]) for line in file.read_text(encoding="utf-8").splitlines() if re.match(r"# \w+ \(.*\): ", line)
    )
    row = pd.read_csv(file, comment="#").iloc[0]
    slip = run.problem.unit_of("slip")
    time = np.linspace(0.0, run.duration, 4001)
    moved = run.slip(time) - run.problem.initial_slip
    for name, expected, si in (
        ("end_slip", float(run.slip(run.duration)), slip),
        ("displacement", moved[np.abs(moved).argmax()], slip),
    ):
        assert si in said[name].split(" or ")
        assert row[name] == pytest.approx(expected, rel=1e-4, abs=0.0), name
    assert abs(row.displacement) >= np.abs(moved).max() * (1.0 - 1e-12)
    assert row.load_unit == run.problem.load_unit
