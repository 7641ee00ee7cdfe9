"""Bodies in a position loop: their integral depends on where they are."""

from __future__ import annotations

from stickslip.extensions.cycles.disturbed.kinds.rigid import ComparedRigid
from stickslip.problem import Problem


class ComparedInLoop(ComparedRigid):
    """Answers of a body in a position loop."""

    def has_place(self, problem: Problem) -> bool:
        """Return True: the lag winds the integral up."""
        return True


ANSWERS = ComparedInLoop()
