"""A uniform body sends waves back from its driver."""

from __future__ import annotations

from stickslip.extensions.schemes.echoes.asked import Echoes, EchoesOfKind, SideOfWaves
from stickslip.problem import Problem


class EchoesOfUniform(EchoesOfKind):
    """Answers of a uniform body with waves."""

    def echoes(self, problem: Problem) -> Echoes | None:
        """Return one cell with its driver."""
        body = problem.body
        return Echoes((SideOfWaves((body.impedance,), (-body.reflection,)),), 0.5 * body.round_trip_time)


ANSWERS = EchoesOfUniform()
