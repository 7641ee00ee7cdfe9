"""What the explorer shows of all bodies in which waves run."""

from __future__ import annotations

import tomllib
from dataclasses import replace
from typing import Any, ClassVar

from stickslip.extensions.explorer.model.asked import ShownKind, slab_of_figure
from stickslip.foundation.names import TURNS
from stickslip.problem import block_for
from stickslip.problem.bodies import BodyOnCharacteristics
from stickslip.problem.scenarios import Scenario, library


class ShownWaves(ShownKind):
    """The answers of bodies with waves, as far as they are alike."""

    has_the_mass: ClassVar[str] = "the contact"
    beside: ClassVar[str] = ""
    times: ClassVar[int] = 160

    def companion(self, scenario: Scenario) -> Scenario | None:
        """Return the equivalent block, for each m^2 of contact, so that its forces in N are the slab's stresses in Pa."""
        return replace(scenario, problem=block_for(scenario.problem), creep_rtol=None, shortest_event=None)

    def in_place_of(self, own: BodyOnCharacteristics, kind: str, name: str) -> dict[str, Any]:
        """Return the body of the slab of the same figure, or of the scenario that new ones of this kind start from."""
        starter = kind if kind in library.STARTERS else "string" if own.load_unit == TURNS else "slab"  # of layers, or uniform
        slab_name = (slab_of_figure(name) if starter == "slab" else None) or library.STARTERS[starter].example
        return dict(tomllib.loads(library.text(slab_name))["body"])
