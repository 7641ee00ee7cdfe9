"""Define the rigid bodies on a belt: a block that a belt drags, and one that a disc turns, on a spring that hangs on a wall."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from stickslip.problem.bodies.rigid.blocks import RotatingBlock, SpringBlock


class OnBelt:
    """What differs from a body whose spring is pulled: the pull rate is the velocity of the belt under it."""

    structure: ClassVar[str] = "belt"
    off_belt: ClassVar[str]
    """The class of the body off the belt."""

    def belt_as_ground(self, pull: Any, given: str) -> Any:
        """Return the belt as ground that moves. Raises InputError if other ground is given, or if the belt jumps."""
        from stickslip.problem.belt import ground_of_belt  # few problems have one

        return ground_of_belt(type(self).__name__, pull, given)

    def __repr__(self) -> str:
        """Return the call that makes it: the classes of bodies on a belt have no names after `ss.`."""
        return super().__repr__().replace(type(self).__name__, self.off_belt, 1) + ".on_belt()"


@dataclass(frozen=True)
class BlockOnBelt(OnBelt, SpringBlock):
    """A rigid block on a belt, held by a spring on a wall: m dv/dt + damping v + tau = K (D0 + integral of w - u) + m dw/dt.

    The velocity w of the belt is the pull rate, and may vary. Slip u is how far the belt has run ahead of the block: v = w less the
    velocity of the block. Where w is constant this is the block whose spring is pulled. Loads and tractions are forces, in N.
    """

    kind: ClassVar[str] = "block-on-belt"
    off_belt: ClassVar[str] = "SpringBlock"
    source: ClassVar[str] = "Newton's second law in the frame of the belt"


@dataclass(frozen=True)
class BlockOnDisc(OnBelt, RotatingBlock):
    """A body on a disc that turns, held by a torsion spring: I dv/dt + damping v + tau = K (D0 + integral of w - u) + I dw/dt.

    The rate of rotation w of the disc is the pull rate, and may vary. The slip u is the angle (rad) by which the disc has turned
    ahead of the body: v = w less the rate of the body. Loads and tractions are torques, in N m.
    """

    kind: ClassVar[str] = "block-on-disc"
    off_belt: ClassVar[str] = "RotatingBlock"
    source: ClassVar[str] = "Newton's second law in the frame of the disc"
