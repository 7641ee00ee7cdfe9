"""The bodies: a block on a spring and slabs, of one layer or several, that slide; a disc on a spring and a string that turn."""

from stickslip.foundation.classes_by_kind import ClassesByKind
from stickslip.foundation.lazy_names import lazy_names
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

__getattr__, __dir__ = lazy_names(__name__, __file__)
