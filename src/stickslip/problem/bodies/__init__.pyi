# The bodies, and what their kinds share.
from stickslip.problem.bodies.contract import MACHINE, Body, BodyOnCharacteristics, BodyWithWaves, as_waves
from stickslip.problem.bodies.layered.of_layers import OfLayers
from stickslip.problem.bodies.layered.slabs import LayeredSlab, TwoSlabs
from stickslip.problem.bodies.layered.string import SectionedString
from stickslip.problem.bodies.register import BODIES
from stickslip.problem.bodies.rigid.blocks import RotatingBlock, SpringBlock, as_block
from stickslip.problem.bodies.rigid.in_loop import PositionLoop, RotaryLoop
from stickslip.problem.bodies.rigid.on_belt import BlockOnBelt, BlockOnDisc
from stickslip.problem.bodies.rigid.on_spring import as_on_spring
from stickslip.problem.bodies.uniform.column import SoilColumn
from stickslip.problem.bodies.uniform.slab import ElasticSlab, as_slab
from stickslip.problem.bodies.uniform.string import TorsionalString

__all__ = [
    "BODIES",
    "MACHINE",
    "BlockOnBelt",
    "BlockOnDisc",
    "Body",
    "BodyOnCharacteristics",
    "BodyWithWaves",
    "ElasticSlab",
    "LayeredSlab",
    "OfLayers",
    "PositionLoop",
    "RotaryLoop",
    "RotatingBlock",
    "SectionedString",
    "SoilColumn",
    "SpringBlock",
    "TorsionalString",
    "TwoSlabs",
    "as_block",
    "as_on_spring",
    "as_slab",
    "as_waves",
]
