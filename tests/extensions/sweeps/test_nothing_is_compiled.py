"""A sweep runs by the machine code that came with the package."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.core.foundation.kernels.fresh import COMMAND, printed, python

SWEEP = ["sweep", "fig6-slab", "--vary", "friction.alpha=0.5,1,2", "--out", "a.zarr"]


def test_a_sweep_compiles_nothing_and_loads_no_compiler(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = python(COMMAND.format(arguments=SWEEP), tmp_path / "cache")
    assert (printed(done).splitlines()[-1], done.stderr) == ("False 0", "")
    assert [path.name for path in (tmp_path / "cache").rglob("*.o")] == []
