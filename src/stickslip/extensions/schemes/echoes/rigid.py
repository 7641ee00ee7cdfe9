"""A rigid body has no waves."""

from __future__ import annotations

from stickslip.extensions.schemes.echoes.asked import Echoes, EchoesOfKind
from stickslip.problem import Problem


class EchoesOfRigid(EchoesOfKind):
    """Answers of a rigid body."""

    def echoes(self, problem: Problem) -> Echoes | None:
        """Return None."""
        return None


ANSWERS = EchoesOfRigid()
