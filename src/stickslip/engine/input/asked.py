"""What preparation asks of each kind of body: its numbers, its first load, its cells, and what moving ground does to it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, NamedTuple, Protocol

import numpy as np

from stickslip.engine.state import layout as at
from stickslip.engine.state.layout import LadderCell
from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, Problem

NO_LADDER = LadderCell.table(0)
"""Table `Setup.ladder` of a body without layers."""


class CellCounts(NamedTuple):
    """The cells of a body of layers, as `state.layout.Counts` has them."""

    cells: int = 0
    first_side: int = 0
    """Those of the first side."""
    joined: bool = False
    """True if the sides move as one."""
    slots: int = 0
    """Places for waves: a machine has one, too."""


class Shaken(Protocol):
    """What moving ground does to the load of a contact, by segments of time."""

    @property
    def start(self) -> Floats:
        """When (s) segments begin."""
        ...

    @property
    def brings_inflow(self) -> bool:
        """True if it has the inflow of the driver in it."""
        ...

    def put(self, segments: Any, start: Floats) -> None:
        """Write it into segments (`LoadingSegment.of` a table) that begin at times (s), its own among them."""
        ...


class AtRest:
    """Ground that does not move."""

    start: Floats = np.zeros(1)
    brings_inflow: bool = False

    def put(self, segments: Any, start: Floats) -> None:
        """Leave the segments as they are."""


class InputOfBody(ABC):
    """The questions of preparation to a kind of body. Any number of the problem may be an array, for the members of a batch."""

    @abstractmethod
    def numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the numbers of `Setup.params` that bodies of this kind have, by name."""

    @abstractmethod
    def steady_numbers(self, problem: Problem) -> dict[str, Any]:
        """Return the numbers of `Setup.params` of a loading that does not vary."""

    @abstractmethod
    def first_load(self, problem: Problem) -> at.Floats:
        """Return the load of the first round trip (minus the reference), as a table of `FirstLoad`: linear between breaks."""

    @abstractmethod
    def first_load_varying(self, problem: Problem) -> at.Floats:
        """Return the same without the inflow of a loading that varies."""

    @abstractmethod
    def on_ground(self, problem: Problem) -> Shaken:
        """Return what ground that moves does to the load, by segments of time."""

    def ladder(self, problem: Problem) -> at.Floats:
        """Return the table of `LadderCell`: that of a body without layers is empty."""
        return NO_LADDER

    def cells(self, problem: Problem) -> CellCounts:
        """Return how many cells it has: a body without layers has none."""
        return CellCounts()


INPUTS: ByKind[InputOfBody] = ByKind("stickslip.engine.input.kinds", BODY_KINDS)
"""What preparation is answered by each kind of body, by `Body.structure`."""
