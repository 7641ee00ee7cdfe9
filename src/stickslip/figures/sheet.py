"""Where a figure is drawn and how large it is: in a new figure, or in a figure or axes of the user.

Every function of the package that draws takes the keywords of `Place`. Without them it makes a new figure, a `StickslipFigure`, in
the size that suits its panels. Methods that users call (`solution.plot()`, `study.plot()`) make the finished figure known to
pyplot, by `known_to_pyplot`; commands and the paper draw figures that pyplot never sees.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from functools import partial
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar, Unpack, cast

import matplotlib as mpl
from matplotlib.backends.registry import BackendFilter, backend_registry
from matplotlib.figure import Figure

from stickslip.figures.style import image, styled
from stickslip.foundation.arguments import shown
from stickslip.foundation.atomic_write import write_atomically
from stickslip.foundation.errors import InputError, nearest
from stickslip.foundation.place import Place

if TYPE_CHECKING:
    from matplotlib.axes import Axes

T = TypeVar("T")
KEYWORDS = ("ax", "figure", "size", "dpi")
"""The keywords of `Place`."""
INCHES = {"mm": 1.0 / 25.4, "cm": 1.0 / 2.54, "in": 1.0, "inch": 1.0, "inches": 1.0}
"""Units in which a size can be written, and their length in inches."""
WIDTHS_OF_COLUMNS = {"single column": 3.5, "double column": 7.2}
"""Widths (inches) of one and of two columns of most journals; the height stays that of the figure."""
SIDES = (0.8, 80.0)
"""Smallest and largest side of a figure, inches (2 cm and 2 m)."""
DPI = (10.0, 2400.0)
"""Smallest and largest number of dots per inch."""
MOST_DOTS = 30_000
"""Largest number of dots along one side: a picture with more takes gigabytes of memory."""
HOW_TO_SIZE = 'two lengths in inches, a text such as "16 x 10 cm" or "3.5 x 5 in", "single column" or "double column"'
_SIZE = re.compile(r"\s*([\d.]+)\s*([a-z]*)\s*[x×*]\s*([\d.]+)\s*([a-z]+)\s*")


class StickslipFigure(Figure):
    """A figure of this package. It takes the size that suits its panels, and a notebook shows it exactly once."""

    def _ipython_display_(self) -> None:
        """Show the figure as the result of a cell of a notebook.

        Figures that pyplot knows are shown by the notebook's own backend at the end of the cell, or by a window. The result of the
        cell would be a second picture, so that pyplot forgets a figure that has no window, and the window is left to show its own.
        """
        from IPython import get_ipython
        from IPython.display import display
        from matplotlib import pyplot

        if pyplot.fignum_exists(getattr(self, "number", -1)):
            if _has_windows():
                display({"text/plain": repr(self)}, raw=True)
                return
            pyplot.close(self)
        formatters = get_ipython().display_formatter.formatters
        pictures = {
            kind: formatter(self) for kind, formatter in formatters.items() if kind.startswith(("image/", "application/pdf"))
        }
        found = {kind: picture for kind, picture in pictures.items() if picture}
        data = {kind: picture[0] if isinstance(picture, tuple) else picture for kind, picture in found.items()}
        metadata = {kind: picture[1] for kind, picture in found.items() if isinstance(picture, tuple)}
        display({"text/plain": repr(self), **(data or {"image/png": self._png()})}, metadata=metadata, raw=True)

    def _png(self) -> bytes:
        """Return the figure as PNG, for a notebook whose backend does not say how figures are shown."""
        return image(self, "png", dpi=self.dpi)


def _has_windows() -> bool:
    """Return True if pyplot's backend shows figures by itself, in windows or in widgets."""
    backend = mpl.get_backend().lower()
    without: list[str] = backend_registry.list_builtin(BackendFilter.NON_INTERACTIVE)  # type: ignore[no-untyped-call]
    return backend not in without and "inline" not in backend


def known_to_pyplot(drawn: T, place: Place) -> T:
    """Return what was drawn; if it is a figure of its own, pyplot knows and shows it from now on."""
    if isinstance(drawn, StickslipFigure) and place.get("figure") is None:
        from matplotlib import pyplot

        # Only a finished figure is handed over: one that fails leaves nothing behind. This must not happen inside `styled`,
        # because with the first figure the backend of a notebook sets options of matplotlib that have to stay.
        pyplot.figure(FigureClass=lambda **_: drawn)  # type: ignore[arg-type]
    return drawn


def shown_or_saved(drawn: Any, path: str | Path | None, place: Place) -> Any:
    """Make what was drawn known to pyplot, or write its figure to a file, either whole or not at all; return what was drawn."""
    if path is None:
        return known_to_pyplot(drawn, place)
    dpi = {} if place.get("dpi") is None else {"dpi": place["dpi"]}
    write_atomically(Path(path), partial(styled(drawn.get_figure(root=True).savefig), **dpi))
    return drawn


