"""Cycles: periodic motion of a rigid body, slab or string, its multipliers, and how it changes along a parameter."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class CyclesExtension(Extension):
    """The studies `cycle` and `follow`, and the command that does both."""

    name = "cycles"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command."""
        from stickslip.extensions.cycles.commands.cycle import cycle

        return {"Questions that need many runs": (cycle,)}

    def public(self) -> Mapping[str, str]:
        """Return the studies and the classes of their results."""
        homes = {"BranchOfCycles": "branch", "LimitCycle": "limit_cycle", "cycle": "find_cycle", "follow": "follow"}
        return {f"studies.{name}": f"stickslip.extensions.cycles.{module}:{name}" for name, module in homes.items()}


EXTENSION = CyclesExtension()
