"""Sweeps in several threads, beside runs and checks."""

from __future__ import annotations

from pathlib import Path
from uuid import uuid4

import pytest

from tests.core.engine.at_once import SETTING, python

AT_ONCE = """
from stickslip.run.check.examine import examine
scenario = ss.load_scenario("fig6-slab")
kinds = (
    lambda: slip(problem(0)),
    lambda: float(ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0]}, quantities=["slip"]).slip[0]),
    lambda: str(examine(scenario)),
    lambda: float(ss.simulate("fig6-slab").events.slip.iloc[0]),
)
found = at_once(lambda n: kinds[n % 4](), 8)
assert found[:4] == found[4:], found
"""


@pytest.mark.slow
def test_runs_sweeps_and_checks_at_once() -> None:
    python(SETTING + AT_ONCE, uuid4().hex)


@pytest.mark.slow
def test_runs_sweeps_and_checks_begin_with_an_empty_cache(tmp_path: Path) -> None:
    python(SETTING + AT_ONCE, uuid4().hex, STICKSLIP_CACHE_DIR=str(tmp_path))
