"""Numerical schemes for the slab on a grid, beside which the exact solution shows what a scheme does: `ss.studies.schemes(...)`.

A scheme is one small class. It says how the body moves in one step of time (`contract.Scheme`); the contact is the same for all
schemes (`run.GridContact`). `run.SCHEMES` lists them by name.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class SchemesExtension(Extension):
    """The commands `schemes` and `benchmark`, and the studies `ss.studies.schemes` and `ss.studies.judge_series`."""

    name = "schemes"
    uses = ("planar",)

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the commands `schemes` and `benchmark`."""
        from stickslip.extensions.schemes.commands.benchmark import benchmark
        from stickslip.extensions.schemes.commands.schemes import schemes

        return {"Questions that need many runs": (schemes,), "For other programs": (benchmark,)}

    def public(self) -> Mapping[str, str]:
        """Return the studies."""
        home = "stickslip.extensions.schemes"
        return {
            "studies.Schemes": f"{home}.schemes:Schemes",
            "studies.judge_series": f"{home}.benchmarks:judge_series",
            "studies.schemes": f"{home}.schemes:schemes",
        }


EXTENSION = SchemesExtension()
