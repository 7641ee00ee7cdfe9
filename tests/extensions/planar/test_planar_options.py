"""Every option of `simulate` is obeyed, or refused by name, of a contact of many nodes."""

from __future__ import annotations

from pathlib import Path

import pytest

import stickslip as ss
from stickslip.extensions.planar.kind import PLANAR
from tests.core.run.long_runs.solvers import OBEYED, check_checkpoint, check_option
from tests.problems import SLAB

WEAKENING = ss.Problem(SLAB, ss.friction.LinearSlipWeakening(0.6, 0.3, 2.0), initial_excess=1e6)
PATCH = ss.PlanarSlab(WEAKENING, nodes=8, length=1e4)


KNOWN = OBEYED | {"frames": (7, lambda run: bool(0.5 < 7 * run.times[1] / SLAB.two_way_time <= 1.0))}


def test_every_option_of_the_solver_has_a_value_that_shows() -> None:
    assert PLANAR.takes - {"progress", "checkpoint", "checkpoint_every"} <= set(KNOWN)


@pytest.mark.sampled(every=9)
@pytest.mark.parametrize("option", KNOWN)
def test_an_option_is_obeyed_or_refused_by_name(option: str) -> None:
    check_option(PATCH, option, KNOWN)


def test_frames_are_refused_for_a_single_contact() -> None:
    with pytest.raises(ss.InputError, match="simulate: frames is for a PlanarSlab"):
        ss.simulate(WEAKENING, 1.0, frames=7)


def test_progress_is_reported_and_a_checkpoint_kept(tmp_path: Path) -> None:
    check_checkpoint(PATCH, tmp_path / "run.zarr", lambda run: run.slip)
