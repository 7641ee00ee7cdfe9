"""The register of bodies, by their names in scenario files."""

from __future__ import annotations

from stickslip.foundation.classes_by_kind import ClassesByKind
from stickslip.problem.bodies.contract import BodyOnCharacteristics

BODIES: ClassesByKind[BodyOnCharacteristics] = ClassesByKind(
    "stickslip.problem.bodies",
    {
        "spring-block": "rigid.blocks.SpringBlock",
        "elastic-slab": "uniform.slab.ElasticSlab",
        "soil-column": "uniform.column.SoilColumn",
        "layered-slab": "layered.slabs.LayeredSlab",
        "two-slabs": "layered.slabs.TwoSlabs",
        "rotating-block": "rigid.blocks.RotatingBlock",
        "block-on-belt": "rigid.on_belt.BlockOnBelt",
        "block-on-disc": "rigid.on_belt.BlockOnDisc",
        "position-loop": "rigid.in_loop.PositionLoop",
        "rotary-loop": "rigid.in_loop.RotaryLoop",
        "torsional-string": "uniform.string.TorsionalString",
        "sectioned-string": "layered.string.SectionedString",
    },
)
"""The class of every body by its name in scenario files."""
