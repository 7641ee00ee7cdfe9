"""The source of the package, which several tests read: parsed once for all tests of a process."""

from __future__ import annotations

from pathlib import Path

from benchmarks.house import House

import stickslip

HOUSE = House(Path(stickslip.__file__).parent)
"""The package with the syntax tree of each file, made when it is first asked for."""
