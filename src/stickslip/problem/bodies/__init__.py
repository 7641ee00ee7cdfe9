"""The bodies: a block on a spring and slabs, of one layer or several, that slide; a disc on a spring and a string that turn."""

from stickslip.bodies.contract import MACHINE, Body, BodyOnCharacteristics, BodyWithWaves, as_waves, has_dashpot
from stickslip.bodies.layered import LayeredSlab, OfLayers, TwoSlabs
from stickslip.bodies.sections import SectionedString
from stickslip.bodies.sliding import ElasticSlab, SpringBlock, as_block, as_slab
from stickslip.bodies.turning import RotatingBlock, TorsionalString

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
