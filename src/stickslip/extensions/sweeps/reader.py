"""Read the folder of a sweep for `stickslip show`: its summary, a figure of one quantity, and its members as a table."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from typing_extensions import override

from stickslip.run import Reader

if TYPE_CHECKING:
    from stickslip.cli.results import Stored


class SweepReader(Reader):
    """Reads the folder of zarr that holds a sweep."""

    what = "a sweep"

    @override
    def is_in(self, path: Path) -> bool:
        if not path.is_dir():
            return False
        from stickslip.extensions.sweeps.results.layout import SWEEP_FORMAT

        return SWEEP_FORMAT.is_in(path)

    @override
    def stored(self, path: Path) -> Stored:
        from stickslip.cli.results import Stored
        from stickslip.extensions.sweeps.results.layout import SWEEP_FORMAT
        from stickslip.extensions.sweeps.results.store import open_store
        from stickslip.extensions.sweeps.shown import SweepResults

        with SWEEP_FORMAT.reading(path):
            dataset = open_store(path).load()
        return Stored(path, dataset.attrs, SweepResults(path, dataset))
