"""Show progress in one line: after a spinner on a terminal, as a text that is replaced in a notebook, and elsewhere not at all."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

from stickslip.foundation.arguments import shown
from stickslip.foundation.errors import InputError
from stickslip.foundation.formatting import clean

News = TypeVar("News")
Show = Callable[[str], object]
"""A function that shows a line of text in place of the one before."""


@contextmanager
def told(progress: Callable[[News], object] | bool | None, what: str) -> Iterator[Callable[[News], object] | None]:
    """Provide the function that receives the progress of `what`: the user's function, or a display if `progress` is True.

    It is None if no progress is wanted. Raises InputError for anything else.
    """
    if progress is True:
        with progress_line(f"{what}:") as report:
            yield report
        return
    if not (progress is None or progress is False or callable(progress)):
        raise InputError(f"{what}: progress must be True or a function, got {shown(progress)}")
    yield progress or None


@contextmanager
def progress_line(what: str) -> Iterator[Callable[..., None]]:
    """Show progress on a terminal or in a notebook until the end of the context, which removes the line.

    Yields a function that shows its arguments after `what`. Messages about compilation are shown in the same place.
    """
    notebook = _notebook()
    if notebook is None and not sys.stderr.isatty():
        yield lambda *news: None
        return
    from stickslip.engine.codegen.cache import announce_by, tell  # with the compiler behind it, which is needed now anyway

    with _in_notebook(notebook) if notebook else _on_terminal(what) as show:

        def report(*news: object) -> None:
            show(" ".join([what, *(clean(str(one)) for one in news)]))

        announce_by(report)
        try:
            yield report
        finally:
            announce_by(tell)


@contextmanager
def _on_terminal(what: str) -> Iterator[Show]:
    from rich.console import Console
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    console = Console(file=sys.stderr, highlight=False, markup=False, emoji=False)
    with Progress(SpinnerColumn(), TextColumn("{task.description}"), TimeElapsedColumn(), console=console, transient=True) as bar:
        task = bar.add_task(what)
        yield lambda line: bar.update(task, description=line)


def _notebook() -> Callable[..., Any] | None:
    """Return IPython's function `display` in a notebook; None elsewhere, without importing anything."""
    shell = getattr(sys.modules.get("IPython"), "get_ipython", lambda: None)()
    if getattr(shell, "kernel", None) is None:  # a shell in a terminal has none
        return None
    from IPython.display import display

    return display  # type: ignore[no-any-return]


@contextmanager
def _in_notebook(display: Callable[..., Any]) -> Iterator[Show]:
    """Replace the text of one display; rich would need a library of widgets for that, which many notebooks lack."""
    handle = display({"text/plain": ""}, raw=True, display_id=True)
    try:
        yield lambda line: handle.update({"text/plain": line}, raw=True)
    finally:
        handle.update({"text/plain": ""}, raw=True)
