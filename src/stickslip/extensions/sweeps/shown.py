"""A sweep as `stickslip show` shows it: its summary, a figure of one quantity, and its members as a table."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from typing_extensions import override

from stickslip.cli.output.files import drawing, write_files
from stickslip.cli.results import Results, made_by
from stickslip.foundation.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    from stickslip.cli.output.pictures import Pictures


@dataclass(frozen=True)
class SweepResults(Results):
    """The results of a sweep, and the quantity that is drawn: by default the first."""

    path: Path
    dataset: xr.Dataset
    quantity: str | None = None

    @override
    def of_quantity(self, name: str, path: Path) -> SweepResults:
        return replace(self, quantity=name)

    @override
    def check(self, pictures: Pictures, where: str) -> None:
        if others := [option for option in pictures.wanted if option != "--figure"]:
            raise InputError(f"{self.path}: the results of a sweep have no {', '.join(others)}: --figure draws a quantity")
        if self.quantity is not None:
            from stickslip.extensions.sweeps.figures.sweep import sweep_data

            sweep_data(self.dataset, self.quantity)

    @override
    def summarise(self, *, everything: bool = False) -> None:
        from stickslip.extensions.sweeps.summary import show_sweep

        show_sweep(self.path.stem, self.dataset)

    @override
    def draw(self, pictures: Pictures) -> list[Path]:
        from stickslip.extensions.sweeps.figures.sweep import plot_sweep

        return write_files((pictures.figure, drawing(partial(plot_sweep, self.dataset, self.quantity), pictures.look)))

    @override
    def to_csv(self, path: Path) -> Path:
        """Write a row for each member, with the units of the columns, and return the path."""
        from stickslip.extensions.sweeps.results.layout import table_of
        from stickslip.foundation.atomic_write import write_table

        return write_table(path, table_of(self.dataset), [made_by(self.dataset.attrs)])
