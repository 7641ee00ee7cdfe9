"""stickslip: dynamic frictional sliding of a rigid block and of an elastic slab."""

from stickslip import friction
from stickslip.bodies import ElasticSlab, SpringBlock
from stickslip.errors import InputError
from stickslip.problem import Problem

__version__ = "0.1.0"

__all__ = ["ElasticSlab", "InputError", "Problem", "SpringBlock", "friction"]
