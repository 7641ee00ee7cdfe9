"""Checkpoints of a run or a catalogue, and notes on what rounding and merging have done to it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from functools import cache

from stickslip.engine.state.layout import Counts, Floats, Integers
from stickslip.engine.state.workspace import NO_WAVES
from stickslip.foundation.code_key import key_of_folders
from stickslip.foundation.kernels.code import SOURCES

RUN_CODE = ("contact", "engine", "friction", "problem", "run", "solution")
"""Folders of the package whose code decides the result of a run."""


@dataclass(frozen=True, eq=False)
class Checkpoint:
    """Copies of everything that changes in a run, except its history (see `layout`)."""

    state: Floats
    count: Integers
    scratch: Floats
    branch: Floats  # Setup.branch, which changes with slip for some laws
    stick_to: Floats  # (1,): Setup.params.stick_to, which changes with it
    engine: str  # hash of the code that made it
    waves: Floats = field(default_factory=NO_WAVES.copy)  # rows of waves of a body of layers, which are of two round trips only

    @property
    def length(self) -> int:
        """The number of pieces in the history at the checkpoint; a run that has ended may hold more, cut at its end."""
        return int(Counts(self.count).length)


ARRAYS = tuple(field.name for field in fields(Checkpoint) if field.name != "engine")
"""Names of the arrays in a checkpoint."""


@cache
def engine_key(*beside: str) -> str:
    """Return the key of the code that decides the result of a run; a run that continues with other code may differ in its digits.

    `beside` are folders of an extension whose code decides its results, too. Comments, docstrings and the layout of lines leave the
    key as it is (`code_key`).
    """
    if beside:  # few files, and the key of all others came with the package
        return key_of_folders(beside, engine_key())
    return key_of_folders(RUN_CODE, SOURCES)


def rounding_note(steps: int, share: float) -> str:
    """Return one line on steps that miss the contact equation by more than the tolerance, by rounding; empty if there are none."""
    if steps == 0:
        return ""
    where = "in 1 step" if steps == 1 else f"in {steps} steps"
    return (
        f"{where} the contact equation is missed by more than rtol allows, up to {share:.1g} of the slip rate, which the bound"
        " contains: as a rule the formula loses digits far from where slip began; write it without differences of nearly equal"
        " numbers, or expect no more digits"
    )


def merging_note(change: float, unit: str, where: str) -> str:
    """Return one line on the changes of waves by merging, in sum (Pa, N or N m); empty if nothing was merged. `where` may be ""."""
    if change == 0.0:
        return ""
    return f"pieces of waves{where} were merged, which changed the waves by {change:.1g} {unit} at most, added up over the run"


def strips_note(shift: float, unit: str) -> str:
    """Return one line on merged strips of creep and how far slip is off within them, in sum (m or rad); empty if there are none."""
    if shift == 0.0:
        return ""
    return (
        f"strips at the borders of creep were merged: within them slip is off by {shift:.1g} {unit} at most, added up over the run"
    )
