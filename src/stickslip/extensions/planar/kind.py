"""What the core asks of planar slabs: their solver, and the reader of their folders."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.run import ALL_TAKE, Reader, SolverKind

if TYPE_CHECKING:
    from stickslip.cli.kinds import KindOfRun
    from stickslip.cli.results import Stored
    from stickslip.extensions.planar.solution import PlanarSolution
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions
    from stickslip.run.check import Examination


def _solves(what: Any) -> bool:
    from stickslip.extensions.planar.slab import PlanarSlab

    return isinstance(what, PlanarSlab)


def _run(source: Any, options: CallOptions) -> PlanarSolution:
    from stickslip.extensions.planar.run import simulate_planar

    return simulate_planar(source, options)


def _on_command_line() -> KindOfRun:
    from stickslip.extensions.planar.command_line import PlanarKindOfRun

    return PlanarKindOfRun()


def _examine(scenario: Scenario) -> Examination:
    from stickslip.extensions.planar.examine import examine_contact

    return examine_contact(scenario)


PLANAR = SolverKind(
    _solves,
    _run,
    ALL_TAKE | {"frames"},
    "a PlanarSlab has no {}: its nodes and its courant set the accuracy, and its scenario has the title",
    _on_command_line,
    _examine,
    what="a PlanarSlab",
)
"""The solver of planar slabs, and of scenarios with a [contact]."""


class PlanarReader(Reader):
    """Reads the folder of zarr that holds the run of a planar slab."""

    what = "the run of a PlanarSlab"

    @override
    def is_in(self, path: Path) -> bool:
        if not path.is_dir():
            return path.suffix.lower() == ".zarr" and not path.exists()  # so that a run that is not there is missed by its name
        from stickslip.extensions.planar.store_layout import PLANAR_FORMAT

        return PLANAR_FORMAT.is_in(path)

    @override
    def open(self, path: Path) -> PlanarSolution:
        from stickslip.extensions.planar.store_layout import open_planar

        return open_planar(path)

    @override
    def resume(self, path: Path, duration: Any, **options: Any) -> PlanarSolution:
        from stickslip.extensions.planar.run import resume_planar

        needless = [name for name in ("max_events", "checkpoint", "max_pieces") if options.pop(name, None) is not None]
        if needless:
            raise InputError(f"resume: {path}: the run of a PlanarSlab continues in its own folder, without {needless[0]}")
        return resume_planar(path, duration, **options)

    @override
    def stored(self, path: Path) -> Stored:
        from stickslip.cli.results import Stored
        from stickslip.extensions.planar.command_line import PlanarResults
        from stickslip.extensions.planar.store_layout import open_planar, opened, scenario_in

        about, scenario = opened(path).attrs, scenario_in(path)
        return Stored(path, about, PlanarResults(scenario, open_planar(path)), scenario.to_toml())

    @override
    def on_command_line(self) -> KindOfRun:
        return _on_command_line()
