"""Sweeps run one scenario many times with different parameters: on a grid, for random samples, or for a list of members.

Results are kept in a store. A sweep that was killed continues from its store.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from stickslip.extension import Command, Extension

if TYPE_CHECKING:
    from stickslip.extensions.sweeps.along import Along
    from stickslip.run import Reader


class SweepsExtension(Extension):
    """The command `sweep`, `ss.sweep` and `ss.figures.plot_sweep`."""

    name = "sweeps"

    def readers(self) -> Sequence[Reader]:
        """Return the reader of its folders."""
        from stickslip.extensions.sweeps.reader import SweepReader

        return (SweepReader(),)

    def commands(self) -> Mapping[str, Sequence[Command]]:
        """Return the command `sweep`."""
        from stickslip.extensions.sweeps.command import sweep

        return {"Questions that need many runs": (sweep,)}

    def public(self) -> Mapping[str, str]:
        """Return the function and the figure of its results."""
        home = "stickslip.extensions.sweeps"
        return {"figures.plot_sweep": f"{home}.figures.sweep:plot_sweep", "sweep": f"{home}.sweep:sweep"}


EXTENSION = SweepsExtension()


def run_along(*given: Any) -> Along:
    """Run a scenario for many values of one parameter, as `along.run_along` says: this is what other extensions may use."""
    from stickslip.extensions.sweeps.along import run_along as run

    return run(*given)
