"""Compiled code is kept on disk: parameters are data, so another scenario of the same kind compiles nothing."""

from __future__ import annotations

import subprocess
import sys

from stickslip.evolution.compiled import CACHE

SCRIPT = """
import stickslip as ss
slab = ss.ElasticSlab({density}, 3500, {thickness}, 1e8)
law = ss.friction.HyperbolicRate(0.8, {dynamic}, {alpha})
print(len(ss.simulate(ss.Problem(slab, law, pull_rate={pull}, initial_excess=0.0), {duration}).shocks))
"""


def run(**values: float) -> str:
    return subprocess.run([sys.executable, "-c", SCRIPT.format(**values)], capture_output=True, text=True, check=True).stdout


def test_second_scenario_compiles_nothing() -> None:
    first = {"density": 2800, "thickness": 1e4, "dynamic": 0.3, "alpha": 1.0, "pull": 1e-9, "duration": 20}
    assert run(**first) == "2\n"
    before = {path: path.stat().st_mtime_ns for path in CACHE.rglob("*") if path.is_file()}
    assert len(before) > 5
    second = {"density": 2500, "thickness": 3e3, "dynamic": 0.35, "alpha": 2.0, "pull": 1e-3, "duration": 9}
    assert run(**second) != ""
    assert {path: path.stat().st_mtime_ns for path in CACHE.rglob("*") if path.is_file()} == before
