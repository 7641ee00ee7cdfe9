"""Chains and lattices of blocks that are coupled by springs: Burridge and Knopoff's model, with located events."""

from __future__ import annotations

from collections.abc import Mapping

from stickslip.extension import Extension


class ChainsExtension(Extension):
    """`ss.Chain`, and what is made of it."""

    name = "chains"

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
