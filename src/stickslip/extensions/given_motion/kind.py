"""What the core asks of given motions: their solver, and the reader of their files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.foundation.errors import InputError
from stickslip.run import ALL_TAKE, Reader, SolverKind

if TYPE_CHECKING:
    from stickslip.cli.kinds import KindOfRun
    from stickslip.cli.results import Stored
    from stickslip.extensions.given_motion.along import FrictionAlongMotion
    from stickslip.problem.scenarios import Scenario
    from stickslip.run import CallOptions

MARK = "stickslip_motion_format"
"""The attribute of files of runs along given motions."""


def _solves(what: Any) -> bool:
    from stickslip.extensions.given_motion.moved import MovedContact

    return isinstance(what, MovedContact)


def _run(source: Any, options: CallOptions) -> FrictionAlongMotion:
    from stickslip.extensions.given_motion.run import follow_motion

    return follow_motion(source, options)


def _on_command_line() -> KindOfRun:
    from stickslip.extensions.given_motion.command_line import MotionKindOfRun

    return MotionKindOfRun()


def _examine(scenario: Scenario) -> Any:
    from stickslip.extensions.given_motion.examine import MotionExamination

    return MotionExamination(scenario)


MOVED = SolverKind(
    _solves,
    _run,
    ALL_TAKE | {"rtol", "title"},
    "a MovedContact has no {}: leave it out",
    _on_command_line,
    _examine,
    what="a MovedContact",
)
"""The solver of contacts whose motion is given, and of scenarios with a [motion]."""


class MotionReader(Reader):
    """Reads the netCDF file that holds a run along a given motion."""

    what = "the run of a MovedContact"
    mark = MARK

    @override
    def open(self, path: Path) -> FrictionAlongMotion:
        from stickslip.extensions.given_motion.kept import read_motion

        return read_motion(path)

    @override
    def resume(self, path: Path, duration: Any, **options: Any) -> FrictionAlongMotion:
        from stickslip.extensions.given_motion.run import resume_motion

        if needless := [name for name in ("max_events", "max_pieces") if options.pop(name, None) is not None]:
            raise InputError(f"resume: {path} holds {self.what}, which has no {needless[0]}: leave it out")
        return resume_motion(path, duration, **options)

    @override
    def stored(self, path: Path) -> Stored:
        from stickslip.cli.results import PlainRun, Stored
        from stickslip.extensions.given_motion.kept import motion_in
        from stickslip.foundation.netcdf_file import read_tables
        from stickslip.problem.scenarios import read_scenario

        tables = read_tables(path, self.what)
        run = motion_in(tables, path)
        scenario = read_scenario(str(tables.attrs["scenario"]), path.stem)
        return Stored(path, tables.attrs, PlainRun(scenario, run))

    @override
    def on_command_line(self) -> KindOfRun:
        return _on_command_line()
