"""Where numba's public compiler compiles batches, they have the same bits."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

BATCH = """
import stickslip as ss
found = ss.sweep("fig6-slab", {"friction.alpha": [0.5, 1.0, 2.0]})
print(found.slip.values.tobytes().hex())
"""


def printed(**environment: str) -> str:
    settings = os.environ | environment
    return subprocess.run([sys.executable, "-c", BATCH], capture_output=True, text=True, check=True, env=settings).stdout


@pytest.mark.slow
def test_batches_are_the_same_bit_for_bit(tmp_path: Path) -> None:
    ours = printed()
    assert len(ours) == 3 * 16 + 1
    assert printed(STICKSLIP_PLAIN_NUMBA="1", STICKSLIP_CACHE_DIR=str(tmp_path)) == ours
    assert list(tmp_path.rglob("plain/**/*.nbc"))
