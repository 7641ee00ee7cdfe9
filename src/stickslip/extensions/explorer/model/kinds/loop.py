"""What the explorer shows of an axis in a position loop: what it shows of a block, whose spring is the proportional gain."""

from __future__ import annotations

from typing import Any

from stickslip.extensions.explorer.model.kinds.rigid import GAINS, ShownRigid
from stickslip.problem.bodies import BodyOnCharacteristics

FIELDS_OF_LOOP = {field: gain for gain, field in GAINS.items()}


class _ShownLoop(ShownRigid):
    def in_place_of(self, own: BodyOnCharacteristics, kind: str, name: str) -> dict[str, Any]:
        """Return the axis that moves as the block in place of a body does: its integral gain is 0."""
        block = super().in_place_of(own, kind, name)
        block.pop("backlash", None)  # which a loop has not
        return {FIELDS_OF_LOOP.get(key, key): value for key, value in block.items()} | {"integral_gain": 0.0}


ANSWERS = _ShownLoop()
