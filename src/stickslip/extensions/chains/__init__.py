"""Chains of sliding blocks (Burridge & Knopoff 1967), and what catalogues of slip events say."""

from __future__ import annotations

from collections.abc import Mapping

from stickslip.extension import Extension


class ChainsExtension(Extension):
    """The statistics of catalogues."""

    name = "chains"

    def public(self) -> Mapping[str, str]:
        """Return the statistics of catalogues."""
        home = "stickslip.extensions.chains"
        return {
            "studies.GutenbergRichter": f"{home}.statistics:GutenbergRichter",
            "studies.gutenberg_richter": f"{home}.statistics:gutenberg_richter",
            "studies.magnitudes": f"{home}.magnitudes:magnitudes",
        }


EXTENSION = ChainsExtension()
