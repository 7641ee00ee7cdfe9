"""Define the bodies that slide on the contact: a rigid block on a spring and an elastic slab."""

from stickslip.bodies.body import Body, BodyOnCharacteristics, as_block, as_slab, has_dashpot
from stickslip.bodies.elastic_slab import ElasticSlab
from stickslip.bodies.spring_block import SpringBlock

BODIES: dict[str, type[BodyOnCharacteristics]] = {body.kind: body for body in (SpringBlock, ElasticSlab)}
"""Every body by its name in scenario files."""

__all__ = ["BODIES", "Body", "BodyOnCharacteristics", "ElasticSlab", "SpringBlock", "as_block", "as_slab", "has_dashpot"]
