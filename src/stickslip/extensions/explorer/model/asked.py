"""List what the explorer asks of each kind of body."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.foundation.arrays import Floats
from stickslip.foundation.by_kind import ByKind
from stickslip.problem import BODY_KINDS, Problem
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.scenarios import Scenario

SLABS = {"fig5-block": "fig5-slab-printed", "fig6-block": "fig6-slab", "fig7-block": "fig7-slab-critical"}
"""The slab by the beginning of the block's name."""


def slab_of_figure(name: str) -> str | None:
    """Return the name of the bundled slab that the paper shows beside a bundled block, or None for another name."""
    return next((slab for start, slab in SLABS.items() if name.startswith(start)), None)


class ShownKind(ABC):
    """What is asked of a kind of body."""

    has_the_mass: ClassVar[str]
    """What sentences call what has a mass, if the slip rate cannot jump."""
    beside: ClassVar[str]
    """A word before the noun of a body that runs beside another one, with a space behind it."""
    times: ClassVar[int]
    """Number of times of the picture of the energy."""

    @abstractmethod
    def companion(self, scenario: Scenario) -> Scenario | None:
        """Return the scenario of the body that runs beside one of this kind, or None. Raises InputError if it has none."""

    @abstractmethod
    def in_place_of(self, own: BodyOnCharacteristics, kind: str, name: str) -> dict[str, Any]:
        """Return the table of a body `kind`, of this kind, which takes the place of another one in the scenario `name`."""

    @abstractmethod
    def as_rigid(self, own: BodyOnCharacteristics) -> dict[str, Any]:
        """Return the table of the block to which a body of this kind is equivalent, under a driver that does not give way."""

    def loading_of(self, table: dict[str, Any], own: Problem) -> dict[str, Any]:
        """Return the table [loading] of a problem as a body of this kind can have it: by default as it is."""
        return table

    @abstractmethod
    def waves(self, shown: ShownInterval) -> SampledWaves | None:
        """Return the waves inside, if they are sampled; None where they are not known because of a leap over creep."""

    @abstractmethod
    def inside(self, shown: ShownInterval, waves: SampledWaves | None) -> SlabPicture | None:
        """Return the picture of the inside; None if there is none, or if it would take too long."""

    @abstractmethod
    def energies(self, shown: ShownInterval, waves: SampledWaves | None, time: Floats) -> dict[str, Floats] | None:
        """Return the energies at times (s) by name; None where they are not known."""


SHOWN_KINDS: ByKind[ShownKind] = ByKind("stickslip.extensions.explorer.model.kinds", BODY_KINDS)
