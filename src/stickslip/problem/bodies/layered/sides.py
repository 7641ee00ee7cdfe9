"""How two sides of a contact go together: joined, they move as one on it; apart, they slip on each other."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any, ClassVar

from numpy.typing import NDArray


class Sides(ABC):
    """What the sides of a contact have in common. One side alone is one that is joined with no other."""

    has_ground: ClassVar[bool]
    """True if there is something under the contact that does not belong to a side."""
    resist: ClassVar[str]
    """How they resist, in words."""

    @abstractmethod
    def together(self, numbers: Sequence[float]) -> float:
        """Return what the impedances or stiffnesses of the sides are together (Pa s/m, Pa/m)."""

    @abstractmethod
    def shares(self, stiffness: Sequence[float]) -> list[float]:
        """Return the share (1) of the load that each side bears, from their stiffness (Pa/m)."""

    @abstractmethod
    def slipping(self, stiffness: Sequence[float]) -> list[float]:
        """Return the share (1) of slow slip that each side takes."""

    @abstractmethod
    def alike(self, starts: NDArray[Any]) -> NDArray[Any]:
        """Return the starts of rows of cells that bear the same stress, from those of the cells of each side."""

    @abstractmethod
    def is_pulled(self, count: int) -> list[bool]:
        """Return for each of so many sides whether its driver is pulled, or held."""

    @abstractmethod
    def rates_at_start(self, rate: float, shear: float, stiffness: Sequence[float]) -> list[tuple[float, float]]:
        """Return the velocities (m/s, towards forward slip) of contact and driver on each side: see `Body.rates_at_start`."""


class Joined(Sides):
    """Sides that move as one on a third body, and resist side by side."""

    has_ground: ClassVar[bool] = True
    resist: ClassVar[str] = "side by side"

    def together(self, numbers: Sequence[float]) -> float:
        """Return their sum."""
        return sum(numbers)

    def shares(self, stiffness: Sequence[float]) -> list[float]:
        """Return shares in proportion to the stiffness."""
        return [one / self.together(stiffness) for one in stiffness]

    def slipping(self, stiffness: Sequence[float]) -> list[float]:
        """Return 1 for each: both slip."""
        return [1.0] * len(stiffness)

    def alike(self, starts: NDArray[Any]) -> NDArray[Any]:
        """Return those of each side."""
        return starts

    def is_pulled(self, count: int) -> list[bool]:
        """Return True for each."""
        return [True] * count

    def rates_at_start(self, rate: float, shear: float, stiffness: Sequence[float]) -> list[tuple[float, float]]:
        """Return the same for each side."""
        return [(rate, rate + shear)] * len(stiffness)


class Apart(Sides):
    """Two sides that slip on each other: each is the ground of the other, and they give way one after the other."""

    has_ground: ClassVar[bool] = False
    resist: ClassVar[str] = "in series"

    def together(self, numbers: Sequence[float]) -> float:
        """Return what they are in series."""
        return 1.0 / sum(1.0 / one for one in numbers)

    def shares(self, stiffness: Sequence[float]) -> list[float]:
        """Return 1 for each: the same load is on both."""
        return [1.0] * len(stiffness)

    def slipping(self, stiffness: Sequence[float]) -> list[float]:
        """Return shares in proportion to the compliance."""
        whole = self.together(stiffness)
        return [whole / one for one in stiffness]

    def alike(self, starts: NDArray[Any]) -> NDArray[Any]:
        """Return one row: the stress is the same on both."""
        return starts[[0, -1]]

    def is_pulled(self, count: int) -> list[bool]:
        """Return True for the first side, and False for the other, whose driver is held."""
        return [True, *[False] * (count - 1)]

    def rates_at_start(self, rate: float, shear: float, stiffness: Sequence[float]) -> list[tuple[float, float]]:
        """Return the velocities of an observer for whom the driver that is held rests; the sides share the shear."""
        whole = self.together(stiffness)
        first, other = (shear * whole / one for one in stiffness)
        return [(rate + shear - first, rate + shear), (-other, 0.0)]
