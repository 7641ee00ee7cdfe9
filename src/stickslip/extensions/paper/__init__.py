"""Reproduction of the paper: its figures, tables, and a verdict on each claim. `make.make(folder)` writes everything."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class PaperExtension(Extension):
    """The command `paper`."""

    name = "paper"
    uses = ("chains", "planar")

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `paper`."""
        from stickslip.extensions.paper.command import paper

        return {"The source paper": (paper,)}


EXTENSION = PaperExtension()
