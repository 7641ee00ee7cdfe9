"""The register of bodies, by their names in scenario files."""

from __future__ import annotations

from stickslip.foundation.classes_by_kind import ClassesByKind
from stickslip.problem.bodies.contract import BodyOnCharacteristics

BODIES: ClassesByKind[BodyOnCharacteristics] = ClassesByKind(
    "stickslip.problem.bodies",
    {
        "spring-block": "sliding.SpringBlock",
        "elastic-slab": "sliding.ElasticSlab",
        "layered-slab": "layered.LayeredSlab",
        "two-slabs": "layered.TwoSlabs",
        "rotating-block": "turning.RotatingBlock",
        "torsional-string": "turning.TorsionalString",
        "sectioned-string": "sections.SectionedString",
    },
)
"""The class of every body by its name in scenario files."""
