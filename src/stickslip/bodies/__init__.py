"""Bodies: what stands behind the contact."""

from stickslip.bodies.elastic_slab import ElasticSlab
from stickslip.bodies.spring_block import SpringBlock

Body = ElasticSlab | SpringBlock

BODIES: dict[str, type[Body]] = {body.kind: body for body in (SpringBlock, ElasticSlab)}

__all__ = ["BODIES", "Body", "ElasticSlab", "SpringBlock"]
