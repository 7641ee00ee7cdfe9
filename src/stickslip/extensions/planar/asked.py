"""List what a planar slab asks of each kind of driver that it follows."""

from __future__ import annotations

from abc import ABC, abstractmethod

from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import Problem


class PlanarDriver(ABC):
    """What is asked of a kind of driver."""

    @abstractmethod
    def reflects_at_first(self, problem: Problem) -> bool:
        """Return True if what the driver reflects first, of waves from before the start, does not simply go on with their ramp."""

    @abstractmethod
    def entering(self, problem: Problem, sent: Floats) -> Floats:
        """Return the load (Pa) that sets out from the driver at given times (s); before 0 s the pull rate is the first one."""

    @abstractmethod
    def impedance(self, problem: Problem) -> float:
        """Return the impedance (Pa s/m) that waves feel, inf if they come back whole."""

    @abstractmethod
    def damping(self, problem: Problem) -> float:
        """Return the impedance (Pa s/m) with which it takes up energy where it moves otherwise than pulled."""


FOLLOWED = {"rigid": "", "lossy": ""}
"""The kinds of driver that planar slabs have; all others are refused (`PlanarSlab`)."""
PLANAR_DRIVERS: ByKind[PlanarDriver] = ByKind("stickslip.extensions.planar.drivers", FOLLOWED)
