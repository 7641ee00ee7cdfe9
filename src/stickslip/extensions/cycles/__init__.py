"""Cycles: periodic motion, its multipliers, how it changes along a parameter; and how fast disturbances of any motion grow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class CyclesExtension(Extension):
    """The studies `cycle`, `follow` and `lyapunov`, and their commands."""

    name = "cycles"

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the commands."""
        from stickslip.extensions.cycles.commands.cycle import cycle
        from stickslip.extensions.cycles.commands.lyapunov import lyapunov

        return {"Questions that need many runs": (cycle, lyapunov)}

    def public(self) -> Mapping[str, str]:
        """Return the studies and the classes of their results."""
        homes = {
            "BranchOfCycles": "branch",
            "LimitCycle": "limit_cycle",
            "LyapunovExponent": "exponent",
            "cycle": "find_cycle",
            "follow": "follow",
            "lyapunov": "lyapunov",
        }
        return {f"studies.{name}": f"stickslip.extensions.cycles.{module}:{name}" for name, module in homes.items()}


EXTENSION = CyclesExtension()
