"""Rows of waves in a body of layers: where they are, and how a piece of them is cut and written next to folds (`waves.ladder`)."""

from __future__ import annotations

from stickslip.engine.folds.fold import share_described, square_variable
from stickslip.engine.series.polynomial import copy, restrict
from stickslip.engine.state.layout import TERMS, Floats
from stickslip.engine.state.workspace import FIRST_ROW, Run
from stickslip.foundation.kernels.kernels import kernel
from stickslip.foundation.kernels.memory.addresses import ahead

AIR, ASIDE = 0, 1
"""Rows of the piece of load that the contact meets, and of one that is set aside next to a fold."""


@kernel
def wave_in(run: Run, row: int, cell: int) -> Floats:
    """Return the wave (Pa, minus that of the reference strength) in a cell, of one row."""
    return ahead(run.waves, (row * run.counts.slots + cell) * TERMS)


@kernel
def row_of(run: Run, n: int) -> int:
    """Return the row of piece n of the history."""
    return FIRST_ROW + (n + run.counts.wave_shift) % run.wave_rows


@kernel
def kept_wave(run: Run, n: int, cell: int) -> Floats:
    """Return the wave (Pa) that left with piece n of the history in a cell; of a uniform body the one wave, in run.machine_pull."""
    if run.counts.slots > 0:
        return wave_in(run, row_of(run, n), cell)
    wave, rate, load, doubled = run.machine_pull, run.history[n].rate, run.history[n].load, 2.0 * run.params.impedance
    for k in range(TERMS):
        wave[k] = doubled * rate[k] - load[k]
    return wave


@kernel
def brought_wave(run: Run, cell: int) -> Floats:
    """Return the wave (Pa) that is brought to the contact in a cell; of a uniform body the piece of load."""
    return wave_in(run, AIR, cell) if run.counts.slots > 0 else run.load


@kernel
def side_of(run: Run, side: int) -> tuple[int, int]:
    """Return the first cell of a side of the contact (0 or 1), and the one behind its last."""
    return (0, run.counts.first_side) if side == 0 else (run.counts.first_side, run.counts.cells)


@kernel
def cut_waves(run: Run, end: float) -> None:
    """Restrict the waves to the part of the piece of load from the present place to `end`."""
    begin = run.state.xi
    for cell in range(run.counts.slots):
        wave = wave_in(run, AIR, cell)
        restrict(wave, begin, end - begin, run.trial)
        copy(run.trial, wave, TERMS)


@kernel
def share_of_waves(run: Run, width: float) -> float:
    """Return the share of the way (in xi) back from a fold that is `width` ahead, on which all waves fit the root of time."""
    share = 1.0
    for cell in range(run.counts.slots):
        restrict(wave_in(run, AIR, cell), run.state.xi + width, -width, run.spare)
        share = min(share, share_described(run.spare))
    return share


@kernel
def write_to_fold(run: Run, width: float) -> None:
    """Set the waves aside, and write those up to the fold `width` (in xi) ahead in the root of the time left."""
    copy(wave_in(run, AIR, 0), wave_in(run, ASIDE, 0), run.counts.slots * TERMS)
    for cell in range(run.counts.slots):
        wave = wave_in(run, AIR, cell)
        restrict(wave, run.state.xi + width, -width, run.trial)
        square_variable(run.trial, run.spare)
        restrict(run.spare, 1.0, -1.0, wave)


@kernel
def write_from_fold(run: Run, width: float) -> None:
    """Set the waves aside, and write those from the fold on, over `width` (in xi), in the root of the time since."""
    copy(wave_in(run, AIR, 0), wave_in(run, ASIDE, 0), run.counts.slots * TERMS)
    for cell in range(run.counts.slots):
        wave = wave_in(run, AIR, cell)
        restrict(wave, run.state.xi, width, run.trial)
        square_variable(run.trial, wave)
