"""The bodies: a block on a spring and slabs, of one layer or several, that slide; a disc on a spring and a string that turn."""

from stickslip.problem.bodies.contract import MACHINE, Body, BodyOnCharacteristics, BodyWithWaves, as_waves, has_dashpot
from stickslip.problem.bodies.layered import LayeredSlab, OfLayers, TwoSlabs
from stickslip.problem.bodies.sections import SectionedString
from stickslip.problem.bodies.sliding import ElasticSlab, SpringBlock, as_block, as_slab
from stickslip.problem.bodies.turning import RotatingBlock, TorsionalString

BODIES: dict[str, type[BodyOnCharacteristics]] = {
    body.kind: body for body in (SpringBlock, ElasticSlab, LayeredSlab, TwoSlabs, RotatingBlock, TorsionalString, SectionedString)
}
"""Every body by its name in scenario files."""

__all__ = [
    "BODIES",
    "MACHINE",
    "Body",
    "BodyOnCharacteristics",
    "BodyWithWaves",
    "ElasticSlab",
    "LayeredSlab",
    "OfLayers",
    "RotatingBlock",
    "SectionedString",
    "SpringBlock",
    "TorsionalString",
    "TwoSlabs",
    "as_block",
    "as_slab",
    "as_waves",
    "has_dashpot",
]
