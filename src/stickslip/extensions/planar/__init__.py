"""A slab whose slip varies along the contact: a line of contact (2D) or a plane of it (3D), in JAX.

`slab.py` says what is solved, `nodes.py` what each node is, `memory.py` and `echo.py` how waves come back along the half-space and
from the driver, `friction.py` what the contact answers, `layout.py` how fields and modes are spread over devices. `step.py` takes a
step of time with these, and `solver.py` a run.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from stickslip.extension import Extension

if TYPE_CHECKING:
    from stickslip.problem.scenarios.table import Table
    from stickslip.run.kinds import Reader, SolverKind


class PlanarExtension(Extension):
    """`ss.PlanarSlab`, the table [contact] of scenario files, and the solver of both."""

    name = "planar"

    def solvers(self) -> Sequence[SolverKind]:
        """Return the solver of planar slabs."""
        from stickslip.extensions.planar.kind import PLANAR

        return (PLANAR,)

    def tables(self) -> Mapping[str, Table]:
        """Return the table [contact]."""
        from stickslip.extensions.planar.table import ContactTable

        return {ContactTable.name: ContactTable()}

    def readers(self) -> Sequence[Reader]:
        """Return the reader of their folders."""
        from stickslip.extensions.planar.kind import PlanarReader

        return (PlanarReader(),)

    def public(self) -> Mapping[str, str]:
        """Return `ss.PlanarSlab`."""
        return {"PlanarSlab": "stickslip.extensions.planar.slab:PlanarSlab"}


EXTENSION = PlanarExtension()
