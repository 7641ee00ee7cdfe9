"""Four times as many members take no more memory than their numbers."""

from __future__ import annotations

import subprocess
import sys

CODE = """
from dataclasses import replace
import numpy as np
from pathlib import Path
from stickslip.batch import run_members
from tests.batch.cases import CASES

def resident():
    return int(Path("/proc/self/statm").read_text().split()[1]) * 4096

def run(members):
    scenario = replace(CASES["rate"].scenario, duration=11.4)
    run_members(scenario, {"friction.alpha": np.linspace(0.9, 1.1, members)}, ("slip", "events"), threads=2)
    return resident()

run(10_000), run(100_000)
print(run(100_000), run(400_000))
"""
BYTES_OF_A_MEMBER = 8 * (1 + 2 + 1)
"""What varies, two quantities, status."""


def test_memory_grows_only_by_the_results_of_each_member() -> None:
    done = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    before, after = (int(word) for word in done.stdout.split())
    assert after - before < 300_000 * BYTES_OF_A_MEMBER + 12e6  # a history would take thousands of bytes a member