def check_place(**place: Unpack[Place]) -> None:
    """Raise InputError if a figure cannot be drawn there, or not in this size."""
    for unknown in (name for name in place if name not in KEYWORDS):
        raise InputError(f"plot: there is no {unknown}=; {nearest(unknown, KEYWORDS)}")
    for name, kinds in (("ax", "axes"), ("figure", "figure")):
        given: Any = place.get(name)
        if given is not None and not hasattr(given, "plot" if name == "ax" else "subplots"):
            raise InputError(f"plot: {name} must be a matplotlib {kinds}, got {shown(given)}")
    if place.get("ax") is not None and any(place.get(name) is not None for name in KEYWORDS[1:]):
        raise InputError("plot: axes already have a figure, its size and its dpi: leave out figure, size and dpi, or ax")
    size, dpi = (place.get("size"), place.get("dpi"))
    width, height = (1.0, 1.0) if size is None else read_size(size, (1.0, 1.0))
    if dpi is not None:
        check_dpi(dpi, max(width, height))


def check_dpi(dpi: float, longest: float = 1.0, where: str = "dpi") -> float:
    """Return dots per inch, for a figure whose longest side is given in inches. Raises InputError; `where` begins the message."""
    if isinstance(dpi, bool) or not isinstance(dpi, Real) or not DPI[0] <= dpi <= DPI[1]:
        raise InputError(f"{where}: must be a number of dots per inch from {DPI[0]:g} to {DPI[1]:g}, got {shown(dpi)}")
    if dpi * longest > MOST_DOTS:
        raise InputError(f"{where}: {dpi:g} dots per inch make a side of {dpi * longest:.0f} dots, at most {MOST_DOTS} are allowed")
    return float(dpi)


def read_size(size: tuple[float, float] | str, usual: tuple[float, float], where: str = "size") -> tuple[float, float]:
    """Return width and height in inches from what users write.

    `usual` is the size of the figure by default, whose height goes with the width of a column. Raises InputError; `where` begins
    the message.
    """
    if isinstance(size, str):
        text = size.strip().lower()
        if text in WIDTHS_OF_COLUMNS:
            return WIDTHS_OF_COLUMNS[text], usual[1]
        sides = _sides_in(text)
    else:
        sides = tuple(size) if isinstance(size, Iterable) else ()
    if len(sides) != 2 or not all(isinstance(side, Real) and math.isfinite(side) for side in sides):
        raise InputError(f"{where}: must be {HOW_TO_SIZE}, got {shown(size)}")
    width, height = (float(side) for side in sides)
    if not all(SIDES[0] <= side <= SIDES[1] for side in (width, height)):
        raise InputError(f"{where}: each side must be from 2 cm to 2 m, got {width * 2.54:.4g} cm x {height * 2.54:.4g} cm")
    return width, height


def _sides_in(text: str) -> tuple[float, ...]:
    """Return width and height (inches) in a text such as "16 x 10 cm" or "160mm x 4in"; nothing if it is no such text."""
    found = _SIZE.fullmatch(text)
    if found is None:
        return ()
    width, first, height, second = found.groups()
    if (first or second) not in INCHES or second not in INCHES:
        return ()
    try:
        return float(width) * INCHES[first or second], float(height) * INCHES[second]
    except ValueError:
        return ()


def size_of(usual: tuple[float, float], **place: Unpack[Place]) -> tuple[float, float]:
    """Return the width and height (inches) that `sheet` will give a figure, so that its panels can be chosen by its room."""
    check_place(**place)
    size, figure = place.get("size"), place.get("figure")
    if size is not None:
        return read_size(size, usual)
    if figure is None or (isinstance(figure, StickslipFigure) and not figure.axes):
        return usual
    dpi = figure.get_figure(root=True).dpi
    return figure.bbox.width / dpi, figure.bbox.height / dpi


def sheet(usual: tuple[float, float], **place: Unpack[Place]) -> Figure:
    """Return the figure to draw several panels in, of the `usual` size (inches) unless the user says otherwise.

    Raises InputError if axes are given: several panels do not fit into them.
    """
    check_place(**place)
    if place.get("ax") is not None:
        raise InputError("plot: this figure has several panels: give an empty figure (figure=...) instead of axes (ax=...)")
    figure = place.get("figure")
    size, dpi = place.get("size"), place.get("dpi")
    ours = figure is None or (isinstance(figure, StickslipFigure) and not figure.axes)
    if figure is None:
        figure = StickslipFigure(dpi=dpi)  # a resolution that is set later does not count when the figure is saved
    if isinstance(figure, Figure):
        if ours or size is not None:
            figure.set_size_inches(*(usual if size is None else read_size(size, usual)))
        if dpi is not None:
            figure.set_dpi(dpi)
        figure.set_layout_engine("constrained")
    return cast("Figure", figure)  # a subfigure draws as a figure does


def one_panel(usual: tuple[float, float], **place: Unpack[Place]) -> Axes:
    """Return the axes to draw one panel in: the user's own, or those of a new figure of the `usual` size (inches)."""
    if place.get("ax") is not None:
        check_place(**place)
        return place["ax"]
    axes: Axes = sheet(usual, **place).subplots()
    return axes
