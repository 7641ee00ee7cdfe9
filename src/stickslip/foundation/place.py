"""The keywords for the place and the size of a figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure


class Place(TypedDict, total=False):
    """Where a figure is drawn, and how large.

    Axes `ax`, for figures of one panel, get no title. An empty `figure` keeps its size unless `size` is given: width and height in
    inches, a text with a unit ("16 x 10 cm"), "single column" or "double column". `dpi` are dots per inch, on the screen and in
    files.
    """

    ax: Axes
    figure: Figure | SubFigure
    size: tuple[float, float] | str
    dpi: float
