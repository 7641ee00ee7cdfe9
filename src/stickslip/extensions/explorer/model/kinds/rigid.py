"""What the explorer shows of rigid bodies: a block has no inside, and stands beside the slab of the same figure."""

from __future__ import annotations

import math
from dataclasses import fields, replace
from typing import Any, ClassVar, cast

from stickslip.extensions.explorer.model.answer import SlabPicture
from stickslip.extensions.explorer.model.asked import ShownKind, slab_of_figure
from stickslip.extensions.explorer.model.pictures import exact_energies
from stickslip.extensions.explorer.model.sampled_waves import SampledWaves, ShownInterval
from stickslip.foundation.arrays import Floats
from stickslip.problem.bodies import BodyOnCharacteristics, BodyWithWaves, ElasticSlab
from stickslip.problem.scenarios import Scenario, load_scenario, to_table

RIGID_DRIVER = {
    "driver_impedance": math.inf,
    "other_driver_impedance": math.inf,
    "driver_inertia": 0.0,
    "driver_integral_gain": 0.0,
}
"""Numbers of a driver that does not give way: the block equivalent to a body needs one."""
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
        """Return the block to which a body with waves is equivalent, under a driver that does not give way; or the same block."""
        if not own.has_waves:  # on a belt, or off it, or in a loop
            kept = {key: value for key, value in to_table(own).items() if key not in ONLY_OF_LOOPS}
            return {GAINS.get(key, key): value for key, value in kept.items()} | {"kind": kind}
        known = {one.name for one in fields(own)}
        whole = replace(own, **{field: value for field, value in RIGID_DRIVER.items() if field in known})
        return to_table(cast(BodyWithWaves, whole).equivalent_block()) | {"kind": kind}

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
