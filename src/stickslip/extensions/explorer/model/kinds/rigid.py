"""What the explorer shows of rigid bodies: a block has no inside, and stands beside the slab of the same figure."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.asked import SHOWN_KINDS, ShownKind, slab_of_figure
from stickslip.extensions.explorer.model.pictures import exact_energies
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import BodyOnCharacteristics, ElasticSlab
from stickslip.problem.scenarios import Scenario, load_scenario, to_table

GAINS = {"proportional_gain": "stiffness", "derivative_gain": "driver_damping"}
"""The gains of a position loop that act as a spring and its dashpot, and the fields of a block for these."""
ONLY_OF_LOOPS = ("integral_gain", "reference_step")


class ShownRigid(ShownKind):
    """The answers of rigid bodies."""

    has_the_mass: ClassVar[str] = "the block"
    beside: ClassVar[str] = "equivalent "
    times: ClassVar[int] = 400

    def companion(self, scenario: Scenario) -> Scenario | None:
        """Return the slab of the same figure, under the law, the loading and the rule of the block, for a block of the paper."""
        name = slab_of_figure(scenario.name)
        if name is None:
            return None
        block, slab = scenario.problem, load_scenario(name).problem
        assert isinstance(slab.body, ElasticSlab)
        beside = replace(slab, friction=block.friction, pull_rate=block.pull_rate, selection=block.selection)
        return replace(scenario, problem=beside)

    def in_place_of(self, own: BodyOnCharacteristics, kind: str, name: str) -> dict[str, Any]:
        """Return the block to which a body is equivalent, under a driver that does not give way; or the same block."""
        return SHOWN_KINDS[own.structure].as_rigid(own) | {"kind": kind}

    def as_rigid(self, own: BodyOnCharacteristics) -> dict[str, Any]:
        """Return the same block: on a belt, off it, or in a loop."""
        kept = {key: value for key, value in to_table(own).items() if key not in ONLY_OF_LOOPS}
        return {GAINS.get(key, key): value for key, value in kept.items()}

    def waves(self, shown: ShownInterval) -> SampledWaves | None:
        """Return None: there are none."""
        return None

    def inside(self, shown: ShownInterval, waves: SampledWaves | None) -> SlabPicture | None:
        """Return None: there is no inside."""
        return None

    def energies(self, shown: ShownInterval, waves: SampledWaves | None, time: Floats) -> dict[str, Floats] | None:
        """Return those of the run."""
        return exact_energies(shown, time)


ANSWERS = ShownRigid()
