"""What mypy says about code that a user could have written."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def mypy_on(file: Path, code: str) -> str:
    """Write code into a file, and return what mypy prints about it.

    Its options are the project's, so that it finds the types of the package in the cache that `make lint` has left: half a second
    instead of twenty. Files of different tests have different names, because that cache knows them by name.
    """
    pytest.importorskip("mypy")
    file.write_text(code)
    command = [sys.executable, "-m", "mypy", "--config-file", str(ROOT / "pyproject.toml"), str(file)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False).stdout
