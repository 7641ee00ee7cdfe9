"""What the core asks of given motions where files are read: the reader of their runs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from typing_extensions import override

from stickslip.extensions.given_motion.moved import MARK
from stickslip.foundation.errors import InputError
from stickslip.run import Reader

if TYPE_CHECKING:
    from stickslip.cli.kinds import KindOfRun
    from stickslip.cli.results import Stored
    from stickslip.extensions.given_motion.along import FrictionAlongMotion


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
        from stickslip.extensions.given_motion.kept import motion_in, tables_in
        from stickslip.problem.scenarios import read_scenario

        tables = tables_in(path)
        run = motion_in(tables, path)
        scenario = read_scenario(str(tables.attrs["scenario"]), path.stem)
        return Stored(path, tables.attrs, PlainRun(scenario, run))

    @override
    def on_command_line(self) -> KindOfRun:
        from stickslip.extensions.given_motion.command_line import MotionKindOfRun

        return MotionKindOfRun()
