"""The common parts of all studies: runs that Ctrl-C ends, the common time of runs, the text of a result, and its figure."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

from stickslip.foundation.arguments import NamesAttributes
from stickslip.foundation.atomic_write import write_table
from stickslip.foundation.show import ShownAsTable
from stickslip.problem import in_given_units
from stickslip.run.progress import reporting
from stickslip.solution import Solution, known_to_pyplot

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.figure import Figure

    from stickslip.foundation.place import Place

MAX_PIECES = 200_000
"""Default limit on the pieces of history of one run, which are held in memory (some 400 bytes each)."""
MOST_ROWS = 20
"""Largest number of rows of a table that a notebook shows."""
TextProgress = Callable[[str], Any]
"""A function that is called with a line of text on the progress of a study."""


@contextmanager
def telling(progress: TextProgress | bool | None, what: str) -> Iterator[TextProgress]:
    """Provide the function that receives the progress of a study, as `reporting` does; it does nothing if no progress is wanted."""
    with reporting(progress, what) as tell:
        yield tell or (lambda text: None)


def uninterrupted(solution: Solution) -> Solution:
    """Return a solution that has just been computed. Raises KeyboardInterrupt if Ctrl-C ended its run."""
    if solution.status.name == "interrupted":
        raise KeyboardInterrupt
    return solution


class Study(NamesAttributes, ShownAsTable):
    """The result of a study: a table, a text and a figure."""

    table: Any
    """Results as a pandas.DataFrame; its columns are described in each study."""

    def to_csv(self, path: str | Path) -> Path:
        """Write the table as CSV and return its path; comment lines (#) before it, if there are any, say where it comes from."""
        return write_table(Path(path), self.table, self._about())

    def _about(self) -> Iterable[str]:
        return ()

    @in_given_units
    def plot(self, **place: Unpack[Place]) -> Figure:
        """Plot the result; the panels are described with each study in the documentation.

        The keywords `figure`, `size` and `dpi` say where to draw, and how large, as for `solution.plot()`.
        """
        figure: Figure = self._figure()(self._drawn(), **place)
        return known_to_pyplot(figure, place)

    def _drawn(self) -> Any:
        """Return what the figure is drawn from: the result, or its dataset."""
        return self

    def _figure(self) -> Callable[..., Any]:
        """Return the function that draws the result, or its dataset."""
        raise NotImplementedError

    def _shown_table(self) -> pd.DataFrame:
        return self.table  # type: ignore[no-any-return]

    def _sentences(self) -> Iterable[str]:
        """Return what is said of the result; empty texts are left out."""
        raise NotImplementedError

    @in_given_units
    def _lines(self) -> list[tuple[str, ...]]:
        return [(text,) for text in self._sentences() if text]

    @in_given_units
    def _repr_html_(self) -> str:
        return super()._repr_html_() + self._shown_table().to_html(max_rows=MOST_ROWS, float_format="{:.6g}".format)


class StudyWithDataset(Study):
    """The result of a study whose figure is drawn from a dataset, which `to_dataset` gives."""

    def to_dataset(self) -> xr.Dataset:
        """Return what `plot` draws, in SI units."""
        raise NotImplementedError

    def _drawn(self) -> Any:
        return self.to_dataset()
