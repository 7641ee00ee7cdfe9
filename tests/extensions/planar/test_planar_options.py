"""Every option of `simulate` is obeyed, or refused by name, of a contact of many nodes."""

from __future__ import annotations

from pathlib import Path

import pytest

import stickslip as ss
from tests.core.run.long_runs.solvers import OBEYED, check_checkpoint, check_option
from tests.problems import SLAB

WEAKENING = ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.6, 0.3, 2.0), initial_excess=1e6)
PATCH = ss.PlanarSlab(WEAKENING, nodes=8, length=1e4)


@pytest.mark.parametrize("option", OBEYED)
def test_an_option_is_obeyed_or_refused_by_name(option: str) -> None:
    check_option(PATCH, option)


def test_progress_is_reported_and_a_checkpoint_kept(tmp_path: Path) -> None:
    check_checkpoint(PATCH, tmp_path / "run.zarr", lambda run: run.slip)
