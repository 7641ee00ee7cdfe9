"""Pictures that are written without being drawn, which takes most of the time of many tests: core/figures draws all kinds."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest.mock import patch

from matplotlib.figure import Figure


@contextmanager
def blank(*kinds: str) -> Iterator[None]:
    """Write figures as empty pictures of their size: those in some formats ("png", "svg"), or in any if none is named."""
    save = Figure.savefig

    def save_blank(figure: Figure, file: Any, **look: Any) -> None:
        if not kinds or look.get("format") in kinds:
            figure = Figure(figsize=tuple(figure.get_size_inches()))
        save(figure, file, **look)

    with patch.object(Figure, "savefig", save_blank):
        yield
