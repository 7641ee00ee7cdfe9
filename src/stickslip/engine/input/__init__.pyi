# What others take from engine.input. Each name is imported when it is first used; all else is the room's own.

from stickslip.engine.input.branch_table import (
    is_algebraic,  # Return True if the slip rate is a root of the contact equation, on one of its branches.
)
from stickslip.engine.input.ladder import (
    ladder_of,  # Return the table of `LadderCell` of a problem; an empty one for a body that is uniform.
    sides_of,  # Yield the sides of the contact as they are at the start.
)
from stickslip.engine.input.prepare import (
    SHARE_OF_TOLERANCE,  # Share of rtol allowed in a step: leaves the error of a whole run below rtol (see docs/numerics.md).
)

__all__ = [
    "SHARE_OF_TOLERANCE",
    "is_algebraic",
    "ladder_of",
    "sides_of",
]
