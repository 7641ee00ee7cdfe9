"""Motion given: friction along a slip rate in time, and the law that fits friction along measured motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from stickslip.extension import Command, Extension

if TYPE_CHECKING:
    from stickslip.problem.scenarios import ScenarioTable
    from stickslip.run import Reader, SolverKind


class GivenMotionExtension(Extension):
    """`ss.MovedContact`, the table [motion] of scenario files, the solver of both, and `identify`."""

    name = "given_motion"

    def solvers(self) -> Sequence[SolverKind]:
        """Return the solver of contacts whose motion is given."""
        from stickslip.extensions.given_motion.kind import MOVED

        return (MOVED,)

    def readers(self) -> Sequence[Reader]:
        """Return the reader of files of runs along given motions."""
        from stickslip.extensions.given_motion.reader import MotionReader

        return (MotionReader(),)

    def tables(self) -> Mapping[str, ScenarioTable]:
        """Return the table [motion]."""
        from stickslip.problem.scenarios import LateTable

        return {"motion": LateTable("stickslip.extensions.given_motion.table:MotionTable")}

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `identify`."""
        from stickslip.extensions.given_motion.commands.identify import identify

        return {"Measured friction": (identify,)}

    def public(self) -> Mapping[str, str]:
        """Return `ss.MovedContact`, and what finds a law along measured motion."""
        home = "stickslip.extensions.given_motion"
        return {
            "MovedContact": f"{home}.moved:MovedContact",
            "studies.Identification": f"{home}.identification:Identification",
            "studies.identify": f"{home}.identify:identify",
        }


EXTENSION = GivenMotionExtension()
