"""Chains and lattices of blocks that are coupled by springs: Burridge and Knopoff's model, with located events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from stickslip.extension import Command, Extension

if TYPE_CHECKING:
    from stickslip.problem.scenarios import ScenarioTable
    from stickslip.run import Reader, SolverKind


class ChainsExtension(Extension):
    """`ss.Chain`, and what is made of it."""

    name = "chains"

    def solvers(self) -> Sequence[SolverKind]:
        """Return the solver of chains."""
        from stickslip.extensions.chains.kind import CHAIN_SOLVER

        return (CHAIN_SOLVER,)

    def tables(self) -> Mapping[str, ScenarioTable]:
        """Return the table [chain]."""
        from stickslip.problem.scenarios import LateTable

        return {"chain": LateTable("stickslip.extensions.chains.table:ChainTable", Path(__file__).with_name("scenarios"))}

    def readers(self) -> Sequence[Reader]:
        """Return the reader of their folders."""
        from stickslip.extensions.chains.kind import ChainReader

        return (ChainReader(),)

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `magnitudes`."""
        from stickslip.extensions.chains.commands.magnitudes import magnitudes

        return {"Catalogues of events": (magnitudes,)}

    def public(self) -> Mapping[str, str]:
        """Return the chain, numbers that are drawn for its blocks, and the statistics of catalogues."""
        home = "stickslip.extensions.chains"
        return {
            "Chain": f"{home}.chain:Chain",
            "Drawn": f"{home}.drawn:Drawn",
            "studies.ChainBesideSlab": f"{home}.beside_slab:ChainBesideSlab",
            "studies.GutenbergRichter": f"{home}.statistics:GutenbergRichter",
            "studies.chain_beside_slab": f"{home}.beside_slab:chain_beside_slab",
            "studies.gutenberg_richter": f"{home}.statistics:gutenberg_richter",
            "studies.magnitudes": f"{home}.magnitudes:magnitudes",
        }


EXTENSION = ChainsExtension()
