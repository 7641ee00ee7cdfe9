"""The explorer: a page in the browser, or in a notebook, where a problem answers while its numbers are moved.

`model` says what is shown, and imports neither Panel nor Bokeh; `page` draws it; `server` opens it to browsers, and runs the work
beside the pages.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from stickslip.extension import Command, Extension


class ExplorerExtension(Extension):
    """The command `explore` and `ss.explore`."""

    name = "explorer"
    uses = ("inference", "planar", "sweeps")

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `explore`."""
        from stickslip.extensions.explorer.command import explore

        return {"A scenario and its run": (explore,)}

    def public(self) -> Mapping[str, str]:
        """Return `ss.explore`."""
        return {"explore": "stickslip.extensions.explorer.notebook:explore"}


EXTENSION = ExplorerExtension()
