"""Cycles: periodic motion of a rigid body, its multipliers, and how it changes along a parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class CyclesExtension(Extension):
    """The studies `cycle` and `follow`."""

    name = "cycles"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command, which does both."""
        from stickslip.extensions.cycles.commands.cycle import cycle

        return {"Questions that need many runs": (cycle,)}

    def public(self) -> Mapping[str, str]:
        """Return the studies and the classes of their results."""
        home = "stickslip.extensions.cycles"
        return {
            "studies.BranchOfCycles": f"{home}.branch:BranchOfCycles",
            "studies.LimitCycle": f"{home}.limit_cycle:LimitCycle",
            "studies.cycle": f"{home}.find_cycle:cycle",
            "studies.follow": f"{home}.follow:follow",
        }


EXTENSION = CyclesExtension()
