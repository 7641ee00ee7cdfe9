# The bodies, and what their kinds share.
from stickslip.problem.bodies.contract import MACHINE, Body, BodyOnCharacteristics, BodyWithWaves, as_waves, has_dashpot
from stickslip.problem.bodies.layered import LayeredSlab, OfLayers, TwoSlabs
from stickslip.problem.bodies.register import BODIES
from stickslip.problem.bodies.sections import SectionedString
from stickslip.problem.bodies.sliding import ElasticSlab, SpringBlock, as_block, as_slab
from stickslip.problem.bodies.turning import RotatingBlock, TorsionalString

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
